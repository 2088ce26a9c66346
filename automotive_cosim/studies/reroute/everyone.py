"""How the effect of a choice is distributed over everyone present at the fork, including the ego."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.rows import Horizon, Spread, TripClass

Numbers = NDArray[np.float64]

NOTICED_S = 1.0
"""A vehicle counts as earlier or later if its mean arrival differs by at least this."""

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
CLASSES_S = (0.0, 120.0, 300.0, 600.0)
"""Lower bounds of the classes of trips, by the time left from the fork if the ego keeps its route."""
HORIZONS = (0.9, 0.95, 0.99)
"""Shares of the vehicles that must have arrived, up to which the effect on the others is summed too."""


def spread(pairs: Sequence[tuple[Future, Future]], group: Sequence[str], at_s: float) -> Spread:
    """The distribution of what single vehicles save, each as its mean over the draws.

    Args:
        pairs: for every draw, the future in which the ego keeps its route, and the one in which it does not.
        at_s: instant of the fork."""
    left = [_times_left(pair, group, at_s) for pair in pairs]
    stay_s, other_s = (np.mean([times[which] for times in left], axis=0) for which in (0, 1))
    gains_s = stay_s - other_s
    low_s, lower_s, median_s, upper_s, high_s = (float(each) for each in np.quantile(gains_s, QUANTILES))
    bounds = (*CLASSES_S, np.inf)
    trips = tuple(
        _class(from_s, gains_s[(stay_s >= from_s) & (stay_s < to_s)]) for from_s, to_s in pairwise(bounds)
    )
    return Spread(
        count=len(gains_s),
        mean_s=round(float(gains_s.mean()), 3),
        low_s=round(low_s, 3),
        lower_s=round(lower_s, 3),
        median_s=round(median_s, 3),
        upper_s=round(upper_s, 3),
        high_s=round(high_s, 3),
        earlier=int(np.sum(gains_s >= NOTICED_S)),
        later=int(np.sum(gains_s <= -NOTICED_S)),
        gini_stay=round(gini(stay_s), 4),
        gini=round(gini(other_s), 4),
        trips=tuple(each for each in trips if each.count),
        horizons=tuple(_horizon(pairs, group, share) for share in HORIZONS),
    )


def gini(values: Numbers) -> float:
    """The Gini coefficient of positive values: 0 if all are equal, near 1 if one has everything."""
    total = float(values.sum())
    if total <= 0:
        return 0.0
    ranks = np.arange(1, len(values) + 1)
    return float(2 * np.sum(ranks * np.sort(values)) / (len(values) * total) - (len(values) + 1) / len(values))


def _times_left(pair: tuple[Future, Future], group: Sequence[str], at_s: float) -> tuple[Numbers, Numbers]:
    """Seconds from the fork to the arrival of the ego and of each other vehicle, in both futures.

    A vehicle that has not arrived when the earlier future ends counts up to then, as in ``compare.others``."""
    until_s = min(future.settled.time_s for future in pair)
    stay_s, other_s = (
        np.array([future.last.time_s, *(min(future.settled.arrivals_s.get(v, until_s), until_s) for v in group)])
        for future in pair
    )
    return stay_s - at_s, other_s - at_s


def _class(from_s: float, gains_s: Numbers) -> TripClass:
    return TripClass(
        from_s=from_s,
        count=len(gains_s),
        gain_s=round(float(gains_s.sum()), 3),
        later=int(np.sum(gains_s <= -NOTICED_S)),
    )


def _horizon(pairs: Sequence[tuple[Future, Future]], group: Sequence[str], share: float) -> Horizon:
    """What the others save up to the instant at which that share of them has arrived in the faster future."""
    sums_s: list[float] = []
    for pair in pairs:
        until_s = min(_time_home(future, group, share) for future in pair)
        if until_s > min(future.settled.time_s for future in pair):
            return Horizon(share=share, gain_s=None)
        stay_s, other_s = (
            sum(min(future.settled.arrivals_s.get(each, until_s), until_s) for each in group) for future in pair
        )
        sums_s.append(stay_s - other_s)
    return Horizon(share=share, gain_s=round(float(np.mean(sums_s)), 3))


def _time_home(future: Future, group: Sequence[str], share: float) -> float:
    """When that share of the vehicles had arrived; infinite if not by the end."""
    needed = int(np.ceil(share * len(group) - 1e-9))
    arrivals_s = sorted(future.settled.arrivals_s.get(each, np.inf) for each in group)
    return arrivals_s[needed - 1] if needed else 0.0
