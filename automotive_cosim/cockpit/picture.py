"""The whole picture: the status bar, the present screen with what is beside and above it, and the dock."""

from __future__ import annotations

from automotive_cosim.cockpit.companion import companion
from automotive_cosim.cockpit.equipment import equipped
from automotive_cosim.cockpit.frame import callouts, dock, status_bar
from automotive_cosim.cockpit.keyboard import focused, keyboard, uncovered
from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.widgets import Screen, Widget


def picture(state: State) -> Screen:
    """The widget tree of the whole display: what is always there first and what comes and goes last, so
    that the rest keeps its place in the list."""
    page, language = pages()[state.screen], state.signals[HMI.LANGUAGE]
    bar = tuple(translated(widget, language) for widget in equipped(state, status_bar(state)))
    lower = equipped(state, dock(state))
    beside = state.size.beside(page.room)
    upper = page.made(state)
    if beside is not None:
        upper = (*upper, *companion(beside, state))
    upper = equipped(state, (*upper, *callouts(state)))
    field = focused(upper) if state.is_typing else None
    above: tuple[Widget, ...] = ()
    if field is not None:
        upper, lower, above = tuple(uncovered(upper, state.size.keyboard)), (), (keyboard(field, state),)
    return Screen(
        rect=state.size.whole,
        dock=state.size.dock,
        night=state.signals[HMI.DAY_NIGHT] == "NIGHT",
        children=(*bar, *lower, *(translated(widget, language) for widget in upper), *above),
    )
