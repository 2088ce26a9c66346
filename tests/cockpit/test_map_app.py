"""The map as it is used: moved, turned, with marks; and frames drawn only where they changed."""

import math
from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from itertools import product

import numpy as np
import pytest
from shapely import LineString, Point

from automotive_cosim.cockpit.apps.map.state import Viewpoint
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import ZOOMS_M_PER_PX, Camera, View
from automotive_cosim.cockpit.pois import PoiKind
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.cockpit.render import render
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.theme import DAY
from automotive_cosim.cockpit.widgets import Badge, MapView
from automotive_cosim.contracts import (
    BoundingBox,
    Direction,
    FeedbackCode,
    IncidentKind,
    RoadIncident,
    RouteOption,
    Surroundings,
)
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.contracts.ids import resource_id as shown_id
from tests.cockpit.fingers import press

from .conftest import town

Make = Callable[..., Cockpit]


def view(cockpit: Cockpit) -> MapView:
    return next(widget for widget in cockpit.tree.walk() if isinstance(widget, MapView))


def test_a_swipe_moves_the_map_and_a_button_brings_it_back(cockpit: Cockpit) -> None:
    cockpit.open_app("map")
    before = view(cockpit).scene.camera
    x, y = view(cockpit).rect.centre
    assert cockpit.swipe(x, y, Direction.DOWN).code is FeedbackCode.OK
    assert view(cockpit).scene.camera.y_m > before.y_m
    assert view(cockpit).scene.camera.heading_deg == 0.0
    assert cockpit.scroll("map.view", Direction.RIGHT).code is FeedbackCode.OK
    assert view(cockpit).scene.camera.x_m > before.x_m
    assert press(cockpit, "map.orientation") is FeedbackCode.OK
    assert view(cockpit).scene.camera == before


def test_the_map_ends_at_the_network_s_edge(cockpit: Cockpit) -> None:
    cockpit.open_app("map")
    for _ in range(20):
        if cockpit.scroll("map.view", Direction.UP).code is FeedbackCode.NO_EFFECT:
            break
    else:
        raise AssertionError("the map goes on for ever")
    assert view(cockpit).scene.camera.y_m == 1320.0


def test_north_up_and_turning(cockpit: Cockpit) -> None:
    cockpit.open_app("map")
    assert view(cockpit).scene.camera.heading_deg == 62.0
    assert press(cockpit, "map.orientation") is FeedbackCode.OK
    assert view(cockpit).scene.camera.heading_deg == 0.0
    assert press(cockpit, "map.orientation") is FeedbackCode.OK
    assert view(cockpit).scene.camera.heading_deg == 62.0


def test_the_map_shows_ways_traffic_and_a_jam(make: Make, around: Surroundings) -> None:
    ahead = replace(
        around.driving.ahead,
        jam_distance_m=80.0,
        slow_edges=(("e6_6", 0.2),),
        alternatives=(RouteOption(("e6_5", "n7_5"), 900.0, 120.0, 10.0),),
    )
    cockpit = make(surroundings=replace(around, driving=replace(around.driving, ahead=ahead)))
    cockpit.open_app("map")
    scene = view(cockpit).scene
    assert scene.slow == (("e6_6", 0.2),)
    assert scene.alternatives == (("e6_5", "n7_5"),)
    assert scene.route == ahead.route_edges
    assert any(element.resource_id == shown_id("map.jam") for element in cockpit.elements())


def test_charging_stops_are_on_the_map_beside_names_and_marks_and_in_no_list(cockpit: Cockpit) -> None:
    found = 0
    for app in ("map", "home"):
        cockpit.open_app(app)
        for zoom in range(len(ZOOMS_M_PER_PX)):
            cockpit._state.keep(Viewpoint(zoom))
            cockpit._tree = None
            shown = view(cockpit)
            stops = [child for child in shown.children if isinstance(child, Badge) and child.charges]
            others = [child.rect for child in shown.children if child not in stops]
            for at, stop in enumerate(stops):
                assert shown.rect.encloses(stop.rect)
                assert not any(stop.rect.overlaps(other) for other in others)
                assert not any(stop.rect.overlaps(other.rect) for other in stops[at + 1 :])
            boxes = {element.bbox_pixels for element in cockpit.elements()}
            assert boxes.isdisjoint(BoundingBox(*stop.rect.edges(1.0)) for stop in stops)
            found += len(stops)
    assert found > 5


def test_a_charging_stop_is_green(cockpit: Cockpit) -> None:
    cockpit.open_app("map")
    cockpit._state.keep(Viewpoint(len(ZOOMS_M_PER_PX) - 1))
    cockpit._tree = None
    stop = next(child.rect for child in view(cockpit).children if isinstance(child, Badge) and child.charges)
    picture = cockpit.screenshot()
    assert tuple(picture[stop.centre[1], stop.x + 4].tolist()) == DAY.good


def incidents_seen(cockpit: Cockpit) -> dict[str, str]:
    found = {key_of(one.resource_id): one.content_description for one in cockpit.elements()}
    return {key: words for key, words in found.items() if key.startswith("map.incident.")}


def with_incidents(around: Surroundings, *incidents: RoadIncident, online: bool = True) -> Surroundings:
    ahead = replace(around.driving.ahead, incidents=incidents, slow_edges=(("e6_6", 0.2),) if incidents else ())
    link = replace(around.connectivity, online=online)
    return replace(around, driving=replace(around.driving, ahead=ahead), connectivity=link)


def test_every_kind_of_incident_in_sight_is_marked_and_named(make: Make, around: Surroundings) -> None:
    marks = set()
    for kind in IncidentKind:
        here, far = RoadIncident(kind, "e6_6", 30.0), RoadIncident(kind, "e0_0", 30.0)
        cockpit = make(surroundings=with_incidents(around, far, here))
        cockpit.open_app("map")
        badge = next(widget for widget in cockpit.tree.walk() if widget.key == "map.incident.1")
        assert incidents_seen(cockpit) == {"map.incident.1": badge.description}, "the far one is out of sight"
        assert badge.description.endswith(": Pont Neuf"), "its street"
        expected = View(*_frame(view(cockpit))).pixel(720.0 + 30.0, 720.0)
        assert math.dist(badge.rect.centre, expected) < 10
        patch = Rect(badge.rect.x, badge.rect.y, 40, 40)
        marks.add(cockpit.screenshot()[patch.y : patch.bottom, patch.x : patch.right].tobytes())
        assert cockpit.screenshot()[badge.rect.y + 6, badge.rect.centre[0]].tolist() == list(DAY.warning)
    assert len(marks) == len(IncidentKind), "each has a look of its own"


def _frame(map_view: MapView) -> tuple[Camera, float, float, float]:
    rect, camera = map_view.rect, map_view.scene.camera
    return camera, 1 / camera.metres_per_pixel, rect.x + rect.width / 2, rect.y + rect.height * camera.down


def test_incidents_at_one_place_and_on_unknown_roads_break_nothing(make: Make, around: Surroundings) -> None:
    told = [RoadIncident(kind, "e6_6", 30.0) for kind in reversed(IncidentKind)]
    cockpit = make(surroundings=with_incidents(around, RoadIncident(IncidentKind.CLOSURE, "gone", 5.0), *told))
    cockpit.open_app("map")
    (words,) = incidents_seen(cockpit).values()
    assert words == "Road closed: Pont Neuf", "the gravest"


def test_a_mark_lies_on_its_road_and_does_not_cover_the_car(make: Make, around: Surroundings) -> None:
    moved, ways = 0, [LineString(road.shape_m) for road in town().roads]
    for at_m, zoom in product(range(0, 121, 24), range(len(ZOOMS_M_PER_PX))):
        cockpit = make(
            surroundings=with_incidents(around, RoadIncident(IncidentKind.BREAKDOWN, "e6_5", float(at_m)))
        )
        cockpit._state.keep(Viewpoint(zoom))
        cockpit.open_app("map")
        badge = next((widget for widget in cockpit.tree.walk() if widget.key == "map.incident.0"), None)
        if badge is None:
            continue  # below the edge of the map
        frame = View(*_frame(view(cockpit)))
        x, y = frame.pixel(around.driving.x_m, around.driving.y_m)
        assert not badge.rect.overlaps(Rect(round(x) - 20, round(y) - 20, 40, 40)), (at_m, zoom)
        metres = Point(frame.metres(*badge.rect.centre))
        away_px = min(way.distance(metres) for way in ways) / frame.camera.metres_per_pixel
        assert away_px < 2, (at_m, zoom)
        moved += abs(metres.x - 600.0 - at_m) > 10
    assert moved > 8


def test_of_two_marks_of_one_jam_the_route_s_is_shown(make: Make, around: Surroundings) -> None:
    for jam_distance_m, marked in ((None, False), (80.0, True)):
        news = with_incidents(around, RoadIncident(IncidentKind.JAM, "e6_6", 90.0))
        ahead = replace(news.driving.ahead, jam_distance_m=jam_distance_m)
        cockpit = make(surroundings=replace(news, driving=replace(news.driving, ahead=ahead)))
        cockpit.open_app("map")
        assert any(element.resource_id == shown_id("map.jam") for element in cockpit.elements()) is marked
        assert bool(incidents_seen(cockpit)) is not marked


def test_without_a_link_the_traffic_stays_as_it_was_heard_last(make: Make, around: Surroundings) -> None:
    closed = RoadIncident(IncidentKind.CLOSURE, "e6_6", 30.0)
    later = replace(around, local_time=around.local_time + timedelta(minutes=20))
    cockpit = make(surroundings=with_incidents(around, closed))
    cockpit.open_app("map")
    assert "traffic" not in view(cockpit).description
    for news, online in ((with_incidents(later, online=False), False), (with_incidents(later), True)):
        cockpit.sense(news, 1.0)
        assert bool(incidents_seen(cockpit)) is not online
        assert bool(view(cockpit).scene.slow) is not online
        assert (", traffic as of 14:05" in view(cockpit).description) is not online
    never = make(surroundings=with_incidents(around, closed, online=False))
    never.open_app("map")
    assert (incidents_seen(never), view(never).scene.slow) == ({}, ())


def test_without_mobile_data_no_traffic_is_heard(make: Make, around: Surroundings) -> None:
    closed = RoadIncident(IncidentKind.CLOSURE, "e6_6", 30.0)
    cockpit = make(surroundings=with_incidents(around), signals={LINK.MOBILE_DATA.path: False})
    cockpit.open_app("map")
    cockpit.sense(with_incidents(around, closed), 1.0)
    assert not incidents_seen(cockpit)
    cockpit = make(surroundings=with_incidents(around))
    cockpit.open_app("map")
    cockpit.inject(LINK.ONLINE.path, False)
    cockpit.sense(with_incidents(around, closed), 1.0)
    assert not incidents_seen(cockpit)


@pytest.mark.slow
def test_a_frame_drawn_in_part_is_the_frame_drawn_anew(make: Make, around: Surroundings) -> None:
    rng = np.random.default_rng(5)
    for size, scale in ((ScreenSize.STANDARD, 1.0), (ScreenSize.STANDARD, 0.75), (ScreenSize.PORTRAIT, 1.0)):
        width, height = round(size.width * scale), round(size.height * scale)
        cockpit, now = make(size=size, width=width), around
        for step in range(27):
            if rng.random() < 0.3:
                cockpit.open_app(str(rng.choice(list(apps()))))
            else:
                cockpit.tap(int(rng.integers(width)), int(rng.integers(height)))
            driving = replace(now.driving, time_s=now.driving.time_s + 1, x_m=now.driving.x_m + 3.0)
            now = replace(now, driving=driving, sun_elevation_deg=-20.0 if step % 25 > 18 else 40.0)
            cockpit.sense(now, 1.0)
            anew = render(cockpit.tree, scale).pixels()
            assert np.array_equal(cockpit.screenshot(), anew), cockpit.screen


def test_every_place_is_reached_while_driving_by_a_short_way(cockpit: Cockpit) -> None:
    """Map, explore, a kind, the place, start; at most four scrolls in between."""
    found: dict[str, int] = {}

    def look_through(rows: str) -> None:
        for scrolls in range(5):
            for element in cockpit.elements():
                if key_of(element.resource_id).startswith(rows) and element.is_clickable:
                    found.setdefault(element.text, scrolls)
            if cockpit.scroll("", Direction.DOWN).code is not FeedbackCode.OK:
                return

    cockpit.open_app("map")
    look_through("map.place.")
    press(cockpit, "map.list.explore")
    kinds = [kind for kind in PoiKind if kind not in (PoiKind.HOME, PoiKind.WORK)]
    for kind in kinds:
        while all(element.resource_id != shown_id(f"explore.kind.{kind}") for element in cockpit.elements()):
            assert cockpit.scroll("explore.kinds", Direction.DOWN).code is FeedbackCode.OK
        press(cockpit, f"explore.kind.{kind}")
        look_through("explore.place.")
        press(cockpit, "explore.back")
    assert set(cockpit.content["places"]) <= set(found)
    press(cockpit, "open home; home.map")
    while cockpit.scroll("map.places", Direction.UP).code is FeedbackCode.OK:
        pass
    assert press(cockpit, "map.place.0; place.start") is FeedbackCode.OK
