"""``report.html`` of an evaluation of drives: tables by agent, kind and family, and a timeline of each drive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import ToldPolicy
from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.drives.departure import car_named
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.faults import faults
from automotive_cosim.drives.followed import FOLLOWED_S, LATER_S, followed
from automotive_cosim.drives.judge import FULL_S
from automotive_cosim.drives.score import Score, together
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.measures.exposure import summed
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS
from automotive_cosim.report.charts import Chart
from automotive_cosim.report.drivechart import timeline_chart
from automotive_cosim.report.findings import act_effects
from automotive_cosim.report.fleet import FleetCar, shown_fleet
from automotive_cosim.report.house_rules import house_rules
from automotive_cosim.report.results import Contestant, contestant
from automotive_cosim.report.stats import CONFIDENCE, LEAST_CLUSTERS, Interval
from automotive_cosim.report.tables import Cell, Table, TableRow
from automotive_cosim.run.fleet_record import fleets_in, read_fleet
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.run.store import read_trace, trace_file

DRAWS = 2000
"""Bootstrap samples of whole drives, at which the second digit of a bound is stable."""
SHOWN = 8
"""Maximum number of timelines on the page; all of them are written as files."""

Figure = Callable[[Sequence[DriveTrialRow]], float | None]
"""A figure of several drives together; None if there is nothing to divide by."""


def grouped(rows: Iterable[DriveTrialRow]) -> dict[Contestant, list[DriveTrialRow]]:
    """The judged drives of each watcher, the best first."""
    found: dict[Contestant, list[DriveTrialRow]] = {}
    for row in rows:
        if row.score is not None:
            found.setdefault(contestant(row), []).append(row)
    return dict(sorted(found.items(), key=lambda entry: -whole(entry[1]).value))


def whole(rows: Sequence[DriveTrialRow]) -> Score:
    """The score of all drives pooled."""
    return together([row.score for row in rows if row.score is not None])


def standings(rows: Iterable[DriveTrialRow]) -> list[str]:
    """A line for each watcher."""
    lines = []
    groups = grouped(rows)
    for each, mine in groups.items():
        total = whole(mine)
        due = sum(not row.has_nothing_due for row in mine)
        of_due = f", something due in {due}" if due < len(mine) else ""
        recall = "no events" if total.recall is None else f"{total.recall:.0%} of {total.events} events met"
        lines.append(
            f"{each.label}: score {told(mine, value_of, '.0f')}; {recall}, "
            f"{total.false_alarms_per_h:.1f} false alarms and {total.nuisances_per_h:.1f} nuisances an hour, "
            f"{counted(len(mine), 'drive')}{of_due}{_left_alone(mine)}"
        )
    if len({whole(mine).events for mine in groups.values()}) > 1:
        lines.append(DIVERGE)
    return lines


def _left_alone(rows: Sequence[DriveTrialRow]) -> str:
    """How many drives nobody watched to their end, and from when on at the earliest."""
    from_s = [row.unwatched_from_s for row in rows if row.unwatched_from_s is not None]
    if not from_s:
        return ""
    return f"; nobody watched {counted(len(from_s), 'drive')} to the end, one from {clock(min(from_s))} on"


SCALE = "a score of 0 is doing nothing, 100 the rule-perfect watcher"
DIVERGE = (
    "Watchers meet different events on the same drive: after the first act, driver and traffic go another way."
)


# --- figures of several drives ----------------------------------------------------------------------------------


def value_of(rows: Sequence[DriveTrialRow]) -> float | None:
    """The score of all drives pooled, in points."""
    return whole(rows).value


def _share(of: Callable[[Score], float | None]) -> Figure:
    def figure(rows: Sequence[DriveTrialRow]) -> float | None:
        found = of(whole(rows))
        return None if found is None else 100 * found

    return figure


def _saved(of: Callable[[Any], float]) -> Figure:
    """The share of the do-nothing runs' harm that was avoided."""

    def figure(rows: Sequence[DriveTrialRow]) -> float | None:
        pairs = [(row.harm, row.baseline_harm) for row in rows if row.harm and row.baseline_harm]
        before = sum(of(baseline) for _, baseline in pairs)
        return 100 * (before - sum(of(mine) for mine, _ in pairs)) / before if before else None

    return figure


def _per_hour(of: Callable[[DriveTrialRow], float]) -> Figure:
    def figure(rows: Sequence[DriveTrialRow]) -> float | None:
        driven_s = whole(rows).driven_s
        return 3600 * sum(map(of, rows)) / driven_s if driven_s else None

    return figure


def _watched_share(rows: Sequence[DriveTrialRow]) -> float | None:
    """The share of the driving time in which the agent watched, before it failed or its budget was spent."""
    judged = [row for row in rows if row.score is not None]
    driven_s = sum(row.score.driven_s for row in judged if row.score is not None)
    watched_s = sum(
        row.score.driven_s if row.unwatched_from_s is None else row.unwatched_from_s
        for row in judged
        if row.score is not None
    )
    return 100 * watched_s / driven_s if driven_s else None


FIGURES: tuple[tuple[str, Figure, str], ...] = (
    ("Score", value_of, ".0f"),
    ("Recall %", _share(lambda score: score.recall), ".0f"),
    ("Precision %", _share(lambda score: score.precision), ".0f"),
    ("False alarms/h", lambda rows: whole(rows).false_alarms_per_h, ".1f"),
    ("Nuisances/h", lambda rows: whole(rows).nuisances_per_h, ".1f"),
    ("Known to act s", lambda rows: whole(rows).median_delay_s, ".1f"),
    ("Due to act s", lambda rows: whole(rows).median_due_s, ".1f"),
    ("Watched %", _watched_share, ".0f"),
)
"""Columns of the first table: name, figure, format."""
WITH_INTERVAL = 5
"""The first of them have intervals."""
EFFECTS: tuple[tuple[str, Figure, str], ...] = (
    ("Overspeed saved %", _saved(lambda harm: float(harm.over_limit_m)), ".0f"),
    ("Near collision s/h", _per_hour(lambda row: row.harm.short_ttc_s if row.harm else 0.0), ".1f"),
    (
        "the same without it",
        _per_hour(lambda row: row.baseline_harm.short_ttc_s if row.baseline_harm else 0.0),
        ".1f",
    ),
    ("Attention lost s/h", _per_hour(lambda row: row.harm.unaware_s if row.harm else 0.0), ".0f"),
    ("Distraction s/h", _per_hour(lambda row: row.distraction_s), ".0f"),
    ("Steps/h", _per_hour(lambda row: row.steps), ".0f"),
    ("Model calls/h", _per_hour(lambda row: row.calls), ".0f"),
    ("Tokens/h", _per_hour(lambda row: row.tokens_in + row.tokens_out), ".0f"),
    ("Model s/h", _per_hour(lambda row: row.model_seconds), ".0f"),
)
"""Columns of the table of what watching did and took."""


def interval(rows: Sequence[DriveTrialRow], figure: Figure) -> Interval | None:
    """Bounds from resampling whole drives, each with its repeats; None with fewer than ``LEAST_CLUSTERS``."""
    return _resampled([(row, row) for row in rows], lambda picked: figure([row for row, _ in picked]))


@dataclass(frozen=True, slots=True)
class ScoreChange:
    """The score of the same drives before and after, each of all of them together, in points."""

    before: float
    after: float
    bounds: Interval | None
    """Of the difference in points, from resampling whole drives; None with fewer than ``LEAST_CLUSTERS``."""

    @property
    def difference(self) -> float:
        """After minus before as a share of the score's 100 points, as rates have it."""
        return (self.after - self.before) / 100

    @property
    def interval(self) -> Interval | None:
        """The bounds as shares of the score."""
        return None if self.bounds is None else Interval(self.bounds.low / 100, self.bounds.high / 100)


def score_change(judged: Sequence[tuple[DriveTrialRow, DriveTrialRow]]) -> ScoreChange | None:
    """Compares the scores of drives that were judged both times; None without any.

    Args:
        judged: each drive before and after."""

    def scores(picked: RowPairs) -> tuple[float, float]:
        before, after = (whole([pair[which] for pair in picked]).value for which in (0, 1))
        return before, after

    def difference(picked: RowPairs) -> float:
        before, after = scores(picked)
        return after - before

    return ScoreChange(*scores(judged), _resampled(judged, difference)) if judged else None


RowPairs = Sequence[tuple[DriveTrialRow, DriveTrialRow]]


def _resampled(pairs: RowPairs, figure: Callable[[RowPairs], float | None]) -> Interval | None:
    clusters: dict[tuple[str, int], list[tuple[DriveTrialRow, DriveTrialRow]]] = {}
    for pair in pairs:
        clusters.setdefault((pair[0].family, pair[0].seed), []).append(pair)
    groups = list(clusters.values())
    if len(groups) < LEAST_CLUSTERS:
        return None
    rng = np.random.default_rng(0)
    found = []
    for picks in rng.integers(len(groups), size=(DRAWS, len(groups))):
        value = figure([pair for pick in picks for pair in groups[pick]])
        if value is not None:
            found.append(value)
    if not found:
        return None
    tail = 100 * (1 - CONFIDENCE) / 2
    low, high = np.percentile(found, (tail, 100 - tail))
    return Interval(float(low), float(high))


def told(rows: Sequence[DriveTrialRow], figure: Figure, form: str, *, bounded: bool = True) -> str:
    """A figure with its interval, as text."""
    value = figure(rows)
    if value is None:
        return "–"
    text = f"{value:{form}}"
    bounds = interval(rows, figure) if bounded else None
    if bounds is not None:
        text += f" ({bounds.low:{form}} to {bounds.high:{form}})"
    return text.replace("-", "−")


# --- tables --------------------------------------------------------------------------------------------------


def tables(rows: Sequence[DriveTrialRow], folder: Path) -> list[Table]:
    """Every table of the report, the most important first; what became of acts is read from the folder's traces."""
    groups = grouped(rows)
    return [
        table
        for table in (
            _watchers(groups),
            _cars(rows),
            _faults(groups),
            _acts(groups, folder),
            act_effects(folder, {row.id: f"{contestant(row).label}, {row.name}, seed {row.seed}" for row in rows}),
            _kinds(groups),
            _families(groups),
            _effects(groups),
            _measures(groups),
            _exposed(groups),
            _unwatched(rows),
            *([house_rules(groups, "policy_of_drives")] if any(map(_is_ruled, rows)) else []),
            _errors(rows),
        )
        if table.rows
    ]


def _is_ruled(row: DriveTrialRow) -> bool:
    return row.conditions.policy is not ToldPolicy.NONE or bool(row.breaches)


def _watchers(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    lines: tuple[TableRow, ...] = tuple(
        (
            each.label,
            str(len(mine)),
            f"{whole(mine).driven_s / 3600:.1f}",
            *(
                Cell(told(mine, figure, form, bounded=number < WITH_INTERVAL), tuple(row.id for row in mine))
                for number, (_, figure, form) in enumerate(FIGURES)
            ),
        )
        for each, mine in groups.items()
    )
    return Table(
        "watchers",
        "Watchers",
        ("Watcher", "Drives", "Hours", *(name for name, _, _ in FIGURES)),
        lines,
        f"{SCALE[2:].capitalize()}; a nuisance costs as much as a miss of weight "
        f"1, a look-alike taken for an event twice its weight. {DIVERGE} Known to act: median from when an event "
        "could be known to the act that met it; due to act: from when it was due, of events met after that, where "
        f"up to {FULL_S:g} s cost nothing. {_intervals_told(groups)}",
    )


def _intervals_told(groups: dict[Contestant, list[DriveTrialRow]]) -> str:
    if all(interval(mine, value_of) is None for mine in groups.values()):
        return f"Fewer than {LEAST_CLUSTERS} drives give no intervals."
    return f"In brackets: 95 % intervals from resampling whole drives, from {LEAST_CLUSTERS} drives on."


def fleets(folder: Path, rows: Sequence[DriveTrialRow]) -> tuple[str, dict[str, str]]:
    """The fleets whose cars were recorded: maps for the report with links, and a page for each by its file.

    Raises UserError: a record is damaged."""
    known, maps, pages = {row.id: row for row in rows}, [], {}
    for name, _ in fleets_in(folder):
        fleet = read_fleet(folder, name)
        cars = {car: known[trial] for car, trial in fleet.trials.items() if trial in known} if fleet else {}
        if fleet is None or not cars:
            continue
        first, page = next(iter(cars.values())), f"{name}.html"
        title = f"{counted(len(cars), 'car')}: {first.name}, seed {first.seed}, {contestant(first).label}"
        told = [shown_car(car, row) for car, row in cars.items()]
        note = "A score of 0 is doing nothing, 100 the rule-perfect watcher."
        picture, pages[page] = shown_fleet(
            fleet, told, LOOKS, OF_A_CAR, page, title=title, about=first.scenario, note=note
        )
        maps.append(f'<h2>Fleet</h2>\n<p><a href="{page}">{title}</a></p>\n{picture}')
    return "\n".join(maps), pages


LOOKS = {
    "sooner": "everything was met, nothing was a nuisance",
    "later": "something was missed or a nuisance",
    "same": "nothing was due",
    "failed": "its agent failed",
}
"""Cars on a map, by how they look."""
OF_A_CAR = "Seed", "Score", "Events met", "Nuisances", "Steps"


def shown_car(car: str, row: DriveTrialRow) -> FleetCar:
    """A car on the map and in the list, by SUMO's id."""
    error, words = row.error or row.agent_error or "", row.error or str(row.end).replace("_", " ")
    cells: tuple[str, ...] = (str(row.seed), "–", "–", "–", str(row.steps))
    kind = "failed" if error else "same" if row.has_nothing_due else "sooner" if row.outcome else "later"
    if row.score is not None:
        met = f"{row.score.met} of {row.score.events}"
        cells = str(row.seed), f"{row.score.value:.0f}", met, str(row.score.nuisances), str(row.steps)
        words = f"{met} events met, {counted(row.score.nuisances, 'nuisance')}"
    return FleetCar(car, kind, "; ".join(filter(None, (words, _unanswered(row)))), cells, error)


def _unanswered(row: DriveTrialRow) -> str:
    """In how many steps its agent gave no action, and why at first; empty if it always gave one."""
    return f"no action in {counted(row.malformed, 'step')}, at first: {row.malformed_why}" if row.malformed else ""


def _cars(rows: Sequence[DriveTrialRow]) -> Table:
    """Every car of every fleet."""
    lines = tuple(
        (f"{row.name}, seed {row.seed - row.car}", contestant(row).label, car.name, *car.cells, why)
        for row in sorted(rows, key=lambda row: (row.name, row.seed - row.car, contestant(row).label, row.car))
        if row.settings.cars
        for car in [shown_car(car_named(row.car), row)]
        for why in [car.error or _unanswered(row)]
    )
    heads = "Fleet", "Watcher", "Car", *OF_A_CAR, "Failure"
    return Table("cars", "Cars of fleets", heads, lines, "What failed in one car is that car's alone.", heads=3)


def _effects(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    """What watching did on the road, and what it took."""
    lines = tuple(
        (each.label, *(told(mine, figure, form, bounded=False) for _, figure, form in EFFECTS))
        for each, mine in groups.items()
    )
    return Table(
        "effects",
        "What watching did, and what it took",
        ("Watcher", *(name for name, _, _ in EFFECTS)),
        lines,
        "Saved: compared with the do-nothing run of the same drive. Near collision: below 3 s to the vehicle ahead "
        "while only hard braking avoids it, and the same without the agent.",
    )


def _faults(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    """What every watcher missed, met too late, or did needlessly."""
    lines = tuple(
        (each.label, f"{row.name}, seed {row.seed}", clock(fault.time_s), fault.what, fault.about, fault.why)
        for each, mine in groups.items()
        for row in mine
        for fault in faults(row.events, row.acts)
    )
    return Table(
        "faults",
        "Missed, late and needless",
        ("Watcher", "Drive", "When", "What", "Event or act", "Why"),
        lines,
        "When: minutes and seconds since departure at which something was due, or the agent acted. Why: what was "
        "there, from when to when something was due, and what came; of a needless act, what speaks against it of "
        "what could be known, and when it would have been right.",
        heads=6,
    )


def _acts(groups: dict[Contestant, list[DriveTrialRow]], folder: Path) -> Table:
    """Every act, and what became of it."""
    lines = []
    for each, mine in groups.items():
        for row in mine:
            timeline = timeline_of(folder, row.id) or {}
            for act, came in zip(row.acts, followed(row.acts, timeline) if timeline else (), strict=False):
                when = "" if came.answered_s is None else f"{came.answered_s:.1f}"
                drove = f"{came.before_kmh:.0f}", f"{came.after_kmh:.0f}", f"{came.over_s:.0f}"
                lines.append(
                    (
                        *(each.label, f"{row.name}, seed {row.seed}", clock(act.time_s), act.words),
                        *(str(act.worth), came.answer or "none asked", when, came.did, *drove),
                    )
                )
    return Table(
        "acts",
        "What became of each act",
        (
            *("Watcher", "Drive", "When", "Act", "Judged", "Driver", "After s", "Did"),
            *("km/h at it", f"km/h {LATER_S:.0f} s later", f"s over in {FOLLOWED_S:.0f} s"),
        ),
        tuple(lines),
        "Judged: neutral acts are neither asked for nor false. Driver: obeyed; heard, with nothing to do or unable "
        "to; ignored; unanswered, if the drive ended before or another act took its place; none asked, of what the "
        f"car does by itself. The last column counts the seconds above the limit in the {FOLLOWED_S:.0f} s after "
        "the act: an act in time whose driver goes on speeding shows here.",
        heads=8,
    )


def _kinds(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    """Events met of each kind, and look-alikes left alone."""
    lines = []
    for name, kind in KINDS.items():
        cells = []
        for mine in groups.values():
            events = [event for row in mine for event in row.events if event.kind == name]
            real = [event for event in events if event.outcome.counts]
            lookalikes = [event for event in events if event.lookalike]
            met, left = sum(e.outcome.is_credited for e in real), sum(e.outcome == "avoided" for e in lookalikes)
            cells.append(f"{met}/{len(real)}, {left}/{len(lookalikes)}" if events else "–")
        if any(cell != "–" for cell in cells):
            lines.append((name, kind.about, *cells))
    return Table(
        "kinds",
        "Kinds of events",
        ("Kind", "Situation", *(each.label for each in groups)),
        tuple(lines),
        "Events met, out of those that required an act; then look-alikes (which only resemble one) left alone. "
        "0/0: there was one, but it passed, or was settled, before anything was due, which is no point, also where "
        "an act told of it. –: none on this watcher's drives, which go another way after its first act.",
        heads=2,
    )


def _families(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    families = dict.fromkeys(row.family for mine in groups.values() for row in mine)
    lines = []
    for family in families:
        of = [[row for row in mine if row.family == family] for mine in groups.values()]
        lines.append((family, *(told(rows, value_of, ".0f", bounded=False) if rows else "–" for rows in of)))
    return Table("families", "Score by family", ("Family", *(each.label for each in groups)), tuple(lines))


def _measures(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    """How close the cars came to those in front and behind."""
    lines = []
    for each, rows in groups.items():
        found = [row.measures for row in rows if row.measures is not None]
        hours = sum(cell.hours for row in rows for cell in row.exposure)
        if not found or not hours:
            continue
        least = [min((v for m in found if (v := getattr(m, name)) is not None), default=None) for name in LEAST]
        most = [max((v for m in found if (v := getattr(m, name)) is not None), default=None) for name in MOST]
        sums = [sum(getattr(m, name) for m in found) / hours for name in PER_HOUR]
        values = (*least, *most, *sums)
        lines.append((each.label, *("–" if value is None else f"{value:.1f}" for value in values)))
    heads = (
        "Min TTC s",
        "Min gap time s",
        "Min TTC behind s",
        "Max DRAC m/s2",
        "Max MDRAC m/s2",
        "TET s/h",
        "TIT s2/h",
    )
    note = (
        f"TET and TIT: below {DEFAULT_THRESHOLDS.ttc_s:g} s to the vehicle in front. They measure the driver and "
        "the traffic, which go another way after the first act: on few drives, a difference says nothing about a "
        "watcher."
    )
    return Table("measures", "Surrogate measures of safety", ("Watcher", *heads), tuple(lines), note)


LEAST = "min_ttc_s", "min_gap_time_s", "min_ttc_behind_s"
MOST = "max_drac_mps2", "max_mdrac_mps2"
PER_HOUR = "tet_s", "tit_s2"
"""Fields of ``FollowingFigures`` by how several drives are summed up."""


def _exposed(groups: dict[Contestant, list[DriveTrialRow]]) -> Table:
    """Hours and kilometres by condition."""
    lines = tuple(
        (
            *(each.label, cell.road_class or "unknown", cell.weather, cell.light, cell.speed_band),
            *(f"{cell.hours:.2f}", f"{cell.kilometres:.1f}"),
        )
        for each, rows in groups.items()
        for cell in summed(cell for row in rows for cell in row.exposure)
        if cell.hours >= LEAST_HOURS
    )
    heads = "Watcher", "Road", "Weather", "Light", "Speed km/h", "Hours", "Kilometres"
    return Table("exposure", "Exposure", heads, lines, "What was driven for less than 20 s is left out.", heads=5)


LEAST_HOURS = 0.005


def _unwatched(rows: Sequence[DriveTrialRow]) -> Table:
    """Drives that were not watched to their end, and from when."""
    lines = tuple(
        (row.id, clock(row.unwatched_from_s), _why_unwatched(row))
        for row in rows
        if row.unwatched_from_s is not None
    )
    heads = "Drive", "Nobody watched from, min:s", "Why"
    return Table("unwatched", "Drives that nobody watched to their end", heads, lines)


def _why_unwatched(row: DriveTrialRow) -> str:
    return row.agent_error or str(row.end).replace("_", " ")


def _errors(rows: Sequence[DriveTrialRow]) -> Table:
    return Table(
        "drive_errors",
        "Drives that ended in an error",
        ("Drive", "Error"),
        tuple((row.id, f"{row.error_kind}: {row.error}") for row in rows if row.error is not None),
    )


# --- the page ------------------------------------------------------------------------------------------------


def timelines(folder: Path, rows: Iterable[DriveTrialRow]) -> dict[str, Chart]:
    """Writes a plot for each judged drive into ``plots/``; returns those of the lowest scores, for the page.

    There may be hundreds, so each is one file, as SVG.

    Raises:
        OSError: they cannot be written.
        UserError: a trace cannot be read.
        SetupError: the extra ``reports`` is not installed."""
    plots: dict[str, Chart] = {}
    for row in sorted(rows, key=lambda row: (row.value is None, row.value or 0.0)):
        found = None if row.score is None else timeline_of(folder, row.id)
        if found is None:
            continue
        plot = timeline_chart(row, found, f"{row.name}, seed {row.seed}: {contestant(row).label}")
        write_whole(make_folder(folder, "plots") / f"{row.id}.svg", plot.svg)
        if len(plots) < SHOWN:
            plots[row.id] = plot
    return plots


def timeline_of(folder: Path, name: str) -> Json | None:
    """The timeline of a drive, from the end of its trace; None without a trace."""
    if not trace_file(folder, name).is_file():
        return None
    result = read_trace(folder, name)[-1].get("result")
    return result and result["timeline"]
