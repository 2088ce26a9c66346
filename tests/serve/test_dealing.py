"""What a study deals to whom, for every number of people and tasks."""

from collections import Counter
from itertools import pairwise
from pathlib import Path

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.serve.dealing import PeoplePlan, deal, read_study, williams
from automotive_cosim.tasks import CATALOGUE

PAIRS = [task.id for task in CATALOGUE.values() if task.second][:4]
SINGLES = [task.id for task in CATALOGUE.values() if not task.second][:4]


def dealt(people: int, tasks: list[str], order_seed: int = 0):  # type: ignore[no-untyped-def]
    names = tuple(f"person {number}" for number in range(people))
    plan = PeoplePlan(names, tuple(tasks), order_seed=order_seed)
    jobs = plan.plan.jobs()
    return jobs, deal(jobs, names, order_seed)


@pytest.mark.parametrize("count", range(1, 9))
def test_a_williams_design_is_balanced(count: int) -> None:
    rows = [williams(count, row) for row in range(count if count % 2 == 0 else 2 * count)]
    assert all(sorted(row) == list(range(count)) for row in rows)
    for place in range(count):
        assert len(set(Counter(row[place] for row in rows).values())) == 1
    follows = Counter(pair for row in rows for pair in pairwise(row))
    assert len(set(follows.values())) <= 1
    assert len(follows) == count * (count - 1)


@pytest.mark.parametrize("people", [1, 2, 5])
@pytest.mark.parametrize(
    "tasks", [PAIRS[:2], PAIRS, [PAIRS[0], SINGLES[0]], [*PAIRS[:1], *SINGLES], [*PAIRS[:3], *SINGLES[:2]], SINGLES]
)
def test_everybody_plays_everything_and_never_both_halves_in_a_row(people: int, tasks: list[str]) -> None:
    jobs, _ = dealt(people, tasks)
    for order_seed in range(4):
        orders = deal(jobs, tuple(f"person {number}" for number in range(people)), order_seed)
        assert sorted(job.id for order in orders.values() for job in order) == sorted(job.id for job in jobs)
        for name, order in orders.items():
            assert {job.model for job in order} == {name}
            assert all(before.task != after.task for before, after in pairwise(order))


def test_half_of_the_people_meet_each_half_first() -> None:
    _, orders = dealt(6, PAIRS)
    for task in PAIRS:
        first = [next(job.half for job in order if job.task == task) for order in orders.values()]
        assert Counter(first) == {"first": 3, "second": 3}


def test_the_seed_decides_the_order() -> None:
    def ids(seed: int) -> list[str]:
        return [job.id for order in dealt(3, PAIRS, seed)[1].values() for job in order]

    assert ids(0) == ids(0)
    assert ids(0) != ids(1)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('people = ["a", "a"]\ntasks = ["hvac_fan_max"]', "different code names"),
        ('people = ["../x"]\ntasks = ["hvac_fan_max"]', "code name"),
        ('people = ["a"]\ntasks = ["no_such"]', "no_such"),
        (f'people = ["a"]\ntasks = ["{PAIRS[0]}"]', "both halves"),
        ('people = []\ntasks = ["hvac_fan_max"]', "people"),
        ('people = ["a"]\ntasks = ["hvac_fan_max"]\npause = true', "pause"),
        ('people = ["a"]\ntasks = ["hvac_fan_max"]\nscenario = "nowhere"', "nowhere"),
        ("people = 3", "people"),
    ],
)
def test_a_plan_that_cannot_be_dealt_is_refused_in_words(tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match=why):
        read_study(path).check()
