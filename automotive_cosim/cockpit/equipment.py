"""What a car lacks: equipment that it was never fitted with, or that is out of order.

What is not fitted leaves a line in its place that says so; what is out of order is there, disabled, and says so
too. Either way the car refuses the command and tells no reading, whoever asks: a finger, a function or an app.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Type
from automotive_cosim.cockpit.widgets import Label, Slider, Widget
from automotive_cosim.contracts.text import say

UNREAD = "–"
"""What is shown in place of a reading."""


def equipped(state: State, widgets: Iterable[Widget]) -> tuple[Widget, ...]:
    """The widgets as they are in a car that lacks something: with a line in place of what is not fitted, with what
    is out of order disabled, and with a word beside values that cannot all be set."""
    lacks = state.vehicle.lacks
    return tuple(_left(lacks, widgets)) if lacks else tuple(widgets)


def _left(lacks: tuple[Lacking, ...], widgets: Iterable[Widget]) -> Iterator[Widget]:
    for widget in widgets:
        found = next((each for each in lacks if _touches(each, widget)), None)
        if found is None:
            if said := _unfitted(lacks, widget.children):
                yield Label(rect=widget.rect, text=said, style=Type.CAPTION, tone="muted")
            else:
                children = tuple(_left(lacks, widget.children))
                yield widget if children == widget.children else replace(widget, children=children)
        elif found.is_range and isinstance(widget, Label | Slider):
            yield replace(widget, description=found.words)
        elif isinstance(widget, Label):
            yield replace(widget, text=UNREAD, description=found.words)
        elif found.is_broken:
            yield replace(widget, disabled=found.words)
        else:
            text = say("Not fitted")
            yield Label(rect=widget.rect, text=text, description=found.words, style=Type.CAPTION, tone="muted")


def _unfitted(lacks: tuple[Lacking, ...], widgets: tuple[Widget, ...]) -> str:
    """What the car says of widgets all of which it has nothing for; empty if some are left."""
    found = [next((each for each in lacks if _touches(each, widget)), None) for widget in widgets]
    fitted = any(
        each is None or each.is_broken or each.is_range or isinstance(widget, Label)
        for each, widget in zip(found, widgets, strict=True)
    )
    return "" if fitted or not found or found[0] is None else found[0].words


def _touches(lacking: Lacking, widget: Widget) -> bool:
    """Whether a widget sets what is lacking, or shows it."""
    if widget.key and widget.key in lacking.keys:
        return True
    if isinstance(widget, Slider):
        return widget.signal in lacking.signals
    return isinstance(widget.on_tap, Set) and lacking.bars(widget.on_tap.signal, widget.on_tap.value)
