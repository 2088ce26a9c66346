"""Parts shared by several screens, and the formatting of values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.controls import (
    StepWords as StepWords,
)
from automotive_cosim.cockpit.controls import (
    forward_back as forward_back,
)
from automotive_cosim.cockpit.controls import (
    left_right as left_right,
)
from automotive_cosim.cockpit.controls import (
    lower_higher as lower_higher,
)
from automotive_cosim.cockpit.controls import (
    upright_back as upright_back,
)
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, row
from automotive_cosim.cockpit.messages import Back, Focus, Show
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import HMI, Signal, Signals
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.timer import Timer
from automotive_cosim.cockpit.values import (
    MILE_KM as MILE_KM,
)
from automotive_cosim.cockpit.values import (
    distance as distance,
)
from automotive_cosim.cockpit.values import (
    minutes as minutes,
)
from automotive_cosim.cockpit.values import (
    pressure as pressure,
)
from automotive_cosim.cockpit.values import (
    sign_figure as sign_figure,
)
from automotive_cosim.cockpit.values import (
    sign_in_words as sign_in_words,
)
from automotive_cosim.cockpit.values import (
    speed as speed,
)
from automotive_cosim.cockpit.values import (
    speed_unit as speed_unit,
)
from automotive_cosim.cockpit.values import (
    temperature as temperature,
)
from automotive_cosim.cockpit.widgets import (
    Bar,
    Button,
    Card,
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

HELD_STEPS = 5
"""Steps for one long press on plus or minus."""


def content(state: State) -> Rect:
    """The area of the present screen."""
    return state.size.content(pages()[state.screen].room)


def heading(rect: Rect, text: str, key: str = "") -> Label:
    """The title of a card."""
    return Label(rect=rect, key=key, text=text, style=Type.LABEL, tone="muted")


StepWays = Callable[[str, str], StepWords]


def stepper(
    rect: Rect,
    key: str,
    name: str,
    signal: Signal[float],
    signals: Signals,
    show: Callable[[float], str],
    style: Type = Type.TITLE,
    locked: str = "",
    ways: StepWays = lower_higher,
    gauge: bool = False,
) -> tuple[Widget, ...]:
    """Minus, the value, plus; a long press goes ``HELD_STEPS`` at once.

    Args:
        rect: where they are.
        key: of the value; those of the buttons begin with it.
        name: of the signal.
        signal: what they change.
        signals: the values of all.
        show: a value in words.
        style: of the value.
        locked: why it is locked while driving; empty if it is not.
        ways: where the buttons lead.
        gauge: whether it shows its ends, and by a bar under the value how far it is between them.
    """
    value = signals[signal]
    side = min(rect.height, 64)
    less, more, far_less, far_more = (
        min(signal.high, max(signal.low, value + steps * signal.step)) for steps in (-1, 1, -HELD_STEPS, HELD_STEPS)
    )
    words = ways(name, _step(signal, signals))
    left, middle, right = row(rect, side, REST, side)
    minus, plus = (right, left) if words.more_first else (left, right)
    decrease = Button(
        rect=minus.middle(side, side),
        key=f"{key}.decrease",
        description=words.less,
        icon=words.icons[0],
        on_tap=Set(signal, less),
        on_hold=Set(signal, far_less),
        disabled=words.least if less == value else "",
        locked=locked,
    )
    ends = joined(" … ", (show(signal.low), show(signal.high)))
    told = joined(". ", (name, ends)) if gauge else name
    number = Label(rect=middle, key=f"{key}.value", text=show(value), description=told, style=style, align="centre")
    increase = Button(
        rect=plus.middle(side, side),
        key=f"{key}.increase",
        description=words.more,
        icon=words.icons[1],
        on_tap=Set(signal, more),
        on_hold=Set(signal, far_more),
        disabled=words.most if more == value else "",
        locked=locked,
    )
    share = (value - signal.low) / (signal.high - signal.low)
    if words.more_first:
        share = 1 - share
    bar = middle.inset(28, 0).bottom_part(4)
    shown = (number, Bar(rect=bar, share=share)) if gauge else (number,)
    return (increase, *shown, decrease) if words.more_first else (decrease, *shown, increase)


def _step(signal: Signal[float], signals: Signals) -> str:
    """A stepper's step in the unit of the display, as whole as the value that is shown."""
    if signal.unit == "Celsius" and signals[HMI.TEMPERATURE_UNIT] == "F":
        return f"{1.8 * signal.step:.0f}"
    if signal.unit == "km/h" and signals[HMI.DISTANCE_UNIT] == "MILES":
        return f"{signal.step / MILE_KM:.0f}"
    return Quantity(f"{signal.step:g}")


def switch(
    rect: Rect, key: str, name: str, icon: Icon, signal: Signal[bool], signals: Signals, locked: str = ""
) -> Tile:
    """A tile that turns a signal on and off."""
    on = signals[signal]
    return Tile(rect=rect, key=key, text=name, icon=icon, checked=on, on_tap=Set(signal, not on), locked=locked)


def grouped(tile: Tile, group: str) -> Tile:
    """The tile, told apart from those of the same name in other groups by whoever hears it alone."""
    return replace(tile, description=say("{name}: {value}", name=group, value=tile.text))


def levels(
    rect: Rect,
    key: str,
    name: str,
    icon: Icon,
    signal: Signal[float],
    signals: Signals,
    steps: Sequence[tuple[float, str]],
) -> Tile:
    """A tile that goes round its levels; a value that is none of them counts as the first, 0 is off."""
    values = [value for value, _ in steps]
    now = signals[signal]
    at = values.index(now) if now in values else 0
    following = values[(at + 1) % len(values)]
    return Tile(
        rect=rect,
        key=key,
        text=name,
        icon=icon,
        checked=at > 0 and not values[0],
        level=steps[at][1],
        levels=listed([shown for _, shown in steps]),
        read=say("{name}: {value}", name=name, value=steps[at][1]) if name else steps[at][1],
        on_tap=Set(signal, following),
    )


def choices(
    rect: Rect,
    key: str,
    options: Sequence[tuple[str, str, Icon | None, bool, Message]],
    *,
    stacked: bool = False,
) -> Card:
    """A row of options of which one is selected; each (key, text, icon, selected, message)."""
    cells = rect.inset(4).columns(len(options), 4)
    return Card(
        rect=rect,
        look="raised",
        children=tuple(
            Choice(
                rect=cell,
                key=f"{key}.{name}",
                text=text,
                icon=icon,
                selected=selected,
                on_tap=message,
                stacked=stacked,
            )
            for cell, (name, text, icon, selected, message) in zip(cells, options, strict=True)
        ),
    )


def slider(
    rect: Rect,
    key: str,
    name: str,
    icon: Icon,
    signal: Signal[float],
    signals: Signals,
    shown: str = "",
    locked: str = "",
) -> Slider:
    """A slider for a number, as a percentage by default."""
    return Slider(
        rect=rect,
        key=key,
        description=name,
        text=shown or f"{signals[signal]:.0f} %",
        icon=icon,
        signal=signal,
        value=signals[signal],
        locked=locked,
    )


def search(
    rect: Rect, key: str, name: str, hint: str, state: State, on_enter: Message | None, icon: Icon = Icon.SEARCH
) -> Field:
    """A text field; typing is locked while driving."""
    return Field(
        rect=rect,
        key=key,
        text=state.typed.get(key, ""),
        description=name,
        hint=hint,
        icon=icon,
        focused=state.focus == key,
        on_tap=Focus(key),
        on_enter=on_enter,
        locked=state.locked(Restriction.NO_KEYBOARD),
    )


def title(rect: Rect, icon: Icon, text: str, key: str = "") -> Card:
    """The head of a page: an icon and its name."""
    picture, _, words = row(rect, 32, 12, REST)
    return Card(
        rect=rect,
        look="none",
        children=(
            Glyph(rect=picture, icon=icon, size=28, tone="accent"),
            Label(rect=words, key=key, text=text, style=Type.TITLE),
        ),
    )


def note(rect: Rect, key: str, text: str) -> Label:
    """The text of an empty list."""
    return Label(rect=rect.top(60), key=key, text=text, tone="muted", style=Type.LABEL, align="centre")


def fact(rect: Rect, key: str, name: str, value: str) -> tuple[Widget, ...]:
    """A line with a name and a value."""
    half = rect.width // 2
    return (
        Label(rect=rect.left(half), text=name, style=Type.LABEL, tone="muted"),
        Label(
            rect=rect.right_part(rect.width - half - 8),
            key=key,
            text=value,
            description=name,
            style=Type.LABEL,
            align="right",
        ),
    )


def menu(rect: Rect, key: str, pages: Sequence[tuple[str, str, Icon]], state: State) -> Card:
    """The pages of an app, one above the other; each (screen, text, icon)."""
    lines = rect.inset(12).top(64 * len(pages) - 8).rows(len(pages), 8)
    return Card(
        rect=rect,
        children=tuple(
            Row(
                rect=line,
                key=f"{key}.{screen}",
                text=text,
                icon=icon,
                selected=state.screen == screen,
                on_tap=Show(screen),
            )
            for line, (screen, text, icon) in zip(lines, pages, strict=True)
        ),
    )


def rows(
    rect: Rect,
    key: str,
    name: str,
    state: State,
    total: int,
    row: Callable[[int, Rect], Widget],
    *,
    columns: int = 1,
    height: int = 64,
    gap: int = 8,
) -> Rows:
    """A scrolling list or grid of ``total`` entries, cut at whole rows; while driving it ends early.

    Args:
        rect: where it is; the rightmost 16 pixels are left to the scroll bar.
        key: its own, under which the state remembers how far it is scrolled.
        name: what it lists.
        state: of the cockpit.
        total: number of entries.
        row: makes the entry of that index in that box.
        columns: entries side by side.
        height: of one row.
        gap: between rows and columns.
    """
    if state.is_typing:  # above the keyboard, but for a row at least
        rect = rect.top(min(rect.height, max(height, state.size.keyboard.y - gap - rect.y)))
    limit = state.entries_limit
    if limit is not None and total > limit:
        total = limit + 1
    else:
        limit = total
    lines = -(-total // columns)
    shown = max(1, (rect.height + gap) // (height + gap))
    first = min(state.scrolled.get(key, 0), max(0, lines - shown))
    room = Rect(rect.x, rect.y, rect.width - (16 if lines > shown else 0), rect.height)
    cells = room.top(height).columns(columns, gap)

    def entry(index: int) -> Widget:
        cell = cells[index % columns].moved(0, (index // columns - first) * (height + gap))
        return row(index, cell) if index < limit else _rest(cell, key, state)

    return Rows(
        rect=rect,
        key=key,
        description=name,
        first=first,
        shown=shown,
        total=lines,
        children=tuple(entry(index) for index in range(first * columns, min(total, (first + shown) * columns))),
    )


def _rest(rect: Rect, key: str, state: State) -> Row:
    """The end of a long list while driving."""
    return Row(
        rect=rect,
        key=f"{key}.rest",
        text=say("See more when stopped"),
        icon=Icon.INFO,
        on_tap=Show(state.screen),
        locked=state.locked(Restriction.LIMIT_CONTENT),
    )


def time_setter(rect: Rect, key: str, timer: Timer, put: Callable[[Timer], Put]) -> tuple[Widget, ...]:
    """A time of day, earlier and later by half an hour; ``put`` keeps the one that was set."""
    earlier, time, later = row(rect, 72, REST, 72)
    return (
        Button(
            rect=earlier,
            key=f"{key}.earlier",
            description=say("Half an hour earlier"),
            icon=Icon.MINUS,
            on_tap=put(timer.moved(-30)),
            on_hold=put(timer.moved(-30 * HELD_STEPS)),
        ),
        Label(
            rect=time,
            key=f"{key}.time",
            text=timer.shown,
            description=say("Time"),
            style=Type.HEADLINE,
            align="centre",
        ),
        Button(
            rect=later,
            key=f"{key}.later",
            description=say("Half an hour later"),
            icon=Icon.PLUS,
            on_tap=put(timer.moved(30)),
            on_hold=put(timer.moved(30 * HELD_STEPS)),
        ),
    )


def gone(rect: Rect, screen: str, words: str) -> tuple[Widget, ...]:
    """The page of what was removed."""
    back = rect.bottom_part(72).columns(3, 16)[0]
    return (
        note(rect, f"{screen}.gone", words),
        Button(rect=back, key=f"{screen}.back", text=say("Back"), icon=Icon.BACK, on_tap=Back()),
    )


def picked_at(state: State, screen: str, names: Sequence[str]) -> int | None:
    """Index of what the screen was opened on, the first by default; None once it is removed."""
    picked = state.picked.get(screen, names[0] if names else "")
    return names.index(picked) if picked in names else None
