"""The tree of screens of a make: what leads where, and the reading of a make's file."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.settings.screens import PAGES
from automotive_cosim.cockpit.apps.vehicle.screens import TABS
from automotive_cosim.cockpit.language import messages
from automotive_cosim.cockpit.make import HOME, LANGUAGES, Make, ShelfItem, glyphs
from automotive_cosim.cockpit.registry import apps, apps_in, docked, pages
from automotive_cosim.cockpit.theme import Icon, Palette
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.checked import Steps
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
    if _digest(document) != name.sha256:
        raise UserError(f"--make {name.file} has changed since the run began; restore it, or begin another run")
    return document.read(Make)


def resolved(word: str) -> str:
    """What was given for the make: a file, once it has been checked, becomes ``FILE@SHA-256``.

    Raises UserError: the file cannot be used, with its line."""
    if not word.endswith(".toml"):
        return word
    document = read_toml(Path(word))
    check(document)
    return f"{Path(word).as_posix()}@{_digest(document)}"


def _digest(document: Document) -> str:
    return hashlib.sha256(document.text.encode()).hexdigest()


def check(document: Document) -> None:
    """Looks up all that a make's file names.

    Raises UserError: with file and line: what does not exist, or a screen that nothing leads to."""
    make, wrong = document.read(Make), document.refused
    for steps, kind, name, known in _names(make):
        if name not in known:
            raise wrong(steps, str(UnknownNameError(kind, name, sorted(known))))
    for light, colours in (("day", make.look.day), ("night", make.look.night)):
        for name, code in colours.items():
            if not re.fullmatch("[0-9A-Fa-f]{6}", code):
                raise wrong(("look", light, name), f"is {code[:20]!r}; give six digits such as 1A2B3C")
    for word, told in make.words.items():
        if any(_fields(each) != _fields(word) for each in told):
            raise wrong(("words", word), "has other fields in braces than the words that it replaces")
    for name, place in make.screens.items():
        if bool(place.holds) == bool(place.shelves):
            raise wrong(("screens", name), "needs either holds, of screens, or shelves, of controls")
        if name not in pages() and holder(make, name) == LAUNCHER:
            raise wrong(("screens", name), "is in no menu and not in the bar; put it into one")
        if not re.fullmatch("[a-z][a-z0-9_]*", name):
            raise wrong(("screens", name), "is no name of a screen; give small letters, digits and underscores")
        if name in _above(make, name):
            raise wrong(("screens", name), "is in a menu that only it leads to; put one of them into the bar")
        for at, each in enumerate(place.shelves):
            if any(len(control) not in (1, 1 + len(LANGUAGES)) for control in each.controls):
                how = "needs the key of each control alone, or with its name in every language"
                raise wrong(("screens", name, "shelves", at, "controls"), how)
    held = [(("screens", name, "holds"), place.holds) for name, place in make.screens.items()]
    for where, listed in [(("bar", "entries"), make.bar.entries), *held]:
        if twice := [each for each in listed if listed.count(each) > 1]:
            raise wrong(where, f"names {twice[0]} twice")
    if not {"home", LAUNCHER} <= {*entries(make)}:
        raise wrong(("bar",), "lacks home or apps among its entries; add both, all else hangs on them")


def _above(make: Make, screen: str) -> list[str]:
    """What leads to a screen, one after the other upwards, until the bar or one that was there before."""
    found: list[str] = []
    while (screen := holder(make, screen)) and screen not in found:
        found.append(screen)
    return found


def _fields(text: str) -> list[str]:
    return sorted(part.partition("}")[0] for part in text.split("{")[1:])


def _names(make: Make) -> Iterator[tuple[Steps, str, str, Collection[str]]]:
    """Each name in a make: where it is, of what kind, and what there is of that kind."""
    shown = {*SUBPAGES, *apps(), *make.screens} - {app.name for app in apps_in(Where.STORE)}
    icons = {icon.name for icon in Icon}
    yield from ((("bar", "entries", at), "screen", name, shown) for at, name in enumerate(make.bar.entries))
    for name, place in make.screens.items():
        yield ("screens", name, "icon"), "icon", place.icon, icons
        yield from ((("screens", name, "holds", at), "screen", each, shown) for at, each in enumerate(place.holds))
        for at, each in enumerate(place.shelves):
            yield ("screens", name, "shelves", at, "of"), "screen", each.of, set(pages())
    for light, colours in (("day", make.look.day), ("night", make.look.night)):
        yield from ((("look", light, name), "colour", name, set(Palette.__slots__)) for name in colours)
    for name, glyph in make.look.icons.items():
        yield ("look", "icons", name), "icon", name, icons
        yield ("look", "icons", name), "glyph", glyph, set(glyphs())
    yield from ((("words", word), "text of the cockpit", word, messages()) for word in make.words)
