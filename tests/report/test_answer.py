"""The sentence that every report begins with says what the results say."""

import pytest

from automotive_cosim.report.answer import answer, versus
from automotive_cosim.report.results import read_results
from automotive_cosim.report.stats import compare

from .test_regression import PLAN, write


def compared(both, only_first, only_second):
    cells = [(True, True)] * both + [(True, False)] * only_first + [(False, True)] * only_second
    first, second = (dict(enumerate(cell[side] for cell in cells)) for side in (0, 1))
    return compare(first, second, {name: name for name in first})


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ((10, 10, 0), "a beats b by 50 percentage points ("),
        ((10, 1, 1), "a and b cannot be told apart: a difference of 0 percentage points (−"),
        ((10, 0, 1), "a and b cannot be told apart: a difference of −9 percentage points (−"),
    ],
)
def test_who_is_better_is_said_only_if_the_interval_says_it(cells, words):
    told = versus("a", "b", compared(*cells), "pair")
    assert told.startswith(words)
    assert told.endswith(f", {sum(cells)} pairs")


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ((0, 2, 0), "a is 100 percentage points ahead of b on 2 pairs of 2 tasks, "),
        ((0, 0, 1), "b is 100 percentage points ahead of a on 1 pair of 1 task, "),
        ((4, 0, 0), "a and b are level, 4 won each, on 4 pairs of 4 tasks, "),
    ],
)
def test_few_tasks_give_no_interval(cells, words):
    assert compared(*cells).interval is None
    told = "too few to tell agents apart (5 tasks are needed)"
    assert versus("a", "b", compared(*cells), "pair") == words + told


def test_one_alone_has_its_rate_and_errors_are_counted(tmp_path):
    told = answer(read_results(write(tmp_path / "a", lost={1}, errors={3})))
    assert told.startswith("asurada, ")
    assert " pairs (" in told
    assert told.endswith(f"1 of {len(PLAN.jobs())} runs ended in an error.")


def test_references_are_not_ranked_unless_they_are_alone(tmp_path):
    assert answer(read_results(write(tmp_path / "a", agent="oracle"))).startswith("oracle (told the answer)")
    assert "no run ended in an error" in answer(read_results(write(tmp_path / "b")))


def test_prices_and_options_are_no_part_of_a_models_name(tmp_path):
    model = "provider/model?temperature=0.5&usd_per_million_in=2&usd_per_million_out=8"
    results = read_results(write(tmp_path / "a", agent="t3a", model=model))
    (each,) = [each for each in results.contestants if each.model == model]
    assert each.base_model == "provider/model"
    assert each.method == "t3a, temperature=0.5"
    assert each.label == "t3a, provider/model, temperature=0.5"
    assert "usd" not in answer(results)
