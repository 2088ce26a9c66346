"""Geo controls: the same instance with other information about place, to measure what place is worth.

| ``--geo`` | GPS | context and queries |
|---|---|---|
| ``full`` | the car's | the car's |
| ``gps`` | the car's | withheld |
| ``context`` | withheld, also its line in the context | the car's |
| ``wrong`` | another country's | the other country's, the same in both halves of a pair |
| ``irrelevant`` | withheld | a text about bees, as long as the context would be; no queries |
| ``none`` | withheld | withheld |

An agent never gets more than the channels it wants; road, cockpit and judgement are the same under all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import cycle, islice
from typing import Protocol
from zoneinfo import ZoneInfo

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    Around,
    DrivingState,
    GpsFix,
    Limit,
    LimitSource,
    Observation,
    RoadAhead,
    RoadHere,
    Weather,
)
from automotive_cosim.contracts.given import PLACE as PLACE
from automotive_cosim.contracts.given import GeoInput as GeoInput
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.locate import Geo
from automotive_cosim.interface.observe import context_text


class Shown(Protocol):
    """Turns the receivers' readings into the agent's observation."""

    def observation(self, observation: Observation, moment: Moment) -> Observation:
        """The observation of that moment with its place replaced."""
        ...

    def moments(self, moments: Sequence[Moment]) -> Sequence[Moment]:
        """The drive as the virtual sensor sees it."""
        ...


def shown(control: GeoInput, geo: Geo, first: Moment) -> Shown:
    """The effect of a control on the observations of a drive.

    Args:
        geo: makes the context of another place.
    """
    if control is GeoInput.WRONG:
        return _Elsewhere(geo, first)
    return _Irrelevant() if control is GeoInput.IRRELEVANT else _AsItIs()


class _AsItIs:
    def observation(self, observation: Observation, moment: Moment) -> Observation:
        return observation

    def moments(self, moments: Sequence[Moment]) -> Sequence[Moment]:
        return moments


class _Irrelevant(_AsItIs):
    def observation(self, observation: Observation, moment: Moment) -> Observation:
        if observation.context is None:
            return observation
        return replace(observation, context=unrelated(len(observation.context)))


@dataclass(frozen=True, slots=True)
class _Spot:
    """Somewhere else: a road with its limit, and the sky over it."""

    country: str
    zone: str
    lon_deg: float
    lat_deg: float
    road: RoadHere
    weather: Weather


def _highway(name: str, limit_kmh: float) -> RoadHere:
    return RoadHere(
        edge_id="",
        lane_id="",
        lane_index=0,
        lane_count=1,
        lane_position_m=0.0,
        name=name,
        road_class="trunk",
        limit=Limit(limit_kmh / KMH_PER_MPS, LimitSource.POSTED),
        in_tunnel=False,
        lit=False,
        built_up=False,
        centre_line=None,
        friction=1.0,
    )


CLEAR = Weather(21.0, 45.0, 0.0, 0, 5.0, 30_000.0, 8.0)
SPOTS = (
    _Spot("ZA", "Africa/Johannesburg", 22.30, -32.10, _highway("N1", 120.0), CLEAR),
    _Spot("ES", "Europe/Madrid", -2.86, 39.16, _highway("N-301", 90.0), CLEAR),
)
"""Plain open roads; the first one outside the car's own country is used. No scenario lies in the first one's
country, so both halves of a pair get the same place."""


class _Elsewhere:
    """The drive moved as a whole to another place, with road and sky as they are there."""

    def __init__(self, geo: Geo, first: Moment) -> None:
        self._geo = geo
        self._spot = next(spot for spot in SPOTS if spot.country != first.context.country)
        self._origin = first.gps
        self._known: dict[float, Moment] = {}

    def observation(self, observation: Observation, moment: Moment) -> Observation:
        there = self._moved(moment)
        return replace(
            observation,
            gps=None if observation.gps is None else there.gps,
            context=None
            if observation.context is None
            else context_text(there.context, with_position=observation.gps is not None),
        )

    def moments(self, moments: Sequence[Moment]) -> Sequence[Moment]:
        return [self._moved(moment) for moment in moments]

    def _moved(self, moment: Moment) -> Moment:
        if moment.time_s not in self._known:
            spot = self._spot
            driving = _alone(moment.driving, spot.road)
            gps = self._fix(moment.gps)
            local_time = moment.local_time.replace(tzinfo=ZoneInfo(spot.zone))
            self._known[moment.time_s] = replace(
                moment,
                driving=driving,
                gps=gps,
                weather=spot.weather,
                local_time=local_time,
                context=self._geo.locate(driving, gps, spot.weather, local_time),
            )
        return self._known[moment.time_s]

    def _fix(self, fix: GpsFix | None) -> GpsFix | None:
        if fix is None or self._origin is None:
            return None
        return replace(
            fix,
            lon_deg=self._spot.lon_deg + fix.lon_deg - self._origin.lon_deg,
            lat_deg=self._spot.lat_deg + fix.lat_deg - self._origin.lat_deg,
        )


def _alone(driving: DrivingState, road: RoadHere) -> DrivingState:
    """The same motion on an empty road."""
    left_m = driving.ahead.route_left_m
    ahead = RoadAhead(left_m, left_m / 25.0, 0.0, 1.0, None, 0.0, None, None, None, None, None)
    return replace(driving, road=road, ahead=ahead, around=Around(None, None, None, None, 1.0))


# --- words about something else ---------------------------------------------------------------------------

BEES = """\
A honeybee colony winters as a cluster, a ball of workers around the queen that shivers to keep its middle warm.
In early spring she lays her first eggs of the year into cells that were polished for her.
An egg stands upright for three days, then a larva hatches and is fed by nurses on a jelly from their glands.
Workers change their trade as they age: cleaner, nurse, builder, guard, and forager at the last.
Wax leaves the body in small scales, which are chewed until they are soft enough for a comb.
Each cell of a comb is a hexagon, tilted up a little so that honey does not run out.
A forager who has found blossoms dances on the comb, and her sisters learn from it where to look.
Nectar is carried home in a crop, handed from mouth to mouth and fanned until most of the water is gone.
Pollen is kept beside the brood, pressed into cells with the head and covered with a drop of honey.
Drones have large eyes, no sting and no work; in autumn they are shown out.
When a nest becomes crowded the workers raise new queens, and the old one leaves with half of them.
A swarm hangs in a tree for some hours while scouts compare hollow trunks and agree on one of them.
"""


def unrelated(length: int) -> str:
    """Exactly ``length`` characters about bees, over and over."""
    return "".join(islice(cycle(BEES), length))
