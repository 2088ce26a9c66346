"""A scenario's proof: what is shipped holds, and each kind of slip is found."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.incidents import Breakdown, EmergencyVehicle, Incident
from automotive_cosim.scenarios import Ego, Scenario, Street, Trip, open_scenario
from automotive_cosim.scenarios.check import ScenarioProof, by_clock, check
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic import stability
from automotive_cosim.traffic.posted_limits import timed_limits


def _coarse(scenario: Scenario, warm_up_s: float | None = None) -> Scenario:
    """In steps of a second, with a shorter warm-up if asked for."""
    sumo = scenario.sumo if warm_up_s is None else replace(scenario.sumo, warm_up_s=warm_up_s)
    return replace(scenario, sumo=replace(sumo, step_length_s=1.0))


GRID = _coarse(scenarios.load("grid"), 30.0)


def _failing(proof: ScenarioProof) -> dict[str, str]:
    return {item.name: item.detail for item in proof.items if not item.ok}


def _with_trips(*trips: Trip) -> Scenario:
    return replace(GRID, ego=Ego(trips))


AVENUE = GRID.trip("avenue")


@pytest.fixture(scope="module")
def found(sumo: None) -> ScenarioProof:
    return check(GRID)


def test_every_thing_declared_is_looked_at(found: ScenarioProof) -> None:
    names = [item.name for item in found.items]
    assert names[:3] == ["loads", "place", "roads"]
    assert {f"trip {trip.name}" for trip in GRID.ego.trips} <= set(names)
    assert {f"street {street.name}" for street in GRID.streets} <= set(names)
    assert names[-1] == "an hour of traffic"
    assert found.ok
    assert found.as_json()["ok"] is True


def test_every_shipped_scenario_names_its_streets() -> None:
    for name in scenarios.shipped():
        assert len(scenarios.load(name).streets) >= 2, name


@pytest.mark.parametrize(("hour", "now"), [(23, "0.3"), (12, "0.0")])
def test_limits_that_the_file_of_the_network_does_not_have_at_this_hour_are_told(hour: int, now: str) -> None:
    plain = next(iter(network_of(GRID).edges.values()))
    timed = replace(plain, length_m=300.0, timed_limits=timed_limits("30 @ (22:00-06:00)")[0])
    told = by_clock([plain, timed], GRID.start.replace(hour=hour, minute=0))
    assert f"on 0.3 km: at {hour}:00 {now} km of it have another limit than in the network's file" in told
    assert by_clock([plain], GRID.start) == ""


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("street", "said"),
    [
        (Street("Avenue Foch"), "is not in the network"),
        (Street("Avenue Centrale", ("30",)), "there is no sign for 30"),
        (Street("Avenue Centrale", ("50", "30 mph")), "there is no sign for 30 mph"),
        (Street("Avenue Centrale", ("unposted",)), "there is no sign for unposted"),
        (Street("Rue du Nord", ("30",)), "there is no sign for 30"),
    ],
)
def test_a_street_that_is_otherwise_fails(street: Street, said: str) -> None:
    failing = _failing(check(replace(_with_trips(AVENUE), streets=(street,)), quick=True))
    assert said in failing[f"street {street.name}"]
    assert len(failing) == 1


@pytest.mark.sumo
def test_an_edge_with_another_limit_than_declared_is_named() -> None:
    mixed = check(
        replace(_coarse(scenarios.load("new_york"), 30.0), streets=(Street("Madison Avenue", ("25 mph",)),)),
        quick=True,
    )
    assert "has another limit than 25 mph" in _failing(mixed)["street Madison Avenue"]


@pytest.mark.sumo
def test_a_sign_that_is_none_is_the_authors_error() -> None:
    with pytest.raises(ScenarioError, match="'fifty' is not a maxspeed"):
        check(replace(_with_trips(AVENUE), streets=(Street("Avenue Centrale", ("fifty",)),)), quick=True)


@pytest.mark.sumo
@pytest.mark.parametrize("trip", [Trip("lost", "cwc0", "nowhere"), Trip("lost", "nowhere", "cwc0")])
def test_a_trip_that_cannot_be_driven_fails_alone(trip: Trip) -> None:
    failing = _failing(check(_with_trips(AVENUE, trip), quick=True))
    assert "has no edge 'nowhere'" in failing.pop("trip lost")
    assert failing == {}


@pytest.mark.sumo
def test_a_trip_that_is_blocked_for_good_does_not_arrive(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("automotive_cosim.scenarios.check.LONGEST_DRIVE_S", 240.0)
    blocks = tuple(Breakdown(edge="c2c3", lane=lane, position_m=150.0) for lane in (0, 1))
    failing = _failing(check(replace(_with_trips(AVENUE), incidents=blocks), quick=True))
    assert "is still on its way" in failing["trip avenue"]
    assert "Avenue Centrale" in failing["trip avenue"]


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("incident", "is_met"),
    [
        (Breakdown(edge="c2c3", lane=0, position_m=150.0, to_s=60.0), True),
        (Breakdown(edge="s2s3", lane=0, position_m=150.0, to_s=60.0), False),
        (Breakdown(edge="c2c3", lane=0, position_m=150.0, from_s=4000.0), False),
        (EmergencyVehicle(trip="avenue", at_m=200.0), True),
        (EmergencyVehicle(trip="avenue", at_m=9000.0), False),
    ],
)
def test_a_situation_that_the_ego_never_meets_fails(incident: Incident, is_met: bool) -> None:
    proof = check(replace(_with_trips(AVENUE), incidents=(incident,)), quick=True)
    assert ({f"situation {incident.kind}"} == set(_failing(proof))) is not is_met


@pytest.mark.sumo
def test_a_situation_on_no_road_does_not_load() -> None:
    failing = _failing(check(replace(GRID, incidents=(Breakdown(edge="x", position_m=9.0),)), quick=True))
    assert "no edge 'x'" in failing["loads"]


@pytest.mark.sumo
@pytest.mark.parametrize(("field", "value"), [("country", "DE"), ("start", None)])
def test_a_country_or_clock_that_is_not_the_places_fails(field: str, value: object) -> None:
    from zoneinfo import ZoneInfo

    value = value or GRID.start.replace(tzinfo=ZoneInfo("America/New_York"))
    assert set(_failing(check(replace(_with_trips(AVENUE), **{field: value}), quick=True))) == {"place"}  # type: ignore[arg-type]


def test_a_network_that_is_broken_does_not_load(tmp_path: Path) -> None:
    shutil.copytree(GRID.folder, tmp_path / "grid")
    net = tmp_path / "grid" / "grid.net.xml"
    net.write_text(net.read_text()[:-2000])
    failing = _failing(check(open_scenario(tmp_path / "grid"), quick=True))
    assert "not a complete SUMO network" in failing["loads"]


@pytest.mark.sumo
def test_traffic_that_locks_up_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: dict[str, float] = {}
    flow = stability.Stability(1.0, 0, 1.0, 3600.0, 0.9, 0.5, 80.0, 99, 5, 7, 0, 0, 0.0)

    def measured(scenario: Scenario, *, step_length_s: float, **_: object) -> stability.Stability:
        seen["step"] = step_length_s
        return flow

    monkeypatch.setattr("automotive_cosim.scenarios.check.measure", measured)
    detail = _failing(check(_with_trips(AVENUE)))["an hour of traffic"]
    assert "90% of the vehicles halted" in detail
    assert "7 vehicles stood" in detail
    assert seen["step"] == GRID.sumo.step_length_s


@pytest.mark.sumo
def test_progress_is_told() -> None:
    told: list[tuple[str, float | None]] = []
    check(_with_trips(AVENUE), quick=True, tell=lambda what, share: told.append((what, share)))
    assert told[0] == ("loading", None)
    assert ("warming up", 1.0) in told
    assert told[-1] == ("driving the trip avenue", None)


@pytest.mark.proof
@pytest.mark.sumo
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("name", scenarios.shipped())
@pytest.mark.parametrize("steps", [_coarse, lambda scenario: scenario], ids=["of a second", "its own"])
def test_every_shipped_scenario_holds(name: str, steps: Callable[[Scenario], Scenario]) -> None:
    """The hour of traffic is looked at in ``tests/sumo_scenarios``."""
    assert _failing(check(steps(open_scenario(name)), quick=True)) == {}
