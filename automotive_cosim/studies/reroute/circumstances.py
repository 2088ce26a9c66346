"""Tables of the context of the figures: the traffic, its warm-up, and the possible effect of the exclusions."""

from collections.abc import Iterable
from statistics import fmean

from automotive_cosim.report.tables import Table, TableRow
from automotive_cosim.studies.intervals import seed_mean
from automotive_cosim.studies.reroute.points import NOT_ARRIVED
from automotive_cosim.studies.reroute.results import Study, all_decisions, choices_at
from automotive_cosim.studies.reroute.rows import PolicyChoice
from automotive_cosim.studies.reroute.tables import (
    NONE,
    STAYING,
    goes_by_news,
    groups,
    mean_cell,
    time_saved_s,
    told_mean,
)


def context(study: Study) -> list[Table]:
    """All tables of this module, in the order of the report."""
    return [bounds(study), by_departure(study), traffic(study)]


def bounds(study: Study) -> Table:
    """The mean gain with the excluded decisions included."""
    left_out = [point for point in all_decisions(study.rows) if point.decision.excluded]
    rows: list[TableRow] = []
    for share, policy, age_s, counted in groups(study) if left_out else ():
        if policy in STAYING:
            continue
        here = [point for point in left_out if point.drive.share == share]
        put_in = [
            (point.decision.excluded, choice)
            for point in here
            for choice in choices_at(point, (policy,), study.plan.compliance[0])
            if choice.age_s == age_s
        ]
        known = _gains(counted) + _gains(choice for reason, choice in put_in if reason != NOT_ARRIVED)
        unknown = [choice.seed for reason, choice in put_in if reason == NOT_ARRIVED]
        worst_s, best_s = (end(gain_s for _, gain_s in known) for end in (min, max))
        rows.append(
            (
                f"{share:.0%}",
                policy,
                f"{age_s:g}" if goes_by_news(policy) else NONE,
                str(len(counted)),
                told_mean(seed_mean(_gains(counted)), "+.1f"),
                str(len(put_in) - len(unknown)),
                told_mean(seed_mean(known), "+.1f"),
                str(len(unknown)),
                *(
                    told_mean(seed_mean([*known, *((seed, end_s) for seed in unknown)]), "+.1f")
                    for end_s in (worst_s, best_s)
                ),
            )
        )
    columns = (
        "Share rerouting",
        "Policy",
        "News age, s",
        "Counted",
        "Time saved, s",
        "Excluded, measured",
        "With these, s",
        "Not measured",
        "At worst, s",
        "At best, s",
    )
    note = (
        "Exclusion depends on the outcome, so it could favour a policy. Decisions that are excluded although "
        "the ego arrived on every route are included as measured; those in which it did not arrive get the worst "
        "loss and the best gain of all others. Figures measured in a gridlock say little by themselves."
    )
    return Table("bounds", "With the excluded decisions included", columns, tuple(rows), note, heads=3)


def traffic(study: Study) -> Table:
    """The traffic as a whole at the decisions."""
    rows: list[TableRow] = []
    for share in sorted({row.share for row in study.rows}):
        points = [point for point in all_decisions(study.rows) if point.drive.share == share]
        summaries = [summary for point in points if (summary := point.decision.traffic) is not None]
        if summaries:
            rows.append(
                (
                    f"{share:.0%}",
                    str(len(summaries)),
                    f"{fmean(each.running for each in summaries):.0f}",
                    f"{fmean(each.halted / max(1, each.running) for each in summaries):.0%}",
                    str(max(each.stuck for each in summaries)),
                    str(max(each.backlog for each in summaries)),
                    str(max(each.teleported for each in summaries)),
                )
            )
    columns = (
        "Share rerouting",
        "Decisions",
        "Vehicles on the road",
        "Standing",
        "Max. waiting for 300 s",
        "Max. without room to enter",
        "Max. teleports",
    )
    note = (
        "At all decisions, excluded ones included. Vehicles without room to enter wait outside and are no gridlock."
    )
    return Table("traffic", "The traffic at the decisions", columns, tuple(rows), note)


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
