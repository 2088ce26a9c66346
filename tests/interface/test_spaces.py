"""Typed observations and actions go into their spaces and come back."""

import dataclasses

import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.cockpit.actions import check
from automotive_cosim.contracts import UNCALLED, GpsFix
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.spaces import action_space, decode, decode_action, encode, observation_space

SCREEN = np.zeros((720, 1280, 3), np.uint8)


@pytest.fixture
def full(observation):
    return observation("Keep me warm, s'il vous plaît", screenshot=SCREEN)


def test_a_sample_lies_in_its_space(full):
    assert observation_space(ALL, 1280, 720).contains(encode(full, ALL))


@pytest.mark.parametrize("withheld", Channel)
def test_a_withheld_channel_is_absent(full, withheld):
    channels = ALL - {withheld}
    encoded = encode(full, channels)
    assert str(withheld) not in encoded
    assert observation_space(channels, 1280, 720).contains(encoded)


def test_what_was_encoded_comes_back(full):
    back = decode(encode(full, ALL))
    assert back.goal == full.goal
    assert back.context == full.context
    assert back.connectivity == full.connectivity
    assert back.feedback == full.feedback
    for part in ("vehicle", "gps"):
        sent, got = dataclasses.asdict(getattr(full, part)), dataclasses.asdict(getattr(back, part))
        numbers = {name for name, value in sent.items() if isinstance(value, float)}
        assert {name: got[name] for name in numbers} == pytest.approx({name: sent[name] for name in numbers})
        assert {name: got[name] for name in got.keys() - numbers} == {
            name: sent[name] for name in sent.keys() - numbers
        }
    assert [dataclasses.replace(element, package_name="automotive") for element in back.elements] == list(
        full.elements
    )


def test_no_receiver_and_no_fix_differ(observation):
    for gps in (None, GpsFix(False, 2.0, 48.0, 30.0, 12.0, 90.0)):
        back = decode(encode(observation("x", gps=gps, screenshot=SCREEN), ALL))
        assert (back.gps is None) == (gps is None)


def test_values_beyond_the_bounds_are_clipped(observation, vehicle):
    wild = observation("x", vehicle=vehicle(speed_kmh=1e9, leader_gap_m=1e12), screenshot=SCREEN)
    assert observation_space(ALL, 1280, 720).contains(encode(wild, ALL))


@given(st.text(max_size=700))
def test_any_text_fits(observation, text):
    encoded = encode(observation(text), ALL - {Channel.SCREENSHOT})
    assert observation_space(ALL - {Channel.SCREENSHOT}, 1280, 720).contains(encoded)
    assert text.replace("\0", "").startswith(decode(encoded).goal.replace("\0", ""))


def test_every_call_gives_arrays_of_its_own(full):
    first, second = encode(full, ALL), encode(full, ALL)
    assert data_equivalence(first, second)
    assert not np.shares_memory(first["screenshot"], second["screenshot"])
    assert not np.shares_memory(first["elements"]["text"], second["elements"]["text"])


def test_every_sample_is_a_well_formed_action():
    space = action_space(1280, 720)
    space.seed(0)
    kinds = set()
    for _ in range(600):
        action = decode_action(space.sample())
        assert check(action) is action
        kinds.add(action.action_type)
    assert kinds == set(UNCALLED)
