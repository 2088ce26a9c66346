"""Studies find what can be reckoned by hand, and SUMO's own outputs say the same."""

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import astuple, replace
from pathlib import Path

import pytest

from automotive_cosim.contracts import EgoEnd, Reroute
from automotive_cosim.errors import TrafficError
from automotive_cosim.scenarios import load
from automotive_cosim.studies.calls.accounts import Settled
from automotive_cosim.studies.calls.chance import Fresh, fresh_of, renew
from automotive_cosim.studies.calls.ledger import keep_ledger, others, run_on, settle
from automotive_cosim.studies.reroute.futures import own_choice_of
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.reroute.rows import NOTHING, Totals, TripRow
from automotive_cosim.studies.reroute.trip import run_drive
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked, RemoteCopy, RemoteTraffic

from .conftest import EDGES, LORRY_EVERY_S, SLOW_MPS, SPEED_MPS

pytestmark = pytest.mark.sumo

STEP_S = 0.1


@pytest.fixture(scope="module")
def driven(small: StudyPlan, tmp_path_factory: pytest.TempPathFactory) -> tuple[TripRow, Path]:
    """The row of the one drive, and the folder of SUMO's outputs."""
    outputs = tmp_path_factory.mktemp("outputs")
    (job,) = replace(small, step_s=STEP_S).jobs()
    scene = job.plan.scene(job.share)
    with closing(Forked(scene, job.seed, allow_unprojected=True, outputs=outputs)) as simulation:
        simulation.call(keep_ledger)
        return run_drive(job, simulation, ()), outputs


def length_m(*edges: str) -> float:
    return sum(EDGES[edge][2] for edge in edges)


def reckoned_s() -> tuple[float, float]:
    """Travel time on the main road and on the other way, by hand.

    The ego begins with its front bumper 4.6 m into the road, at the limit. On the main road it comes up behind the
    last lorry that is on its way 100 m in, and follows it: a lorry's length, the gap at a standstill and a second's
    headway behind. At the end of the main road the lorry turns off."""
    access_s = (length_m("access") - 4.6) / SPEED_MPS
    other_s = access_s + length_m("out", "back", "exit") / SPEED_MPS
    behind_m = 7.5 + 2.5 + 1.0 * SLOW_MPS
    meets_s = access_s + (100.0 - 7.5 - 2.5) / SPEED_MPS  # later lorries come in behind the ego
    lorry_s = meets_s // LORRY_EVERY_S * LORRY_EVERY_S  # the warm-up is whole periods long
    leaves_s = lorry_s + (length_m("main") - 100.0) / SLOW_MPS + behind_m / SLOW_MPS
    return leaves_s + length_m("exit") / SPEED_MPS, other_s


def test_the_gain_is_the_one_reckoned_by_hand(driven: tuple[TripRow, Path]) -> None:
    row, _ = driven
    (decision,) = row.decisions
    stay = row.stay
    assert stay is not None
    (branch,) = decision.branches
    stay_s, other_s = reckoned_s()
    assert stay.time_s == pytest.approx(stay_s, abs=1.0), "to the time it takes to speed up again"
    assert branch.totals.time_s == pytest.approx(other_s, abs=1.0)
    assert branch.gains.time_s == pytest.approx(stay_s - other_s, abs=1.0)
    assert branch.gains.distance_m == pytest.approx(length_m("main") - length_m("out", "back"), abs=1e-6)
    assert branch.gains.stops == 0
    assert (stay.way_s, branch.totals.way_s) == pytest.approx((2000.0 / SPEED_MPS, 2500.0 / SPEED_MPS), abs=2.0)
    assert branch.gains.lost_s == pytest.approx(stay_s - other_s + 50.0, abs=3.0), "all of it, and the detour's"
    assert branch.others.gain_s == 0, "the lorries never have the ego before them"


def test_sumos_own_outputs_say_the_same(driven: tuple[TripRow, Path]) -> None:
    row, outputs = driven
    told = futures(row)
    found = list(trips(outputs))
    assert len(found) == len(told)
    for totals, trip in paired(told, found):
        assert totals.time_s == pytest.approx(trip.time_s, abs=1e-6)
        assert totals.distance_m == pytest.approx(trip.distance_m, abs=0.01)
        assert totals.stops == trip.stops
        assert totals.standing_s == pytest.approx(trip.standing_s, abs=1e-6)
        assert totals.co2_g == pytest.approx(trip.co2_g, rel=0.005), "to the step in which it arrives"
        assert totals.fuel_g == pytest.approx(trip.fuel_g, rel=0.005)
        assert totals.lost_s == pytest.approx(trip.lost_s, abs=1.0), "to the step in which it arrives"


def test_they_say_the_same_where_cars_stop_and_waver(tmp_path: Path) -> None:
    plan = StudyPlan("grid", trips=("round",), least_delay_s=0.0, per_drive=1)
    job = plan.jobs()[0]
    with closing(Forked(plan.scene(0.6), 3, outputs=tmp_path)) as simulation:
        simulation.call(keep_ledger)
        simulation.call(run_on, 100.0)
        row = run_drive(job, simulation, ())
    told = futures(row)
    assert any(totals.stops for totals in told)
    for totals, trip in paired(told, trips(tmp_path)):
        for name in ("time_s", "distance_m", "stops", "standing_s", "lost_s"):
            assert getattr(totals, name) == pytest.approx(getattr(trip, name), abs=1.0), name
        assert totals.co2_g == pytest.approx(trip.co2_g, rel=0.02)


def futures(row: TripRow) -> list[Totals]:
    """The drive's own, the branches' of its one decision, and the placebo's."""
    (decision,) = row.decisions
    assert row.stay is not None
    assert decision.placebo is not None
    return [row.stay, *(branch.totals for branch in decision.branches), decision.placebo.totals]


def paired(told: Iterable[Totals], found: Iterable[Totals]) -> Iterator[tuple[Totals, Totals]]:
    """In the order of their values, as nothing names them."""
    ordered = (sorted(each, key=lambda one: [round(value, 1) for value in astuple(one)]) for each in (told, found))
    return zip(*ordered, strict=True)


def trips(outputs: Path) -> Iterator[Totals]:
    """The ego's trip in every future that was driven to its end, by SUMO's tripinfo."""
    for path in sorted(outputs.glob("*/tripinfo.xml")):
        for trip in ET.parse(path).getroot():
            if trip.get("id") == "ego":
                (emissions,) = trip.iter("emissions")
                yield Totals(
                    time_s=float(trip.attrib["duration"]),
                    distance_m=float(trip.attrib["routeLength"]),
                    stops=int(trip.attrib["waitingCount"]),
                    standing_s=float(trip.attrib["waitingTime"]),
                    co2_g=float(emissions.attrib["CO2_abs"]) / 1000,
                    fuel_g=float(emissions.attrib["fuel_abs"]) / 1000,
                    lost_s=float(trip.attrib["timeLoss"]),
                )


def test_branches_without_a_choice_stay_the_same_to_the_last(tmp_path: Path) -> None:
    """Everybody's trip, as SUMO writes it to the sixth digit, and the ego's whole way."""
    scenario = load("grid")
    with closing(Forked(scenario, 2, outputs=tmp_path)) as simulation:
        simulation.call(keep_ledger)
        simulation.call(run_on, 60.0)
        traffic = simulation.depart(EgoPlan(scenario.trip("round"), seed=1))
        traffic.advance(30.0)
        group, _ = traffic.call(others)
        asked = traffic.branch()
        asked.alternatives(60.0)
        own_choice_of(asked)
        watched = traffic.branch()
        futures = [traffic, asked, traffic.branch()]
        for future in futures:
            future.begin(settle, [group], 0.95, 3600.0)
        outcomes: list[Settled] = [future.ended() for future in futures]
        watched.advance(3600.0)
        seen, told = watched.state, watched.call(settle, [group], 0.95, 3600.0)
        for future in (*futures, watched):
            future.close()
    last = futures[0].state
    assert outcomes[0].is_complete
    assert last.end is seen.end is EgoEnd.ARRIVED
    assert outcomes[0] == outcomes[1] == outcomes[2]
    assert last == futures[1].state == futures[2].state
    assert told == outcomes[0], "whether anybody reads what the ego sees"
    assert (seen.time_s, seen.distance_m) == (last.time_s, last.distance_m)
    assert seen.ahead.route_left_m == last.ahead.route_left_m
    for name in ("tripinfo.xml", "fcd.xml"):
        written = [rows(path) for path in sorted(tmp_path.glob(f"drive-*/{name}"))]
        longest = max(map(len, written))
        whole = [each for each in written if len(each) == longest]
        assert len(whole) == 4, "the copies that were only asked have ended early"
        assert all(each == whole[0] for each in whole)


def rows(path: Path) -> list[bytes]:
    return [ET.tostring(element) for element in ET.parse(path).getroot()]


def test_a_choice_changes_nothing_before_it(small: StudyPlan) -> None:
    (job,) = small.jobs()
    with closing(Forked(job.plan.scene(0.0), 0, allow_unprojected=True)) as simulation:
        simulation.call(keep_ledger)
        traffic = simulation.depart(EgoPlan(job.trip, "steady"))
        before = traffic.advance(20.0).states
        with closing(traffic), closing(traffic.branch()) as branch:
            way = branch.alternatives()[1]
            assert branch.request(Reroute(edges=way.edges)).accepted
            assert branch.state == traffic.state == before[-1]
            after: list[RemoteTraffic] = [traffic, branch]
            paths = [[state.road.edge_id for state in each.advance(400.0).states] for each in after]
    assert "main" in paths[0]
    assert "main" not in paths[1]


def test_old_news_is_what_was_known_then(small: StudyPlan) -> None:
    """Lorries that are on the road for one minute are not yet in news that is two minutes old."""
    (job,) = small.jobs()
    scene = job.plan.scene(0.0)
    scene = replace(scene, sumo=replace(scene.sumo, warm_up_s=60.0))
    with closing(Forked(scene, 0, allow_unprojected=True)) as simulation:
        simulation.call(keep_ledger)
        simulation.call(run_on, 120.0)
        with closing(simulation.depart(EgoPlan(job.trip, "steady"))) as traffic:
            now, old = traffic.alternatives(0.0), traffic.alternatives(900.0)
            assert now == traffic.alternatives()
    assert now[0].delay_s > 50
    assert old[0].delay_s == pytest.approx(0, abs=1e-6)
    free_s = length_m("access", "main", "exit") / SPEED_MPS
    assert old[0].eta_s == pytest.approx(free_s, rel=0.02)


def test_traffic_that_leaves_nothing_to_chance_has_one_future(small: StudyPlan) -> None:
    (job,) = replace(small, replicates=3).jobs()
    with closing(Forked(job.plan.scene(0.0), 0, allow_unprojected=True)) as simulation:
        simulation.call(keep_ledger)
        assert fresh_of(simulation) is Fresh.SEED_UNSEEN
        row = run_drive(job, simulation, ())
    (decision,) = row.decisions
    assert row.fresh is Fresh.SEED_UNSEEN
    assert decision.draws == 3
    assert decision.placebo is None
    for replicate in decision.replicates:
        assert replicate.stay.gains == NOTHING
        assert replicate.branches == decision.branches


@pytest.mark.parametrize("fresh", [None, Fresh.JITTER])
def test_a_replicate_is_another_future_and_its_seed_gives_it_again(fresh: Fresh | None) -> None:
    """Both by true seeds, which the shipped SUMO allows, and where it does not."""
    scenario = load("grid")
    with closing(Forked(scenario, 2)) as simulation:
        simulation.call(keep_ledger)
        proven = fresh_of(simulation)
        assert proven is Fresh.SEED
        with closing(simulation.depart(EgoPlan(scenario.trip("round"), seed=1))) as traffic:
            group, _ = traffic.call(others)

            def settled(seed: int | None) -> dict[str, float]:
                with closing(traffic.branch()) as copy:
                    if seed is not None:
                        copy.call(renew, fresh or proven, seed)
                    return copy.call(settle, [group], 0.95, 3600.0).arrivals_s

            same, first, again, other = settled(None), settled(5), settled(5), settled(6)
            assert settled(None) == same
    assert first == again
    assert len({tuple(sorted(each.items())) for each in (same, first, other)}) == 3


def test_a_library_without_the_symbols_is_replaced_by_jitter(
    monkeypatch: pytest.MonkeyPatch, small: StudyPlan
) -> None:
    (job,) = small.jobs()
    with closing(Forked(job.plan.scene(0.0), 0, allow_unprojected=True)) as simulation:
        simulation.call(keep_ledger)
        monkeypatch.setattr(simulation, "copy", refused)
        assert fresh_of(simulation) is Fresh.JITTER
        row = run_drive(job, simulation, ())
    assert row.fresh is Fresh.JITTER
    assert row.decisions[0].placebo is not None


def refused() -> RemoteCopy:
    raise TrafficError("the simulation died: by SIGSEGV")
