"""A network at another place on earth: the same metres, that place's law, clock and climate."""

import math
from collections.abc import Mapping
from dataclasses import replace
from datetime import timedelta
from functools import cache
from typing import Any

import numpy as np
import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import Reroute, Weather
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import UserError
from automotive_cosim.geo.place import shipped
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.georeference import GeoReference, middle
from automotive_cosim.traffic.mirror import mirrored
from tests.laws import over

ROME, GERMANY, AUSTRIA = (12.49, 41.89), (9.9, 50.5), (14.3, 48.3)
PLACES = {
    "IT": ((9.19, 45.46), "Europe/Rome"),
    "CN": ((121.47, 31.23), "Asia/Shanghai"),
    "GB": ((-3.18, 51.48), "Europe/London"),
    "ZA": ((28.05, -26.20), "Africa/Johannesburg"),
    "NO": ((25.78, 71.17), "Europe/Oslo"),
}
DRY = Weather(22.0, 50.0, 0.0, 0, 0.0, 20_000.0, 8.0)


@over(
    (name, [*PLACES][(number + more) % len(PLACES)])
    for number, name in enumerate(scenarios.shipped())
    for more in (0, 2)
)
def test_any_shipped_network_lies_where_it_is_put(name: str, country: str) -> None:
    origin, zone = PLACES[country]
    home, away = scenarios.load(name), open_scenario(name, origin=origin)
    assert (away.country, str(away.start.tzinfo)) == (country, zone)
    assert away.start.replace(tzinfo=None) == home.start.replace(tzinfo=None)
    assert away.weather == ()
    network = network_of(away)
    assert middle(network.map) == pytest.approx(origin, abs=1e-9)
    own = network_of(home)
    if away.mirrored:
        own = mirrored(own)
    assert {edge_id: replace(edge, name="") for edge_id, edge in network.edges.items()} == {
        edge_id: replace(edge, name="") for edge_id, edge in own.edges.items()
    }


@pytest.mark.parametrize("origin", [ROME, (0.0, 0.0), (179.9, -16.0), (25.0, 78.0)])
def test_a_metre_stays_a_metre(origin: tuple[float, float]) -> None:
    network = network_of(open_scenario("grid", origin=origin)).map
    reference = GeoReference(network)
    x_m, y_m = network.roads[0].shape_m[0]
    lon_a, lat_a = reference.lon_lat(x_m, y_m)
    lon_b, lat_b = reference.lon_lat(x_m + 300.0, y_m + 400.0)
    east_m = ((lon_b - lon_a + 180) % 360 - 180) * 111_320 * math.cos(math.radians(lat_a))
    assert math.hypot(east_m, (lat_b - lat_a) * 111_320) == pytest.approx(500.0, rel=0.01)
    assert reference.x_y(lon_b, lat_b) == pytest.approx((x_m + 300.0, y_m + 400.0), abs=1e-3)


def test_where_no_law_is_known_is_said() -> None:
    assert any("no traffic law is known" in note for note in open_scenario("grid", origin=(-30.0, 0.0)).notes)
    assert open_scenario("london", origin=PLACES["ZA"][0]).notes == ()


@pytest.mark.parametrize(
    ("name", "country", "is_mirrored"), [("grid", "GB", True), ("london", "IT", True), ("london", "ZA", False)]
)
def test_a_network_is_mirrored_where_traffic_keeps_the_other_side(
    name: str, country: str, is_mirrored: bool
) -> None:
    scenario = open_scenario(name, origin=PLACES[country][0])
    assert scenario.mirrored is is_mirrored
    assert network_of(scenario).map.left_hand is (country in ("GB", "ZA"))


HALVES = [(task, half) for task in CATALOGUE.values() for half in task.halves]


@over(HALVES)
def test_every_half_drives_on_the_side_of_its_country(task: Task, half: str) -> None:
    """The side that the map shows is the one that the prompt says."""
    start = task.half(half).start
    left_hand, origin = _network(start.scenario, start.origin)
    law = shipped().place(*origin).law
    assert law is not None
    assert ("left" if left_hand else "right") == law.driving_side


@cache
def _network(scenario: str, origin: tuple[float, float] | None) -> tuple[bool, tuple[float, float]]:
    network = network_of(open_scenario(scenario, origin=origin)).map
    return network.left_hand, middle(network)


@pytest.mark.parametrize("origin", [(9.0, 91.0), (181.0, 0.0), (math.nan, 0.0)])
def test_what_is_not_on_earth_is_refused(origin: tuple[float, float]) -> None:
    with pytest.raises(UserError, match="is not on earth"):
        open_scenario("grid", origin=origin)


def test_weather_and_context_are_the_places(simulations) -> None:
    seen = {}
    for country in ("ZA", "NO"):
        env = CockpitEnv("hvac_fan_max", scenario="grid", origin=PLACES[country][0], simulations=simulations)
        env.reset(seed=1)
        moment = env.episode.moments[0]
        assert moment.context.country == country
        assert moment.driving.lon_deg == pytest.approx(PLACES[country][0][0], abs=0.05)
        assert moment.gps is not None
        assert moment.gps.lat_deg == pytest.approx(PLACES[country][0][1], abs=0.05)
        seen[country] = moment
        env.close()
    za, no = seen["ZA"], seen["NO"]
    assert za.weather.temperature_2m > no.weather.temperature_2m  # the 10th of March
    # The grid keeps right, so in South Africa it is mirrored.
    assert (za.driving.x_m, za.driving.distance_m) == (no.driving.x_m, no.driving.distance_m)
    assert za.driving.heading_deg == pytest.approx((180.0 - no.driving.heading_deg) % 360.0)
    assert za.local_time.replace(tzinfo=None) == no.local_time.replace(tzinfo=None)
    assert za.local_time - no.local_time == timedelta(hours=-1)


def test_the_driver_can_be_sent_to_a_position_of_the_new_place(simulations) -> None:
    scenario = open_scenario("grid", origin=ROME)
    network = network_of(scenario)
    (x_a, y_a), *_, (x_b, y_b) = network.edges["n3n4"].shape_m
    lon_deg, lat_deg = GeoReference(network.map).lon_lat((x_a + x_b) / 2, (y_a + y_b) / 2)
    env = CockpitEnv("hvac_fan_max", scenario="grid", origin=ROME, simulations=simulations)
    env.reset(seed=1)
    answer = env.episode.world.traffic.request(Reroute(f"{lon_deg:.6f},{lat_deg:.6f}"))
    assert answer.accepted, answer.reason
    assert network.edges["n3n4"].name in answer.reason
    env.close()


# --- translated pairs -------------------------------------------------------------------------------------


def _translated(first: tuple[float, float], second: tuple[float, float]) -> Task:
    """A pair whose halves differ in nothing but the origin. At this hour the sun is high at both."""
    task = CATALOGUE["hvac_fan_max"]
    start = replace(task.first.start, scenario="grid", trip="avenue", start="2026-06-16T14:00", weather=DRY)
    return replace(
        task,
        first=replace(task.first, start=replace(start, origin=first)),
        second=replace(task.first, start=replace(start, origin=second)),
        difference="place",
    )


def _without_place(encoded: Mapping[str, Any]) -> list[bytes]:
    """The observation's bytes but for GPS and context."""
    return [_bytes(encoded[key]) for key in sorted(encoded) if key not in ("gps", "context")]


def _bytes(part: Any) -> bytes:
    if isinstance(part, Mapping):
        return b"".join(key.encode() + _bytes(part[key]) for key in sorted(part))
    if isinstance(part, tuple | list):
        return b"".join(_bytes(entry) for entry in part)
    return part.encode() if isinstance(part, str) else np.asarray(part).tobytes()


ACTIONS = (
    {"action_type": "open_app", "app_name": "climate"},
    {"action_type": "open_app", "app_name": "map"},
    {"action_type": "show_alert", "kind": "speed"},
    {"action_type": "wait", "seconds": 8},
    {"action_type": "open_app", "app_name": "home"},
    {"action_type": "status", "goal_status": "complete"},
)


@pytest.mark.parametrize("seed", [0, 7])
def test_equal_actions_look_equal_but_for_gps_and_context(simulations, seed: int) -> None:
    task = _translated(GERMANY, AUSTRIA)
    seen: dict[str, list[dict[str, Any]]] = {}
    for half in ("first", "second"):
        env = CockpitEnv(task, half, simulations=simulations)
        seen[half] = [env.reset(seed=seed)[0]]
        seen[half] += [env.step(action)[0] for action in ACTIONS]
        env.close()
    for here, there in zip(seen["first"], seen["second"], strict=True):
        assert _without_place(here) == _without_place(there)
        assert _bytes(here["gps"]) != _bytes(there["gps"])
        assert _bytes(here["context"]) != _bytes(there["context"])
