"""Compares two futures of one instant. A gain is what the second one saves; positive is better."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.contracts import DrivingState, EgoEnd
from automotive_cosim.studies.calls.accounts import Settled
from automotive_cosim.studies.reroute.rows import FleetClass, OthersTotals, Totals
from automotive_cosim.traffic.sumo import EGO

CONSUMED = ("co2_g", "nox_g", "fuel_g", "energy_wh", "noise_s")


@dataclass(frozen=True, slots=True)
class Future:
    """One future of an instant, driven to its end."""

    last: DrivingState
    """Figures of the ego."""
    settled: Settled

    @property
    def has_arrived(self) -> bool:
        """Whether the ego reached its destination in time."""
        return self.last.end is EgoEnd.ARRIVED

    def totals(self) -> Totals:
        """Figures of the ego's drive; the rest of the route covered in the last step counts as driven."""
        ego = self.settled.ego
        return Totals(
            time_s=round(self.last.time_s - ego.departed_s, 3),
            distance_m=round(self.last.distance_m + self.last.ahead.route_left_m, 2),
            stops=ego.stops,
            standing_s=round(ego.standing_s, 3),
            co2_g=round(ego.co2_g, 3),
            fuel_g=round(ego.fuel_g, 3),
            energy_wh=round(ego.energy_wh, 3),
            lost_s=round(ego.lost_s, 3),
        )


def gains(stay: Future, other: Future) -> Totals:
    """The ego's savings in the other future."""
    return stay.totals().saved(other.totals())


def others(stay: Future, other: Future, group: Sequence[str]) -> OthersTotals:
    """The savings of all other vehicles present at the fork, in total time since then.

    Both futures are compared up to the same instant, the earlier of their ends. A vehicle that has not arrived by
    then counts up to it and as unfinished, so none drops out of the sum, even if it is late in only one of the two.

    Args:
        stay: the future in which the ego keeps its route.
        other: the future in which it does not.
        group: the vehicles that were on the road, or due and waiting to enter it."""
    until_s = min(stay.settled.time_s, other.settled.time_s)
    times = [
        [min(future.settled.arrivals_s.get(vehicle, until_s), until_s) for vehicle in group]
        for future in (stay, other)
    ]
    return OthersTotals(
        count=len(group),
        gain_s=round(sum(before - after for before, after in zip(*times, strict=True)), 3),
        changed=sum(before != after for before, after in zip(*times, strict=True)),
        unfinished_stay=unfinished(stay, group, until_s),
        unfinished=unfinished(other, group, until_s),
    )


def fleet(stay: Future, other: Future, group: Sequence[str]) -> tuple[FleetClass, ...]:
    """How much less everyone emits and consumes, by emission class, with the ego as a class of its own.

    Only vehicles that have arrived in both futures count, with their whole trips; the time before the fork cancels.
    """
    before, after = stay.settled.consumptions, other.settled.consumptions
    home = [each for each in group if each in stay.settled.arrivals_s and each in other.settled.arrivals_s]
    saved: dict[str, list[float]] = {}
    for vehicle in [EGO, *home]:
        if vehicle in before and vehicle in after:
            one, two = before[vehicle], after[vehicle]
            name = f"ego: {one.emission_class}" if vehicle == EGO else one.emission_class
            sums = saved.setdefault(name, [0.0] * (1 + len(CONSUMED)))
            savings = (getattr(one, each) - getattr(two, each) for each in CONSUMED)
            for number, value in enumerate((1.0, *savings)):
                sums[number] += value
    return tuple(
        FleetClass(
            emission_class=name, count=round(count), **dict(zip(CONSUMED, (round(x, 3) for x in rest), strict=True))
        )
        for name, (count, *rest) in sorted(saved.items())
    )


def unfinished(future: Future, group: Sequence[str], until_s: float) -> int:
    """How many of the group have not arrived by an instant."""
    return sum(future.settled.arrivals_s.get(vehicle, until_s + 1) > until_s for vehicle in group)
