"""An agent behind an address, on this project's tasks and drives."""

from __future__ import annotations

import time
from collections import deque
from typing import TYPE_CHECKING

from automotive_cosim.agents import prompt
from automotive_cosim.agents.a2a.contract import (
    ENVIRONMENT,
    USER,
    AnswerReader,
    Metrics,
    RemoteAnswer,
    opening,
    results,
)
from automotive_cosim.agents.base import Stage, StageName
from automotive_cosim.agents.registry import PREFIX
from automotive_cosim.agents.settings import AgentProfile, AgentSettings
from automotive_cosim.agents.thoughts import spoken
from automotive_cosim.cockpit.actions import TEXT_LIMIT
from automotive_cosim.contracts import UNCALLED, Action, ActionType, Observation
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError, SetupError, install_hint
from automotive_cosim.formats.words import shown
from automotive_cosim.interface.functions import action_of, offered
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.models.base import ModelReply, ToolCall, believed

if TYPE_CHECKING:
    from automotive_cosim.agents.a2a.client import AgentLine

MOST_CALLS = 10
"""Most calls of one answer; each is a step."""
CLOSING_S = 30.0
"""Longest wait for an agent's last words, with which it reports its metrics."""
NOT_DONE = "not done"
SPOKEN = (
    "Words without a call are put to the driver as a question, of 120 characters at most, and distract; say only "
    "what has to be asked"
)
"""What the agent is told of its words."""
CHANNELS = ALL - {Channel.SCREENSHOT}
"""The contract has no pictures."""


class A2AAgent:
    """Sends each answer's results and the situation then to the agent, in one context for each episode.

    Words without a call are spoken to the driver (``ask_driver``), as the contract has it. Before the agent's
    declaration takes effect, it is sent its result like that of any call: agents report their metrics with their
    last words.
    """

    def __init__(self, name: str, settings: AgentSettings) -> None:
        """Reads the agent's card.

        Args:
            name: ``a2a:http://HOST:PORT``.
            settings: the conditions, the budget, and the time for an answer.

        Raises:
            UserError: the name has no address.
            SetupError: no such agent answers there, or ``a2a-sdk`` is missing.
        """
        self.name = name
        self.model = "none"
        self._settings = settings
        self._profile = AgentProfile("a2a", CHANNELS, frozenset(UNCALLED), reflects=False).under(settings)
        tools = offered(settings.conditions.interface, settings.conditions.geo)
        self._tools = {function.name: function for function in tools}
        self._line = _line(name.removeprefix(PREFIX))
        self.stages: list[Stage] = []
        self.reset("")

    @property
    def channels(self) -> frozenset[Channel]:
        """All channels but the picture."""
        return CHANNELS

    def reset(self, goal: str) -> None:
        self._line.begin()
        self._reader = AnswerReader(self._tools)
        self._is_new, self._heard = True, 0
        self._asked: tuple[ToolCall, ...] = ()
        self._results: dict[str, str] = {}
        self._left: deque[ToolCall] = deque()
        self._waiting: ToolCall | None = None
        self._tokens = 0
        self._seconds = self._unreported_s = 0.0
        self._is_reported = True
        self.stages.clear()

    def act(self, observation: Observation) -> Action:
        """The next call of the last answer, or the first of another one.

        Raises:
            ActionError: the answer has neither words nor a call, or one that does not fit its function.
            OutOfBudgetError: the episode's tokens or seconds are spent.
            AgentError: the agent does not answer, or not in its protocol.
        """
        self.stages.clear()
        began_s = time.monotonic()
        if self._waiting is not None:
            self._results[self._waiting.id] = prompt.result(observation)
            self._waiting = None
        if not self._left:
            words = self._ask(observation)
            if words is not None:
                return words
        call = self._waiting = self._left.popleft()
        try:
            if call.name not in self._tools:
                raise ActionError(f"there is no function {shown(call.name)} here; call one of those offered")
            action = action_of(call.name, call.arguments)
        except ActionError as error:
            self._note(StageName.ACT, observation, str(error))
            raise
        self._note(StageName.ACT, observation, prompt.action_words(action, observation))
        if action.action_type is ActionType.STATUS and not observation.on_watch:
            self._close(observation, (self._settings.answer_s - (time.monotonic() - began_s)) / 2)
        return action

    def _ask(self, seen: Observation) -> Action | None:
        """Asks for the next answer; returns what its words alone do."""
        now = self._situation(seen, is_resulting=self._is_new or not self._asked)
        self._note(StageName.PERCEIVE, seen, now)
        sounds = list(seen.sounds[0 if self._is_new else self._heard + 1 :])  # the wish is the first
        if self._is_new:
            system = f"{self._told(seen)}\n\n{self._situation(seen, is_spoken=False)}"
            opened = opening(system, prompt.driver_words(seen), self._tools.values())
            answer = self._say(seen, [*opened, *sounds], USER)
        elif self._asked:
            contents = [self._results.get(call.id, NOT_DONE) for call in self._asked]
            contents[-1] += f"\n\n{now}"
            answer = self._say(seen, [*results(self._asked, contents), *sounds], ENVIRONMENT)
        else:
            words = "\n".join(seen.said[self._heard :])
            answer = self._say(seen, [f"{words}\n\n{now}".strip(), *sounds], USER)
        self._is_new, self._heard = False, len(seen.said)
        self._asked, self._results = answer.calls, {}
        if len(answer.calls) > MOST_CALLS:
            wrong = f"the answer has {len(answer.calls)} calls; at most {MOST_CALLS} are allowed"
        elif answer.calls:
            self._left.extend(answer.calls)
            return None
        else:
            try:
                words = " ".join(spoken(answer.say).split())[:TEXT_LIMIT]
                wrong = "the answer has neither words nor a call"
            except ActionError as error:
                words, wrong = "", str(error)
            if words:
                action = Action(ActionType.ASK_DRIVER, text=words)
                self._note(StageName.ACT, seen, prompt.action_words(action, seen))
                return action
        self._note(StageName.ACT, seen, wrong)
        raise ActionError(wrong)

    def _say(self, seen: Observation, parts: list[object], source: str, limit_s: float = 0.0) -> RemoteAnswer:
        settings = self._settings
        if self._tokens >= settings.most_tokens or self._seconds >= settings.most_seconds:
            raise OutOfBudgetError(
                f"the episode's budget is spent: {self._tokens} of {settings.most_tokens} tokens, "
                f"{self._seconds:.0f} of {settings.most_seconds:g} s"
            )
        began_s = time.monotonic()
        said = self._line.say(parts, source, limit_s or settings.answer_s)
        took_s = time.monotonic() - began_s
        try:
            answer = self._reader.read(said.parts, said.metadata)
        except (ValueError, RecursionError) as error:
            raise AgentError(f"the agent {self.name} gave no answer of CAR-bench's contract: {error}") from error
        self._is_reported = answer.metrics is not None
        metrics = answer.metrics or Metrics()
        self._seconds += took_s
        self._unreported_s += took_s
        told = ModelReply(
            answer.say,
            metrics.tokens_in,
            metrics.tokens_out,
            metrics.cost_usd,
            round(took_s, 3),
            reasoning=answer.reasoning,
            tokens_reasoning=metrics.tokens_reasoning,
        )
        reply = believed(told, self._unreported_s)
        if self._is_reported:
            self._unreported_s = 0.0
        self._tokens += reply.tokens_in + reply.tokens_out
        called = "\n".join(f"{call.name} {call.arguments}" for call in answer.calls)
        self._note(StageName.INTERPRET, seen, "\n".join(filter(None, (answer.say, called))), reply)
        return answer

    def _close(self, seen: Observation, limit_s: float) -> None:
        """Lets the agent have its last words, for its metrics. What it says is heard by nobody, and how it takes
        the end changes nothing: it has declared."""
        if self._is_reported or limit_s <= 0:
            return
        contents = [self._results.get(call.id, NOT_DONE) for call in self._asked]
        contents[-1] = "ok"
        try:
            self._say(seen, results(self._asked, contents), ENVIRONMENT, min(limit_s, CLOSING_S))
        except (AgentError, OutOfBudgetError) as error:
            self._note(StageName.REFLECT, seen, str(error))

    def _situation(self, seen: Observation, *, is_spoken: bool = True, is_resulting: bool = True) -> str:
        return prompt.situation(self._profile, seen, pictures=False, is_spoken=is_spoken, is_resulting=is_resulting)

    def _told(self, seen: Observation) -> str:
        weigh = prompt.PLACE_COUNTS if Channel.CONTEXT in self._profile.channels else ""
        name = "caller_watch" if seen.on_watch else "caller"
        return prompt.fill(name, {"weigh": weigh, "words": SPOKEN, "policy": seen.policy})

    def _note(self, name: StageName, seen: Observation, text: str, reply: ModelReply | None = None) -> None:
        self.stages.append(Stage(name, text, seen.time_s, reply))


def _line(address: str) -> AgentLine:
    try:
        from automotive_cosim.agents.a2a.client import AgentLine
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("a2a", "httpx", "google"):
            raise
        raise SetupError(f"the a2a-sdk package is missing; install it with `{install_hint('doors')}`") from error
    return AgentLine(address)
