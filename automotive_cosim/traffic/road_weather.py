"""The effect of weather on driving: grip, speed choice, gaps and visibility, for the ego's driver and all others.

Posted limits do not change. SUMO's own friction only lowers the desired speed, so braking is set here too: no
vehicle brakes harder than ``friction * g``, which gives physical stopping distances, v^2 / (2 friction g).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Container
from dataclasses import dataclass, replace

from automotive_cosim.contracts import Weather
from automotive_cosim.formats.scenario import WeatherAt, weather_at
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.sumo import DesiredSpeed, LibSumo

G_MPS2 = 9.81

FOG_BELOW_M = 1000.0
"""WMO: fog is visibility under one kilometre."""

HEAVY_RAIN_FROM_MM_PER_H = 7.6
"""American Meteorological Society, Glossary of Meteorology, "rain"."""

LOSS_PER_KELVIN = 0.0023
"""Asphalt loses 0.232 BPN, hundredths of friction, per kelvin (Bazlamit and Reza, J. Transp. Eng. 131 (2005))."""

FASTEST_MPS = 100.0
"""Nobody drives as fast: sight that allows it limits nobody."""

WARM_FROM_C = 20.0
"""Reference temperature of friction tests."""

WORSE_THAN_WET = 0.7
"""Friction below this is of no wet road, but of one that goes over to slush or ice. A driver who has been warned
keeps to the warning from here on, because it may come before it is due."""
ICY = 0.5
"""Friction below this is of snow, slush and ice, also of loose snow (see below): from here on a warning is due."""

GRIP_STEP_S = 5.0
"""How often a road that takes on another grip changes."""

REACTION_S = 2.5
COMFORTABLE_MPS2 = 3.4
"""Reaction time and deceleration of stopping sight distances in AASHTO's Green Book."""


@dataclass(frozen=True, slots=True)
class RoadCondition:
    """How to drive a road; the ratios are relative to a dry road in clear air."""

    friction: float = 1.0
    """Friction; 1 is dry, as in SUMO."""
    speed_ratio: float = 1.0
    headway_ratio: float = 1.0
    sight_mps: float = math.inf
    """Speed from which a driver can stop within the visibility."""
    weather: str = ""
    """``"wet"`` or ``"snow"``, for signs that hold in that weather only."""

    @property
    def is_felt(self) -> bool:
        """Whether anybody drives otherwise than on a dry road in clear air."""
        return (self.friction, self.speed_ratio, self.headway_ratio) != (1, 1, 1) or self.sight_mps < FASTEST_MPS


DRY = RoadCondition()

# Friction: Wallman and Astrom, "Friction measurement methods and the correlation between road friction and
# traffic safety" (VTI meddelande 911A, 2001): dry 0.8 to 1.0, wet 0.7 to 0.8, packed snow 0.20 to 0.30, loose snow
# and slush 0.20 to 0.50, black ice 0.15 to 0.30, wet ice 0.05 to 0.10. Dust on asphalt is our choice.
# Speed and headway: FHWA Road Weather Management Program, "How Do Weather Events Impact Roads?": freeway speeds
# fall by 3 to 13 % in light rain or snow, 3 to 16 % in heavy rain, 5 to 40 % in heavy snow, 10 to 12 % in low
# visibility; capacities by 4 to 11, 10 to 30, 12 to 27 and 12 %. The middle is used; the headway is the
# capacity's inverse.
LIGHT, HEAVY_RAIN, HEAVY_SNOW, LOW_VISIBILITY = (
    (0.92, 1 / 0.925),
    (0.905, 1 / 0.80),
    (0.775, 1 / 0.805),
    (0.89, 1 / 0.88),
)

_OF_CODES: dict[frozenset[int], tuple[float, tuple[float, float]]] = {
    frozenset((51, 53, 55, 61, 63, 80, 81)): (0.75, LIGHT),
    frozenset((65, 82, 95, 96, 99)): (0.7, HEAVY_RAIN),
    frozenset((71, 73, 77, 85)): (0.35, LIGHT),
    frozenset((75, 86)): (0.25, HEAVY_SNOW),
    frozenset((48, 56, 57, 66, 67)): (0.15, HEAVY_SNOW),
    frozenset((7,)): (0.9, LIGHT),
    frozenset((31,)): (0.6, LOW_VISIBILITY),
}
"""Friction, and the ratios of speed and headway, of weather codes (WMO 4677; freezing rain and rime are ice)."""


SNOW_CODES = frozenset((71, 73, 75, 77, 85, 86))
WET_CODES = frozenset((51, 53, 55, 56, 57, 61, 63, 65, 66, 67, 80, 81, 82, 95, 96, 99))
"""Weather codes in which limits for snow or for the wet are in force."""


def condition_of(weather: Weather) -> RoadCondition:
    """The condition of an open road in some weather."""
    friction, ratios = 1.0, (1.0, 1.0)
    for codes, effect in _OF_CODES.items():
        if weather.weather_code in codes:
            friction, ratios = effect
    if ratios is LIGHT and friction > 0.5 and weather.precipitation >= HEAVY_RAIN_FROM_MM_PER_H:
        friction, ratios = 0.7, HEAVY_RAIN
    if weather.visibility < FOG_BELOW_M:
        ratios = (min(ratios[0], LOW_VISIBILITY[0]), max(ratios[1], LOW_VISIBILITY[1]))
    hot = max(0.0, weather.temperature_2m - WARM_FROM_C)
    friction = min(friction, 1.0 - LOSS_PER_KELVIN * hot)
    sign = "snow" if weather.weather_code in SNOW_CODES else "wet" if weather.weather_code in WET_CODES else ""
    return RoadCondition(friction, *ratios, sight_speed_mps(weather.visibility, friction), sign)


def sight_speed_mps(visibility_m: float, friction: float) -> float:
    """The speed from which a driver stops within the visibility: v t + v^2 / 2b, as in AASHTO."""
    braking_mps2 = min(COMFORTABLE_MPS2, friction * G_MPS2)
    return braking_mps2 * (-REACTION_S + math.sqrt(REACTION_S**2 + 2 * visibility_m / braking_mps2))


def felt(timeline: tuple[WeatherAt, ...]) -> tuple[tuple[float, RoadCondition], ...]:
    """What a timeline is on the road: two that are the same drive alike. Sight that limits nobody is as good as
    any."""
    found = ((entry.at_s, condition_of(entry.weather)) for entry in timeline)
    return tuple(
        (at_s, replace(condition, sight_mps=math.inf) if condition.sight_mps >= FASTEST_MPS else condition)
        for at_s, condition in found
    )


class Forecast:
    """A timeline of weather as conditions of the road."""

    def __init__(self, timeline: tuple[WeatherAt, ...], departure_s: float, settles_s: float = 0.0) -> None:
        """Takes a timeline in seconds after ``departure_s``; an empty one is always dry.

        Args:
            departure_s: simulation time of its beginning.
            settles_s: over how long the road takes on the grip of other weather."""
        self._timeline = timeline
        self._departure_s = departure_s
        self._settles_s = settles_s
        self.until_s = -math.inf
        """Simulation time up to which the last condition holds."""

    def read(self, time_s: float) -> RoadCondition:
        """The condition at a simulation time."""
        if not self._timeline:
            self.until_s = math.inf
            return DRY
        since_s = time_s - self._departure_s
        following = bisect_right([entry.at_s for entry in self._timeline], since_s)
        self.until_s = (
            math.inf if following == len(self._timeline) else self._departure_s + self._timeline[following].at_s
        )
        weather = weather_at(self._timeline, since_s)
        condition = condition_of(weather)
        friction = self._friction(since_s) if self._settles_s else condition.friction
        if friction == condition.friction:
            return condition
        self.until_s = min(self.until_s, time_s + GRIP_STEP_S)
        return replace(condition, friction=friction, sight_mps=sight_speed_mps(weather.visibility, friction))

    def _friction(self, since_s: float) -> float:
        """It goes from what it was when a weather set in to that of the weather, at a steady pace."""
        friction = condition_of(self._timeline[0].weather).friction
        ends_s = [*(entry.at_s for entry in self._timeline[1:]), math.inf]
        for entry, end_s in zip(self._timeline, ends_s, strict=True):
            if entry.at_s > since_s:
                break
            share = min(1.0, (min(since_s, end_s) - entry.at_s) / self._settles_s)
            friction += share * (condition_of(entry.weather).friction - friction)
        return round(friction, 3)


@dataclass(slots=True)
class _Type:
    """A vehicle type's parameters on a dry road."""

    deceleration_mps2: float
    emergency_mps2: float
    headway_s: float
    top_mps: float


class Surface:
    """Applies a condition to the road: the friction of the lanes, and the driving of all vehicles except the ego.

    Lanes in tunnels stay dry. Desired speeds are set per vehicle, the rest per type."""

    def __init__(
        self, sumo: LibSumo, network: Network, left_out: tuple[str, ...], drawn: Container[str] = ()
    ) -> None:
        """Starts dry.

        Args:
            left_out: types, or prefixes of their names, that stay unchanged.
            drawn: distributions, which SUMO lists among the types, and which stay unchanged too, as does everybody
                in weather that is not felt."""
        self._sumo = sumo
        self._left_out = left_out
        self._drawn = drawn
        self.condition = DRY
        self._tunnels = {lane for edge in network.edges.values() if edge.in_tunnel for lane in edge.lane_ids}
        self._types: dict[str, _Type] = {}
        self._factors: dict[str, float] = {}
        """Speed factor of each vehicle on a dry road, stored while the road is not dry."""

    def put(self, condition: RoadCondition) -> None:
        """Changes the condition for everything on the road."""
        if condition == self.condition:
            return
        if not (condition.is_felt or self.condition.is_felt):
            self.condition = condition
            return
        if condition.friction != self.condition.friction:
            for lane in (each for each in self._sumo.lane.getIDList() if each not in self._tunnels):
                self._sumo.lane.setFriction(lane, condition.friction)
        self.condition = condition
        for type_id in self._sumo.type.getIDList():
            if not type_id.startswith(self._left_out) and type_id not in self._drawn:
                self._treat(type_id)
        for vehicle in self._sumo.vehicle.getIDList():
            if not self._sumo.type_of(vehicle).startswith(self._left_out):
                self._slow(vehicle)

    def adopt(self, type_id: str) -> None:
        """Handles a type that was created after the condition was applied."""
        if self.condition != DRY:
            self._treat(type_id)

    def departed(self, vehicle: str) -> None:
        """Handles a vehicle that has entered the road."""
        if self.condition.speed_ratio != 1.0:
            self._slow(vehicle)

    def arrived(self, vehicle: str) -> None:
        """Handles a vehicle that has left the road."""
        self._factors.pop(vehicle, None)

    def wanted(self, vehicle: str) -> DesiredSpeed:
        """How fast a vehicle that has just departed wants to drive on a dry road."""
        dry = self._types.get(self._sumo.type_of(vehicle))
        of = self._sumo.vehicle
        return min(1.0, of.getSpeedFactor(vehicle)), of.getMaxSpeed(vehicle) if dry is None else dry.top_mps

    def _treat(self, type_id: str) -> None:
        kind, condition = self._sumo.type, self.condition
        dry = self._types.get(type_id)
        if dry is None:
            dry = self._types[type_id] = _Type(
                kind.getDecel(type_id),
                kind.getEmergencyDecel(type_id),
                kind.getTau(type_id),
                kind.getMaxSpeed(type_id),
            )
        hardest_mps2 = condition.friction * G_MPS2
        kind.setDecel(type_id, min(dry.deceleration_mps2, hardest_mps2))
        kind.setApparentDecel(type_id, min(dry.deceleration_mps2, hardest_mps2))
        kind.setEmergencyDecel(type_id, min(dry.emergency_mps2, hardest_mps2))
        kind.setTau(type_id, dry.headway_s * condition.headway_ratio)
        kind.setMaxSpeed(type_id, min(dry.top_mps, condition.sight_mps))

    def _slow(self, vehicle: str) -> None:
        factor = self._factors.get(vehicle)
        if factor is None:
            factor = self._factors[vehicle] = self._sumo.vehicle.getSpeedFactor(vehicle)
        self._sumo.set_speed_factor(vehicle, factor * self.condition.speed_ratio)
