"""The on-screen keyboard."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import Element, FeedbackCode, Surroundings
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.contracts.ids import key_of
from tests.cockpit.fingers import find, press
from tests.laws import over

from .conftest import outside, town

FIELDS = {"map": "map.search", "media": "media.search", "manual": "manual.search"}


def has_keys(cockpit: Cockpit) -> bool:
    return any(key_of(element.resource_id).startswith("keyboard.") for element in cockpit.elements())


def entries(cockpit: Cockpit) -> list[Element]:
    return [each for each in cockpit.elements() if key_of(each.resource_id).startswith("media.entry.")]


@pytest.fixture
def standing(make: Callable[..., Cockpit], around: Surroundings) -> Cockpit:
    return make(surroundings=replace(around, driving=replace(around.driving, speed_mps=0.0)))


@pytest.mark.parametrize("screen", FIELDS)
def test_a_tap_on_a_field_brings_the_keys_and_they_write_into_it(standing: Cockpit, screen: str) -> None:
    standing.visit(screen)
    assert not has_keys(standing)
    assert press(standing, FIELDS[screen]) is FeedbackCode.OK
    assert not any(key_of(element.resource_id).startswith("dock.") for element in standing.elements())
    press(standing, "keyboard.f", "keyboard.o", "keyboard.k", "keyboard.backspace", "keyboard.g", "keyboard.space")
    assert find(standing, FIELDS[screen]).text == "fog "


def test_enter_takes_the_first_result(standing: Cockpit) -> None:
    standing.visit("manual")
    press(standing, "manual.search", "keyboard.f", "keyboard.o", "keyboard.g", "keyboard.enter")
    assert not has_keys(standing)
    assert any(element.is_selected and "og" in element.text for element in standing.elements())


def test_enter_is_off_while_nothing_fits(standing: Cockpit) -> None:
    standing.visit("map")
    press(standing, "map.search", *(f"keyboard.{letter}" for letter in "zqzq"))
    assert press(standing, "keyboard.enter") is FeedbackCode.DISABLED


def test_folded_keys_leave_the_text_and_the_whole_list(standing: Cockpit) -> None:
    standing.visit("media")
    press(standing, "media.search", "keyboard.r")
    rows = entries(standing)
    assert press(standing, "keyboard.hide") is FeedbackCode.OK
    more = entries(standing)
    assert (has_keys(standing), find(standing, "media.search").text) == (False, "r")
    assert len(more) > len(rows) > 0


def test_text_that_is_typed_at_once_folds_the_keys_and_can_be_entered(standing: Cockpit) -> None:
    standing.visit("manual")
    press(standing, "manual.search")
    assert standing.type_text("ice").code is FeedbackCode.OK
    assert not has_keys(standing)
    assert standing.key_enter().code is FeedbackCode.OK


def test_driving_off_folds_the_keys(standing: Cockpit, around: Surroundings) -> None:
    standing.visit("map")
    press(standing, "map.search")
    standing.sense(around, 1.0)
    assert not has_keys(standing)
    assert press(standing, "map.search") is FeedbackCode.RESTRICTED


@pytest.mark.parametrize(("language", "letter"), [("fr", "é"), ("de", "ß"), ("ja", "q"), ("en", "'")])
def test_each_language_has_its_keys(standing: Cockpit, language: str, letter: str) -> None:
    standing.inject(HMI.LANGUAGE.path, language)
    standing.visit("map")
    assert press(standing, "map.search", f"keyboard.{letter}") is FeedbackCode.OK
    assert find(standing, "map.search").text == letter


@over(product((name for name in CarMake if name is not CarMake.DRAWN), ScreenSize))
def test_the_keys_of_no_make_cover_the_field_they_write_into(name: CarMake, size: ScreenSize) -> None:
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), size=size, make=make_named(name))
    cockpit.inject("Vehicle.Powertrain.Transmission.Gear", "P")
    cockpit.sense(outside(speed_kmh=0.0), 0.0)
    for screen, field in (FIELDS | {"figure": "figure.own"}).items():
        cockpit.visit(screen)
        if screen == "figure":
            press(cockpit, "figure.say.own")
        press(cockpit, field)
        assert find(cockpit, field).is_focused
