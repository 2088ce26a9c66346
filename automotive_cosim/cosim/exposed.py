"""A drive in stretches of unchanged conditions, for its exposure; and every step of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from automotive_cosim.contracts import KMH_PER_MPS, DrivingState, Weather
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.sun import Darkness, elevation_deg
from automotive_cosim.geo.weather import FOG_BELOW_M
from automotive_cosim.measures.exposure import DriveStretch

UNKNOWN = "unknown"


def states_of(moments: Sequence[Moment]) -> list[DrivingState]:
    """Every step of a drive, from the first moment on; none of a drive that never began."""
    first = [moment.driving for moment in moments[:1]]
    return first + [state for moment in moments[1:] for state in moment.passed]


def stretches(moments: Sequence[Moment]) -> Iterator[DriveStretch]:
    """The stretches between moments; a stretch has the conditions and the speed of its end."""
    for before, now in pairwise(moments):
        state, seconds = now.driving, now.time_s - before.time_s
        metres = max(0.0, state.distance_m - before.driving.distance_m)
        kmh = metres / seconds * KMH_PER_MPS if seconds > 0 else 0.0
        yield DriveStretch(seconds, metres, kmh, state.road.road_class, weather_class(now.weather), _light(now))


def weather_class(weather: Weather) -> str:
    """``fog``, ``snow or ice``, ``rain`` or ``dry``, by visibility and WMO 4677."""
    code = weather.weather_code
    if weather.visibility < FOG_BELOW_M or code in (45, 48):
        return "fog"
    if code in (56, 57, 66, 67, *range(71, 78), 85, 86):
        return "snow or ice"
    return "rain" if weather.precipitation > 0 or 51 <= code <= 99 else "dry"


def _light(moment: Moment) -> str:
    """``day``, ``twilight`` or ``night``, by the sun."""
    state = moment.driving
    if state.lat_deg is None or state.lon_deg is None:
        return UNKNOWN
    darkness = Darkness.at(elevation_deg(state.lat_deg, state.lon_deg, moment.local_time))
    return str(darkness) if darkness in (Darkness.DAY, Darkness.NIGHT) else "twilight"
