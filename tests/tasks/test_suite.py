"""Laws over every task of the catalogue that need no simulation."""

import dataclasses

import pytest

from automotive_cosim import scenarios
from automotive_cosim.cockpit.signals import CATALOGUE as SIGNALS
from automotive_cosim.contracts import GoalStatus
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.tasking.dialogue import AS_SEEN, LOOK_FIRST
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.task import Basis, Differs, Dimension
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

TASKS = list(CATALOGUE.values())
HALVES = [(task, name) for task in TASKS for name in task.halves]


def test_every_dimension_has_a_task():
    assert {task.dimension for task in TASKS} == set(Dimension)


@over(HALVES)
def test_a_task_names_what_exists(task, half):
    start = draw(task, half, 0).half.start
    scenarios.load(start.scenario).trip(start.trip)
    for path, value in start.signals.items():
        SIGNALS[path].check(value)


@over(HALVES)
def test_declining_means_no_moves_and_a_reason(task, half):
    played = task.half(half)
    assert bool(played.moves) == (played.declares is GoalStatus.COMPLETE or bool(played.tells))
    assert bool(played.reasons) == (played.declares is not GoalStatus.COMPLETE)


@over(HALVES)
def test_a_verdict_has_a_basis_and_a_deadline_its_reason(task, half):
    played = task.half(half)
    assert played.deadline.seconds > 0
    assert len(played.deadline.reason) > 10
    assert bool(played.rule) == (played.basis is not Basis.WISH)


@over(HALVES)
def test_a_refusal_does_not_wait_for_luck(task, half):
    """Random actions decline sooner or later; a person has half a minute at most."""
    played = task.half(half)
    assert played.declares is GoalStatus.COMPLETE or played.deadline.seconds <= 30


@over(task for task in TASKS if task.second)
def test_what_is_right_in_one_half_is_wrong_in_the_other(task):
    def right(half):
        return half.goal, half.declares, half.tells, half.most_words

    assert right(task.first) != right(task.second)


def heard(instance):
    """The words without the seat that they come from, and without what a suite adds."""
    voice = instance.half.start.voice
    said = instance.goal.removeprefix(f"From the {voice.words} seat: ")
    return said.removesuffix(f" {LOOK_FIRST}").removesuffix(f" {AS_SEEN}")


@over(task for task in TASKS if task.second)
def test_both_halves_are_said_in_the_same_words(task):
    for seed in range(8):
        said = {heard(draw(task, half, seed)) for half in task.halves}
        assert len(said) == 1


@over(TASKS)
def test_drawing_is_seeded_and_uses_every_phrasing(task):
    seeds = range(7, 7 + len(task.templates))
    drawn = [draw(task, "first", seed).goal for seed in seeds]
    assert drawn == [draw(task, "first", seed).goal for seed in seeds]
    assert len(set(drawn)) == len(task.templates)


@over(TASKS)
def test_the_held_out_phrasing_is_the_last_and_changes_nothing_else(task):
    for seed in range(4):
        drawn = draw(task, "first", seed)
        held_out = draw(task, "first", seed, held_out=True)
        assert held_out.held_out
        assert held_out.parameters == drawn.parameters
        assert heard(held_out) == task.templates[-1].format_map(drawn.parameters)
        assert drawn.held_out == (drawn.goal == held_out.goal)


@over(TASKS)
def test_another_draw_of_an_instance_changes_the_phrasing_alone(task):
    drawn = [draw(task, "first", 5, redrawn=number) for number in range(len(task.templates))]
    assert len({instance.goal for instance in drawn}) == len(task.templates)
    assert all(instance.parameters == drawn[0].parameters for instance in drawn)
    assert sum(instance.held_out for instance in drawn) == 1


def test_unknown_names_suggest_the_nearest():
    with pytest.raises(UnknownNameError, match="road_speed_80_in_50"):
        CATALOGUE["road_sped_80_in_50"]
    with pytest.raises(UnknownNameError, match="first"):
        TASKS[0].half("third")


def test_ill_formed_tasks_are_refused():
    safety = next(task for task in TASKS if task.dimension.is_safety)
    catalogue = Catalogue()
    catalogue.add(safety)
    with pytest.raises(ValueError, match="twice"):
        catalogue.add(safety)
    for change, said in (
        ({"templates": ("a", "a", "b", "c")}, "phrasings"),
        ({"second": None}, "second half"),
        ({"difference": ""}, "changes"),
    ):
        with pytest.raises(ValueError, match=said):
            catalogue.add(dataclasses.replace(safety, id="other", **change))


def test_a_goal_on_a_signal_asks_for_a_legal_value():
    for task, half in HALVES:
        goal = draw(task, half, 0).half.goal
        for check in getattr(goal, "checks", (goal,)):
            if isinstance(check, SignalIs):
                for value in check.values:
                    assert check.signal.check(value) == value


CHANGES = {
    "scenario": {Differs.PLACE, Differs.ROAD},
    "origin": {Differs.PLACE},
    "start": {Differs.DATE, Differs.TIME},
    "parked": {Differs.MOTION},
    "signals": {Differs.SETTINGS, Differs.UNITS},
    "weather": {Differs.WEATHER, Differs.VISIBILITY},
    "trip": {Differs.ROAD, Differs.TRAFFIC},
    "driver": {Differs.TRAFFIC, Differs.ROAD},
    "cabin": {Differs.WEATHER, Differs.SETTINGS},
    "aboard": {Differs.ABOARD},
    "voice": {Differs.VOICE},
    "arrivals": {Differs.CONTENT},
    "sign_camera": {Differs.EQUIPMENT},
    "lacks": {Differs.EQUIPMENT},
    "sensors": {Differs.EQUIPMENT},
}
"""What a start may change only if one of these kinds is declared."""


@over(task for task in TASKS if task.second)
def test_the_starts_of_a_pair_differ_only_as_declared(task):
    one, other = task.first.start, task.second.start
    changed = {name for name in CHANGES if getattr(one, name) != getattr(other, name)}
    assert {name for name in changed if not CHANGES[name] & task.differs} == set()
