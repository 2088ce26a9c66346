"""What an event is: what a kind finds at one instant, and which acts settle it.

    observable  the first instant at which what is needed stands in a channel that an agent is given
    obliged     the rule's predicate has held for its time
    deadline    the last instant at which an act still helps
    ends        the last instant at which it was there

An event is found on the drive itself, from its moments; nothing of how the drive was staged is read.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from automotive_cosim.contracts import AlertKind, Cruise, PullOver, RoadRequest, Severity, SlowDown
from automotive_cosim.cosim.moment import Moment

MOST_QUOTED = 60
"""Characters of what an act says that reports show."""
Wanted = Callable[[Any], bool]
"""Whether a value written to a signal settles an event."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """What a kind of event finds at one instant."""

    words: str
    """What there is, for reports."""
    subject: str = ""
    """Tells one occurrence of a kind from another, e.g. the limit that is exceeded."""
    due: bool = False
    """Whether something ought to be done now."""
    hold_s: float = 0.0
    """How long it must have been due until it is an obligation."""
    lookalike: bool = False
    """Whether it only looks like an event: here no act is right."""
    severity: float = 1.0
    """How bad it is, 1 at the threshold; a repeated alert is right once it has risen."""
    left_s: float | None = None
    """Seconds until it is too late; None leaves that to the kind's ``grace_s``."""
    value: float | None = None
    """What an act is measured against, e.g. the limit in km/h."""
    done_s: float | None = None
    """Since when what was asked for is done, for a kind that is judged ``by_state``."""


@dataclass(frozen=True, slots=True)
class DriveAct:
    """Something that an agent did and that reaches the driver, the car or the road."""

    time_s: float
    """Simulation time."""
    alert: AlertKind | None = None
    severity: Severity = Severity.WARNING
    speed_kmh: float | None = None
    """The speed that the alert advises; None means the limit."""
    requests: tuple[RoadRequest, ...] = ()
    """What it asked of the driver or the router, other than the alert."""
    writes: tuple[tuple[str, Any], ...] = ()
    """Signals and app data that it commanded, with their values; None for app data."""
    said: str = ""
    """Words spoken to the driver."""
    text: str = ""
    """Words that stand with the alert."""
    releases: bool = False
    """Whether it only takes back what the driver was asked or advised."""

    @property
    def holds_back(self) -> bool:
        """Whether it makes the car stop or drive slowly, or tells the driver to."""
        if self.releases:
            return False
        slows = any(isinstance(request, SlowDown | PullOver | Cruise) for request in self.requests)
        return slows or (self.alert is not None and self.speed_kmh is not None) or self.stops

    @property
    def stops(self) -> bool:
        """Whether it makes the car stop."""
        is_red = self.alert is AlertKind.VEHICLE and self.severity is Severity.CRITICAL
        return is_red or any(isinstance(request, PullOver) for request in self.requests)

    @property
    def words(self) -> str:
        if self.alert is not None:
            speed = "" if self.speed_kmh is None else f", {self.speed_kmh:.0f} km/h"
            severity = "" if self.severity is Severity.WARNING else f", {self.severity}"
            return f"alert {self.alert}{speed}{severity}{_quoted(': ', self.text)}"
        if self.requests:
            return ", ".join(type(request).__name__ for request in self.requests)
        if self.writes:
            return ", ".join(_written(path, value) for path, value in self.writes)
        return "said" + (_quoted(" ", self.said) or " nothing")


class Measured(str):
    """A fact that speaks against a warning by a measure alone: who was told no threshold may see it otherwise."""

    __slots__ = ()


class EventKind(ABC):
    """One kind of event. An instance has no state: everything comes from the moments."""

    name: ClassVar[str]
    about: ClassVar[str]
    """What is due and why, in one sentence."""
    lookalike: ClassVar[str]
    """What looks like it, in a few words."""
    source: ClassVar[str]
    """Where the times come from."""
    weight: ClassVar[float] = 1.0
    """Worth of one event of this kind: 2 where somebody may be hurt within seconds, 0.5 for advice."""
    grace_s: ClassVar[float] = 10.0
    """Seconds from obligation to deadline, if no sighting says how long is left."""
    alerts: ClassVar[frozenset[AlertKind]]
    """Kinds of alerts that settle it."""
    requests: ClassVar[tuple[type, ...]] = ()
    """Requests to the road that settle it, whatever they say."""
    says: ClassVar[tuple[str, ...]] = ()
    """Words one of which must be in what is said to the driver for that to settle it; none if saying never does."""
    writes: ClassVar[Mapping[str, Wanted]] = {}
    """Signals that settle it, by path, and which values do."""
    lasts_s: ClassVar[float] = 60.0
    """For how long before the obligation a warning prepares for it: a driver remembers for a minute, and what comes
    slowly for longer."""
    by_state: ClassVar[bool] = False
    """Whether the state that the car reaches settles it, and not an act by itself."""
    eases: ClassVar[bool] = False
    """Whether it has passed by itself if in the end it only looks like one."""
    told_by: ClassVar[tuple[str, ...]]
    """Names of the readings (``changes.WAKES``) that tell of it, and of what speaks against a warning of it; the
    context states the rules."""
    neutral: ClassVar[str]
    """What makes a warning true although nothing is due, so that it costs nothing."""

    is_due_ever: ClassVar[bool] = True
    """Whether an act is ever due; if not, the kind only says what acts are true."""

    @abstractmethod
    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """What there is at the last moment of a drive; at most one sighting per subject."""
        ...

    @abstractmethod
    def against(self, drive: Sequence[Moment]) -> str | None:
        """The fact, known to the agent at the last moment of a drive, that speaks against a warning of this kind;
        None if none does. ``speaks_against`` asks only while nothing is sighted."""
        ...

    def speaks_against(self, drive: Sequence[Moment]) -> str | None:
        """The fact that speaks against a warning of this kind at the last moment of a drive.

        None if it is true: something of the kind is there, comes, or may be there for all that is known.
        """
        if any(not sighting.lookalike for sighting in self.sight(drive)):
            return None
        return self.against(drive)

    def settles(self, act: DriveAct, value: float | None) -> bool:
        """Whether an act is one that is right for an event.

        Args:
            value: the event's ``Sighting.value``.
        """
        if act.alert is not None:
            return act.alert in self.alerts
        if any(isinstance(request, self.requests) for request in act.requests):
            return True
        if act.said:
            return any(word in act.said.casefold() for word in self.says)
        return any(path in self.writes and self.writes[path](written) for path, written in act.writes)

    def concerns(self, act: DriveAct) -> bool:
        """Whether an act touches what the kind is about, rightly or not."""
        return any(path in self.writes for path, _ in act.writes)


def _quoted(before: str, words: str) -> str:
    """Words in quotation marks, as far as a line has room."""
    line = " ".join(words.split())
    short = line if len(line) <= MOST_QUOTED else f"{line[: MOST_QUOTED - 1]}…"
    return f'{before}"{short}"' if short else ""


def _written(path: str, value: Any) -> str:
    return path.removeprefix("Vehicle.") + ("" if value is None else f" = {value}")


def on(value: Any) -> bool:
    """A switch that is on."""
    return value is True


def off(value: Any) -> bool:
    """A switch that is off."""
    return value is False
