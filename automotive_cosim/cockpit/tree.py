"""The tree of screens of a make: what leads where."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.settings.screens import PAGES
from automotive_cosim.cockpit.apps.vehicle.screens import TABS
from automotive_cosim.cockpit.make import HOME, Make, ShelfItem
from automotive_cosim.cockpit.registry import apps, apps_in, docked
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.errors import UserError
from automotive_cosim.formats.toml import Document, parse, read_toml

LAUNCHER = "apps"
SUBPAGES: Mapping[str, tuple[str, Icon, str]] = {
    **{to: (text, icon, f"vehicle.tab.{key}") for key, text, icon, to in TABS},
    **{screen: (text, icon, f"settings.page.{screen}") for screen, text, icon in PAGES},
}
"""By screen: how the other screens of its app call it, and the key of what leads to it there."""


@cache
def entries(make: Make) -> tuple[str, ...]:
    """Screens that the dock leads to."""
    return make.bar.entries or tuple(app.name for app in apps_in(Where.DOCK))


@cache
def app_of(screen: str) -> str:
    """The app that has a screen; a screen of a make's own stands for itself."""
    return next((app.name for app in apps().values() if screen in app.pages), screen)


@cache
def holder(make: Make, screen: str) -> str:
    """What leads to a screen: a menu, or for a page in no menu its app; empty for an entry of the dock."""
    if screen in entries(make):
        return ""
    return make.holders.get(screen) or (LAUNCHER if app_of(screen) == screen else app_of(screen))


@cache
def root(make: Make, screen: str) -> str:
    """The entry of the dock that a screen belongs to; at home none for what is opened on the status bar."""
    if make is HOME:
        return docked()[screen]
    above = holder(make, screen)
    return root(make, above) if above else screen


@cache
def named(make: Make, screen: str) -> tuple[str, Icon]:
    """Title and icon of what leads to a screen."""
    if screen in make.screens:
        place = make.screens[screen]
        return place.text, Icon[place.icon]
    if screen in SUBPAGES and (screen in make.holders or screen not in apps()):
        text, icon, _ = SUBPAGES[screen]
        return text, icon
    return apps()[screen].title, apps()[screen].icon


@cache
def short(make: Make, screen: str) -> str:
    """How the dock calls it."""
    app = None if screen in make.screens else apps().get(screen)
    return (app.short if app else "") or named(make, screen)[0]


@cache
def way(make: Make, screen: str) -> tuple[str, ...]:
    """Keys of what leads to a screen, one after the other, from the dock on."""
    above = holder(make, screen)
    if not above:
        return (f"dock.{screen}",)
    if above in make.screens and screen in make.screens[above].holds:
        return (*way(make, above), f"{above}.{screen}")
    return (*way(make, above), f"apps.{screen}" if above == LAUNCHER else SUBPAGES[screen][2])


@cache
def loose(make: Make) -> tuple[str, ...]:
    """Apps that only the launcher leads to."""
    return tuple(name for name in apps() if holder(make, name) == LAUNCHER)


@cache
def opens(make: Make) -> Mapping[str, str]:
    """By name and title, the screens that open by themselves: those of the dock, and of the launcher."""
    every = (*entries(make), *loose(make))
    return {make.said(named(make, name)[0]).lower(): name for name in every} | {name: name for name in every}


@cache
def shelf(make: Make, key: str) -> str:
    """The screen of the make's own that shows a control; empty where it is as at home."""
    shelves = ((name, each) for name, place in make.screens.items() for each in place.shelves)
    return next((name for name, each in shelves if shown_by(each.controls, key)), "")


def shown_by(controls: tuple[ShelfItem, ...], key: str) -> ShelfItem | None:
    """The control among them that a widget's key belongs to."""
    fitting = [control for control in controls if f"{key}.".startswith(f"{control[0]}.")]
    return max(fitting, key=lambda control: len(control[0]), default=None)


# --- files ------------------------------------------------------------------------------------------------


@cache
def make_named(name: CarMake) -> Make:
    """A make by its name, or by its file.

    Raises UserError: the file cannot be used, or has changed since it was named."""
    if name is CarMake.HOME:
        return HOME
    if not name.file:
        text = files("automotive_cosim.cockpit").joinpath("makes", f"{name}.toml").read_text("utf-8")
        return parse(text, Path(f"{name}.toml")).read(Make)
    document = read_toml(Path(name.file))
    if digest(document) != name.sha256:
        raise UserError(f"--make {name.file} has changed since the run began; restore it, or begin another run")
    return document.read(Make)


def digest(document: Document) -> str:
    """The SHA-256 of a make's file."""
    return hashlib.sha256(document.text.encode()).hexdigest()
