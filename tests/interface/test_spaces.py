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
from automotive_cosim.interface.spaces import (
    MOST_SOUNDS,
    SOUND_SAMPLES,
    action_space,
    decode,
    decode_action,
    encode,
    observation_space,
)
from automotive_cosim.voice.engines import as_wav

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


def test_the_latest_that_was_said_is_in_the_sound(observation):
    long = SOUND_SAMPLES - 1000
    for lengths, kept in (((800,), 1), ((800, 400, 100), 3), ((long, 600, 400), 3), ((long, 601, 400), 2),
                          ((300, SOUND_SAMPLES + 5), 1), ((9,) * (MOST_SOUNDS + 5), MOST_SOUNDS + 5)):  # fmt: skip
        levels = [(number + 1) / 2000 for number in range(len(lengths))]
        sounds = [np.full(length, level, np.float32) for length, level in zip(lengths, levels, strict=True)]
        seen = dataclasses.replace(observation("x", screenshot=SCREEN), sounds=tuple(map(as_wav, sounds)))
        encoded = encode(seen, ALL)
        assert observation_space(ALL, 1280, 720, with_sound=True).contains(encoded)
        assert not observation_space(ALL, 1280, 720).contains(encoded)
        sound = encoded["sound"]
        expected = np.concatenate(sounds[-kept:])[:SOUND_SAMPLES] * 32767
        assert (sound["count"], sound["length"]) == (min(len(lengths), MOST_SOUNDS), len(expected))
        assert np.array_equal(sound["samples"][: len(expected)], expected.astype(np.int16))
        assert not sound["samples"][len(expected) :].any()
