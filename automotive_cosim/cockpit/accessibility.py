"""The widget tree as a list of elements in AndroidWorld's fields: only what can be read or touched."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import chain

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.widgets import (
    Button,
    Choice,
    Field,
    Label,
    LimitSign,
    MapView,
    Pill,
    Row,
    Rows,
    Screen,
    Slider,
    Tile,
    Widget,
)
from automotive_cosim.contracts import BoundingBox, Element
from automotive_cosim.contracts.ids import resource_id

PACKAGE = "org.automotive_cosim.cockpit"


def elements(screen: Screen, scale: float = 1.0) -> tuple[Element, ...]:
    """All widgets that have texts, react to touch or scroll, in drawing order.

    Args:
        scale: pixels per logical pixel."""
    return tuple(chain.from_iterable(_part(child, scale) for child in screen.children))


def drawn(screen: Screen, scale: float = 1.0) -> tuple[Element, ...]:
    """The same elements in the same order, with only the texts that the picture shows."""
    widgets = (widget for child in screen.children for widget in child.walk() if _listed(widget))
    return tuple(
        replace(
            element,
            text=element.text if isinstance(widget, _LETTERED) else "",
            content_description=widget.description if isinstance(widget, Slider) else "",
        )
        for element, widget in zip(elements(screen, scale), widgets, strict=True)
    )


@lru_cache(maxsize=512)
def _part(child: Widget, scale: float) -> tuple[Element, ...]:
    """The elements of one top-level widget, cached: most recur, and equal ones get the same elements."""
    return tuple(_element(widget, scale) for widget in child.walk() if _listed(widget))


def _listed(widget: Widget) -> bool:
    return bool(widget.text or widget.description) or widget.listens or isinstance(widget, Field)


def _element(widget: Widget, scale: float) -> Element:
    kind = type(widget)
    rect, is_field = widget.touched, kind is Field
    chosen = isinstance(widget, Choice | Row) and widget.selected
    return Element(
        text=str((isinstance(widget, Tile) and widget.read) or widget.text),
        content_description=str(_description(widget)),
        class_name=widget.class_name,
        bbox_pixels=_box(rect, scale),
        resource_id=resource_id(widget.key),
        package_name=PACKAGE,
        hint_text=str(widget.hint) if isinstance(widget, Field) else "",
        is_checked=(isinstance(widget, Tile) and widget.checked) or (kind is Choice and chosen),
        is_checkable=kind is Tile or kind is Choice,
        is_clickable=widget.listens,
        is_editable=is_field,
        is_enabled=widget.usable,
        is_focused=isinstance(widget, Field) and widget.focused,
        is_focusable=is_field,
        is_scrollable=kind in _SCROLLING and _scrolls(widget),
        is_selected=chosen,
        is_long_clickable=isinstance(widget, Button) and widget.on_hold is not None,
    )


@lru_cache(maxsize=4096)
def _box(rect: Rect, scale: float) -> BoundingBox:
    return BoundingBox(*rect.edges(scale))


_LETTERED = (Label, Button, Choice, Tile, Slider, Field, Row, Pill, LimitSign)
"""Widgets whose text is drawn."""
_SCROLLING = frozenset((Rows, Slider, MapView))


def _scrolls(widget: Widget) -> bool:
    if isinstance(widget, Rows):
        return widget.last_first > 0
    return not isinstance(widget, MapView) or widget.pans


def _description(widget: Widget) -> str:
    parts: tuple[str, ...]
    if isinstance(widget, Row):
        parts = (widget.description, widget.detail, widget.trail, widget.disabled, widget.locked)
    elif isinstance(widget, Slider):
        reach = f"{widget.signal.low:g} … {widget.signal.high:g}"
        parts = (widget.description, reach, widget.disabled, widget.locked)
    elif isinstance(widget, Tile):
        parts = (widget.description, widget.levels, widget.disabled, widget.locked)
    elif isinstance(widget, MapView):
        scale = f"{widget.scene.camera.metres_per_pixel:g} metres per pixel"
        parts = (widget.description, scale, widget.disabled, widget.locked)
    elif widget.disabled or widget.locked:
        parts = (widget.description, widget.disabled, widget.locked)
    else:
        return widget.description
    return ". ".join(part for part in parts if part)
