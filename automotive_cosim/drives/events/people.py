"""Events of the people in the car: fatigue by hours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from automotive_cosim.contracts import AlertKind, PullOver, SightKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import EventKind, Sighting
from automotive_cosim.drives.events.law import seen

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
