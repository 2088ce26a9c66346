"""What a search has found: rates by factor, coverage, bounds on what was not seen, and failures in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.report.stats import CONFIDENCE, upper_bound, wilson
from automotive_cosim.report.tables import Table
from automotive_cosim.safety.hunt import REPEATS, Hunt, MinimalFailure, Tried
from automotive_cosim.safety.space import Factor, FactorRange, SearchPoint, told

CONFIDENCE_WORDS = f"{100 * CONFIDENCE:.0f} %"
LEAST_EVEN = 12
"""Fewer points say nothing about a factor's share."""
MOST_PAIRS = 30
"""Rows of the table of two factors."""


@dataclass(frozen=True, slots=True)
class UnseenBound:
    """What the points that represent the whole space say about it."""

    even: int
    """Number of those that were judged."""
    failed: int
    upper: float | None
    """Upper bound of the failure rate in the space, one-sided; None without a judged point."""
    unexplained: int
    """Failures among them that no minimal failure explains."""
    unseen_upper: float | None
    """Upper bound of the rate of failures that no minimal failure explains."""


def percent(share: float) -> str:
    """A share in words."""
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{100 * share:.2g} %"


def judged(tried: Sequence[Tried]) -> list[Tried]:
    """Those with a margin."""
    return [each for each in tried if each.outcome.margin is not None]


def unseen(found: Hunt) -> UnseenBound:
    """The bounds on what was not seen."""
    even = [each for each in judged(found.samples) if each.even]
    failed = [each for each in even if each.outcome.failed]
    other = [each for each in failed if not explained(found, each.point)]
    if not even:
        return UnseenBound(0, 0, None, 0, None)
    total = len(even)
    return UnseenBound(
        total, len(failed), upper_bound(len(failed), total), len(other), upper_bound(len(other), total)
    )


def explained(found: Hunt, point: SearchPoint) -> MinimalFailure | None:
    """The first minimal failure that explains one at a point."""
    return next((each for each in found.minimal if each.covers(found.space, point)), None)


def coverage(found: Hunt) -> tuple[int, int]:
    """How many pairs of levels of two factors were tried, and how many there are (2-wise coverage)."""
    points = [each.point for each in judged(found.tried)]
    covered = total = 0
    for one, other in combinations(_varied(found), 2):
        total += len(set(one.levels)) * len(set(other.levels))
        covered += len({(one.level(point[one.name]), other.level(point[other.name])) for point in points})
    return covered, total


def tables(found: Hunt) -> list[Table]:
    """Every table of the report, the most important first."""
    every = (
        _failures(found),
        _unseen(found),
        _rates(found),
        _sensitivity(found),
        _pairs(found),
        _unsteady(found),
        _errors(found),
    )
    return [table for table in every if table.rows]


def _failures(found: Hunt) -> Table:
    lines = []
    samples = judged(found.samples)
    for number, each in enumerate(found.minimal, 1):
        count = sum(tried.outcome.failed and each.covers(found.space, tried.point) for tried in samples)
        lines.append((str(number), each.words(found.space), each.why, _passes(each), str(count)))
    return Table(
        "failures",
        "Minimal failures",
        ("No.", "Fails with", "What is missing", "Passes with", "Samples it explains"),
        tuple(lines),
        f"Each failed {REPEATS} times of {REPEATS}. Factors that are not named are nominal; numbers are bisected. "
        "failures/NN.toml replays the failure and the nearest passing neighbour: automotive-cosim eval --plan.",
        heads=4,
    )


def _passes(each: MinimalFailure) -> str:
    if each.neighbour is None:
        return "no neighbour found"
    return f"{each.differs} {told(each.neighbour[each.differs])}"


def _unseen(found: Hunt) -> Table:
    bound, (covered, total) = unseen(found), coverage(found)
    samples = judged(found.samples)

    def share(value: float | None) -> str:
        return "–" if value is None else percent(value)

    return Table(
        "unseen",
        "What the search leaves unknown",
        ("Figure", "Value"),
        (
            ("Points sampled and judged", str(len(samples))),
            ("Runs in total, with repeats and reductions", str(len(found.tried))),
            ("Points that represent the whole space", str(bound.even)),
            ("Failures among them", str(bound.failed)),
            (f"Failure rate in the space at most ({CONFIDENCE_WORDS})", share(bound.upper)),
            ("Failures among them that no minimal failure explains", str(bound.unexplained)),
            (f"Rate of such failures at most ({CONFIDENCE_WORDS})", share(bound.unseen_upper)),
            (
                "Pairs of levels of two factors tried",
                f"{covered} of {total} ({100 * covered / max(1, total):.0f} %)",
            ),
        ),
        "Bounds are one-sided, by Clopper and Pearson (3/n if none was seen), over the points that were drawn from "
        "the whole space; points to which a search was drawn by failures do not count. They hold for this space "
        "and its values, not for the road.",
    )


def _rates(found: Hunt) -> Table:
    lines = []
    for factor in _varied(found):
        for level in dict.fromkeys(factor.levels):
            mine = [each for each in judged(found.samples) if factor.level(each.point[factor.name]) == level]
            if mine:
                lines.append((factor.name, level, *_rate(mine), *_rate([each for each in mine if each.even])))
    heads = "Factor", "Value", "Samples", "Pass % (interval)", "Of the whole space", "Pass % (interval)"
    note = "Intervals: Wilson, 95 %. Points beyond those of the whole space are drawn to failures by their margins."
    return Table("rates", "Passed by factor", heads, tuple(lines), note, heads=2)


def sensitivity(found: Hunt) -> list[tuple[Factor, float, float | None]]:
    """How much of the margin's variance each factor explains by itself, the most first, over the points that
    represent the whole space; and its rank correlation with the margin if it is an ordered number.

    The share is the correlation ratio of the margin's means by level, corrected for the number of levels (epsilon
    squared, Kelley 1935): a first-order Sobol index from given data. Empty with fewer than ``LEAST_EVEN`` points.
    """
    even = [each for each in judged(found.samples) if each.even]
    margins = np.array([each.outcome.margin for each in even], dtype=float)
    total = float(((margins - margins.mean()) ** 2).sum()) if len(even) else 0.0
    if len(even) < LEAST_EVEN or total == 0:
        return []
    shares = []
    for factor in _varied(found):
        levels = np.array([factor.level(each.point[factor.name]) for each in even])
        groups = [margins[levels == level] for level in dict.fromkeys(levels.tolist())]
        within = sum(float(((group - group.mean()) ** 2).sum()) for group in groups)
        freedom = len(even) - len(groups)
        share = 1 - (within / freedom) / (total / (len(even) - 1)) if freedom > 0 else 0.0
        rank = None
        if isinstance(factor, FactorRange) and factor.is_ordered:
            from scipy.stats import rankdata

            values = [factor.unit(each.point[factor.name]) for each in even]
            if len(set(values)) > 1:  # Spearman's
                rank = float(np.corrcoef(rankdata(values), rankdata(margins))[0, 1])
        shares.append((factor, min(1.0, max(0.0, share)), rank))
    return sorted(shares, key=lambda entry: -entry[1])


def _sensitivity(found: Hunt) -> Table:
    lines = [
        (factor.name, f"{100 * share:.0f}", "–" if rank is None else f"{rank:+.2f}".replace("-", "−"))
        for factor, share, rank in sensitivity(found)
    ]
    note = (
        "Over the points that represent the whole space: the share of the margin's variance that the factor "
        "explains by itself (first-order Sobol index from given data, corrected for the number of levels), and its "
        "rank correlation with the margin (Spearman): below 0, a higher number is worse."
    )
    return Table(
        "sensitivity", "Sensitivity", ("Factor", "Share of variance %", "Rank correlation"), tuple(lines), note
    )


def _varied(found: Hunt) -> list[Factor]:
    """The factors with more than one value."""
    return [each for each in found.space.factors if len(set(each.levels)) > 1]


def _rate(mine: Sequence[Tried]) -> tuple[str, str]:
    if not mine:
        return "0", "–"
    passed = sum(not each.outcome.failed for each in mine)
    bounds = wilson(passed, len(mine))
    return str(len(mine)), f"{100 * passed / len(mine):.0f} ({100 * bounds.low:.0f} to {100 * bounds.high:.0f})"


def _pairs(found: Hunt) -> Table:
    """The pairs of levels with the largest shares of failures."""
    lines = []
    samples = judged(found.samples)
    for one, other in combinations(_varied(found), 2):
        cells: dict[tuple[str, str], list[bool]] = {}
        for each in samples:
            cell = one.level(each.point[one.name]), other.level(each.point[other.name])
            cells.setdefault(cell, []).append(each.outcome.failed)
        lines += [_cell(one, other, cell, failed) for cell, failed in cells.items() if any(failed)]
    lines.sort(key=lambda line: (-line[0], line[1]))
    return Table(
        "two_factors",
        "Two factors at a time",
        ("Factors and values", "Failed", "Samples", "Failed %"),
        tuple(line[1:] for line in lines[:MOST_PAIRS]),
        f"The {MOST_PAIRS} pairs of values with the highest lower bounds (Wilson) of the failure rate.",
    )


def _cell(
    one: Factor, other: Factor, cell: tuple[str, str], failed: Sequence[bool]
) -> tuple[float, str, str, str, str]:
    words = f"{one.name} {cell[0]}, {other.name} {cell[1]}"
    low = wilson(sum(failed), len(failed)).low
    return low, words, str(sum(failed)), str(len(failed)), f"{100 * sum(failed) / len(failed):.0f}"


def _unsteady(found: Hunt) -> Table:
    lines = [("passed when repeated", _point(each), each.outcome.trial) for each in found.unsteady]
    lines += [("not made small", _point(each), each.outcome.trial) for each in found.not_reduced]
    return Table("other", "Other failures", ("What", "Where", "Trial"), tuple(lines), heads=3)


def _errors(found: Hunt) -> Table:
    wrong = [each for each in found.tried if each.outcome.margin is None]
    return Table(
        "search_errors",
        "Not judged",
        ("Where", "Why"),
        tuple((_point(each), each.outcome.error) for each in wrong),
        "Combinations that cannot be run, situations that did not arise, and infrastructure errors; no rate counts "
        "them.",
        heads=2,
    )


def _point(each: Tried) -> str:
    return ", ".join(f"{name} {told(value)}" for name, value in each.point.items())


def sentence(found: Hunt, agent: str) -> str:
    """What was found, in a sentence or two."""
    samples, bound = judged(found.samples), unseen(found)
    failed = sum(each.outcome.failed for each in samples)
    if not failed:
        told_first = f"{agent} failed in none of {counted(len(samples), 'sample')}."
    else:
        causes = counted(len(found.minimal), "minimal failure")
        told_first = f"{agent} failed in {failed} of {counted(len(samples), 'sample')}, from {causes}."
    if bound.upper is None:
        return told_first
    return f"{told_first} The failure rate in this space is at most {percent(bound.upper)} ({CONFIDENCE_WORDS})."


def as_json(found: Hunt) -> Json:
    """The findings as a JSON object."""
    bound, (covered, total) = unseen(found), coverage(found)
    samples = judged(found.samples)
    return {
        "samples": len(samples),
        "failed": sum(each.outcome.failed for each in samples),
        "runs": len(found.tried),
        "not_judged": len(found.tried) - len(judged(found.tried)),
        "failure_rate_upper": bound.upper,
        "unseen_rate_upper": bound.unseen_upper,
        "pairs_covered": covered,
        "pairs": total,
        "stopped": found.stopped,
        "failures": [
            {
                "words": each.words(found.space),
                "why": each.why,
                "point": dict(each.point),
                "neighbour": None if each.neighbour is None else dict(each.neighbour),
                "differs": each.differs,
                "trial": each.trial,
                "neighbour_trial": each.neighbour_trial,
            }
            for each in found.minimal
        ],
        "unsteady": [dict(each.point) for each in found.unsteady],
        "not_reduced": [dict(each.point) for each in found.not_reduced],
    }
