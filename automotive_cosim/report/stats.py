"""Rates with intervals, comparisons of pairs, and the shares of pass^k and pass@k.

Episodes of one task are not independent of each other, so tasks are the clusters here: intervals of a rate shrink
the sample by the design effect, and comparisons resample whole tasks.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import comb, sqrt
from statistics import NormalDist
from typing import Any

import numpy as np

from automotive_cosim.errors import SetupError, install_hint

CONFIDENCE = 0.95
LEAST_CLUSTERS = 5
"""Fewer clusters (tasks, drives) give no interval of a mean or difference, because they say little of others."""
DRAWS = 10_000
"""Number of bootstrap samples, at which the third digit of a bound is stable."""


@dataclass(frozen=True, slots=True)
class Interval:
    """Bounds of an estimate."""

    low: float
    high: float


def bracketed(interval: Interval | None, form: str, factor: float = 1.0) -> str:
    """Bounds to put behind a figure, as `` (+1.5 to +3.5)``, in a format such as ``+.1f``; empty without any."""
    return "" if interval is None else f" ({factor * interval.low:{form}} to {factor * interval.high:{form}})"


@dataclass(frozen=True, slots=True)
class Rate:
    """The share of successes among the episodes that have run; an error is no success."""

    successes: int
    judged: int
    errors: int
    interval: Interval | None
    """Over the episodes that have run; None if nothing was judged."""
    not_run: int = 0

    @property
    def planned(self) -> int:
        """Judged, ended in an error, or not run."""
        return self.judged + self.errors + self.not_run

    @property
    def ran(self) -> int:
        """Judged, or ended in an error."""
        return self.judged + self.errors

    @property
    def value(self) -> float | None:
        """From 0 to 1; None if nothing was judged."""
        return self.successes / self.ran if self.judged else None


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two agents on the same instances."""

    both: int
    only_first: int
    only_second: int
    neither: int
    clusters: int
    """Tasks that the instances are of."""
    interval: Interval | None
    """Interval of the difference, from resampling tasks; None with fewer than ``LEAST_CLUSTERS``."""

    @property
    def count(self) -> int:
        """Instances on which both were judged."""
        return self.both + self.only_first + self.only_second + self.neither

    @property
    def difference(self) -> float:
        """Success rate of the first minus that of the second."""
        return (self.only_first - self.only_second) / self.count


def wilson(successes: float, count: float, confidence: float = CONFIDENCE) -> Interval:
    """Wilson's score interval (Wilson 1927, JASA 22); ``count`` may be an effective one.

    Raises ValueError: count is not above 0, or successes are not between 0 and count."""
    if count <= 0 or not 0 <= successes <= count:
        raise ValueError(f"{successes} successes of {count}")
    z = NormalDist().inv_cdf(0.5 + confidence / 2)
    share = successes / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    reach = z / (1 + z * z / count) * sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return Interval(max(0.0, middle - reach), min(1.0, middle + reach))


def distributions() -> Any:
    """``scipy.stats``, for the bounds of rates. Raises SetupError: scipy is not installed."""
    try:
        from scipy import stats
    except ImportError as error:
        raise SetupError(f"bounds of rates need scipy: {install_hint('reports')}") from error
    return stats


def upper_bound(count: int, total: int) -> float:
    """The one-sided upper bound of a rate (Clopper and Pearson 1934, Biometrika 26); 3 / total if none was seen.

    Raises ValueError: total is not above 0, or count is not between 0 and total."""
    if total <= 0 or not 0 <= count <= total:
        raise ValueError(f"{count} of {total}")
    return 1.0 if count == total else float(distributions().beta.ppf(CONFIDENCE, count + 1, total - count))


def rate_upper_bound(count: int, exposure: float) -> float:
    """The one-sided upper bound of a rate of independent events, as per hour (Garwood 1936,
    Biometrika 28); 3 / exposure if none was seen.

    Raises ValueError: exposure is not above 0, or count is below 0."""
    if exposure <= 0 or count < 0:
        raise ValueError(f"{count} in {exposure}")
    return float(distributions().chi2.ppf(CONFIDENCE, 2 * count + 2)) / 2 / exposure


def rate(outcomes: Iterable[tuple[Hashable, bool | None]], not_run: int = 0) -> Rate:
    """A rate with Wilson's interval at the effective sample size (Korn and Graubard 1998, Survey Methodology 24).

    Args:
        outcomes: (cluster, success) of each episode that has run; success None is an error.
        not_run: number of further planned episodes."""
    clusters: dict[Hashable, list[bool]] = defaultdict(list)
    errors = 0
    for cluster, success in outcomes:
        clusters[cluster].append(success is True)
        errors += success is None
    groups = list(clusters.values())
    ran, successes = sum(map(len, groups)), sum(map(sum, groups))
    if ran == errors:
        return Rate(0, 0, errors, None, not_run)
    size = effective_size(groups)
    return Rate(successes, ran - errors, errors, wilson(successes / ran * size, size), not_run)


def effective_size(clusters: Sequence[Sequence[bool]]) -> float:
    """The effective number of independent episodes, between the number of clusters and that of the episodes.

    The design effect is the variance of the rate between clusters divided by that of a simple sample. If all
    episodes agree, it cannot be estimated, and the clusters are counted."""
    count, groups = sum(map(len, clusters)), len(clusters)
    share = sum(map(sum, clusters)) / count
    if share in (0.0, 1.0) or groups < 2:
        return float(groups)
    residuals = sum((sum(cluster) - share * len(cluster)) ** 2 for cluster in clusters)
    clustered = groups / (groups - 1) * residuals / count**2
    simple = share * (1 - share) / count
    return float(min(count, max(groups, count * simple / clustered))) if clustered else float(count)


def all_pass(trials: Sequence[bool], k: int) -> float | None:
    """The probability that k of an instance's trials, drawn without replacement, all succeed: its share of pass^k
    (Yao et al. 2024, tau-bench).

    Args:
        trials: outcomes of the instance's repeats.
        k: 1 or more; None is returned for more than there are."""
    return comb(sum(trials), k) / comb(len(trials), k) if len(trials) >= k else None


def any_passes(trials: Sequence[bool], k: int) -> float | None:
    """The probability that at least one of them succeeds: its share of pass@k (Chen et al. 2021, HumanEval); see
    ``all_pass``."""
    return 1 - comb(len(trials) - sum(trials), k) / comb(len(trials), k) if len(trials) >= k else None


def compare(
    first: Mapping[Hashable, bool],
    second: Mapping[Hashable, bool],
    clusters: Mapping[Hashable, Hashable],
    seed: int = 0,
) -> Comparison | None:
    """Compares two agents on the instances on which both were judged; None if there are none.

    Args:
        first: success by instance.
        second: success by instance of the other agent.
        clusters: the cluster, e.g. the task, of each instance."""
    shared = [instance for instance in first if instance in second]
    if not shared:
        return None
    cells = [(first[instance], second[instance]) for instance in shared]
    only_first, only_second = cells.count((True, False)), cells.count((False, True))
    sums: dict[Hashable, list[int]] = defaultdict(lambda: [0, 0])
    for instance, (one, other) in zip(shared, cells, strict=True):
        sums[clusters[instance]][0] += int(one) - int(other)
        sums[clusters[instance]][1] += 1
    return Comparison(
        both=cells.count((True, True)),
        only_first=only_first,
        only_second=only_second,
        neither=cells.count((False, False)),
        clusters=len(sums),
        interval=None
        if len(sums) < LEAST_CLUSTERS
        else _bootstrap(list(sums.values()), seed) or _newcombe(cells, len(sums)),
    )


@dataclass(frozen=True, slots=True)
class Mean:
    """A mean over clustered values."""

    value: float
    count: int
    interval: Interval | None
    """Interval from resampling clusters; None with fewer than ``LEAST_CLUSTERS``, or if all agree."""


def clustered_mean(values: Iterable[tuple[Hashable, float]], seed: int = 0) -> Mean | None:
    """The mean with a percentile bootstrap interval over whole clusters; None without values.

    Args:
        values: (cluster, value) of each episode."""
    sums: dict[Hashable, list[float]] = defaultdict(lambda: [0.0, 0.0])
    for cluster, value in values:
        sums[cluster][0] += value
        sums[cluster][1] += 1
    if not sums:
        return None
    total, count = (sum(each[place] for each in sums.values()) for place in (0, 1))
    found = total / count
    return Mean(found, int(count), None if len(sums) < LEAST_CLUSTERS else _bootstrap(list(sums.values()), seed))


def mean(values: Iterable[float | None]) -> float | None:
    """The mean of the values that are not None."""
    present = [value for value in values if value is not None]
    return sum(present) / len(present) if present else None


def _bootstrap(sums: Sequence[Sequence[float]], seed: int) -> Interval | None:
    """As ``bootstrap``; None if all clusters agree."""
    return bootstrap(sums, seed) if len({total / count for total, count in sums}) > 1 else None


def bootstrap(sums: Sequence[Sequence[float]], seed: int) -> Interval:
    """Percentile interval of sum over count, of both for each cluster, when resampling whole clusters."""
    table = np.asarray(sums, dtype=float)
    rng = np.random.default_rng(seed)
    drawn = table[rng.integers(len(table), size=(DRAWS, len(table)))].sum(axis=1)
    tail = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(drawn[:, 0] / drawn[:, 1], [tail, 100 - tail])
    return Interval(float(low), float(high))


def _newcombe(cells: Sequence[tuple[bool, bool]], size: float) -> Interval:
    """Score interval of a paired difference (Newcombe 1998, Statistics in Medicine 17:2635, method 8).

    The correlation is omitted if a margin is empty; the cells are scaled to ``size`` in total."""
    count = len(cells)
    one, other = (sum(cell[which] for cell in cells) / count for which in (0, 1))
    both = sum(first and second for first, second in cells) / count
    spread = sqrt(one * (1 - one) * other * (1 - other))
    linked = (both - one * other) / spread if spread else 0.0
    ones, others = wilson(one * size, size), wilson(other * size, size)

    def reach(near: float, far: float) -> float:
        return sqrt(max(0.0, near**2 - 2 * linked * near * far + far**2))

    difference = one - other
    return Interval(
        max(-1.0, difference - reach(one - ones.low, others.high - other)),
        min(1.0, difference + reach(ones.high - one, other - others.low)),
    )
