"""Every draw is its own: of its task, its number and its purpose."""

import math
import re
from collections import Counter

import pytest

from automotive_cosim.tasking.dialogue import AS_SEEN, LOOK_FIRST
from automotive_cosim.tasking.draws import Draws, Purpose
from automotive_cosim.tasking.instance import HELD, Instance, draw, instances
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

TASKS = list(CATALOGUE.values())
NUMBERS = range(12)
MANY = 400
"""Instances that a test is willing to draw of each task."""
CONTENT = {
    kind: tuple(f"{kind} {number}" for number in range(HELD.get(kind, 1))) for kind in (*HELD, "unread", "streets")
}


def drawn(task: Task, number: int, half: str = "first") -> Instance:
    return draw(task, half, number, CONTENT)


def space(task: Task) -> int:
    """Number of distinct phrasings and parameters."""
    return instances(task) // len(task.runs_in)


def words(instance):
    """The goal without the seat that it comes from, and without where one may look."""
    return (
        re.sub(r"^From the [a-z ]+ seat: ", "", instance.goal)
        .removesuffix(f" {LOOK_FIRST}")
        .removesuffix(f" {AS_SEEN}")
    )


@pytest.mark.parametrize("number", NUMBERS)
def test_one_number_takes_every_phrasing_equally_often(number):
    """The held-out share within four standard deviations, and the places of all phrasings within chi-square's
    0.01 %."""
    chances = [1 / len(task.templates) for task in TASKS]
    held_out = sum(drawn(task, number).held_out for task in TASKS)
    assert abs(held_out - sum(chances)) < 4 * math.sqrt(sum(chance * (1 - chance) for chance in chances))
    for phrasings, bound in ((4, 21.1), (5, 23.5)):
        alike = [task for task in TASKS if len(task.templates) == phrasings]
        goals = [drawn(task, number) for task in alike]
        places = Counter(
            next(
                place
                for place, template in enumerate(instance.task.templates)
                if template.format_map(instance.parameters) == words(instance)
            )
            for instance in goals
        )
        expected = len(alike) / phrasings
        assert sum((places[place] - expected) ** 2 / expected for place in range(phrasings)) < bound


@over(TASKS)
def test_an_instance_comes_again_only_when_there_is_no_other(task):
    first = [drawn(task, number) for number in range(min(space(task), MANY))]
    assert len({(instance.goal, *instance.parameters.values()) for instance in first}) == len(first) >= 4


def test_five_seeds_say_five_different_things_to_most_tasks():
    assert sum(space(task) >= 5 for task in TASKS) >= 0.85 * len(TASKS)


@over(task for task in TASKS if task.second)
def test_both_halves_draw_the_same(task):
    for number in NUMBERS:
        one, other = drawn(task, number), drawn(task, number, "second")
        assert (words(one), one.parameters, one.held_out) == (words(other), other.parameters, other.held_out)


def test_every_task_purpose_and_number_has_a_stream_of_its_own():
    firsts = {
        int(Draws(task_id, number).rng(purpose).integers(2**63))
        for task_id in CATALOGUE
        for number in NUMBERS
        for purpose in Purpose
    }
    assert len(firsts) == len(CATALOGUE) * len(NUMBERS) * len(Purpose)


def test_a_stream_is_the_same_in_every_process_and_release():
    """Other figures here mean other episodes for every seed."""
    draws = Draws("road_horn_abroad", 3)
    assert (draws.seed(Purpose.DRIVER), draws.seed(Purpose.SKY)) == (1703759902, 920016418)
    assert [int(one) for one in draws.rng(Purpose.CONTENT).integers(100, size=4)] == [41, 30, 22, 46]


def test_another_draw_of_an_instance_has_other_content_and_nothing_else():
    first, other, third = (Draws("a_task", 3, redrawn=number) for number in range(3))
    assert first == Draws("a_task", 3)
    assert len({each.seed(Purpose.CONTENT) for each in (first, other, third)}) == 3
    for purpose in set(Purpose) - {Purpose.CONTENT}:
        assert first.seed(purpose) == other.seed(purpose)
