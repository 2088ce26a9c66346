"""The table of the house rules: how often they were kept, whether or not the agent was told them."""

from collections import Counter
from collections.abc import Mapping, Sequence

from automotive_cosim.report.results import Contestant
from automotive_cosim.report.summary import rate_cell
from automotive_cosim.report.tables import Cell, Table, TableRow
from automotive_cosim.run.rows import TrialRow

NAMED = 3
"""Number of rules named for each contestant."""


def house_rules(groups: Mapping[Contestant, Sequence[TrialRow]], name: str = "policy") -> Table:
    """How often each contestant kept the house rules; without those whose rows say nothing about them.

    Args:
        groups: the trials of each contestant, tasks or drives.
        name: base name of the table's files."""
    rows: list[TableRow] = []
    for each, every in groups.items():
        mine = [row for row in every if row.breaches is not None]
        if not mine:
            continue
        broken = Counter(breach.rule for row in mine for breach in row.breaches or ())
        worst = ", ".join(f"{rule} ({count})" for rule, count in broken.most_common(NAMED)) or "none"
        ids = tuple(row.id for row in mine if row.breaches)
        rows.append(
            (
                each.label,
                rate_cell(mine, of=lambda row: not row.breaches),
                rate_cell(mine, of=lambda row: row.has_succeeded and not row.breaches),
                Cell(str(sum(broken.values())), ids),
                Cell(worst, ids),
            )
        )
    columns = ("Contestant", "Rules kept", "Kept and solved", "Breaches", "Broken most often")
    note = (
        "House rules are checked by code, whether or not the agent was told them (`--policy house`), and have no "
        "part in success. Judged runs alone."
    )
    return Table(name, "House rules", columns, tuple(rows), note)
