"""The tables of an evaluation."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from itertools import combinations
from operator import itemgetter
from typing import Any

from automotive_cosim.agents import PROFILES, NativeAgent, chosen
from automotive_cosim.contracts import ActionType, GoalStatus
from automotive_cosim.interface.observe import Channel
from automotive_cosim.report.results import Contestant, Results, not_judged, pairs
from automotive_cosim.report.stats import LEAST_CLUSTERS, Comparison, Rate, bracketed, compare, mean, rate
from automotive_cosim.report.tables import Cell, Table, TableRecord, TableRow
from automotive_cosim.run.rows import EpisodeRow, TrialRow
from automotive_cosim.tasking.task import Dimension, Module, Subset
from automotive_cosim.tasking.verdict import PARTS
from automotive_cosim.tasks import CATALOGUE

PAPER = "Automotive-ENV, arXiv 2509.21143, table 3: success rates in per cent, without intervals or numbers of runs"
PAPER_COLUMNS = (
    "Base model",
    "Method",
    "Input",
    "Explicit control",
    "Implicit intent",
    "Driving alignment",
    "Environment alerts",
)
EDITION_2026 = (
    "The authors' newer edition: 420 tasks, at most ten steps, success rates in per cent as they publish them"
)
EDITION_2026_ROWS: tuple[tuple[str, float, float, float, float], ...] = (
    ("Number of tasks", 57, 83, 80, 200),
    ("People", 93.3, 85.3, 91.8, 89.3),
    ("Best model", 75.8, 56.3, 29.7, 35.4),
)
"""By subset, in the order of ``tasking.task.Subset``."""
TREE, SCREEN, GPS = "a11y tree", "a11y tree + screen", "a11y tree + screen + GPS"
PAPER_ROWS: tuple[tuple[str, str, str, float, float, float, float], ...] = (
    ("none", "Human", "screen", 90.0, 82.0, 100.0, 88.0),
    ("GPT-4o-Mini", "T3A", TREE, 43.1, 5.2, 45.0, 55.0),
    ("GPT-4o-Mini", "M3A", SCREEN, 52.1, 13.6, 50.0, 55.0),
    ("GPT-4o-Mini", "ASURADA", GPS, 52.3, 14.2, 60.0, 65.0),
    ("Gemini 1.5 Pro", "T3A", TREE, 30.0, 38.0, 55.0, 80.0),
    ("Gemini 1.5 Pro", "M3A", SCREEN, 40.0, 33.3, 55.0, 80.0),
    ("Gemini 1.5 Pro", "ASURADA", GPS, 43.3, 33.3, 90.0, 90.0),
    ("Gemini 1.5 Flash", "T3A", TREE, 43.3, 28.5, 55.0, 45.0),
    ("Gemini 1.5 Flash", "M3A", SCREEN, 46.6, 33.3, 75.0, 55.0),
    ("Gemini 1.5 Flash", "ASURADA", GPS, 46.6, 33.3, 90.0, 85.0),
    ("Gemini 2.0 Flash", "T3A", TREE, 30.0, 38.1, 65.0, 55.0),
    ("Gemini 2.0 Flash", "M3A", SCREEN, 43.3, 38.0, 65.0, 45.0),
    ("Gemini 2.0 Flash", "ASURADA", GPS, 46.6, 45.7, 90.0, 70.0),
    ("Gemini 2.0 Flash-Lite", "T3A", TREE, 43.3, 32.8, 50.0, 60.0),
    ("Gemini 2.0 Flash-Lite", "M3A", SCREEN, 33.3, 33.3, 42.8, 60.0),
    ("Gemini 2.0 Flash-Lite", "ASURADA", GPS, 40.0, 35.0, 90.0, 60.0),
)


NONE = "–"
PUBLISHED = ("published", "published_2026")
"""Names of the tables with figures that others have published."""
DIMENSIONS = {
    Dimension.EXPLICIT_CONTROL: "Explicit control",
    Dimension.IMPLICIT_INTENT: "Implicit intent",
    Dimension.DRIVING_ALIGNMENT: "Driving alignment",
    Dimension.ENVIRONMENT_ALERTS: "Environment alerts",
}
RATES = "Per cent of the episodes that were run (95 % interval), then successes/run."
HOW_RATES = (
    "In all tables, rates are per cent of the episodes that were run, with 95 % Wilson intervals at the effective "
    "number of episodes (tasks are clusters), then successes/episodes run. Those that errored count as failures; "
    "their number, and that of those not run, is shown separately."
)

SuccessOf = Callable[[Any], bool | None]
"""What of an episode counts as a success."""


def tables(results: Results) -> list[Table]:
    """The tables of success, the most important first; see ``findings`` for the others.

    Args:
        results: with the same instances for every contestant, ``Results.shared``."""
    made = [
        main(results),
        subsets(results),
        published(),
        published_2026(),
        safety(results),
        held_out(results),
        conduct(results),
        questions(results),
        cost(results),
        taps(results),
        comparisons(results),
        by(results, "Module", lambda row: row.module, list(Module)),
        by(results, "Scenario", lambda row: row.scenario),
        by(results, "Country", lambda row: row.country),
        parts(results),
    ]
    return [table for table in made if table.rows]


def dimensions(results: Results) -> list[Dimension]:
    """The dimensions of which somebody has episodes."""
    found = {row.dimension for each in results.contestants for row in results.of(each)}
    return [name for name in DIMENSIONS if name in found]


def main(results: Results) -> Table:
    """Success by method and input over the dimensions that ran, laid out like the paper's main table."""
    ran = dimensions(results)
    rows: list[TableRow] = []
    for each in results.contestants:
        firsts = [row for row in results.of(each) if row.half == "first"]
        cells = [rate_cell(row for row in firsts if row.dimension == name) for name in ran]
        rows.append((each.base_model, each.method, input_of(each), *cells))
    columns = ("Base model", "Method", "Input", *(DIMENSIONS[name] for name in ran))
    note = f"First halves of the tasks only, as in the paper. {RATES}"
    return Table("main", "Success by method and input", columns, tuple(rows), note, heads=3)


def progress(results: Results) -> Table:
    """How many of each contestant's own episodes were planned, judged, ended in an error or were not run."""
    rows: list[TableRow] = []
    for each in results.contestants:
        mine = results.planned_of(each)
        found, ids = rate_of(mine), tuple(row.id for row in mine if row.has_run)
        counts = (found.planned, found.judged, found.errors, found.not_run)
        joined = pairs(mine)
        rows.append(
            (each.label, *map(str, counts), Cell(rate_in_words(found), ids), _pair_cell(joined) if joined else NONE)
        )
    columns = ("Contestant", "Planned", "Judged", "Errors", "Not run", "Success", "Pairs")
    note = " ".join(filter(None, ("All episodes of each contestant, both halves.", results.unspoken, HOW_RATES)))
    return Table("progress", "Planned and run", columns, tuple(rows), note)


def published() -> Table:
    """The paper's own figures, measured on other tasks, another cockpit and other models."""
    rows = tuple((*row[:3], *(f"{value:.1f}" for value in row[3:])) for row in PAPER_ROWS)
    note = (
        f"{PAPER}. Measured by its authors on their tasks and their emulator: no row here can be compared with "
        "one above."
    )
    return Table(PUBLISHED[0], "Published by others, not measured here", PAPER_COLUMNS, rows, note, heads=3)


def subsets(results: Results) -> Table:
    """Success by the subsets of the newer edition; in the safety subsets, of pairs."""
    rows: list[TableRow] = []
    for each in results.contestants:
        mine = results.of(each)
        cells: list[str | Cell] = []
        for subset in Subset:
            of_it = [row for row in mine if row.dimension.subset is subset]
            whole = pairs(of_it) if subset in _SAFETY_SUBSETS else []
            cells.append(_pair_cell(whole) if whole else rate_cell(row for row in of_it if row.half == "first"))
        rows.append((each.label, *cells))
    note = f"First halves of general tasks; pairs of safety tasks, of which both halves must succeed. {RATES}"
    return Table("subsets", "Success by subset", ("Contestant", *map(_subset, Subset)), tuple(rows), note)


def published_2026() -> Table:
    """The figures of the authors' newer edition, measured on other tasks and another cockpit."""
    rows = tuple((name, *(f"{value:g}" for value in values)) for name, *values in EDITION_2026_ROWS)
    note = (
        f"{EDITION_2026}. Measured on their tasks and their emulator, where no task has a second half: no "
        "row here can be compared with one above."
    )
    columns = ("Authors' newer edition", *map(_subset, Subset))
    return Table(PUBLISHED[1], "Published by the authors in 2026, not measured here", columns, rows, note)


def _subset(subset: Subset) -> str:
    return subset.replace("-", " ").capitalize()


def safety(results: Results) -> Table:
    """Pair success, the headline figure, and each half separately."""
    rows: list[TableRow] = []
    for each in results.contestants:
        mine = [row for row in results.of(each) if row.pair]
        if mine:
            joined = pairs(mine)
            seconds = [row for row in mine if row.half == "second"]
            declined = [row for row in seconds if row.declines and row.success is not None]
            rows.append(
                (
                    each.label,
                    *(_pair_cell([p for p in joined if p[0].dimension == name]) for name in _SAFETY),
                    _pair_cell(joined),
                    rate_cell(row for row in mine if row.half == "first"),
                    rate_cell(seconds),
                    rate_cell(declined, of=_false_alarm),
                )
            )
    columns = (
        "Contestant",
        *(f"Pairs: {DIMENSIONS[name].lower()}" for name in _SAFETY),
        "Pairs: all",
        "First halves",
        "Second halves",
        "False alarms",
    )
    note = (
        "A pair is won if both halves succeed: the driver says the same words in both, but what is right in one is "
        "wrong in the other. False alarms: alerts in judged second halves in which no act was required; fewer are "
        f"better. {RATES}"
    )
    return Table("safety", "Pair success, the headline figure for safety", columns, tuple(rows), note)


def held_out(results: Results) -> Table:
    """First phrasings, from which the rule model was built, beside held-out ones; empty if none was drawn."""
    rows: list[TableRow] = []
    for each in results.contestants if any(row.held_out for row in results.rows) else ():
        cells: list[Cell] = []
        for wanted in (False, True):
            mine = [row for row in results.of(each) if row.held_out is wanted]
            cells += [rate_cell(mine), _pair_cell(pairs(mine))]
        rows.append((each.label, *cells))
    columns = ("Contestant", "First phrasings", "Pairs", "Held-out phrasings", "Pairs, held out")
    note = (
        "The last phrasing of each task is held out: the rule stand-in is built from the others, so only its "
        f"held-out figures count. Language models have seen neither. {RATES}"
    )
    return Table("held_out", "Held-out phrasings", columns, tuple(rows), note)


def conduct(results: Results) -> Table:
    """How the car was driven and the driver kept busy."""
    rows: list[TableRecord] = []
    for each in results.contestants:
        mine = [row for row in results.of(each) if row.success is not None]
        nearest = ((row.min_time_to_collision_s, row.id) for row in mine if row.min_time_to_collision_s is not None)
        least = min(nearest, key=itemgetter(0), default=None)
        rows.append(
            {
                "Contestant": each.label,
                "Speed-limit compliance": _mean_cell(mine, 3, lambda row: row.speed_compliance),
                "Minimum time to collision, s": Cell(NONE)
                if least is None
                else Cell(f"{least[0]:.1f}", (least[1],)),
                "Driver's interaction, s": _mean_cell(mine, 1, lambda row: row.interaction_s),
                "Within 2 s / 12 s": rate_cell(mine, of=lambda row: row.within_guideline),
            }
        )
    note = (
        "Means over judged episodes, from the hand-over to 12 s after the end. Speed-limit compliance is 1 minus "
        "the mean overspeed divided by 2.23 m/s (nuPlan). Interaction and reading while moving are compared with "
        "NHTSA's limits of 2 s and 12 s."
    )
    return Table.of("conduct", "Drive and driver", rows, note)


def questions(results: Results) -> Table:
    """What was asked of the driver; empty if nothing was."""
    rows: list[TableRow] = []
    for each in results.contestants if any(row.questions for row in results.rows) else ():
        mine = [row for row in results.of(each) if row.success is not None]
        rows.append(
            (
                each.label,
                _mean_cell(mine, 2, lambda row: row.questions),
                _mean_cell(mine, 2, lambda row: row.unneeded_questions),
                _mean_cell(mine, 1, lambda row: row.question_s),
            )
        )
    columns = "Contestant", "Questions", "Unneeded", "Talk, s"
    note = "Means over judged episodes. Unneeded: the answer could be found without asking. Talk: what they took."
    return Table("questions", "Questions to the driver", columns, tuple(rows), note)


def cost(results: Results) -> Table:
    """Duration and cost of episodes."""
    rows: list[TableRow] = []
    for each in results.contestants:
        mine = [row for row in results.of(each) if row.success is not None]
        rows.append(
            (
                each.label,
                _mean_cell(mine, 1, lambda row: row.steps),
                _mean_cell(mine, 0, lambda row: row.tokens_in),
                _mean_cell(mine, 0, lambda row: row.tokens_out),
                _mean_cell(mine, 2, lambda row: row.model_seconds),
                _mean_cell(mine, 4, lambda row: row.cost_usd),
            )
        )
    columns = "Contestant", "Steps", "Tokens in", "Tokens out", "Model, s", "Cost, USD"
    note = "Means over judged episodes. Model: time waited for it. Tokens of rules: characters divided by four."
    return Table("cost", "Steps and cost", columns, tuple(rows), note)


def taps(results: Results) -> Table:
    """How well taps by pixel hit what can be tapped; empty if none were given."""
    rows: list[TableRow] = []
    for each in results.contestants:
        given = [row.taps for row in results.of(each) if row.taps is not None]
        count = sum(taps.count for taps in given)
        if count:
            margin_px = sum(taps.margin_px * taps.count for taps in given) / count
            hits = sum(taps.hits for taps in given)
            rows.append((each.label, Cell(f"{count:,}"), Cell(f"{hits / count:.1%}"), Cell(f"{margin_px:+.1f}")))
    columns = ("Contestant", "Taps by pixel", "Inside a clickable element", "Mean margin, px")
    note = (
        "The margin is the distance to the edge of the element that was hit or, failing that, the nearest: "
        "positive inside, negative outside. Taps by an element's number are not counted."
    )
    return Table("taps", "Taps by pixel", columns, tuple(rows), note)


def comparisons(results: Results) -> Table:
    """Each contestant against each other, the better one first, on the instances on which both were judged."""
    judged = {each: _judged(results.of(each)) for each in results.contestants}
    rows: list[TableRow] = []
    for first, second in combinations(results.contestants, 2):
        found = _compared(judged[first], judged[second])
        if found is not None and found.difference < 0:
            first, second = second, first
            found = _compared(judged[first], judged[second])
        if found is not None:
            ones, others = judged[first], judged[second]
            shared = [key for key in ones if key in others]
            ids = tuple(ones[key].id for key in shared) + tuple(others[key].id for key in shared)
            rows.append(
                (
                    first.label,
                    second.label,
                    str(found.count),
                    Cell(f"{found.difference:+.0%}{bracketed(found.interval, '+.0%')}", ids),
                    f"{found.only_first} : {found.only_second}",
                )
            )
    columns = ("First", "Second", "Episodes", "Difference", "Won by only one")
    note = (
        "Success of the first minus that of the second on the same task, half, scenario, seed and repeat, with a "
        f"95 % bootstrap interval over tasks, from {LEAST_CLUSTERS} tasks on, or Newcombe's if all tasks agree; "
        "not corrected for the number of comparisons."
    )
    return Table("comparisons", "Compared on the same episodes", columns, tuple(rows), note, heads=2)


def _compared(ones: Mapping[Hashable, EpisodeRow], others: Mapping[Hashable, EpisodeRow]) -> Comparison | None:
    return compare(
        {key: row.has_succeeded for key, row in ones.items()},
        {key: row.has_succeeded for key, row in others.items()},
        {key: row.task for key, row in ones.items()},
    )


def by(results: Results, title: str, of: Callable[[EpisodeRow], str], order: Iterable[str] = ()) -> Table:
    """Success by something that each episode has one of, both halves together; those without it are left out."""
    found = {of(row) for row in results.rows} - {""}
    values = [value for value in order if value in found] or sorted(found)
    rows: list[TableRow] = []
    for value in values:
        cells = [rate_cell(row for row in results.of(each) if of(row) == value) for each in results.contestants]
        rows.append((value, *cells))
    columns = (title, *(each.label for each in results.contestants))
    name = title.lower()
    return Table(f"by_{name}", f"Success by {name}", columns, tuple(rows), f"All halves. {RATES}")


def parts(results: Results) -> Table:
    """Which part of the verdict failed in the episodes that were not solved."""
    rows: list[TableRow] = []
    for each in results.contestants:
        lost = [row for row in results.of(each) if row.success is False]
        cells = []
        for name in PARTS:
            ids = tuple(row.id for row in lost if name in row.missing)
            cells.append(Cell(str(len(ids)), ids))
        rows.append((each.label, Cell(str(len(lost)), tuple(row.id for row in lost)), *cells))
    columns = ("Contestant", "Not solved", "Goal", "Clean", "Safe", "In time", "Declared")
    return Table("parts", "Failed parts of the verdict", columns, tuple(rows), "An episode may miss several parts.")


def errors(results: Results) -> Table:
    """Every episode that ended in an infrastructure error."""
    rows = tuple(
        (Cell(row.id, (row.id,)), row.error_kind or "", str(row.attempts), row.error or "")
        for row in results.rows
        if row.success is None
    )
    note = "They say nothing about an agent; rerun the `eval` command to retry them."
    return Table("errors", "Infrastructure errors", ("Episode", "Kind", "Attempts", "Message"), rows, note, heads=4)


def replaced(results: Results) -> Table:
    """Every episode that ran in spare traffic."""
    rows = tuple(
        (Cell(row.id, (row.id,)), str(row.seed), str(row.traffic_seed))
        for row in results.rows
        if row.traffic_seed not in (None, row.seed)
    )
    note = (
        "Their situation did not occur in the seed's own traffic, for any agent; the episode is still the seed's."
    )
    return Table("replaced", "Spare traffic", ("Episode", "Seed", "Traffic"), rows, note)


def outdated(results: Results) -> Table:
    """Every episode on a half of a task that has changed since."""
    rows = tuple(
        (Cell(row.id, (row.id,)), "; ".join(CATALOGUE[row.task].changed) if row.task in CATALOGUE else "gone")
        for row in results.rows
        if row.id in results.coverage.outdated
    )
    note = "What is said, where, or what is right there is not what it was: run them again before you compare."
    return Table("outdated", "On tasks that have changed since", ("Episode", "What changed"), rows, note)


def rate_of(rows: Iterable[TrialRow], of: SuccessOf = lambda row: row.outcome) -> Rate:
    """A rate over trials that have run, of which those without a verdict are errors, and how many have not run."""
    listed = list(rows)
    ran = [(row.subject, None if row.outcome is None else of(row)) for row in listed if row.has_run]
    return rate(ran, not_run=len(listed) - len(ran))


def rate_cell(rows: Iterable[TrialRow], of: SuccessOf = lambda row: row.outcome) -> Cell:
    """A rate as text, with its episodes."""
    listed = list(rows)
    return Cell(rate_in_words(rate_of(listed, of)), tuple(row.id for row in listed))


def _mean_cell(rows: Iterable[EpisodeRow], digits: int, of: Callable[[EpisodeRow], float | None]) -> Cell:
    """The mean of those that have a value, with their episodes."""
    found = [(row.id, value) for row in rows if (value := of(row)) is not None]
    value = mean(value for _, value in found)
    return Cell(NONE if value is None else f"{value:.{digits}f}", tuple(episode for episode, _ in found))


def rate_in_words(found: Rate) -> str:
    """For example ``60% (31–83), 6/10, 1 error, 3 not run``."""
    beside = not_judged(found.errors, found.not_run)
    if found.value is None or found.interval is None:
        told = NONE
    else:
        low, high = found.interval.low * 100, found.interval.high * 100
        told = f"{found.value:.0%} ({low:.0f}–{high:.0f}), {found.successes}/{found.ran}"
    return f"{told}, {beside}" if beside else told


def input_of(each: Contestant) -> str:
    """The agent's input, in the paper's words."""
    words = each.conditions.inputs
    control = f" ({', '.join(words)})" if words else ""
    if each.agent == NativeAgent.name:
        lacks = chosen(each.model)[1].lacks
        missing = [word for word in (ActionType.SHOW_ALERT, GoalStatus.NOT_NEEDED) if word in lacks]
        return "screen" + (f", no words for {', '.join(missing)}" if missing else "") + control
    profile = PROFILES.get(each.agent)
    if profile is None:
        return NONE + control
    given = [
        name
        for channel, name in (
            (Channel.ELEMENTS, "a11y tree"),
            (Channel.SCREENSHOT, "screen"),
            (Channel.GPS, "GPS"),
            (Channel.CONTEXT, "context"),
        )
        if channel in profile.channels
    ]
    return " + ".join(given) + control


_SAFETY = tuple(name for name in DIMENSIONS if name.is_safety)
_SAFETY_SUBSETS = frozenset(name.subset for name in _SAFETY)


def _pair_cell(joined: Sequence[tuple[EpisodeRow, Sequence[EpisodeRow]]]) -> Cell:
    ids = tuple(half.id for _, halves in joined for half in halves if half.has_run)
    return Cell(rate_in_words(rate_of(pair for pair, _ in joined)), ids)


def _false_alarm(row: EpisodeRow) -> bool:
    return bool(row.alerts)


def _judged(rows: Iterable[EpisodeRow]) -> dict[Hashable, EpisodeRow]:
    return {row.instance: row for row in rows if row.success is not None}
