"""The timeline of a drive: what its road, its car, its driver and its agent did, second by second, as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from automotive_cosim.cockpit.signals import LIGHTS
from automotive_cosim.contracts import KMH_PER_MPS, Json
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.driver import DRIVES_ON, HEEDS, RELEASED, driver_events
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.geo.breaches import limit_at

LAMPS = {
    "dipped": LIGHTS.LOW_BEAM,
    "high": LIGHTS.HIGH_BEAM,
    "front_fog": LIGHTS.FRONT_FOG,
    "rear_fog": LIGHTS.REAR_FOG,
    "hazard": LIGHTS.HAZARD,
}


def timeline(session: DriveSession) -> Json:
    """The timeline of a session that is over; times in seconds since departure.

    | key | one value a second, or one entry each |
    |---|---|
    | ``time_s``, ``speed_kmh``, ``limit_kmh`` | of the drive; no limit is None |
    | ``baseline_kmh`` | speed of the do-nothing run |
    | ``gap_s``, ``ttc_s`` | time gap and time to collision to the vehicle ahead; None without one |
    | ``awareness`` | of the driver; not there unless it is limited |
    | ``visibility_m``, ``grip`` | of air and road |
    | ``lamps`` | names of the lamps that are on |
    | ``wakes`` | time and names of the readings that changed, and ended a wait |
    | ``driver`` | time and words of what the driver did after a request |
    | ``advice`` | from when to when the driver kept to what was advised |
    | ``watched_until_s`` | from then on nobody watched; None if somebody did to the end |
    """
    moments, begun_s = session.moments, session.moments[0].time_s

    def since(time_s: float) -> float:
        return round(time_s - begun_s, 1)

    def each(of: Any) -> list[Any]:
        return [of(moment) for moment in moments]

    limits = [limit_at(moment.context).kmh for moment in moments]
    unwatched_s = session.unwatched_from_s
    return {
        "time_s": each(lambda now: since(now.time_s)),
        "speed_kmh": each(_kmh),
        "limit_kmh": [None if limit is None else round(limit, 1) for limit in limits],
        "baseline_kmh": [_kmh(moment) for moment in session.baseline_moments],
        "gap_s": each(_gap_s),
        "ttc_s": each(_ttc_s),
        **({} if moments[0].awareness is None else {"awareness": each(lambda now: now.awareness)}),
        "visibility_m": each(lambda now: round(now.weather.visibility)),
        "grip": each(lambda now: round(now.driving.road.friction, 2)),
        "lamps": each(lambda now: [name for name, lamp in LAMPS.items() if now.signals[lamp.path]]),
        "wakes": [[since(time_s), list(names)] for time_s, names in session.woken],
        "driver": [[since(event.time_s), event.text] for event in driver_events(moments)],
        "advice": [[since(from_s), since(to_s)] for from_s, to_s in _advice(moments)],
        "watched_until_s": unwatched_s,
    }


def _kmh(moment: Moment) -> float:
    return round(moment.driving.speed_mps * KMH_PER_MPS, 1)


def _gap_s(moment: Moment) -> float | None:
    leader, mps = moment.driving.around.leader, moment.driving.speed_mps
    return None if leader is None or mps < 1.0 else round(leader.gap_m / mps, 2)


def _ttc_s(moment: Moment) -> float | None:
    leader = moment.driving.around.leader
    ttc_s = None if leader is None else leader.time_to_collision_s
    return None if ttc_s is None else round(ttc_s, 2)


def _advice(moments: Sequence[Moment]) -> Iterator[tuple[float, float]]:
    """From the first thing that the driver heeds until the release."""
    from_s: float | None = None
    for event in driver_events(moments):
        if event.kind in HEEDS:
            from_s = event.time_s if from_s is None else from_s
        elif event.kind in (RELEASED, DRIVES_ON) and from_s is not None:
            yield from_s, event.time_s
            from_s = None
    if from_s is not None:
        yield from_s, moments[-1].time_s
