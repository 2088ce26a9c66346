"""Weather on the road: what it does to grip, speed and gaps, of the ego and of everybody else."""

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from automotive_cosim.contracts import KMH_PER_MPS, EgoEnd, Weather
from automotive_cosim.scenarios import Scenario, Trip, WeatherAt, load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.road_weather import (
    G_MPS2,
    GRIP_STEP_S,
    Forecast,
    RoadCondition,
    condition_of,
    sight_speed_mps,
)
from tests.scripted.traffic import Scripted, Stretch
from tests.traffic.in_process import InProcess

Variant = Callable[[Callable[[Path], None]], Scenario]

CLEAR = Weather(12.0, 60.0, 0.0, 1, 20.0, 20_000.0, 10.0)
RAIN = replace(CLEAR, weather_code=63, precipitation=4.0, visibility=6000.0)
DOWNPOUR = replace(CLEAR, weather_code=65, precipitation=12.0, visibility=2500.0)
SNOW = replace(CLEAR, weather_code=73, temperature_2m=-3.0, precipitation=1.0, visibility=1500.0)
BLIZZARD = replace(SNOW, weather_code=75, precipitation=4.0, visibility=400.0)
ICE = replace(CLEAR, weather_code=66, temperature_2m=-1.0, precipitation=0.5)
FOG = replace(CLEAR, weather_code=45, visibility=50.0)
HEAT = replace(CLEAR, temperature_2m=44.0)
SAND = replace(HEAT, weather_code=31, visibility=400.0)


@pytest.fixture
def empty(variant: Variant) -> Scenario:
    return variant(lambda folder: (folder / "grid.rou.xml").write_text("<routes/>") and None)


def under(weather: Weather, *later: tuple[float, Weather]) -> tuple[WeatherAt, ...]:
    return (WeatherAt(0.0, weather), *(WeatherAt(at_s, then) for at_s, then in later))


# --- what weather is --------------------------------------------------------------------------------------


def test_the_worse_the_weather_the_worse_the_road() -> None:
    grips = [condition_of(weather).friction for weather in (CLEAR, RAIN, DOWNPOUR, SNOW, BLIZZARD, ICE)]
    assert grips == sorted(grips, reverse=True)
    assert len(set(grips)) == len(grips)
    assert condition_of(CLEAR).friction == 1.0
    for weather in (RAIN, DOWNPOUR, SNOW, BLIZZARD, ICE, FOG, SAND):
        condition = condition_of(weather)
        assert condition.speed_ratio < 1.0 < condition.headway_ratio
    assert condition_of(FOG).friction == 1.0
    assert 0.9 < condition_of(HEAT).friction < 1.0
    assert condition_of(SAND).friction < condition_of(HEAT).friction


@pytest.mark.parametrize("visibility_m", [20.0, 50.0, 200.0, 1000.0])
@pytest.mark.parametrize("friction", [0.15, 0.5, 1.0])
def test_one_can_stop_within_sight(visibility_m: float, friction: float) -> None:
    speed_mps = sight_speed_mps(visibility_m, friction)
    braking_mps2 = min(3.4, friction * G_MPS2)
    assert 2.5 * speed_mps + speed_mps**2 / (2 * braking_mps2) == pytest.approx(visibility_m)


# --- the ego ----------------------------------------------------------------------------------------------


def hits(simulation: InProcess, plan: EgoPlan, condition: RoadCondition, brakes_before_m: float) -> bool:
    """Whether the ego, at 50 km/h, hits something that stands ahead and that it sees only so far before."""
    import libsumo

    traffic = simulation.depart(plan)
    libsumo.vehicletype.copy("DEFAULT_VEHTYPE", "wall")
    libsumo.route.add("wall", ["cwc0"])
    libsumo.vehicle.add("wall", "wall", typeID="wall", departLane="0", departPos="250", departSpeed="0")
    libsumo.vehicle.setSpeed("wall", 0.0)
    libsumo.vehicle.setSpeedMode("ego", 0)
    libsumo.vehicle.setLaneChangeMode("ego", 0)
    libsumo.vehicle.setSpeed("ego", 50 / KMH_PER_MPS)
    traffic._drive._driver.pedals.set_grip(condition.friction)
    step_m = 50 / KMH_PER_MPS * 0.1
    while traffic.state.around.leader is None or traffic.state.around.leader.gap_m > brakes_before_m + step_m:
        traffic.advance(0.1)
        assert traffic.state.end is None
    libsumo.vehicle.setSpeedMode("ego", 31)
    libsumo.vehicle.setSpeed("ego", -1.0)
    libsumo.vehicle.setMinGap("ego", 0.0)
    return traffic.advance(30.0).states[-1].end is EgoEnd.COLLIDED


@pytest.mark.sumo
@pytest.mark.parametrize("friction", [0.2, 0.5, 1.0])
def test_stopping_distances_are_those_of_physics(empty: Scenario, friction: float) -> None:
    """Within 15 % of v^2 / (2 mu g): from a little more the ego stops, from a little less it cannot."""
    plan = EgoPlan(empty.trip("avenue"), "average", seed=3)
    with closing(InProcess(empty, seed=1)) as simulation:
        distance_m = (50 / KMH_PER_MPS) ** 2 / (2 * friction * G_MPS2)
        assert not hits(simulation, plan, RoadCondition(friction), 1.15 * distance_m)
        assert hits(simulation, plan, RoadCondition(friction), 0.85 * distance_m)


def fastest_kmh(forked: Forked, plan: EgoPlan, weather: Weather) -> float:
    with closing(forked.depart(replace(plan, weather=under(weather)))) as traffic:
        traffic.advance(15.0)  # it enters at the limit
        return max(state.speed_mps for state in traffic.advance(45.0).states) * KMH_PER_MPS


def test_a_cautious_driver_slows_down_and_a_hurried_one_does_not(forked: Forked, hurried: EgoPlan) -> None:
    average = replace(hurried, driver="average")
    careful = [fastest_kmh(forked, average, weather) for weather in (CLEAR, RAIN, BLIZZARD, FOG)]
    assert careful[0] == pytest.approx(50.0, abs=1.0)
    assert careful[:3] == sorted(careful[:3], reverse=True)
    assert careful[1] == pytest.approx(50.0 * condition_of(RAIN).speed_ratio, abs=1.0)
    assert careful[3] <= condition_of(FOG).sight_mps * KMH_PER_MPS + 0.5
    careless = [fastest_kmh(forked, hurried, weather) for weather in (CLEAR, FOG)]
    assert min(careless) > 75.0


def test_the_state_says_how_the_road_is(forked: Forked, grid: Scenario) -> None:
    """It changes on the timeline, the sign stays, and it does not rain in the tunnel."""
    tunnel = grid.trip("tunnel")
    plan = EgoPlan(tunnel, "average", 3, under(CLEAR, (10.0, RAIN), (200.0, ICE)))
    with closing(forked.depart(plan)) as traffic:
        departure_s = traffic.state.time_s
        states = traffic.advance(600.0).states[:-1]
    open_air = {
        (state.time_s - departure_s >= 10.0, state.road.friction) for state in states if not state.road.in_tunnel
    }
    assert open_air == {(False, 1.0), (True, condition_of(RAIN).friction)}
    assert {state.road.friction for state in states if state.road.in_tunnel and ":" not in state.road.lane_id} == {
        1.0
    }
    limits = {round((state.road.limit.mps or 0) * KMH_PER_MPS) for state in states}
    assert limits == {30}


def test_the_first_look_is_on_the_road_of_its_weather(forked: Forked, hurried: EgoPlan) -> None:
    """Not on that of the scenario's own weather, which is dry."""
    with closing(forked.depart(replace(hurried, weather=under(ICE)))) as traffic:
        assert traffic.state.road.friction == condition_of(ICE).friction


def test_a_scripted_road_is_slippery_too() -> None:
    """A harder stop than the road allows is not to be had."""
    hardest = []
    for weather in (CLEAR, ICE):
        road = Scripted([Stretch("free", 300.0, 90.0), Stretch("slow", 600.0, 30.0)], start_speed_kmh=90.0)
        plan = EgoPlan(Trip("t", "", ""), "hurried", 1, under(weather))
        states = road.depart(plan).advance(60.0).states
        hardest.append(min(state.acceleration_mps2 for state in states))
    assert hardest[1] >= -condition_of(ICE).friction * G_MPS2 - 1e-6
    assert hardest[0] < hardest[1]


# --- the others -------------------------------------------------------------------------------------------


@pytest.mark.sumo
def test_the_others_drive_by_the_weather_and_back(variant: Variant, hurried: EgoPlan) -> None:
    import libsumo

    changing = under(CLEAR, (20.0, BLIZZARD), (60.0, CLEAR))
    with closing(InProcess(load("grid"), seed=1)) as simulation:
        traffic = simulation.depart(replace(hurried, driver="calm", weather=changing))
        kind, lane = libsumo.vehicletype, "s0s1_0"
        watched = ("getDecel", "getEmergencyDecel", "getTau", "getMaxSpeed")
        seen = []
        for _ in range(3):
            types = {call: getattr(kind, call)("car") for call in watched}
            factors = {v: libsumo.vehicle.getSpeedFactor(v) for v in libsumo.vehicle.getIDList() if v != "ego"}
            seen.append((types, factors, libsumo.lane.getFriction(lane), libsumo.lane.getMaxSpeed(lane)))
            traffic.advance(35.0)
    condition = condition_of(BLIZZARD)
    (dry, dry_factors, dry_friction, limit), (bad, bad_factors, friction, bad_limit), (again, *_, _) = seen
    assert bad["getDecel"] == bad["getEmergencyDecel"] == pytest.approx(condition.friction * G_MPS2)
    assert bad["getTau"] == pytest.approx(dry["getTau"] * condition.headway_ratio)
    assert bad["getMaxSpeed"] == pytest.approx(condition.sight_mps)
    assert (dry_friction, friction) == (1.0, condition.friction)
    assert bad_limit == limit, "the posted limit is not touched"
    assert again == dry
    both = dry_factors.keys() & bad_factors.keys()
    assert len(both) > 5
    for vehicle in both:
        assert bad_factors[vehicle] == pytest.approx(dry_factors[vehicle] * condition.speed_ratio)
    assert max(bad_factors.values()) <= 1.2 * condition.speed_ratio + 1e-9, "also those that came later"


def test_in_process_and_forked_alike(grid: Scenario, forked: Forked, hurried: EgoPlan) -> None:
    plan = replace(hurried, driver="average", weather=under(RAIN, (15.0, SNOW), (40.0, HEAT)))
    with closing(forked.depart(plan)) as traffic:
        traffic.advance(10.0)
        with closing(traffic.branch()) as branch:
            expected = traffic.advance(60.0)
            assert branch.advance(60.0) == expected
    with closing(InProcess(grid, seed=1)) as simulation:
        own = simulation.depart(plan)
        own.advance(10.0)
        assert own.advance(60.0) == expected


@pytest.mark.sumo
def test_a_scenario_brings_its_weather(variant: Variant, hurried: EgoPlan) -> None:
    """Its warm traffic has met it already; a plan's own weather takes its place."""

    def snow(folder: Path) -> None:
        path = folder / "scenario.toml"
        path.write_text(path.read_text().replace("weather_code = 2", "weather_code = 73"))

    with closing(Forked(variant(snow), seed=1)) as simulation:
        frictions = []
        for weather in ((), under(ICE)):
            with closing(simulation.depart(replace(hurried, weather=weather))) as traffic:
                frictions.append(traffic.advance(1.0).states[-1].road.friction)
    assert frictions == [condition_of(SNOW).friction, condition_of(ICE).friction]


def test_a_road_that_settles_takes_on_the_grip_of_other_weather_by_and_by() -> None:
    forecast = Forecast(under(CLEAR, (100.0, SNOW), (300.0, CLEAR)), 0.0, settles_s=60.0)
    grips, at_s = {}, 0.0
    while at_s < 400.0:
        grips[at_s] = forecast.read(at_s).friction
        at_s = min(forecast.until_s, 1e9)
    told = list(grips.values())
    assert max(abs(here - there) for here, there in pairwise(told)) < 0.06
    assert grips[0.0] == grips[100.0] == 1.0
    assert grips[130.0] == pytest.approx(1.0 - 0.65 / 2, abs=0.01)
    assert grips[160.0] == condition_of(SNOW).friction == min(told)
    assert told[-1] == 1.0
    assert min(there - here for here, there in pairwise(grips)) == GRIP_STEP_S


def test_a_road_that_does_not_settle_changes_with_its_weather() -> None:
    forecast = Forecast(under(CLEAR, (100.0, SNOW)), 0.0)
    assert (forecast.read(99.0), forecast.until_s) == (condition_of(CLEAR), 100.0)
    assert forecast.read(100.0) == condition_of(SNOW)
