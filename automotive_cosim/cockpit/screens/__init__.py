"""The screens of the cockpit, one module each, and the whole picture made of them."""

from __future__ import annotations

from collections.abc import Callable

from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.screens import apps, body, settings, tools
from automotive_cosim.cockpit.screens.cabin import cabin
from automotive_cosim.cockpit.screens.climate import climate, comfort
from automotive_cosim.cockpit.screens.companion import companion
from automotive_cosim.cockpit.screens.diary import appointment, memo_note
from automotive_cosim.cockpit.screens.figure import figure
from automotive_cosim.cockpit.screens.frame import APPS, DOCK, PART_OF, callouts, dock, status_bar
from automotive_cosim.cockpit.screens.home import home
from automotive_cosim.cockpit.screens.keyboard import focused, keyboard, uncovered
from automotive_cosim.cockpit.screens.map import map_screen
from automotive_cosim.cockpit.screens.media import media, playlist
from automotive_cosim.cockpit.screens.outside import outside
from automotive_cosim.cockpit.screens.parts import room
from automotive_cosim.cockpit.screens.person import contact, thread
from automotive_cosim.cockpit.screens.phone import phone
from automotive_cosim.cockpit.screens.safety import emergency, safety
from automotive_cosim.cockpit.screens.tripb import trip_b
from automotive_cosim.cockpit.screens.vehicle import assistance, vehicle
from automotive_cosim.cockpit.screens.way import explore, place, route
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.widgets import Screen, Widget

SCREENS: dict[str, Callable[[State], tuple[Widget, ...]]] = {
    "home": home,
    "map": map_screen,
    "explore": explore,
    "place": place,
    "route": route,
    "climate": climate,
    "comfort": comfort,
    "cabin": cabin,
    "safety": safety,
    "emergency": emergency,
    "vehicle": vehicle,
    "assistance": assistance,
    "driving": body.driving,
    "doors": body.doors,
    "seats": body.seats,
    "mirrors": body.mirrors,
    "interior": body.interior,
    "outside": outside,
    "media": media,
    "playlist": playlist,
    "phone": phone,
    "contact": contact,
    "thread": thread,
    "figure": figure,
    "apps": apps.apps,
    "store": apps.store,
    "charging": tools.charging,
    "parking": tools.parking,
    "manual": tools.manual,
    "memo": tools.memo,
    "note": memo_note,
    "trip": tools.trip,
    "trip_b": trip_b,
    "calendar": tools.calendar,
    "appointment": appointment,
    "notifications": apps.notifications,
    "settings": settings.settings,
    "sound": settings.sound,
    "connections": settings.connections,
    "language": settings.language,
    "privacy": settings.privacy,
    "profiles": settings.profiles,
}
"""Every screen by its name; those in ``APPS`` can be opened from anywhere."""


def picture(state: State) -> Screen:
    """The widget tree of the whole display: what is always there first and what comes and goes last, so
    that the rest keeps its place in the list."""
    language = state.signals[HMI.LANGUAGE]
    bar, lower = tuple(translated(widget, language) for widget in status_bar(state)), dock(state)
    beside = state.size.beside(room(state.screen))
    upper: tuple[Widget, ...] = SCREENS[state.screen](state)
    if beside is not None:
        upper = (*upper, *companion(beside, state))
    upper = (*upper, *callouts(state))
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


__all__ = ["APPS", "DOCK", "PART_OF", "SCREENS", "picture"]
