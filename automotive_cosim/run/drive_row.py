"""The row of a drive, from which its report is made."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Annotated

from automotive_cosim.drives.elsewhere import name_of
from automotive_cosim.drives.harm import Harm
from automotive_cosim.drives.judge import JudgedAct, JudgedEvent
from automotive_cosim.drives.score import Score
from automotive_cosim.drives.settings import AS_SCRIPTED, DriveSettings
from automotive_cosim.errors import NoRoomError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.run.row import InColumns
from automotive_cosim.run.trial_row import TrialRow


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
