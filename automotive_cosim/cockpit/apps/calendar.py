"""Calendar: the day's appointments, and one of them, to be moved and removed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import back, content, gone, note, picked_at, rows, title
from automotive_cosim.cockpit.commands import Put, Remove
from automotive_cosim.cockpit.flow import card, fill, grid
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, named, offered, unknown
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.pois import Gazetteer, PoiKind
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Label, Row, Widget
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import joined, say

APPOINTMENTS = 4
_OCCASIONS = (
    (say("Check-up"), PoiKind.HOSPITAL),
    (say("Team meeting"), PoiKind.WORK),
    (say("Meal with Nora"), PoiKind.RESTAURANT),
    (say("Parents' evening"), PoiKind.SCHOOL),
    (say("Training"), PoiKind.GYM),
    (say("Groceries"), PoiKind.SHOP),
    (say("Meet the visitors"), PoiKind.STATION),
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


NO_PLACE = say("No place is given")
MOVES_MIN = (
    ("hour_earlier", "-1 h", -60),
    ("earlier", "-15 min", -15),
    ("later", "+15 min", 15),
    ("hour_later", "+1 h", 60),
)
"""Key, text and minutes of the buttons that move an appointment."""


def calendar(state: State) -> tuple[Widget, ...]:
    """The day's appointments; each leads to its place."""
    agenda = state.of(Agenda).entries
    date = say("Today") if state.outside is None else f"{state.outside.local_time:%Y-%m-%d}"

    def entry(index: int, each: Appointment) -> Row:
        return Row(
            key=f"calendar.{index}",
            raised=True,
            text=joined(" ", (each.at, each.title)),
            detail=each.place,
            trail=say("Details"),
            icon=Icon.CALENDAR,
            on_tap=Show("appointment", each.name),
        )

    every = rows("calendar.entries", say("Appointments"), state, agenda, entry, height=76)
    listed = every if agenda else note("calendar.empty", say("Nothing today"))
    head = title(Icon.CALENDAR, date, "calendar.date")
    return fill(content(state), card(head, 16, (REST, listed), padding=(28, 20)))


def appointment(state: State) -> tuple[Widget, ...]:
    """The entry that was tapped."""
    agenda = state.of(Agenda).entries
    index = picked_at(state, "appointment", [each.name for each in agenda])
    if index is None:
        return gone(state, "appointment", say("This appointment is no longer there"))
    entry = agenda[index]

    def moved(by_min: int) -> Put:
        hours, minutes = map(int, entry.at.split(":"))
        then = (60 * hours + minutes + by_min) % 1440
        new = replace(entry, at=f"{then // 60:02d}:{then % 60:02d}")
        return Put(
            Agenda((*agenda[:index], new, *agenda[index + 1 :])),
            say("{title} is at {time}", title=entry.title, time=new.at),
        )

    where = Label(
        key="appointment.place", text=entry.place or NO_PLACE, description=say("Place"), style=Type.HEADLINE
    )
    times = (
        Button(key=f"appointment.{key}", text=text, icon=Icon.CLOCK, on_tap=moved(by_min))
        for key, text, by_min in MOVES_MIN
    )
    there = Button(
        key="appointment.place_there",
        text=say("Show on the map"),
        icon=Icon.GOAL,
        on_tap=Show("place", entry.place),
        disabled="" if entry.place else NO_PLACE,
    )
    remove = Button(
        key="appointment.remove",
        text=say("Remove"),
        icon=Icon.DELETE,
        on_tap=Remove(Agenda((*agenda[:index], *agenda[index + 1 :])), say("{name} is removed", name=entry.title)),
    )
    whole = card(
        title(Icon.CALENDAR, joined(" ", (entry.at, entry.title)), "appointment.title"),
        40,
        (56, where),
        64,
        (72, grid(len(MOVES_MIN), 12, *times)),
        REST,
        (72, grid(3, 16, back("appointment"), there, remove)),
        padding=(28, 20),
    )
    return fill(content(state), whole)


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
    listed = [f"{entry.at} {entry.title}" for entry in entries]
    for names in ([entry.name for entry in entries], [entry.title for entry in entries], listed):
        found = named(name, names)
        if found is not None:
            return names.index(found)
    return unknown("appointment", name, (entry.name for entry in entries))


APP = App(
    name="calendar",
    title=say("Calendar"),
    icon=Icon.CALENDAR,
    order=16,
    where=Where.STORE,
    about=say("Today's appointments and how to get there"),
    functions=(move_appointment, remove_appointment),
    pages={"calendar": AppPage(calendar, Room.ONE), "appointment": AppPage(appointment, Room.ONE)},
    preinstalled=False,
    starts=lambda state, rng: (agenda(rng, state.of(Gazetteer)),),
    turn=5,
)
