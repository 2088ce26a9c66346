"""Functions of the calendar."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from automotive_cosim.cockpit.apps.calendar.state import Agenda
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, named, offered, unknown
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import Feedback

AppointmentName = Annotated[str, "Its title, or title and place with a comma between, if several have the title."]


@offered
def move_appointment(state: State, appointment: AppointmentName, time: Annotated[str, CLOCK]) -> CallMade:
    """Move an appointment of today to another time."""
    at, minute = _index(state, appointment), minute_of(time)
    if isinstance(at, Feedback):
        return at
    if isinstance(minute, Feedback):
        return minute
    entries = state.of(Agenda).entries
    moved = replace(entries[at], at=f"{minute // 60:02d}:{minute % 60:02d}")
    return Put(Agenda((*entries[:at], moved, *entries[at + 1 :])), "")


@offered
def remove_appointment(state: State, appointment: AppointmentName) -> CallMade:
    """Remove an appointment of today."""
    at, entries = _index(state, appointment), state.of(Agenda).entries
    return at if isinstance(at, Feedback) else Put(Agenda((*entries[:at], *entries[at + 1 :])), "")


def _index(state: State, name: str) -> int | Feedback:
    entries = state.of(Agenda).entries
    for names in ([entry.name for entry in entries], [entry.title for entry in entries]):
        found = named(name, names)
        if found is not None:
            return names.index(found)
    return unknown("appointment", name, (entry.name for entry in entries))


FUNCTIONS = (move_appointment, remove_appointment)
