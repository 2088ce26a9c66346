"""An agent's position estimates while GPS was out, compared with dead reckoning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from automotive_cosim.cockpit.actions import position
from automotive_cosim.contracts import ActionType
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east
from automotive_cosim.geo.reckoning import reckon
from automotive_cosim.interface.trace import Step


@dataclass(frozen=True, slots=True)
class PositionEstimate:
    """One estimate with both errors, in metres on the ground."""

    step: int
    age_s: float
    """Seconds since the last fix."""
    error_m: float
    dead_reckoning_error_m: float
    """Error of dead reckoning from the last fix, by compass and speedometer, at the same instant."""


def estimates(steps: Sequence[Step], moments: Sequence[Moment]) -> tuple[PositionEstimate, ...]:
    """The estimates of an episode, in order, except those made while there was a fix.

    Args:
        steps: steps of the episode.
        moments: from departure to its end, in order.
    """
    found = []
    for before, step in pairwise(steps):
        action = step.action
        if action is None or action.action_type is not ActionType.ESTIMATE_POSITION:
            continue
        now = before.moment
        said = position(action.text or "")
        reckoned = reckon([moment for moment in moments if moment.time_s <= now.time_s])
        if said is None or reckoned is None or now.gps is None or now.gps.has_fix:
            continue
        found.append(
            PositionEstimate(
                step.number,
                now.gps.age_s,
                _off_m(now, *said),
                _off_m(now, reckoned.lon_deg, reckoned.lat_deg),
            )
        )
    return tuple(found)


def _off_m(moment: Moment, lon_deg: float, lat_deg: float) -> float:
    truth = moment.driving
    assert truth.lon_deg is not None
    assert truth.lat_deg is not None
    east_m = ((lon_deg - truth.lon_deg + 180) % 360 - 180) * metres_per_degree_east(truth.lat_deg)
    north_m = (lat_deg - truth.lat_deg) * METRES_PER_DEGREE
    return float((east_m**2 + north_m**2) ** 0.5)
