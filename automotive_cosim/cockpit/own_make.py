"""A make of one's own: all that its file names is looked up before it is used."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from pathlib import Path

import numpy as np

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import messages
from automotive_cosim.cockpit.make import LANGUAGES, Make, glyphs
from automotive_cosim.cockpit.messages import Pick
from automotive_cosim.cockpit.registry import apps, apps_in, pages
from automotive_cosim.cockpit.signals import MOTION
from automotive_cosim.cockpit.theme import Icon, Palette
from automotive_cosim.cockpit.tree import LAUNCHER, SUBPAGES, digest, entries, holder
from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.checked import Steps
from automotive_cosim.formats.toml import Document, read_toml


def resolved(word: str) -> str:
    """What was given for the make: a file, once it has been checked, becomes ``FILE@SHA-256``.

    Raises UserError: the file cannot be used, with its line."""
    if not word.endswith(".toml"):
        return word
    document = read_toml(Path(word))
    check(document)
    return f"{Path(word).as_posix()}@{digest(document)}"


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
            where = ("screens", name, "shelves", at)
            yield (*where, "of"), "screen", each.of, set(pages())
            known = _controls().get(each.of, ())
            yield from (
                ((*where, "controls", no, 0), "control", key, known) for no, (key, *_) in enumerate(each.controls)
            )
    for light, colours in (("day", make.look.day), ("night", make.look.night)):
        yield from ((("look", light, name), "colour", name, set(Palette.__slots__)) for name in colours)
    for name, glyph in make.look.icons.items():
        yield ("look", "icons", name), "icon", name, icons
        yield ("look", "icons", name), "glyph", glyph, set(glyphs())
    yield from ((("words", word), "text of the cockpit", word, messages()) for word in make.words)


@cache
def _controls() -> Mapping[str, frozenset[str]]:
    """By screen of home's, the keys of what it shows while the car is parked and while it drives, on all its parts,
    and the beginnings of those keys."""
    found: dict[str, set[str]] = {name: set() for name in pages()}
    for gear in ("P", "D"):
        cockpit = Cockpit(
            RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False), rng=np.random.default_rng(0)
        )
        cockpit.inject(MOTION.GEAR.path, gear)
        cockpit.inject(MOTION.IS_MOVING.path, gear == "D")
        for screen, page in pages().items():
            left, tried = [cockpit.state.copy()], set[Pick]()
            for state in left:  # which grows by the parts that one can pick
                state.screen = screen
                for widget in (each for top in page.made(state) for each in top.walk()):
                    steps = widget.key.split(".") if widget.key else []
                    found[screen] |= {".".join(steps[: at + 1]) for at in range(len(steps))}
                    pick = getattr(widget, "on_tap", None)
                    if isinstance(pick, Pick) and pick not in tried:
                        tried.add(pick)
                        left.append(state.copy())
                        pick.perform(left[-1])
    return {screen: frozenset(keys) for screen, keys in found.items()}
