"""Triggers: the situation on the road that starts a task. Pure predicates on one moment, without effects.

Conditions can be compared and stored; ``str`` describes them in words. One about something that does not exist (no
leader, no limit, no place) does not hold. A new one is a function here, by whose name tasks ask for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Concatenate, ParamSpec, Protocol

from annotated_types import Ge, Gt

from automotive_cosim.cockpit.restrictions import Motion, motion
from automotive_cosim.cockpit.signals import ENERGY, MOTION, Signal
from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.named import ROWS, Named, Wording, keep

WALKING_MPS = 2.0
STANDING_MPS = 0.1
ANY = 1e9
"""Larger than any distance, speed or amount."""

P = ParamSpec("P")


class TriggerCondition(Protocol):
    """A predicate on one moment."""

    def __call__(self, moment: Moment) -> bool:
        """Whether it holds at a moment."""
        ...


@dataclass(frozen=True, slots=True)
class Trigger:
    """The situation that starts a task: ``condition`` has held for ``for_s`` without interruption."""

    condition: TriggerCondition
    for_s: Annotated[float, Ge(0)]
    within_s: Annotated[float, Gt(0)]
    """Simulated seconds from departure after which the trigger counts as not reached."""
    after_s: float = 0.0
    """Simulated seconds from departure before which it does not count: with it, both halves of a pair have been
    under way equally long, and clock, cabin and battery tell nothing."""


@dataclass(frozen=True, slots=True)
class All:
    """All of the conditions hold."""

    conditions: tuple[TriggerCondition, ...]

    def __call__(self, moment: Moment) -> bool:
        return all(condition(moment) for condition in self.conditions)

    def __str__(self) -> str:
        return ", ".join(map(str, self.conditions))


@dataclass(frozen=True, slots=True)
class Not:
    """The condition does not hold."""

    condition: TriggerCondition

    def __call__(self, moment: Moment) -> bool:
        return not self.condition(moment)

    def __str__(self) -> str:
        return f"not: {self.condition}"


@dataclass(frozen=True, slots=True)
class Situation(Named):
    """A condition with its values."""

    def __call__(self, moment: Moment) -> bool:
        return ROWS[self.name].holds(moment, *self.values)


def situation(words: Wording) -> Callable[[Callable[Concatenate[Moment, P], bool]], Callable[P, Situation]]:
    """Makes a condition of a predicate, which then takes its values and gives the ``Situation`` with them."""
    return lambda holds: keep(Situation, holds, 1, words, lambda *values: frozenset())


# --- how the car moves ---


@situation("{signal.path} above {value:g}")
def signal_above(moment: Moment, signal: Signal[float], value: float) -> bool:
    """A numeric signal is greater than ``value``, e.g. the fog on a window."""
    return float(moment.signals[signal.path]) > value


@situation("{signal.path} below {value:g}")
def signal_below(moment: Moment, signal: Signal[float], value: float) -> bool:
    """A numeric signal is less than ``value``, e.g. the battery's level."""
    return float(moment.signals[signal.path]) < value


@situation(lambda signal, value: f"{signal.path} is {'empty' if value == '' else value}")
def signal_has(moment: Moment, signal: Signal[Any], value: Any) -> bool:
    """A signal has that value, e.g. a lamp that is on."""
    return bool(moment.signals[signal.path] == value)


@situation("the car is driving")
def driving(moment: Moment) -> bool:
    """The ego is driving, faster than walking pace."""
    return moment.driving.speed_mps > WALKING_MPS


@situation("the car is parked")
def parked(moment: Moment) -> bool:
    """The ego is in park."""
    return (
        motion(moment.signals[MOTION.GEAR.path], moment.signals[MOTION.SPEED.path]) is Motion.PARKED
        and moment.driving.speed_mps < STANDING_MPS
    )


@situation("the car is stationary")
def standing(moment: Moment) -> bool:
    """The ego is stationary, in gear or not."""
    return moment.driving.speed_mps < STANDING_MPS


def _speed_above(speed_kmh: float, limit_from_kmh: float, limit_to_kmh: float) -> str:
    limits = f"{limit_from_kmh:g}"
    if limit_to_kmh != limit_from_kmh:
        limits += f" to {limit_to_kmh:g}"
    return f"faster than {speed_kmh:g} km/h where {limits} km/h are posted"


@situation(_speed_above)
def speed_above(moment: Moment, speed_kmh: float, limit_from_kmh: float, limit_to_kmh: float) -> bool:
    """Faster than a speed, on a road with a posted limit in a range (km/h, inclusive)."""
    limit_mps = moment.driving.road.limit.posted_mps
    return (
        moment.driving.speed_mps * KMH_PER_MPS > speed_kmh
        and limit_mps is not None
        and limit_from_kmh <= round(limit_mps * KMH_PER_MPS, 1) <= limit_to_kmh
    )


def _speed_between(from_kmh: float, to_kmh: float = ANY) -> str:
    if to_kmh == ANY:
        return f"faster than {from_kmh:g} km/h"
    return f"{max(from_kmh, 0):g} to {to_kmh:g} km/h"


@situation(_speed_between)
def speed_between(moment: Moment, from_kmh: float, to_kmh: float = ANY) -> bool:
    """Faster than one speed and not faster than another, whatever is posted."""
    return from_kmh < moment.driving.speed_mps * KMH_PER_MPS <= to_kmh


# --- the road that the car is on, and what comes next on it ---


@situation("no limit is posted")
def unposted(moment: Moment) -> bool:
    """No limit is posted here."""
    return moment.context.posted_limit_kmh is None


@situation(lambda classes: f"on a {' or '.join(classes)} road")
def on_road_class(moment: Moment, classes: tuple[str, ...]) -> bool:
    """On a road of one of these classes (OSM highway values)."""
    return moment.driving.road.road_class in classes


@situation("on {name}")
def on_street(moment: Moment, name: str) -> bool:
    """On the street with this name."""
    return moment.driving.road.name == name


@situation(lambda lit: "on a lit road" if lit else "on an unlit road")
def lit(moment: Moment, lit: bool = True) -> bool:
    """The road is lit, or unlit, according to the map."""
    return moment.driving.road.lit is lit


@situation(lambda built_up: "in a built-up area" if built_up else "outside built-up areas")
def built_up(moment: Moment, built_up: bool = True) -> bool:
    """In a built-up area, or outside."""
    return moment.context.built_up is built_up


@situation(lambda there: f"on a road {'with' if there else 'without'} a centre line")
def centre_line(moment: Moment, there: bool) -> bool:
    """The road has a centre line, or has none."""
    return moment.driving.road.centre_line is there


@situation("{count} lanes or more")
def lanes(moment: Moment, count: int) -> bool:
    """At least a number of lanes in the ego's direction."""
    return moment.driving.road.lane_count >= count


@situation("in a tunnel")
def in_tunnel(moment: Moment) -> bool:
    """In a tunnel."""
    return moment.driving.road.in_tunnel


@situation(lambda in_force: f"in a school zone {'in' if in_force else 'outside'} its hours")
def in_school_zone(moment: Moment, in_force: bool = True) -> bool:
    """In a school zone whose limit is in force at the local time, or outside its hours."""
    road = moment.driving.road
    return road.school_zone and (road.limit_by_clock or not road.limit_hours) == in_force


@situation("{seconds:g} s before a tunnel")
def tunnel_within(moment: Moment, seconds: float) -> bool:
    """The route enters a tunnel within a number of seconds at the present speed."""
    away_m, speed_mps = moment.driving.ahead.tunnel_distance_m, moment.driving.speed_mps
    return away_m is not None and not moment.driving.road.in_tunnel and 0 < away_m <= seconds * max(speed_mps, 1)


@situation("a tunnel on the route")
def tunnel_on_route(moment: Moment) -> bool:
    """A tunnel lies on the rest of the route, however far."""
    return moment.driving.road.in_tunnel or moment.driving.ahead.tunnel_distance_m is not None


@situation("a lower limit posted within {distance_m:g} m")
def lower_limit_within(moment: Moment, distance_m: float) -> bool:
    """A lower limit is posted within that distance on the route."""
    here, ahead = moment.driving.road.limit, moment.driving.ahead
    following_mps = None if ahead.next_limit is None else ahead.next_limit.posted_mps
    return (
        following_mps is not None
        and ahead.next_limit_distance_m is not None
        and ahead.next_limit_distance_m <= distance_m
        and (here.mps is None or following_mps < here.mps)
    )


@situation("the remaining route is longer than the range")
def out_of_range(moment: Moment) -> bool:
    """The battery does not last to the destination."""
    return float(moment.signals[ENERGY.RANGE.path]) < moment.driving.ahead.route_left_m


@situation("grip below {friction:g}")
def less_grip_than(moment: Moment, friction: float) -> bool:
    """The lane's friction coefficient is below a value; 1 is dry."""
    return moment.driving.road.friction < friction


# --- other vehicles on the road ---


@situation("less than {seconds:g} s behind the car in front")
def headway_below(moment: Moment, seconds: float) -> bool:
    """Closer behind the leader than a number of seconds, while moving."""
    leader, speed_mps = moment.driving.around.leader, moment.driving.speed_mps
    return leader is not None and speed_mps > WALKING_MPS and leader.gap_m < seconds * speed_mps


@situation("a car in front within {distance_m:g} m")
def leader_within(moment: Moment, distance_m: float) -> bool:
    """A vehicle in front within a distance."""
    leader = moment.driving.around.leader
    return leader is not None and leader.gap_m <= distance_m


@situation("within {distance_m:g} m a vehicle in front at {speed_kmh:g} km/h or less")
def slow_leader_within(moment: Moment, speed_kmh: float, distance_m: float) -> bool:
    """A vehicle in front, slow or stationary, within a distance."""
    leader = moment.driving.around.leader
    return leader is not None and leader.gap_m <= distance_m and leader.speed_mps * KMH_PER_MPS <= speed_kmh


@situation("a {kind} in front within {distance_m:g} m")
def leader_is(moment: Moment, kind: str, distance_m: float) -> bool:
    """A vehicle of a class of SUMO's (``passenger``, ``truck``, ``delivery``) in front within a distance."""
    leader = moment.driving.around.leader
    return leader is not None and leader.kind == kind and leader.gap_m <= distance_m


@situation(
    lambda distance_m, lit: f"in front within {distance_m:g} m, brake lamps that are {'lit' if lit else 'dark'}"
)
def leader_brakes(moment: Moment, distance_m: float, lit: bool = True) -> bool:
    """A vehicle in front within a distance, whose brake lamps are lit, or are not."""
    leader = moment.driving.around.leader
    return leader is not None and leader.is_braking is lit and leader.gap_m <= distance_m


@situation("an oncoming car within {distance_m:g} m")
def oncoming_within(moment: Moment, distance_m: float) -> bool:
    """An oncoming vehicle within a distance."""
    oncoming = moment.driving.around.oncoming
    return oncoming is not None and oncoming.gap_m <= distance_m


@situation("a blue light behind within {distance_m:g} m")
def blue_light_within(moment: Moment, distance_m: float) -> bool:
    """An emergency vehicle with its blue lights on, behind within a distance."""
    behind = moment.driving.around.emergency_behind
    return behind is not None and behind.gap_m <= distance_m


@situation("a jam {from_m:g} to {to_m:g} m ahead")
def jam_within(moment: Moment, to_m: float, from_m: float = 0.0) -> bool:
    """A jam on the route with its tail between two distances; 0 is in the jam."""
    away_m = moment.driving.ahead.jam_distance_m
    return away_m is not None and from_m <= away_m <= to_m


@situation("more than {seconds:g} s of delay on the route")
def delay_above(moment: Moment, seconds: float) -> bool:
    """The route takes longer than at free flow, by a number of seconds."""
    return moment.driving.ahead.delay_s > seconds


@situation("another route saves {saves_s:g} s")
def other_way_known(moment: Moment, saves_s: float = 0.0) -> bool:
    """The navigation knows another route that saves a number of seconds (if negative, costs no more than that)."""
    ahead = moment.driving.ahead
    return any(ahead.eta_s - way.eta_s > saves_s for way in ahead.alternatives)


@situation("traffic at less than {share:.0%} of the limit")
def flow_below(moment: Moment, share: float) -> bool:
    """Traffic on the ego's road is slower than a share of its limit."""
    return moment.driving.around.relative_speed < share


@situation("a red light within {within_m:g} m")
def red_light(moment: Moment, within_m: float) -> bool:
    """The next signal on the route shows red, within a distance."""
    light = moment.driving.ahead.next_light
    return light is not None and light.state in "rR" and light.distance_m <= within_m


@situation("a green light within {within_m:g} m")
def green_light(moment: Moment, within_m: float) -> bool:
    """The next signal on the route shows green, within a distance."""
    light = moment.driving.ahead.next_light
    return light is not None and light.state in "gG" and light.distance_m <= within_m


# --- sky, place, position fix and connection ---


@situation(lambda from_m, to_m: "visibility " + _range(from_m, to_m, "m"))
def visibility_between(moment: Moment, from_m: float, to_m: float) -> bool:
    """Visibility within a range in metres, the upper end excluded."""
    return from_m <= moment.weather.visibility < to_m


@situation(lambda from_mm_h, to_mm_h: _range(from_mm_h, to_mm_h, "mm/h") + " of rain or snow")
def rain_between(moment: Moment, from_mm_h: float, to_mm_h: float = ANY) -> bool:
    """Precipitation within a range in mm/h, the upper end excluded."""
    return from_mm_h <= moment.weather.precipitation < to_mm_h


@situation("{from_c:g} to {to_c:g} degrees outside")
def air_between(moment: Moment, from_c: float, to_c: float) -> bool:
    """Outside temperature within a range in degrees Celsius, the upper end excluded."""
    return from_c <= moment.weather.temperature_2m < to_c


@situation(lambda dark: "in the dark" if dark else "by day")
def dark(moment: Moment, dark: bool = True) -> bool:
    """Between sunset and sunrise, or not."""
    return moment.context.sun is not None and moment.context.sun.is_set is dark


@situation("in {code}")
def in_country(moment: Moment, code: str) -> bool:
    """In a country (ISO 3166-1 code)."""
    return moment.context.country == code


@situation("no connection")
def offline(moment: Moment) -> bool:
    """The car has no link to the outside."""
    return not moment.connectivity.online


def _range(low: float, high: float, unit: str) -> str:
    return f"{low:g} {unit} or more" if high == ANY else f"{low:g} to {high:g} {unit}"
