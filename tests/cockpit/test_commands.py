"""What was commanded is done once more elsewhere, in full or as far as it aims at some commands."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.map.commands import Guide
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import CABIN, HVAC, LIGHTS, MEDIA, difference
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    Answer,
    FeedbackCode,
    PullOver,
    Reroute,
    Severity,
    SlowDown,
)
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.episode.counterfactual import counterfactual, replayed

from .conftest import middle, outside

ACCEPTED = Answer(True, "so it is")


class Drive:
    """A drive with a hand-over, at whose cockpit one command is given in a second."""

    def __init__(self, cockpit: Cockpit) -> None:
        self.cockpit = cockpit
        self.before = cockpit.copy()
        self.moments: list[Any] = [self._moment(900.0)]

    def act(self, act: Callable[[Cockpit], object], answer: Answer = ACCEPTED) -> None:
        act(self.cockpit)
        for request in self.cockpit.drain_requests():
            self.cockpit.answered(request, answer)
        self.moments.append(self._moment(self.moments[-1].time_s + 1.0))
        self.cockpit.sense(self.moments[-1].surroundings, 1.0)

    def beyond(self, *keys: str) -> set[str]:
        """What differs from the counterfactual in which only these are commanded."""
        other = counterfactual(self.before, self.cockpit.given, self.moments, keys)
        return set(difference(other, self.cockpit.commands()))

    def _moment(self, time_s: float) -> Any:
        return SimpleNamespace(time_s=time_s, surroundings=outside(time_s))


@pytest.fixture
def drive(cockpit: Cockpit) -> Drive:
    cockpit.sense(outside(), 1.0)
    return Drive(cockpit)


def test_what_the_car_couples_to_a_command_belongs_to_it_and_one_switch_more_does_not(drive: Drive) -> None:
    drive.act(lambda cockpit: cockpit.command(HVAC.FRONT_DEFROSTER, True))
    assert drive.cockpit.signals[HVAC.AIR_CONDITIONING]
    assert drive.beyond(HVAC.FRONT_DEFROSTER.path) == set()
    drive.act(lambda cockpit: cockpit.command(HVAC.REAR_DEFROSTER, True))
    assert drive.beyond(HVAC.FRONT_DEFROSTER.path) == {HVAC.REAR_DEFROSTER.path}
    assert HVAC.FRONT_DEFROSTER.path in drive.beyond()


def test_a_switch_that_is_coupled_to_the_goal_is_not_a_part_of_it(drive: Drive) -> None:
    drive.act(lambda cockpit: cockpit.command(HVAC.FAN_SPEED, 100.0))
    assert drive.beyond(HVAC.FAN_SPEED.path) == set()
    drive.act(lambda cockpit: cockpit.command(HVAC.AIR_CONDITIONING, True))
    assert drive.beyond(HVAC.FAN_SPEED.path) == {HVAC.AIR_CONDITIONING.path}


def test_a_detour_that_is_taken_back_leaves_nothing(drive: Drive) -> None:
    for value in (True, False):
        drive.act(lambda cockpit, on=value: cockpit.command(HVAC.MAX_COOLING, on))
    assert drive.beyond() == set()
    drive.act(lambda cockpit: cockpit.alert(Alert(AlertKind.SPEED, Severity.WARNING)))
    assert drive.beyond() == {"alerts"}
    assert drive.beyond("alerts") == set()


def test_of_several_windows_closed_at_once_each_counts(drive: Drive) -> None:
    for window in (CABIN.DRIVER_WINDOW, CABIN.PASSENGER_WINDOW):
        drive.cockpit.inject(window.path, 60.0)
    drive = Drive(drive.cockpit)
    for step in ("vehicle", "vehicle.tab.doors", "window.close_all"):
        drive.act(lambda cockpit, to=step: cockpit.open_app(to) if to == "vehicle" else press(cockpit, to))
    assert drive.beyond(CABIN.DRIVER_WINDOW.path) == {CABIN.PASSENGER_WINDOW.path}
    assert drive.beyond(CABIN.DRIVER_WINDOW.path, CABIN.PASSENGER_WINDOW.path) == set()


def test_two_entries_of_one_book_are_told_apart(drive: Drive) -> None:
    for step in ("parking", "parking.time.240"):
        drive.act(lambda cockpit, to=step: cockpit.open_app(to) if to == "parking" else press(cockpit, to))
    for step in ("climate", "hvac.comfort", "climate.schedule"):
        drive.act(lambda cockpit, to=step: cockpit.open_app(to) if to == "climate" else press(cockpit, to))
    assert drive.beyond("climate.schedule") == {"parking.minutes"}
    assert drive.beyond("parking.minutes") == {"climate.schedule"}


def test_the_road_replies_as_it_did(drive: Drive) -> None:
    drive.act(lambda cockpit: cockpit.ask_road(Reroute("e9_9")))
    assert drive.cockpit.commands()["navigation.destination"]
    assert drive.beyond("navigation.destination") == set()
    assert drive.beyond("requests") == {"requests", "navigation.destination"}
    drive.act(lambda cockpit: cockpit.ask_road(SlowDown(30.0)), Answer(False, "no"))
    assert drive.beyond("navigation.destination") == {"requests"}
    drive.act(lambda cockpit: cockpit.ask_road(PullOver()))
    assert drive.beyond("navigation.destination", "requests") == set()


def test_a_stop_slipped_in_on_the_way_is_no_part_of_the_destination(drive: Drive) -> None:
    stop, home = drive.cockpit.content["places"][:2]
    drive.act(lambda cockpit: cockpit._perform(Guide(stop, home)))
    assert drive.cockpit.commands()["navigation.onward"] == home
    assert "navigation.onward" in drive.beyond("navigation.destination")
    assert drive.beyond("navigation.destination", "navigation.onward") == set()


def test_what_is_refused_is_not_given(drive: Drive) -> None:
    drive.act(lambda cockpit: cockpit.command(LIGHTS.REAR_FOG, True))
    assert drive.cockpit.given == ()


def test_another_entry_is_not_what_play_was_asked_for(drive: Drive) -> None:
    drive.act(lambda cockpit: cockpit.open_app("media"))
    drive.act(lambda cockpit: press(cockpit, "media.entry.2"))
    assert drive.cockpit.signals[MEDIA.ACTION] == "PLAY"
    assert drive.beyond(MEDIA.ACTION.path) >= {MEDIA.SELECTED.path}
    assert drive.beyond(MEDIA.SELECTED.path) == set()


@pytest.mark.parametrize("seed", range(6))
def test_everything_done_again_commands_the_same(drive: Drive, seed: int) -> None:
    rng = np.random.default_rng(seed)
    apps = ("climate", "vehicle", "media", "map", "phone", "settings", "safety", "charging", "parking", "memo")
    for _ in range(60):
        if rng.random() < 0.25:
            name = apps[int(rng.integers(len(apps)))]
            drive.act(lambda cockpit, to=name: cockpit.open_app(to))
            continue
        able = [element for element in drive.cockpit.elements() if element.is_clickable]
        x, y = middle(able[int(rng.integers(len(able)))])
        drive.act(lambda cockpit, x=x, y=y: cockpit.tap(x, y), Answer(bool(rng.random() < 0.8), "said"))
    again = replayed(drive.before, drive.cockpit.given, drive.moments)
    assert difference(again.commands(), drive.cockpit.commands()) == {}
    assert drive.cockpit.given


def press(cockpit: Cockpit, key: str) -> FeedbackCode:
    return cockpit.tap(*middle(next(each for each in cockpit.elements() if each.resource_id == shown_id(key)))).code
