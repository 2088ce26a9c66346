"""Checks: goals as predicates on the state, without effects.

A ``Check`` judges the outcome of the situation that a trigger (``triggers``) started. It can be compared and
stored; ``str`` describes it in words. Values may be parameters until they are bound. A new one is a function, by
whose name tasks ask for it; those are classes that something else looks into.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Concatenate, ParamSpec, Protocol

from automotive_cosim.cockpit.apps.vehicle.state import REMEMBERED
from automotive_cosim.cockpit.signals import CABIN, HVAC, MEDIA, Signal
from automotive_cosim.contracts import KMH_PER_MPS, AlertKind, PullOver, Reroute, RoadRequest, SlowDown
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.dialogue import Topic, questions, untold
from automotive_cosim.tasking.named import ROWS, Named, Wording, keep


class Check(Protocol):
    """A goal: a pure predicate over the hand-over, the present and what happened in between."""

    @property
    def writes(self) -> frozenset[str]:
        """Keys of ``Moment.commands`` that reaching the goal necessarily changes."""
        ...

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether the goal is reached. ``trace`` goes from the hand-over to now, both included."""
        ...


NUMBER = re.compile(r"(\d+):(\d\d)|\d+(?:\.\d+)?")
"""A time of day or a number."""

P = ParamSpec("P")


@dataclass(frozen=True, slots=True)
class _OfSignal:
    """Common part of the checks of one signal."""

    signal: Signal[Any]

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({self.signal.path})


@dataclass(frozen=True, slots=True)
class NamedCheck(Named):
    """A check with its values."""

    @property
    def writes(self) -> frozenset[str]:
        return ROWS[self.name].writes(*self.values)

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return ROWS[self.name].holds(hand_over, now, trace, *self.values)


def _its_key(key: str, *others: object) -> frozenset[str]:
    return frozenset({key})


def _its_path(signal: Signal[Any], *others: object) -> frozenset[str]:
    return frozenset({signal.path})


def goal(
    words: Wording, writes: Callable[..., frozenset[str]] = _its_key
) -> Callable[[Callable[Concatenate[Moment, Moment, Sequence[Moment], P], bool]], Callable[P, NamedCheck]]:
    """Makes a check of a predicate, which then takes its values and gives the ``NamedCheck`` with them.

    Args:
        writes: of the values; without it, the first of them."""
    return lambda holds: keep(NamedCheck, holds, 3, words, writes)


@dataclass(frozen=True, slots=True)
class SignalIs(_OfSignal):
    """A signal has one of these values."""

    values: tuple[Any, ...]

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return now.signals[self.signal.path] in self.values

    def __str__(self) -> str:
        return f"{self.signal} is {_either(self.values)}"


@goal("{signal} raised by {by:g} or more", writes=_its_path)
def signal_raised(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], signal: Signal[float], by: float
) -> bool:
    """A numeric signal is at least ``by`` above its value at the hand-over."""
    return float(now.signals[signal.path]) - float(hand_over.signals[signal.path]) >= by


@goal("{signal} lowered by {by:g} or more", writes=_its_path)
def signal_lowered(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], signal: Signal[float], by: float
) -> bool:
    """A numeric signal is at least ``by`` below its value at the hand-over."""
    return float(hand_over.signals[signal.path]) - float(now.signals[signal.path]) >= by


@dataclass(frozen=True, slots=True)
class SignalWithin(_OfSignal):
    """A numeric signal lies between two values, both included."""

    low: float
    high: float

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return self.low - 1e-9 <= float(now.signals[self.signal.path]) <= self.high + 1e-9

    def __str__(self) -> str:
        return f"{self.signal} from {self.low:g} to {self.high:g}"


@goal("{signal} is no longer what it was", writes=_its_path)
def signal_changed(hand_over: Moment, now: Moment, trace: Sequence[Moment], signal: Signal[Any]) -> bool:
    """A signal has any other value than at the hand-over."""
    return bool(now.signals[signal.path] != hand_over.signals[signal.path])


@dataclass(frozen=True, slots=True)
class AppDataIs:
    """An entry of the apps' data (``State.commands``) has one of these values."""

    key: str
    values: tuple[Any, ...]

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({self.key})

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return now.commands[self.key] in self.values

    def __str__(self) -> str:
        return f"{self.key} is {_either(self.values)}"


@goal(lambda key, entry, there: f"{entry!r} {'among' if there else 'no longer among'} {key}")
def app_data_has(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, entry: Any, there: bool = True
) -> bool:
    """A list of the apps' data contains that entry, or no longer does; the rest of it is unchanged."""
    before, after = hand_over.commands[key], now.commands[key]
    same = [each for each in before if each != entry] == [each for each in after if each != entry]
    return same and (entry in after) is there


@goal(lambda key, name, entry, there: f"{entry!r} {'among' if there else 'no longer among'} {key} {name}")
def filed(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, name: str, entry: Any, there: bool = True
) -> bool:
    """One of several named lists (playlists) contains that entry, or no longer does; the others are unchanged."""
    before, after = dict(hand_over.commands[key]), dict(now.commands[key])
    was, is_now = before.pop(name, []), after.pop(name, [])
    same = [each for each in was if each != entry] == [each for each in is_now if each != entry]
    return before == after and same and (entry in is_now) is there


@goal(lambda key, entry: f"one entry added to {key}" + ("" if entry is None else f": {entry!r}"))
def entered(hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, entry: Any = None) -> bool:
    """Exactly one entry was added to a list that only grows (messages sent, calls, payments, memos), and with
    ``entry`` it is that one. If an entry is a mapping, only the fields named in ``entry`` count."""
    added = now.commands[key][len(hand_over.commands[key]) :]
    if len(added) != 1 or entry is None:
        return len(added) == 1
    if isinstance(entry, dict):
        return all(added[0].get(name) == value for name, value in entry.items())
    return bool(added[0] == entry)


@goal("{signal}, as it was, added to {key}")
def entered_of(hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, signal: Signal[str]) -> bool:
    """Exactly one entry was added to a list that only grows: the signal's value at the hand-over, e.g. who rang."""
    added = now.commands[key][len(hand_over.commands[key]) :]
    return bool(added == [hand_over.signals[signal.path]])


@goal("{key} {by} higher")
def counted(hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, by: int = 1) -> bool:
    """A counter (horn, washer, trip.resets) is higher than at the hand-over by a number."""
    return bool(now.commands[key] - hand_over.commands[key] == by)


def _as_in_memory(memory: Moment, now: Moment, slot: int) -> bool:
    """Whether everything stands as that memory had it at one moment."""
    stored = memory.commands["seat.memory"][slot - 1]
    return all(now.signals[signal.path] == value for signal, value in zip(REMEMBERED, stored, strict=True))


def _remembered(slot: int) -> frozenset[str]:
    return frozenset(signal.path for signal in REMEMBERED)


@goal("seat and mirrors as in memory {slot}", writes=_remembered)
def seat_recalled(hand_over: Moment, now: Moment, trace: Sequence[Moment], slot: int) -> bool:
    """Seat and mirrors stand as one of the driver's memories has them.

    Args:
        slot: number of the memory, from 1."""
    return _as_in_memory(now, now, slot)


@goal(lambda key, entries, in_order: f"added to {key}{', in this order' if in_order else ''}: {entries!r}")
def entered_all(
    hand_over: Moment,
    now: Moment,
    trace: Sequence[Moment],
    key: str,
    entries: tuple[Any, ...],
    in_order: bool = False,
) -> bool:
    """Exactly these entries were added to a list (messages sent, calls, saved places), in this order or in any."""
    added = list(now.commands[key][len(hand_over.commands[key]) :])
    if in_order or len(added) != len(entries):
        return added == list(entries)
    return all(added.count(entry) == entries.count(entry) for entry in entries)


@goal(lambda key, entries: f"{' and '.join(map(repr, entries))} among {key}")
def app_data_includes(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, entries: tuple[Any, ...]
) -> bool:
    """A list of the apps' data (messages read) contains all of these entries, whatever else it contains."""
    return all(entry in now.commands[key] for entry in entries)


@goal(
    "a message to {to} with {figure} (to {tolerance:g}) and {words!r}",
    writes=lambda *values: frozenset({"messages.sent"}),
)
def says_figure(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], to: str, words: str, figure: float, tolerance: float
) -> bool:
    """Exactly one message was sent, to that person, with these words and one figure, to a tolerance.

    Args:
        words: what the message has to contain besides, such as a unit.
        figure: a number; for a time of day the minutes since midnight."""
    key = "messages.sent"
    added = now.commands[key][len(hand_over.commands[key]) :]
    if len(added) != 1 or added[0]["to"] != to or words not in added[0]["text"]:
        return False
    said = NUMBER.search(added[0]["text"])
    return said is not None and abs(_value(said) - figure) <= tolerance + 1e-9


@goal(
    "a message to {to} that says {tells}, and nothing of {without}",
    writes=lambda *values: frozenset({"messages.sent"}),
)
def wrote(
    hand_over: Moment,
    now: Moment,
    trace: Sequence[Moment],
    to: str,
    tells: tuple[tuple[str, ...], ...],
    without: tuple[str, ...] = (),
) -> bool:
    """Exactly one message was sent, to that person, in whatever words.

    Args:
        tells: what it has to say, each by any of its words or phrases.
        without: what it must not mention."""
    key = "messages.sent"
    added = now.commands[key][len(hand_over.commands[key]) :]
    if len(added) != 1 or added[0]["to"] != to:
        return False
    text, unsaid = [added[0]["text"]], tuple((word,) for word in without)
    return not untold(text, tells) and untold(text, unsaid) == unsaid


@goal(lambda key, place, value: f"entry {place + 1} of {key} is {value!r}")
def app_data_at(hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, place: int, value: Any) -> bool:
    """One place of a list in the apps' data has a value; the others are unchanged."""
    wanted = list(hand_over.commands[key])
    value = list(value) if isinstance(value, tuple) else value
    wanted[place] = {**wanted[place], **value} if isinstance(value, Mapping) else value
    return bool(now.commands[key] == wanted)


@goal(lambda key, place: f"entry {place + 1} of {key} is gone")
def app_data_without(hand_over: Moment, now: Moment, trace: Sequence[Moment], key: str, place: int) -> bool:
    """One place of a list in the apps' data is gone; the others are unchanged."""
    wanted = list(hand_over.commands[key])
    del wanted[place]
    return bool(now.commands[key] == wanted)


@goal("seat and mirrors as stored in place {slot}", writes=_remembered)
def seat_as_stored(hand_over: Moment, now: Moment, trace: Sequence[Moment], slot: int) -> bool:
    """Seat and mirrors stand as a memory place has them since the hand-over."""
    return _as_in_memory(hand_over, now, slot)


REQUEST_WORDS = {Reroute: "reroute", PullOver: "pull-over", SlowDown: "slow-down"}


def _road_asked(request: type[RoadRequest] | RoadRequest) -> str:
    if isinstance(request, Reroute) and request.destination:
        return f"exactly one reroute request, to {request.destination}"
    wanted = request if isinstance(request, type) else type(request)
    return f"exactly one {REQUEST_WORDS.get(wanted, wanted.__name__)} request"


def _road_asked_writes(request: type[RoadRequest] | RoadRequest) -> frozenset[str]:
    sets_out = isinstance(request, Reroute) and bool(request.destination)
    return frozenset({"requests", "navigation.destination"} if sets_out else {"requests"})


@goal(_road_asked, writes=_road_asked_writes)
def road_asked(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], request: type[RoadRequest] | RoadRequest
) -> bool:
    """Exactly one irrevocable request was made to the road: ``Reroute``, ``PullOver``, ``SlowDown``.

    Args:
        request: a class or an exact request: ``road_asked(Reroute)`` accepts any, ``road_asked(Reroute("A 4"))``
            that one."""
    asked = now.commands["requests"][len(hand_over.commands["requests"]) :]
    if len(asked) != 1:
        return False
    return isinstance(asked[0], request) if isinstance(request, type) else asked[0] == request


@goal("the driver asked once, and first, about {topic.name}", writes=lambda topic: frozenset({"questions"}))
def asked_first(hand_over: Moment, now: Moment, trace: Sequence[Moment], topic: Topic) -> bool:
    """The driver was asked exactly once, before anything was changed, and the question names every alternative."""
    asked = questions(hand_over, now)
    if len(asked) != 1 or asked[0]["commands"]:
        return False
    return topic.named(asked[0]["text"]) == len(topic.choices)


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


@goal(
    "the driver asked back about {topic.name}, before anything but the noise was changed",
    writes=lambda topic: frozenset(),  # it may be asked again: the answer, too, has to be heard
)
def asked_back(hand_over: Moment, now: Moment, trace: Sequence[Moment], topic: Topic) -> bool:
    """The driver was asked about it, or to say it again, before anything but the noise was changed."""
    for count, asked in enumerate(questions(hand_over, now), start=1):
        if topic.fits(asked["text"]):
            then = next(moment for moment in trace if len(questions(hand_over, moment)) >= count)
            changed = {key for key, value in then.commands.items() if value != hand_over.commands.get(key)}
            return changed <= QUIETING | {"questions"}
    return False


@goal("the driver not asked", writes=frozenset)
def not_asked(hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
    """The driver was not asked anything: what he wants can be found out."""
    return not questions(hand_over, now)


@goal(lambda classes: f"no question but on a {' or '.join(classes)} road", writes=lambda classes: frozenset())
def asked_on(hand_over: Moment, now: Moment, trace: Sequence[Moment], classes: tuple[str, ...]) -> bool:
    """Every question to the driver was begun on a road of these classes, such as where nobody has to merge."""
    return all(moment.driving.road.road_class in classes for moment in _asked_at(trace))


@goal("no question while a siren is near", writes=frozenset)
def asked_without_siren(hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
    """No question to the driver was begun while a vehicle with blue lights was coming up from behind."""
    return all(moment.driving.around.emergency_behind is None for moment in _asked_at(trace))


def _asked_at(trace: Sequence[Moment]) -> Iterator[Moment]:
    """The moments at which the driver had just been asked."""
    begun = [len(questions(trace[0], moment)) for moment in trace]
    return (moment for before, count, moment in zip([0, *begun], begun, trace, strict=False) if count > before)


def asked_in(check: Check) -> Iterator[Topic]:
    """The topics of a goal that the driver has to be asked about."""
    if isinstance(check, NamedCheck) and check.name in ("asked_first", "asked_back"):
        yield check.values[0]
    for part in getattr(check, "checks", ()):
        yield from asked_in(part)


@dataclass(frozen=True, slots=True)
class AllOf:
    """All of the checks hold."""

    checks: tuple[Check, ...]

    @property
    def writes(self) -> frozenset[str]:
        return frozenset().union(*(check.writes for check in self.checks))

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return all(check.holds(hand_over, now, trace) for check in self.checks)

    def __str__(self) -> str:
        return ", and ".join(map(str, self.checks))


@dataclass(frozen=True, slots=True)
class AlertGiven:
    """The driver was alerted of ``kind`` once; an advised speed, if any, is the given one, to 1 km/h.

    Without a given one, any speed up to a posted limit may be advised: a warning of something else may name it."""

    kind: AlertKind
    speed_kmh: float | None = None
    must_advise: bool = False
    """Whether the alert must name the speed, because no sign does."""

    @property
    def writes(self) -> frozenset[str]:
        return frozenset({"alerts"})

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether there was exactly one alert since the hand-over, of this kind."""
        before = len(hand_over.commands["alerts"])
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

    def holds(self, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return any(check.holds(hand_over, now, trace) for check in self.checks)

    def __str__(self) -> str:
        return ", or ".join(map(str, self.checks))


@goal("nothing to do", writes=frozenset)
def nothing_done(hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
    """The right act is to leave everything as it is; that nothing else changed is the verdict's *clean* part."""
    return True


CLASSES = (AppDataIs, AlertGiven)
"""Checks that tasks name like the others."""


def _either(values: object) -> str:
    """The accepted values in words; before they are bound they may be one parameter."""
    return " or ".join(map(str, values)) if isinstance(values, tuple) else str(values)


def _value(said: re.Match[str]) -> float:
    hours, minutes = said.groups()
    return float(said[0]) if hours is None else 60.0 * int(hours) + int(minutes)
