"""``decisions.html``: every decision of a study, with the traffic news, the policies' choices and the results."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean

from automotive_cosim.errors import UserError
from automotive_cosim.formats.csvs import read_packed_csv
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.report.templates import render
from automotive_cosim.run.effect import ActEffect, weighed
from automotive_cosim.studies.reroute.data import choosers
from automotive_cosim.studies.reroute.results import Study, all_decisions, standard_error
from automotive_cosim.studies.reroute.rows import Decision, DecisionPoint
from automotive_cosim.studies.reroute.tracks import TRACKS

KEPT = "kept route"
WIDTH, HEIGHT = 320.0, 200.0
"""Size of a map, in pixels."""

COMPARED = {"arrival_s": "time_s", "driven_m": "distance_m", "energy_wh": "energy_wh", "co2_g": "co2_g"}
"""What is compared of two drives, by the names of ``effect.FIGURES``."""
Way = Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class ExplainedFuture:
    """One future, as means over the draws that count."""

    name: str
    policies: str
    """Policies that chose it by the newest news, without ``best``."""
    time_s: float
    """From departure to destination."""
    saved_s: float | None
    """None for the kept route, with which the others are compared."""
    error_s: float | None
    """Standard error of that; None for a single draw."""
    others_s: float | None
    later: int | None
    """Others that arrive at least a second later."""


@dataclass(frozen=True, slots=True)
class ExplainedDecision:
    """One decision."""

    point: DecisionPoint
    told: tuple[str, ...]
    """What the news of each age said, and what followed, in words."""
    futures: tuple[ExplainedFuture, ...]
    ways: tuple[tuple[str, str], ...]
    """Name of each route and its points on a map, in SVG's form; empty without tracks."""


def write_decisions(study: Study) -> Path:
    """Writes the page into the study's folder; returns its path. Raises OSError: it cannot be written."""
    page = study.folder / "decisions.html"
    found = list(explained(study))
    write_whole(
        page, render("studies/reroute/decisions.html", study=study, found=found, width=WIDTH, height=HEIGHT)
    )
    return page


def explained(study: Study) -> Iterator[ExplainedDecision]:
    """Every decision, including those that are in no average."""
    for point in all_decisions(study.rows):
        ways = _ways(study.folder / TRACKS / f"{point.drive.id}.csv.gz", point.id)
        yield ExplainedDecision(point, tuple(told(point.decision)), tuple(_futures(study, point)), _fitted(ways))


def attributed(folder: Path, item: str) -> list[ActEffect]:
    """What decisions changed whose ids begin so: each other route against the kept one, over all draws, so that
    what fresh random numbers change as much is not called an effect.

    Raises UserError: there is none, or the study cannot be read."""
    study = Study.read(folder)
    points = [point for point in all_decisions(study.rows) if point.id.startswith(item)]
    if not points:
        raise UserError(f"no decision in {folder} begins with {item!r}; choices.csv has the ids")
    return [
        _effect(point, number, by_branch.get(number, ""))
        for point in points
        for by_branch in [choosers(study.plan, point.decision)]
        for number in range(len(point.decision.branches))
    ]


def _effect(point: DecisionPoint, number: int, policies: str) -> ActEffect:
    decision, stay = point.decision, point.drive.stay
    assert stay is not None, "it has a decision"
    pairs = [
        (branch.totals, decision.replicates[draw - 1].stay.totals if draw else stay)
        for draw in range(decision.draws)
        if (branch := decision.drawn(draw, number)) is not None
    ]
    draws = [
        {name: (getattr(one, of), getattr(other, of)) for name, of in COMPARED.items()} for one, other in pairs
    ]
    changed, chance = weighed(draws)
    names = f" ({policies})" if policies else ""
    words = f"{point.id}: alternative {number + 1}{names} instead of the kept route"
    words += f", in no average: {decision.excluded}" if decision.excluded else ""
    words += "; driven once, --replicates 4 tells an effect from chance" if len(draws) == 1 else ""
    return ActEffect((), decision.at_s, words, changed=changed, chance=chance, draws=len(draws))


def told(decision: Decision) -> Iterator[str]:
    """What the news of each age said at a decision and what agents did, in sentences."""
    for news in decision.news:
        source = f"Traffic news, {news.age_s:g} s old" if news.age_s else "Traffic news"
        if news.stay_s is None:
            yield f"{source}: no travel time."
        elif news.offered_s is None:
            yield f"{source}: {news.stay_s:.0f} s on the current route, no alternative."
        else:
            yield (
                f"{source}: {news.stay_s:.0f} s on the current route ({news.delay_s:.0f} s more than on empty "
                f"roads), {news.offered_s:.0f} s on the alternative."
            )
    for agent in decision.agents:
        yield f"{agent} {'rerouted' if agent in decision.agents_rerouted else 'kept the route'}."
    if decision.excluded:
        yield f"In no average: {decision.excluded}; {decision.why}."


def _futures(study: Study, point: DecisionPoint) -> Iterator[ExplainedFuture]:
    decision, stay = point.decision, point.drive.stay
    assert stay is not None, "it has a decision"
    by_branch = choosers(study.plan, decision)
    kept_s = [decision.replicates[draw - 1].stay.totals.time_s if draw else stay.time_s for draw in decision.scored]
    yield ExplainedFuture(KEPT, by_branch.get(None, ""), fmean(kept_s), None, None, None, None)
    for number in range(len(decision.branches)):
        drawn = [branch for draw in decision.scored if (branch := decision.drawn(draw, number)) is not None]
        gains_s = [branch.gains.time_s for branch in drawn]
        yield ExplainedFuture(
            f"alternative {number + 1}",
            by_branch.get(number, ""),
            fmean(branch.totals.time_s for branch in drawn),
            fmean(gains_s),
            standard_error(gains_s),
            fmean(branch.others.gain_s for branch in drawn),
            decision.spreads[number].later if number < len(decision.spreads) else None,
        )


def _ways(path: Path, decision: str) -> Mapping[str, Way]:
    """Where the ego went in the futures of the first draw; empty without a file of tracks."""
    ways: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for row in read_packed_csv(path):
        if row["id"] == decision and row["draw"] == "0":
            name = f"alternative {int(row['branch']) + 1}" if row["branch"] else KEPT
            ways[name].append((float(row["x_m"]), float(row["y_m"])))
    return ways


def _fitted(ways: Mapping[str, Way]) -> tuple[tuple[str, str], ...]:
    """The routes on a map that shows all of them, north up."""
    points = [point for way in ways.values() for point in way]
    if not points:
        return ()
    west, south = (min(point[axis] for point in points) for axis in (0, 1))
    east, north = (max(point[axis] for point in points) for axis in (0, 1))
    scale = min((WIDTH - 20) / max(1.0, east - west), (HEIGHT - 20) / max(1.0, north - south))
    return tuple(
        (name, " ".join(f"{10 + (x - west) * scale:.1f},{10 + (north - y) * scale:.1f}" for x, y in way))
        for name, way in ways.items()
    )
