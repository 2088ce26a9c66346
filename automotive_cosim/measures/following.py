"""Measures of a drive against the vehicles in front and behind, along the road as SUMO has it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from automotive_cosim.contracts import DrivingState, OtherVehicle
from automotive_cosim.measures.formulas import gap_time_s, mdrac_mps2, time_exposed
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS, Thresholds


def is_near(state: DrivingState) -> bool:
    """Whether the car is near a collision with the one in front: seconds away, and only hard braking avoids it.

    Without the braking every gentle stop in a queue counts: who brakes from v with a is v / 2a from a collision."""
    leader = state.around.leader
    if leader is None or leader.time_to_collision_s is None:
        return False
    is_soon = leader.time_to_collision_s < DEFAULT_THRESHOLDS.ttc_s
    return is_soon and (leader.drac_mps2 or 0.0) >= DEFAULT_THRESHOLDS.drac_mps2


@dataclass(frozen=True, slots=True)
class FollowingFigures:
    """The most critical values of a drive, and for how long it was critical. None without such a vehicle."""

    min_ttc_s: float | None
    """To the vehicle in front."""
    max_drac_mps2: float | None
    max_mdrac_mps2: float | None
    min_gap_time_s: float | None
    """To the vehicle in front, bumper to bumper."""
    tet_s: float
    """Time with a TTC up to the threshold to the vehicle in front."""
    tit_s2: float
    """How far it was below the threshold, integrated."""
    min_ttc_behind_s: float | None
    """Of the vehicle behind."""
    tet_behind_s: float


def following_figures(
    states: Sequence[DrivingState], thresholds: Thresholds = DEFAULT_THRESHOLDS
) -> FollowingFigures:
    """The figures of a drive.

    Args:
        states: every step, in order.
        thresholds: from when on it is critical."""
    ahead = [(state, other) for state in states if (other := state.around.leader) is not None]
    closing = [(other.gap_m, other.gap_m / ttc_s) for _, other in ahead if (ttc_s := _closing(other))]
    tet_s, tit_s2 = time_exposed([_ttc(state, state.around.leader) for state in states], thresholds.ttc_s)
    tet_behind_s, _ = time_exposed([_ttc(state, state.around.follower) for state in states], thresholds.ttc_s)
    return FollowingFigures(
        min_ttc_s=nearest_s(states),
        max_drac_mps2=_most(other.drac_mps2 for _, other in ahead),
        max_mdrac_mps2=_most(mdrac_mps2(gap_m, mps, thresholds.reaction_s) for gap_m, mps in closing),
        min_gap_time_s=_least(gap_time_s(other.gap_m, state.speed_mps) for state, other in ahead),
        tet_s=round(tet_s, 3),
        tit_s2=round(tit_s2, 3),
        min_ttc_behind_s=_least(
            state.around.follower.time_to_collision_s for state in states if state.around.follower is not None
        ),
        tet_behind_s=round(tet_behind_s, 3),
    )


def nearest_s(states: Iterable[DrivingState]) -> float | None:
    """The minimum TTC to the vehicle in front; None if none came nearer."""
    return _least(state.around.leader.time_to_collision_s for state in states if state.around.leader is not None)


def _ttc(state: DrivingState, other: OtherVehicle | None) -> tuple[float, float | None]:
    return state.time_s, None if other is None else other.time_to_collision_s


def _closing(other: OtherVehicle) -> float | None:
    """TTC to a vehicle that is not touched yet."""
    return other.time_to_collision_s if other.gap_m > 0 else None


def _least(values: Iterable[float | None]) -> float | None:
    return min((round(value, 3) for value in values if value is not None), default=None)


def _most(values: Iterable[float | None]) -> float | None:
    return max((round(value, 3) for value in values if value is not None), default=None)
