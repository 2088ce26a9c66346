"""What an agent is, and what it may offer besides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol, runtime_checkable

from automotive_cosim.contracts import Action, Json, Observation
from automotive_cosim.interface.observe import Channel
from automotive_cosim.models.base import ModelReply
from automotive_cosim.tasking.instance import Instance


class Agent(Protocol):
    """Acts on observations for one episode at a time."""

    @property
    def name(self) -> str:
        """As it is written into results."""
        ...

    @property
    def model(self) -> str:
        """Name of the model behind it; ``"none"`` without one."""
        ...

    @property
    def channels(self) -> frozenset[Channel]:
        """What it is to be given."""
        ...

    def reset(self, goal: str) -> None:
        """A new episode begins with what the driver said."""
        ...

    def act(self, observation: Observation) -> Action:
        """The next action.

        Raises:
            ActionError: its model's answer could not be read; the step counts all the same.
            OutOfBudgetError: it may think no further; the episode ends and is judged as it stands.
            ModelError: its model could not be reached; the episode says nothing about it.
        """
        ...


class StageName(StrEnum):
    """The stages of an agent's cycle."""

    PERCEIVE = "perceive"
    """What it was given, as its model reads it."""
    INTERPRET = "interpret"
    """What it makes of that."""
    PLAN = "plan"
    """What it means to do after this action."""
    ACT = "act"
    """The action, or what was wrong with the answer."""
    REFLECT = "reflect"
    """What came of the action before, in its own words."""
    REMEMBER = "remember"
    """What it keeps in mind from here on."""


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of one step, for the record."""

    name: StageName
    text: str
    at_s: float
    """Simulated seconds since the hand-over."""
    reply: ModelReply | None = None
    """The model's answer, at the first of the stages that were read from it; its text is the whole answer."""
    asked: str = ""
    """Digest of the question it answers."""
    pictures: int = 0
    """How many pictures went with the question."""

    def as_json(self) -> Json:
        """The stage as a JSON object."""
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
    """An agent that tells how it came to its last action."""

    @property
    def stages(self) -> Sequence[Stage]:
        """The stages of the last ``act``, also of one that raised."""
        ...


@runtime_checkable
class Learner(Protocol):
    """An agent that keeps something from one episode to the next."""

    def learn(self, success: bool) -> None:
        """The episode is over, and this came of it."""
        ...


@runtime_checkable
class Privileged(Protocol):
    """An agent that is told the task itself: a yardstick, never a contestant."""

    def brief(self, instance: Instance) -> None:
        """Called after ``reset``."""
        ...
