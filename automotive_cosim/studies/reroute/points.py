"""The futures of one decision: the conditions under which they count, and their results."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from statistics import fmean, stdev

from automotive_cosim.studies.calls.accounts import TrafficSummary
from automotive_cosim.studies.gridlock import gridlock
from automotive_cosim.studies.reroute import compare
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.everyone import NOTICED_S, spread
from automotive_cosim.studies.reroute.plan import AUTO_ERRORS
from automotive_cosim.studies.reroute.rows import Branch, Closed, Decision, Replicate, Together


def together(
    share: float,
    draw: int,
    pair: tuple[Future, Future],
    group: Sequence[str],
    took: Sequence[str],
    could: int,
    excluded: str,
) -> Together:
    """Savings of the ego, of the cars rerouted with it, and of all the rest.

    Args:
        share: share of the eligible cars that were rerouted with the ego.
        pair: the future in which everyone keeps their route, and the one in which they do not.
        group: the other vehicles that were present.
        excluded: why the future does not count."""
    stay, other = pair
    until_s = min(future.settled.time_s for future in pair)
    went = set(took)

    def gains_s(who: Sequence[str]) -> Iterator[float]:
        for vehicle in who:
            before_s, after_s = (min(future.settled.arrivals_s.get(vehicle, until_s), until_s) for future in pair)
            yield before_s - after_s

    return Together(
        share=share,
        draw=draw,
        could=could,
        took=len(took),
        ego_gain_s=round(stay.totals().time_s - other.totals().time_s, 3),
        took_gain_s=round(sum(gains_s(took)), 3),
        rest_gain_s=round(sum(gains_s([vehicle for vehicle in group if vehicle not in went])), 3),
        excluded=excluded,
    )


GRIDLOCK = "gridlock"
NOT_ARRIVED = "ego did not arrive"
NOT_CLEARED = "traffic did not clear"
"""Reasons to exclude a decision from the averages; a gridlock is followed by the rule that detected it."""


@dataclass(slots=True)
class Point:
    """A decision point with its branches."""

    decision: Decision
    """The decision without the results of its branches."""
    group: tuple[str, ...]
    """The other vehicles that were present."""
    summary: TrafficSummary
    branches: list[Future | None] = field(default_factory=list)
    """The future of each branch; None if nothing in it differs from the drive itself."""
    placebo: Future | None = None
    replicates: list[Drawn] = field(default_factory=list)
    together: list[Diverted] = field(default_factory=list)
    shut: list[Shut] = field(default_factory=list)


@dataclass(slots=True)
class Shut:
    """The futures of the two routes with a road closed."""

    edge: str
    draw: int
    branch: int
    """Number of the other route."""
    stay: Future
    other: Future


@dataclass(slots=True)
class Diverted:
    """A future in which others take the ego's other route too."""

    share: float
    draw: int
    future: Future
    took: tuple[str, ...]
    could: int


@dataclass(slots=True)
class Drawn:
    """The futures of one replicate."""

    seed: int
    stay: Future
    branches: list[Future]

    @property
    def gains_s(self) -> list[float]:
        """Time saved by each branch."""
        return [compare.gains(self.stay, branch).time_s for branch in self.branches]


def compared(point: Point, stay: Future, history: Sequence[TrafficSummary]) -> Decision:
    """A decision with the gains of its branches.

    Args:
        stay: the drive itself, in which the ego keeps its route.
        history: measurements of the traffic up to the ego's departure."""
    branches = [stay if branch is None else branch for branch in point.branches]
    drawn = [Drawn(0, stay, branches), *point.replicates]
    scored = drawn[: point.decision.planned_draws or len(drawn)]
    pairs = [(each.stay, branch) for each in drawn for branch in each.branches]
    pairs += [(stay, point.placebo)] if point.placebo else []
    summaries = [*history, point.summary]
    excluded, why = exclusion(pairs, summaries)
    return replace(
        point.decision,
        excluded=point.decision.excluded or excluded,
        why=point.decision.why or why,
        branches=tuple(branched(stay, branch, point.group) for branch in branches),
        placebo=None if point.placebo is None else branched(stay, point.placebo, point.group),
        replicates=tuple(
            Replicate(
                seed=each.seed,
                stay=branched(stay, each.stay, point.group),
                branches=tuple(branched(each.stay, branch, point.group) for branch in each.branches),
            )
            for each in point.replicates
        ),
        spreads=tuple(
            spread([(each.stay, each.branches[number]) for each in scored], point.group, point.decision.at_s)
            for number in range(len(branches))
        ),
        traffic=point.summary,
        together=tuple(_together(each, drawn[each.draw].stay, point, summaries) for each in point.together),
        closed=tuple(_closed(each, drawn[each.draw], point, summaries) for each in point.shut),
    )


def _closed(shut: Shut, open_: Drawn, point: Point, summaries: Sequence[TrafficSummary]) -> Closed:
    """The cost of a closure, unless one of its futures does not count; the decision itself still counts."""
    other = open_.branches[shut.branch]
    times_s = [future.totals().time_s for future in (open_.stay, other, shut.stay, shut.other)]
    stay_s, other_s, stay_closed_s, other_closed_s = times_s
    excluded, _ = exclusion([(open_.stay, shut.stay), (open_.stay, shut.other)], summaries)
    until_s = min(open_.stay.settled.time_s, shut.stay.settled.time_s)
    arrivals = [
        [min(future.settled.arrivals_s.get(each, until_s), until_s) for future in (open_.stay, shut.stay)]
        for each in point.group
    ]
    return Closed(
        edge=shut.edge,
        draw=shut.draw,
        stay_loss_s=round(stay_closed_s - stay_s, 3),
        other_loss_s=round(other_closed_s - other_s, 3),
        gain_s=round(stay_closed_s - other_closed_s, 3),
        open_gain_s=round(stay_s - other_s, 3),
        others_loss_s=round(sum(after_s - before_s for before_s, after_s in arrivals), 3),
        others_later=sum(after_s - before_s >= NOTICED_S for before_s, after_s in arrivals),
        excluded=excluded,
    )


def _together(diverted: Diverted, stay: Future, point: Point, summaries: Sequence[TrafficSummary]) -> Together:
    """What many cars gain, unless that future does not count; the decision itself still counts."""
    pair = stay, diverted.future
    excluded, _ = exclusion([pair], summaries)
    return together(diverted.share, diverted.draw, pair, point.group, diverted.took, diverted.could, excluded)


def exclusion(pairs: Sequence[tuple[Future, Future]], summaries: Sequence[TrafficSummary]) -> tuple[str, str]:
    """Why futures are excluded from the averages, with the figures; both empty if they count.

    Args:
        pairs: each future with the one in which the ego keeps its route, which comes first.
        summaries: measurements of the traffic up to their fork."""
    futures = [future for pair in pairs for future in pair]
    if not all(future.has_arrived for future in futures):
        ends = sorted({str(future.last.end) for future in futures if not future.has_arrived})
        return NOT_ARRIVED, f"it ended as {', '.join(ends)}"
    for stay, _ in pairs:
        jam = gridlock([*summaries, stay.settled.summary])
        if jam is not None:
            return f"{GRIDLOCK}: {jam.rule}", jam.why
    if not all(future.settled.is_complete for future in futures):
        return NOT_CLEARED, "too few of the vehicles present at the decision had arrived in time"
    return "", ""


def shows_signs(drawn: Sequence[Drawn]) -> bool:
    """Whether the mean gain of every branch is clearly above or below zero."""
    for gains_s in zip(*(each.gains_s for each in drawn), strict=True):
        error_s = stdev(gains_s) / len(gains_s) ** 0.5
        if error_s > 0 and abs(fmean(gains_s)) <= AUTO_ERRORS * error_s:
            return False
    return True


def branched(stay: Future, other: Future, group: Sequence[str]) -> Branch:
    """A future compared with the one in which the ego keeps its route.

    Args:
        group: the other vehicles that were there at the fork."""
    return Branch(
        gains=compare.gains(stay, other),
        totals=other.totals(),
        others=compare.others(stay, other, group),
        fleet=compare.fleet(stay, other, group),
    )
