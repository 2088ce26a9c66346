"""How far the demand of a study is from an equilibrium: measured once and kept in ``demand.json``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from automotive_cosim.errors import CosimError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.report.tables import Table
from automotive_cosim.run.job_row import from_json
from automotive_cosim.studies.equilibrium.gap import TAIL_S, Gap, measure
from automotive_cosim.studies.reroute.plan import StudyPlan

FILE = "demand.json"
LEAST_S, MOST_S = 900.0, 3_600.0
"""Departures of the others are observed while the ego's continue, for at least and at most this long."""


@dataclass(frozen=True, slots=True)
class DemandGap:
    """The gap of the traffic with one share of rerouting cars."""

    share: float
    seed: int
    gap: Gap | None
    why_not: str = ""
    """Why it could not be measured."""


def measure_demand(plan: StudyPlan, folder: Path) -> tuple[DemandGap, ...]:
    """Drives the traffic of every share once without the ego; earlier measurements are read instead."""
    known = read_demand(folder)
    if known:
        return known
    observe_s = min(MOST_S, max(LEAST_S, max(plan.departures_s)))
    found = []
    for share in sorted({job.share for job in plan.jobs()}):
        try:
            gap = measure(plan.scene(share), observe_s=observe_s, seed=plan.seeds[0])
            found.append(DemandGap(share, plan.seeds[0], gap))
        except CosimError as error:  # such as SUMO's programs, which a study does not need otherwise
            found.append(DemandGap(share, plan.seeds[0], None, str(error)))
    if all(each.gap is not None for each in found):
        write_whole(folder / FILE, json.dumps([asdict(each) for each in found], indent=1))
    return tuple(found)


def read_demand(folder: Path) -> tuple[DemandGap, ...]:
    """Earlier measurements; empty without any."""
    path = folder / FILE
    if not path.is_file():
        return ()
    try:
        return tuple(from_json(DemandGap, each) for each in read_json(path))
    except (ValueError, TypeError):
        return ()  # incomplete or of another version: it is measured again


def demand_table(found: Sequence[DemandGap]) -> Table:
    """The gaps as a table."""
    rows = tuple(
        (
            f"{each.share:.0%}",
            f"{each.gap.relative:.1%}",
            str(each.gap.trips),
            f"{each.gap.better:.0%}",
            str(each.gap.unfinished),
            str(each.gap.teleports),
        )
        for each in found
        if each.gap is not None
    )
    columns = ("Share rerouting", "Relative gap", "Trips", "Had a quicker route", "Not arrived", "Teleports")
    note = (
        "How much longer the drives of the others took than on the routes that were quickest at their time, "
        "measured by driving the demand once without the ego, at steps of 1 s. 0 is a user equilibrium. Trips that "
        f"had not arrived {TAIL_S:g} s after the last departure are left out, which flatters a jam."
    )
    return Table("demand", "How far the demand is from an equilibrium", columns, rows, note)
