"""What the rows of all trials share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Annotated

from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import End
from automotive_cosim.measures.exposure import ExposureCell
from automotive_cosim.measures.following import FollowingFigures
from automotive_cosim.run.row import InColumns, JobRow, Volatile
from automotive_cosim.tasking.policy import Breach
from automotive_cosim.tasking.sets import Split


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialRow(JobRow, ABC):
    """One trial: an agent's run of a task's half or of a drive. An error leaves most fields at their defaults."""

    scenario: str
    agent: str
    model: str
    seed: int
    repeat: int = 0
    conditions: Annotated[Conditions, InColumns("")] = Conditions()  # noqa: RUF009, frozen
    """What the agent was given, and at what speed."""
    split: Split | None = None
    """The set that it belongs to; None in rows from before there were sets."""
    end: End = End.ERROR
    agent_error: str | None = None
    """How the agent's side failed, if it did: a failure like any other, never an error."""
    steps: int = 0
    malformed: int | None = None
    """Steps lost to answers that were no action, as the agent raised or they could not be read; None without a
    trial."""
    malformed_why: str = ""
    """Why the first of them was none."""
    thought_s: float = 0.0
    """Simulated seconds that all answers took."""
    tokens_in: int = 0
    tokens_out: int = 0
    cost_usd: float = 0.0
    trace_sha256: str | None = None
    breaches: tuple[Breach, ...] | None = None
    """What the agent did against the house rules; None without a judgement and in earlier rows."""
    measures: Annotated[FollowingFigures | None, InColumns("measure")] = None
    """How close the car came to those in front and behind; None if it never drove."""
    exposure: tuple[ExposureCell, ...] = ()
    """How long and how far it drove in which conditions."""
    model_seconds: Volatile[float] = 0.0
    """Total wait for the model."""

    @property
    @abstractmethod
    def subject(self) -> str:
        """The task, or the family of drives."""

    @property
    @abstractmethod
    def instance(self) -> tuple[Hashable, ...]:
        """What two contestants must share to be compared."""

    @property
    @abstractmethod
    def outcome(self) -> bool | None:
        """Whether it is a success; None without a judgement."""

    @property
    @abstractmethod
    def missing(self) -> tuple[str, ...]:
        """What a success lacks, in words."""

    @property
    def has_succeeded(self) -> bool:
        """Whether it was judged a success."""
        return self.outcome is True

    @property
    def has_run(self) -> bool:
        """Whether it was judged or ended in an error; false for one that is only planned."""
        return self.outcome is not None or self.error is not None
