"""Kinds of events, grouped by subject.

base     what a kind of event is, a sighting, an act
tracker  folds a drive's moments into events
law      what law and measurement say at one moment
speed, light, weather, road, car, people, border, errands
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from automotive_cosim.drives.events import border, car, errands, light, people, road, speed, weather
from automotive_cosim.drives.events.base import DriveAct, EventKind, Sighting
from automotive_cosim.drives.events.tracker import DriveEvent, Tracker

SUBJECTS = (speed, light, weather, road, car, people, border, errands)


def _kinds() -> Iterator[EventKind]:
    """One of each class that has a name, in the order in which they are written."""
    for subject in SUBJECTS:
        for found in vars(subject).values():
            is_own = isinstance(found, type) and found.__module__ == subject.__name__
            if is_own and issubclass(found, EventKind) and "name" in vars(found):
                yield found()


KINDS: Mapping[str, EventKind] = {kind.name: kind for kind in _kinds()}
"""Every kind by its name."""

__all__ = ["KINDS", "DriveAct", "DriveEvent", "EventKind", "Sighting", "Tracker"]
