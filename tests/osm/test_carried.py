"""What the map knows of schools, cameras, bus lanes and hours is in the network afterwards."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.geo.place import shipped
from automotive_cosim.osm import extract, network
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.network import Built
from automotive_cosim.osm.roads import describe
from automotive_cosim.traffic.congestion import Congestion, Route
from automotive_cosim.traffic.network import Edge

ALONG_M = 230.0
"""Of the camera in Rue du Lavoir, whose first node lies at y = 0; the village's unit is the metre."""


@pytest.fixture(scope="module")
def built(sumo: None, make_village: Callable[..., Any], tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp("carried")
    made = make_village()
    for _, tags in made.ways:
        if tags.get("name") == "Rue du Lavoir":
            tags |= {"hazard": "school_zone", "maxspeed:conditional": "20 @ (Mo-Fr 08:00-09:00); 10 @ snow"}
        if tags.get("name") == "Rue de l'Église" and "lane_markings" in tags:
            tags["busway:right"] = "lane"
    made.nodes["camera"] = (325.0, ALONG_M)
    made.node_tags["camera"] = {"highway": "speed_camera", "maxspeed": "30"}
    made.nodes["lost"] = (1500.0, 900.0)
    made.node_tags["lost"] = {"highway": "speed_camera"}
    (folder / "village.osm").write_text(made.xml(), encoding="utf-8")
    mapped = extract.read(folder / "village.osm")
    roads = describe(mapped, shipped(), "FR")
    return network.convert(mapped, roads, folder / "village.net.xml.gz", "FR", folder)


def named(built: Built, name: str) -> list[Edge]:
    return [edge for edge in built.edges if edge.name == name]


def test_the_school_zone_has_its_hours(built: Built) -> None:
    zone = {edge.edge_id for edge in built.edges if edge.school_zone}
    assert zone == {edge.edge_id for edge in built.edges if edge.timed_limits}
    assert zone == {edge.edge_id for edge in named(built, "Rue du Lavoir")}
    hours = {edge.limit_hours for edge in named(built, "Rue du Lavoir")}
    assert hours == {"20 km/h Mo-Fr 08:00-09:00; 10 km/h in snow"}


def test_the_bus_lane_is_not_the_cars(built: Built) -> None:
    with_lane = {edge.name for edge in built.edges if edge.bus_lane}
    assert with_lane == {"Rue de l'Église"}
    assert all(len(edge.lane_ids) == 1 for edge in built.edges if edge.bus_lane)


def test_the_camera_stands_where_the_map_has_it(built: Built) -> None:
    watched = [edge for edge in built.edges if edge.cameras_m]
    assert {edge.name for edge in watched} == {"Rue du Lavoir"}, "the other one stands in a field"
    assert len(watched) == 2, "it may look either way"
    for edge in watched:
        (at_m,) = edge.cameras_m
        share = at_m / edge.length_m
        (_, first_m), (_, last_m) = edge.shape_m[0], edge.shape_m[-1]
        (south_m, *_), ground_m = sorted((first_m, last_m)), first_m + share * (last_m - first_m)
        assert 0 < at_m < edge.length_m
        assert ground_m - south_m == pytest.approx(ALONG_M - 160, abs=15), "beyond the junction at 160 m"


def test_the_route_tells_how_far_the_camera_is(built: Built) -> None:
    free = Congestion(built.network, lambda: ())
    edge = next(edge for edge in built.edges if edge.cameras_m)
    route = Route([edge.edge_id], built.network, free)
    (at_m,) = edge.cameras_m
    assert route.ahead(0, 0.0).camera_distance_m == at_m
    assert route.ahead(0, at_m - 1.0).camera_distance_m == pytest.approx(1.0)
    assert route.ahead(0, at_m + 1.0).camera_distance_m is None
    signed = replace(built.network, edges=built.network.edges | {edge.edge_id: replace(edge, sign="stop")})
    ahead = Route([edge.edge_id], signed, free).ahead(0, 10.0)
    assert (ahead.next_sign, ahead.sign_distance_m) == ("stop", pytest.approx(edge.length_m - 10.0))
    assert route.ahead(0, 10.0).next_sign is None


def test_a_crop_holds_what_lies_within(formats: dict[str, Path]) -> None:
    whole = extract.read(formats[""])
    west, south, east, north = whole.bounds
    half = Area(west, south, (west + east) / 2, north)
    cropped = whole.crop(half)
    assert 0 < len(cropped.ways) < len(whole.ways)
    assert all(half.holds(*node.position) for node in cropped.nodes.values())
    assert {ref for way in cropped.ways for ref in way.nodes} == set(cropped.nodes)
    assert whole.crop(whole.bounds) == whole
    assert cropped.crop(half) == cropped
    with pytest.raises(UserError, match="no road in the --bbox"):
        whole.crop(Area(10.0, 10.0, 11.0, 11.0))
