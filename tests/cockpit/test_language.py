"""The screens in other languages."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim import cockpit as package
from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.arrivals import Arrival
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import said, table
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.theme import Weight, face
from automotive_cosim.cockpit.widgets import Widget
from automotive_cosim.contracts import Answer, Feedback, FeedbackCode, Surroundings
from automotive_cosim.contracts.ids import resource_id as shown_id

Make = Callable[..., Cockpit]
LANGUAGES = tuple(language for language in HMI.LANGUAGE.allowed if language != "en")
TEXTS = ("text", "description", "disabled", "locked", "hint", "detail", "trail", "level")
LATIN = re.compile(r"[A-Za-zÀ-ÿ]{2,}")
INTERNATIONAL = frozenset(
    LATIN.findall(
        "km mi mm min kg kWh kW µg dB bar kPa psi mph MHz GPS DAB FM USB Bluetooth Wi-Fi SOS UTC Live "
        "English Français Deutsch"
    )
)
"""Units, names of techniques, and the languages in their own words."""


SHOWN = {"notify": 0, "said": 0, "refused": 0, "RefusedError": 0, "Answer": 1, "_hear": 2}
TOLD = {"Feedback": 1, "Put": 2, "_change": -1, "SetAll": 1, "command_all": 2}
"""What shows a text in a notice, and what answers with one: the place of the text among the arguments."""
SAYING = ("_refusal", "_too_slow", "reroute", "_asked")
"""Functions whose text is shown."""


def entries(language: str) -> dict[str, str]:
    forms = {pattern.pattern: form for pattern, form in table(language, answers=True).forms}
    return {**table(language, answers=True).words, **forms}


def written(node: ast.AST | None) -> Iterator[str]:
    """The texts that an expression may be, with ``{}`` for what varies."""
    match node:
        case ast.Constant(str(text)):
            yield text
        case ast.JoinedStr(parts):
            yield "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in parts)
        case ast.IfExp():
            yield from (*written(node.body), *written(node.orelse))
        case ast.BoolOp():
            yield from (text for value in node.values for text in written(value))
        case ast.BinOp():
            yield from (*written(node.left), *written(node.right))
        case ast.Tuple():
            yield from written(node.elts[0])
        case _:
            pass


def source_texts(places: Mapping[str, int], returns: tuple[str, ...]) -> dict[str, str]:
    """Every text given to one of these functions, or returned by one of those, and its file."""
    root, found = Path(package.__file__).parent, dict[str, str]()
    roads = [root.parent / "traffic" / name for name in ("ego.py", "steering.py", "kinematics.py")]
    for path in (*sorted(root.rglob("*.py")), *roads):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.FunctionDef) and node.name in returns:
                given = [one.value for one in ast.walk(node) if isinstance(one, ast.Return)]
                found |= {text: path.name for value in given for text in written(value)}
            if not isinstance(node, ast.Call):
                continue
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name not in places:
                continue
            given = [keyword.value for keyword in node.keywords if keyword.arg == "said"]
            given += node.args[places[name] :][:1]
            found |= {text: path.name for value in given for text in written(value)}
    return found


def from_table(text: str, names: frozenset[str], *, answers: bool = False) -> bool:
    """Whether all words of an English text are in the tables, but for names, numbers and units."""
    known = table(LANGUAGES[0], answers)
    if text in names or text in known.words or not set(LATIN.findall(text)) - INTERNATIONAL:
        return True
    for pattern, _ in known.forms:
        found = pattern.fullmatch(text)
        if found is not None:
            return all(from_table(part, names, answers=answers) for part in found.groups())
    return False


def named(cockpit: Cockpit) -> frozenset[str]:
    """What keeps its name in every language: people, places, streets, music, and what people wrote."""
    state = cockpit._state
    names = {text for entry in state.library.by_uri.values() for text in (entry.title, entry.by)}
    names |= {playlist.name for playlist in state.library.playlists} | set(state.roads.names)
    names |= {text for place in state.atlas.places for text in (place.name, place.street)}
    names |= {contact.name for contact in state.directory.contacts}
    names |= {line for thread in state.directory.threads for line in thread.lines}
    return frozenset(names | {"Home-5G", "CityFree", "Garage", "Coffee-Guest"})


NOTHING = frozenset[str]()
IDENTIFIER = re.compile(
    r"\b(?:[A-Za-z0-9_]+(?:\.[A-Za-z0-9_]+)+|[A-Z]+(?:_[A-Z0-9]+)*)\b"
    r"|^[a-z0-9_]+(?= is (?:already )?shown)|(?<= is )\S+$|(?<= already )\S+$"
)
"""Resource ids and signals, their values, and screens' names."""


def texts(widget: Widget) -> Iterator[str]:
    for one in widget.walk():
        yield from (getattr(one, name) for name in TEXTS if getattr(one, name, ""))


def press(cockpit: Cockpit, key: str) -> FeedbackCode:
    box = next(element for element in cockpit.elements() if element.resource_id == shown_id(key)).bbox_pixels
    return cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2).code


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_knows_the_same_texts(language: str) -> None:
    assert entries(language).keys() == entries(LANGUAGES[0]).keys()
    assert table(language).keys.keys() == table(LANGUAGES[0]).keys.keys()
    assert all(words.strip() == words != "" for words in entries(language).values())


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_form_keeps_all_that_varies(language: str) -> None:
    for pattern, form in table(language, answers=True).forms:
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
    said_by_others = [text for text in table("fr", answers=True).words if text not in known]
    assert len(said_by_others) < 0.1 * len(table("fr", answers=True).words), said_by_others


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
    left = set()
    for home in homes(make, around):
        own = {word for name in named(home) for word in LATIN.findall(name)}
        for view in walker(home):
            for text in texts(view.cockpit.tree):
                words = LATIN.findall(said("ja", text))
                left |= {(word, text) for word in words if word not in own | INTERNATIONAL}
    assert left == set()


def test_every_text_of_a_notice_or_an_answer_is_in_the_tables() -> None:
    """As the source has them, whether or not a test comes by: notices, refusals, what the road and taps say."""
    shown, told = source_texts(SHOWN, SAYING), source_texts(TOLD, ())
    assert len(shown) > 50
    assert len(told) > 80
    for texts_of, answers in ((shown, False), (told, True)):
        missing = {text: file for text, file in texts_of.items() if not from_table(text, NOTHING, answers=answers)}
        assert missing == {}


EVERY_KIND = tuple(
    Occupant(seat, kind, asleep=kind is Kind.BABY, belted=kind is not Kind.OBJECT)
    for seat, kind in zip(list(Seat)[1:], (Kind.CHILD, Kind.BABY, Kind.PET, Kind.OBJECT), strict=True)
)


def homes(make: Make, around: Surroundings) -> tuple[Cockpit, ...]:
    standing = replace(around, driving=replace(around.driving, speed_mps=0.0))
    parked = {"Vehicle.Powertrain.Transmission.Gear": "P"}
    calls = [Arrival("message", 0.0), Arrival("call", 0.0)]
    return make(), make(surroundings=standing, signals=parked, aboard=EVERY_KIND), make(arrivals=calls)


def test_every_text_of_a_screen_is_in_the_tables(make: Make, around: Surroundings, walker: Any) -> None:
    for home in homes(make, around):
        names = named(home)
        for view in walker(home):
            assert [text for text in texts(view.cockpit.tree) if not from_table(text, names)] == [], view.name


@pytest.mark.slow
def test_every_answer_to_a_tap_is_in_the_tables(make: Make, around: Surroundings, walker: Any) -> None:
    """And the notice that goes with it. Resource ids, screens' names and signals stay as they are."""
    heard, unknown = set(), set()
    for home in homes(make, around):
        names = named(home)
        for view in walker(home):
            for widget in view.cockpit.tree.walk():
                if not widget.listens:
                    continue
                twin = view.cockpit.copy()
                feedback = twin.tap(*widget.rect.centre)
                for request in twin.drain_requests():
                    twin.answered(request, Answer(False, "the next junction is too near for another turn"))
                heard.add(feedback.text)
                forms = (feedback.text, IDENTIFIER.sub("0", feedback.text))
                if not any(from_table(text, names, answers=True) for text in forms):
                    unknown.add(feedback.text)
                notices = [notice.text for notice in twin._state.notices]
                assert [text for text in notices if not from_table(text, names)] == []
    assert unknown == set()
    assert len(heard) > 200


@pytest.mark.parametrize("language", LANGUAGES)
def test_an_answer_is_told_in_the_language_of_the_screens(make: Make, language: str) -> None:
    cockpit = make()
    expected = Feedback(FeedbackCode.OK, "Body.Lights.Hazard.IsSignaling is on")
    assert cockpit.spoken(cockpit.hazards(True)) == expected
    cockpit.inject(HMI.LANGUAGE.path, language)
    for feedback in (cockpit.hazards(False), cockpit.home(), cockpit.back(), cockpit.emergency_call()):
        spoken = cockpit.spoken(feedback)
        assert spoken.code is feedback.code
        assert spoken.text != feedback.text
    assert said(language, "Dinner is ready") == "Dinner is ready", "what people wrote is no answer"


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
    field = next(element for element in cockpit.elements() if element.resource_id == shown_id("map.search"))
    assert (field.text, field.hint_text) == ("Home", "Où aller ?")


def test_the_language_is_chosen_in_the_settings(make: Make) -> None:
    cockpit = make()
    cockpit.visit("language")
    assert press(cockpit, "language.de") is FeedbackCode.OK
    assert (
        next(element for element in cockpit.elements() if element.resource_id == shown_id("dock.phone")).text
        == "Telefon"
    )
    assert cockpit.open_app("phone").code is FeedbackCode.OK
