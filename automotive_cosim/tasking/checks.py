"""Checks: goals as predicates on the state, without effects.

A ``Check`` judges the outcome of the situation that a trigger (``triggers``) started. Each is a frozen dataclass,
so it can be compared and stored; ``str`` describes it in words. Values may be parameters until they are bound.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from automotive_cosim.cockpit.apps.vehicle.state import REMEMBERED
from automotive_cosim.cockpit.signals import CABIN, HVAC, MEDIA, Signal
from automotive_cosim.contracts import KMH_PER_MPS, AlertKind, PullOver, Reroute, RoadRequest, SlowDown
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.dialogue import Topic, questions


class Check(Protocol):
    """A goal: a pure predicate over the start, the present and what happened in between."""

    @property
    def writes(self) -> frozenset[str]:
        """Keys of ``Moment.commands`` that reaching the goal necessarily changes."""
        ...

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether the goal is reached. ``trace`` goes from the start to now, both included."""
        ...


NUMBER = re.compile(r"(\d+):(\d\d)|\d+(?:\.\d+)?")
"""A time of day or a number."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class _OfSignal(Generic[T]):
    """Common part of the checks of one signal."""

    signal: Signal[T]

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({self.signal.path})


@dataclass(frozen=True, slots=True)
class _OfData:
    """Common part of the checks of one entry of ``Moment.commands``."""

    key: str

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({self.key})


@dataclass(frozen=True, slots=True)
class SignalIs(_OfSignal[Any]):
    """A signal has one of these values."""

    values: tuple[Any, ...]

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return now.signals[self.signal.path] in self.values

    def __str__(self) -> str:
        return f"{self.signal} is {_either(self.values)}"


@dataclass(frozen=True, slots=True)
class SignalRaised(_OfSignal[float]):
    """A numeric signal is at least ``by`` above its value at the start."""

    by: float

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return float(now.signals[self.signal.path]) - float(start.signals[self.signal.path]) >= self.by

    def __str__(self) -> str:
        return f"{self.signal} raised by {self.by:g} or more"


@dataclass(frozen=True, slots=True)
class SignalLowered(_OfSignal[float]):
    """A numeric signal is at least ``by`` below its value at the start."""

    by: float

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return float(start.signals[self.signal.path]) - float(now.signals[self.signal.path]) >= self.by

    def __str__(self) -> str:
        return f"{self.signal} lowered by {self.by:g} or more"


@dataclass(frozen=True, slots=True)
class SignalWithin(_OfSignal[float]):
    """A numeric signal lies between two values, both included."""

    low: float
    high: float

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return self.low - 1e-9 <= float(now.signals[self.signal.path]) <= self.high + 1e-9

    def __str__(self) -> str:
        return f"{self.signal} from {self.low:g} to {self.high:g}"


@dataclass(frozen=True, slots=True)
class SignalChanged(_OfSignal[Any]):
    """A signal has any other value than at the start."""

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return bool(now.signals[self.signal.path] != start.signals[self.signal.path])

    def __str__(self) -> str:
        return f"{self.signal} is no longer what it was"


@dataclass(frozen=True, slots=True)
class AppDataIs(_OfData):
    """An entry of the apps' data (``State.commands``) has one of these values."""

    values: tuple[Any, ...]

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return now.commands[self.key] in self.values

    def __str__(self) -> str:
        return f"{self.key} is {_either(self.values)}"


@dataclass(frozen=True, slots=True)
class AppDataHas(_OfData):
    """A list of the apps' data contains that entry, or no longer does; the rest of it is unchanged."""

    entry: Any
    there: bool = True

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether the entry is there, or gone, and the rest is unchanged."""
        before, after = start.commands[self.key], now.commands[self.key]
        same = [entry for entry in before if entry != self.entry] == [
            entry for entry in after if entry != self.entry
        ]
        return same and (self.entry in after) is self.there

    def __str__(self) -> str:
        return f"{self.entry!r} {'among' if self.there else 'no longer among'} {self.key}"


@dataclass(frozen=True, slots=True)
class Filed(_OfData):
    """One of several named lists (playlists) contains that entry, or no longer does; the others are unchanged."""

    name: str
    entry: Any
    there: bool = True

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether the entry is there, or gone, and the rest is unchanged."""
        before, after = dict(start.commands[self.key]), dict(now.commands[self.key])
        was, is_now = before.pop(self.name, []), after.pop(self.name, [])
        same = [entry for entry in was if entry != self.entry] == [entry for entry in is_now if entry != self.entry]
        return before == after and same and (self.entry in is_now) is self.there

    def __str__(self) -> str:
        return f"{self.entry!r} {'among' if self.there else 'no longer among'} {self.key} {self.name}"


@dataclass(frozen=True, slots=True)
class Entered(_OfData):
    """Exactly one entry was added to a list that only grows (messages sent, calls, payments, memos), and with
    ``entry`` it is that one. If an entry is a mapping, only the fields named in ``entry`` count."""

    entry: Any = None

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        added = now.commands[self.key][len(start.commands[self.key]) :]
        if len(added) != 1 or self.entry is None:
            return len(added) == 1
        if isinstance(self.entry, dict):
            return all(added[0].get(name) == value for name, value in self.entry.items())
        return bool(added[0] == self.entry)

    def __str__(self) -> str:
        return f"one entry added to {self.key}" + ("" if self.entry is None else f": {self.entry!r}")


@dataclass(frozen=True, slots=True)
class EnteredOf(_OfData):
    """Exactly one entry was added to a list that only grows: the signal's value at the start, e.g. who rang."""

    signal: Signal[str]

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        added = now.commands[self.key][len(start.commands[self.key]) :]
        return bool(added == [start.signals[self.signal.path]])

    def __str__(self) -> str:
        return f"{self.signal}, as it was, added to {self.key}"


@dataclass(frozen=True, slots=True)
class Counted(_OfData):
    """A counter (horn, washer, trip.resets) is higher than at the start by a number."""

    by: int = 1

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return bool(now.commands[self.key] - start.commands[self.key] == self.by)

    def __str__(self) -> str:
        return f"{self.key} {self.by} higher"


@dataclass(frozen=True, slots=True)
class SeatRecalled:
    """Seat and mirrors stand as one of the driver's memories has them."""

    slot: int
    """Number of the memory, from 1."""

    @property
    def writes(self) -> frozenset[str]:
        return frozenset(signal.path for signal in REMEMBERED)

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return self.is_so(now, now)

    def is_so(self, memory: Moment, now: Moment) -> bool:
        """Whether everything stands as that memory had it at one moment."""
        stored = memory.commands["seat.memory"][self.slot - 1]
        return all(now.signals[signal.path] == value for signal, value in zip(REMEMBERED, stored, strict=True))

    def __str__(self) -> str:
        return f"seat and mirrors as in memory {self.slot}"


@dataclass(frozen=True, slots=True)
class EnteredAll(_OfData):
    """Exactly these entries were added to a list (messages sent, calls, saved places), in this order or in any."""

    entries: tuple[Any, ...]
    in_order: bool = False

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        added = list(now.commands[self.key][len(start.commands[self.key]) :])
        if self.in_order or len(added) != len(self.entries):
            return added == list(self.entries)
        return all(added.count(entry) == self.entries.count(entry) for entry in self.entries)

    def __str__(self) -> str:
        return f"added to {self.key}{', in this order' if self.in_order else ''}: {self.entries!r}"


@dataclass(frozen=True, slots=True)
class AppDataIncludes(_OfData):
    """A list of the apps' data (messages read) contains all of these entries, whatever else it contains."""

    entries: tuple[Any, ...]

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return all(entry in now.commands[self.key] for entry in self.entries)

    def __str__(self) -> str:
        return f"{' and '.join(map(repr, self.entries))} among {self.key}"


@dataclass(frozen=True, slots=True)
class SaysFigure:
    """Exactly one message was sent, to that person, with these words and one figure, to a tolerance."""

    to: str
    words: str
    """What the message has to contain besides, such as a unit."""
    figure: float
    """A number; for a time of day the minutes since midnight."""
    tolerance: float

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({"messages.sent"})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether that message is the only one since the start."""
        key = "messages.sent"
        added = now.commands[key][len(start.commands[key]) :]
        if len(added) != 1 or added[0]["to"] != self.to or self.words not in added[0]["text"]:
            return False
        said = NUMBER.search(added[0]["text"])
        return said is not None and abs(_value(said) - self.figure) <= self.tolerance + 1e-9

    def __str__(self) -> str:
        return f"a message to {self.to} with {self.figure} (to {self.tolerance:g}) and {self.words!r}"


@dataclass(frozen=True, slots=True)
class AppDataAt(_OfData):
    """One place of a list in the apps' data has a value; the others are unchanged."""

    place: int
    value: Any

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        wanted = list(start.commands[self.key])
        value = list(self.value) if isinstance(self.value, tuple) else self.value
        wanted[self.place] = {**wanted[self.place], **value} if isinstance(value, Mapping) else value
        return bool(now.commands[self.key] == wanted)

    def __str__(self) -> str:
        return f"entry {self.place + 1} of {self.key} is {self.value!r}"


@dataclass(frozen=True, slots=True)
class AppDataWithout(_OfData):
    """One place of a list in the apps' data is gone; the others are unchanged."""

    place: int

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        wanted = list(start.commands[self.key])
        del wanted[self.place]
        return bool(now.commands[self.key] == wanted)

    def __str__(self) -> str:
        return f"entry {self.place + 1} of {self.key} is gone"


@dataclass(frozen=True, slots=True)
class SeatAsStored(SeatRecalled):
    """Seat and mirrors stand as a memory place has them since the start."""

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return self.is_so(start, now)

    def __str__(self) -> str:
        return f"seat and mirrors as stored in place {self.slot}"


REQUEST_WORDS = {Reroute: "reroute", PullOver: "pull-over", SlowDown: "slow-down"}


@dataclass(frozen=True, slots=True)
class RoadAsked:
    """Exactly one irrevocable request was made to the road: ``Reroute``, ``PullOver``, ``SlowDown``."""

    request: type[RoadRequest] | RoadRequest
    """A class or an exact request: ``RoadAsked(Reroute)`` accepts any, ``RoadAsked(Reroute("A 4"))`` one."""

    @property
    def writes(self) -> frozenset[str]:
        """The key of the requests, and of the destination if one is asked for."""
        sets_out = isinstance(self.request, Reroute) and bool(self.request.destination)
        return frozenset({"requests", "navigation.destination"} if sets_out else {"requests"})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        asked = now.commands["requests"][len(start.commands["requests"]) :]
        if len(asked) != 1:
            return False
        return isinstance(asked[0], self.request) if isinstance(self.request, type) else asked[0] == self.request

    def __str__(self) -> str:
        if isinstance(self.request, Reroute) and self.request.destination:
            return f"exactly one reroute request, to {self.request.destination}"
        wanted = self.request if isinstance(self.request, type) else type(self.request)
        return f"exactly one {REQUEST_WORDS.get(wanted, wanted.__name__)} request"


@dataclass(frozen=True, slots=True)
class AskedFirst:
    """The driver was asked exactly once, before anything was changed, and the question names every alternative."""

    topic: Topic

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({"questions"})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether that was the only question, and came first."""
        asked = questions(start, now)
        if len(asked) != 1 or asked[0]["commands"]:
            return False
        return self.topic.named(asked[0]["text"]) == len(self.topic.choices)

    def __str__(self) -> str:
        return f"the driver asked once, and first, about {self.topic.name}"


QUIETING = frozenset(
    each.path
    for each in (
        CABIN.DRIVER_WINDOW,
        CABIN.PASSENGER_WINDOW,
        CABIN.REAR_LEFT_WINDOW,
        CABIN.REAR_RIGHT_WINDOW,
        CABIN.SUNROOF,
        HVAC.FAN_SPEED,
        MEDIA.ACTION,
        MEDIA.VOLUME,
        MEDIA.MUTED,
    )
)
"""What makes the cabin quieter, and may be changed before a question."""


@dataclass(frozen=True, slots=True)
class AskedBack:
    """The driver was asked about it, or to say it again, before anything but the noise was changed."""

    topic: Topic

    @property
    def writes(self) -> frozenset[str]:
        return frozenset()  # it may be asked again: the answer, too, has to be heard

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether the first moment after such a question is as the start but for the noise."""
        for count, asked in enumerate(questions(start, now), start=1):
            if self.topic.fits(asked["text"]):
                then = next(moment for moment in trace if len(questions(start, moment)) >= count)
                changed = {key for key, value in then.commands.items() if value != start.commands.get(key)}
                return changed <= QUIETING | {"questions"}
        return False

    def __str__(self) -> str:
        return f"the driver asked back about {self.topic.name}, before anything but the noise was changed"


@dataclass(frozen=True, slots=True)
class NotAsked:
    """The driver was not asked anything: what he wants can be found out."""

    @property
    def writes(self) -> frozenset[str]:
        return frozenset()

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return not questions(start, now)

    def __str__(self) -> str:
        return "the driver not asked"


def asked_in(check: Check) -> Iterator[Topic]:
    """The topics of a goal that the driver has to be asked about."""
    if isinstance(check, AskedFirst | AskedBack):
        yield check.topic
    for part in getattr(check, "checks", ()):
        yield from asked_in(part)


@dataclass(frozen=True, slots=True)
class AllOf:
    """All of the checks hold."""

    checks: tuple[Check, ...]

    @property
    def writes(self) -> frozenset[str]:
        return frozenset().union(*(check.writes for check in self.checks))

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return all(check.holds(start, now, trace) for check in self.checks)

    def __str__(self) -> str:
        return ", and ".join(map(str, self.checks))


@dataclass(frozen=True, slots=True)
class AlertGiven:
    """The driver was alerted of ``kind`` once; an advised speed, if any, is the given one, to 1 km/h.

    Without a given one, any speed up to a posted limit may be advised: a warning of something else may name it.
    """

    kind: AlertKind
    speed_kmh: float | None = None
    must_advise: bool = False
    """Whether the alert must name the speed, because no sign does."""

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({"alerts"})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether there was exactly one alert since the start, of this kind."""
        before = len(start.commands["alerts"])
        given = now.commands["alerts"][before:]
        if len(given) != 1 or given[0]["kind"] != self.kind:
            return False
        then = next((moment for moment in trace if len(moment.commands["alerts"]) > before), now)
        return self._advises(given[0]["speed_kmh"], then)

    def _advises(self, speed_kmh: float | None, then: Moment) -> bool:
        """Whether that speed was right when it was advised."""
        if speed_kmh is None:
            return not self.must_advise
        if self.speed_kmh is None:
            signed_mps = then.driving.road.limit.posted_mps
            return signed_mps is None or speed_kmh < signed_mps * KMH_PER_MPS + 1.0
        return abs(speed_kmh - self.speed_kmh) < 1.0

    def __str__(self) -> str:
        speed = "" if self.speed_kmh is None else f" (any advised speed must be {self.speed_kmh:g} km/h)"
        return f"exactly one {self.kind} alert{speed}"


@dataclass(frozen=True, slots=True)
class AnyOf:
    """At least one of the checks holds: several end states are right."""

    checks: tuple[Check, ...]

    @property
    def writes(self) -> frozenset[str]:
        return frozenset().union(*(check.writes for check in self.checks))

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return any(check.holds(start, now, trace) for check in self.checks)

    def __str__(self) -> str:
        return ", or ".join(map(str, self.checks))


@dataclass(frozen=True, slots=True)
class NothingDone:
    """The right act is to leave everything as it is; that nothing else changed is the verdict's *clean* part."""

    @property
    def writes(self) -> frozenset[str]:
        return frozenset()

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return True

    def __str__(self) -> str:
        return "nothing to do"


def _either(values: object) -> str:
    """The accepted values in words; before they are bound they may be one parameter."""
    return " or ".join(map(str, values)) if isinstance(values, tuple) else str(values)


def _value(said: re.Match[str]) -> float:
    hours, minutes = said.groups()
    return float(said[0]) if hours is None else 60.0 * int(hours) + int(minutes)
