import itertools
import re
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.report import stats


@pytest.mark.parametrize(("successes", "count"), [(0, 7), (7, 7), (3, 7), (40, 50), (1, 1000), (500, 1000)])
@pytest.mark.parametrize("confidence", [0.9, 0.95, 0.99])
def test_wilson_agrees_with_scipy(successes, count, confidence):
    from scipy.stats import binomtest  # a second, in the one worker that needs it

    ours = stats.wilson(successes, count, confidence)
    theirs = binomtest(successes, count).proportion_ci(confidence, method="wilson")
    assert (ours.low, ours.high) == pytest.approx((theirs.low, theirs.high), abs=1e-9)


def test_wilson_on_a_published_example():
    # Newcombe 1998 (Statistics in Medicine 17), table I, method 3: 81/263, 15/148, 0/20, 1/29
    for successes, count, low, high in [
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ]:
        interval = stats.wilson(successes, count)
        assert (interval.low, interval.high) == pytest.approx((low, high), abs=6e-5)


@given(st.lists(st.booleans(), min_size=1, max_size=60))
def test_without_repeats_the_interval_is_wilsons(outcomes):
    rate = stats.rate(enumerate(outcomes))
    plain = stats.wilson(sum(outcomes), len(outcomes))
    assert rate.interval is not None
    if 0 < sum(outcomes) < len(outcomes):
        # The variance between clusters of one is n/(n-1) times the binomial one.
        assert rate.interval.high - rate.interval.low >= plain.high - plain.low - 1e-12
        assert rate.interval.low == pytest.approx(plain.low, abs=0.06 if len(outcomes) < 10 else 0.01)
    else:
        assert (rate.interval.low, rate.interval.high) == pytest.approx((plain.low, plain.high))


@given(st.lists(st.booleans(), min_size=2, max_size=20), st.integers(2, 8))
def test_seeds_that_only_repeat_a_task_add_nothing(tasks, seeds):
    once = stats.rate(enumerate(tasks))
    often = stats.rate((task, success) for task, success in enumerate(tasks) for _ in range(seeds))
    assert often.judged == seeds * once.judged
    assert once.interval is not None
    assert often.interval is not None
    assert often.interval.low == pytest.approx(once.interval.low, abs=1e-9)
    assert often.interval.high == pytest.approx(once.interval.high, abs=1e-9)


@pytest.mark.parametrize("within", [0.0, 0.3, 1.0])
def test_intervals_cover_the_truth_as_often_as_they_say(within):
    """Tasks of differing difficulty, five seeds each; over many benchmarks about 95 in 100 hold the truth."""
    rng = np.random.default_rng(0)
    held = 0
    for _ in range(400):
        chances = np.where(rng.random(40) < within, (rng.random(40) < 0.6).astype(float), 0.6)
        outcomes = rng.random((40, 5)) < chances[:, None]
        interval = stats.rate((task, bool(s)) for task, row in enumerate(outcomes) for s in row).interval
        assert interval is not None
        held += interval.low <= 0.6 <= interval.high
    assert 0.92 <= held / 400 <= 0.99


@given(st.lists(st.tuples(st.integers(0, 5), st.sampled_from([True, False, None]))), st.integers(0, 5))
def test_a_rate_divides_by_what_was_run(outcomes, not_run):
    rate = stats.rate(outcomes, not_run)
    as_failures = stats.rate((task, success is True) for task, success in outcomes)
    assert (rate.planned, rate.successes) == (len(outcomes) + not_run, as_failures.successes)
    assert (rate.judged, rate.errors, rate.not_run) == (
        sum(success is not None for _, success in outcomes),
        sum(success is None for _, success in outcomes),
        not_run,
    )
    if rate.judged:
        assert (rate.value, rate.interval) == (as_failures.value, as_failures.interval)
        assert rate.value == rate.successes / rate.ran
    else:
        assert (rate.value, rate.interval) == (None, None)


@pytest.mark.parametrize(("both", "b", "c", "neither"), [(3, 9, 1, 4), (0, 5, 5, 0), (10, 0, 6, 10), (4, 0, 0, 4)])
def test_a_difference_lies_within_its_interval(both, b, c, neither):
    cells = [(True, True)] * both + [(True, False)] * b + [(False, True)] * c + [(False, False)] * neither
    first = dict(enumerate(one for one, _ in cells))
    second = dict(enumerate(other for _, other in cells))
    found = stats.compare(first, second, {i: i for i in first})
    assert found is not None
    assert found.difference == pytest.approx((b - c) / len(cells))
    assert found.interval.low <= found.difference <= found.interval.high


@pytest.mark.slow
def test_the_bootstrap_agrees_with_the_normal_interval_of_many_independent_pairs():
    rng = np.random.default_rng(1)
    one, other = rng.random(800) < 0.7, rng.random(800) < 0.55
    found = stats.compare(
        dict(enumerate(map(bool, one))), dict(enumerate(map(bool, other))), {i: i for i in range(800)}
    )
    assert found is not None
    differences = one.astype(float) - other
    reach = 1.96 * differences.std(ddof=1) / np.sqrt(800)
    assert found.interval.low == pytest.approx(differences.mean() - reach, abs=0.005)
    assert found.interval.high == pytest.approx(differences.mean() + reach, abs=0.005)


def test_only_shared_instances_are_compared():
    assert stats.compare({1: True}, {2: True}, {1: 1}) is None
    found = stats.compare({1: True, 2: True}, {2: False, 3: True}, {2: "t"})
    assert found is not None
    assert (found.count, found.only_first) == (1, 1)


@given(st.lists(st.booleans(), min_size=1, max_size=8), st.integers(1, 8))
def test_shares_of_pass_k_are_those_of_all_draws(trials, k):
    draws = list(itertools.combinations(trials, k))
    for share, holds in ((stats.all_pass, all), (stats.any_passes, any)):
        wanted = sum(map(holds, draws)) / len(draws) if draws else None
        assert share(trials, k) == (None if wanted is None else pytest.approx(wanted))


@pytest.mark.parametrize(
    ("cells", "low", "high"),
    # The first is an example of Newcombe 1998 (Statistics in Medicine 17:2635), the others are Wilson's bounds.
    [((36, 12, 2, 0), 0.0569, 0.3404), ((30, 0, 0, 0), -0.1135, 0.1135), ((0, 0, 30, 0), -1.0, -0.8395)],
)
def test_the_score_interval_of_paired_differences_agrees_with_the_paper(cells, low, high):
    e, f, g, h = cells
    pairs = [(True, True)] * e + [(True, False)] * f + [(False, True)] * g + [(False, False)] * h
    interval = stats._newcombe(pairs, len(pairs))
    assert (interval.low, interval.high) == pytest.approx((low, high), abs=6e-4)


def test_few_tasks_that_agree_prove_little_and_fewer_nothing():
    def compared(tasks):
        cells = range(3 * tasks)
        return stats.compare(dict.fromkeys(cells, True), dict.fromkeys(cells, False), {i: i % tasks for i in cells})

    assert compared(stats.LEAST_CLUSTERS).interval.low < 0.6
    assert compared(stats.LEAST_CLUSTERS).interval.high == 1.0
    few = compared(stats.LEAST_CLUSTERS - 1)
    assert (few.interval, few.clusters, few.difference) == (None, stats.LEAST_CLUSTERS - 1, 1.0)


def test_a_mean_of_few_tasks_or_of_equal_ones_has_no_interval_of_no_width():
    few = [(task, float(task)) for task in range(stats.LEAST_CLUSTERS - 1)]
    assert stats.clustered_mean(few).interval is None
    assert stats.clustered_mean([*few, (9, 9.0)]).interval is not None
    assert stats.clustered_mean([(task, 2.0) for task in range(9)]).interval is None


def test_without_scipy_bounds_name_what_brings_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy", None)
    for bound in (stats.upper_bound, stats.rate_upper_bound):
        with pytest.raises(SetupError, match=re.escape(install_hint("reports"))):
            bound(0, 10)
