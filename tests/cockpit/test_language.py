"""The screens in other languages."""

import ast
import copy
import json
import pickle
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from string import Formatter
from typing import Any

import pytest
from babel.messages.catalog import Catalog

from automotive_cosim import cockpit as package
from automotive_cosim.cockpit.apps.map.state import TURN_LEFT
from automotive_cosim.cockpit.apps.media.state import Library
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.state import Directory
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import said, word
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.theme import Weight, face
from automotive_cosim.cockpit.widgets import Widget
from automotive_cosim.contracts import Answer, Feedback, FeedbackCode, Surroundings
from automotive_cosim.contracts.text import Quantity, Text, counted, joined, listed, say, say_in
from tests.cockpit.fingers import find, press

from . import catalogues

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
    roads = [root.parent / "traffic" / name for name in ("ego.py", "steering.py")]
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


def untold(text: str, names: frozenset[str]) -> Iterator[str]:
    """The parts of a text that no language would translate, but for names, numbers and units."""
    if isinstance(text, Text):
        fields = (value for value in text.fields.values() if isinstance(value, str))
        yield from (part for value in fields for part in untold(value, names))
    elif text not in names and set(LATIN.findall(text)) - INTERNATIONAL:
        yield text


def named(cockpit: Cockpit) -> frozenset[str]:
    """What keeps its name in every language: people, places, streets, music, and what people wrote."""
    state = cockpit._state
    names = {text for entry in state.of(Library).by_uri.values() for text in (entry.title, entry.by)}
    names |= {playlist.name for playlist in state.of(Library).playlists} | set(state.roads.names)
    names |= {text for place in state.of(Gazetteer).places for text in (place.name, place.street)}
    names |= {contact.name for contact in state.of(Directory).contacts}
    names |= {line for thread in state.of(Directory).threads for line in thread.lines}
    return frozenset(names | {"Home-5G", "CityFree", "Garage", "Coffee-Guest"})


IDENTIFIER = re.compile(r"#?[A-Za-z0-9_]+(?:\.[A-Za-z0-9_]+)*")
"""A resource id, a signal, its value, or a screen's name."""


def texts(widget: Widget) -> Iterator[str]:
    for one in widget.walk():
        yield from (getattr(one, name) for name in TEXTS if getattr(one, name, ""))


@pytest.fixture(scope="module")
def now() -> Catalog:
    return catalogues.written()


def messages(language: str) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """The forms of every message in English and in that language."""
    for message in catalogues.known(language):
        if message.id:
            yield catalogues.strings(message.id), catalogues.strings(message.string)


def fields(form: str) -> list[str]:
    return sorted(name for _, name, _, _ in Formatter().parse(form) if name is not None)


def test_there_is_a_catalogue_of_every_language() -> None:
    assert catalogues.languages() == tuple(sorted(LANGUAGES))


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_catalogue_has_the_texts_of_the_code_and_no_others(language: str, now: Catalog) -> None:
    """If not: ``python -m tests.cockpit.catalogues --renew``, and translate what is empty."""
    assert len(catalogues.keys(now)) > 800
    assert list(catalogues.differences(language, now)) == []
    assert catalogues.text(catalogues.renewed(language, now)) == (catalogues.FOLDER / f"{language}.po").read_bytes()


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_translation_keeps_the_fields(language: str) -> None:
    for english, told in messages(language):
        assert all(fields(form) == fields(english[-1]) for form in (*english, *told)), english
        assert all(form.strip() == form != "" for form in told), english
    assert not any(message.fuzzy for message in catalogues.known(language) if message.id)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_letter_has_a_glyph(language: str) -> None:
    for words in (form for _, told in messages(language) for form in told):
        letters = face(words, Weight.MEDIUM, 20)
        missing = bytes(letters.getmask("\U0010fffe"))
        for letter in re.sub(r"\{\w+\}| ", "", words):
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
                words = LATIN.findall(said(text, "ja"))
                left |= {(word, text) for word in words if word not in own | INTERNATIONAL}
    assert left == set()


def test_every_text_of_a_notice_or_an_answer_can_be_told_in_other_languages() -> None:
    """As the source has them, whether or not a test comes by: notices, refusals, what the road and taps say."""
    plain = source_texts(SHOWN, SAYING) | source_texts(TOLD, ())
    assert {text: file for text, file in plain.items() if LATIN.search(text.replace("{}", ""))} == {}


EVERY_KIND = tuple(
    Occupant(seat, kind, asleep=kind is Kind.BABY, belted=kind is not Kind.OBJECT)
    for seat, kind in zip(list(Seat)[1:], (Kind.CHILD, Kind.BABY, Kind.PET, Kind.OBJECT), strict=True)
)


def homes(make: Make, around: Surroundings) -> tuple[Cockpit, ...]:
    standing = replace(around, driving=replace(around.driving, speed_mps=0.0))
    parked = {"Vehicle.Powertrain.Transmission.Gear": "P"}
    calls = [Arrival("message", 0.0), Arrival("call", 0.0)]
    return make(), make(surroundings=standing, signals=parked, aboard=EVERY_KIND), make(arrivals=calls)


def test_every_text_of_a_screen_can_be_told_in_other_languages(
    make: Make, around: Surroundings, walker: Any
) -> None:
    for home in homes(make, around):
        names = named(home)
        for view in walker(home):
            assert [part for text in texts(view.cockpit.tree) for part in untold(text, names)] == [], view.name


@pytest.mark.slow
def test_every_answer_to_a_tap_can_be_told_in_other_languages(
    make: Make, around: Surroundings, walker: Any
) -> None:
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
                    twin.answered(request, Answer(False, say("the next junction is too near for another turn")))
                heard.add(feedback.text)
                parts = [part for part in untold(feedback.text, names) if not IDENTIFIER.fullmatch(part)]
                notices = (part for notice in twin._state.notices for part in untold(notice.text, names))
                unknown |= {*parts, *notices}
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
    assert said("Thank you", language) == "Thank you", "what people wrote is no text of the screens"


def test_what_varies_is_translated_in_turn() -> None:
    assert said(say("Sent to {to}: {text}", to="Ada Adler", text=say("Thank you")), "de") == "An Ada Adler: Danke"
    assert said(TURN_LEFT, "fr") == "Tournez à gauche"
    detail = say("{power} kW, {free} of {total} free", power=300, free=1, total=3)
    assert said(detail, "ja") == "300 kW、3台中1台空き"


@pytest.mark.parametrize("language", ["fr", "de"])
def test_figures_have_the_decimal_sign_of_the_language(
    make: Make, around: Surroundings, walker: Any, language: str
) -> None:
    shown = {
        said(text, language)
        for home in homes(make, around)
        for view in walker(home)
        for text in texts(view.cockpit.tree)
        if re.search(r"\d[.,]\d", said(text, language))
    }
    assert len(shown) > 15
    assert [text for text in shown if re.search(r"\d\.\d", text) and "MHz" not in text] == [], "stations are data"
    assert said(say("Paid {price}", price=Quantity("4.50")), "ja").endswith("4.50")


def test_what_is_counted_has_the_forms_of_its_language() -> None:
    told = {n: counted("{n} new message", "{n} new messages", n) for n in (0, 1, 2)}
    assert list(told.values()) == ["0 new messages", "1 new message", "2 new messages"]
    assert said(told[1], "de") == "1 neue Nachricht"
    assert said(told[2], "de") == "2 neue Nachrichten"
    assert said(told[0], "fr") == "0 nouveau message", "French counts none like one"


def test_the_same_word_has_several_meanings() -> None:
    assert said(say("Home"), "de") == "Zuhause"
    assert said(say_in("dock", "Home"), "de") == "Start"


def test_a_text_stays_one_on_its_way() -> None:
    text = say("Sent to {to}: {text}", to="Ada", text=counted("{n} track", "{n} tracks", 2))
    for copied in (copy.copy(text), copy.deepcopy(text), pickle.loads(pickle.dumps(text))):
        assert copied == str(text) == "Sent to Ada: 2 tracks"
        assert isinstance(copied, Text)
        assert said(copied, "de") == said(text, "de") == "An Ada: 2 Titel"
    assert hash(text) == hash(str(text))
    assert json.dumps(text) == json.dumps(str(text))


def test_braces_of_others_are_no_fields() -> None:
    assert said(say("Sent to {to}: {text}", to="{x}", text="{0} {text}"), "de") == "An {x}: {0} {text}"
    assert listed(("a", say("low beam"), "{b}")) == "a, low beam, {b}"
    assert said(joined(" ", ("{a}", say("Thank you"))), "de") == "{a} Danke"


def test_a_word_without_fields_is_found_by_itself() -> None:
    assert (word("Locks", "de"), word("Kaya Duval", "de"), word("", "de")) == ("Verriegelung", "Kaya Duval", "")
    assert word("Locks", "en") == "Locks"


def test_what_was_typed_stays(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=replace(around, driving=replace(around.driving, speed_mps=0.0)))
    cockpit.inject(HMI.LANGUAGE.path, "fr")
    cockpit.visit("map")
    press(cockpit, "map.search")
    cockpit.type_text("Home")
    field = find(cockpit, "map.search")
    assert (field.text, field.hint_text) == ("Home", "Où aller\u202f?")


def test_the_language_is_chosen_in_the_settings(make: Make) -> None:
    cockpit = make()
    cockpit.visit("language")
    assert press(cockpit, "language.de") is FeedbackCode.OK
    assert find(cockpit, "dock.phone").text == "Telefon"
    assert cockpit.open_app("phone").code is FeedbackCode.OK
