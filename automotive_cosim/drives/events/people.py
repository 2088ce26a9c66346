"""Events of the people in the car: fatigue by hours, the phone in the driver's hand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from automotive_cosim.cockpit.signals import CALL
from automotive_cosim.contracts import AlertKind, PullOver, SightKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import EventKind, Sighting
from automotive_cosim.drives.events.law import SLOW_KMH, seen, speed_kmh
from automotive_cosim.drives.margins import gaze_s

BREAK_AFTER_H = 2.0
"""The Highway Code, rule 91: a break of at least 15 minutes after every two hours of driving."""


class Fatigue(EventKind):
    """Two hours at the wheel without a break."""

    name = "fatigue"
    about = "the driver has been driving for two hours without a break"
    bait = "more than one hour, but not two"
    source = "The Highway Code, rule 91: after two hours; deadline: 120 s, the next lay-by"
    grace_s = 120.0
    alerts = frozenset({AlertKind.FATIGUE})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """By the driving time that the car shows."""
        driven = seen(drive[-1], SightKind.DRIVING_TIME)
        if driven is None or driven.value is None:
            return
        due = driven.value >= BREAK_AFTER_H
        yield Sighting(driven.text, due=due, hold_s=5.0 if due else 0.0, bait=not due)


class PhoneUse(EventKind):
    """The driver takes the phone in the hand, by the driver's own wish."""

    name = "phone"
    about = "the driver holds the phone and looks at it while the car moves"
    bait = "a call by the phone in its cradle"
    source = (
        "Regulation (EU) 2023/2590: gaze away for 6 s at 20 to 50 km/h, for 3.5 s above; deadline: as long again"
    )
    weight = 1.5
    grace_s = 6.0
    alerts = frozenset({AlertKind.DISTRACTION})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """By the interior camera."""
        now = drive[-1]
        where, kmh = now.signals[CALL.PHONE.path], speed_kmh(now)
        if where == "AWAY" or kmh < SLOW_KMH:
            return
        if where == "CRADLE":
            yield Sighting("the phone is used in its cradle", bait=True)
        else:
            yield Sighting(f"the phone in the driver's hand at {kmh:.0f} km/h", due=True, hold_s=gaze_s(kmh))
