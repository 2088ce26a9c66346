"""The on-screen keyboard, over the lower half of the screen while a text field is focused."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from automotive_cosim.cockpit.flow import Block, fill, line
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.messages import BACKSPACE, Enter, Focus, Key
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import MARGIN, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Field, Look, MapView, Rows, Widget
from automotive_cosim.contracts.text import say

LETTERS = {
    "en": ("qwertyuiop", "asdfghjkl", "zxcvbnm"),
    "fr": ("azertyuiop", "qsdfghjklm", "wxcvbn"),
    "de": ("qwertzuiop", "asdfghjkl", "yxcvbnm"),
}
"""Rows of letters by language; Japanese uses the English ones."""
ACCENTS = {"fr": "éèàç", "de": "äöüß"}
"""Further letters, next to the last row."""
DIGITS = "1234567890"
GAP = 6


def focused(widgets: Iterable[Widget]) -> Field | None:
    """The text field among them that has the focus."""
    return next((w for one in widgets for w in one.walk() if isinstance(w, Field) and w.focused), None)


def keyboard(field: Field, state: State) -> Card:
    """The keys that write into a field."""
    language = state.signals[HMI.LANGUAGE]
    letters = list(LETTERS.get(language, LETTERS["en"]))
    letters[-1] += ACCENTS.get(language, "'-")
    lines = state.frame.keyboard.inset(MARGIN, 8).rows(5, GAP)
    keys = [
        Button(rect=cell, key=f"keyboard.{letter}", text=letter, style=Type.BODY, on_tap=Key(field.key, letter))
        for box, row in zip(lines, (DIGITS, *letters), strict=False)
        for cell, letter in zip(_centred(box, len(row)), row, strict=True)
    ]
    card = Card(rect=state.frame.keyboard, children=(*keys, *fill(lines[-1], _lowest(field))))
    return translated(card, language, state.make)


def uncovered(widgets: Iterable[Widget], keyboard: Rect) -> Iterator[Widget]:
    """The widgets without those that the keyboard covers; groups stay below it unless they react to a tap."""
    for widget in widgets:
        if not widget.rect.overlaps(keyboard):
            yield widget
        elif isinstance(widget, MapView | Rows) or (isinstance(widget, Card) and not widget.listens):
            yield replace(widget, children=tuple(uncovered(widget.children, keyboard)))


def _centred(line: Rect, count: int) -> tuple[Rect, ...]:
    """Cells for a number of keys, with one width in all rows unless a row has more."""
    cells = max(len(DIGITS), count)
    wide = (line.width + GAP) * count // cells - GAP
    return Rect(line.x + (line.width - wide) // 2, line.y, wide, line.height).columns(count, GAP)


def _lowest(field: Field) -> Block:
    hide = Button(
        key="keyboard.hide", description=say("Hide the keyboard"), icon=Icon.KEYBOARD_CLOSE, on_tap=Focus("")
    )
    erase = Button(
        key="keyboard.backspace",
        description=say("Delete the last character"),
        icon=Icon.ERASE,
        on_tap=Key(field.key, BACKSPACE),
        disabled="" if field.text else say("There is nothing to delete"),
    )
    space = Button(key="keyboard.space", text=say("Space"), on_tap=Key(field.key, " "))
    enter = Button(
        key="keyboard.enter",
        description=field.enters,
        icon=Icon.CHECK,
        look=Look.ACCENT,
        on_tap=Enter(field.on_enter),
        disabled="" if field.on_enter else field.lacking,
    )
    return line((160, hide), GAP, (160, erase), GAP, space, GAP, (260, enter))
