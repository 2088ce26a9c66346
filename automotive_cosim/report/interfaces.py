"""Touch, functions and both, side by side: the same agent and model on the same instances."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence

from automotive_cosim.contracts.given import Interface
from automotive_cosim.report.results import Results
from automotive_cosim.report.stats import bracketed, clustered_mean, compare, mean
from automotive_cosim.report.summary import NONE, rate_cell
from automotive_cosim.report.tables import Cell, Table, TableRow
from automotive_cosim.run.rows import EpisodeRow

FigureOf = Callable[[EpisodeRow], float | None]
Instances = Mapping[tuple[Hashable, ...], EpisodeRow]

FIGURES: tuple[tuple[str, int, FigureOf], ...] = (
    ("Steps", 1, lambda row: row.steps),
    ("Time, s", 1, lambda row: row.sim_seconds),
    ("Driver's interaction, s", 1, lambda row: row.interaction_s),
    ("Talk, s", 1, lambda row: row.question_s),
    ("Tokens in", 0, lambda row: row.tokens_in),
    ("Tokens out", 0, lambda row: row.tokens_out),
    ("Model, s", 1, lambda row: row.model_seconds),
    ("Cost, USD", 4, lambda row: row.cost_usd),
)
"""Of an episode: title, digits, and which figure."""
COMPARED = 3
"""So many of them, the first, are compared with touch."""


def interfaces(results: Results) -> Table:
    """What each interface costs and wins; no rows for who had one alone.

    Args:
        results: with the same instances for every contestant, ``Results.shared``."""
    groups = dict.fromkeys(each.under("interface", Interface.TOUCH) for each in results.contestants)
    rows: list[TableRow] = []
    for group in groups:
        found = {
            which: {row.instance: row for row in mine}
            for which in Interface
            if (mine := [row for row in results.of(group.under("interface", which)) if row.success is not None])
        }
        touched = found.get(Interface.TOUCH, {})
        for which, instances in found.items() if len(found) > 1 else ():
            own = tuple(instances.values())
            ids = tuple(row.id for row in own)
            rows.append(
                (
                    group.label,
                    which,
                    rate_cell(own),
                    *(Cell(_mean(own, digits, of), ids) for _, digits, of in FIGURES),
                    *([NONE] * (1 + COMPARED) if which is Interface.TOUCH else _differences(instances, touched)),
                )
            )
    compared = tuple(
        f"{title} minus touch's" for title in ("Success", *(name for name, _, _ in FIGURES[:COMPARED]))
    )
    columns = ("Contestant", "Interface", "Success", *(title for title, _, _ in FIGURES), *compared)
    note = (
        "Judged episodes, both halves; means from the hand-over to the end. Time is simulated. Interaction: "
        "touches while the car moves, before the driver's eyes; talk: questions to the driver. Differences are on "
        "the same task, half, scenario, seed and repeat, with 95 % bootstrap intervals over tasks, or Newcombe's "
        "for successes if all tasks agree."
    )
    return Table("interfaces", "Touch, functions and both", columns, tuple(rows), note, heads=2)


def _mean(rows: Sequence[EpisodeRow], digits: int, of: FigureOf) -> str:
    value = mean(map(of, rows))
    return NONE if value is None else f"{value:.{digits}f}"


def _differences(mine: Instances, touched: Instances) -> list[Cell]:
    """Success and the compared figures, minus those by touch."""
    shared = [key for key in mine if key in touched]
    ids = tuple(each[key].id for key in shared for each in (mine, touched))
    won = compare(
        {key: mine[key].has_succeeded for key in shared},
        {key: touched[key].has_succeeded for key in shared},
        {key: mine[key].task for key in shared},
    )
    cells = [NONE]
    if won is not None:
        cells = [f"{won.difference:+.0%}{bracketed(won.interval, '+.0%')}"]
    for _, digits, of in FIGURES[:COMPARED]:
        found = clustered_mean(
            (mine[key].task, one - other)
            for key in shared
            if (one := of(mine[key])) is not None and (other := of(touched[key])) is not None
        )
        told = NONE if found is None else f"{found.value:+.{digits}f}{bracketed(found.interval, f'+.{digits}f')}"
        cells.append(told)
    return [Cell(text, ids) for text in cells]
