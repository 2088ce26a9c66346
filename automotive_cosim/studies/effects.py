"""Tables of the effect on everyone, of the traffic, and of what the exclusions could hide."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise
from statistics import fmean

from automotive_cosim.report.tables import Table, TableRow
from automotive_cosim.studies.everyone import CLASSES_S, HORIZONS, NOTICED_S
from automotive_cosim.studies.intervals import SeedMean, seed_mean
from automotive_cosim.studies.points import NOT_ARRIVED
from automotive_cosim.studies.results import Study, all_decisions, choices_at
from automotive_cosim.studies.rows import PolicyChoice, Spread, WholeDrive
from automotive_cosim.studies.tables import NONE, STAYING, goes_by_news, groups, told, told_mean

SpreadOf = tuple[PolicyChoice, Spread]


def effects(study: Study) -> list[Table]:
    """All of these tables."""
    return [whole(study), everyone(study), by_trip(study), horizons(study), bounds(study), traffic(study)]


def whole(study: Study) -> Table:
    """The value of a policy over the whole drive."""
    rows: list[TableRow] = []
    for share in sorted({row.share for row in study.rows}):
        for policy in study.plan.policies:
            drives: dict[str, list[WholeDrive]] = {}
            seeds: dict[str, int] = {}
            for row in study.rows:
                for drive in row.whole if row.share == share else ():
                    if drive.policy == policy:
                        drives.setdefault(row.id, []).append(drive)
                        seeds[row.id] = row.seed
            kept = {name: here for name, here in drives.items() if not any(each.excluded for each in here)}
            if not drives:
                continue
            means = {
                what: seed_mean((seeds[name], fmean(map(of, here))) for name, here in kept.items())
                for what, of in (
                    ("reroutings", lambda each: each.reroutings),
                    ("time", lambda each: each.branch.gains.time_s),
                    ("distance", lambda each: each.branch.gains.distance_m),
                    ("others", lambda each: each.branch.others.gain_s),
                )
            }
            rows.append(
                (
                    f"{share:.0%}",
                    policy,
                    str(len(kept)),
                    str(len(drives) - len(kept)),
                    told_mean(means["reroutings"], ".2f"),
                    told_mean(means["time"], "+.1f"),
                    told_mean(means["distance"], "+.0f"),
                    told_mean(means["others"], "+.1f"),
                )
            )
    columns = (
        "Share rerouting",
        "Policy",
        "Drives",
        "Excluded",
        "Reroutings",
        "Time saved, s",
        "Distance saved, m",
        "Others save, s",
    )
    note = (
        "Per drive from departure to destination, compared with the drive that keeps its route from the same "
        "traffic; drives that meet no decision count, with 0. The policy decides by the newest news of the plan."
    )
    return Table("whole", "What following a policy saves over the whole drive", columns, tuple(rows), note, heads=2)


def rerouted(study: Study) -> list[tuple[tuple[str, str, str], list[SpreadOf]]]:
    """The choices of another route with their effect on everyone, by share, policy and age of the news."""
    decisions = {point.id: point.decision for point in study.decisions}
    found = []
    for share, policy, age_s, chosen in groups(study):
        spreads = [
            (each, decisions[each.id].spreads[each.branch])
            for each in chosen
            if each.branch is not None and decisions[each.id].spreads
        ]
        if spreads:
            found.append(((f"{share:.0%}", policy, f"{age_s:g}" if goes_by_news(policy) else NONE), spreads))
    return found


def everyone(study: Study) -> Table:
    """How gains and losses are spread over everyone."""
    rows: list[TableRow] = []
    for heads, found in rerouted(study):
        spreads = [spread for _, spread in found]
        rows.append(
            (
                *heads,
                str(len(found)),
                f"{fmean(each.count for each in spreads):.0f}",
                _mean_cell(found, lambda each: each.mean_s, "+.2f"),
                *(
                    told(fmean(getattr(each, name) for each in spreads), "+.1f")
                    for name in ("low_s", "lower_s", "median_s", "upper_s", "high_s")
                ),
                f"{sum(each.earlier for each in spreads) / sum(each.count for each in spreads):.0%}",
                f"{sum(each.later for each in spreads) / sum(each.count for each in spreads):.0%}",
                f"{fmean(each.gini_stay for each in spreads):.3f}",
                told(fmean(each.gini - each.gini_stay for each in spreads), "+.4f"),
            )
        )
    columns = (
        "Share rerouting",
        "Policy",
        "News age, s",
        "Reroutings",
        "Vehicles",
        "Saved by one, s",
        "5 %",
        "25 %",
        "Median",
        "75 %",
        "95 %",
        "Earlier",
        "Later",
        "Gini",
        "Gini changes by",
    )
    note = (
        "Over the decisions in which the policy reroutes: what single vehicles save, the ego and everybody who was "
        "there, each as the mean over the draws; quantiles are means over decisions. Earlier and later: share of "
        f"the vehicles that arrive at least {NOTICED_S:g} s earlier or later, chance included. Gini: of the times "
        "from the decision to the arrival if the ego keeps its route."
    )
    return Table("everyone", "Who gains and who loses", columns, tuple(rows), note, heads=3)


def by_trip(study: Study) -> Table:
    """The same by how long the trip still takes."""
    rows: list[TableRow] = []
    for heads, found in rerouted(study):
        for from_s, to_s in pairwise((*CLASSES_S, float("inf"))):
            here = [trip for _, spread in found for trip in spread.trips if trip.from_s == from_s]
            count = sum(trip.count for trip in here)
            if count:
                saved_s = sum(trip.gain_s for trip in here) / count
                later = sum(trip.later for trip in here) / count
                name = f"{from_s:g} to {to_s:g} s" if to_s < float("inf") else f"over {from_s:g} s"
                rows.append((*heads, name, str(count), told(saved_s, "+.2f"), f"{later:.0%}"))
    columns = ("Share rerouting", "Policy", "News age, s", "Time left", "Vehicles", "Saved by one, s", "Later")
    note = "Vehicles by the time that their trips still take from the decision, if the ego keeps its route."
    return Table("by_trip", "By length of trip", columns, tuple(rows), note, heads=4)


def horizons(study: Study) -> Table:
    """The effect on the others, summed up to earlier and later instants."""
    rows: list[TableRow] = []
    for heads, found in rerouted(study):
        cells = []
        for number in range(len(HORIZONS)):
            gains = [(choice.seed, spread.horizons[number].gain_s) for choice, spread in found]
            known = [(seed, gain_s) for seed, gain_s in gains if gain_s is not None]
            cells.append(told_mean(seed_mean(known), "+.1f") if len(known) == len(gains) else NONE)
        rows.append((*heads, str(len(found)), *cells))
    columns = (
        "Share rerouting",
        "Policy",
        "News age, s",
        "Reroutings",
        *(f"{share:.0%} home" for share in HORIZONS),
    )
    note = (
        "Seconds that all others together save until the given share of them had arrived in the first of the two "
        f"futures, over the decisions in which the policy reroutes. The futures end at {study.plan.arrived:.0%} "
        "(--arrived)."
    )
    return Table("horizons", "The others, by horizon", columns, tuple(rows), note, heads=3)


def bounds(study: Study) -> Table:
    """The mean gain with the excluded decisions put in."""
    left_out = [point for point in all_decisions(study.rows) if point.decision.excluded]
    rows: list[TableRow] = []
    for share, policy, age_s, counted in groups(study) if left_out else ():
        if policy in STAYING:
            continue
        here = [point for point in left_out if point.drive.share == share]
        put_in = [
            (point.decision.excluded, choice)
            for point in here
            for choice in choices_at(point, (policy,))
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
        "Exclusion looks at the outcome, so it could favour a policy. Decisions that are excluded although "
        "the ego arrived in every future are put in as measured; those in which it did not arrive get the greatest "
        "loss and the greatest gain of all others. Measured in a gridlock, they say little by themselves."
    )
    return Table("bounds", "With the excluded decisions put in", columns, tuple(rows), note, heads=3)


def traffic(study: Study) -> Table:
    """The traffic as a whole at the decisions."""
    rows: list[TableRow] = []
    for share in sorted({row.share for row in study.rows}):
        points = [point for point in all_decisions(study.rows) if point.drive.share == share]
        pulses = [pulse for point in points if (pulse := point.decision.traffic) is not None]
        if pulses:
            rows.append(
                (
                    f"{share:.0%}",
                    str(len(pulses)),
                    f"{fmean(each.running for each in pulses):.0f}",
                    f"{fmean(each.halted / max(1, each.running) for each in pulses):.0%}",
                    str(max(each.stuck for each in pulses)),
                    str(max(each.backlog for each in pulses)),
                    str(max(each.teleported for each in pulses)),
                )
            )
    columns = (
        "Share rerouting",
        "Decisions",
        "Vehicles on the road",
        "Standing",
        "Most waiting for 300 s",
        "Most without room to enter",
        "Most teleports",
    )
    note = "At all decisions, excluded ones too. Vehicles without room to enter wait outside and are no gridlock."
    return Table("traffic", "The traffic at the decisions", columns, tuple(rows), note)


def _gains(chosen: Iterable[PolicyChoice]) -> list[tuple[int, float]]:
    return [(each.seed, each.gain.time_s) for each in chosen]


def _mean_cell(found: Iterable[SpreadOf], of: Callable[[Spread], float], form: str) -> str:
    mean: SeedMean | None = seed_mean((choice.seed, of(spread)) for choice, spread in found)
    return told_mean(mean, form)
