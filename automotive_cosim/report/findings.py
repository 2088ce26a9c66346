"""Tables of failure classes, harm, the effect of place, and prompt lengths."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from automotive_cosim.agents import NOT_RANKED
from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.episode.conditions import TABLE, Condition
from automotive_cosim.report.failures import FailureClass, failure_class
from automotive_cosim.report.results import Contestant, Results, pair_instance, pairs
from automotive_cosim.report.stats import bracketed, clustered_mean, compare
from automotive_cosim.report.summary import DIMENSIONS, NONE, RATES, rate_cell
from automotive_cosim.report.tables import Cell, Table, TableRow
from automotive_cosim.run.attribution import path_of, read_effects
from automotive_cosim.run.difficulty import WonBy, level, measured
from automotive_cosim.run.figures import DriveFigures
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import read_trace, trace_file
from automotive_cosim.tasking.task import Module

PLACE = "place"
"""Tag of the pairs in which only the receiver, the context or its queries tell what is right (gate ``place``)."""
NAMES = {Module.HVAC: "HVAC"}
FIGURES: tuple[tuple[str, int, Callable[[DriveFigures], float | None]], ...] = (
    ("Above the limit, m", 1, lambda drive: drive.overspeed_m),
    ("Minimum time to collision, s", 2, lambda drive: drive.min_time_to_collision_s),
    ("Delay, s", 1, lambda drive: drive.arrival_s),
    ("Energy, Wh", 1, lambda drive: drive.energy_wh),
)
"""Of a drive: title, digits, and which figure."""


def classes(results: Results) -> dict[str, FailureClass]:
    """The failure class of every episode that was judged and not solved, by its id."""
    return {
        row.id: failure_class(row, read_trace(results.folder, row.id))
        for row in results.rows
        if row.success is False and trace_file(results.folder, row.id).is_file()
    }


def failures(results: Results, found: Mapping[str, FailureClass]) -> Table:
    """The number of failures of each class, by contestant."""
    rows: list[TableRow] = []
    for each in results.contestants:
        lost = [row.id for row in results.of(each) if row.id in found]
        cells = [
            Cell(f"{len(ids)} ({len(ids) / len(lost):.0%})" if ids else "0", ids)
            for name in FailureClass
            for ids in [tuple(episode for episode in lost if found[episode] is name)]
        ]
        if lost:
            rows.append((each.label, Cell(str(len(lost)), tuple(lost)), *cells))
    columns = ("Contestant", "Not solved", *(name.words for name in FailureClass))
    note = "Read from the trace by fixed rules, which are tested on injected faults."
    return Table("failure_classes", "Why episodes were not solved", columns, tuple(rows), note)


def meanings(found: Mapping[str, FailureClass]) -> Table:
    """What the classes are that occur."""
    rows = tuple((name.words, name.about) for name in FailureClass if name in found.values())
    note = "An episode is of the first class that fits it; the order is that of the columns above."
    return Table(
        "failure_meanings", "What the classes of failures are", ("Class", "What happened"), rows, note, heads=2
    )


def act_effects(folder: Path, trials: Mapping[str, str]) -> Table:
    """What each act of the trials changed of which that was measured.

    Args:
        trials: their ids, with their names."""
    lines = tuple(
        (name, " and ".join(map(str, each.steps)), clock(each.at_s), each.act, each.effect, str(each.draws))
        for trial, name in trials.items()
        for each in read_effects(path_of(folder, trial))
    )
    columns = ("Id", "Step", "When", "Act", "Effect", "Draws")
    note = (
        "Measured by `automotive-cosim attribute`: each act was left out of a fork of the same traffic, the later "
        "ones given as recorded; two together where neither changed anything alone. Differences are with the act "
        "minus without it; what other random numbers change as much is no effect."
    )
    return Table("act_effects", "Which act did it", columns, lines, note, heads=5)


def harm(results: Results) -> Table:
    """Differences between the agent's drive and its baseline run."""
    rows: list[TableRow] = []
    for each in results.contestants:
        for half in ("first", "second"):
            mine = [row for row in results.of(each) if row.drive and row.half == half]
            if mine:
                rows.append((each.label, half, *(_difference(mine, digits, of) for _, digits, of in FIGURES)))
    columns = ("Contestant", "Half", *(title for title, _, _ in FIGURES))
    note = (
        "Mean difference between the agent's drive and its baseline run, in which nobody touches the cockpit, "
        "from the hand-over to 12 s after the end, with 95 % bootstrap intervals over tasks and the "
        "number of episodes. Below 0: fewer metres above the limit, less delay, less energy; for the time to "
        "collision, higher is better. The car is electric: energy from its battery stands in for emissions."
    )
    return Table("harm", "Harm caused or averted", columns, tuple(rows), note, heads=2)


def _difference(rows: Iterable[EpisodeRow], digits: int, of: Callable[[DriveFigures], float | None]) -> Cell:
    both = [
        (row.id, row.task, mine - baseline)
        for row in rows
        if row.drive and row.baseline_drive
        if (mine := of(row.drive)) is not None and (baseline := of(row.baseline_drive)) is not None
    ]
    found = clustered_mean((task, value) for _, task, value in both)
    if found is None:
        return Cell(NONE)
    told = bracketed(found.interval, f"+.{digits}f")
    return Cell(f"{found.value:+.{digits}f}{told}, n={found.count}", tuple(episode for episode, _, _ in both))


def place_effect(results: Results) -> Table:
    """The effect of place: success on pairs that depend on it, with and without it; the others are the placebo."""
    rows: list[TableRow] = []
    ranked = [each for each in results.contestants if each.agent not in NOT_RANKED]
    for full in ranked:
        for other in ranked:
            geo = other.conditions.geo
            if full.conditions.geo == "full" != geo and full.under("geo", geo) == other:
                told = [_effect(results, full, other, decided) for decided in (True, False)]
                if any(cell.episodes for cell in told):
                    rows.append((f"{full.method}, {full.base_model}", geo, *told))
    columns = ("Contestant", "Compared with geo", "Pairs that depend on place", "Placebo: the other pairs")
    note = (
        f"Pair success with full geo-context minus that under the other geo control, on the same pairs, with 95 % "
        f"intervals over tasks. Pairs tagged “{PLACE}” depend on place; in the others "
        "the screens decide, so place should make no difference."
    )
    return Table("place_effect", "Effect of place", columns, tuple(rows), note, heads=2)


def by_condition(results: Results) -> list[Table]:
    """Success by the values of each condition: a column for each value, and a row for each contestant.

    A condition that is the same for all has no rows."""
    return [_side_by_side(results, each) for each in TABLE]


def _side_by_side(results: Results, condition: Condition) -> Table:
    shown = sorted(
        {condition.of(each.conditions) for each in results.contestants},
        key=lambda value: (*condition.choices, value).index(value) if condition.choices else value,
    )
    groups = list(dict.fromkeys(each.under(condition.name, condition.default) for each in results.contestants))
    rows: list[TableRow] = [
        (each.label, *(rate_cell(results.of(each.under(condition.name, value))) for value in shown))
        for each in groups
        if len(shown) > 1
    ]
    note = condition.words.note
    if condition.name == "see" and (beyond := results.beyond_the_list):
        note += f" Left out: {counted(len(beyond), 'task')} in which something needed is only in a picture."
    columns = ("Contestant", *map(condition.told, shown))
    name = f"by_{condition.word}"
    return Table(name, condition.words.title, columns, tuple(rows), f"{note} All halves. {RATES}")


def _effect(results: Results, full: Contestant, other: Contestant, decided: bool) -> Cell:
    def judged(each: Contestant) -> dict[tuple[object, ...], tuple[EpisodeRow, Sequence[EpisodeRow]]]:
        return {
            pair_instance(pair): (pair, halves)
            for pair, halves in pairs(results.of(each))
            if pair.success is not None and (PLACE in pair.tags) is decided
        }

    ones, others = judged(full), judged(other)
    found = compare(
        {key: pair.has_succeeded for key, (pair, _) in ones.items()},
        {key: pair.has_succeeded for key, (pair, _) in others.items()},
        {key: pair.task for key, (pair, _) in ones.items()},
    )
    if found is None:
        return Cell(NONE)
    shared = [key for key in ones if key in others]
    ids = tuple(half.id for side in (ones, others) for key in shared for half in side[key][1])
    return Cell(f"{found.difference:+.0%}{bracketed(found.interval, '+.0%')}, n={found.count}", ids)


def by_label(
    results: Results,
    name: str,
    plural: str,
    of: Callable[[EpisodeRow], Sequence[str]],
    order: Sequence[str] = (),
    note: str = "A task may count in several rows.",
) -> Table:
    """Success by a label of which an episode may have several; those in ``order`` come in it, others by name."""
    found = {value for row in results.rows for value in of(row)}
    values = [value for value in order if value in found] + sorted(found.difference(order))
    rows: list[TableRow] = [
        (value, *(rate_cell(row for row in results.of(each) if value in of(row)) for each in results.contestants))
        for value in values
    ]
    columns = (name.capitalize(), *(each.label for each in results.contestants))
    return Table(f"by_{plural}", f"Success by {name}", columns, tuple(rows), f"{note} All halves. {RATES}")


def by_difficulty(results: Results) -> Table:
    """Success by measured difficulty."""
    note = (
        "Halves by who has won them before: the rule stand-in, a large language model that answers by hand, or few."
    )
    return by_label(results, "difficulty", "difficulty", _level, tuple(WonBy), note)


def _level(row: EpisodeRow) -> Sequence[str]:
    return (level(measured(row.task, row.half)),)


def prompts(results: Results) -> Table:
    """Lengths of prompts under each geo control."""
    rows: list[TableRow] = []
    for each in results.contestants:
        asked = [row for row in results.of(each) if row.prompt_tokens]
        if asked:
            lengths = [length for row in asked for length in row.prompt_tokens]
            shown = [f"{value:.0f}" for value in np.percentile(lengths, (5, 25, 50, 75, 95))]
            ids = tuple(row.id for row in asked)
            rows.append((each.label, each.conditions.geo, str(len(lengths)), *(Cell(text, ids) for text in shown)))
    columns = ("Contestant", "Geo", "Prompts", "5 %", "25 %", "Median", "75 %", "95 %")
    note = (
        "Tokens per prompt, as percentiles over all calls. For rules, tokens are estimated at four characters each."
    )
    return Table("prompts", "Length of prompts", columns, tuple(rows), note, heads=3)


def distribution(results: Results) -> Table:
    """The number of tasks by module and dimension."""
    tasks = {row.task: row for row in results.rows}.values()
    rows: list[TableRow] = []
    for module in Module:
        mine = [row for row in tasks if row.module == module]
        if mine:
            counts = [sum(row.dimension == name for row in mine) for name in DIMENSIONS]
            rows.append((NAMES.get(module, module.capitalize()), *map(str, counts), str(len(mine))))
    totals = [sum(row.dimension == name for row in tasks) for name in DIMENSIONS]
    rows.append(("All", *map(str, totals), str(len(tasks))))
    columns = ("Module", *DIMENSIONS.values(), "All")
    return Table(
        "distribution", "Tasks by module and dimension", columns, tuple(rows), "A pair counts as one task."
    )
