"""The day's appointments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from automotive_cosim.cockpit.places import Gazetteer, PlaceKind
from automotive_cosim.cockpit.state import AppData
from automotive_cosim.contracts.text import say

APPOINTMENTS = 4
_OCCASIONS = (
    (say("Check-up"), PlaceKind.HOSPITAL),
    (say("Team meeting"), PlaceKind.WORK),
    (say("Meal with Nora"), PlaceKind.RESTAURANT),
    (say("Parents' evening"), PlaceKind.SCHOOL),
    (say("Training"), PlaceKind.GYM),
    (say("Groceries"), PlaceKind.SHOP),
    (say("Meet the visitors"), PlaceKind.STATION),
)


@dataclass(frozen=True, slots=True)
class Appointment:
    """An entry of the calendar."""

    at: str
    title: str
    place: str

    @property
    def name(self) -> str:
        """Tells it from others, regardless of its time."""
        return say("{first}, {second}", first=self.title, second=self.place)


@dataclass(frozen=True, slots=True)
class Agenda(AppData):
    """The appointments, by time."""

    entries: tuple[Appointment, ...]

    def commands(self) -> dict[str, Any]:
        return {
            "calendar.entries": [
                {"at": entry.at, "title": entry.title, "place": entry.place} for entry in self.entries
            ]
        }


def agenda(rng: np.random.Generator, atlas: Gazetteer) -> Agenda:
    """Draws the day's appointments at places of the network."""
    hours = np.sort(rng.choice(np.arange(8, 21), APPOINTMENTS, replace=False))
    entries = []
    for hour, at in zip(hours, rng.permutation(len(_OCCASIONS))[:APPOINTMENTS], strict=True):
        title, kind = _OCCASIONS[int(at)]
        there = atlas.of(kind)
        if there:
            place = there[int(rng.integers(len(there)))].name
            entries.append(Appointment(f"{hour:02d}:{30 * int(rng.integers(2)):02d}", title, place))
    return Agenda(tuple(entries))
