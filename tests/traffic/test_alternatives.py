"""Other ways to the goal: what is offered, how honest its times are, and that nothing is left behind."""

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from statistics import mean, median

import pytest

from automotive_cosim.contracts import EgoEnd, Reroute
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.base import EgoPlan, Traffic
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.network import read_network
from tests.scripted.traffic import Scripted, Stretch
from tests.traffic.in_process import InProcess

pytestmark = pytest.mark.sumo

Variant = Callable[[Callable[[Path], None]], Scenario]


@pytest.fixture
def average(grid: Scenario) -> EgoPlan:
    return EgoPlan(grid.trip("avenue"), "average", seed=3)


def test_what_is_offered(grid: Scenario, forked: Forked, average: EgoPlan) -> None:
    network = read_network(grid.folder / "grid.net.xml")
    with closing(forked.depart(average)) as traffic:
        traffic.advance(5.0)
        now, *others = traffic.alternatives()
        assert now.edges == traffic.state.ahead.route_edges
        assert now.length_m == pytest.approx(traffic.state.ahead.route_left_m, rel=0.01)
    assert 2 <= len(others) <= 3
    assert [option.eta_s for option in others] == sorted(option.eta_s for option in others)
    for option in others:
        assert (option.edges[0], option.edges[-1]) == (now.edges[0], now.edges[-1])
        assert all(there in network.crossings[here] for here, there in pairwise(option.edges))
        assert option.eta_s > option.delay_s >= 0
        length_m = sum(network.edges[edge].length_m for edge in option.edges)
        for other in (now, *others):
            if other is not option:
                shared_m = sum(network.edges[edge].length_m for edge in option.edges if edge in other.edges)
                earlier = (now, *others).index(other) < (now, *others).index(option)
                assert shared_m / length_m <= 0.75 or not earlier or other.eta_s <= option.eta_s
        assert option.edges != now.edges


def test_stops_are_passed_by_every_way_if_they_are_to_be_kept(grid: Scenario, forked: Forked) -> None:
    """By the other ways, by the quickest way now, and by what SUMO's own device would take."""
    trip = grid.trip("round")
    found = {}
    for keeps in (False, True):
        with closing(forked.depart(EgoPlan(trip, seed=3, keeps_stops=keeps))) as traffic:
            traffic.advance(5.0)
            ways = [each.edges for each in traffic.alternatives()[1:]]
            traffic.request(Reroute())
            ways.append(traffic.state.ahead.route_edges)
        found[keeps] = [[edge for edge in way if edge in trip.via] == list(trip.via) for way in ways]
    assert all(found[True])
    assert len(found[True]) > 2
    assert not any(found[False][:-1]), "they need not, so the test can fail"


def test_asking_leaves_nothing_behind(grid: Scenario, forked: Forked, average: EgoPlan) -> None:
    """Neither a weight nor a random number: the traffic goes on as if nobody had asked, here and in a copy."""
    with closing(forked.depart(average)) as asking, closing(forked.depart(average)) as silent:
        for age_s in (0.0, 300.0, 0.0, 900.0):
            asking.alternatives(age_s)
            assert asking.advance(15.0) == silent.advance(15.0)
        expected = asking.alternatives()
        with closing(InProcess(grid, seed=1)) as simulation:
            own = simulation.depart(average)
            own.advance(30.0)
            own.alternatives()
            own.advance(30.0)
            assert own.alternatives() == expected
            assert own.advance(60.0) == silent.advance(60.0)


def test_a_chosen_way_is_driven(forked: Forked, average: EgoPlan) -> None:
    """Also when it was chosen some seconds after it was offered."""
    with closing(forked.depart(average)) as traffic:
        traffic.advance(2.0)
        option = traffic.alternatives()[1]
        traffic.advance(2.0)
        assert traffic.request(Reroute(edges=option.edges)).accepted
        states = traffic.advance(900.0).states
    met = dict.fromkeys(state.road.edge_id for state in states if not state.road.edge_id.startswith(":"))
    assert tuple(met) == option.edges
    assert states[-1].end is EgoEnd.ARRIVED


def test_a_jam_makes_another_way_quicker(variant: Variant, average: EgoPlan) -> None:
    jam = 'kind = "jam"\nedges = ["c2c3", "c3c4"]\nlength_m = 350.0\nhold_s = 30.0\nfrom_s = -50.0'

    def jammed(folder: Path) -> None:
        path = folder / "scenario.toml"
        path.write_text(path.read_text() + f"\n[[incidents]]\n{jam}\n")

    with closing(Forked(variant(jammed), seed=1)) as simulation, closing(simulation.depart(average)) as traffic:
        traffic.advance(10.0)
        now, best, *_ = traffic.alternatives()
        assert best.eta_s < now.eta_s
        with closing(traffic.branch()) as asked:
            assert asked.request(Reroute()).accepted
            asked.advance(0.1)
            assert asked.alternatives()[0].eta_s <= best.eta_s, "who asks for a faster way gets it"
        with closing(traffic.branch()) as onward, closing(traffic.branch()) as round_:
            for branch, option in ((onward, now), (round_, best)):
                assert branch.request(Reroute(edges=option.edges)).accepted
            round_.advance(3000.0)
            assert round_.state.end is EgoEnd.ARRIVED
            onward.advance(round_.state.time_s - onward.state.time_s)
            assert onward.state.end is None


def test_who_is_on_the_quickest_way_stays_on_it(forked: Forked, average: EgoPlan) -> None:
    with closing(forked.depart(average)) as traffic:
        traffic.advance(5.0)
        assert traffic.request(Reroute()).accepted
        before = traffic.advance(0.1).states[-1].ahead.route_edges
        answer = traffic.request(Reroute())
        assert (answer.accepted, answer.reason) == (True, "this is the quickest route")
        assert traffic.advance(0.1).states[-1].ahead.route_edges == before


def test_the_ego_does_not_reroute_by_itself(variant: Variant, average: EgoPlan) -> None:
    import libsumo

    def all_reroute(folder: Path) -> None:
        path = folder / "scenario.toml"
        path.write_text(path.read_text().replace("background_rerouting = 0.6", "background_rerouting = 1.0"))

    with closing(InProcess(variant(all_reroute), seed=1)) as simulation:
        traffic = simulation.depart(average)
        route = libsumo.vehicle.getRoute("ego")
        assert libsumo.vehicle.getParameter("ego", "has.rerouting.device") == "false"
        others = [vehicle for vehicle in libsumo.vehicle.getIDList() if vehicle != "ego"]
        assert {libsumo.vehicle.getParameter(vehicle, "has.rerouting.device") for vehicle in others} == {"true"}
        while traffic.advance(10.0).states and traffic.state.end is None:
            assert libsumo.vehicle.getRoute("ego") == route


def test_there_is_nothing_to_choose_on_a_scripted_road_or_at_the_end(forked: Forked, average: EgoPlan) -> None:
    assert Scripted([Stretch()]).depart(average).alternatives() == ()
    with closing(forked.depart(average)) as traffic:
        traffic.advance(600.0)
        assert traffic.alternatives() == ()
    inside = replace(average, driver="calm")
    with closing(forked.depart(inside)) as traffic:
        traffic.advance(20.0)
        while not traffic.state.road.edge_id.startswith(":"):
            traffic.advance(0.1)
        assert traffic.alternatives() == (), "inside a junction the way is fixed"


def driven_ratios(traffic: Traffic) -> list[float]:
    """Predicted over driven time, of every way offered."""
    found = []
    for option in traffic.alternatives():
        with closing(traffic.branch()) as branch:
            began_s = branch.state.time_s
            if branch.request(Reroute(edges=option.edges)).accepted:
                branch.advance(1800.0)
                assert branch.state.end is EgoEnd.ARRIVED
                found.append(option.eta_s / (branch.state.time_s - began_s))
    return found


def test_arrival_times_are_honest(forked: Forked, grid: Scenario, average: EgoPlan) -> None:
    """As ``benchmarks/eta.py`` reports for every scenario."""
    found = []
    for trip in grid.ego.trips:
        with closing(forked.depart(replace(average, trip=trip))) as traffic:
            traffic.advance(5.0)
            found += driven_ratios(traffic)
    assert len(found) >= 9
    assert 0.85 <= median(found) <= 1.15
    assert mean(abs(ratio - 1) for ratio in found) <= 0.25
