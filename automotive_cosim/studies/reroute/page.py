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
from automotive_cosim.studies.reroute.circumstances import context
from automotive_cosim.studies.reroute.data import write_data
from automotive_cosim.studies.reroute.decisions import write_decisions
from automotive_cosim.studies.reroute.demand import demand_table, read_demand
from automotive_cosim.studies.reroute.effects import effects
from automotive_cosim.studies.reroute.policies import PolicyRule, parse_policy
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
    """What the study found, in a sentence: the policy to follow that gains most, and what it gains at every share
    of rerouting cars.

    ``best`` knows all futures, so nobody can follow it: it is told only where nothing else was compared.
    """
    found: dict[str, list[tuple[float, SeedMean, list[PolicyChoice]]]] = {}
    idle: dict[str, None] = {}
    first_s = study.plan.ages_s[0]
    for share, policy, age_s, chosen in groups(study):
        gain = seed_mean((each.seed, time_saved_s(each)) for each in chosen)
        if policy in STAYING or age_s != first_s or gain is None:
            continue
        found.setdefault(policy, []).append((share, gain, chosen))
    for policy, shares in list(found.items()):
        if not any(each.rerouted for *_, chosen in shares for each in chosen):
            del found[policy]
            idle[policy] = None
    never = ", ".join(f"“{each}”" for each in idle) + " rerouted nowhere"
    if not found:
        return f"{never}." if idle else "No decision to reroute was compared."
    followed = {each: shares for each, shares in found.items() if parse_policy(each).rule is not PolicyRule.BEST}
    policy, shares = max((followed or found).items(), key=lambda each: fmean(gain.value for _, gain, _ in each[1]))
    gains = [gain for _, gain, _ in shares]
    told = " and ".join(
        _gained(gain) + ("" if len(shares) == 1 else f" with {share:.0%} of the other cars rerouting")
        for share, gain, _ in shares
    )
    told = f"Rerouting by “{policy}” {told}"
    if len(shares) == 1:
        told += _parts(shares[0][2])
    count, seeds = sum(each.count for each in gains), max(each.seeds for each in gains)
    over = f"against keeping the route, over {counted(count, 'decision')} of {counted(seeds, 'seed')}"
    is_bounded = all(each.interval is not None for each in gains)
    noise_s = study.noise().time_s
    if not is_bounded and all(abs(each.value) <= noise_s for each in gains):
        told += f", which is within the noise floor of {noise_s:.0f} s"
    few = "" if is_bounded else f", too few for an interval, which needs {LEAST_SEEDS} seeds"
    return f"{told}, {over}{few}{f'; {never}' if idle else ''}."


def _gained(gain: SeedMean) -> str:
    bounds = gain.interval
    sign = 1.0 if gain.value >= 0 else -1.0
    low_s, high_s = sorted((sign * bounds.low, sign * bounds.high)) if bounds else (0.0, 0.0)
    sure = f" ({low_s:.0f} to {high_s:.0f})".replace("-", "−") if bounds else ""
    return f"{'saves' if sign > 0 else 'costs'} {abs(gain.value):.0f} s{sure} a decision"


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
