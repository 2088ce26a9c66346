"""The same study on several networks, in one table."""

import re
from collections.abc import Sequence
from pathlib import Path
from statistics import fmean

from automotive_cosim.contracts.plain import counted
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.report.tables import Table, TableRecord
from automotive_cosim.studies.reroute.demand import read_demand
from automotive_cosim.studies.reroute.effects import rerouted
from automotive_cosim.studies.reroute.page import cost_s
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.rows import PolicyChoice
from automotive_cosim.studies.reroute.tables import NONE, mean_cell, others_save_s, time_saved_s
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import read_configuration


def folder_name(number: int, scenario: str) -> str:
    """Name of a network's folder: its place in the list and its own name."""
    name = Path(scenario).name.partition(".")[0] or "network"
    return f"{number:02d}_{re.sub(r'[^A-Za-z0-9_-]+', '_', name)}"


def networks(studies: Sequence[Study]) -> Table:
    """One row per network, warm-up and share of rerouting cars, with the newest news of its plan."""
    rows: list[TableRecord] = []
    for study in studies:
        edges = len(read_network(read_configuration(study.plan.opened.config).net).edges)
        spent_s = cost_s(study)
        for share in sorted({row.share for row in study.rows}):
            here = [e for e in study.choices if e.share == share and e.age_s == study.plan.ages_s[0]]
            always = [each for each in here if each.policy == "always"]
            summaries = [p.decision.traffic for p in study.decisions if p.drive.share == share]
            running = [summary.running for summary in summaries if summary is not None]
            gaps = [each.gap for each in read_demand(study.folder) if each.share == share]
            rows.append(
                {
                    "Network": study.plan.opened.name,
                    "Warm-up, s": f"{study.plan.scene(share).sumo.warm_up_s:g}",
                    "Share rerouting": f"{share:.0%}",
                    "Edges": f"{edges:,}",
                    "Vehicles on the road": f"{fmean(running):.0f}" if running else NONE,
                    "Decisions": str(len({each.id for each in here})),
                    "Always saves, s": mean_cell(always, time_saved_s),
                    "Best saves, s": mean_cell((each for each in here if each.policy == "best"), time_saved_s),
                    "Others save, s": mean_cell(always, others_save_s, 0),
                    "Later": _later(study, always),
                    "Noise floor, s": f"{study.noise().time_s:.1f}",
                    "Demand gap": f"{gaps[0].relative:.1%}" if gaps and gaps[0] is not None else NONE,
                    "s per decision": NONE if spent_s is None else f"{spent_s:.1f}",
                }
            )
    note = (
        "Always and best: seconds saved per decision that counts, with 95 % intervals if there are enough "
        "seeds. Others save and later (share of the vehicles that arrive at least 1 s later): when the ego always "
        "reroutes. Seconds per decision: wall time of one worker."
    )
    return Table.of("networks", "The same study on several networks", rows, note, heads=3)


def sentence(studies: Sequence[Study]) -> str:
    """What rerouting always gains on each network, in a sentence."""
    told = []
    for study in studies:
        gains_s = [
            time_saved_s(each)
            for each in study.choices
            if each.policy == "always" and each.age_s == study.plan.ages_s[0]
        ]
        gain = f"{fmean(gains_s):+.0f} s".replace("-", "−") if gains_s else "nothing known"
        told.append(f"{study.plan.opened.name} {gain} ({counted(len(gains_s), 'decision')})")
    return f"Saved by “always”, a decision, against keeping the route: {', '.join(told)}."


def write_networks(table: Table, folder: Path, told: str) -> Path:
    """Writes the table as Markdown, below a sentence, CSV and LaTeX; returns the first.

    Raises OSError: it cannot be written."""
    for suffix, text in (("csv", table.csv()), ("tex", table.latex()), ("md", f"{told}\n\n{table.markdown()}")):
        write_whole(folder / f"{table.name}.{suffix}", text)
    return folder / f"{table.name}.md"


def _later(study: Study, always: Sequence[PolicyChoice]) -> str:
    """Share of the vehicles that arrive later where `always` reroutes."""
    wanted = {each.id for each in always}
    spreads = [
        spread
        for (_, policy, _), found in rerouted(study)
        if policy == "always"
        for choice, spread in found
        if choice.id in wanted
    ]
    count = sum(each.count for each in spreads)
    return f"{sum(each.later for each in spreads) / count:.0%}" if count else NONE
