"""One appointment of the calendar and one memo: what is in it, and its removal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from automotive_cosim.cockpit.desk import Appointment
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.messages import Back, Put, Show
from automotive_cosim.cockpit.screens.parts import content, note, title
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Widget
from automotive_cosim.contracts.text import joined, say

MOVES_MIN = (
    ("hour_earlier", "-1 h", -60),
    ("earlier", "-15 min", -15),
    ("later", "+15 min", 15),
    ("hour_later", "+1 h", 60),
)
"""Key, text and minutes of the buttons that move an appointment."""


def appointment(state: State) -> tuple[Widget, ...]:
    """The entry that was tapped."""
    area = content(state)
    inner = area.inset(28, 20)
    head, _, where, _, times, _, acts = column(inner, 40, 40, 56, 64, 72, REST, 72)
    agenda = state.desk.agenda
    at = _at(state, "appointment", [entry.name for entry in agenda])
    if at is None:
        return _gone(inner, "appointment", say("This appointment is no longer there"))
    entry = agenda[at]

    def put(others: tuple[Appointment, ...], said: str) -> Put:
        return Put("desk", replace(state.desk, agenda=others), said)

    def moved(by_min: int) -> Put:
        hours, minutes = map(int, entry.at.split(":"))
        then = (60 * hours + minutes + by_min) % 1440
        new = replace(entry, at=f"{then // 60:02d}:{then % 60:02d}")
        return put(
            (*agenda[:at], new, *agenda[at + 1 :]), say("{title} is at {time}", title=entry.title, time=new.at)
        )

    cells = times.columns(len(MOVES_MIN), 12)
    back, there, remove = acts.columns(3, 16)
    return (
        Card(
            rect=area,
            children=(
                title(head, Icon.CALENDAR, joined(" ", (entry.at, entry.title)), "appointment.title"),
                Label(
                    rect=where,
                    key="appointment.place",
                    text=entry.place,
                    description=say("Place"),
                    style=Type.HEADLINE,
                ),
                *(
                    Button(rect=cell, key=f"appointment.{key}", text=text, icon=Icon.CLOCK, on_tap=moved(by_min))
                    for cell, (key, text, by_min) in zip(cells, MOVES_MIN, strict=True)
                ),
                Button(rect=back, key="appointment.back", text=say("Back"), icon=Icon.BACK, on_tap=Back()),
                Button(
                    rect=there,
                    key="appointment.place_there",
                    text=say("Show the place"),
                    icon=Icon.GOAL,
                    on_tap=Show("place", entry.place),
                ),
                Button(
                    rect=remove,
                    key="appointment.remove",
                    text=say("Remove"),
                    icon=Icon.DELETE,
                    on_tap=put((*agenda[:at], *agenda[at + 1 :]), say("{name} is removed", name=entry.title)),
                ),
            ),
        ),
    )


def memo_note(state: State) -> tuple[Widget, ...]:
    """The memo that was tapped; it is deleted here, so that nobody deletes by looking."""
    area = content(state)
    inner = area.inset(28, 20)
    head, _, words, _, acts = column(inner, 40, 24, 160, REST, 72)
    memos = state.desk.memos
    at = _at(state, "note", memos)
    if at is None:
        return _gone(inner, "note", say("This memo is no longer there"))
    back, _, delete = acts.columns(3, 16)
    return (
        Card(
            rect=area,
            children=(
                title(head, Icon.MEMO, say("Memo")),
                Label(rect=words, key="note.text", text=memos[at], style=Type.HEADLINE, lines=3),
                Button(rect=back, key="note.back", text=say("Back"), icon=Icon.BACK, on_tap=Back()),
                Button(
                    rect=delete,
                    key="note.delete",
                    text=say("Delete"),
                    icon=Icon.DELETE,
                    on_tap=Put(
                        "desk",
                        replace(state.desk, memos=(*memos[:at], *memos[at + 1 :])),
                        say("{memo} is deleted", memo=memos[at]),
                    ),
                ),
            ),
        ),
    )


def _gone(rect: Rect, screen: str, words: str) -> tuple[Widget, ...]:
    """The page of what was removed."""
    back = rect.bottom_part(72).columns(3, 16)[0]
    return (
        note(rect, f"{screen}.gone", words),
        Button(rect=back, key=f"{screen}.back", text=say("Back"), icon=Icon.BACK, on_tap=Back()),
    )


def _at(state: State, screen: str, names: Sequence[str]) -> int | None:
    """Index of what the screen was opened on, the first by default; None once it is removed."""
    picked = state.picked.get(screen, names[0] if names else "")
    return names.index(picked) if picked in names else None
