"""What a start shows is plausible where and when it is."""

import re
from dataclasses import replace
from datetime import datetime
from functools import cache
from itertools import product

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.phone.state import Directory, Phone
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.pois import PRICES, ZONES
from automotive_cosim.cockpit.signals import HVAC, LIGHTS
from automotive_cosim.contracts import GoalStatus, Reason
from automotive_cosim.geo.place import Place, shipped
from automotive_cosim.geo.sun import sun_at
from automotive_cosim.geo.weather import FOG_BELOW_M
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.task import Basis, Half, Start, Task
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


@cache
def halves_of(task_id: str) -> list[Half]:
    return [draw(CATALOGUE[task_id], name, 0).half for name in CATALOGUE[task_id].halves]


def is_lit(task: Task, name: str) -> bool:
    """Whether the driver has switched the low beam on before the task begins, in a task that is not about lamps."""
    return task.half(name).start.signals.get(LIGHTS.SWITCH.path) == "BEAM" and not any(
        map(is_about_lamps, halves_of(task.id))
    )


@cache
def place_of(scenario: Scenario, trip: str) -> tuple[float, float, Place]:
    network = network_of(scenario)
    edge = network.edges[scenario.trip(trip).from_edge]
    lon_deg, lat_deg = GeoReference(network.map).lon_lat(*edge.shape_m[0])
    return lon_deg, lat_deg, shipped().place(lon_deg, lat_deg)


@pytest.mark.slow
@over(case for case in HALVES if is_lit(*case))
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


AIR = {
    one.path
    for one in (
        HVAC.FAN_SPEED,
        HVAC.DRIVER_TEMPERATURE,
        HVAC.PASSENGER_TEMPERATURE,
        HVAC.AIR_CONDITIONING,
        HVAC.RECIRCULATION,
        HVAC.FRONT_DEFROSTER,
    )
}
"""What keeps the glass clear. Less of it is no harmless wish where the glass fogs."""
CLEAR = 0.05
"""Share of fog from which the climate screen no longer says that the windshield is clear."""
ROAD_KMH, FOGGED_AFTER_S = 90.0, 15.0


def is_granted_or_refused(task: Task) -> bool:
    """Whether a wish about the air is granted in one half and dangerous in the other."""
    halves = halves_of(task.id)
    asks = any(half.goal.writes & AIR for half in halves)
    return asks and any(Reason.SAFETY in half.reasons for half in halves)


@over(
    (task, name)
    for task, name in HALVES
    if is_granted_or_refused(task) and task.half(name).declares is GoalStatus.COMPLETE
)
def test_no_fog_on_the_glass_speaks_against_what_is_granted(task, name):
    start = draw(task, name, 0).half.start
    weather = start.weather or opened(start.scenario, start.origin).weather[0].weather
    signals = {str(path): value for path, value in start.signals.items()}
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), aboard=start.aboard, cabin=start.cabin, signals=signals)
    speed_kmh = 0.0 if start.parked else ROAD_KMH
    for time_s in np.arange(0.0, FOGGED_AFTER_S):
        cockpit.sense(replace(outside(time_s, speed_kmh), weather=weather), 1.0)
    assert cockpit.state.cabin.windshield.fog_inside < CLEAR


HAMPERED = re.compile(r"hampers sight|in reduced sight")
"""Words of rules that leave to judgement how little is seen."""


@pytest.mark.slow
@over(
    [(task, name) for task, name in HALVES if task.half(name).basis is Basis.LAW and task.half(name).start.weather]
)
def test_where_a_rule_speaks_of_hampered_sight_it_is_hampered_beyond_doubt(task, name):
    half = draw(task, name, 0).half
    scenario = opened(half.start.scenario, half.start.origin)
    lon_deg, lat_deg, place = place_of(scenario, half.start.trip)
    rules = place.law.rules if place.law else ()
    said = [rule.text for rule in rules if rule.id == half.rule and HAMPERED.search(rule.text)]
    falls = half.start.weather.precipitation > 0
    is_day = sun_at(lon_deg, lat_deg, time_of(half.start)).elevation_deg > 0
    assert not (said and falls and is_day) or half.start.weather.visibility < FOG_BELOW_M, said


@over(task for task in CATALOGUE.values() if any("Car Park" in str(task.half(name).start) for name in task.halves))
def test_a_car_park_s_price_is_that_of_its_zone(task: Task) -> None:
    for name, seed in product(task.halves, range(6)):
        details = draw(task, name, seed).half.start.belongings.details
        for told in (told for place, told in details.items() if "Car Park" in place and "an hour" in told):
            zone = next(zone for zone in ZONES if told.startswith(f"{zone}: "))
            assert f"{PRICES[zone]:.2f} an hour" in told
