"""The row of an episode, from which reports, comparisons and data frames are made."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, fields
from typing import Annotated, Any

from automotive_cosim.run.figures import DriveFigures, PixelTaps
from automotive_cosim.run.row import InColumns
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Ability, Basis, Dimension, Module
from automotive_cosim.tasking.verdict import Verdict


@dataclass(frozen=True, slots=True)
class PartsHeld:
    """Which parts of a verdict hold (``PARTS``); success is all of them."""

    goal: bool
    clean: bool
    safe: bool
    in_time: bool
    declared: bool

    @classmethod
    def of(cls, verdict: Verdict) -> PartsHeld:
        return cls(**{name: part.ok for name, part in verdict.parts.items()})

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of the parts that do not hold."""
        return tuple(each.name for each in fields(self) if not getattr(self, each.name))


@dataclass(frozen=True, slots=True, kw_only=True)
class EpisodeRow(TrialRow):
    """One episode on a task's half. Values that were not measured are None."""

    task: str
    half: str
    pair: str
    """Name that both halves of a pair share; empty for a task with one half."""
    half_digest: str = ""
    """``fingerprint`` of the half when it ran; empty in rows of 0.2.0."""
    dimension: Dimension
    module: Module
    basis: Basis | None = None
    """What the verdict rests on."""
    suite: Suite = Suite.STANDARD
    tags: tuple[str, ...] = ()
    skills: tuple[str, ...] = ()
    """Skills that the task requires of an agent."""
    ability: Ability | None = None
    """What a task of the hard suite is hard by."""
    declines: bool = False
    """Whether nothing has to be done in this half."""
    traffic_seed: int | None = None
    """Seed of the traffic: ``seed``, or a spare one; None without a hand-over."""
    parameters: Mapping[str, Any] | None = None
    """Drawn for this seed; None without a hand-over."""
    country: str = ""
    """Country at the hand-over; empty if the place is unknown."""
    success: bool | None = None
    """None without a verdict."""
    reward: float = 0.0
    parts: Annotated[PartsHeld | None, InColumns("part")] = None
    goal_s: float | None = None
    """Seconds from the trigger since when the goal held to the end."""
    reason_fits: bool | None = None
    """For a declined task, whether the reason code fits."""
    alerts: int | None = None
    """Number of alerts that the agent gave to the driver."""
    questions: int | None = None
    """Number of questions that it asked the driver."""
    unneeded_questions: int | None = None
    """Questions whose answer could be found without asking, or had already been given."""
    question_s: float | None = None
    """Seconds that questions and answers took from the driver's attention."""
    sim_seconds: float = 0.0
    """From the hand-over to the end."""
    speed_compliance: float | None = None
    """From 1 without overspeed down to 0; None if no limit binds, by sign or by law."""
    min_time_to_collision_s: float | None = None
    drive: Annotated[DriveFigures | None, InColumns("drive")] = None
    """Figures of the drive; only of judged safety tasks."""
    baseline_drive: Annotated[DriveFigures | None, InColumns("baseline_drive")] = None
    """The same figures of the baseline run over the same time."""
    interaction_s: float | None = None
    """The driver's, while the car moved."""
    within_guideline: bool | None = None
    """Whether the load on the driver is within NHTSA's 2 s per glance and 12 s in total."""
    taps: Annotated[PixelTaps | None, InColumns("taps")] = None
    """Taps that were given as pixels; None without one."""
    prompt_tokens: tuple[int, ...] = ()
    """Tokens of each call of the model."""
    held_out: bool = False
    """Whether the driver's phrasing is held out from the rule model."""

    @property
    def subject(self) -> str:
        return self.task

    @property
    def instance(self) -> tuple[Hashable, ...]:
        """What two contestants must share to be compared."""
        return self.task, self.half, self.scenario, self.seed, self.repeat

    @property
    def outcome(self) -> bool | None:
        """Whether it is a success; None without a verdict."""
        return self.success

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of the parts of the verdict that do not hold."""
        return self.parts.missing if self.parts else ()
