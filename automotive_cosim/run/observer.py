"""What observes a trial while it runs, e.g. to show or record it; it sees everything and changes nothing.

play_observed:  begun -> (act -> stepped)* -> finished, which whoever judges the session calls
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Generic, Protocol, TypeVar, runtime_checkable

import numpy as np
import numpy.typing as npt

from automotive_cosim.agents import Agent, Stage, StageName, Thinker
from automotive_cosim.contracts import Element
from automotive_cosim.contracts.given import Clock
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.specification import End
from automotive_cosim.interface.trace import Step
from automotive_cosim.models import ModelReply

T = TypeVar("T", bound=Session)
S = TypeVar("S", bound=Session, contravariant=True)
R = TypeVar("R", contravariant=True)


@dataclass(frozen=True)
class Shot:
    """One step as observers see it."""

    session: Session
    step: Step
    seen: tuple[Element, ...] = ()
    """The elements the agent saw when it acted."""
    thought: str = ""
    """The agent's own reason for the action; empty if it gives none."""
    stages: tuple[Stage, ...] = ()
    """The stages of the agent's reasoning, for agents that report them."""

    @cached_property
    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The cockpit after the step, (height, width, 3); drawn when an observer first asks for it, which must be
        before the next step."""
        return self.session.screenshot()


class TrialObserver(Observer, Generic[S, R]):
    """Observes trials of one kind: their sessions and what comes of them."""

    def begun(self, session: S, shot: Shot) -> None:
        """The agent takes over: at the hand-over of a task, or when a drive departs."""

    def stepped(self, shot: Shot) -> None:
        """The agent has acted."""

    def finished(self, result: R) -> None:
        """The trial is over and judged."""


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


@dataclass(frozen=True, slots=True)
class Usage:
    """What the answers of an agent's model cost."""

    calls: int = 0
    tokens_in: int = 0
    tokens_out: int = 0
    cost_usd: float = 0.0
    model_seconds: float = 0.0
    """Total wait for the model; 0 for one that runs in this process."""
    thought_s: float = 0.0
    """Simulated seconds that all answers took."""


class Answers:
    """An agent's answers: how long each took, its reasons, and what they all cost."""

    def __init__(self, agent: Agent, conditions: Conditions) -> None:
        """Nothing has been answered yet."""
        self._agent, self._conditions = agent, conditions
        self._replies: list[ModelReply] = []
        self._thought_s = 0.0

    def thought_s(self) -> float:
        """Simulated seconds that the last answer took; asked once for each."""
        seconds = self._seconds()
        self._thought_s += seconds
        return seconds

    def stages(self) -> tuple[Stage, ...]:
        """The stages of the last turn, whose replies are counted; asked once for each."""
        stages = tuple(self._agent.stages) if isinstance(self._agent, Thinker) else ()
        self._replies += [stage.reply for stage in stages if stage.reply is not None]
        return stages

    @property
    def usage(self) -> Usage:
        """What they cost so far."""
        replies = self._replies
        return Usage(
            len(replies),
            sum(reply.tokens_in for reply in replies),
            sum(reply.tokens_out for reply in replies),
            sum(reply.cost_usd for reply in replies),
            round(sum(reply.seconds for reply in replies), 3),
            round(self._thought_s, 3),
        )

    def _seconds(self) -> float:
        agent, seconds = self._agent, self._conditions.latency_s
        if isinstance(agent, _Replayed):
            return agent.thought_s
        if self._conditions.clock is Clock.MODEL and isinstance(agent, _Timed):
            seconds += agent.answer_s
        elif self._conditions.clock is Clock.MODEL and isinstance(agent, Thinker):
            seconds += sum(stage.reply.seconds for stage in agent.stages if stage.reply is not None)
        return round(seconds, 1)  # the shortest step of a scenario


def play_observed(
    session: T, agent: Agent, answers: Answers, observers: Sequence[TrialObserver[T, R]], wall_s: float = inf
) -> End:
    """Lets an agent act until the session is over, and returns why it is.

    Args:
        session: the session.
        agent: the agent, which has been told the goal.
        answers: counts the agent's.
        observers: told of the beginning and of each step.
        wall_s: wall seconds after which it is cut off.

    Raises:
        TrafficError: the traffic simulation failed.
        ModelError: the agent's model could not be reached.
    """

    def stepped(session: T, seen: Sequence[Element]) -> None:
        stages = answers.stages()
        shot = Shot(session, session.steps[-1], tuple(seen), _thought(stages), stages)
        for observer in observers:
            observer.stepped(shot)

    first = Shot(session, session.steps[0])
    for observer in observers:
        observer.begun(session, first)
    end = play(session, agent, stepped, answers.thought_s, wall_s)
    if end in (End.OUT_OF_BUDGET, End.AGENT_FAILED):
        answers.stages()  # of the turn that it did not finish
    return end


def _thought(stages: Sequence[Stage]) -> str:
    """The agent's action, or what was wrong with its answer."""
    said = {stage.name: stage.text for stage in stages}
    return said.get(StageName.INTERPRET, said.get(StageName.ACT, ""))
