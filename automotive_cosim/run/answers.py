"""An agent's answers in a trial: how long each took, its reasons, and what they all cost."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from automotive_cosim.agents import Agent, Stage, Thinker
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Clock
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.models import ModelReply


@runtime_checkable
class _Timed(Protocol):
    """An agent whose answers are timed from outside, so that it cannot influence the measurement."""

    @property
    def answer_s(self) -> float:
        """Wall seconds that its last answer took."""
        ...


@runtime_checkable
class _Replayed(Protocol):
    """An agent that repeats a recording, including the time that each answer took."""

    @property
    def thought_s(self) -> float:
        """Simulated seconds that the answer it gave last took."""
        ...


class Answers:
    """An agent's answers so far."""

    def __init__(self, agent: Agent, conditions: Conditions) -> None:
        """Nothing has been answered yet."""
        self._agent, self._conditions = agent, conditions
        self._replies: list[ModelReply] = []
        self.prompts: tuple[int, ...] = ()
        """Tokens of each question to the model, those of an unfinished turn left out."""
        self.thought_s = 0.0
        """Simulated seconds that all answers took."""

    def took_s(self) -> float:
        """Simulated seconds that the last answer took; asked once for each."""
        seconds = self._seconds()
        self.thought_s += seconds
        return seconds

    def stages(self, *, finished: bool = True) -> tuple[Stage, ...]:
        """The stages of the last turn, whose replies are counted; asked once for each.

        Args:
            finished: whether the turn came to an answer.
        """
        stages = tuple(self._agent.stages) if isinstance(self._agent, Thinker) else ()
        replies = [stage.reply for stage in stages if stage.reply is not None]
        self._replies += replies
        self.prompts += tuple(reply.tokens_in for reply in replies if finished)
        return stages

    @property
    def calls(self) -> int:
        """How often the model answered."""
        return len(self._replies)

    @property
    def costs(self) -> Json:
        """The fields of a row about what the agent's model took; a model in this process took no time."""
        replies = self._replies
        return {
            "tokens_in": sum(reply.tokens_in for reply in replies),
            "tokens_out": sum(reply.tokens_out for reply in replies),
            "cost_usd": sum(reply.cost_usd for reply in replies),
            "model_seconds": round(sum(reply.seconds for reply in replies), 3),
        }

    def _seconds(self) -> float:
        agent, seconds = self._agent, self._conditions.latency_s
        if isinstance(agent, _Replayed):
            return agent.thought_s
        if self._conditions.clock is Clock.MODEL and isinstance(agent, _Timed):
            seconds += agent.answer_s
        elif self._conditions.clock is Clock.MODEL and isinstance(agent, Thinker):
            seconds += sum(stage.reply.seconds for stage in agent.stages if stage.reply is not None)
        return round(seconds, 1)  # the shortest step of a scenario
