"""What a search has found: rates by factor, coverage, bounds on what was not seen, and failures in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import combinations
from math import prod

import numpy as np
from numpy.typing import NDArray

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted, rounded
from automotive_cosim.report.stats import CONFIDENCE, upper_bound, wilson
from automotive_cosim.report.tables import Table
from automotive_cosim.safety.hunt import NOMINAL, REPEATS, Hunt, MinimalFailure, Tried
from automotive_cosim.safety.space import BINS, Factor, FactorRange, FactorValue, SearchPoint, label_of, said

CONFIDENCE_WORDS = f"{100 * CONFIDENCE:.0f} %"
LEAST_EVEN = 12
"""Fewer points say nothing about a factor's share."""
POINTS_A_PART, MOST_PARTS = 8, 16
"""Points for each of the finer parts into which a range is cut to see what it explains, and how many at most."""
MOST_MAPS, MOST_COLUMNS = 3, 12
"""Maps of two factors, and levels of the second that fit beside each other."""
MOST_EMPTY = 40
"""Trials with nothing due that are listed; all of them are in tried.jsonl."""
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
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{rounded(100 * share, 2)} %"


def judged(tried: Sequence[Tried]) -> list[Tried]:
    """Those with a margin."""
    return [each for each in tried if each.outcome.margin is not None]


def nothing_due(tried: Sequence[Tried]) -> list[Tried]:
    """Those in which nothing required an act: neither passes nor failures."""
    return [each for each in tried if each.outcome.nothing_due]


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


def coverage(found: Hunt, together: int = 2) -> tuple[int, int]:
    """How many combinations of levels of so many factors were tried, and how many there are (t-wise coverage)."""
    points = [each.point for each in judged(found.tried)]
    covered = total = 0
    for factors in combinations(_varied(found), together):
        total += prod(len(set(factor.levels)) for factor in factors)
        covered += len({tuple(factor.level(point[factor.name]) for factor in factors) for point in points})
    return covered, total


def prevented(found: Hunt) -> tuple[int, int]:
    """How many minimal failures a careful watcher prevents, of those at which it was tried."""
    tried = [each.prevented for each in found.minimal if each.prevented is not None]
    return sum(tried), len(tried)


def tables(found: Hunt) -> list[Table]:
    """Every table of the report, the most important first."""
    every = (
        _failures(found),
        _unseen(found),
        _rates(found),
        _sensitivity(found),
        _pairs(found),
        *_maps(found),
        _unsteady(found),
        _nothing_due(found),
        _errors(found),
    )
    return [table for table in every if table.rows]


def _failures(found: Hunt) -> Table:
    lines = []
    samples = judged(found.samples)
    for number, each in enumerate(found.minimal, 1):
        count = sum(tried.outcome.failed and each.covers(found.space, tried.point) for tried in samples)
        careful = {None: "not tried", True: "prevents it", False: "fails too"}[each.prevented]
        lines.append(
            {
                "No.": str(number),
                "Fails with": each.words(found.space),
                "What is missing": each.why,
                "Act, or missing act": each.act or "not measured",
                "Beside it": each.beside or "no neighbour found",
                "A careful watcher": careful,
                "Combinations it explains": str(count),
            }
        )
    return Table.of(
        "failures",
        "Minimal failures",
        lines,
        f"Each failed {REPEATS} times of {REPEATS}, and what is beside it did not. Factors that "
        "are not named are nominal; numbers are bisected. "
        "The careful watcher is the reference: rule-perfect on drives, oracle on tasks. failures/NN.toml replays "
        "the failure and what is beside it, the nearest that does not fail: automotive-cosim eval --plan.",
        heads=6,
    )


def _unseen(found: Hunt) -> Table:
    bound, (averted, tried) = unseen(found), prevented(found)
    samples = judged(found.samples)

    def share(value: float | None) -> str:
        return "–" if value is None else percent(value)

    return Table(
        "unseen",
        "What the search leaves unknown",
        ("Figure", "Value"),
        (
            ("Combinations tried in which something was due", str(len(samples))),
            ("Combinations tried in which nothing was due", str(len(nothing_due(found.samples)))),
            ("Combinations passed over, as nothing came due without an agent", str(found.passed_over)),
            ("Runs in total, with repeats and reductions", str(len(found.tried))),
            ("Combinations that represent the whole space, something due", str(bound.even)),
            ("Failures among them", str(bound.failed)),
            (f"Failure rate in the space at most ({CONFIDENCE_WORDS})", share(bound.upper)),
            ("Failures among them that no minimal failure explains", str(bound.unexplained)),
            (f"Rate of such failures at most ({CONFIDENCE_WORDS})", share(bound.unseen_upper)),
            *(
                (f"{name} tried", f"{covered} of {total} ({100 * covered / max(1, total):.0f} %)")
                for name, (covered, total) in (
                    ("Pairs of levels of two factors", coverage(found)),
                    ("Triples of levels of three", coverage(found, 3)),
                )
                if total
            ),
            *([("Minimal failures that a careful watcher prevents", f"{averted} of {tried}")] if tried else []),
        ),
        "Bounds are one-sided, by Clopper and Pearson (3/n if none was seen), over the combinations drawn from the "
        "whole space in which something was due; those to which a search was drawn by failures do not "
        "count. They hold for this space and its values, not for the road.",
    )


def _rates(found: Hunt) -> Table:
    lines = []
    for factor in _varied(found):
        for level in dict.fromkeys(factor.levels):
            here = [each for each in found.samples if factor.level(each.point[factor.name]) == level]
            mine, empty = judged(here), len(nothing_due(here))
            if mine or empty:
                even = [each for each in mine if each.even]
                failed = sum(each.outcome.failed for each in mine)
                lines.append((_named(factor), level, str(len(mine)), str(failed), str(empty), *_rate(even)))
    heads = (
        "Factor",
        "Value",
        "Combinations",
        "Failed",
        "Nothing due",
        "Of the whole space",
        "Of these, pass % (interval)",
    )
    note = (
        "Combinations are those in which something was due; the others, in which nothing was, are neither passes "
        "nor failures. A rate, with Wilson's interval (95 %), is given over those alone that represent the whole "
        "space; the others were drawn to failures, so that they are counted and give none."
    )
    return Table("rates", "Passed by factor", heads, tuple(lines), note, heads=2)


def sensitivity(found: Hunt) -> list[tuple[Factor, float, float | None]]:
    """How much of the margin's variance each factor explains by itself, the most first, over the points that
    represent the whole space; and its rank correlation with the margin if it is an ordered number.

    The share is the correlation ratio of the margin's means by level, corrected for the number of levels (epsilon
    squared, Kelley 1935): a first-order Sobol index from given data. Ranges are cut into few parts, which see small
    effects, and into as many as the points allow, which see what rises and falls; the larger share counts. Empty
    with fewer than ``LEAST_EVEN`` points.
    """
    even = [each for each in judged(found.samples) if each.even]
    margins = np.array([each.outcome.margin for each in even], dtype=float)
    total = float(((margins - margins.mean()) ** 2).sum()) if len(even) else 0.0
    if len(even) < LEAST_EVEN or total == 0:
        return []
    shares = []
    for factor in _varied(found):
        values = [each.point[factor.name] for each in even]
        share = max(
            _explained(margins, _parts(factor, values, count)) for count in (BINS, len(even) // POINTS_A_PART)
        )
        rank = None
        if isinstance(factor, FactorRange) and factor.is_ordered:
            from scipy.stats import rankdata

            if len(set(values)) > 1:  # Spearman's
                rank = float(np.corrcoef(rankdata(list(map(factor.unit, values))), rankdata(margins))[0, 1])
        shares.append((factor, share, rank))
    return sorted(shares, key=lambda entry: -entry[1])


def _explained(margins: NDArray[np.float64], levels: Sequence[str]) -> float:
    """The share of the variance between levels (epsilon squared), at least 0."""
    names = np.array(levels)
    groups = [margins[names == level] for level in dict.fromkeys(levels)]
    within = sum(float(((group - group.mean()) ** 2).sum()) for group in groups)
    total, freedom = float(((margins - margins.mean()) ** 2).sum()), len(margins) - len(groups)
    return max(0.0, 1 - (within / freedom) / (total / (len(margins) - 1))) if freedom > 0 else 0.0


def _parts(factor: Factor, values: Sequence[FactorValue], count: int) -> list[str]:
    """The level of each value; of a range, which of so many equal parts."""
    if not isinstance(factor, FactorRange) or len(factor.levels) != BINS:
        return [factor.level(value) for value in values]
    parts = max(BINS, min(MOST_PARTS, count))
    return [str(min(parts - 1, int(factor.unit(value) * parts))) for value in values]


def _sensitivity(found: Hunt) -> Table:
    lines = [
        (_named(factor), f"{100 * share:.0f}", "–" if rank is None else f"{rank:+.2f}".replace("-", "−"))
        for factor, share, rank in sensitivity(found)
    ]
    note = (
        "Over the combinations that represent the whole space: the share of the margin's variance that the factor "
        "explains by itself (first-order Sobol index from given data, corrected for the number of levels), and its "
        "rank correlation with the margin (Spearman): below 0, a higher number is worse."
    )
    return Table(
        "sensitivity", "Sensitivity", ("Factor", "Share of variance %", "Rank correlation"), tuple(lines), note
    )


def _named(factor: Factor) -> str:
    """A factor as the heading of its values: ``visibility, m``."""
    return ", ".join(filter(None, label_of(factor.name)))


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
        ("Factors and values", "Failed", "Combinations"),
        tuple(line[1:] for line in lines[:MOST_PAIRS]),
        f"The {MOST_PAIRS} pairs of values with the most failures for their combinations, by Wilson's lower bound. "
        "Counts, not rates: samplers are drawn to failures.",
    )


def _maps(found: Hunt) -> list[Table]:
    """Maps of the failures over two factors, for the pairs of factors with the worst pairs of levels."""
    samples = judged(found.samples)
    worst: list[tuple[float, str, Factor, Factor, dict[tuple[str, str], list[bool]]]] = []
    for one, other in combinations(_varied(found), 2):
        cells: dict[tuple[str, str], list[bool]] = {}
        for each in samples:
            cell = one.level(each.point[one.name]), other.level(each.point[other.name])
            cells.setdefault(cell, []).append(each.outcome.failed)
        low = max((wilson(sum(failed), len(failed)).low for failed in cells.values() if any(failed)), default=0.0)
        if low > 0 and len(set(other.levels)) <= MOST_COLUMNS:
            worst.append((-low, f"{one.name} and {other.name}", one, other, cells))
    made = []
    for number, (_, _, one, other, cells) in enumerate(sorted(worst, key=lambda each: each[:2])[:MOST_MAPS], 1):
        columns = tuple(dict.fromkeys(other.levels))
        rows = tuple(
            (row, *(_share_of(cells.get((row, column), ())) for column in columns))
            for row in dict.fromkeys(one.levels)
        )
        note = f"Failures of combinations. Rows are {_named(one)}, columns {_named(other)}; – was not tried."
        names = f"{label_of(one.name)[0]} and {label_of(other.name)[0]}"
        made.append(Table(f"map_{number}", f"Map of {names}", (_named(one), *columns), rows, note))
    return made


def _share_of(failed: Sequence[bool]) -> str:
    return f"{sum(failed)} of {len(failed)}" if failed else "–"


def _cell(one: Factor, other: Factor, cell: tuple[str, str], failed: Sequence[bool]) -> tuple[float, str, str, str]:
    words = ", ".join(
        " ".join(filter(None, (name, level, unit)))
        for (name, unit), level in zip((label_of(one.name), label_of(other.name)), cell, strict=True)
    )
    low = wilson(sum(failed), len(failed)).low
    return low, words, str(sum(failed)), str(len(failed))


def _unsteady(found: Hunt) -> Table:
    lines = [("passed when repeated", _point(each), each.outcome.trial) for each in found.unsteady]
    lines += [("not reduced", _point(each), each.outcome.trial) for each in found.not_reduced]
    return Table("other", "Other failures", ("What", "Where", "Run"), tuple(lines), heads=3)


def _nothing_due(found: Hunt) -> Table:
    empty = nothing_due(found.tried)
    more = f" {len(empty) - MOST_EMPTY} more are in tried.jsonl." if len(empty) > MOST_EMPTY else ""
    return Table(
        "nothing_due",
        "Runs in which nothing was due",
        ("Where", "Why", "Run"),
        tuple((_point(each), each.outcome.nothing_due, each.outcome.trial) for each in empty[:MOST_EMPTY]),
        "Nothing that the space's rule judges required an act, and the agent did nothing wrong: whoever does "
        "nothing gets the same. They are neither passes nor failures, no rate counts them, and samplers are drawn "
        "elsewhere. If there are many, stage more, or widen `events` in the space's [failure]." + more,
        heads=3,
    )


def _errors(found: Hunt) -> Table:
    wrong = [each for each in found.tried if each.outcome.margin is None and not each.outcome.nothing_due]
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
    return ", ".join(said(name, value) for name, value in each.point.items())


def sentence(found: Hunt, agent: str) -> str:
    """What was found, in a sentence or two."""
    samples, bound = judged(found.samples), unseen(found)
    failed, empty = sum(each.outcome.failed for each in samples), len(nothing_due(found.samples))
    told_first = of_due(f"{agent} failed in", failed, len(samples), empty)
    if failed:
        told_first += (
            f" From {counted(len(found.minimal), 'minimal failure')}." if found.minimal else " None reduced."
        )
    if any(not each.changed for each in found.minimal):
        told_first = f"{agent} fails with {NOMINAL}. Beside that, {told_first}"
    if bound.upper is None:
        return told_first
    where = "Where something is due in this space, the failure rate" if empty else "The failure rate in this space"
    return f"{told_first} {where} is at most {percent(bound.upper)} ({CONFIDENCE_WORDS})."


def of_due(what: str, failed: int, due: int, empty: int) -> str:
    """How many failed, of the trials in which something was due, which is what every count of failures is of."""
    if not due:
        trials = "the only run" if empty == 1 else f"any of {counted(empty, 'run')}"
        return f"Nothing was due in {trials}, so that nothing is known."
    told = f"{what} {failed or 'none'} of {counted(due, 'run')} in which something was due"
    return f"{told}; in {empty} more nothing was due." if empty else f"{told}."


def as_json(found: Hunt) -> Json:
    """The findings as a JSON object."""
    bound, (covered, total), (triples, of_triples) = unseen(found), coverage(found), coverage(found, 3)
    averted, tried = prevented(found)
    samples = judged(found.samples)
    return {
        "samples": len(samples),
        "failed": sum(each.outcome.failed for each in samples),
        "runs": len(found.tried),
        "nothing_due": len(nothing_due(found.samples)),
        "passed_over": found.passed_over,
        "not_judged": len(found.tried) - len(judged(found.tried)) - len(nothing_due(found.tried)),
        "failure_rate_upper": bound.upper,
        "unseen_rate_upper": bound.unseen_upper,
        "pairs_covered": covered,
        "pairs": total,
        "triples_covered": triples,
        "triples": of_triples,
        "careful_prevents": averted,
        "careful_tried": tried,
        "stopped": found.stopped,
        "rule": asdict(found.space.rule),
        "failures": [
            {
                "words": each.words(found.space),
                "why": each.why,
                "act": each.act,
                "point": dict(each.point),
                "neighbour": None if each.neighbour is None else dict(each.neighbour),
                "differs": each.differs,
                "beside": each.beside,
                "trial": each.trial,
                "neighbour_trial": each.neighbour_trial,
                "careful_prevents": each.prevented,
            }
            for each in found.minimal
        ],
        "unsteady": [dict(each.point) for each in found.unsteady],
        "not_reduced": [dict(each.point) for each in found.not_reduced],
        "sampled_trials": [each.outcome.trial for each in found.samples if each.outcome.trial],
    }
