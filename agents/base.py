"""The protocol of agents, and optional protocols."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol, runtime_checkable

from automotive_cosim.contracts import Action, Element, Json, Observation
from automotive_cosim.episode.episode import Episode
from automotive_cosim.interface.observe import Channel
from automotive_cosim.models.base import ModelReply
from automotive_cosim.tasking.instance import Instance


class Agent(Protocol):
    """Acts on observations for one episode at a time."""

    @property
    def name(self) -> str: ...

    @property
    def model(self) -> str:
        """Name of its model; ``"none"`` without one."""
        ...

    @property
    def channels(self) -> frozenset[Channel]:
        """The channels that it gets."""
        ...

    def reset(self, goal: str) -> None:
        """Begins a new episode with the driver's words."""
        ...

    def act(self, observation: Observation) -> Action:
        """The next action.

        Raises:
            ActionError: its model's answer could not be read; the step still counts.
            OutOfBudgetError: its budget is spent; the episode ends and is judged as it is.
            ModelError: its model could not be reached; the episode says nothing about it."""
        ...


class StageName(StrEnum):
    """The stages of an agent's cycle."""

    PERCEIVE = "perceive"
    """Its input, as its model reads it."""
    INTERPRET = "interpret"
    """Its interpretation of the input."""
    PLAN = "plan"
    """What it intends to do after this action."""
    ACT = "act"
    """The action, or what was wrong with the answer."""
    REFLECT = "reflect"
    """The result of the previous action, in its own words."""
    REMEMBER = "remember"
    """What it remembers from here on."""


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of one step, for the record."""

    name: StageName
    text: str
    at_s: float
    """Simulated seconds since the hand-over."""
    reply: ModelReply | None = None
    """The model's whole answer, at the first of the stages that were parsed from it."""
    asked: str = ""
    """Digest of the question it answers."""
    pictures: int = 0
    """Number of pictures sent with the question."""

    def as_json(self) -> Json:
        return {
            "stage": self.name,
            "text": self.text,
            "at_s": self.at_s,
            "reply": None if self.reply is None else self.reply.as_json(),
            "asked": self.asked,
            "pictures": self.pictures,
        }


@runtime_checkable
class Thinker(Protocol):
    """An agent that reports the stages that led to its last action."""

    @property
    def stages(self) -> Sequence[Stage]:
        """The stages of the last ``act``, even if it raised."""
        ...


@runtime_checkable
class Learner(Protocol):
    """An agent that remembers something from one episode to the next."""

    def learn(self, success: bool) -> None:
        """Takes the result of the episode that has ended."""
        ...


@runtime_checkable
class Privileged(Protocol):
    """An agent that is told the task itself: a reference, never a contestant."""

    def brief(
        self, instance: Instance, *, drawn: Callable[[], Sequence[Element]], branch: Callable[[], Episode]
    ) -> None:
        """Called after ``reset``.

        Args:
            drawn: the boxes of the widgets in the present picture, for a reference that works by pixels.
            branch: gives a copy of the episode as it is, for a reference that tries things; it closes the copy."""
        ...
