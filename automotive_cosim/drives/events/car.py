"""Events of the car itself: belt, flap, tyre, range."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import ClassVar

from automotive_cosim.cockpit.notices import LOW_KPA, TYRES
from automotive_cosim.cockpit.occupants import Seat, seated_by
from automotive_cosim.cockpit.signals import CABIN, ENERGY, MOTION
from automotive_cosim.contracts import AlertKind, PullOver, Reroute
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.changes import before
from automotive_cosim.drives.events.base import EventKind, Measured, Sighting, Wanted, off
from automotive_cosim.drives.events.law import grows, speed_kmh

BELT_KMH = 25.0
"""Speed from which the second, audible belt warning is due (UN R16, 8.4.2.4)."""
HALT_S = 90
"""A shorter halt, as at a red light, does not end an event."""
ROLLING_KMH = 5.0
RECOMMENDED_KPA = 250.0
"""What the label on the door frame says."""
WARM_KPA = 240.0
"""Between this and 200 kPa a tyre is low, but needs no warning while it keeps its air."""
LEAK_KPA = 0.5
"""Loss within ten seconds from which a tyre leaks: more than the sensor's noise, a tyre flat in an hour."""
WINDOWS = (
    CABIN.DRIVER_WINDOW,
    CABIN.PASSENGER_WINDOW,
    CABIN.REAR_LEFT_WINDOW,
    CABIN.REAR_RIGHT_WINDOW,
    CABIN.SUNROOF,
)
NEAR_RANGE_M = 5000.0
LOST_M = 1000.0
"""Range lost within ten seconds from which something is wrong with the battery."""
RESERVE_M = 2000.0
"""A range that ends this much after the destination is short."""


class Belt(EventKind):
    """Somebody is not belted."""

    told_by = ("belt", "speed", "parked")
    name = "belt"
    about = "somebody rides without a belt"
    lookalike = "an open belt while the car stands, or around a thing"
    source = "UN R16, 8.4.2.4: on every seat, from 25 km/h; deadline: 15 s"
    neutral = "below 25 km/h, as long as the car is not parked"
    weight = 1.5
    grace_s = 15.0
    alerts = frozenset({AlertKind.SEAT_BELT})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the switches of the buckles."""
        now = drive[-1]
        kmh = speed_kmh(now)
        for one in seated_by(now.signals):
            if one.belted:
                continue
            whose = "the driver's belt is open" if one.seat is Seat.DRIVER else f"the {one.kind}'s belt is open"
            whose = whose if one.kind.is_person else "the belt on a seat with an object is open"
            if not one.kind.is_person:
                yield Sighting(whose, one.seat, lookalike=True)
            elif now.signals[MOTION.GEAR.path] == "P" or all(speed_kmh(then) < 1.0 for then in drive[-HALT_S:]):
                yield Sighting(f"{whose}, the car stands", one.seat, lookalike=True)
            else:
                yield Sighting(f"{whose} at {kmh:.0f} km/h", one.seat, due=kmh >= BELT_KMH, hold_s=2.0)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Belts that are fastened, or that nobody needs now."""
        now = drive[-1]
        unbelted = [one for one in seated_by(now.signals) if not one.belted]
        if not unbelted:
            return "every belt is fastened"
        if not any(one.kind.is_person for one in unbelted):
            return f"what is not belted is: {', '.join(one.kind for one in unbelted)}"
        return "the car stands"


class FlapOpen(EventKind):
    """Trunk or charging flap open while the car moves."""

    told_by = ("open", "parked")
    name = "door"
    about = "the trunk or the charging flap is open while the car moves"
    lookalike = "a window or the sunroof open while the car moves"
    source = "UN R11 asks for a warning of doors not shut; 2 s; deadline: 20 s"
    neutral = "while the car stands, but is not parked"
    grace_s = 20.0
    lasts_s = 600.0
    alerts = frozenset({AlertKind.VEHICLE})
    requests = (PullOver,)
    writes: ClassVar[Mapping[str, Wanted]] = {CABIN.TRUNK.path: off, ENERGY.CHARGE_FLAP.path: off}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the switches of the latches."""
        signals = drive[-1].signals
        is_rolling = speed_kmh(drive[-1]) >= ROLLING_KMH
        if not is_rolling and signals[MOTION.GEAR.path] == "P":
            return
        for part, words in ((CABIN.TRUNK, "the trunk is open"), (ENERGY.CHARGE_FLAP, "the charging flap is open")):
            if signals[part.path]:
                where = "while driving" if is_rolling else "while the car stands"
                yield Sighting(f"{words} {where}", part.path, due=is_rolling, hold_s=2.0)
        if is_rolling and any(float(signals[part.path]) > 0 for part in WINDOWS):
            yield Sighting("a window is open", "window", lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Flaps that are shut, or a parked car."""
        signals = drive[-1].signals
        if signals[CABIN.TRUNK.path] or signals[ENERGY.CHARGE_FLAP.path]:
            return "the car is parked" if signals[MOTION.GEAR.path] == "P" else None
        opened = any(float(signals[part.path]) > 0 for part in WINDOWS)
        return "only a window is open" if opened else "trunk and charging flap are shut"


SOFTER = 0.92
"""Share of the recommended pressure below which a careful driver may speak of it."""


class Tyre(EventKind):
    """A tyre loses its air."""

    told_by = ("tyres",)
    name = "tyre"
    about = "a tyre has lost a fifth of its pressure"
    lookalike = "a tyre that is a little low and keeps its air"
    source = "UN R141 (and R64): at 20 % below, 200 kPa here; deadline: 60 s of the ten minutes that it allows"
    neutral = "a tyre that loses air"
    lasts_s = 600.0
    weight = 1.5
    grace_s = 60.0
    alerts = frozenset({AlertKind.VEHICLE})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the lowest tyre pressure."""
        signals = drive[-1].signals
        then, lowest_kpa = before(drive).signals, min(float(signals[tyre.path]) for tyre in TYRES)
        words = f"a tyre at {lowest_kpa:.0f} kPa"
        severity = max(1.0, (RECOMMENDED_KPA - lowest_kpa) / (RECOMMENDED_KPA - WARM_KPA))
        if lowest_kpa < LOW_KPA:
            yield Sighting(words, due=True, hold_s=5.0, severity=severity)
        elif any(float(signals[tyre.path]) - float(then[tyre.path]) <= -LEAK_KPA for tyre in TYRES):
            yield Sighting(f"{words}, and falling", severity=severity)
        elif lowest_kpa < WARM_KPA:
            yield Sighting(words, lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Tyres that keep their air."""
        lowest_kpa = min(float(drive[-1].signals[tyre.path]) for tyre in TYRES)
        words = f"the softest tyre has {lowest_kpa:.0f} kPa of {RECOMMENDED_KPA:.0f}, and keeps them"
        return Measured(words) if lowest_kpa < SOFTER * RECOMMENDED_KPA else words


SCANT = 1.5
"""Times what is left to go: with less range than this, a careful driver may speak of it."""


class RangeShort(EventKind):
    """The battery ends before the destination."""

    told_by = ("range",)
    name = "range"
    about = "the battery's range ends before the destination"
    lookalike = "a low battery that still reaches the destination"
    source = "a reserve of 2 km; deadline: 120 s, while ways to a charger are still open"
    neutral = "less than 5 km more than the route, or a range that falls quickly"
    lasts_s = 600.0
    grace_s = 120.0
    alerts = frozenset({AlertKind.VEHICLE})
    requests = (Reroute,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Compares the range that the car shows with the route."""
        now = drive[-1]
        range_m, left_m = float(now.signals[ENERGY.RANGE.path]), now.driving.ahead.route_left_m
        words = f"range {range_m / 1000:.1f} km, {left_m / 1000:.1f} km to go"
        if range_m < left_m + RESERVE_M:
            yield Sighting(words, due=True, hold_s=5.0)
        elif float(now.signals[ENERGY.LEVEL.path]) < 20.0:
            yield Sighting(words, lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """A range that is long enough."""
        now = drive[-1]
        range_m, left_m = float(now.signals[ENERGY.RANGE.path]), now.driving.ahead.route_left_m
        if range_m < left_m + NEAR_RANGE_M or grows(drive, ENERGY.RANGE.path, -LOST_M):
            return None
        words = f"range {range_m / 1000:.0f} km, and {left_m / 1000:.1f} km to go"
        return Measured(words) if range_m < SCANT * left_m else words
