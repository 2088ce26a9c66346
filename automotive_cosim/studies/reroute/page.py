"""``report.html``: a study on one self-contained page, and its decisions, tables, plots and data as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from statistics import fmean

from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.files import write_files
from automotive_cosim.report.templates import render
from automotive_cosim.run.store import cannot_write
from automotive_cosim.studies.intervals import LEAST_SEEDS, SeedMean, seed_mean
from automotive_cosim.studies.reroute.charts import charts
from automotive_cosim.studies.reroute.context import context
from automotive_cosim.studies.reroute.data import write_data
from automotive_cosim.studies.reroute.decisions import write_decisions
from automotive_cosim.studies.reroute.demand import demand_table, read_demand
from automotive_cosim.studies.reroute.effects import effects
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.rows import PolicyChoice
from automotive_cosim.studies.reroute.tables import STAYING, groups, tables, time_saved_s
from automotive_cosim.studies.reroute.warnings import warnings


def write_study(folder: Path) -> Path:
    """Writes all of a study's pages, data, ``tables/`` and ``plots/`` into its folder; returns ``report.html``.

    Raises:
        UserError: the folder is not a study's, has no decision that counts, or cannot be written.
        SetupError: the extra ``reports`` is not installed.
    """
    study = Study.read(folder)
    if not study.rows:
        raise UserError(f"{folder} has no drives yet; rerun its `study` command to resume")
    made = [
        *tables(study),
        *(table for table in (*effects(study), *context(study), demand_table(read_demand(folder))) if table.rows),
    ]
    plots = charts(study) if study.choices else {}
    try:
        with drafted(page := folder / "report.html") as file:
            write_files(folder, made, plots.values())
            write_data(study)
            write_decisions(study)
            text = render(
                "studies/reroute/study.html",
                study=study,
                answer=answer(study),
                count=len(study.decisions),
                tables=made,
                plots=plots,
                warnings=warnings(study),
                plan=study.plan.as_json(),
                seeds=len({row.seed for row in study.rows}),
                demand=study.plan.demand(),
                cost_s=cost_s(study),
                starts=study.manifest["starts"],
            )
            file.write(text.encode())
    except OSError as error:
        raise cannot_write(folder, error) from error
    return page


def answer(study: Study) -> str:
    """What the study found, in a sentence: which policy that rerouted saves the ego how much for each decision."""
    best: tuple[str, SeedMean, list[PolicyChoice]] | None = None
    idle: list[str] = []
    for _, policy, _, chosen in groups(study):
        found = seed_mean((each.seed, time_saved_s(each)) for each in chosen)
        if policy in STAYING or found is None:
            continue
        if not any(each.rerouted for each in chosen):
            idle.append(policy)
        elif best is None or found.value > best[1].value:
            best = policy, found, chosen
    never = ", ".join(f"“{each}”" for each in dict.fromkeys(idle)) + " rerouted nowhere"
    if best is None:
        return f"{never}." if idle else "No decision to reroute was compared."
    policy, found, chosen = best
    bounds = found.interval
    sure = "" if bounds is None else f" ({bounds.low:.0f} to {bounds.high:.0f})".replace("-", "−")
    verb = "saves" if found.value >= 0 else "costs"
    told = f"Rerouting by “{policy}” {verb} {abs(found.value):.0f} s{sure} a decision{_parts(chosen)}"
    over = f"{counted(found.count, 'decision')} of {counted(found.seeds, 'seed')}"
    rest = f"; {never}" if idle else ""
    noise_s = study.noise().time_s
    if bounds is None and abs(found.value) <= noise_s:
        told += f", which is within the noise floor of {noise_s:.0f} s"
    few = "" if bounds else f", too few for an interval, which needs {LEAST_SEEDS} seeds"
    return f"{told}, over {over}{few}{rest}."


def _parts(chosen: Sequence[PolicyChoice]) -> str:
    """What the mean gain consists of, in words that add up; empty if it is nothing or was not measured."""
    parts = [(each.gain.lost_s, each.gain.way_s) for each in chosen]
    known = [(lost_s, way_s) for lost_s, way_s in parts if lost_s is not None and way_s is not None]
    if len(known) < len(parts) or not any(map(any, known)):
        return ""
    avoided_s = round(fmean(lost_s for lost_s, _ in known))
    way_s = round(fmean(map(sum, known))) - avoided_s
    return (
        f", as {abs(avoided_s)} s {'less' if avoided_s >= 0 else 'more'} is lost in congestion and the route "
        f"itself takes {abs(way_s)} s {'less' if way_s >= 0 else 'more'}"
    )


def cost_s(study: Study) -> float | None:
    """Wall seconds of one worker per decision, including the drive up to it and all its futures."""
    decisions = sum(len(row.decisions) for row in study.rows)
    return sum(row.wall_seconds for row in study.rows) / decisions if decisions else None
