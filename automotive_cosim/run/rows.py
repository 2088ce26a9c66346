"""The rows of an evaluation: what those of all trials share, then an episode's, a drive's and a fleet's."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Annotated, Any

from automotive_cosim.drives.elsewhere import name_of
from automotive_cosim.drives.harm import Harm
from automotive_cosim.drives.judge import JudgedAct, JudgedEvent
from automotive_cosim.drives.score import Score
from automotive_cosim.drives.settings import AS_SCRIPTED, DriveSettings
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import NoRoomError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.measures.exposure import ExposureCell
from automotive_cosim.measures.following import FollowingFigures
from automotive_cosim.run.figures import DriveFigures, PixelTaps
from automotive_cosim.run.job_row import InColumns, JobRow, Volatile
from automotive_cosim.run.store import read_rows
from automotive_cosim.tasking.policy import Breach
from automotive_cosim.tasking.sets import Split, Suite
from automotive_cosim.tasking.task import Ability, Basis, Dimension, Module
from automotive_cosim.tasking.verdict import Verdict


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


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveTrialRow(TrialRow):
    """One drive. Times of events and acts are seconds since departure."""

    family: str
    """Family of drives that it was drawn from."""
    season: str
    country: str = ""
    """Country at departure; empty if the place is unknown, and in earlier rows."""
    settings: Annotated[DriveSettings, InColumns("set")] = AS_SCRIPTED
    """What was set otherwise than the family's script has it."""
    car: int = 0
    """Its number in its fleet, to which also its seed has been counted."""
    score: Annotated[Score | None, InColumns("score")] = None
    """None without a judgement."""
    value: float | None = None
    """The headline figure: 0 is doing nothing, 100 is the rule-perfect watcher."""
    harm: Annotated[Harm | None, InColumns("harm")] = None
    baseline_harm: Annotated[Harm | None, InColumns("baseline_harm")] = None
    """The same for the do-nothing run."""
    distraction_s: float = 0.0
    """Seconds for which messages took the driver's eyes off the road."""
    events: tuple[JudgedEvent, ...] = ()
    acts: tuple[JudgedAct, ...] = ()
    unwatched_from_s: float | None = None
    """From when nobody watched: the agent had failed or spent its budget. None if somebody did to the end."""
    waits: int = 0
    wakes: int = 0
    """Waits and acts after which something had changed."""
    calls: int = 0
    """Answers of the model."""
    channels: tuple[Channel, ...] = ()
    """What the agent was given; the answers to its queries depend on it."""

    @property
    def subject(self) -> str:
        return self.family

    @property
    def name(self) -> str:
        """What people call it: the family, or its month on other roads than its own, ``heidelberg_january``."""
        return name_of(self.family, self.scenario)

    @property
    def instance(self) -> tuple[Hashable, ...]:
        """What two contestants must share to be compared."""
        return self.family, self.scenario, self.settings, self.seed, self.repeat, self.car

    @property
    def outcome(self) -> bool | None:
        """Whether every event was met and nothing was a nuisance; None without a judgement."""
        return None if self.score is None else self.score.met == self.score.events and not self.score.nuisances

    @property
    def has_nothing_due(self) -> bool:
        """Whether nothing required an act and the agent did nothing wrong: it says nothing about the agent."""
        return self.score is not None and not self.score.events and not self.score.nuisances

    @property
    def missing(self) -> tuple[str, ...]:
        """Events that were not met, and whether something was a nuisance."""
        if self.score is None:
            return ()
        lost = [event.kind for event in self.events if event.outcome.counts and not event.outcome.is_credited]
        return (*dict.fromkeys(lost), *(["nuisances"] if self.score.nuisances else []))


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetRow(DriveTrialRow):
    """What a fleet comes to: the row of its first car, and those of all, which are what is stored."""

    cars: Sequence[TrialRow]

    @classmethod
    def of(cls, cars: Sequence[TrialRow]) -> FleetRow:
        """That of a fleet; its error is the first that may not recur."""
        first = {each.name: getattr(cars[0], each.name) for each in fields(DriveTrialRow)}
        failed = ((each.error, each.error_kind) for each in cars if each.error is not None)
        why, kind = next((each for each in failed if each[1] != NoRoomError.__name__), (None, None))
        return cls(**first | {"cars": cars, "error": why, "error_kind": kind})

    @property
    def stored(self) -> Sequence[TrialRow]:
        """The cars' rows, each with its part of the wall time."""
        took_s, tries, failed = self.wall_seconds / len(self.cars), self.attempts, self.failed_attempts
        return [
            replace(each, wall_seconds=took_s, attempts=tries, failed_attempts=failed)
            for each in reversed(self.cars)
        ]

    @property
    def has_succeeded(self) -> bool:
        return all(each.has_succeeded for each in self.cars)


def kind_of(line: bytes) -> type[TrialRow]:
    """The kind of row in a line: only a drive has a family."""
    return DriveTrialRow if b'"family":' in line else EpisodeRow


def read_trials(folder: Path) -> dict[str, TrialRow]:
    """The newest row of each trial by its id, as ``store.read_rows``. Raises UserError: a line cannot be read."""
    return read_rows(folder, kind_of)
