"""The row of an episode: all that reports, comparisons and data frames know of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Annotated, Any

from automotive_cosim.run.harm import DriveFigures
from automotive_cosim.run.row import InColumns, JobRow, Volatile, formerly
from automotive_cosim.tasking.task import Dimension, Mode, Module


@dataclass(frozen=True, slots=True)
class PartsHeld:
    """Which parts of a verdict hold; success is all of them."""

    goal: bool
    clean: bool
    safe: bool
    in_time: bool
    declared: bool

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of those that do not."""
        return tuple(each.name for each in fields(self) if not getattr(self, each.name))


PARTS = tuple(each.name for each in fields(PartsHeld))


@dataclass(frozen=True, slots=True, kw_only=True)
class EpisodeRow(JobRow):
    """One episode. What was not measured is None; an error leaves most fields at their defaults."""

    task: str
    half: str
    pair: str
    """Name that both halves of a pair share; empty for a task with one half."""
    dimension: Dimension
    module: Module
    basis: str = ""
    """What the verdict rests on (``tasking.task.Basis``)."""
    tags: tuple[str, ...] = ()
    skills: tuple[str, ...] = ()
    """What the task asks of an agent."""
    declines: bool = False
    """Whether nothing is to be done in this half."""
    scenario: str
    agent: str
    model: str
    geo: str
    seed: int
    repeat: int
    mode: str = Mode.PROMPTED
    parameters: Mapping[str, Any] | None = None
    """Drawn for this seed; None without a hand-over."""
    country: str = ""
    """At the hand-over; empty where no place is known."""
    success: bool | None = None
    """None without a verdict."""
    reward: float = 0.0
    end: str = "error"
    """Why it ended (``run.episode.End``)."""
    parts: Annotated[PartsHeld | None, InColumns("part")] = None
    goal_s: float | None = None
    """Seconds from the trigger since when the goal held to the end."""
    reason_fits: bool | None = None
    """For a declined task, whether the reason code fits."""
    alerts: int | None = None
    """Given to the driver by the agent."""
    steps: int = 0
    sim_seconds: float = 0.0
    """From the hand-over to the end."""
    speed_compliance: float | None = None
    """From 1 without overspeed to 0; None where no limit is posted."""
    min_time_to_collision_s: float | None = None
    drive: Annotated[DriveFigures | None, InColumns("drive")] = None
    """Of a judged safety task."""
    baseline_drive: Annotated[
        DriveFigures | None, InColumns("baseline_drive"), formerly("untouched_drive", "baseline_drive")
    ] = None
    """Of the baseline run over the same time."""
    interaction_s: float | None = None
    """The driver's, while the car moved."""
    within_guideline: bool | None = None
    """Whether what it asked of the driver is within NHTSA's 2 s a glance and 12 s in all."""
    prompt_tokens: tuple[int, ...] = ()
    """Of each call of the model."""
    tokens_in: int = 0
    tokens_out: int = 0
    cost_usd: float = 0.0
    held_out: bool = False
    """Whether the driver's phrasing is one that the rule model was not made on."""
    trace_sha256: str | None = None
    model_seconds: Volatile[float] = 0.0
    """Waited for the model."""

    @property
    def has_succeeded(self) -> bool:
        """Whether it was judged a success."""
        return self.success is True

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of the parts of the verdict that do not hold."""
        return self.parts.missing if self.parts else ()
