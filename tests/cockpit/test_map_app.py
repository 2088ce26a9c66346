"""The map as it is used: moved, turned, with marks; and frames drawn only where they changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.places import Kind
from automotive_cosim.cockpit.render import render
from automotive_cosim.cockpit.screens import APPS
from automotive_cosim.cockpit.widgets import MapView
from automotive_cosim.contracts import Direction, FeedbackCode, RouteOption, Surroundings

Make = Callable[..., Cockpit]


def view(cockpit: Cockpit) -> MapView:
    return next(widget for widget in cockpit.tree.walk() if isinstance(widget, MapView))


def press(cockpit: Cockpit, key: str) -> FeedbackCode:
    box = next(element for element in cockpit.elements() if element.resource_id == key).bbox_pixels
    return cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2).code


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
    assert any(element.resource_id == "map.jam" for element in cockpit.elements())


def test_a_frame_drawn_in_part_is_the_frame_drawn_anew(make: Make, around: Surroundings) -> None:
    rng = np.random.default_rng(5)
    for width in (1280, 960):
        cockpit, now = make(width=width), around
        for step in range(60):
            if rng.random() < 0.3:
                cockpit.open_app(str(rng.choice(APPS)))
            else:
                cockpit.tap(int(rng.integers(width)), int(rng.integers(width * 9 // 16)))
            driving = replace(now.driving, time_s=now.driving.time_s + 1, x_m=now.driving.x_m + 3.0)
            now = replace(now, driving=driving, sun_elevation_deg=-20.0 if step % 25 > 18 else 40.0)
            cockpit.sense(now, 1.0)
            anew = render(cockpit.tree, width, width * 9 // 16).pixels()
            assert np.array_equal(cockpit.screenshot(), anew), cockpit.screen


def test_every_place_is_reached_while_driving_by_a_short_way(cockpit: Cockpit) -> None:
    """Map, explore, a kind, the place, start; at most four scrolls in between."""
    found: dict[str, int] = {}

    def look_through(rows: str) -> None:
        for scrolls in range(5):
            for element in cockpit.elements():
                if element.resource_id.startswith(rows) and element.is_clickable:
                    found.setdefault(element.text, scrolls)
            if cockpit.scroll(None, Direction.DOWN).code is not FeedbackCode.OK:
                return

    cockpit.open_app("map")
    look_through("map.place.")
    press(cockpit, "map.list.explore")
    kinds = [kind for kind in Kind if kind not in (Kind.HOME, Kind.WORK)]
    for kind in kinds:
        while all(element.resource_id != f"explore.kind.{kind}" for element in cockpit.elements()):
            assert cockpit.scroll("explore.kinds", Direction.DOWN).code is FeedbackCode.OK
        press(cockpit, f"explore.kind.{kind}")
        look_through("explore.place.")
        press(cockpit, "explore.back")
    assert set(cockpit.content["places"]) <= set(found)
    cockpit.open_app("home")
    press(cockpit, "home.map")
    while cockpit.scroll("map.places", Direction.UP).code is FeedbackCode.OK:
        pass
    press(cockpit, "map.place.0")
    assert press(cockpit, "place.start") is FeedbackCode.OK
