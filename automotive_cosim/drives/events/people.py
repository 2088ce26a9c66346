"""Events of the people in the car: fatigue by hours, the phone in the driver's hand, who stays in a parked car."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import ClassVar

from automotive_cosim.cockpit.forecast import MINUTES
from automotive_cosim.cockpit.occupants import seated_by
from automotive_cosim.cockpit.signals import CALL, DRIVE, HVAC, MOTION, OCCUPANT
from automotive_cosim.contracts import AlertKind, PullOver, SightKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import EventKind, Measured, Sighting, Wanted, on
from automotive_cosim.drives.events.law import SLOW_KMH, speed_kmh
from automotive_cosim.drives.margins import gaze_s

ALONE_S = 15.0
"""Euro NCAP's protocol for child presence detection: a first warning within 15 s after the car has been locked."""
WARM_C = 28.0
"""From here on the air of the parked car makes it worse; our choice."""
SOON_H = 1 / 6
BREAK_AFTER_H = 2.0
"""The Highway Code, rule 91: a break of at least 15 minutes after every two hours of driving."""


class Fatigue(EventKind):
    """Two hours at the wheel without a break."""

    told_by = ("driving time",)
    name = "fatigue"
    about = "the driver has been driving for two hours without a break"
    lookalike = "more than one hour, but ten minutes or more short of two"
    source = "The Highway Code, rule 91: after two hours; deadline: 120 s, the next lay-by"
    neutral = "the last ten minutes before"
    lasts_s = 600.0
    grace_s = 120.0
    alerts = frozenset({AlertKind.FATIGUE})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the driving time that the car shows."""
        driven = drive[-1].sight(SightKind.DRIVING_TIME)
        if driven is None or driven.value is None:
            return
        due = driven.value >= BREAK_AFTER_H
        yield Sighting(
            driven.text, due=due, hold_s=5.0 if due else 0.0, lookalike=driven.value < BREAK_AFTER_H - SOON_H
        )

    def against(self, drive: Sequence[Moment]) -> str | None:
        """A shorter time at the wheel."""
        driven = drive[-1].sight(SightKind.DRIVING_TIME)
        if driven is None or driven.value is None:
            return "less than an hour at the wheel"
        return Measured(f"{driven.value:.1f} h at the wheel; a break is due after {BREAK_AFTER_H:.0f}")


class PhoneUse(EventKind):
    """The driver takes the phone in the hand, by the driver's own wish."""

    told_by = ("phone", "parked")
    name = "phone"
    about = "the driver holds the phone and looks at it while the car moves"
    lookalike = "a call by the phone in its cradle"
    source = (
        "Regulation (EU) 2023/2590: gaze away for 6 s at 20 to 50 km/h, for 3.5 s above; deadline: as long again"
    )
    neutral = "in the hand below 20 km/h"
    weight = 1.5
    grace_s = 6.0
    alerts = frozenset({AlertKind.DISTRACTION})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the interior camera."""
        now = drive[-1]
        where, kmh = now.signals[CALL.PHONE.path], speed_kmh(now)
        if where == "AWAY" or now.signals[MOTION.GEAR.path] == "P":
            return
        if where == "HAND":
            told = f"the phone in the driver's hand at {kmh:.0f} km/h"
            yield Sighting(told, due=kmh >= SLOW_KMH, hold_s=gaze_s(kmh))
        elif kmh >= SLOW_KMH:
            yield Sighting("the phone is used in its cradle", lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No phone in the hand, or a parked car."""
        signals = drive[-1].signals
        match signals[CALL.PHONE.path]:
            case "HAND":
                return "the car is parked" if signals[MOTION.GEAR.path] == "P" else None
            case "CRADLE":
                return "the phone is in its cradle"
            case _:
                return "the driver uses no phone"


class LeftBehind(EventKind):
    """A child or a pet stays in the parked car without anybody who could help it."""

    told_by = ("parked",)
    name = "left_behind"
    about = "the driver has left the parked car, and a child or a pet is alone in it"
    lookalike = "a car that is left empty, or with a thing or an adult in it"
    source = (
        "Euro NCAP, child presence detection: a warning within 15 s of leaving; deadline: the escalation, due 90 s "
        "after leaving"
    )
    neutral = "the first 15 s after the driver has left"
    weight = 2.0
    grace_s = 75.0
    alerts = frozenset({AlertKind.VEHICLE})
    says = ("child", "baby", "pet", "dog", "cat", "alone", "left behind")
    writes: ClassVar[Mapping[str, Wanted]] = {DRIVE.HORN.path: on, HVAC.KEPT.path: on}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """By the seats' sensors, and by how warm the air will be (``cockpit.forecast``)."""
        signals = drive[-1].signals
        if signals[MOTION.GEAR.path] != "P" or signals[OCCUPANT.DRIVER.occupied.path]:
            return
        aboard = tuple(seated_by(signals))
        alone = [one.kind for one in aboard if one.kind.needs_care]
        if not alone or any(one.kind.is_person and not one.kind.needs_care for one in aboard):
            yield Sighting(f"the driver has left; aboard: {', '.join(one.kind for one in aboard)}", lookalike=True)
            return
        air_c = float(signals[HVAC.FORECAST.path])
        words = f"{' and '.join(alone)} alone in the parked car, {air_c:.0f} degrees in {MINUTES:.0f} min"
        yield Sighting(words, due=True, hold_s=ALONE_S, severity=max(1.0, air_c / WARM_C))

    def against(self, drive: Sequence[Moment]) -> str | None:
        """A driver who is there, or nobody left who needs care."""
        signals = drive[-1].signals
        if signals[OCCUPANT.DRIVER.occupied.path]:
            return "the driver is in the car"
        if signals[MOTION.GEAR.path] != "P":
            return None
        aboard = ", ".join(one.kind for one in seated_by(signals)) or "nobody"
        return f"the driver has left; aboard: {aboard}"
