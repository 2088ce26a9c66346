"""Surrogate measures of safety, from the states of two vehicles alone.

| measure | meaning |
|---|---|
| TTC | time to collision: gap over closing speed (Hayward, 1972) |
| DRAC | deceleration to avoid a crash: closing speed squared over twice the gap (Cooper, Ferguson, 1976) |
| MDRAC | the same with a reaction time: closing speed over twice the rest of the TTC (Kuang et al., 2015) |
| crossing TTC | time until the second reaches the point of crossing, if the first is still on it then |
| TET, TIT | time with a TTC up to a threshold; how far it was below, integrated (Minderhoud, Bovy, 2001) |

TTC and DRAC agree with SUMO's SSM device (``device.ssm``), its stamps moved one step later. SUMO's drivers avoid
crashes by construction, so compare drives with each other, never with accident statistics.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

REACTION_S = 1.0
"""Reaction time in the MDRAC."""


def time_to_collision_s(gap_m: float, closing_mps: float) -> float | None:
    """TTC; None while the gap does not shrink."""
    return None if closing_mps <= 0 else max(0.0, gap_m) / closing_mps


def drac_mps2(gap_m: float, closing_mps: float) -> float | None:
    """DRAC; None while the gap does not shrink or is none."""
    return None if closing_mps <= 0 or gap_m <= 0 else closing_mps**2 / (2 * gap_m)


def mdrac_mps2(gap_m: float, closing_mps: float) -> float | None:
    """MDRAC; None while the gap does not shrink, or if there is no time left to react."""
    ttc_s = time_to_collision_s(gap_m, closing_mps)
    return None if ttc_s is None or ttc_s <= REACTION_S else closing_mps / (2 * (ttc_s - REACTION_S))


def crossing_time_to_collision_s(
    first: tuple[float, float], second: tuple[float, float], first_length_m: float
) -> float | None:
    """Crossing TTC; None if the first has left the point before the second reaches it, or one of them stands.

    Args:
        first: metres to the point of crossing and metres per second of the one who reaches it first.
        second: the same of the other.
        first_length_m: how much further the first must drive to leave it.
    """
    (first_m, first_mps), (second_m, second_mps) = first, second
    if first_mps <= 0 or second_mps <= 0:
        return None
    reaches_s, leaves_s = second_m / second_mps, (first_m + first_length_m) / first_mps
    return reaches_s if leaves_s > reaches_s else None


def exposure(times: Sequence[tuple[float, float | None]], threshold_s: float) -> tuple[float, float]:
    """TET in seconds, and TIT in seconds squared.

    Args:
        times: simulation time and TTC at each step, in order; a step counts for the time since the one before.
        threshold_s: the TTC up to which a step counts.
    """
    tet_s = tit_s2 = 0.0
    for (before_s, _), (now_s, ttc_s) in pairwise(times):
        if ttc_s is not None and ttc_s <= threshold_s:
            tet_s += now_s - before_s
            tit_s2 += (threshold_s - ttc_s) * (now_s - before_s)
    return tet_s, tit_s2
