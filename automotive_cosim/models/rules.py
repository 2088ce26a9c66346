"""``rules``: a deterministic stand-in for a language model.

It gets the text that a language model would get and nothing else, and reads it by headings and keywords. It is not
a language model, and its success rates say nothing about one: it shows that the pipeline carries the information
that an agent needs, and how the same rules fare when they are given less. It sees no pixels, so an agent with
screenshots does exactly what the same agent does without them.

Its knowledge is in ``skills.py``; this module reads the prompt and follows a plan. The prompt itself carries the
plan from turn to turn, in the section "Your plan".
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence

from automotive_cosim.models.base import ChatMessage, ModelReply, estimated_tokens
from automotive_cosim.models.page import ListedElement, Page
from automotive_cosim.models.skills import CALLS, SKILLS, Course, Decline, SkillMove, Wait

MOST_SCROLLS = 6
"""How often it scrolls for one element before it stops looking."""
STOPPED = {
    "restricted": "safety",
    "disabled": "not_possible",
    "refused": "not_possible",
    "no_such_element": "not_possible",
}
"""Results after which a plan cannot continue, and the reason to decline with."""


class Rules:
    """The stand-in; ``chat`` is a pure function of the messages. Its token counts are estimates."""

    name = "rules"
    sees_pictures = False

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """Answers a prompt with an action, or a request to look back with one line."""
        page = Page.read(messages[-1].text)
        if messages[0].role == "system":
            text = _call(page, called=len(messages) > 2)
        else:
            text = _look_back(page) if page.looks_back else _answer(page)
        asked = [message.text for message in messages]
        return ModelReply(text, estimated_tokens(*asked), estimated_tokens(text))


def _answer(page: Page) -> str:
    moves, scrolls = _plan(page.plan)
    if moves:
        return _go_on(page, "Going on as planned.", moves, scrolls)
    decided = _called(page) if page.calls_alone else _decide(page)
    if isinstance(decided, Decline):
        return _say(decided.because, _status(decided.status, decided.reason))
    if isinstance(decided, Wait):
        wait: dict[str, object] = {"action_type": "wait"}
        return _say(decided.because, wait if decided.seconds is None else wait | {"seconds": decided.seconds})
    end = (("status", "complete", "none"),) if decided.declares else ()
    return _go_on(page, decided.because, (*decided.moves, *end), 0)


def _call(page: Page, *, called: bool) -> str:
    """Calls that fulfil the goal, then how it ended by the last result, in the form of a protocol of calls."""
    known = _calls_for(page)
    calls: list[tuple[str, dict[str, object]]]
    if called and page.result in STOPPED:
        calls = [("status", {"goal_status": "infeasible", "reason": STOPPED[page.result]})]
    elif called or not known:
        calls = [("status", {"goal_status": "complete"} if known else {"goal_status": "infeasible"})]
    else:
        calls = list(known)
    return json.dumps({"say": "", "calls": [{"name": name, "arguments": given} for name, given in calls]})


def _called(page: Page) -> Course | Decline:
    """The same calls as a plan of actions."""
    known = _calls_for(page)
    if not known:
        return Decline("infeasible", "none", "I know no function for that.")
    calls = ({"action_type": "call", "function": name, "arguments": given} for name, given in known)
    return Course("A function does it.", tuple(("do", json.dumps(call)) for call in calls))


def _calls_for(page: Page) -> Sequence[tuple[str, dict[str, object]]]:
    return next((found for words, found in CALLS if re.search(words, page.goal.lower())), ())


def _decide(page: Page) -> Course | Decline | Wait:
    goal = page.goal.lower()
    for skill in SKILLS:
        if any(re.search(word, goal) for word in skill.words):
            return skill.do(page) if callable(skill.do) else skill.do
    return Decline("infeasible", "none", "I do not know what is wanted.")


def _go_on(page: Page, because: str, moves: Sequence[SkillMove], scrolls: int) -> str:
    """The first of the moves, with the others as the plan."""
    if page.plan and page.result in STOPPED:
        return _say(f"The car says {page.result}.", _status("infeasible", STOPPED[page.result]))
    move, rest = moves[0], moves[1:]
    action = _action(page, move)
    if action is not None:
        return _say(because, action, rest)
    if scrolls < MOST_SCROLLS and any(line.is_scrollable for line in page.screen):
        return _say(
            f"{move[1]} is not in sight.", {"action_type": "scroll", "direction": "down"}, moves, scrolls + 1
        )
    return _say(f"I cannot find {move[1]}.", _status("infeasible", "not_possible"))


def _action(page: Page, move: SkillMove) -> dict[str, object] | None:
    """The action of one move; None if its element is not on the screen."""
    kind, about = move[0], move[1]
    if kind == "open":
        return {"action_type": "open_app", "app_name": about}
    if kind == "say":
        return {"action_type": "answer", "text": about}
    if kind == "do":
        action: dict[str, object] = json.loads(about)
        return action
    if kind == "status":
        return _status(about, move[2])
    line = page.find(about)
    if line is None:
        return None
    if kind == "type":
        return {"action_type": "input_text", "index": line.index, "text": move[2], "clear_text": True}
    if kind == "slide":
        return _on_track(line, float(move[2]))
    return {"action_type": "click", "index": line.index}


def _on_track(line: ListedElement, share: float) -> dict[str, object]:
    left, top, right, bottom = line.bounds
    return {"action_type": "click", "x": round(left + share * (right - left)), "y": (top + bottom) // 2}


def _status(status: str, reason: str) -> dict[str, object]:
    return {"action_type": "status", "goal_status": status, "reason": reason}


def _say(because: str, action: Mapping[str, object], rest: Sequence[SkillMove] = (), scrolls: int = 0) -> str:
    plan = f"Plan: {json.dumps({'moves': rest, 'scrolls': scrolls})}\n" if rest else ""
    return f"Situation: {because}\n{plan}Action: {json.dumps(action)}"


def _plan(text: str) -> tuple[tuple[SkillMove, ...], int]:
    """The remaining moves of a plan and how often it has scrolled for the first; empty if it is not ours."""
    try:
        plan = json.loads(text)
        return tuple(tuple(map(str, move)) for move in plan["moves"]), int(plan["scrolls"])
    except (ValueError, LookupError, TypeError):
        return (), 0


def _look_back(page: Page) -> str:
    what = "nothing" if page.changes == ("nothing",) else "the screen"
    return f"Lesson: {page.result or 'done'}; {what} changed."
