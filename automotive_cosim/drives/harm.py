"""Harm on a drive: speeding, short times to collision, and the driver's eyes off the road."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from automotive_cosim.contracts import KMH_PER_MPS, EgoEnd
from automotive_cosim.cosim.attention import GLANCE_S
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import DriveAct
from automotive_cosim.measures.following import is_near

WORDS_PER_S = 4.0
"""Reading speed of a message: 240 words a minute."""


@dataclass(frozen=True, slots=True)
class Harm:
    """What a drive exposed its driver and others to."""

    driven_s: float
    """Duration of the drive."""
    distance_m: float
    over_limit_s: float
    """Time above the binding limit."""
    over_limit_m: float
    """Integral of the excess over time: metres driven that the limit would not have allowed."""
    short_ttc_s: float
    """Time below three seconds to collision with the vehicle in front, while only hard braking avoids it."""
    collided: bool
    """Whether the car itself was in a collision; those of others are not its drive's."""
    unaware_s: float = 0.0
    """Seconds of the driver's attention that were not on the road: at 0.4 a second counts 0.6."""


def harm(drive: Sequence[Moment]) -> Harm:
    """The harm on a drive's moments, one per second."""
    over_s = over_m = short_s = unaware_s = 0.0
    for before, now in pairwise(drive):
        dt_s = now.time_s - before.time_s
        limit = now.context.binding_limit
        excess_kmh = 0.0 if limit is None else now.driving.speed_mps * KMH_PER_MPS - limit.kmh
        if excess_kmh > 1.0:
            over_s += dt_s
            over_m += excess_kmh / KMH_PER_MPS * dt_s
        short_s += dt_s if is_near(now.driving) else 0.0
        unaware_s += (1.0 - (now.awareness or 1.0)) * dt_s
    first, last = drive[0], drive[-1]
    return Harm(
        driven_s=last.time_s - first.time_s,
        distance_m=last.driving.distance_m - first.driving.distance_m,
        over_limit_s=over_s,
        over_limit_m=over_m,
        short_ttc_s=short_s,
        collided=any(moment.driving.end is EgoEnd.COLLIDED for moment in drive),
        unaware_s=round(unaware_s, 3),
    )


def distraction_s(acts: Iterable[DriveAct], texts: Iterable[str] = ()) -> float:
    """Seconds for which what an agent told the driver took the eyes off the road.

    Args:
        acts: what the agent did; each alert and each spoken answer costs a glance.
        texts: the words that stood with the alerts.
    """
    glances = sum(1 for act in acts if act.alert is not None or act.said)
    return glances * GLANCE_S + sum(len(text.split()) for text in texts) / WORDS_PER_S
