"""The whole picture: the status bar, the present screen with what is beside and above it, and the dock."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.home import METRES_PER_PIXEL, drive_card, media_card
from automotive_cosim.cockpit.apps.map.scene import ego
from automotive_cosim.cockpit.apps.map.screens import map_view, street_plate
from automotive_cosim.cockpit.arranged import moved, page_of
from automotive_cosim.cockpit.equipment import equipped
from automotive_cosim.cockpit.flow import fill
from automotive_cosim.cockpit.frame import callouts, dock, status_bar
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.keyboard import focused, keyboard, uncovered
from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.map import camera_of
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP
from automotive_cosim.cockpit.widgets import Card, Screen, Widget

_PLAYING = ("media", "playlist")
"""Screens that show what plays themselves; beside them, the drive is shown."""


def _companion(rect: Rect, state: State) -> tuple[Widget, ...]:
    """The map over a card; a tap leads to the app."""
    view, _, card = column(rect, REST, GAP, 132)
    below = drive_card(state) if state.screen in _PLAYING else media_card(state)
    return _map(view, state), *fill(card, below)


def _map(rect: Rect, state: State) -> Widget:
    plate = rect.inset(20).bottom_part(56).left(420)
    camera = camera_of(state.roads, ego(state), METRES_PER_PIXEL)
    view = map_view(rect, "companion.map", state, camera, (plate,), Show("map"))
    return Card(rect=rect, look="none", children=(view, *fill(plate, street_plate(state))))


def picture(state: State) -> Screen:
    """The widget tree of the whole display: what is always there first and what comes and goes last, so
    that the rest keeps its place in the list."""
    page, language, make, frame = page_of(state), state.signals[HMI.LANGUAGE], state.make, state.frame
    bar = tuple(translated(widget, language, make) for widget in equipped(state, status_bar(state)))
    lower = equipped(state, dock(state))
    beside = frame.beside(page.room)
    upper = page.made(state)
    if make.mirrored and not page.sided:
        area = frame.content(page.room)
        upper = tuple(moved(widget, area.x + area.right - widget.rect.right - widget.rect.x) for widget in upper)
    if beside is not None:
        upper = (*upper, *_companion(beside, state))
    upper = equipped(state, (*upper, *callouts(state)))
    field = focused(upper) if state.is_typing else None
    above: tuple[Widget, ...] = ()
    if field is not None:
        upper, lower, above = tuple(uncovered(upper, frame.keyboard)), (), (keyboard(field, state),)
    return Screen(
        rect=state.size.whole,
        dock=frame.dock,
        style=make.style,
        night=state.signals[HMI.DAY_NIGHT] == "NIGHT",
        children=(*bar, *lower, *(translated(widget, language, make) for widget in upper), *above),
    )
