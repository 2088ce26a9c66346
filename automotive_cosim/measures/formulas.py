"""Surrogate measures of safety in closed form, from the states of two vehicles alone.

| measure | meaning |
|---|---|
| TTC | time to collision: gap over closing speed (Hayward, 1972) |
| DRAC | deceleration to avoid a crash: closing speed squared over twice the gap (Cooper, Ferguson, 1976) |
| MDRAC | the same with a reaction time: closing speed over twice the rest of the TTC (Kuang et al., 2015) |
| crossing TTC | time until the second reaches the point of crossing, if the first is still on it then |
| crossing DRAC | deceleration with which the second reaches the point only when the first has left it |
| required deceleration | the DRAC behind a leader that goes on braking as it does (ISO 15623) |
| PET | time from one leaving a point to the other reaching it (Allen, Shin, Cooper, 1978) |
| gap time, headway time | from bumper to bumper, and from front to front, over the follower's speed (HCM 2010) |
| TET, TIT | time with a TTC up to a threshold; how far it was below, integrated (Minderhoud, Bovy, 2001) |
| delta-v | change of one's own velocity in an inelastic collision |

TTC and DRAC agree with SUMO's SSM device (``device.ssm``), its stamps moved one step later. SUMO's drivers avoid
crashes by construction, so compare drives with each other, never with accident statistics.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot

REACTION_S = 1.0
"""Reaction time in the MDRAC (Kuang et al., 2015, and ``device.ssm.mdrac.prt``)."""


def time_to_collision_s(gap_m: float, closing_mps: float) -> float | None:
    """TTC; None while the gap does not shrink."""
    return None if closing_mps <= 0 else max(0.0, gap_m) / closing_mps


def drac_mps2(gap_m: float, closing_mps: float) -> float | None:
    """DRAC; None while the gap does not shrink or is none."""
    return None if closing_mps <= 0 or gap_m <= 0 else closing_mps**2 / (2 * gap_m)


def mdrac_mps2(gap_m: float, closing_mps: float, reaction_s: float = REACTION_S) -> float | None:
    """MDRAC; None while the gap does not shrink, or if there is no time left to react."""
    ttc_s = time_to_collision_s(gap_m, closing_mps)
    return None if ttc_s is None or ttc_s <= reaction_s else closing_mps / (2 * (ttc_s - reaction_s))


def required_deceleration_mps2(
    gap_m: float, follower_mps: float, leader_mps: float, leader_brakes_mps2: float = 0.0
) -> float | None:
    """The constant deceleration with which the follower just does not touch a leader that brakes as given.

    Args:
        gap_m: from bumper to bumper.
        leader_brakes_mps2: its deceleration, which it keeps up until it stands; the DRAC is the case of 0.

    Returns:
        None if none is needed, or no gap is left."""
    closing_mps = follower_mps - leader_mps
    if gap_m <= 0 or (closing_mps <= 0 and leader_brakes_mps2 <= 0) or follower_mps <= 0:
        return None
    if leader_brakes_mps2 <= 0:
        return drac_mps2(gap_m, closing_mps)
    if closing_mps > 0 and 2 * gap_m / closing_mps <= leader_mps / leader_brakes_mps2:
        return leader_brakes_mps2 + closing_mps**2 / (2 * gap_m)  # as fast as the leader before it stands
    return follower_mps**2 / (2 * (gap_m + leader_mps**2 / (2 * leader_brakes_mps2)))


def crossing_time_to_collision_s(
    first: tuple[float, float], second: tuple[float, float], first_length_m: float
) -> float | None:
    """Crossing TTC; None if the first has left the point before the second reaches it, or one of them stands.

    Args:
        first: metres to the point of crossing and metres per second of the one who reaches it first.
        first_length_m: how much further the first must drive to leave it."""
    (first_m, first_mps), (second_m, second_mps) = first, second
    if first_mps <= 0 or second_mps <= 0:
        return None
    reaches_s, leaves_s = second_m / second_mps, (first_m + first_length_m) / first_mps
    return reaches_s if leaves_s > reaches_s else None


def crossing_drac_mps2(second_m: float, second_mps: float, first_leaves_s: float) -> float | None:
    """Crossing DRAC; None if the second is late enough as it is, or already at the point.

    Args:
        second_m: metres to the point of crossing of the one who reaches it second.
        first_leaves_s: when the first leaves the point, seconds from now."""
    if second_mps <= 0 or second_m <= 0 or second_m / second_mps >= first_leaves_s:
        return None
    moving = 2 * (second_mps - second_m / first_leaves_s) / first_leaves_s
    stands = second_mps - moving * first_leaves_s <= 0  # it need not reverse: to stop before the point is enough
    return second_mps**2 / (2 * second_m) if stands else moving


def swept_pet_s(
    pet_s: float, first_mps: float, first_width_m: float, second_mps: float, second_width_m: float
) -> float:
    """The PET by swept area, from that at the point where two paths cross.

    It counts from the first's rear leaving the other's path, half a width further on, to the second's front
    reaching the first's path, half a width before; SUMO's SSM device has it so."""
    return pet_s - second_width_m / 2 / first_mps - first_width_m / 2 / second_mps


def gap_time_s(gap_m: float, follower_mps: float) -> float | None:
    """Time from the leader's rear to the follower's front; None for one who stands."""
    return None if follower_mps <= 0 else max(0.0, gap_m) / follower_mps


def headway_time_s(gap_m: float, leader_length_m: float, follower_mps: float) -> float | None:
    """Time from front to front; None for one who stands."""
    return gap_time_s(gap_m + leader_length_m, follower_mps)


def delta_v_mps(
    own_kg: float, other_kg: float, own_mps: tuple[float, float], other_mps: tuple[float, float]
) -> float:
    """Delta-v of oneself: both velocities become one, and the momentum stays.

    Args:
        own_mps: own velocity, to the east and to the north."""
    relative_mps = hypot(own_mps[0] - other_mps[0], own_mps[1] - other_mps[1])
    return other_kg / (own_kg + other_kg) * relative_mps


def time_exposed(times: Sequence[tuple[float, float | None]], threshold_s: float) -> tuple[float, float]:
    """TET in seconds, and TIT in seconds squared.

    Args:
        times: simulation time and TTC at each step, in order; a step counts for the time since the one before.
        threshold_s: the TTC up to which a step counts."""
    tet_s = tit_s2 = 0.0
    for (before_s, _), (now_s, ttc_s) in pairwise(times):
        if ttc_s is not None and ttc_s <= threshold_s:
            tet_s += now_s - before_s
            tit_s2 += (threshold_s - ttc_s) * (now_s - before_s)
    return tet_s, tit_s2
