"""The companion: what a driver wants beside every app where the display has room, the map and what plays now."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.home import METRES_PER_PIXEL, drive_card, media_card
from automotive_cosim.cockpit.apps.map.scene import ego
from automotive_cosim.cockpit.apps.map.screens import map_view, street_plate
from automotive_cosim.cockpit.flow import fill
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.map import camera_of
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP
from automotive_cosim.cockpit.widgets import Card, Widget

MEDIA = ("media", "playlist")
"""Screens that show what plays themselves; beside them, the drive is shown."""


def companion(rect: Rect, state: State) -> tuple[Widget, ...]:
    """The map over a card; a tap leads to the app."""
    view, _, card = column(rect, REST, GAP, 132)
    below = drive_card(state) if state.screen in MEDIA else media_card(state)
    return _map(view, state), *fill(card, below)


def _map(rect: Rect, state: State) -> Widget:
    plate = rect.inset(20).bottom_part(56).left(420)
    camera = camera_of(state.roads, ego(state), METRES_PER_PIXEL)
    view = map_view(rect, "companion.map", state, camera, (plate,), Show("map"))
    return Card(rect=rect, look="none", children=(view, *fill(plate, street_plate(state))))
