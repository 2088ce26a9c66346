"""A town in which more and more cars have an assistant: who is silent changes nothing, and how the rest is told."""

import json
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.contracts import DrivingState, Observation, Reroute, RouteOption, SlowDown
from automotive_cosim.errors import UserError
from automotive_cosim.run.executor import tried
from automotive_cosim.run.fleet_record import read_fleet
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.store import FORMAT
from automotive_cosim.serve.records import NotHereError
from automotive_cosim.studies.adoption import adoption
from automotive_cosim.studies.adoption.adoption import (
    AdoptionPlan,
    AdoptionRow,
    AdoptionStudy,
    Cohort,
    ShareLog,
    ShareOutcome,
    fleet_id,
    run_seed,
)
from automotive_cosim.studies.adoption.page import answer, charts, effects, fleets, gone, warnings
from automotive_cosim.studies.adoption.served import cars, shares
from automotive_cosim.studies.calls import chosen, town
from automotive_cosim.studies.calls.town import CarTrip
from automotive_cosim.traffic.fork import Forked
from tests.traffic.in_process import InProcess

PLAN = AdoptionPlan("grid", seeds=(0, 1), minutes=2.0, warm_up_s=120.0, shares=(0.0, 50.0, 100.0))


def cohort(gain_s: float) -> Cohort:
    return Cohort(
        cars=10,
        arrived=9,
        time_s=200.0 - gain_s,
        before_s=200.0,
        lost_s=50.0,
        side=0.1,
        near_s_h=3.0,
        energy_wh_km=600.0,
    )


def outcome(share: float, equipped_s: float, others_s: float) -> ShareOutcome:
    return ShareOutcome(
        share=share,
        equipped=cohort(equipped_s) if share else None,
        others=cohort(others_s) if share < 1 else None,
        all=cohort(share * equipped_s + (1 - share) * others_s),
        reroutes=4,
        warnings=6,
        hazards=3,
        failed=0,
    )


def study(*outcomes: ShareOutcome) -> AdoptionStudy:
    return seeds_of([outcomes for _ in PLAN.seeds])


def seeds_of(driven: Sequence[Sequence[ShareOutcome]]) -> AdoptionStudy:
    rows = [
        AdoptionRow(id=f"seed{seed}", scenario="grid", seed=seed, shares=tuple(each))
        for seed, each in enumerate(driven)
    ]
    return AdoptionStudy(Path(), {}, PLAN, tuple(rows))


def test_herding_is_what_is_gone_of_the_first_gain() -> None:
    found = study(outcome(0.0, 0, 0), outcome(0.05, 40, 1), outcome(0.5, 10, -2), outcome(1.0, -5, 0))
    herding = gone(found)
    assert herding is not None
    assert herding[:3] == (0.05, 0.5, 0.75)
    assert "75% of the gain is gone, which 2 seeds cannot tell from chance" in answer(found)
    assert "5.0 s later per car" in answer(found)
    assert [row[0] for row in effects(found).rows] == ["0%", "5%", "50%", "100%"]
    assert set(charts(found)) == {"gains"}
    assert any("had not ended" in warning for warning in warnings(found))
    assert gone(study(outcome(0.05, -3, 1), outcome(0.5, 10, -2))) is None


@pytest.mark.parametrize(
    ("left_s", "told"), [(10, "75% of the gain is gone (95 %: 2"), (39, "s, which may be chance)")]
)
def test_herding_has_the_interval_of_its_seeds(left_s: float, told: str) -> None:
    days = [(outcome(0.05, 40, 1), outcome(0.5, left_s + 4 * (-1) ** day, 0)) for day in range(10)]
    assert told in answer(seeds_of(days))


def test_warnings_of_one_kind_on_one_road_within_a_minute_are_of_one_hazard() -> None:
    said = ShareLog(
        warned=[
            ("traffic", "a", 0.0, "1"),
            ("traffic", "a", 59.0, "2"),
            ("traffic", "b", 1.0, "1"),
            ("slippery", "a", 2.0, "1"),
        ]
    )
    assert said.hazards == 3
    said.warned.append(("traffic", "a", 119.0, "3"))
    assert said.hazards == 4


def trips_with(warm: Forked, share: float, seconds: float) -> Mapping[str, CarTrip]:
    with closing(warm.road()) as road:
        road.call(town.equip, share, 1, "average")
        for _ in range(round(seconds)):
            road.run(1.0)
            for car in road.entered():
                assert car.state.time_s == road.time_s
        trips: Mapping[str, CarTrip] = road.call(town.trips_of)
        return trips


def test_silent_assistants_change_nothing_and_none_is_plain_sumo(sumo: None) -> None:
    scenario = PLAN.scene()
    with closing(Forked(scenario, 1)) as warm:
        warm.call(town.follow_town)
        none, all_ = trips_with(warm, 0.0, 90), trips_with(warm, 1.0, 90)
    assert len(none) > 20
    assert all_ == none
    with closing(InProcess(scenario, 1)) as plain:
        world = plain.world
        assert world is not None
        bare = town.Town(
            world._sumo,
            world.step_s,
            frozenset(
                each.edge_id for each in world.network.edges.values() if each.road_class in town.SIDE_STREETS
            ),
        )
        for _ in range(90):
            world._sumo.step()
            bare.after_step()
        assert bare.trips == none


def test_every_share_ends_at_the_same_instant_though_cars_set_out_between_seconds(
    sumo: None, tmp_path: Path
) -> None:
    plan = replace(PLAN, agent="never", seeds=(1,), step_s=0.1, minutes=0.6, shares=(0.0, 100.0))
    none, full = tried(run_seed)(plan.jobs()[0], tmp_path).shares
    assert any(round(car.departs_s, 1) % 1 for car in full.cars)
    assert full.all == none.all


@pytest.mark.slow
@pytest.mark.parametrize("agent", ["never", "always", "silent", "alert-often"])
def test_a_study_of_an_agent(agent: str, sumo: None, tmp_path: Path) -> None:
    plan = replace(PLAN, agent=agent, seeds=(1,), every_s=20.0)
    plan.check()
    row = tried(run_seed)(plan.jobs()[0], tmp_path)
    assert row.error is None
    none, half, full = row.shares
    assert (none.share, half.share, full.share) == (0.0, 0.5, 1.0)
    assert none.equipped is None
    assert full.others is None
    assert not none.cars
    for share in (half, full):
        drove = read_fleet(tmp_path, fleet_id(1, share.share))
        assert drove is not None
        assert {each.car for each in share.cars} >= drove.ways.keys() > set()
        assert share.reroutes == sum(each.reroutes for each in share.cars)
        assert share.warnings == sum(each.warnings for each in share.cars)
    assert {each.car for each in half.cars} < {each.car for each in full.cars}
    assert half.equipped
    assert half.others
    assert none.all.time_s == none.all.before_s
    if agent in ("never", "silent"):
        assert half.all == full.all == none.all
        assert full.reroutes == full.warnings == 0
    elif agent == "always":
        assert full.reroutes > half.reroutes > 0
        assert full.all != none.all
    else:
        assert full.warnings > half.warnings > 0
        assert full.failed == 0


def test_a_day_of_choices_is_the_same_traffic_and_asks_each_driver_as_he_sets_out(sumo: None) -> None:
    scenario = PLAN.scene()
    with closing(Forked(scenario, 1)) as warm:
        warm.call(chosen.prepare)
        silent = chosen.day(warm, {}, 180.0)
        warm.call(town.follow_town)
        plain = trips_with(warm, 0.0, 180)
        assert {car: (trip.planned_s, trip.until_s, trip.has_left) for car, trip in plain.items()}.items() <= {
            car: (trip.planned_s, trip.until_s, trip.has_arrived) for car, trip in silent.items()
        }.items()
        car = next(car for car, trip in plain.items() if trip.has_left)
        slow = chosen.day(warm, {car: SlowDown(10.0)}, 180.0)
        assert slow[car].until_s > silent[car].until_s
        with pytest.raises(UserError, match="nowhere"):
            chosen.day(warm, {car: Reroute(edges=("nowhere",))}, 180.0)


class _Stumbling:
    """An agent of one's own that raises whenever it is asked."""

    channels = ("vehicle",)

    def reset(self, goal: str) -> None: ...

    def act(self, observation: Observation) -> object:
        raise ValueError("a fault of one answer")


@pytest.mark.slow
def test_cockpits_in_a_scenario_without_weather_have_the_climates_and_a_fault_costs_a_step(
    sumo: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    scene = replace(PLAN.scene(), weather=())
    monkeypatch.setattr(AdoptionPlan, "scene", lambda self: scene)
    plan = replace(PLAN, agent="tests.studies.test_adoption:_Stumbling", seeds=(1,), minutes=1.0, shares=(100.0,))
    row = tried(run_seed)(plan.jobs()[0], tmp_path)
    assert row.error is None
    assert not any(car.error for car in row.shares[-1].cars)
    assert sum(car.refused for car in row.shares[-1].cars) > len(row.shares[-1].cars)
    assert any("were no action" in line for line in warnings(AdoptionStudy(tmp_path, {}, plan, (row,))))
    assert "a fault of one answer" in str(read_fleet(tmp_path, fleet_id(1, 1.0)))


class Odd:
    """An assistant of one's own that advises half of its cars and fails in three ways for others."""

    def __init__(self, seed: int) -> None:
        self.asked: dict[str, int] = {}
        self.slow = threading.Event()

    def advise(self, car: str, state: DrivingState, ways: Callable[[], Sequence[RouteOption]]) -> object:
        self.asked[car] = self.asked.get(car, 0) + 1
        match sum(map(ord, car)) % 6:
            case 0:
                raise ValueError("a fault of one car")
            case 1:
                return "left, I think" if len(car) % 2 else SlowDown(float("nan"))
            case 2 if len(self.asked) < 20:
                self.slow.wait(30)
                return None
            case 3:
                return SlowDown(20.0)
            case _:
                return Reroute(edges=ways()[-1].edges)


def test_an_assistants_errors_are_those_of_one_car(
    sumo: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(adoption, "HANGS_S", 0.05)
    job = replace(PLAN, agent="never", seeds=(1,), minutes=1.0, every_s=20.0).jobs()[0]
    with closing(adoption.warmed_up(job)) as warm:
        odd = Odd(1)
        said, trips = adoption.drive(job, warm, 1.0, odd, keeps=tmp_path)  # type: ignore[arg-type]
        silent, before = adoption.drive(job, warm, 0.0)
    kinds = {car: sum(map(ord, car)) % 6 for car in odd.asked}
    late = [car for car in list(odd.asked)[:19] if kinds[car] == 2]
    assert len(said.errors) == sum(kind < 2 for kind in kinds.values()) + len(late) > len(late) > 0
    assert all(odd.asked[car] == 1 for car, kind in kinds.items() if kind < 2)
    assert max(odd.asked.values()) > 1
    assert said.rerouted.total() > 0 == len(silent.errors)
    assert trips.keys() == before.keys() > {car for car, kind in kinds.items() if kind < 2}
    assert trips != before
    row = AdoptionRow(
        id="seed1", scenario="grid", seed=1, shares=(adoption._outcome(job, 1.0, said, trips, before),)
    )
    assert {each.car for each in row.shares[0].cars if each.error} == said.errors.keys()
    picture, pages = fleets(AdoptionStudy(tmp_path, {}, replace(PLAN, seeds=(1,)), (row,)))
    (page,) = pages.values()
    assert page.count('<span class="no">failed</span>') == len(said.errors)
    assert page.count('class="card one"') == len(row.shares[0].cars)
    assert 'class="way failed"' in picture
    assert 'href="cars-seed1-100.html#car-1"' in picture
    plan = {"format": FORMAT, "plan": replace(PLAN, seeds=(1,)).as_json()}
    (tmp_path / "manifest.json").write_text(json.dumps(plan))
    (tmp_path / "episodes.jsonl").write_text(json.dumps(as_json(row)) + "\n")
    assert shares(tmp_path)["fleets"] == [{"id": "seed1-100", "words": "seed 1, 100 %", "running": False}]
    assert len(cars(tmp_path, "seed1-100")["cars"]) == len(row.shares[0].cars)
    with pytest.raises(NotHereError, match="seed9"):
        cars(tmp_path, "seed9-100")


def test_a_file_of_actions_is_an_agent(tmp_path: Path) -> None:
    path = tmp_path / "acts.jsonl"
    with pytest.raises(UserError, match=r"acts\.jsonl"):
        replace(PLAN, agent=str(path)).check()
    path.write_text('{"action_type": "wait", "seconds": 5}')
    replace(PLAN, agent=str(path)).check()


def test_a_class_of_ones_own_advises_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    own = "tests.studies.test_adoption:Odd"
    replace(PLAN, agent=own).check()
    assert isinstance(adoption.own_assistant(own, 1), Odd)
    assert adoption.own_assistant("rule-perfect", 1) is None
    monkeypatch.setattr(Odd, "__init__", lambda self: None)
    with pytest.raises(UserError, match="Odd"):
        replace(PLAN, agent=own).check()
