"""What a search will take before it runs."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from automotive_cosim.errors import UserError
from automotive_cosim.run.forecast import CostForecast, Range, forecast
from automotive_cosim.run.plan import Plan
from automotive_cosim.run.trial import TrialSetup
from automotive_cosim.safety.samplers import make_sampler
from automotive_cosim.safety.space import Space
from automotive_cosim.safety.trying import job_of, trial_of

RUNS_A_FAILURE = 30
"""Runs that repeats and reduction of a failure take, about."""
MOST_LAID = 256
"""Points of which the figures are taken; more are in proportion."""


def search_forecast(space: Space, plan: Plan, points: int, workers: int = 1) -> CostForecast:
    """What the nominal point and so many samples will take; failures that are reduced come in addition.

    The points are others than the search's, drawn at random from the same space.

    Args:
        plan: the agent and its model.
        workers: how many run in parallel; 1 for a search whose points depend on each other.
    """
    drawn = make_sampler("random", space, points, 0)
    jobs: dict[str, TrialSetup] = {}
    for point in (space.nominal, *(drawn.ask()[0] for _ in range(min(points, MOST_LAID)))):
        with suppress(UserError):  # a combination that cannot be run costs nothing
            job = job_of(plan, trial_of(point))
            jobs[job.id] = job
    found = forecast(list(jobs.values()), workers)
    return _times(found, (points + 1) / max(1, found.runs))


def of_a_failure(found: CostForecast) -> Range:
    """Seconds that one failure takes to be reduced, one run after the other."""
    each = RUNS_A_FAILURE / max(1, found.runs)
    return Range(found.wall_s.low * each, found.wall_s.high * each)


def _times(found: CostForecast, factor: float) -> CostForecast:
    def times(span: Range) -> Range:
        return Range(span.low * factor, span.high * factor)

    return replace(
        found,
        runs=round(found.runs * factor),
        wall_s=times(found.wall_s),
        tokens=times(found.tokens),
        usd=times(found.usd),
    )
