"""The whole picture: the status bar, the present screen with what is beside and above it, and the dock.

Of a make's own screens, its menus and controls of home's screens in another arrangement, nothing is made twice: a
control is taken from the screen that has it at home, with all that it does, and put into another box.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import TypeVar

from automotive_cosim.cockpit.app import AppPage
from automotive_cosim.cockpit.apps.home import METRES_PER_PIXEL, drive_card, media_card
from automotive_cosim.cockpit.apps.map.scene import ego
from automotive_cosim.cockpit.apps.map.screens import map_view, street_plate
from automotive_cosim.cockpit.cards import back, content, heading, rows, title
from automotive_cosim.cockpit.equipment import equipped
from automotive_cosim.cockpit.flow import Block, BlockPart, fill, framed, grid, line, stack
from automotive_cosim.cockpit.frame import callouts, dock, status_bar
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.keyboard import focused, keyboard, uncovered
from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.make import OwnScreen, Shelf
from automotive_cosim.cockpit.map import camera_of
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.tree import named, shown_by
from automotive_cosim.cockpit.widgets import Button, Card, Choice, Label, Row, Screen, Slider, Tile, Widget
from automotive_cosim.contracts.text import Text

W = TypeVar("W", bound=Widget)
LINE_HEIGHT, LINE_GAP, INSET = 84, 8, (12, 8)
NARROW_ROOM, WIDE_ROOM, STEP_ROOM, TWO_COLUMNS, MOST_CHOICES = 392, 640, 64, 1100, 4
"""Widths of a control beside its name, and of a button that steps; lines stand in two columns on screens wider
than that, unless one has more choices."""


def page_of(state: State) -> AppPage:
    """The screen that is shown, as the make has it."""
    place = state.make.screens.get(state.screen)
    if place is None:
        return pages()[state.screen]
    return AppPage(partial(_menu if place.holds else _shelves, state.screen, place), Room.TWO)


def moved(widget: W, across: int) -> W:
    """The widget and all in it so many pixels further to the right."""
    if not across:
        return widget
    children = tuple(moved(child, across) for child in widget.children)
    return replace(widget, rect=widget.rect.moved(across, 0), children=children)


def _menu(screen: str, place: OwnScreen, state: State) -> tuple[Widget, ...]:
    """The screens that it leads to."""
    make, tiles = state.make, state.make.menus == "tiles"

    def entry(index: int, name: str) -> Widget:
        text, icon = named(make, name)
        key, on_tap = f"{screen}.{name}", Show(name)
        if tiles:
            return Button(
                key=key, text=text, icon=icon, icon_size=44, stacked=True, style=Type.STRONG, on_tap=on_tap
            )
        return Row(key=key, text=text, icon=icon, on_tap=on_tap)

    columns, height = (3, 150) if tiles else (1, 72)
    every = rows(f"{screen}.all", place.text, state, place.holds, entry, columns=columns, height=height, gap=GAP)
    return _titled(screen, place, state, every)


def _shelves(screen: str, place: OwnScreen, state: State) -> tuple[Widget, ...]:
    """The controls that it shows."""
    every = [part for shelf in place.shelves for part in _parts(shelf, state)]
    widest = max((sum(isinstance(each, Choice) for each in own) for own, _ in every), default=0)
    both = content(state).width > TWO_COLUMNS and widest <= MOST_CHOICES
    columns, room = (2, NARROW_ROOM) if both else (1, WIDE_ROOM)
    listed = rows(
        f"{screen}.all", place.text, state, every, lambda _, part: _line(*part, room), columns=columns,
        height=LINE_HEIGHT, gap=LINE_GAP,
    )  # fmt: skip
    return _titled(screen, place, state, listed)


def _titled(screen: str, place: OwnScreen, state: State, body: BlockPart) -> tuple[Widget, ...]:
    head = line(title(Icon[place.icon], place.text, f"{screen}.title"), GAP, (160, back(screen)))
    return fill(content(state), stack((48, head), GAP, (REST, body)))


def _parts(shelf: Shelf, state: State) -> Iterator[tuple[list[Widget], str]]:
    """The widgets of each control that is there now, and its name; pictures and lists stay at home."""
    every = (widget for child in pages()[shelf.of].made(state) for widget in child.walk() if widget.key)
    made = [widget for widget in every if widget.listens or isinstance(widget, Label)]
    for control in shelf.controls:
        own = [each for each in made if shown_by(shelf.controls, each.key) is control]
        if own:
            yield own, Text(control[1], {}, "make") if control[1:] else ""


def _line(own: list[Widget], name: str, room: int) -> Block:
    """A control, after its name unless it shows it itself."""
    labels = [each for each in own if isinstance(each, Label)]
    if len(labels) == len(own):
        told = replace(labels[0], style=Type.LABEL, align="left", lines=1)
        return framed(line(4, heading(told.description), told) if told.description else line(4, told), INSET)
    touched = sorted((each for each in own if each.listens), key=lambda each: each.rect.x)
    if touched and all(isinstance(each, Choice) for each in touched):
        control = framed(grid(len(touched), 4, *touched), (4, 4), look="raised")
    elif labels and (STEP_ROOM + 4) * len(touched) < room - STEP_ROOM:
        first, *others = touched
        control = line(
            (STEP_ROOM, first),
            replace(labels[0], style=Type.STRONG, align="centre"),
            *((STEP_ROOM, each) for each in others),
        )
        name = name or labels[0].description
    else:
        control = grid(len(touched), GAP, *touched)
        if not name and any(isinstance(each, Tile | Slider | Button) and each.text for each in touched):
            return framed(control, INSET)
    return framed(line(4, (REST, heading(name)), 8, (room, control)), INSET)


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
