"""The result of an evaluation or a comparison in one sentence, which stands first on every page."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from automotive_cosim.agents import NOT_RANKED
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.report import drives
from automotive_cosim.report.results import Contestant, Results, pair_instance, pairs
from automotive_cosim.report.stats import LEAST_CLUSTERS, Comparison, Interval, compare
from automotive_cosim.report.summary import rate_of
from automotive_cosim.run.rows import EpisodeRow


def answer(results: Results) -> str:
    """Who is better by how much, on how many pairs or episodes, and how many ended in an error.

    References and negative controls are not ranked, unless there is nobody else."""
    told = []
    if results.rows:
        told.append(_ranking(results.shared()))
    if results.drives:
        ranked = [row for row in results.drives if row.agent not in NOT_RANKED]
        told += [f"{line} ({drives.SCALE})" for line in drives.standings(ranked or results.drives)[:1]]
    trials = (*results.rows, *results.drives)
    errors = sum(row.error is not None for row in trials)
    ended = (
        f"{errors:,} of {counted(len(trials), 'run')} ended in an error" if errors else "no run ended in an error"
    )
    return "; ".join([*filter(None, told), ended]) + "."


def agents_as_json(results: Results) -> list[Json]:
    """Each agent's rate over its planned episodes, from 0 to 1, or the score of its drives, with 95 % intervals."""
    told: list[Json] = []
    for each in results.contestants:
        found = rate_of(results.planned_of(each))
        told.append(
            _who(each)
            | {"episodes": found.planned, "successes": found.successes, "errors": found.errors}
            | {"not_run": found.not_run, "rate": found.value, "interval": _ends(found.interval)}
        )
    for each, rows in drives.grouped(results.drives).items():
        told.append(
            _who(each)
            | {"drives": len(rows), "score": drives.value_of(rows)}
            | {"interval": _ends(drives.interval(rows, drives.value_of))}
        )
    return told


def _who(each: Contestant) -> Json:
    return {"agent": each.agent, "model": each.model, "label": each.label}


def _ends(interval: Interval | None) -> list[float] | None:
    return None if interval is None else [interval.low, interval.high]


def _ranking(results: Results) -> str:
    """The best contestant beside the next, by pairs if both halves of some were judged, else by episodes."""
    ranked = [each for each in results.contestants if each.agent not in NOT_RANKED] or list(results.contestants)
    has_pairs = all(any(pair.success is not None for pair, _ in pairs(results.of(each))) for each in ranked)
    unit = "pair" if has_pairs else "episode"
    rows = {each: _units(results.of(each), unit) for each in ranked}
    best, *others = sorted(ranked, key=lambda each: -(rate_of(rows[each]).value or 0.0))
    if not others:
        found = rate_of(rows[best])
        beside = f", {found.not_run:,} not run" if found.not_run else ""
        share = "" if found.value is None else f" ({found.value:.0%}{_bounds(found.interval)})"
        return f"{best.label} solves {found.successes} of {counted(found.ran, unit)}{share}{beside}"
    of = f", best of {len(ranked)}" if len(ranked) > 2 else ""
    return _against(best, others[0], rows[best], rows[others[0]], unit) + of


def _units(rows: Sequence[EpisodeRow], unit: str) -> list[EpisodeRow]:
    return [pair for pair, _ in pairs(rows)] if unit == "pair" else list(rows)


def _against(
    best: Contestant, other: Contestant, ones: Sequence[EpisodeRow], others: Sequence[EpisodeRow], unit: str
) -> str:
    def outcomes(rows: Sequence[EpisodeRow]) -> dict[Hashable, bool]:
        return {_key(row, unit): row.has_succeeded for row in rows if row.success is not None}

    found = compare(outcomes(ones), outcomes(others), {_key(row, unit): row.task for row in ones})
    if found is None:
        return f"{best.label} and {other.label} have no {unit} in common"
    return versus(best.label, other.label, found, unit)


def _key(row: EpisodeRow, unit: str) -> Hashable:
    return pair_instance(row) if unit == "pair" else row.instance


def versus(first: str, second: str, found: Comparison, unit: str) -> str:
    """Two contestants, and by how many percentage points the first is better, if that can be told, on how many
    units."""
    difference = counted(round(100 * found.difference), "percentage point").replace("-", "−")
    if found.interval is None:
        ahead, behind = (first, second) if found.difference > 0 else (second, first)
        lead = f"{ahead} is {difference.removeprefix('−')} ahead of {behind}"
        lead = (
            lead
            if found.difference
            else f"{first} and {second} are level, {found.both + found.only_first} won each,"
        )
        on = f"{counted(found.count, unit)} of {counted(found.clusters, 'task')}"
        return f"{lead} on {on}, too few to tell agents apart ({LEAST_CLUSTERS} tasks are needed)"
    points = f"{difference} ({_signed(found.interval.low)} to {_signed(found.interval.high)})"
    if found.interval.low > 0:
        return f"{first} beats {second} by {points}, {counted(found.count, unit)}"
    return f"{first} and {second} cannot be told apart: a difference of {points}, {counted(found.count, unit)}"


def _signed(share: float) -> str:
    return f"{round(100 * share):d}".replace("-", "−")


def _bounds(interval: Interval | None) -> str:
    return "" if interval is None else f", {interval.low:.0%} to {interval.high:.0%}"
