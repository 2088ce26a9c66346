"""Failure classes on planted faults: agents that know the way and go wrong in one respect, on the small grid."""

from collections import Counter, deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import pytest

from automotive_cosim.agents import Oracle, Stage, StageName
from automotive_cosim.contracts import Action, ActionType, AlertKind, Direction, GoalStatus, Observation, Reason
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.interface.observe import Channel
from automotive_cosim.report.failures import FailureClass, failure_class
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.rows import EpisodeRow, PartsHeld
from automotive_cosim.run.trial import run_trial
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

FAN, HANDS, SEAT = "hvac_fan_max", "hvac_cold_hands", "hvac_driver_seat_heater"
WHOSE = "hvac_ask_which_seat"
FRONT, REAR, SPEED = "phenomenon_front_window_fogged", "phenomenon_rear_window_fogged", "road_speed_80_in_50"
DONE = Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)


def declines(status: GoalStatus, reason: Reason = Reason.NONE) -> Action:
    return Action(ActionType.STATUS, goal_status=status, reason=reason)


class _Planted:
    """Plays a list of actions, or of functions of the observation that give one."""

    name = model = "planted"
    channels = frozenset({Channel.ELEMENTS})

    def __init__(self, moves: Sequence[Action | Callable[[Observation], Action]], thought: str = "") -> None:
        self._moves = deque(moves)
        self._thought = thought

    def reset(self, goal: str) -> None:
        """There is nothing to forget."""

    @property
    def stages(self) -> Sequence[Stage]:
        return (Stage(StageName.INTERPRET, self._thought, 0.0),) if self._thought else ()

    def act(self, observation: Observation) -> Action:
        move = self._moves.popleft() if self._moves else Action(ActionType.WAIT, seconds=1)
        return move if isinstance(move, Action) else move(observation)


def opens(app: str) -> Action:
    return Action(ActionType.OPEN_APP, app_name=app)


def tap(resource_id: str, off: int = 0) -> Callable[[Observation], Action]:
    """Taps an element, or the clickable one so many places after it."""

    def act(observation: Observation) -> Action:
        elements = observation.elements or ()
        index = next((i for i, each in enumerate(elements) if each.resource_id == shown_id(resource_id)), None)
        if index is None:  # below the fold
            number = next(i for i, each in enumerate(elements) if each.is_scrollable)
            return Action(ActionType.SCROLL, direction=Direction.DOWN, index=number)
        near = [i for i, each in enumerate(elements) if each.is_clickable and each.is_enabled]
        return Action(ActionType.CLICK, index=near[(near.index(index) + off) % len(near)])

    return act


def at(x: int, y: int) -> Action:
    return Action(ActionType.CLICK, x=x, y=y)


def of(task: str, half: str = "first") -> list[Action | Callable[[Observation], Action]]:
    """The reference solution of another task or half, then ``complete``."""

    oracle = Oracle()
    oracle.brief(draw(CATALOGUE[task], half, 0))
    return [oracle.act] * 6


SCROLL = Action(ActionType.SCROLL, direction=Direction.DOWN)
HOME, BACK = Action(ActionType.NAVIGATE_HOME), Action(ActionType.NAVIGATE_BACK)

PLANTED: dict[FailureClass, list[tuple[str, str, Sequence[Any], str]]] = {
    FailureClass.GROUNDING: [
        (FAN, "first", [opens("climate"), tap("hvac.fan.max", 1), DONE], "I press Max."),
        (FAN, "first", [opens("climate"), tap("hvac.fan.max", -1), DONE], "I press Max."),
        (FAN, "first", [opens("climate"), at(3, 3), at(4, 3), DONE], ""),
        (HANDS, "first", [opens("climate"), at(2, 700), at(2, 702), at(3, 701), DONE], ""),
        (SEAT, "first", [opens("climate"), Action(ActionType.CLICK, index=4000), DONE], ""),
        (FRONT, "first", [opens("climate"), Action(ActionType.CLICK, index=999), at(1, 1), DONE], ""),
    ],
    FailureClass.NAVIGATION: [
        (FAN, "first", [opens("media"), HOME, opens("phone"), BACK, DONE], ""),
        (HANDS, "first", [HOME, BACK, HOME, BACK, DONE], ""),
        (SEAT, "first", [opens("settings"), SCROLL, SCROLL, HOME], ""),
        (FRONT, "first", [opens("map"), HOME, opens("media"), HOME], ""),
        (REAR, "first", [opens("phone"), BACK, opens("settings"), DONE], ""),
        (FAN, "first", [opens("settings"), HOME] * 10, ""),
    ],
    FailureClass.INTENT: [
        (FAN, "first", of(SEAT), ""),
        (FAN, "first", of(REAR), ""),
        (SEAT, "first", of(FAN), ""),
        (HANDS, "first", of(REAR), ""),
        (SEAT, "first", of(FRONT), ""),
        (HANDS, "first", [declines(GoalStatus.INFEASIBLE, Reason.NOT_POSSIBLE)], ""),
        (WHOSE, "first", of(WHOSE, "second"), ""),
        (WHOSE, "second", of(WHOSE, "first"), ""),
    ],
    FailureClass.VEHICLE_STATE: [
        (FRONT, "first", of(FRONT, "second"), ""),
        (REAR, "first", of(REAR, "second"), ""),
        (FAN, "first", [DONE], ""),
        (SEAT, "first", [declines(GoalStatus.NOT_NEEDED, Reason.ALREADY_SO)], ""),
        (FRONT, "first", [opens("climate"), tap("hvac.front_defroster"), tap("hvac.front_defroster"), DONE], ""),
        (FAN, "first", [opens("climate"), tap("hvac.fan.max")], ""),
        (REAR, "first", [opens("climate"), tap("hvac.rear_defroster"), tap("hvac.rear_defroster"), DONE], ""),
    ],
    FailureClass.SAFETY: [
        (SPEED, "first", [declines(GoalStatus.NOT_NEEDED)], ""),
        (SPEED, "first", [Action(ActionType.SHOW_ALERT, kind=AlertKind.FATIGUE), DONE], ""),
        (FRONT, "first", [declines(GoalStatus.INFEASIBLE, Reason.SAFETY)], ""),
        (REAR, "first", [Action(ActionType.SHOW_ALERT, kind=AlertKind.VISIBILITY), DONE], ""),
        (FAN, "first", [Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED), *of(FAN)], ""),
        (FRONT, "first", [declines(GoalStatus.NOT_NEEDED, Reason.LAW)], ""),
    ],
}


def classified(task: str, half: str, moves: Sequence[Any], thought: str, simulations: Simulations) -> FailureClass:
    setup = EpisodeSetup(task, half, "grid", agent="planted", model="planted")
    recorder = Recorder(setup, None)
    row = run_trial(setup, _Planted(moves, thought), [recorder], simulations=simulations)
    assert isinstance(row, EpisodeRow)
    assert row.success is False, row.error
    return failure_class(row, recorder.lines)


@pytest.mark.slow
@pytest.mark.parametrize("planted", PLANTED)
def test_of_five_planted_faults_of_a_class_four_are_told(planted, simulations):
    faults = PLANTED[planted]
    assert len(faults) >= 5
    told = Counter(classified(*fault, simulations) for fault in faults)
    assert told[planted] >= 0.8 * len(faults), told


def test_doing_nothing_is_of_no_class():
    step = {"step": 0, "elements": [], "action": None, "feedback": {"code": "none"}, "thought": ""}
    wait = step | {"step": 1, "action": {"action_type": "wait"}, "feedback": {"code": "ok"}}
    parts = PartsHeld(goal=False, clean=True, safe=True, in_time=False, declared=False)
    row = replace(EpisodeSetup(FAN).planned(), success=False, parts=parts)
    assert failure_class(row, [step, wait, {"result": {}}]) is FailureClass.UNCLASSIFIED
    assert failure_class(replace(row, task="gone"), [step]) is FailureClass.UNCLASSIFIED
