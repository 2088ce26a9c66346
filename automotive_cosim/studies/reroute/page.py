"""``report.html``: a study on one self-contained page, and its decisions, tables, plots and data as files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import fmean

from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.files import write_files
from automotive_cosim.report.tables import Table, TableRecord, TableRow
from automotive_cosim.report.templates import render
from automotive_cosim.run.store import cannot_write
from automotive_cosim.studies.intervals import LEAST_SEEDS, SeedMean, seed_mean
from automotive_cosim.studies.reroute.charts import charts
from automotive_cosim.studies.reroute.data import write_data
from automotive_cosim.studies.reroute.decisions import write_decisions
from automotive_cosim.studies.reroute.demand import demand_table, read_demand
from automotive_cosim.studies.reroute.effects import effects
from automotive_cosim.studies.reroute.points import NOT_ARRIVED
from automotive_cosim.studies.reroute.policies import PolicyRule, parse_policy
from automotive_cosim.studies.reroute.results import Study, all_decisions, choices_at
from automotive_cosim.studies.reroute.rows import PolicyChoice
from automotive_cosim.studies.reroute.tables import (
    NONE,
    STAYING,
    goes_by_news,
    groups,
    mean_cell,
    tables,
    time_saved_s,
    told_mean,
)
from automotive_cosim.studies.reroute.warnings import warnings


def circumstances(study: Study) -> list[Table]:
    """The traffic, its warm-up, and the possible effect of the exclusions, as tables."""
    return [bounds(study), by_departure(study), traffic(study)]


def bounds(study: Study) -> Table:
    """The mean gain with the excluded decisions included."""
    left_out = [point for point in all_decisions(study.rows) if point.decision.excluded]
    rows: list[TableRecord] = []
    for share, policy, age_s, told in groups(study) if left_out else ():
        if policy in STAYING:
            continue
        here = [point for point in left_out if point.drive.share == share]
        put_in = [
            (point.decision.excluded, choice)
            for point in here
            for choice in choices_at(point, (policy,), study.plan.compliance[0])
            if choice.age_s == age_s
        ]
        known = _gains(told) + _gains(choice for reason, choice in put_in if reason != NOT_ARRIVED)
        unknown = [choice.seed for reason, choice in put_in if reason == NOT_ARRIVED]
        worst_s, best_s = (end(gain_s for _, gain_s in known) for end in (min, max))
        rows.append(
            {
                "Share rerouting": f"{share:.0%}",
                "Policy": policy,
                "News age, s": f"{age_s:g}" if goes_by_news(policy) else NONE,
                "Counted": str(len(told)),
                "Time saved, s": told_mean(seed_mean(_gains(told)), "+.1f"),
                "Excluded, measured": str(len(put_in) - len(unknown)),
                "With these, s": told_mean(seed_mean(known), "+.1f"),
                "Not measured": str(len(unknown)),
                **{
                    at: told_mean(seed_mean([*known, *((seed, end_s) for seed in unknown)]), "+.1f")
                    for at, end_s in (("At worst, s", worst_s), ("At best, s", best_s))
                },
            }
        )
    note = (
        "Exclusion depends on the outcome, so it could favour a policy. Decisions that are excluded although "
        "the ego arrived on every route are included as measured; those in which it did not arrive get the worst "
        "loss and the best gain of all others. Figures measured in a gridlock say little by themselves."
    )
    return Table.of("bounds", "With the excluded decisions included", rows, note, heads=3)


def traffic(study: Study) -> Table:
    """The traffic as a whole at the decisions."""
    rows: list[TableRecord] = []
    for share in sorted({row.share for row in study.rows}):
        points = [point for point in all_decisions(study.rows) if point.drive.share == share]
        summaries = [summary for point in points if (summary := point.decision.traffic) is not None]
        if summaries:
            rows.append(
                {
                    "Share rerouting": f"{share:.0%}",
                    "Decisions": str(len(summaries)),
                    "Vehicles on the road": f"{fmean(each.running for each in summaries):.0f}",
                    "Standing": f"{fmean(each.halted / max(1, each.running) for each in summaries):.0%}",
                    "Max. waiting for 300 s": str(max(each.stuck for each in summaries)),
                    "Max. without room to enter": str(max(each.backlog for each in summaries)),
                    "Max. teleports": str(max(each.teleported for each in summaries)),
                }
            )
    note = (
        "At all decisions, excluded ones included. Vehicles without room to enter wait outside and are no gridlock."
    )
    return Table.of("traffic", "The traffic at the decisions", rows, note)


def by_departure(study: Study) -> Table:
    """The gains by how long the traffic had been running when the ego departed."""
    first_s = study.plan.ages_s[0]
    chosen = [each for each in study.choices if each.age_s == first_s and each.policy not in STAYING]
    named = list(dict.fromkeys(each.policy for each in chosen))
    warm_up_s = study.plan.opened.sumo.warm_up_s
    rows: list[TableRow] = []
    departures_s = sorted({each.departure_s for each in chosen})
    for departure_s in departures_s if len(departures_s) > 1 else ():
        here = [each for each in chosen if each.departure_s == departure_s]
        ids = {each.id for each in here}
        summaries = [point.decision.traffic for point in study.decisions if point.id in ids]
        running = [summary.running for summary in summaries if summary is not None]
        cells = [mean_cell((each for each in here if each.policy == name), time_saved_s) for name in named]
        on_road = f"{fmean(running):.0f}" if running else NONE
        rows.append((f"{warm_up_s + departure_s:g}", str(len(ids)), on_road, *cells))
    note = (
        "Seconds saved. Figures that drift with the age of the traffic mean that its warm-up was too short, or "
        "that the demand changes with the hour."
    )
    columns = ("Traffic has run for, s", "Decisions", "Vehicles on the road", *named)
    return Table("by_departure", "Time saved by the age of the traffic", columns, tuple(rows), note)


def _gains(chosen: Iterable[PolicyChoice]) -> list[tuple[int, float]]:
    return [(each.seed, each.gain.time_s) for each in chosen]


def write_study(folder: Path) -> Path:
    """Writes all of a study's pages, data, ``tables/`` and ``plots/`` into its folder; returns ``report.html``.

    Raises:
        UserError: the folder is not a study's, has no decision that counts, or cannot be written.
        SetupError: the extra ``reports`` is not installed."""
    study = Study.read(folder)
    if not study.rows:
        raise UserError(f"{folder} has no drives yet; rerun its `study` command to resume")
    made = [
        *tables(study),
        *(
            table
            for table in (*effects(study), *circumstances(study), demand_table(read_demand(folder)))
            if table.rows
        ),
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

    ``best`` knows all futures, so nobody can follow it: it is told only where nothing else was compared."""
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
