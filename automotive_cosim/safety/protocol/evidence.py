"""Which of an agent's trials speak for which row of a protocol."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib.resources import files
from pathlib import Path

from automotive_cosim.drives.judge import EventOutcome
from automotive_cosim.errors import UserError
from automotive_cosim.formats.toml import read_toml
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow
from automotive_cosim.safety.dossier.subject import Subject
from automotive_cosim.safety.protocol.told import SHARE, DriveTold
from automotive_cosim.tasking.task import Dimension

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
