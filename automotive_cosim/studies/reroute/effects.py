"""Tables of wider effects: of following a policy, of many cars at once, and on everyone else."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise, product
from statistics import fmean

from automotive_cosim.contracts.plain import counted
from automotive_cosim.report.tables import Table, TableRecord, TableRow
from automotive_cosim.studies.intervals import SeedMean, seed_mean
from automotive_cosim.studies.reroute.compare import CONSUMED
from automotive_cosim.studies.reroute.everyone import CLASSES_S, HORIZONS, NOTICED_S
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.rows import Closed, FleetClass, PolicyChoice, Spread, Together, WholeTrip
from automotive_cosim.studies.reroute.tables import NONE, goes_by_news, groups, told, told_mean

SpreadOf = tuple[PolicyChoice, Spread]


def effects(study: Study) -> list[Table]:
    """All tables of this module, in the order of the report."""
    made = (whole, many, closed, everyone, by_trip, horizons, fleet)
    return [each(study) for each in made]


def whole(study: Study) -> Table:
    """The value of a policy over the whole drive."""
    rows: list[TableRecord] = []
    for share in sorted({row.share for row in study.rows}):
        for policy, compliance in product(study.plan.policies, study.plan.compliance):
            drives: dict[str, list[WholeTrip]] = {}
            seeds: dict[str, int] = {}
            for row in study.rows:
                for drive in row.whole if row.share == share else ():
                    if (drive.policy, drive.compliance) == (policy, compliance):
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
                {
                    "Share rerouting": f"{share:.0%}",
                    "Policy": policy,
                    "Compliance": f"{compliance:.0%}",
                    "Drives": str(len(kept)),
                    "Excluded": str(len(drives) - len(kept)),
                    "Reroutings": told_mean(means["reroutings"], ".2f"),
                    "Time saved, s": told_mean(means["time"], "+.1f"),
                    "Distance saved, m": told_mean(means["distance"], "+.0f"),
                    "Others save, s": told_mean(means["others"], "+.1f"),
                }
            )
    note = (
        "Per drive from departure to destination, compared with the drive that keeps its route from the same "
        "traffic; drives that meet no decision count, with 0. The policy decides by the newest news of the plan."
    )
    return Table.of("whole", "What following a policy saves over the whole drive", rows, note, heads=3)


def named(heads: tuple[str, str, str]) -> dict[str, str]:
    """Share, policy and age of the news under their headings."""
    return dict(zip(("Share rerouting", "Policy", "News age, s"), heads, strict=True))


def rerouted(study: Study) -> list[tuple[tuple[str, str, str], list[SpreadOf]]]:
    """The choices of another route with their effect on everyone, by share, policy and age of the news."""
    decisions = {point.id: point.decision for point in study.decisions}
    found = []
    for share, policy, age_s, chosen in groups(study):
        spreads = [
            (each, decisions[each.id].spreads[each.branch])
            for each in chosen
            if each.rerouted and each.branch is not None and decisions[each.id].spreads
        ]
        if spreads:
            found.append(((f"{share:.0%}", policy, f"{age_s:g}" if goes_by_news(policy) else NONE), spreads))
    return found


def together_by_share(study: Study) -> dict[tuple[float, float], list[tuple[int, list[Together]]]]:
    """The draws of each decision with the seed of its traffic, by share of rerouting cars and share sent along.

    A decision of which any draw of any share does not count is left out of all, so that the shares stay paired."""
    found: dict[tuple[float, float], list[tuple[int, list[Together]]]] = {}
    for point in study.decisions:
        every = point.decision.together
        for share in study.plan.together if every and not any(each.excluded for each in every) else ():
            draws = [each for each in every if each.share == share]
            found.setdefault((point.drive.share, share), []).append((point.drive.seed, draws))
    return dict(sorted(found.items()))


def many(study: Study) -> Table:
    """The cost when many cars take the other route at once."""
    left_out = sum(any(each.excluded for each in point.decision.together) for point in study.decisions)
    rows: list[TableRecord] = []
    for (rerouting, share), here in together_by_share(study).items():
        rows.append(
            {
                "Share rerouting": f"{rerouting:.0%}",
                "Rerouted with ego": f"{share:.0%}",
                "Decisions": str(len(here)),
                "Eligible": _drawn_cell(here, lambda each: each.could, ".1f"),
                "Went": _drawn_cell(here, lambda each: each.took, ".1f"),
                "Ego saves, s": _drawn_cell(here, lambda each: each.ego_gain_s, "+.1f"),
                "Rerouted save, s": _drawn_cell(here, lambda each: each.took_gain_s, "+.1f"),
                "The rest save, s": _drawn_cell(here, lambda each: each.rest_gain_s, "+.1f"),
                "All save, s": _drawn_cell(
                    here, lambda each: each.ego_gain_s + each.took_gain_s + each.rest_gain_s, "+.1f"
                ),
            }
        )
    note = (
        "At the first decision of each drive with another route, whatever the news predicts: the ego takes it, and "
        "so does that share of the cars whose routes pass both ends of the section in which the two routes differ. "
        "Cars, traffic and random numbers are the same at every share, so the rows differ only by the share. "
    )
    if left_out:
        note += f"{counted(left_out, 'decision')} left out that did not arrive or clear in time at every share."
    return Table.of("many", "When many cars take the other route", rows, note, heads=2)


def closed(study: Study) -> Table:
    """The cost of closing a road at the fork."""
    rows: list[TableRecord] = []
    for share in sorted({row.share for row in study.rows}):
        points = [point for point in study.decisions if point.drive.share == share and point.decision.closed]
        kept = [
            (point.drive.seed, point.decision.closed)
            for point in points
            if not any(each.excluded for each in point.decision.closed)
        ]
        if points:
            rows.append(
                {
                    "Share rerouting": f"{share:.0%}",
                    "Decisions": str(len(kept)),
                    "Excluded": str(len(points) - len(kept)),
                    **{
                        name: told_mean(seed_mean((seed, fmean(map(of, draws))) for seed, draws in kept), "+.1f")
                        for name, of in _CLOSED.items()
                    },
                }
            )
    note = (
        "At the first decision of each drive with another route, a road is closed on both routes (--close), and "
        "each is compared with the same route with it open. Cars with that road on their route make a detour. "
        "Others: if the ego keeps its route; later: by 1 s or more."
    )
    return Table.of("closed", "When a road is closed at the fork", rows, note)


_CLOSED: dict[str, Callable[[Closed], float]] = {
    "Ego loses, s": lambda each: each.stay_loss_s,
    "On the other route, s": lambda each: each.other_loss_s,
    "Other route saves, open, s": lambda each: each.open_gain_s,
    "Other route saves, closed, s": lambda each: each.gain_s,
    "Others lose, s": lambda each: each.others_loss_s,
    "Others later": lambda each: each.others_later,
}


QUANTILES = {"5 %": "low_s", "25 %": "lower_s", "Median": "median_s", "75 %": "upper_s", "95 %": "high_s"}


def everyone(study: Study) -> Table:
    """How gains and losses are distributed over everyone."""
    rows: list[TableRecord] = []
    for heads, found in rerouted(study):
        spreads = [spread for _, spread in found]
        rows.append(
            {
                **named(heads),
                "Reroutings": str(len(found)),
                "Vehicles": f"{fmean(each.count for each in spreads):.0f}",
                "Saved by one, s": _mean_cell(found, lambda each: each.mean_s, "+.2f"),
                **{
                    quantile: told(fmean(getattr(each, name) for each in spreads), "+.1f")
                    for quantile, name in QUANTILES.items()
                },
                "Earlier": f"{sum(each.earlier for each in spreads) / sum(each.count for each in spreads):.0%}",
                "Later": f"{sum(each.later for each in spreads) / sum(each.count for each in spreads):.0%}",
                "Gini": f"{fmean(each.gini_stay for each in spreads):.3f}",
                "Gini changes by": told(fmean(each.gini - each.gini_stay for each in spreads), "+.4f"),
            }
        )
    note = (
        "Over the decisions where the policy reroutes: what single vehicles save, the ego and all others that were "
        "there, each as its mean over the draws; quantiles are means over decisions. Earlier and later: share of "
        f"the vehicles that arrive at least {NOTICED_S:g} s earlier or later, chance included. Gini: of the times "
        "from the decision to the arrival if the ego keeps its route."
    )
    return Table.of("everyone", "Who gains and who loses", rows, note, heads=3)


def by_trip(study: Study) -> Table:
    """The same by the time left on the trip."""
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
        *(f"{share:.0%} arrived" for share in HORIZONS),
    )
    note = (
        "Seconds that all others together save up to the instant at which the given share has arrived in the "
        f"faster way, over the decisions where the policy reroutes. Each is driven until {study.plan.arrived:.0%} "
        "(arrived) and the ego have arrived: “Others save” in “Other effects” counts up to then, and "
        "over all decisions."
    )
    return Table("horizons", "The others, by horizon", columns, tuple(rows), note, heads=3)


SAVED = (
    ("CO2", "g", "+.0f"),
    ("NOx", "g", "+.2f"),
    ("Fuel", "g", "+.0f"),
    ("Electricity", "Wh", "+.1f"),
    ("Noise", "s", "+.0f"),
)
"""What is told of ``CONSUMED``."""


def fleet(study: Study) -> Table:
    """How much less everyone emits and consumes, by emission class."""
    decisions = {point.id: point.decision for point in study.decisions}
    rows: list[TableRecord] = []
    for heads, found in rerouted(study):
        by_class: dict[str, list[tuple[int, list[FleetClass]]]] = {}
        for choice, _ in found:
            decision = decisions[choice.id]
            drawn = [decision.drawn(draw, choice.branch) for draw in decision.scored]
            parts = [part for branch in drawn if branch is not None for part in branch.fleet]
            for name in dict.fromkeys(part.emission_class for part in parts):
                same = [part for part in parts if part.emission_class == name]
                by_class.setdefault(name, []).append((choice.seed, same))
        for name, here in sorted(by_class.items()):
            vehicles = fmean(part.count for _, parts in here for part in parts)
            rows.append(
                {
                    **named(heads),
                    "Emission class": name,
                    "Vehicles": f"{vehicles:.0f}",
                    **{
                        f"{what} saved, {unit}": told_mean(
                            seed_mean((seed, _mean_of(parts, figure)) for seed, parts in here), form
                        )
                        for (what, unit, form), figure in zip(SAVED, CONSUMED, strict=True)
                    },
                }
            )
    note = (
        "Sums over the vehicles of the class that arrived with either route, per decision in which the policy "
        "reroutes. Classes are those that the demand's vehicle types declare (emissionClass), else SUMO's own for "
        "the kind of vehicle; ego_class of the plan declares the ego's. Noise is sound energy at the vehicles "
        "(Harmonoise), as seconds of a car at 50 km/h, 65 dB(A)."
    )
    return Table.of("fleet", "Emissions and consumption of everyone", rows, note, heads=4)


def _mean_of(parts: Sequence[FleetClass], what: str) -> float:
    """The mean of a figure over the draws of a decision."""
    return fmean(getattr(part, what) for part in parts)


def _mean_cell(found: Iterable[SpreadOf], of: Callable[[Spread], float], form: str) -> str:
    mean: SeedMean | None = seed_mean((choice.seed, of(spread)) for choice, spread in found)
    return told_mean(mean, form)


def _drawn_cell(here: Sequence[tuple[int, list[Together]]], of: Callable[[Together], float], form: str) -> str:
    """The mean over decisions of the means over their draws; each with the seed of its traffic."""
    return told_mean(seed_mean((seed, fmean(map(of, draws))) for seed, draws in here), form)
