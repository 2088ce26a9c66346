"""Means with intervals that treat seeds, not decisions, as independent."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.report.stats import CONFIDENCE, Interval, bootstrap

LEAST_SEEDS = 10
"""Minimum number of seeds for an interval."""

PUBLISHED_SEEDS = 30
"""Minimum number of seeds for publication; with fewer, the report warns."""


@dataclass(frozen=True, slots=True)
class SeedMean:
    """A mean over decisions."""

    value: float
    interval: Interval | None
    """t interval with a standard error over seeds; None with fewer than ``LEAST_SEEDS``."""
    resampled: Interval | None
    """Interval from resampling whole seeds: narrower, and with few seeds too narrow."""
    count: int
    """Number of decisions."""
    seeds: int


def seed_mean(values: Iterable[tuple[int, float]], seed: int = 0) -> SeedMean | None:
    """The mean over all decisions; None if there are none.

    Args:
        values: (seed of the traffic, value) of each decision."""
    by_seed: dict[int, list[float]] = defaultdict(list)
    for cluster, value in values:
        by_seed[cluster].append(value)
    if not by_seed:
        return None
    groups = [by_seed[cluster] for cluster in sorted(by_seed)]
    count = sum(map(len, groups))
    mean = sum(map(sum, groups)) / count
    if len(groups) < LEAST_SEEDS:
        return SeedMean(mean, None, None, count, len(groups))
    return SeedMean(
        mean,
        _clustered(groups),
        bootstrap([(sum(group), len(group)) for group in groups], seed),
        count,
        len(groups),
    )


def _clustered(groups: Sequence[Sequence[float]]) -> Interval:
    """t interval of the mean over decisions with a standard error that is robust to clusters.

    The residuals and the degrees of freedom are corrected for few seeds with unequal numbers of decisions (CR2 with
    its Satterthwaite approximation: R. M. Bell and D. F. McCaffrey, Survey Methodology 28, 2002; G. W. Imbens and
    M. Kolesar, Review of Economics and Statistics 98, 2016). Seeds of equal size get one degree fewer than seeds.

    Raises SetupError: scipy is not installed."""
    try:
        from scipy.special import stdtrit
    except ImportError as missing:
        raise SetupError(f"intervals require scipy: {install_hint('reports')}") from missing
    sums = np.array([sum(group) for group in groups])
    sizes = np.array([len(group) for group in groups], dtype=float)
    count = sizes.sum()
    mean = sums.sum() / count
    scale = 1 / np.sqrt(1 - sizes / count)
    error = np.sqrt(np.sum((scale * (sums - mean * sizes)) ** 2)) / count
    residual = scale[:, None] * (np.eye(len(groups)) - sizes[:, None] / count)
    spread = (residual * sizes) @ residual.T
    freedom = np.trace(spread) ** 2 / np.sum(spread * spread)
    reach = stdtrit(freedom, (1 + CONFIDENCE) / 2) * error
    return Interval(float(mean - reach), float(mean + reach))
