"""An adviser that learns from what each driver took, for `study days --adviser adviser:Learner`.

Each driver tries the routes that were ever quickest by the news, keeps to the one that took least on average, and
tries another one day in ten.
"""

from collections import defaultdict
from statistics import fmean

import numpy as np


class Learner:
    """Epsilon-greedy over the routes of each driver."""

    def __init__(self, seed):
        self._rng = np.random.default_rng(seed)
        self._took_s = defaultdict(dict)  # trip -> route -> times on earlier days

    def advise(self, day):
        """A route for each trip of the day."""
        chosen = {}
        for trip in day.trips:
            routes = self._took_s[trip.id]
            routes.setdefault(trip.edges, []).append(trip.exits_s[-1] - trip.departed_s)
            if trip.id in day.quickest:
                routes.setdefault(day.quickest[trip.id], [])
            best = min(routes, key=lambda route: fmean(routes[route] or [0]))  # what was never driven comes first
            tries = self._rng.random() < 0.1
            chosen[trip.id] = list(routes)[self._rng.integers(len(routes))] if tries else best
        return chosen
