"""The agent ``caller``: a plain loop of function calls, as in-car assistants are built.

    system: what to do     user: the wish and the situation
    assistant: calls       tool: what each of them set, or why not
    ...                    the last of them with the situation now

The order is one that all servers take: a turn of the user before the first call, and none after a result. A picture
of now stands in the user's turn, since results hold text alone.

What it is told of the screen and the place are conditions (``--see``, ``--geo``); ``--interface`` says whether it
calls the car's functions, the actions of a finger, or both.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import replace

from automotive_cosim.agents import prompt
from automotive_cosim.agents.asking import Asking
from automotive_cosim.agents.base import StageName
from automotive_cosim.agents.marks import png, road
from automotive_cosim.agents.settings import AgentProfile, AgentSettings
from automotive_cosim.agents.thoughts import spoken
from automotive_cosim.agents.written import written
from automotive_cosim.contracts import UNCALLED, Action, Json, Observation
from automotive_cosim.errors import ActionError
from automotive_cosim.formats.words import shown
from automotive_cosim.interface.functions import Function, action_of, grouped, offered
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.models.base import ChatMessage, ChatModel, ModelReply, ToolCall

MOST_CALLS = 10
"""Most calls of one answer; each is a step."""
REMEMBERED = 20
"""Answers with their results that a watch, which lasts for hundreds of turns, is told of."""
WORDS = "Words without a call do nothing"
"""What it is told of them."""
NO_CALL = (
    "the answer calls no function; words alone do nothing: call one by the tools, or write "
    '<tool_call>{"name": ..., "arguments": {...}}</tool_call>'
)


def tools(settings: AgentSettings) -> tuple[Function, ...]:
    """The functions that it may call under these conditions, those of the car as one (``grouped``)."""
    return grouped(offered(settings.conditions.interface, settings.conditions.geo))


class Caller:
    """Asks its model once per answer, which may hold several calls; each costs a step."""

    name = "caller"

    def __init__(self, chat_model: ChatModel, settings: AgentSettings) -> None:
        """Puts the agent together.

        Args:
            chat_model: the model to ask, which knows the functions (``tools``) by its protocol.
            settings: the conditions, what to take away, the budget."""
        wanted = AgentProfile(self.name, ALL, frozenset(UNCALLED), reflects=False)
        self._profile = wanted.under(settings)
        self._asking = Asking(chat_model, settings)
        every = (*offered(settings.conditions.interface, settings.conditions.geo), *tools(settings))
        self._known = {function.name: function.parameters for function in every}
        self.stages = self._asking.stages
        self.reset("")

    @property
    def model(self) -> str:
        return self._asking.chat_model.name

    @property
    def channels(self) -> frozenset[Channel]:
        """All channels without those that the settings take away."""
        return self._profile.channels

    def reset(self, goal: str) -> None:
        self._asking.reset()
        self._wish = ChatMessage("user", "")
        self._told: list[tuple[ChatMessage, list[ChatMessage]]] = []
        self._left: deque[ToolCall] = deque()
        self._waiting: ToolCall | None = None
        self._is_told = False
        self._count = 0

    def act(self, observation: Observation) -> Action:
        """The next call of the last answer, or the first of another one.

        Raises:
            ActionError: the answer has no call, or one that does not fit its function.
            OutOfBudgetError: the episode's tokens or seconds are spent.
            ModelError: the model does not answer."""
        self.stages.clear()
        self._is_told = self._waiting is not None
        if self._waiting is not None:
            answer = ChatMessage("tool", prompt.result(observation), call_id=self._waiting.id)
            self._told[-1][1].append(answer)
            self._waiting = None
        if not self._left:
            self._ask(observation)
        call = self._waiting = self._left.popleft()
        try:
            if call.name not in self._known:
                raise ActionError(f"there is no function {shown(call.name)} here; call one of those offered")
            action = action_of(call.name, call.arguments)
        except ActionError as error:
            self._asking.note(StageName.ACT, observation, str(error))
            raise
        self._asking.note(StageName.ACT, observation, prompt.action_words(action, observation))
        return action

    def _ask(self, seen: Observation) -> None:
        pictures: tuple[bytes, ...] = ()
        if seen.screenshot is not None and self._asking.chat_model.sees_pictures:
            pictures = (png(seen.screenshot), *road(seen))
        now = self._situation(seen, bool(pictures))
        pictures = (*seen.sounds, *pictures)
        self._asking.note(StageName.PERCEIVE, seen, now)
        self._wish = replace(self._wish, text=self._wish.text if self._told else now, pictures=pictures)
        reply, asked = self._asking.converse(list(self._conversation(seen, now)))
        try:
            told, wrong = heard(reply, self._known, self._count), ""
        except ActionError as error:
            told, wrong = ChatMessage("assistant", ""), f"{error}{reply.ending}"
        self._asking.note(StageName.INTERPRET, seen, told.text, reply, asked, len(pictures))
        if not wrong and not told.calls:
            wrong = f"{NO_CALL}{reply.ending}"
        if len(told.calls) > MOST_CALLS:
            wrong = f"the answer has {len(told.calls)} calls; at most {MOST_CALLS} are allowed"
        self._count += len(told.calls)
        if wrong:
            self._asking.note(StageName.ACT, seen, wrong)
            raise ActionError(wrong)
        self._left.extend(told.calls)
        self._told.append((told, []))

    def _conversation(self, seen: Observation, now: str) -> Iterator[ChatMessage]:
        """What it is to do, and each earlier answer with its results, the last of which tells the situation."""
        weigh = prompt.PLACE_COUNTS if Channel.CONTEXT in self.channels else ""
        name = "caller_watch" if seen.on_watch else "caller"
        yield ChatMessage("system", prompt.fill(name, {"weigh": weigh, "words": WORDS, "policy": seen.policy}))
        yield self._wish
        for answer, results in self._told[-REMEMBERED:] if seen.on_watch else self._told:
            yield answer
            known = {result.call_id: result for result in results}
            for call in answer.calls:
                result = known.get(call.id, ChatMessage("tool", "not done", call_id=call.id))
                is_last = call is self._told[-1][0].calls[-1]
                yield replace(result, text=f"{result.text}\n\n{now}") if is_last else result

    def _situation(self, seen: Observation, pictures: bool) -> str:
        """What is so now; the result of a call stands at the call."""
        return prompt.situation(self._profile, seen, pictures=pictures, is_resulting=not self._is_told)


def heard(reply: ModelReply, schemas: Mapping[str, Json], count: int = 0) -> ChatMessage:
    """An answer as a turn of the conversation, with its calls: those that its protocol has, else those that are
    written in the words.

    Args:
        schemas: of the parameters, by function.

    Raises ActionError: it ended within its thoughts."""
    try:
        told = json.loads(reply.text)
        say, calls = str(told["say"]), [(str(call["name"]), call["arguments"], call) for call in told["calls"]]
    except (ValueError, LookupError, TypeError, RecursionError):
        say, calls, told = reply.text, [], {}
    if not calls:
        say = spoken(say)
        calls = [(name, given, {}) for name, given in written(say, schemas)]
    made = (
        ToolCall(f"call{count + at:05d}", name, given, frame.get("back"))
        for at, (name, given, frame) in enumerate(calls)
    )
    return ChatMessage("assistant", say, calls=tuple(made), back=told.get("back"))
