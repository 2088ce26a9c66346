"""What the car notices by itself is shown on home and map, in picture and tree; without a lookout, nothing."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.map.lookout import ICONS, LINES
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import said
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat
from automotive_cosim.cockpit.sensor_range import CAMERA_M, HORIZON_M, NEWS_EVERY_S
from automotive_cosim.cockpit.signals import CABIN, ENERGY, HMI, OCCUPANT, SEAT, TYRE
from automotive_cosim.contracts import (
    Connectivity,
    IncidentKind,
    Limit,
    LimitSource,
    OtherVehicle,
    RoadIncident,
    RoadNetwork,
    Sight,
    SightKind,
    Surroundings,
)
from automotive_cosim.contracts.ids import key_of

Make = Callable[..., Cockpit]
BLUE = OtherVehicle("ambulance", 120.0, 25.0, 10.0)
VAN = OtherVehicle("van", 45.0, 20.0, 7.0)
AHEAD = OtherVehicle("car", 24.0, 10.0, None)


def full(around: Surroundings) -> Surroundings:
    """Everything at once."""
    incidents = tuple(
        RoadIncident(IncidentKind(kind), "n7_6", 10.0) for kind in ("breakdown", "roadworks", "closure")
    )
    driving = around.driving
    ahead = replace(driving.ahead, incidents=incidents, tunnel_distance_m=700.0)
    others = replace(driving.around, leader=AHEAD, follower=VAN, emergency_behind=BLUE)
    road = replace(driving.road, school_zone=True)
    return replace(around, driving=replace(driving, ahead=ahead, around=others, road=road))


def shown(cockpit: Cockpit, screen: str) -> dict[str, str]:
    cockpit.open_app(screen)
    found = {key_of(one.resource_id): one.text for one in cockpit.elements()}
    return {key.removeprefix("ahead."): text for key, text in found.items() if key.startswith("ahead.")}


def by_kind(cockpit: Cockpit) -> dict[SightKind, Sight]:
    return {sight.kind: sight for sight in cockpit.sights}


def test_without_a_lookout_nothing_is_shown(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=full(around), signals={SEAT.DRIVER_BELT.path: False})
    assert cockpit.sights == ()
    assert shown(cockpit, "home") == shown(cockpit, "map") == {}


@pytest.mark.parametrize("screen", ["home", "map"])
def test_the_screens_show_each_sight_and_no_other(make: Make, around: Surroundings, screen: str) -> None:
    cockpit = make(surroundings=full(around), lookout=True)
    told = {str(sight.kind): sight.text for sight in cockpit.sights}
    assert shown(cockpit, screen) == told
    assert len(told) == LINES
    assert told["emergency_vehicle"] == "Emergency vehicle 120 m behind"
    assert told["vehicle_behind"] == "Vehicle 45 m behind is closing in"
    assert told["vehicle_ahead"] == "Vehicle ahead: 24 m"
    assert told["school_zone"] == "In a school zone"


def at(around: Surroundings, edge_id: str, on_edge_m: float) -> Surroundings:
    """At another place of the route: on an edge, or in the junction after the first."""
    driving = around.driving
    route = driving.ahead.route_edges
    ahead = replace(driving.ahead, route_edges=route[route.index(edge_id) :] if edge_id in route else route)
    road = replace(driving.road, edge_id=edge_id, lane_position_m=on_edge_m)
    return replace(around, driving=replace(driving, ahead=ahead, road=road))


def ahead_m(cockpit: Cockpit, kind: SightKind) -> float | None:
    sight = by_kind(cockpit).get(kind)
    return None if sight is None else sight.distance_m


def test_what_is_ahead_is_as_far_as_the_way_to_it_with_its_junctions(
    network: RoadNetwork, around: Surroundings
) -> None:
    """In a junction, too, which is part of neither edge."""
    lengths_m = {("e6_5", "e6_6"): 12.0, ("e6_6", "n7_6"): 30.0}
    cockpit = Cockpit(replace(network, junctions_m=lengths_m), rng=np.random.default_rng(1), lookout=True)
    for edge_id, on_edge_m, away_m in (
        ("e6_5", 40.0, 80.0 + 12.0 + 120.0 + 30.0 + 10.0),
        (":n_0", 5.0, 7.0 + 120.0 + 30.0 + 10.0),
        ("e6_6", 0.0, 120.0 + 30.0 + 10.0),
    ):
        cockpit.sense(at(full(around), edge_id, on_edge_m), 1.0)
        assert ahead_m(cockpit, SightKind.BREAKDOWN) == away_m


def test_roadworks_last_to_the_end_of_their_road(make: Make, around: Surroundings) -> None:
    works = (RoadIncident(IncidentKind.ROADWORKS, "e6_6", 0.0),)
    driving = replace(around.driving, ahead=replace(around.driving.ahead, incidents=works))
    for edge_id, on_edge_m, told in (
        ("e6_5", 110.0, "Roadworks in 10 m"),
        ("e6_6", 0.0, "In roadworks, 120 m left"),
        ("e6_6", 50.0, "In roadworks, 70 m left"),
        ("n7_6", 1.0, None),
    ):
        cockpit = make(surroundings=at(replace(around, driving=driving), edge_id, on_edge_m), lookout=True)
        sight = by_kind(cockpit).get(SightKind.ROADWORKS)
        assert (None if sight is None else sight.text) == told


@pytest.mark.parametrize(("visibility_m", "from_m"), [(20_000.0, CAMERA_M), (60.0, 60.0)])
def test_hazard_lights_are_seen_before_a_breakdown_is_reported(
    make: Make, around: Surroundings, visibility_m: float, from_m: float
) -> None:
    """As far as there is sight; the report may be a minute late."""
    cockpit = make(surroundings=around, lookout=True)
    clear = replace(around, weather=replace(around.weather, visibility=visibility_m))
    stands = (RoadIncident(IncidentKind.BREAKDOWN, "e6_6", 90.0),)
    for away_m, seen in ((from_m + 2.0, False), (from_m - 2.0, True)):
        there = at(clear, "e6_5", 210.0 - away_m)
        told = replace(there.driving, ahead=replace(there.driving.ahead, incidents=stands))
        cockpit.sense(replace(there, driving=told), 1.0)
        assert ahead_m(cockpit, SightKind.BREAKDOWN) == (away_m if seen else None)


def test_every_kind_has_a_look(make: Make) -> None:
    assert ICONS.keys() == set(SightKind)


def test_what_is_aboard(make: Make, around: Surroundings) -> None:
    signals = {CABIN.TRUNK.path: True, ENERGY.CHARGE_FLAP.path: True, TYRE.REAR_LEFT.path: 160.0}
    cockpit = make(surroundings=around, lookout=True, driven_s=2 * 3600.0 + 300.0, signals=signals)
    cockpit.inject(SEAT.DRIVER_BELT.path, False)
    told = {kind: sight.text for kind, sight in by_kind(cockpit).items()}
    assert told[SightKind.DRIVER_BELT] == "Driver's seat belt unbuckled"
    assert told[SightKind.TAILGATE] == "Tailgate is open"
    assert told[SightKind.CHARGE_FLAP] == "Charging flap is open"
    assert told[SightKind.TYRE] == "Rear left tyre: 1.5 bar"
    assert told[SightKind.DRIVING_TIME] == "Driving for 2 h 05 min"


def test_what_is_well_aboard_is_not_mentioned(make: Make, around: Surroundings) -> None:
    kinds = by_kind(make(surroundings=around, lookout=True)).keys()
    assert not kinds & {SightKind.DRIVER_BELT, SightKind.TAILGATE, SightKind.TYRE, SightKind.DRIVING_TIME}


def test_distances_are_in_the_driver_s_unit(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=full(around), lookout=True, signals={HMI.DISTANCE_UNIT.path: "MILES"})
    told = by_kind(cockpit)
    assert told[SightKind.VEHICLE_AHEAD].text == "Vehicle ahead: 79 ft"
    assert told[SightKind.VEHICLE_AHEAD].distance_m == 24.0


def test_nothing_beyond_the_horizon(make: Make, around: Surroundings) -> None:
    for away_m, seen in ((HORIZON_M - 1, True), (HORIZON_M + 1, False)):
        ahead = replace(around.driving.ahead, tunnel_distance_m=away_m)
        cockpit = make(surroundings=replace(around, driving=replace(around.driving, ahead=ahead)), lookout=True)
        assert (SightKind.TUNNEL in by_kind(cockpit)) is seen


def test_an_incident_elsewhere_is_not_ahead(make: Make, around: Surroundings) -> None:
    ahead = replace(around.driving.ahead, incidents=(RoadIncident(IncidentKind.ROADWORKS, "e0_0", 10.0),))
    cockpit = make(surroundings=replace(around, driving=replace(around.driving, ahead=ahead)), lookout=True)
    assert SightKind.ROADWORKS not in by_kind(cockpit)


def test_a_limit_ahead_is_seen_with_the_hours_of_its_sign(network: RoadNetwork, around: Surroundings) -> None:
    """But not where the road has that limit at all hours."""
    hours = "Mo-Fr 08:00-09:30"
    roads = tuple(
        replace(road, limit_hours=hours, limit_mps=14.0) if road.edge_id == "e6_6" else road
        for road in network.roads
    )
    here_m = next(road.length_m for road in roads if road.edge_id == "e6_5")
    away_m = here_m - around.driving.road.lane_position_m
    for mps, told in ((8.0, hours), (14.0, "")):
        limit = Limit(mps, LimitSource.POSTED)
        ahead = replace(around.driving.ahead, next_limit=limit, next_limit_distance_m=away_m)
        cockpit = Cockpit(replace(network, roads=roads), rng=np.random.default_rng(1), lookout=True)
        cockpit.sense(replace(around, driving=replace(around.driving, ahead=ahead)), 0.0)
        assert by_kind(cockpit)[SightKind.LIMIT].hours == told


def jam_told(cockpit: Cockpit, around: Surroundings, driven_m: float) -> str:
    """What is told of the jam so far on, by the news that came at the start."""
    driving = replace(around.driving, distance_m=around.driving.distance_m + driven_m)
    cockpit.sense(replace(around, driving=driving), 1.0)
    sight = by_kind(cockpit).get(SightKind.JAM)
    return "" if sight is None else sight.text


def test_a_jam_is_ahead_then_around_the_car_and_then_behind_it(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=around, lookout=True)
    assert jam_told(cockpit, around, 820.0) == "Traffic jam in 80 m"
    assert jam_told(cockpit, around, 1180.0) == "In a traffic jam, 20 m left"
    assert by_kind(cockpit)[SightKind.JAM].distance_m == 0.0
    assert by_kind(cockpit)[SightKind.JAM].value == 20.0
    assert not jam_told(cockpit, around, 1201.0)


def test_the_tail_that_is_reported_on_a_slow_road_is_ahead_until_it_is_reached(
    make: Make, around: Surroundings
) -> None:
    """The road counts as slow from its start, where nobody queues."""
    tail = RoadIncident(IncidentKind.JAM, "e6_5", 110.0)
    for far_m, tails, told in (
        (0.0, (tail,), "Traffic jam in 70 m"),
        (0.0, (), "In a traffic jam, 300 m left"),
        (20.0, (replace(tail, edge_id="n7_6"),), "Traffic jam in 20 m"),
        (0.0, (replace(tail, edge_id="n7_6"),), "In a traffic jam, 300 m left"),
    ):
        ahead = replace(around.driving.ahead, jam_distance_m=far_m, incidents=tails)
        cockpit = make(surroundings=replace(around, driving=replace(around.driving, ahead=ahead)), lookout=True)
        assert by_kind(cockpit)[SightKind.JAM].text == told, (far_m, tails)


def test_news_comes_once_a_minute_and_only_online(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=around, lookout=True)
    news = replace(
        around.driving.ahead, incidents=(RoadIncident(IncidentKind.BREAKDOWN, "n7_6", 10.0),), jam_distance_m=None
    )

    def sense(second: float, *, online: bool = True) -> bool:
        driving = replace(around.driving, time_s=around.driving.time_s + second, ahead=news)
        link = around.connectivity if online else Connectivity(False, "none", 0)
        cockpit.sense(replace(around, driving=driving, connectivity=link), 1.0)
        return SightKind.BREAKDOWN in by_kind(cockpit)

    assert not sense(1.0)
    assert not sense(NEWS_EVERY_S - 1)
    assert not sense(NEWS_EVERY_S, online=False)
    assert sense(NEWS_EVERY_S + 1)


@pytest.mark.parametrize("language", ["fr", "de", "ja"])
def test_every_sight_is_translated(make: Make, around: Surroundings, language: str) -> None:
    cockpit = make(surroundings=full(around), lookout=True, changes=[CarChange(0.0, CABIN.TRUNK.path, True)])
    aboard = [Occupant(Seat.REAR_LEFT, Kind.CHILD, belted=False)]
    gone = CarChange(0.0, OCCUPANT.DRIVER.occupied.path, False, once_parked=True)
    standing = replace(around, driving=replace(around.driving, speed_mps=0.0))
    riding = make(surroundings=standing, lookout=True, aboard=aboard)
    parked, empty = (
        make(surroundings=standing, lookout=True, aboard=others, changes=[gone]) for others in (aboard, ())
    )
    for cockpit_ in (parked, empty):
        cockpit_.sense(replace(standing, parked=True), 1.0)
    works = (RoadIncident(IncidentKind.ROADWORKS, "e6_5", 0.0),)
    ahead = replace(around.driving.ahead, jam_distance_m=0.0, incidents=works)
    queueing = make(surroundings=replace(around, driving=replace(around.driving, ahead=ahead)), lookout=True)
    told = [sight.text for each in (cockpit, riding, parked, empty, queueing) for sight in each.sights]
    assert {
        "Seat belt unbuckled: Rear left",
        "Driver has left, aboard: Child",
        "Driver has left, nobody aboard",
        "In a traffic jam, 300 m left",
        "In roadworks, 80 m left",
    } <= {*told}
    for text in told:
        words = said(text, language)
        assert words != text or text.startswith("Tunnel")
        assert not {"Child", "Rear left"} & {words.partition(": ")[2]}
