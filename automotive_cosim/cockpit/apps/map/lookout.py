"""The lookout: what a current car notices and shows by itself, from its sensors, its map and its traffic service.

It states measurements and messages, whether or not anything follows from them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache

from automotive_cosim.cockpit.apps.cabin import KINDS, SEATS
from automotive_cosim.cockpit.flow import fill, framed, grid, line
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.notices import LOW_KPA
from automotive_cosim.cockpit.occupants import Kind, Seat, seated
from automotive_cosim.cockpit.sensor_range import BLUE_LIGHT_M, CAMERA_M, CLOSING_MPS, HORIZON_M, REAR_RADAR_M
from automotive_cosim.cockpit.signals import (
    ADAS,
    CABIN,
    CALL,
    DRIVER,
    ENERGY,
    HMI,
    MOTION,
    OCCUPANT,
    SEAT,
    TYRE,
    Signals,
)
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import distance, pressure, speed, speed_unit
from automotive_cosim.cockpit.widgets import Glyph, Label, Widget
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    DrivingState,
    IncidentKind,
    Limit,
    RoadIncident,
    Sight,
    SightKind,
)
from automotive_cosim.contracts.text import Text, say

LINE_PX, LINES = 38, 8
"""Height of a line on the screen, and how many there are room for."""
METRES_BELOW_M, FEET_BELOW_M, FOOT_M = 100.0, 300.0, 0.3048
"""Distances below are shown in metres or feet, others as on signs."""
ROUNDED_MPS = 2.0
"""By less than this a sign differs from the limit on the map where a network was moved to another country."""
ICONS: Mapping[SightKind, Icon] = {
    SightKind.DRIVER_BELT: Icon.SEAT_BELT,
    SightKind.PASSENGER_BELT: Icon.SEAT_BELT,
    SightKind.WITHOUT_DRIVER: Icon.CHILD,
    SightKind.PHONE: Icon.PHONE,
    SightKind.EYES: Icon.EYE,
    SightKind.TAILGATE: Icon.VEHICLE_FAULT,
    SightKind.CHARGE_FLAP: Icon.VEHICLE_FAULT,
    SightKind.TYRE: Icon.TYRE,
    SightKind.DRIVING_TIME: Icon.FATIGUE,
    SightKind.EMERGENCY_VEHICLE: Icon.AMBULANCE,
    SightKind.VEHICLE_BEHIND: Icon.VEHICLE,
    SightKind.VEHICLE_AHEAD: Icon.VEHICLE,
    SightKind.TUNNEL: Icon.TUNNEL,
    SightKind.LIMIT: Icon.SPEED,
    SightKind.SCHOOL_ZONE: Icon.SCHOOL,
    SightKind.JAM: Icon.JAM,
    SightKind.BREAKDOWN: Icon.HAZARD,
    SightKind.ROADWORKS: Icon.ROADWORKS,
    SightKind.CLOSURE: Icon.CLOSURE,
}
TYRE_NAMES = {
    TYRE.FRONT_LEFT: say("Front left tyre"),
    TYRE.FRONT_RIGHT: say("Front right tyre"),
    TYRE.REAR_LEFT: say("Rear left tyre"),
    TYRE.REAR_RIGHT: say("Rear right tyre"),
}
PHONE = {"HAND": say("Driver is holding a phone"), "CRADLE": say("Phone in use in its cradle")}
AHEAD: Mapping[SightKind, Callable[[str], Text]] = {
    SightKind.TUNNEL: lambda far: say("Tunnel in {distance}", distance=far),
    SightKind.SCHOOL_ZONE: lambda far: say("School zone in {distance}", distance=far),
    SightKind.JAM: lambda far: say("Traffic jam in {distance}", distance=far),
    SightKind.BREAKDOWN: lambda far: say("Broken-down vehicle in {distance}", distance=far),
    SightKind.ROADWORKS: lambda far: say("Roadworks in {distance}", distance=far),
    SightKind.CLOSURE: lambda far: say("Road closed in {distance}", distance=far),
}
WHO = {kind: name for kind, (name, _) in KINDS.items()} | {Kind.ELDERLY: say("Elderly")}


def sights(state: State) -> tuple[Sight, ...]:
    """What the car notices now: first what is aboard, then by distance. Empty without this equipment."""
    if not state.lookout or state.outside is None:
        return ()
    driving = state.outside.driving
    around = (*_behind(state, driving), *_ahead(state, driving, _starts_m(state, driving)))
    return (*_aboard(state), *sorted(around, key=lambda sight: sight.distance_m or 0.0))[:LINES]


@cache
def _unbuckled(seat: Seat) -> Sight:
    """The same one from second to second, as drives keep them."""
    return Sight(SightKind.PASSENGER_BELT, say("Seat belt unbuckled: {seat}", seat=SEATS[seat]))


def _aboard(state: State) -> Iterator[Sight]:
    signals = state.signals
    if not signals[SEAT.DRIVER_BELT] and signals[MOTION.GEAR] != "P":
        yield Sight(SightKind.DRIVER_BELT, say("Driver's seat belt unbuckled"))
    others = sorted(
        (one for one in seated(signals) if one.seat is not Seat.DRIVER), key=lambda one: not one.kind.needs_care
    )
    unbelted = [one for one in others if not one.belted]
    if unbelted and signals[MOTION.GEAR] != "P":
        yield _unbuckled(unbelted[0].seat)
    if state.parked_s is not None and not signals[OCCUPANT.DRIVER.occupied]:
        left = (
            say("Driver has left, aboard: {who}", who=WHO[others[0].kind])
            if others
            else say("Driver has left, nobody aboard")
        )
        yield Sight(SightKind.WITHOUT_DRIVER, left)
    if signals[CALL.PHONE] != "AWAY":
        yield Sight(SightKind.PHONE, PHONE[signals[CALL.PHONE]])
    if signals[DRIVER.DISTRACTION]:
        yield Sight(SightKind.EYES, say("Driver looks away from the road"), value=signals[DRIVER.DISTRACTION])
    if signals[CABIN.TRUNK]:
        yield Sight(SightKind.TAILGATE, say("Tailgate is open"))
    if signals[ENERGY.CHARGE_FLAP]:
        yield Sight(SightKind.CHARGE_FLAP, say("Charging flap is open"))
    softest = min(TYRE_NAMES, key=lambda tyre: signals[tyre])
    if signals[softest] < LOW_KPA:
        kpa = signals[softest]
        yield Sight(
            SightKind.TYRE,
            say("{name}: {value}", name=TYRE_NAMES[softest], value=pressure(signals, kpa)),
            value=kpa,
        )
    minutes = int((state.driven_s + state.time_s - state.departed_s) / 60)
    if minutes >= 60:
        said = say("Driving for {hours} h {minutes} min", hours=minutes // 60, minutes=f"{minutes % 60:02d}")
        yield Sight(SightKind.DRIVING_TIME, said, value=minutes / 60)


def _behind(state: State, driving: DrivingState) -> Iterator[Sight]:
    around = driving.around
    blue, follower = around.emergency_behind, around.follower
    if blue is not None and blue.gap_m <= BLUE_LIGHT_M:
        said = say("Emergency vehicle {distance} behind", distance=_near(state.signals, blue.gap_m))
        yield Sight(SightKind.EMERGENCY_VEHICLE, said, blue.gap_m, blue.speed_mps - driving.speed_mps)
    if follower is not None and follower.gap_m <= REAR_RADAR_M:
        closing_mps = follower.speed_mps - driving.speed_mps
        if closing_mps >= CLOSING_MPS:
            said = say("Vehicle {distance} behind is closing in", distance=_near(state.signals, follower.gap_m))
            yield Sight(SightKind.VEHICLE_BEHIND, said, follower.gap_m, closing_mps)


def _ahead(state: State, driving: DrivingState, starts_m: Mapping[str, float]) -> Iterator[Sight]:
    signals, ahead = state.signals, driving.ahead
    gap_m = signals[ADAS.LEADER_DISTANCE]
    if gap_m is not None:
        yield Sight(
            SightKind.VEHICLE_AHEAD, say("Vehicle ahead: {distance}", distance=_near(signals, gap_m)), gap_m
        )
    limit, limit_m = ahead.next_limit, ahead.next_limit_distance_m
    if state.sign_camera and limit is not None and limit.is_posted and limit_m is not None and limit_m <= HORIZON_M:
        kmh = None if limit.mps is None else limit.mps * KMH_PER_MPS
        far = _near(signals, limit_m)
        told = (
            say("No limit in {distance}", distance=far)
            if kmh is None
            else say(
                "Limit {speed} in {distance}", speed=f"{speed(signals, kmh)} {speed_unit(signals)}", distance=far
            )
        )
        yield Sight(SightKind.LIMIT, told, limit_m, kmh, _limit_hours(state, starts_m, limit, limit_m))
    if driving.road.in_tunnel:
        yield Sight(SightKind.TUNNEL, say("In a tunnel"), 0.0)
    elif ahead.tunnel_distance_m is not None:
        yield from _told(state, SightKind.TUNNEL, ahead.tunnel_distance_m)
    if driving.road.school_zone:
        yield Sight(SightKind.SCHOOL_ZONE, say("In a school zone"), 0.0)
    yield from _mapped(state, driving, starts_m)


def _limit_hours(state: State, starts_m: Mapping[str, float], limit: Limit, limit_m: float) -> str:
    """The hours on the sign of the next limit; empty if the road has that limit at all hours."""
    for edge_id, start_m in starts_m.items():
        road = state.roads.find(edge_id)
        if road is not None and road.limit_hours and abs(start_m - limit_m) <= 1.0:
            usual_mps = road.limit_mps
            if limit.mps is None or usual_mps is None or abs(limit.mps - usual_mps) > ROUNDED_MPS:
                return road.limit_hours
    return ""


def _mapped(state: State, driving: DrivingState, starts_m: Mapping[str, float]) -> Iterator[Sight]:
    """Schools of the map, and the incidents that are known, on the route within the horizon."""
    found: dict[SightKind, float] = {}
    hours = ""
    for edge_id, start_m in starts_m.items():
        road = state.roads.find(edge_id)
        if road is not None and road.school_zone and start_m >= 0 and SightKind.SCHOOL_ZONE not in found:
            found[SightKind.SCHOOL_ZONE], hours = start_m, road.limit_hours
    queue: tuple[float, float] | None = None
    works_left_m = 0.0
    for incident in _known(state, driving, starts_m):
        if incident.edge_id in starts_m:
            kind, start_m = SightKind(incident.kind.value), starts_m[incident.edge_id]
            away_m = start_m + incident.position_m
            if away_m > 0 and kind is SightKind.JAM:
                queue = min((away_m, start_m), queue or (away_m, start_m))
            elif away_m > 0:
                found[kind] = min(away_m, found.get(kind, away_m))
            elif kind is SightKind.ROADWORKS:
                road = state.roads.find(incident.edge_id)
                works_left_m = max(works_left_m, 0.0 if road is None else start_m + road.length_m)
    yield from _jam(state, driving, queue)
    if works_left_m > 0:
        found.pop(SightKind.ROADWORKS, None)
        said = say("In roadworks, {distance} left", distance=_near(state.signals, works_left_m))
        yield Sight(SightKind.ROADWORKS, said, 0.0, works_left_m)
    for kind, away_m in found.items():
        if kind is not SightKind.SCHOOL_ZONE:
            yield from _told(state, kind, away_m)
        elif not driving.road.school_zone:
            yield from _told(state, kind, away_m, hours)


def _known(state: State, driving: DrivingState, starts_m: Mapping[str, float]) -> Iterator[RoadIncident]:
    """The incidents of the last report, then the broken-down vehicles whose hazard lights the camera sees."""
    if state.news is not None:
        yield from state.news.ahead.incidents
    seen_m = 0.0 if state.outside is None else min(CAMERA_M, state.outside.weather.visibility)
    for incident in driving.ahead.incidents:
        start_m = starts_m.get(incident.edge_id)
        is_near = start_m is not None and start_m + incident.position_m <= seen_m
        if is_near and incident.kind is IncidentKind.BREAKDOWN:
            yield incident


def _jam(state: State, driving: DrivingState, queue: tuple[float, float] | None) -> Iterator[Sight]:
    """The next jam of the last report: how far it is, and within it how much is left.

    Slow traffic is reported road by road, from the start of the first slow one; of some queues the tail is known.

    Args:
        queue: how far the next reported tail is, and where its road begins; in metres from the car."""
    ahead_m = [] if queue is None else [queue[0]]
    news = state.news
    if news is not None and news.ahead.jam_distance_m is not None:
        begins_m = news.ahead.jam_distance_m - (driving.distance_m - news.distance_m)
        left_m = begins_m + news.ahead.jam_length_m
        is_known_better = queue is not None and queue[1] <= begins_m and queue[0] <= left_m
        if begins_m > 0 and not is_known_better:
            ahead_m.append(begins_m)
        elif left_m > 0 and not is_known_better:
            far = _near(state.signals, left_m)
            yield Sight(SightKind.JAM, say("In a traffic jam, {distance} left", distance=far), 0.0, left_m)
            return
    if ahead_m:
        yield from _told(state, SightKind.JAM, min(ahead_m))


def _starts_m(state: State, driving: DrivingState) -> dict[str, float]:
    """The edges of the route within the horizon, and where each begins, counted from the car."""
    found: dict[str, float] = {}
    start_m, before = -driving.road.lane_position_m, ""
    for edge_id in driving.ahead.route_edges:
        start_m += state.roads.network.junctions_m.get((before, edge_id), 0.0)
        if start_m > HORIZON_M:
            break
        road = state.roads.find(edge_id)
        length_m = 0.0 if road is None else road.length_m
        if not before and driving.road.edge_id.startswith(":"):
            start_m -= length_m  # in a junction the route still begins with the edge that has been left
        found.setdefault(edge_id, start_m)
        start_m, before = start_m + length_m, edge_id
    return found


def _told(state: State, kind: SightKind, away_m: float, hours: str = "") -> Iterator[Sight]:
    if 0 <= away_m <= HORIZON_M:
        yield Sight(kind, AHEAD[kind](_near(state.signals, away_m)), away_m, hours=hours)


def _near(signals: Signals, metres: float) -> str:
    """A distance to the metre or the foot where that matters."""
    if signals[HMI.DISTANCE_UNIT] == "MILES" and metres < FEET_BELOW_M:
        return f"{metres / FOOT_M:.0f} ft"
    return f"{metres:.0f} m" if metres < METRES_BELOW_M else distance(signals, metres)


def plate(x: int, y: int, width: int, state: State) -> tuple[Widget, ...]:
    """The sights over a map, one line each, with the keys ``ahead.<kind>``; nothing if there are none."""
    shown = sights(state)
    if not shown:
        return ()
    rect = Rect(x, y, width, 12 + LINE_PX * len(shown))
    lines = (
        line(
            (30, Glyph(icon=ICONS[sight.kind], size=24, tone="accent")),
            10,
            Label(key=f"ahead.{sight.kind}", text=sight.text, style=Type.LABEL),
        )
        for sight in shown
    )
    return fill(rect, framed(grid(1, 0, *lines), (14, 6), look="plate"))
