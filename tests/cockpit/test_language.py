"""The screens in other languages."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim import cockpit as package
from automotive_cosim.cockpit.arrivals import Arrival
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import said, table
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.theme import Weight, face
from automotive_cosim.cockpit.widgets import Widget
from automotive_cosim.contracts import FeedbackCode, Surroundings

Make = Callable[..., Cockpit]
LANGUAGES = tuple(language for language in HMI.LANGUAGE.allowed if language != "en")
TEXTS = ("text", "description", "disabled", "locked", "hint", "detail", "trail", "level")
LATIN = re.compile(r"[A-Za-zÀ-ÿ]{2,}")
INTERNATIONAL = frozenset(
    LATIN.findall(
        "km mi mm min kWh kW µg dB bar kPa psi mph MHz GPS DAB FM USB Bluetooth Wi-Fi SOS UTC Live "
        "English Français Deutsch"
    )
)
"""Units, names of techniques, and the languages in their own words."""


def entries(language: str) -> dict[str, str]:
    forms = {pattern.pattern: form for pattern, form in table(language).forms}
    return {**table(language).words, **forms}


def texts(widget: Widget) -> Iterator[str]:
    for one in widget.walk():
        yield from (getattr(one, name) for name in TEXTS if getattr(one, name, ""))


def press(cockpit: Cockpit, key: str) -> FeedbackCode:
    box = next(element for element in cockpit.elements() if element.resource_id == key).bbox_pixels
    return cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2).code


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_knows_the_same_texts(language: str) -> None:
    assert entries(language).keys() == entries(LANGUAGES[0]).keys()
    assert table(language).keys.keys() == table(LANGUAGES[0]).keys.keys()
    assert all(words.strip() == words != "" for words in entries(language).values())


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_form_keeps_all_that_varies(language: str) -> None:
    for pattern, form in table(language).forms:
        parts = [f"<{at}>" for at in range(pattern.groups)]
        assert all(form.format(*parts).count(part) == 1 for part in parts), form


def test_no_table_has_a_text_that_no_screen_says() -> None:
    """Every entry is a text in the cockpit's source, or one that another form or a drive makes of several."""
    known = set()
    for path in sorted(Path(package.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.JoinedStr):
                parts = (part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
                known.add("".join(map(str, parts)))
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                known.add(node.value)
    said_by_others = [text for text in table("fr").words if text not in known]
    assert len(said_by_others) < 0.1 * len(table("fr").words), said_by_others


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_letter_has_a_glyph(language: str) -> None:
    for words in (*entries(language).values(), *table(language).keys.values()):
        letters = face(words, Weight.MEDIUM, 20)
        missing = bytes(letters.getmask("\U0010fffe"))
        for letter in words.replace("{}", "").replace(" ", ""):
            assert bytes(letters.getmask(letter)) != missing, f"{letter!r} in {words!r}"


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_language_changes_words_and_nothing_else(make: Make, walker: Any, language: str) -> None:
    for view in walker(make()):
        other = view.cockpit.copy()
        other.inject(HMI.LANGUAGE.path, language)
        for here, there in zip(view.cockpit.tree.walk(), other.tree.walk(), strict=True):
            assert (type(here), here.rect, here.key, here.on_tap) == (
                type(there),
                there.rect,
                there.key,
                there.on_tap,
            )
            assert (here.usable, bool(here.text)) == (there.usable, bool(there.text))


def test_no_english_is_left_in_japanese(make: Make, around: Surroundings, walker: Any) -> None:
    """What Latin letters are left belong to names, units and techniques."""
    standing = replace(around, driving=replace(around.driving, speed_mps=0.0))
    parked = {"Vehicle.Powertrain.Transmission.Gear": "P"}
    calls = [Arrival("message", 0.0), Arrival("call", 0.0)]
    left = set()
    for home in (make(), make(surroundings=standing, signals=parked), make(arrivals=calls)):
        state = home._state
        names = {text for entry in state.library.by_uri.values() for text in (entry.title, entry.by)}
        names |= {playlist.name for playlist in state.library.playlists} | set(state.roads.names)
        names |= {text for place in state.atlas.places for text in (place.name, place.street)}
        names |= {contact.name for contact in state.directory.contacts}
        names |= {line for thread in state.directory.threads for line in thread.lines}
        own = {word for name in (*names, "Home-5G CityFree Garage Coffee-Guest") for word in LATIN.findall(name)}
        for view in walker(home):
            for text in texts(view.cockpit.tree):
                words = LATIN.findall(said("ja", text))
                left |= {(word, text) for word in words if word not in own | INTERNATIONAL}
    assert left == set()


def test_what_varies_is_translated_in_turn() -> None:
    assert said("de", "Sent to Ada Adler: Thank you") == "An Ada Adler: Danke"
    assert said("fr", "Turn left in 200 m") == "Tournez à gauche dans 200 m"
    assert said("ja", "300 kW, 1 of 3 free") == "300 kW、3台中1台空き"


def test_numbers_names_and_unknown_words_stay() -> None:
    for text in ("21.5 °C", "14:05", "Rue de Rivoli", "Kaya Duval", "x"):
        assert said("fr", text) == text


def test_what_was_typed_stays(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=replace(around, driving=replace(around.driving, speed_mps=0.0)))
    cockpit.inject(HMI.LANGUAGE.path, "fr")
    cockpit.visit("map")
    press(cockpit, "map.search")
    cockpit.type_text("Home")
    field = next(element for element in cockpit.elements() if element.resource_id == "map.search")
    assert (field.text, field.hint_text) == ("Home", "Où aller ?")


def test_the_language_is_chosen_in_the_settings(make: Make) -> None:
    cockpit = make()
    cockpit.visit("language")
    assert press(cockpit, "language.de") is FeedbackCode.OK
    assert next(element for element in cockpit.elements() if element.resource_id == "dock.phone").text == "Telefon"
    assert cockpit.open_app("phone").code is FeedbackCode.OK
