"""Laws over the hard suite."""

from collections import Counter

from automotive_cosim.cockpit.apps.phone.state import Thread
from automotive_cosim.proof.gates import PACE
from automotive_cosim.tasking.checks import AllOf, Check
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.moves import Do, Tap, TapUntil
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Ability, Half, Task
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

HARD = CATALOGUE.of(Suite.HARD)


def test_the_suite_is_large_enough_and_named_apart():
    assert len(HARD) >= 120
    assert all(task.id.startswith("hard_") for task in HARD)
    assert not any(task.id.startswith("hard_") for task in CATALOGUE.of(Suite.STANDARD))


def test_every_ability_has_ten_tasks_or_more():
    counts = Counter(task.ability for task in HARD)
    assert {ability: counts[ability] for ability in Ability if counts[ability] < 10} == {}


@over(CATALOGUE.values())
def test_only_a_hard_task_says_what_it_is_hard_by_and_why_a_guess_loses(task: Task):
    is_hard = task.suite is Suite.HARD
    assert (task.ability is not None) is is_hard
    assert (len(task.guess_loses.split()) >= 6) is is_hard
    assert not is_hard or task.guess_loses.endswith(".")


def test_a_third_is_in_a_moving_car_and_a_quarter_is_interrupted():
    halves = {task.id: [task.half(name) for name in task.halves] for task in HARD}
    moving = [task for task, each in halves.items() if not all(half.start.parked for half in each)]
    interrupted = [
        task for task, each in halves.items() if any(half.start.interruptions or half.says for half in each)
    ]
    assert 3 * len(moving) >= len(HARD)
    assert 4 * len(interrupted) >= len(HARD)


@over(task for task in HARD if task.ability is Ability.RESTRAINT and task.second)
def test_restraint_is_asked_for_as_long_as_an_act(task: Task):
    """In one half at least there is nothing to do but to watch, or to leave it at what was set first."""
    watches = [
        name
        for name in task.halves
        if any(getattr(each, "name", "") in ("watched", "lasted") for each in _checks(task, name))
    ]
    assert watches


def _checks(task: Task, name: str) -> tuple[Check, ...]:
    goal = task.half(name).goal
    return goal.checks if isinstance(goal, AllOf) else (goal,)


@over(HARD)
def test_the_usual_mistakes_are_named(task: Task):
    assert any(task.half(name).slips for name in task.halves)


@over(HARD)
def test_a_mistake_is_not_a_solution(task: Task):
    for name in task.halves:
        half = task.half(name)
        assert not [slip for slip in half.slips if slip in (half.moves, *half.ways)]


@over(HARD)
def test_it_takes_many_actions_and_fits_the_limit(task: Task):
    """In one of its halves at least; a value that is pressed until it is right counts as two."""
    counts = []
    for name in task.halves:
        half = draw(task, name, 0).half
        taps = (
            move.times if isinstance(move, Tap) else 2 if isinstance(move, TapUntil) else 1 for move in half.moves
        )
        counts.append(1 + sum(taps))
    assert max(counts) >= 8
    assert max(counts) <= task.max_steps - 5


@over(HARD)
def test_a_person_has_the_time(task: Task):
    """A second and a half at least for each action, and for each second of waiting one; at most twelve, and for
    waiting what the reference solution may take; but where a mere warning is right."""
    for name in task.halves:
        half = draw(task, name, 0).half
        if len(half.moves) < 6:
            continue
        waits = max(
            _last_event_s(half), sum(move.action.seconds or 0 for move in half.moves if isinstance(move, Do))
        )
        taps = (
            move.times if isinstance(move, Tap) else 4 if isinstance(move, TapUntil) else 1 for move in half.moves
        )
        acts = sum(taps) - sum(isinstance(move, Do) for move in half.moves)
        assert 1.5 * acts + waits <= half.deadline.seconds <= waits / PACE + 12 * acts


def _last_event_s(half: Half) -> float:
    """When the last thing happens that nobody on the screen has brought about."""
    changes = (each.at_s + getattr(each, "over_s", 0.0) for each in half.start.interruptions)
    return max((*changes, *(says.time_s for says in half.says)), default=0.0)


@over(HARD)
def test_a_task_needs_the_picture_if_it_has_a_photo(task: Task):
    sent = [thread for name in task.halves for thread in task.half(name).start.belongings.threads]
    assert task.needs_picture is any(thread.photo for thread in sent if isinstance(thread, Thread))


def test_some_tasks_need_the_picture_and_come_in_pairs():
    pictured = [task for task in HARD if task.needs_picture]
    assert len(pictured) >= 8
    assert all(task.second for task in pictured)
    assert not any(task.needs_picture for task in CATALOGUE.of(Suite.STANDARD))


def test_goals_differ_from_each_other_and_from_the_standard_suite():
    goals = [str(task.first.goal) + str(task.second.goal if task.second else "") for task in HARD]
    assert len(set(goals)) == len(goals)
