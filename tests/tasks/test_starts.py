"""What a start shows is plausible where and when it is."""

from __future__ import annotations

from datetime import datetime
from functools import cache

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.phone.state import Directory, Phone
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import LIGHTS
from automotive_cosim.geo.place import Place, shipped
from automotive_cosim.geo.sun import sun_at
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.task import Half, Start, Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.georeference import GeoReference
from tests.cockpit.conftest import outside, town
from tests.laws import over

HALVES = [(task, name) for task in CATALOGUE.values() for name in task.halves]
LOW_SUN_DEG, GREY_PCT, FAR_M = 10.0, 90.0, 5000.0
"""Below that sun, under such a sky and with less sight, people drive with their lamps on."""


@cache
def opened(scenario: str, origin: tuple[float, float] | None) -> Scenario:
    return open_scenario(scenario, origin=origin)


def time_of(start: Start) -> datetime:
    there = opened(start.scenario, start.origin).start
    return there if start.start is None else datetime.fromisoformat(start.start).replace(tzinfo=there.tzinfo)


def is_about_lamps(half: Half) -> bool:
    return any(path.startswith("Vehicle.Body.Lights.") for path in half.goal.writes | half.may_write)


def is_lit(task: Task, name: str) -> bool:
    """Whether the driver has switched the low beam on before the task begins, in a task that is not about lamps."""
    halves = [draw(task, each, 0).half for each in task.halves]
    return task.half(name).start.signals.get(LIGHTS.SWITCH.path) == "BEAM" and not any(map(is_about_lamps, halves))


@cache
def place_of(scenario: Scenario, trip: str) -> tuple[float, float, Place]:
    network = network_of(scenario)
    edge = network.edges[scenario.trip(trip).from_edge]
    lon_deg, lat_deg = GeoReference(network.map).lon_lat(*edge.shape_m[0])
    return lon_deg, lat_deg, shipped().place(lon_deg, lat_deg)


@pytest.mark.slow
@over([case for case in HALVES if is_lit(*case)])
def test_lamps_are_lit_by_day_only_where_weather_or_law_asks_for_it(task, name):
    start = task.half(name).start
    scenario = opened(start.scenario, start.origin)
    lon_deg, lat_deg, place = place_of(scenario, start.trip)
    weather = start.weather or (scenario.weather[0].weather if scenario.weather else None)
    is_grey = weather is None or (
        weather.precipitation > 0 or weather.cloud_cover >= GREY_PCT or weather.visibility < FAR_M
    )
    rules = place.law.by_topic.get("daytime_lamps", ()) if place.law else ()
    is_asked = any(case.value == "required" for rule in rules for case in rule.cases)
    sun = sun_at(lon_deg, lat_deg, time_of(start))
    assert is_grey or is_asked or sun.elevation_deg < LOW_SUN_DEG, (place.country, sun)


@over([(task, name) for task, name in HALVES if task.half(name).start.belongings.threads])
def test_no_message_is_dated_later_than_the_start(task, name):
    start = draw(task, name, 0).half.start
    now = time_of(start)
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), belongings=start.belongings)
    cockpit.sense(outside(local_time=now), 0.0)
    for thread in cockpit.state.of(Directory).written(cockpit.state.of(Phone)):
        assert thread.when.startswith("Yesterday") or "ago" in thread.when or thread.when <= f"{now:%H:%M}"
        assert thread.when
