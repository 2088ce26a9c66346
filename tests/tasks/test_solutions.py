"""Laws over every half's reference solutions on a bare cockpit: clean as they are, but not with one switch more."""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.cockpit import actions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import Language
from automotive_cosim.cockpit.signals import ACTUATORS, HMI, difference, named
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import ActionType, Answer, Feedback, FeedbackCode, Observation, RoadNetwork
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.episode.episode import counterfactual
from automotive_cosim.episode.situation import PARKED
from automotive_cosim.proof.mutations import another_value
from automotive_cosim.tasking import verdict
from automotive_cosim.tasking.instance import Instance, draw
from automotive_cosim.tasking.moves import Move
from automotive_cosim.tasking.task import Half, Start, Task
from automotive_cosim.tasking.ways import units_in
from automotive_cosim.tasks import CATALOGUE
from tests.laws import hold

from ..cockpit.conftest import outside, town


def _is_here(half: Half) -> bool:
    """Whether it can be solved without traffic, where this road leads to no other and all has been said at once."""
    goal, is_said_later = repr(half.goal), any(says.time_s for says in half.says)
    return "asked_on" not in goal and not (is_said_later and "watched" in goal)


HALVES = [(task, name) for task in CATALOGUE.values() for name in task.halves if _is_here(task.half(name))]
OTHER_SIZES = (ScreenSize.WIDE, ScreenSize.PORTRAIT)
SAMPLED = [
    pytest.param(task, "first", size, id=f"{task.id}-{size}")
    for module in sorted({task.module for task in CATALOGUE.values()})
    for task, size in zip([task for task in CATALOGUE.values() if task.module == module], OTHER_SIZES, strict=False)
]
"""Two tasks of every module, one on each of the other screens."""
GROUPS = 32
"""Tests over as many parts of the halves: each plays its halves once, and a worker takes one after the other."""
SAMPLE, QUARTER = (
    [part if part < tried else pytest.param(part, marks=pytest.mark.proof) for part in range(GROUPS)]
    for tried in (1, GROUPS // 4)
)
"""Some halves of all modules; the others are proofs."""
SPOKEN = [
    (task, half, language)
    for number, (task, half) in enumerate((task, half) for task, half in HALVES if task.spoken)
    for language in [sorted(task.spoken)[number % len(task.spoken)]]
]
"""Each half in one of the languages, in turn."""
MAKES = [make for make in CarMake if make not in (CarMake.HOME, CarMake.DRAWN)]
MADE = [(task, half, make) for make in MAKES for task, half in HALVES]
MADE_PARTS = len(MAKES) * GROUPS
FROM_S = 900.0
SECONDS_LIMIT = 120

pytestmark = pytest.mark.slow


@dataclass
class _Solved:
    """A reference solution, played to its declaration."""

    cockpit: Cockpit
    moments: list[Any]
    beside: dict[str, Any]
    """What the counterfactual commands at the end."""

    def surplus(self, cockpit: Cockpit, allowed: frozenset[str]) -> set[str]:
        """What that cockpit commands and was not asked for."""
        return set(difference(self.beside, cockpit.commands())) - allowed - verdict.SPOKEN


@pytest.fixture(scope="module")
def network() -> RoadNetwork:
    """The town, of which one street has the name that some tasks ask for on their own roads."""
    made = town()
    last = replace(made.roads[-1], name="Main road 1")
    return replace(made, roads=(*made.roads[:-1], last))


def _at(start: Start, time_s: float) -> Any:
    around = outside(time_s, 0.0 if start.parked else 48.0)
    local_time = around.local_time
    if start.start is not None:
        local_time = datetime.fromisoformat(start.start).replace(tzinfo=local_time.tzinfo)
    sun_deg = 40.0 if 6 <= local_time.hour < 20 else -20.0
    weather = around.weather if start.weather is None else start.weather
    return replace(around, local_time=local_time, sun_elevation_deg=sun_deg, weather=weather)


def _hand_over_s(start: Start) -> int:
    """Seconds after departure: at once, when the first caller rings, or when all messages are there."""
    rings = [arrival.at_s for arrival in start.arrivals if arrival.kind == "call"]
    return 2 + int(min(rings) if rings else max((arrival.at_s for arrival in start.arrivals), default=0.0))


def _taken_over(
    task: Task, half: str, network: RoadNetwork, language: Language = Language.ENGLISH, make: CarMake = CarMake.HOME
) -> tuple[Instance, Cockpit]:
    """The instance, and the cockpit some seconds after departure."""
    instance = draw(task, half, 0, language=language, make=make)
    dressed = make_named(make)
    while True:  # what the cockpit holds is known only when there is one
        start = instance.half.start
        signals = {HMI.LANGUAGE.path: str(language), **units_in(dressed, task), **start.signals}
        cockpit = Cockpit(
            network,
            rng=np.random.default_rng(1),
            aboard=start.aboard,
            cabin=start.cabin,
            signals={**PARKED, **signals} if start.parked else signals,
            arrivals=start.arrivals,
            belongings=start.belongings,
            sign_camera=start.sign_camera,
            make=dressed,
        )
        again = draw(task, half, 0, cockpit.content, language=language, make=make)
        if (again.goal, again.parameters) == (instance.goal, instance.parameters):
            break
        instance = again
    for second in range(_hand_over_s(start) + 1):
        cockpit.sense(_at(start, FROM_S + second), float(second > 0))
    cockpit.expect(instance.half.start.interruptions)
    return instance, cockpit


def _solved(
    instance: Instance,
    cockpit: Cockpit,
    way: tuple[Move, ...],
    *,
    by_pixels: bool = False,
    size: ScreenSize = ScreenSize.STANDARD,
) -> _Solved:
    start, car = instance.half.start, cockpit.copy()
    car.resize(size)
    oracle, feedback = Oracle(), Feedback(FeedbackCode.NONE, "")
    oracle.reset(instance.goal)
    oracle.brief(instance, way, drawn=car.drawn)
    moments: list[Any] = []
    said = tuple(says.text for says in instance.half.says)  # the driver has said all that he will
    acts_at = 0
    for second in range(SECONDS_LIMIT):
        around = _at(start, FROM_S + _hand_over_s(start) + second)
        if second:
            car.sense(around, 1.0)
        now = SimpleNamespace(
            time_s=around.driving.time_s,
            local_time=around.local_time + timedelta(seconds=second),
            surroundings=around,
            driving=around.driving,
            weather=around.weather,
            signals=car.signals.snapshot(),
            commands=car.commands(),
        )
        moments.append(now)
        if second < acts_at:
            continue
        seen = car.elements()
        shown = None if by_pixels else seen
        action = oracle.act(Observation(instance.goal, float(second), feedback, said, elements=shown))
        assert action.index is None or not by_pixels
        if action.action_type is ActionType.STATUS:
            break
        acts_at = second + int(action.seconds or 1)
        feedback = actions.perform(action, car, shown or ())
        for request in car.drain_requests():
            car.answered(request, Answer(True, "so it is"))
    beside = counterfactual(cockpit, car.given, moments, instance.half.allowed_writes)
    return _Solved(car, moments, dict(beside))


@dataclass
class Played:
    """A half's instance, the cockpit at its hand-over, and its first solution."""

    id: str
    instance: Instance
    cockpit: Cockpit
    solved: _Solved


@pytest.fixture(scope="module")
def played(request: pytest.FixtureRequest, network: RoadNetwork) -> list[tuple[Played]]:
    """A part of the halves, played once for all laws over them."""
    found = []
    for task, half in HALVES[request.param :: GROUPS]:
        instance, cockpit = _taken_over(task, half, network)
        solved = _solved(instance, cockpit, instance.half.moves)
        found.append((Played(f"{task.id}, {half}", instance, cockpit, solved),))
    return found


@pytest.mark.parametrize("played", QUARTER, indirect=True)
def test_a_reference_solution_reaches_its_goal_and_leaves_nothing_else(played):
    def check(each: Played) -> None:
        half = each.instance.half
        others = (_solved(each.instance, each.cockpit, way) for way in half.ways)
        for way, solved in zip((half.moves, *half.ways), (each.solved, *others), strict=True):
            assert half.goal.holds(solved.moments[0], solved.moments[-1], solved.moments), way
            assert solved.surplus(solved.cockpit, half.allowed_writes) == set(), way

    hold(played, check)


@pytest.mark.parametrize("part", SAMPLE)
def test_it_is_solved_in_another_language(part, network):
    """What the reference solution looks for is on the screens of that language, and so is what it waits to hear."""

    def check(task: Task, half: str, language: Language) -> None:
        instance, cockpit = _taken_over(task, half, network, language)
        solved = _solved(instance, cockpit, instance.half.moves)
        assert instance.half.goal.holds(solved.moments[0], solved.moments[-1], solved.moments)
        assert solved.surplus(solved.cockpit, instance.half.allowed_writes) == set()

    hold(SPOKEN[part::GROUPS], check)


@pytest.mark.parametrize(
    "part", [part if part == 0 else pytest.param(part, marks=pytest.mark.proof) for part in range(MADE_PARTS)]
)
def test_it_is_solved_in_every_make(part, network):
    """By its way there, and by nothing else than at home."""

    def check(task: Task, half: str, make: CarMake) -> None:
        instance, cockpit = _taken_over(task, half, network, make=make)
        solved = _solved(instance, cockpit, instance.half.moves)
        assert instance.half.goal.holds(solved.moments[0], solved.moments[-1], solved.moments)
        assert solved.surplus(solved.cockpit, instance.half.allowed_writes) == set()

    hold(MADE[part::MADE_PARTS], check)


@pytest.mark.parametrize("played", SAMPLE, indirect=True)
def test_the_picture_alone_is_enough(played):
    """By points alone, with no text but what is drawn, the reference solution comes to the same."""

    def check(each: Played) -> None:
        half = each.instance.half
        pictured = _solved(each.instance, each.cockpit, half.moves, by_pixels=True)
        assert half.goal.holds(pictured.moments[0], pictured.moments[-1], pictured.moments)
        assert pictured.cockpit.commands() == each.solved.cockpit.commands()

    hold(played, check)


@pytest.mark.parametrize(("task", "half", "size"), SAMPLED)
def test_any_screen_is_enough(task, half, size, network):
    """By points alone on another screen, a reference solution comes to the same as by the list on the usual one."""
    instance, cockpit = _taken_over(task, half, network)
    listed = _solved(instance, cockpit, instance.half.moves)
    pictured = _solved(instance, cockpit, instance.half.moves, by_pixels=True, size=size)
    assert instance.half.goal.holds(pictured.moments[0], pictured.moments[-1], pictured.moments)
    assert pictured.cockpit.commands() == listed.cockpit.commands()


@pytest.mark.parametrize("played", SAMPLE, indirect=True)
def test_one_switch_more_is_seen(played):
    """Whether the car couples it to the goal or not; unless the task allows it, or it ends the goal."""

    def check(each: Played) -> None:
        solved, allowed = each.solved, each.instance.half.allowed_writes
        turned = 0
        for path in sorted(set(ACTUATORS) - allowed):
            car = solved.cockpit.copy()
            car.command(named(path), another_value(named(path), car.signals[named(path)]))
            if car.commands() != solved.cockpit.commands():
                turned += 1
                assert solved.surplus(car, allowed), f"{path} as well is not seen"
        assert turned > len(ACTUATORS) / 2

    hold(played, check)
