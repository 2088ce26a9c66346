"""The fit by hand: nearest to the prior, within bounds, no route given up."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array

from automotive_cosim.studies.calibration.fit import CountedFlows, Floats, fit

NO_BOUNDS = csr_array((0, 3)), np.zeros(0)


def flows(
    counted_by: list[list[float]], counts: list[float], prior: tuple[float, ...] = (10.0, 20.0, 30.0)
) -> CountedFlows:
    size = len(counts)
    matrix = csr_array(np.array(counted_by).reshape(size, len(prior)))
    return CountedFlows(np.array(prior), matrix, np.array(counts), np.full(size, 1e-3))


def test_without_counts_it_is_the_prior() -> None:
    found = fit(flows([], []), *NO_BOUNDS)
    assert found == pytest.approx([10.0, 20.0, 30.0])


def test_a_count_raises_all_that_it_sees_by_one_factor() -> None:
    """No route is favoured and none is given up, unlike at a corner of a linear programme."""
    found = fit(flows([[1, 1, 0]], [90.0]), *NO_BOUNDS)
    assert found == pytest.approx([30.0, 60.0, 30.0], rel=1e-3)


def test_counts_that_contradict_each_other_are_missed_evenly() -> None:
    contradicting = replace(flows([[1, 0, 0], [1, 0, 0]], [10.0, 20.0]), variances=np.full(2, 0.5))
    assert fit(contradicting, *NO_BOUNDS) == pytest.approx([15.0, 20.0, 30.0], rel=1e-2)


def test_a_bound_sends_the_traffic_the_other_way() -> None:
    """60 are counted, of which the first route may take 5 at most."""
    found = fit(flows([[1, 1, 0]], [60.0]), csr_array(np.array([[1.0, 0.0, 0.0]])), np.array([5.0]))
    assert found == pytest.approx([5.0, 55.0, 30.0], rel=2e-2)
    slack = fit(flows([[1, 1, 0]], [60.0]), csr_array(np.array([[1.0, 0.0, 0.0]])), np.array([500.0]))
    assert slack == pytest.approx([20.0, 40.0, 30.0], rel=1e-2), "a bound that does not bind changes nothing"


def test_a_count_far_from_the_prior_and_a_count_of_zero_are_met() -> None:
    found: Floats = fit(flows([[1, 0, 0], [0, 0, 1]], [1200.0, 0.0]), *NO_BOUNDS)
    assert found[0] == pytest.approx(1200, rel=1e-2)
    assert found[1] == pytest.approx(20)
    assert found[2] < 0.5


def test_many_routes_and_counts_are_met_and_all_routes_stay() -> None:
    rng = np.random.default_rng(0)
    truth, prior = rng.lognormal(1.0, 1.0, 2000), rng.lognormal(1.0, 1.0, 2000)
    seen = csr_array((rng.random((60, 2000)) < 0.05).astype(float))
    counts = seen @ truth
    found = fit(CountedFlows(prior, seen, counts, 0.001 * counts), csr_array((0, 2000)), np.zeros(0))
    assert seen @ found == pytest.approx(counts, rel=0.02)
    assert np.all(found > 0.01 * prior)
