"""What observes a trial while it runs, sees everything and changes nothing; and what its agent's answers took."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from automotive_cosim.agents import Agent, Stage, StageName, Thinker
from automotive_cosim.contracts import Element, Json
from automotive_cosim.contracts.given import Clock
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Session
from automotive_cosim.interface.trace import Step
from automotive_cosim.models import ModelReply


@dataclass(frozen=True)
class Shot:
    """One step as observers see it."""

    session: Session
    step: Step
    seen: tuple[Element, ...] = ()
    """The elements the agent saw when it acted."""
    stages: tuple[Stage, ...] = ()
    """The stages of the agent's reasoning, for agents that report them."""

    @cached_property
    def thought(self) -> str:
        """The agent's own reason for the action, or what was wrong with its answer; empty if it gives none."""
        said = {stage.name: stage.text for stage in self.stages}
        return said.get(StageName.INTERPRET, said.get(StageName.ACT, ""))

    @cached_property
    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The cockpit after the step, (height, width, 3); drawn when an observer first asks for it, which must be
        before the next step."""
        return self.session.screenshot()


class TrialObserver(Observer):
    """Observes trials: their sessions and what comes of them."""

    def begun(self, session: Any, shot: Shot) -> None:
        """The agent takes over: at the hand-over of a task, or when a drive departs."""

    def stepped(self, shot: Shot) -> None:
        """The agent has acted."""

    def finished(self, row: Any, told: Any) -> None:
        """The trial is over, or was broken off: its row, and what else its trace tells (``TrialSetup.told``)."""


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
