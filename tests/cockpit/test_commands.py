"""What was commanded is done once more elsewhere, in full or as far as it aims at some commands."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from inspect import isabstract
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.map.commands import Guide
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.cockpit.signals import CABIN, HVAC, LIGHTS, MEDIA, MOTION, difference
from automotive_cosim.cockpit.state import Command, Message, State
from automotive_cosim.cockpit.widgets import Slider, Widget
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    Answer,
    Feedback,
    FeedbackCode,
    PullOver,
    Reroute,
    RoadNetwork,
    RouteOption,
    Severity,
    SlowDown,
)
from automotive_cosim.episode.episode import counterfactual, replayed
from tests.cockpit.fingers import middle, press

from .conftest import View, outside

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


def test_a_destination_may_be_a_place_that_the_driver_has_saved(drive: Drive) -> None:
    """The road knows only its edges."""
    place = drive.cockpit.content["places"][0]
    drive.act(lambda cockpit: cockpit.ask_road(Reroute(place)))
    ((request, _),) = drive.cockpit.given[-1].answers
    assert isinstance(request, Reroute)
    assert request.destination not in ("", place)
    assert drive.cockpit.commands()["navigation.destination"] == place


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


# --- laws over all commands -----------------------------------------------------------------------------------

ELSEWHERE = {"Ask", "AskDriver", "Pan"}
"""Sent by a safety call, by an action and by a swipe, not by a widget's tap."""


def classes(kind: type[Message]) -> Iterator[type[Message]]:
    """Every class of messages."""
    apps()
    for each in kind.__subclasses__():
        yield each
        yield from classes(each)


def sent(widget: Widget) -> Iterator[Message]:
    """What touches of a widget send."""
    for touch in ("on_tap", "on_hold", "on_double_tap", "on_enter"):
        message = getattr(widget, touch, None)
        if isinstance(message, Message):
            yield message
    if isinstance(widget, Slider):
        yield widget.message_by(1)


def offered(views: tuple[View, ...]) -> Iterator[tuple[State, Message]]:
    """Every message that a widget of these views sends."""
    for view in views:
        for widget in view.cockpit.tree.walk():
            if widget.usable:
                yield from ((view.cockpit._state, message) for message in sent(widget))


@pytest.fixture(scope="module")
def everywhere(walker: Callable[[Cockpit], tuple[View, ...]], network: RoadNetwork) -> list[tuple[State, Message]]:
    """Every message that the screens of a parked car offer, also with an alert, a caller, and during a call."""
    parked = outside(speed_kmh=0.0)
    other = RouteOption(("e6_5", "n7_5"), 900.0, 120.0, 10.0)
    ahead = replace(parked.driving.ahead, alternatives=(other,))
    parked = replace(parked, driving=replace(parked.driving, ahead=ahead))
    calls = [Arrival("call", 1.0, "Ada Adler")]
    cockpit = Cockpit(network, rng=np.random.default_rng(1), arrivals=calls, lookout=True)
    cockpit.inject(MOTION.GEAR.path, "P")
    cockpit.sense(parked, 0.0)
    warned, ringing = cockpit.copy(), cockpit.copy()
    warned.alert(Alert(AlertKind.SPEED, Severity.WARNING))
    ringing.sense(outside(902.0, speed_kmh=0.0), 2.0)
    talking = ringing.copy()
    press(talking, "call.answer; open phone")
    also = tuple(
        View(name, (), there) for name, there in (("warned", warned), ("ringing", ringing), ("talking", talking))
    )
    return list(offered((*walker(cockpit), *also)))


def test_a_command_without_aims_or_effect_cannot_be_made() -> None:
    commands = [each for each in classes(Command) if each.__module__.startswith("automotive_cosim.")]
    assert len(commands) > 20
    assert not [each for each in commands if isabstract(each)]

    @dataclass(frozen=True, slots=True)
    class Forgotten(Command):
        def perform(self, state: State) -> Feedback:
            return Feedback(FeedbackCode.OK, "")

    with pytest.raises(TypeError, match="aims"):
        Forgotten()  # type: ignore[abstract]


@pytest.mark.slow
def test_every_message_is_offered_somewhere(everywhere: list[tuple[State, Message]]) -> None:
    known = {each.__name__ for each in classes(Message) if each.__module__.startswith("automotive_cosim.")}
    assert {type(message).__name__ for _, message in everywhere} == known - ELSEWHERE - {"Command"}


@pytest.mark.slow
def test_only_a_command_commands_and_it_aims_at_what_it_commands(everywhere: list[tuple[State, Message]]) -> None:
    """What it changes besides is coupled: by the car to a signal, or by the road, which has not replied yet."""
    wrong = []
    for state, message in everywhere:
        before, there = state.commands(), state.copy()
        aims = message.command.aims(state) if message.command is not None else frozenset()
        there.perform(message)
        changed = set(difference(before, there.commands()))
        data = {key for key in changed if not key.startswith("Vehicle.")}
        if not aims <= before.keys() or (changed and not aims) or (data and not data & aims and not there.pending):
            wrong.append((message, aims, changed))
    assert not wrong


@pytest.mark.slow
def test_what_is_given_once_more_commands_the_same(everywhere: list[tuple[State, Message]]) -> None:
    wrong = []
    for state, message in everywhere:
        there, twin = state.copy(), state.copy()
        there.perform(message)
        for record in there.given[len(state.given) :]:
            record.command.repeat(twin, record, record.aims)
            wrong += [message] if difference(there.commands(), twin.commands()) else []
            untouched = state.copy()
            record.command.repeat(untouched, record, frozenset())
            wrong += [message] if difference(state.commands(), untouched.commands()) else []
    assert not wrong
