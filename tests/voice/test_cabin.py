"""How loud the cabin is, and who understands whom in it."""

import math

import pytest

from automotive_cosim.cockpit.signals import CABIN, CALL, HVAC, MEDIA, VOICE
from automotive_cosim.voice.cabin import OPENINGS, driver_snr_db, is_understood, level_db, sources, voices
from tests.drives.scenes import moment, vehicle
from tests.laws import over

QUIET = {HVAC.FAN_SPEED.path: 0.0, MEDIA.ACTION.path: "STOP"}
OPEN = QUIET | {CABIN.DRIVER_WINDOW.path: 100.0}
AJAR, RAIN = {CABIN.DRIVER_WINDOW.path: 10.0}, {"precipitation": 2.0}


def at(kmh, signals=QUIET, **changes):
    return moment(kmh=kmh, signals=QUIET | signals, **changes)


LOUDER = [
    ("faster", at(50.0), at(130.0)),
    ("on a wet road", at(80.0), at(80.0, precipitation=1.0)),
    ("in more rain", at(0.0, **RAIN), at(0.0, precipitation=20.0)),
    ("with a window open", at(80.0), at(80.0, OPEN)),
    ("with it further open", at(80.0, AJAR), at(80.0, OPEN)),
    ("with more fan", at(0.0, {HVAC.FAN_SPEED.path: 20.0}), at(0.0, {HVAC.FAN_SPEED.path: 80.0})),
    ("with music", at(0.0), at(0.0, {MEDIA.ACTION.path: "PLAY"})),
    ("in a call", at(0.0), at(0.0, {CALL.PARTNER.path: "Ann"})),
    ("with a siren near", at(50.0), at(50.0, emergency_behind=vehicle(60.0))),
    ("with it nearer", at(50.0, emergency_behind=vehicle(60.0)), at(50.0, emergency_behind=vehicle(10.0))),
]


@over(LOUDER)
def test_each_source_is_heard_and_makes_words_harder_to_hear(what, less, more):
    low, high = level_db(less), level_db(more)
    assert low < high - 0.5
    assert driver_snr_db(low) > driver_snr_db(high)


@over([(50.0, 58.0, 3.0), (100.0, 66.0, 3.0), (130.0, 70.0, 3.0)])
def test_a_closed_car_is_as_loud_as_measured(kmh, db, within):
    assert level_db(moment(kmh=kmh, signals=QUIET)) == pytest.approx(db, abs=within)


@over([(88.5, 85.3), (120.7, 89.9)])
def test_a_car_with_all_open_is_as_loud_as_with_an_open_roof(kmh, db):
    """Mikulec et al. 2011."""
    opened = QUIET | {each.path: 100.0 for each in OPENINGS}
    assert level_db(moment(kmh=kmh, signals=opened)) == pytest.approx(db, abs=0.5)


def test_levels_add_up_by_their_energy_and_what_is_silent_is_not_listed():
    here = moment(kmh=130.0, signals=OPEN)
    found = dict(sources(here))
    assert set(found) == {"at rest", "tyres and wind", "openings"}
    assert level_db(here) == pytest.approx(10 * math.log10(sum(10 ** (db / 10) for db in found.values())))
    muted = QUIET | {MEDIA.ACTION.path: "PLAY", MEDIA.MUTED.path: True}
    assert "media" not in dict(sources(moment(signals=muted)))


def test_others_are_noise_while_they_speak_and_the_radio_is_media():
    said = [(10.0, ["Left.", "From the rear left seat: Are we there yet? I am so very hungry."])]
    said.append((12.0, ["From the passenger seat: Not yet.", "From the loudspeakers: The news at noon."]))
    assert [voices(said, at_s) for at_s in (9.9, 10.0, 12.0, 13.0, 16.0)] == [0, 1, 2, 1, 0]
    here = moment(kmh=0.0, signals=QUIET)
    assert level_db(here, 1) == pytest.approx(60.0, abs=0.5)
    assert level_db(here, 2) - level_db(here, 1) == pytest.approx(3.0, abs=0.2)
    assert understood(0.0, QUIET)
    assert not understood(0.0, QUIET | {VOICE.GUIDANCE_VOLUME.path: 25.0}, 2)


def understood(kmh, signals, others=0):
    here = moment(kmh=kmh, signals=signals)
    return is_understood(here, level_db(here, others))


def test_the_driver_understands_the_car_unless_it_is_loud_or_its_voice_is_off():
    assert understood(130.0, QUIET)
    assert not understood(130.0, OPEN)
    assert understood(130.0, OPEN | {VOICE.GUIDANCE_VOLUME.path: 100.0})
    assert not understood(0.0, QUIET | {VOICE.GUIDANCE_VOLUME.path: 0.0})
