"""What screens are made of, besides plain widgets: parts for ``flow``, without their boxes.

A control is named by its signal alone (``controls``); where a screen has another key or name for it, it gives them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TypeVar

from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.controls import CHOICES, CONTROLS, shown
from automotive_cosim.cockpit.flow import Block, BlockPart, at, card, fill, framed, grid, line, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, row
from automotive_cosim.cockpit.messages import Back, Focus, Show
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.signals import HMI, Signal, Signals
from automotive_cosim.cockpit.state import AppData, Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.timer import Timer
from automotive_cosim.cockpit.values import MILE_KM
from automotive_cosim.cockpit.widgets import (
    Bar,
    Button,
    Choice,
    Field,
    Glyph,
    Label,
    Row,
    Rows,
    Slider,
    Tile,
    Widget,
)
from automotive_cosim.contracts.text import Quantity, joined, listed, say

T = TypeVar("T")

HELD_STEPS = 5
"""Steps for one long press on plus or minus."""
SMALL = 20, 16
"""Padding of a card among several."""


def content(state: State) -> Rect:
    """The area of the present screen."""
    own = state.screen in state.make.screens
    return state.frame.content(Room.TWO if own else pages()[state.screen].room)


# --- texts ------------------------------------------------------------------------------------------------


def heading(text: str, key: str = "") -> Label:
    """The title of a card."""
    return Label(key=key, text=text, style=Type.LABEL, tone="muted")


def title(icon: Icon, text: str, key: str = "") -> Block:
    """The head of a page: an icon and its name."""
    picture = Glyph(icon=icon, size=28, tone="accent")
    return framed(line((32, picture), 12, Label(key=key, text=text, style=Type.TITLE)), height=40, look="none")


def about(key: str, text: str, lines: int = 2) -> Label:
    """An explanation in small letters."""
    return Label(key=key, text=text, style=Type.CAPTION, tone="muted", lines=lines)


def note(key: str, text: str) -> Block:
    """The text of an empty list."""
    return at(lambda rect: rect.top(60), Label(key=key, text=text, tone="muted", style=Type.LABEL, align="centre"))


def fact(key: str, name: str, value: str) -> Block:
    """A line with a name and a value."""
    return Block(
        (
            Label(text=name, style=Type.LABEL, tone="muted"),
            Label(key=key, text=value, description=name, style=Type.LABEL, align="right"),
        ),
        lambda rect: (rect.left(rect.width // 2), rect.right_part(rect.width - rect.width // 2 - 8)),
    )


# --- controls ---------------------------------------------------------------------------------------------


def switch(
    signal: Signal[bool],
    state: State,
    *,
    key: str = "",
    name: str | None = None,
    group: str = "",
    disabled: str = "",
) -> Tile:
    """A tile that turns a signal on and off.

    Args:
        key: if it is not that of the signal's control; so for ``name``.
        group: tells it apart from those of the same name in other groups for whoever hears it alone.
        disabled: why it cannot be used now."""
    control, on = CONTROLS[signal], state.signals[signal]
    text = control.name if name is None else name
    return Tile(
        key=key or control.key,
        text=text,
        description=say("{name}: {value}", name=group, value=text) if group else "",
        icon=control.icon,
        checked=on,
        on_tap=Set(signal, not on),
        disabled=disabled,
        locked=state.vehicle.held(signal),
    )


def levels(
    signal: Signal[float],
    state: State,
    steps: Sequence[tuple[float, str]],
    *,
    key: str = "",
    name: str = "",
    icon: Icon | None = None,
    group: str = "",
    told: str = "",
) -> Tile:
    """A tile that goes round its levels; a value that is none of them counts as the first, 0 is off.

    Args:
        steps: each value and what it is called.
        key: if it is not that of the signal's control; so for ``name`` and ``icon``.
        group: as of ``switch``.
        told: its description, if it is another one."""
    control = CONTROLS[signal]
    values, text = [value for value, _ in steps], name or control.name
    now = state.signals[signal]
    place = values.index(now) if now in values else 0
    return Tile(
        key=key or control.key,
        text=text,
        description=say("{name}: {value}", name=group, value=text) if group else told,
        icon=icon or control.icon,
        checked=place > 0 and not values[0],
        level=steps[place][1],
        levels=listed([word for _, word in steps]),
        read=say("{name}: {value}", name=text, value=steps[place][1]),
        on_tap=Set(signal, values[(place + 1) % len(values)]),
    )


def slider(
    signal: Signal[float], state: State, *, key: str = "", name: str = "", icon: Icon | None = None
) -> Slider:
    """A slider for a number."""
    control = CONTROLS[signal]
    return Slider(
        key=key or control.key,
        description=name or control.name,
        text=shown(signal, state.signals),
        icon=icon or control.icon,
        signal=signal,
        value=state.signals[signal],
    )


def choices(
    key: str, options: Iterable[tuple[str, str, Icon | None, bool, Message]], *, stacked: bool = False
) -> Block:
    """A row of options of which one is selected; each (key, text, icon, selected, message)."""
    cells = [
        Choice(key=f"{key}.{name}", text=text, icon=icon, selected=selected, on_tap=message, stacked=stacked)
        for name, text, icon, selected, message in options
    ]
    return framed(grid(len(cells), 4, *cells), (4, 4), look="raised")


def choice(signal: Signal[str], state: State) -> Block:
    """A row of the values of a signal."""
    key, values = CHOICES[signal]
    now = state.signals[signal]
    return choices(
        key, [(name, text, icon, now == value, Set(signal, value)) for value, (name, text, icon) in values.items()]
    )


def stepper(
    signal: Signal[float],
    signals: Signals,
    *,
    key: str = "",
    name: str = "",
    style: Type = Type.TITLE,
    locked: str = "",
    gauge: bool = False,
    bare: bool = False,
) -> Block:
    """Minus, the value, plus; a long press goes ``HELD_STEPS`` at once.

    Args:
        key: of the value, if it is not that of the signal's control; those of the buttons begin with it.
        name: as ``key``.
        locked: why it is locked while driving; empty if it is not.
        gauge: whether it shows its ends, and by a bar under the value how far it is between them.
        bare: whether the value stands elsewhere."""
    control, value = CONTROLS[signal], signals[signal]
    key, name = key or control.key, name or control.name
    words = control.ways(name, _step(signal, signals))

    def button(more: bool) -> Button:
        steps, least = (1, words.most) if more else (-1, words.least)
        once, often = (
            min(signal.high, max(signal.low, value + count * signal.step)) for count in (steps, HELD_STEPS * steps)
        )
        return Button(
            key=f"{key}.{'increase' if more else 'decrease'}",
            description=words.more if more else words.less,
            icon=words.icons[more],
            on_tap=Set(signal, once),
            on_hold=Set(signal, often),
            disabled=least if once == value else "",
            locked=locked,
        )

    ends = joined(" … ", (shown(signal, signals, signal.low), shown(signal, signals, signal.high)))
    number = (
        None
        if bare
        else Label(
            key=f"{key}.value",
            text=shown(signal, signals),
            description=joined(". ", (name, ends)) if gauge else name,
            style=style,
            align="centre",
        )
    )
    share = (value - signal.low) / (signal.high - signal.low)
    bar = Bar(share=1 - share if words.more_first else share) if gauge else None

    def divide(rect: Rect) -> Sequence[Rect]:
        side = min(rect.height, 64)
        left, middle, right = row(rect, side, REST, side)
        return left.middle(side, side), middle, middle.inset(28, 0).bottom_part(4), right.middle(side, side)

    return Block((button(words.more_first), number, bar, button(not words.more_first)), divide, 64)


def _step(signal: Signal[float], signals: Signals) -> str:
    """A stepper's step in the unit of the display, as whole as the value that is shown."""
    if signal.unit == "Celsius" and signals[HMI.TEMPERATURE_UNIT] == "F":
        return f"{1.8 * signal.step:.0f}"
    if signal.unit == "km/h" and signals[HMI.DISTANCE_UNIT] == "MILES":
        return f"{signal.step / MILE_KM:.0f}"
    return Quantity(f"{signal.step:g}")


def schedule(
    key: str, text: str, icon: Icon, timer: Timer, keep: Callable[[Timer], AppData], ready: str, off: str
) -> tuple[Tile, Block]:
    """A switch, and the time of day at which something is done, half an hour earlier or later at a tap.

    Args:
        key: of the switch, like ``text`` and ``icon``; those of the time begin with it."""

    def moved(by_min: int) -> Put:
        new = timer.moved(by_min)
        return Put(keep(new), say("The time is {time}", time=new.shown))

    def step(name: str, words: str, by: Icon, by_min: int) -> Button:
        hold = moved(by_min * HELD_STEPS)
        return Button(key=f"{key}.{name}", description=words, icon=by, on_tap=moved(by_min), on_hold=hold)

    turn = Put(keep(replace(timer, on=not timer.on)), off if timer.on else ready)
    time = Label(key=f"{key}.time", text=timer.shown, description=say("Time"), style=Type.HEADLINE, align="centre")
    steps = line(
        (72, step("earlier", say("Half an hour earlier"), Icon.MINUS, -30)),
        time,
        (72, step("later", say("Half an hour later"), Icon.PLUS, 30)),
    )
    return Tile(key=key, text=text, icon=icon, checked=timer.on, on_tap=turn), steps


def search(key: str, name: str, hint: str, state: State, on_enter: Message | None) -> Field:
    """A text field; typing is locked while driving."""
    return Field(
        key=key,
        text=state.typed.get(key, ""),
        description=name,
        hint=hint,
        focused=state.focus == key,
        on_tap=Focus(key),
        on_enter=on_enter,
        locked=state.locked(Restriction.NO_KEYBOARD),
    )


# --- lists ------------------------------------------------------------------------------------------------


def rows(
    key: str,
    name: str,
    state: State,
    entries: Sequence[T],
    entry: Callable[[int, T], BlockPart],
    *,
    columns: int = 1,
    height: int = 64,
    gap: int = 8,
) -> Callable[[Rect], Rows]:
    """A scrolling list or grid, cut at whole rows; while driving it ends early. The rightmost 16 pixels of its box
    are left to the scroll bar.

    Args:
        key: its own, under which the state remembers how far it is scrolled.
        entry: makes the row of an entry, from its index.
        columns: entries side by side.
        gap: between rows and columns."""

    def made(rect: Rect) -> Rows:
        if state.is_typing:  # above the keyboard, but for a row at least
            rect = rect.top(min(rect.height, max(height, state.frame.keyboard.y - gap - rect.y)))
        limit = state.entries_limit
        total = len(entries) if limit is None or len(entries) <= limit else limit + 1
        lines = -(-total // columns)
        seen = max(1, (rect.height + gap) // (height + gap))
        first = min(state.scrolled.get(key, 0), max(0, lines - seen))
        cells = rect.left(rect.width - (16 if lines > seen else 0)).top(height).columns(columns, gap)
        children: list[Widget] = []
        for index in range(first * columns, min(total, (first + seen) * columns)):
            cut = limit is not None and index == limit
            cell = cells[index % columns].moved(0, (index // columns - first) * (height + gap))
            children += fill(cell, _rest(key, state) if cut else entry(index, entries[index]))
        return Rows(
            rect=rect, key=key, description=name, first=first, shown=seen, total=lines, children=tuple(children)
        )

    return made


def _rest(key: str, state: State) -> Row:
    """The end of a long list while driving."""
    return Row(
        key=f"{key}.rest",
        text=say("See more when stopped"),
        icon=Icon.INFO,
        on_tap=Show(state.screen),
        locked=state.locked(Restriction.LIMIT_CONTENT),
    )


def menu(key: str, entries: Iterable[tuple[str, str, Icon]], state: State) -> Block:
    """The pages of an app, one above the other; each (screen, text, icon)."""
    lines = [
        Row(key=f"{key}.{screen}", text=text, icon=icon, selected=state.screen == screen, on_tap=Show(screen))
        for screen, text, icon in entries
    ]
    return card((64 * len(lines) - 8, grid(1, 8, *lines)), padding=(12, 12))


def back(screen: str) -> Button:
    """A button that leads back, with its name."""
    return Button(key=f"{screen}.back", text=say("Back"), icon=Icon.BACK, on_tap=Back())


def gone(state: State, screen: str, words: str) -> tuple[Widget, ...]:
    """The page of what was removed."""
    page = stack((REST, note(f"{screen}.gone", words)), (72, grid(3, 16, back(screen), None, None)))
    return fill(content(state).inset(28, 20), page)


def picked_at(state: State, screen: str, names: Sequence[str]) -> int | None:
    """Index of what the screen was opened on, the first by default; None once it is removed."""
    picked = state.picked.get(screen, names[0] if names else "")
    return names.index(picked) if picked in names else None
