"""Means with intervals that treat seeds, not decisions, as independent."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from automotive_cosim.report.stats import CONFIDENCE, DRAWS, Interval

LEAST_SEEDS = 10
"""Minimum number of seeds for an interval."""

PUBLISHED_SEEDS = 30
"""Minimum number of seeds for publication; with fewer, the report warns."""


@dataclass(frozen=True, slots=True)
class SeedMean:
    """A mean over decisions."""

    value: float
    interval: Interval | None
    """Interval from resampling whole seeds; None with fewer than ``LEAST_SEEDS``."""
    count: int
    """Number of decisions."""
    seeds: int


def seed_mean(values: Iterable[tuple[int, float]], seed: int = 0) -> SeedMean | None:
    """The mean over all decisions; None if there are none.

    Args:
        values: (seed of the traffic, value) of each decision.
        seed: seed of the bootstrap.
    """
    by_seed: dict[int, list[float]] = defaultdict(list)
    for cluster, value in values:
        by_seed[cluster].append(value)
    if not by_seed:
        return None
    groups = [by_seed[cluster] for cluster in sorted(by_seed)]
    count = sum(map(len, groups))
    mean = sum(map(sum, groups)) / count
    interval = _bootstrap(groups, seed) if len(groups) >= LEAST_SEEDS else None
    return SeedMean(mean, interval, count, len(groups))


def _bootstrap(groups: Sequence[Sequence[float]], seed: int) -> Interval:
    """Percentile interval of the mean over decisions when resampling whole seeds."""
    sums = np.array([[sum(group), len(group)] for group in groups], dtype=float)
    picked = np.random.default_rng(seed).integers(len(groups), size=(DRAWS, len(groups)))
    drawn = sums[picked].sum(axis=1)
    tail = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(drawn[:, 0] / drawn[:, 1], [tail, 100 - tail])
    return Interval(float(low), float(high))
