"""Which of an agent's trials speak for which row of a protocol, and which limits it told, when, how far off."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib.resources import files
from itertools import pairwise
from pathlib import Path

from automotive_cosim.contracts import KMH_PER_MPS, ActionType, AlertKind, Json
from automotive_cosim.drives.judge import EventOutcome
from automotive_cosim.errors import UserError
from automotive_cosim.formats.toml import read_toml
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow
from automotive_cosim.run.store import read_trace
from automotive_cosim.safety.dossier.subject import Subject
from automotive_cosim.tasking.checks import AlertGiven, AnyOf, Check
from automotive_cosim.tasking.task import Dimension
from automotive_cosim.tasks import CATALOGUE

EQUAL_KMH = 1.0
"""A speed told is the limit's within this (Regulation (EU) 2021/1958, annex I: equal up to 1.0 km/h)."""
SOON_S = 3.0
"""A limit is told in time until then: 2 s after the sign (2021/1958, annex I), and a second in which it is read."""
SHARE = 0.9
"""Of the distance, told rightly (2021/1958, annex I)."""


@dataclass(frozen=True, slots=True)
class LimitTold:
    """One limit that began to hold, and what the driver was told of it."""

    trial: str
    country: str
    at_s: float
    """Since departure, or since the hand-over of a task, when it held already."""
    limit_kmh: float
    told_kmh: float | None
    """The first speed told while it held; None if none was."""
    after_s: float | None = None
    after_m: float | None = None
    """How long after, and how far beyond, the first right speed was told; None if none was."""

    @property
    def off_kmh(self) -> float | None:
        """What was told, less what held."""
        return None if self.told_kmh is None else self.told_kmh - self.limit_kmh

    @property
    def in_time(self) -> bool:
        """Whether the right one was told soon enough."""
        return self.after_s is not None and self.after_s <= SOON_S


@dataclass(frozen=True, slots=True)
class DriveTold:
    """A drive on which limits were told."""

    trial: str
    country: str
    limits: tuple[LimitTold, ...]
    share: float
    """Of the distance on which some limit held, where the last one told was right."""


def limits_told(subject: Subject) -> tuple[list[DriveTold], list[LimitTold]]:
    """The drives, and the tasks that ask for a limit; trials in which no speed was told, and without a trace, are
    left out."""
    drives, tasks = [], []
    for row in subject.judged:
        try:
            *steps, last = read_trace(subject.results.folder, row.id)
        except UserError:
            continue
        told = [(step["time_s"], speed) for step in steps if (speed := _speed(step.get("action"))) is not None]
        if told and isinstance(row, DriveTrialRow):
            drives.append(told_on(row, told, last["result"]["timeline"]))
        elif told and isinstance(row, EpisodeRow) and (right := _asked(row)) is not None:
            begun, at = steps[0], next(step for step in steps if _speed(step.get("action")) is not None)
            after_s = at["time_s"] - begun["time_s"]
            after_m = at["traffic"]["distance_m"] - begun["traffic"]["distance_m"]
            is_right = abs(told[0][1] - right) < EQUAL_KMH
            when = (after_s, after_m) if is_right else (None, None)
            tasks.append(LimitTold(row.id, row.country, 0.0, right, told[0][1], *when))
    return drives, tasks


def _speed(action: Json | None) -> float | None:
    """The speed that an action tells, in km/h."""
    if (
        action is None
        or action.get("action_type") != ActionType.SHOW_ALERT
        or action.get("kind") != AlertKind.SPEED
    ):
        return None
    return action.get("speed_kmh")


def _asked(row: EpisodeRow) -> float | None:
    """The limit that a task's half asks to be told, in km/h; None if it asks for none."""

    def speeds(check: Check) -> Iterator[float]:
        if isinstance(check, AlertGiven) and isinstance(check.speed_kmh, int | float):
            yield check.speed_kmh
        elif isinstance(check, AnyOf):
            for each in check.checks:
                yield from speeds(each)

    return next(speeds(CATALOGUE[row.task].half(row.half).goal), None) if row.task in CATALOGUE else None


def told_on(row: DriveTrialRow, told: Sequence[tuple[float, float]], timeline: Json) -> DriveTold:
    """What was told on a drive.

    Args:
        told: times since departure, in seconds, and speeds told then, in km/h.
    """
    times, limits, speeds = (timeline[name] for name in ("time_s", "limit_kmh", "speed_kmh"))
    metres, gone_m = [0.0], 0.0
    for (before_s, now_s), kmh in zip(pairwise(times), speeds[1:], strict=True):
        gone_m += kmh / KMH_PER_MPS * (now_s - before_s)
        metres.append(gone_m)
    right_m = held_m = 0.0
    for number in range(1, len(times)):
        if (limit := limits[number]) is not None:
            last = next((speed for at_s, speed in reversed(told) if at_s <= times[number]), None)
            step_m = metres[number] - metres[number - 1]
            held_m += step_m
            right_m += step_m * (last is not None and abs(last - limit) < EQUAL_KMH)
    starts = [number for number in range(len(times)) if number == 0 or limits[number] != limits[number - 1]]
    made = []
    for start, end in pairwise((*starts, len(times))):
        if limits[start] is None:
            continue
        until_s = times[end] if end < len(times) else float("inf")
        here = [(at_s, speed) for at_s, speed in told if times[start] <= at_s < until_s]
        right_s = next((at_s for at_s, speed in here if abs(speed - limits[start]) < EQUAL_KMH), None)
        when: tuple[float | None, float | None] = (None, None)
        if right_s is not None:
            there = max(number for number in range(start, end) if times[number] <= right_s)
            when = right_s - times[start], metres[there] - metres[start]
        first = here[0][1] if here else None
        made.append(LimitTold(row.id, row.country, times[start], limits[start], first, *when))
    return DriveTold(row.id, row.country, tuple(made), right_m / held_m if held_m else 0.0)


PARTS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "accuracy": ("Speed limits told: accuracy", ("SLIF - Accuracy",)),
    "limits": ("Speed limits told: conditional, implicit and dynamic", ("SLIF - Advanced speed limit",)),
    "hazards": ("Speed limits told: hazards ahead", ("SLIF - Local hazards",)),
    "controls": ("General vehicle controls", ("Driving", "Comfort & infotainment")),
    "monitoring": ("Driver monitoring", ()),
}
"""Parts of the protocol that trials can say something about, in words, and the calculator's categories of them; it
scores the monitoring of a driver by where a person on test looks, which no trial has."""


@dataclass(frozen=True, slots=True)
class ProtocolRow:
    """A row of the calculator, and what counts as evidence for it."""

    part: str
    name: str
    scored: str = ""
    """The row of the calculator that has its points; empty if that has its name."""
    tasks: tuple[str, ...] = ()
    """Globs of ids."""
    events: tuple[str, ...] = ()
    """Globs of ``kind: words`` of the events of drives."""
    drives: tuple[str, ...] = ()
    """Globs of families whose drives have such events."""
    stages: tuple[str, ...] = ()
    """What ``stage`` of a drive brings them about on any network, with a trailer where it says so."""
    lacks: str = ""
    """What no trial shows."""

    @property
    def points_of(self) -> str:
        """The calculator's name for what has the points."""
        return self.scored or (f"{self.name} - Receiving & informing" if self.part == "hazards" else self.name)

    @property
    def tried_by(self) -> str:
        """What tries it, in words; empty if nothing does."""
        named = (("tasks", self.tasks), ("drives", self.drives), ("stage", self.stages))
        return "; ".join(f"{kind} {', '.join(names)}" for kind, names in named if names)


@dataclass(frozen=True, slots=True)
class Protocol:
    """A protocol as its file has it."""

    package: str
    version: str
    sha256: str
    countries: Mapping[str, str]
    """The calculator's names of countries, by ISO code."""
    rows: tuple[ProtocolRow, ...]


@dataclass(frozen=True, slots=True)
class ProtocolTrial:
    """One success or failure, of a trial or of an event of it."""

    id: str
    country: str
    ok: bool


@dataclass(frozen=True, slots=True)
class Evidence:
    """The trials behind a row."""

    row: ProtocolRow
    trials: tuple[ProtocolTrial, ...]

    @property
    def holds(self) -> bool | None:
        """Whether every trial succeeded; None without any."""
        return all(each.ok for each in self.trials) if self.trials else None

    @property
    def succeeded(self) -> int:
        """How many did."""
        return sum(each.ok for each in self.trials)

    @property
    def by_country(self) -> Mapping[str, Evidence]:
        """The same, country by country; an unknown country is the empty one."""
        found = defaultdict(list)
        for each in self.trials:
            found[each.country].append(each)
        return {country: Evidence(self.row, tuple(trials)) for country, trials in sorted(found.items())}


NAMES = {"euroncap-2026": "euroncap_2026.toml"}
"""Protocols, and their files."""


def protocol(name: str) -> Protocol:
    """A protocol by its name. Raises UserError: there is none of that name."""
    if name not in NAMES:
        raise UserError(f"no protocol {name!r}; choose {', '.join(NAMES)}")
    return read_toml(Path(str(files("automotive_cosim.safety.protocol").joinpath(NAMES[name])))).read(Protocol)


def evidence(made: Protocol, subject: Subject, drives: Sequence[DriveTold] = ()) -> list[Evidence]:
    """What speaks for each row, in the order of the protocol's file.

    Args:
        drives: on which limits were told; the accuracy's rows are about these.
    """
    told = {
        "Distance based": tuple(ProtocolTrial(each.trial, each.country, each.share >= SHARE) for each in drives),
        "Event based": tuple(
            ProtocolTrial(each.trial, each.country, each.in_time) for drive in drives for each in drive.limits
        ),
    }
    return [
        Evidence(row, told[row.name] if row.part == "accuracy" else tuple(_trials(row, subject)))
        for row in made.rows
    ]


def _trials(row: ProtocolRow, subject: Subject) -> Iterator[ProtocolTrial]:
    for trial in subject.judged:
        if isinstance(trial, DriveTrialRow):
            yield from _events(row, trial)
        elif isinstance(trial, EpisodeRow) and _is_about(row, trial):
            yield ProtocolTrial(trial.id, trial.country, trial.has_succeeded)


def _is_about(row: ProtocolRow, trial: EpisodeRow) -> bool:
    """Whether a task is one of the row's; of the controls, only what was asked for in so many words counts."""
    if row.part == "controls" and trial.dimension is not Dimension.EXPLICIT_CONTROL:
        return False
    return any(fnmatchcase(trial.task, each) for each in row.tasks)


def _events(row: ProtocolRow, trial: DriveTrialRow) -> Iterator[ProtocolTrial]:
    """Events in which an act was due, and look-alikes, which have to be left alone."""
    for event in trial.events:
        counts = event.outcome.counts or event.outcome in (EventOutcome.AVOIDED, EventOutcome.TAKEN)
        if counts and any(fnmatchcase(f"{event.kind}: {event.words}", each) for each in row.events):
            ok = event.outcome.is_credited or event.outcome is EventOutcome.AVOIDED
            yield ProtocolTrial(trial.id, trial.country, ok)
