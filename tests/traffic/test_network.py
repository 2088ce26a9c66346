"""Networks: what the edges say, and how the sums over a route hold up against SUMO's own."""

import gzip
import math
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from automotive_cosim.contracts import LimitSource
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.congestion import MEMORY_S, SAMPLE_PERIOD_S, Congestion, Route
from automotive_cosim.traffic.network import Network, Shape, read_network
from automotive_cosim.traffic.router import Router
from automotive_cosim.traffic.sumo import THE_LIMIT, LibSumo
from automotive_cosim.traffic.ways import way_through
from tests.traffic.in_process import InProcess

EDGE = '<edge id="{id}" from="{a}" to="{b}" {more}>{lanes}{params}</edge>'
LANE = '<lane id="{id}_{n}" index="{n}" speed="{speed}" length="100" shape="0,0 100,0"{more}/>'


def edge(id_: str, params: str = "", lanes: tuple[str, ...] = ("",), more: str = "", speed: float = 13.89) -> str:
    rows = "".join(LANE.format(id=id_, n=n, speed=speed, more=lane) for n, lane in enumerate(lanes))
    pairs = (pair.split("=") for pair in params.split())
    texts = "".join(f'<param key="{key}" value="{value}"/>' for key, value in pairs)
    return EDGE.format(id=id_, a=id_[0], b=id_[1], more=more, lanes=rows, params=texts)


@pytest.fixture
def net(tmp_path: Path) -> Callable[..., Network]:
    def make(*edges: str, attributes: str = "", location: str = "") -> Network:
        path = tmp_path / "some.net.xml.gz"
        path.write_bytes(gzip.compress(f"<net {attributes}>{location}{''.join(edges)}</net>".encode()))
        return read_network(path)

    return make


@pytest.mark.parametrize(
    ("from_lane", "to_lane", "is_way"), [(0, 1, False), (1, 0, False), (0, 0, False), (1, 1, True)]
)
def test_a_way_through_a_lane_of_the_buses_is_none(
    net: Callable[..., Network], from_lane: int, to_lane: int, is_way: bool
) -> None:
    lanes = (' allow="bus"', "")
    link = f'<connection from="ab" to="bc" fromLane="{from_lane}" toLane="{to_lane}" dir="s"/>'
    found = net(edge("ab", lanes=lanes), edge("bc", lanes=lanes), link)
    assert ("bc" in found.crossings.get("ab", {})) is is_way
    assert bool(way_through(found, ("ab", "bc"))) is is_way


def test_ways_of_buses_have_a_time_but_are_no_roads(net: Callable[..., Network]) -> None:
    bus, both = (' allow="bus"', ' allow="pedestrian"'), (' allow="bus"', "")
    found = net(edge("ab", lanes=both), edge("bc", lanes=bus))
    assert set(found.edges) == {"ab"}
    assert set(found.free_s) == {"ab", "bc"}
    assert found.free_s["bc"] == pytest.approx(found.free_s["ab"])


def test_tags_of_openstreetmap_are_understood(net: Callable[..., Network]) -> None:
    edges = net(
        edge("ab", "maxspeed=50 lit=yes zone:traffic=FR:urban lane_markings=no", more='type="highway.primary"'),
        edge("bc", "tunnel=yes lit=no zone:traffic=FR:rural", more='type="highway.motorway_link|railway.tram"'),
        edge("cd", "tunnel=no"),
        edge("de", "tunnel=building_passage maxspeed=none", speed=39.44),
        edge("ef", speed=39.44),
    ).edges
    ab, bc, cd, de, ef = (edges[name] for name in ("ab", "bc", "cd", "de", "ef"))
    assert (ab.road_class, ab.limit_source, ab.lit, ab.built_up, ab.centre_line, ab.in_tunnel) == (
        "primary",
        LimitSource.POSTED,
        True,
        True,
        False,
        False,
    )
    assert (bc.road_class, bc.limit_source, bc.lit, bc.built_up, bc.centre_line, bc.in_tunnel) == (
        "motorway_link",
        LimitSource.ASSUMED,
        False,
        False,
        None,
        True,
    )
    assert (cd.road_class, cd.in_tunnel, cd.lit, cd.built_up) == ("", False, None, None)
    assert (de.in_tunnel, de.limit_mps, de.speed_mps, de.limit_source) == (True, None, 39.44, LimitSource.POSTED)
    assert ef.limit_mps == 39.44, "fast, but nobody says that it has no limit"


def test_only_what_cars_may_use_counts(net: Callable[..., Network]) -> None:
    lanes = (' allow="pedestrian"', ' allow="bus taxi"', ' disallow="tram rail"', "", ' allow="passenger bus"')
    network = net(edge("ab", lanes=lanes), edge("bc", lanes=(' disallow="all"', ' allow="bicycle"')), edge("cd"))
    assert set(network.edges) == {"ab", "cd"}
    assert network.edges["ab"].lane_ids == ("ab_2", "ab_3", "ab_4")
    assert [road.lane_count for road in network.map.roads] == [3, 1]


def test_location_side_and_bounds(net: Callable[..., Network]) -> None:
    location = '<location netOffset="-500000,-5400000" convBoundary="1,2,3,4" projParameter="{}"/>'
    placed = net(edge("ab"), attributes='lefthand="true"', location=location.format("+proj=utm +zone=31")).map
    assert (placed.projection, placed.offset_m, placed.bounds_m) == (
        "+proj=utm +zone=31",
        (-500000, -5400000),
        (1, 2, 3, 4),
    )
    assert placed.left_hand
    for nowhere in (net(edge("ab")).map, net(edge("ab"), location=location.format("!")).map):
        assert nowhere.projection is None
        assert not nowhere.left_hand
    assert net(edge("ab")).map.bounds_m == (0, 0, 100, 0)


@pytest.mark.parametrize(
    "place", ['netOffset=""', 'netOffset="1"', 'netOffset="1,2,3"', 'netOffset="nan,0"', 'convBoundary="0,0,1,x"',
              'projParameter="+proj=utm +zone=31" netOffset="-500000,-5400000" origBoundary="0,0,1,x"']
)  # fmt: skip
def test_a_location_that_is_none_is_one_line(net: Callable[..., Network], place: str) -> None:
    with pytest.raises(ScenarioError, match="has no valid location") as refused:
        net(edge("ab"), location=f"<location {place}/>")
    assert "\n" not in str(refused.value)


def test_opposite_edges_share_junctions_and_name(net: Callable[..., Network]) -> None:
    network = net(
        edge("ab", more='name="A"'),
        edge("ba", more='name="A"'),
        edge("bc", more='name="B"'),
        edge("cb", more='name="C"'),
    )
    assert network.opposite == {"ab": "ba", "ba": "ab"}


@pytest.mark.parametrize("text", ["", "<net>", "<net><edge id='ab'/></net>", "<additional/>", "\x00\x1f"])
def test_a_file_that_is_no_network_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "some.net.xml"
    path.write_text(text)
    with pytest.raises(ScenarioError, match=r"some\.net\.xml"):
        read_network(path)
    packed = tmp_path / "cut.net.xml.gz"
    packed.write_bytes(gzip.compress(b"<net/>" * 100)[:-10])
    with pytest.raises(ScenarioError, match=r"cut\.net\.xml\.gz"):
        read_network(packed)


def test_an_edge_that_lacks_something_is_refused_also_as_the_last_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "a.net.xml"
    for after in ("", "<junction/>"):
        file.write_text(f'<net><edge id="a"><lane id="a_0"/></edge>{after}</net>')
        with pytest.raises(ScenarioError, match="is not a complete SUMO network"):
            read_network(file)


def test_parameters_of_what_follows_an_edge_are_not_its_own(tmp_path: Path) -> None:
    file = tmp_path / "a.net.xml"
    lane = '<lane id="a_0" speed="10" length="50" shape="0,0 50,0"/>'
    signal = '<tlLogic id="t"><param key="tunnel" value="yes"/></tlLogic>'
    file.write_text(
        f'<net><location convBoundary="0,0,9,9"/><edge id="a" from="b" to="c">{lane}</edge>{signal}</net>'
    )
    assert not read_network(file).edges["a"].in_tunnel


@pytest.mark.sumo
def test_lengths_are_sumos(grid: Scenario, hurried: EgoPlan) -> None:
    import libsumo

    simulation = InProcess(grid, seed=1)
    try:
        traffic = simulation.depart(replace(hurried, trip=grid.trip("round")))
        for _ in range(150):
            traffic.advance(1.0)
            goal = libsumo.vehicle.getRoute("ego")[-1]
            left_m = libsumo.vehicle.getDrivingDistance("ego", goal, libsumo.lane.getLength(f"{goal}_0"))
            assert traffic.state.ahead.route_left_m == pytest.approx(left_m, abs=1.0)
    finally:
        simulation.close()


def test_networks_of_others_are_read(data_of_others: Callable[[str], Path]) -> None:
    paths = sorted(data_of_others("").rglob("*.net.xml"))
    assert paths
    for path in paths:
        network = read_network(path)
        assert (network.map.projection is None) == ("acosta" in path.name), path.name
        assert all(crossing in network.edges for ways in network.crossings.values() for crossing in ways)


# --- congestion -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def town(grid: Scenario) -> Network:
    return read_network(grid.folder / "grid.net.xml")


AVENUE = ("cwc0", "c0c1", "c1c2", "c2c3", "c3c4", "c4ce")
SAMPLES = round(6 * MEMORY_S / SAMPLE_PERIOD_S)


def jammed(network: Network, *edges: str, speed_mps: float = 1.0, vehicles: int = 20) -> Congestion:
    lanes = [network.edges[edge].lane_ids[-1] for edge in edges]
    congestion = Congestion(network, lambda: [(lane, speed_mps, THE_LIMIT) for lane in lanes] * vehicles)
    for _ in range(SAMPLES):
        congestion.sample()
    return congestion


def test_an_empty_network_flows_freely(town: Network) -> None:
    free = jammed(town)
    assert all(free.relative_speed(edge_id) == 1.0 for edge_id in town.edges)
    ahead = Route(AVENUE, town, free).ahead(0, 0.0)
    assert ahead.delay_s == pytest.approx(0.0, abs=1e-9)
    assert ahead.relative_speed == pytest.approx(1.0)
    assert (ahead.jam_distance_m, ahead.jam_length_m) == (None, 0.0)


def test_a_red_light_is_no_jam(town: Network) -> None:
    """Half a cycle of standing, half a cycle of free flow."""
    phase = iter([0.0] * 4 + [12.0] * 4 for _ in range(20))
    speeds = [speed for cycle in phase for speed in cycle]
    congestion = Congestion(town, lambda: [("c3c4_0", speeds[0], THE_LIMIT)] * 5)
    seen = []
    while speeds:
        congestion.sample()
        seen.append(congestion.relative_speed("c3c4"))
        speeds.pop(0)
    assert all(0.25 < value < 0.75 for value in seen[40:])


def test_a_jam_clears_when_its_vehicles_have_gone(town: Network) -> None:
    rows = [("c3c4_0", 0.5, THE_LIMIT)] * 20
    congestion = Congestion(town, lambda: rows)
    for _ in range(SAMPLES):
        congestion.sample()
    assert congestion.relative_speed("c3c4") < 0.1
    rows.clear()
    for _ in range(2 * SAMPLES):
        congestion.sample()
    assert congestion.relative_speed("c3c4") > 0.95


@pytest.mark.parametrize("speed_mps", [0.5, 3.0, 9.0, 30.0])
def test_delay_and_relative_speed_agree(town: Network, speed_mps: float) -> None:
    route = Route(AVENUE, town, jammed(town, "c2c3", speed_mps=speed_mps))
    for share in range(20):
        position_m = share / 20 * route.length_m
        ahead = route.ahead(route.edge_at(position_m)[0], position_m)
        assert ahead.relative_speed == pytest.approx(1 - ahead.delay_s / ahead.eta_s)
        assert (ahead.jam_length_m > 0) <= (ahead.relative_speed < 1)


class _NoRouter:
    """A simulation that finds no way but the present one."""

    def adapt_travel_time(self, *_: object) -> None: ...

    def find_route(self, *_: object) -> SimpleNamespace:
        return SimpleNamespace(edges=())


def test_a_queue_to_turn_left_does_not_delay_who_drives_on(town: Network) -> None:
    def eta_s(route: tuple[str, str], *, left_mps: float) -> float:
        congestion = Congestion(town, lambda: [("c0c1_0", 12.0, THE_LIMIT), ("c0c1_1", left_mps, THE_LIMIT)] * 4)
        congestion.sample()
        (option,) = Router(cast(LibSumo, _NoRouter()), town, congestion, "ego").alternatives(route, 1, 0.0)
        return option.eta_s

    on, left = ("c0c1", "c1c2"), ("c0c1", "c1n1")
    assert eta_s(on, left_mps=0.6) == eta_s(on, left_mps=12.0)
    assert eta_s(left, left_mps=0.6) > eta_s(left, left_mps=12.0) + 120.0


def test_jams_lie_where_they_are(town: Network) -> None:
    congestion = jammed(town, "c2c3", "c3c4")
    route = Route(AVENUE, town, congestion)
    start_m = route.position_m(3, 0.0)
    end_m = route.position_m(4, town.edges["c3c4"].length_m)
    far = route.ahead(0, 50.0)
    assert far.jam_distance_m == pytest.approx(start_m - 50.0)
    assert far.jam_length_m == pytest.approx(end_m - start_m)
    inside = route.ahead(3, start_m + 30.0)
    assert inside.jam_distance_m == 0.0
    assert inside.jam_length_m == pytest.approx(end_m - start_m - 30.0)
    past = route.ahead(5, route.position_m(5, 1.0))
    assert (past.jam_distance_m, past.jam_length_m) == (None, 0.0)
    jam_s = sum(town.edges[edge_id].length_m for edge_id in ("c2c3", "c3c4")) / 1.0
    assert far.delay_s == pytest.approx(jam_s, rel=0.2)
    assert far.eta_s - far.delay_s == pytest.approx(route.ahead(0, 50.0).route_left_m / 13.89, rel=0.05)


def test_time_to_the_goal_falls_as_fast_as_the_traffic_flows(town: Network) -> None:
    congestion = jammed(town, "c1c2", speed_mps=5.0)
    route = Route(AVENUE, town, congestion)
    for index, edge_id in enumerate(AVENUE):
        here, there = (route.ahead(index, route.position_m(index, metres)) for metres in (10.0, 60.0))
        assert here.eta_s - there.eta_s == pytest.approx(50.0 / congestion.speed_mps(edge_id))


def test_what_lies_ahead_is_found(town: Network) -> None:
    way = ("s1c1", "c1n1", "n1n2", "n2n3")
    route = Route(way, town, jammed(town))
    ahead = route.ahead(0, 0.0)
    assert ahead.tunnel_distance_m == pytest.approx(route.position_m(2, 0.0))
    assert route.ahead(2, route.position_m(2, 5.0)).tunnel_distance_m == 0.0
    assert route.ahead(3, route.position_m(3, 5.0)).tunnel_distance_m is None
    assert (ahead.next_limit, ahead.exit_distance_m) == (None, None)
    changing = Route(("s0s1", "s1c1", "c1c2"), town, jammed(town)).ahead(0, 20.0)
    assert changing.next_limit.mps == pytest.approx(30 / 3.6, abs=0.01)
    assert changing.route_edges == ("s0s1", "s1c1", "c1c2")


def test_exits_of_a_motorway(town: Network) -> None:
    """The first edge that leads to more than one other, else where the route itself leaves."""
    edges = {
        edge_id: replace(found, road_class="motorway" if edge_id in ("c0c1", "c1c2", "c2c3") else "primary")
        for edge_id, found in town.edges.items()
    }
    branching = replace(town, edges=edges)
    only = {
        edge_id: {following: ways[following] for following in list(ways) if following in AVENUE}
        for edge_id, ways in town.crossings.items()
    }
    plain = replace(branching, crossings=only)
    for network, last in ((branching, 1), (plain, 3)):
        route = Route(AVENUE, network, jammed(network))
        exit_m = route.position_m(last, network.edges[AVENUE[last]].length_m)
        assert route.ahead(1, route.position_m(1, 0.0)).exit_distance_m == pytest.approx(
            exit_m - route.position_m(1, 0.0)
        )
        assert route.ahead(0, 0.0).exit_distance_m is None
        assert route.ahead(4, route.position_m(4, 0.0)).exit_distance_m is None


@pytest.mark.sumo
def test_the_shipped_network_is_what_its_sources_make(grid: Scenario, town: Network, tmp_path: Path) -> None:
    pytest.importorskip("sumo", reason="needs eclipse-sumo")
    from automotive_cosim.traffic import sumo_programs

    for name in ("grid.nod.xml", "grid.edg.xml"):
        shutil.copy(grid.folder / name, tmp_path)
    options = ["--proj.utm", "--output.street-names", "--no-turnarounds.except-deadend"]
    sources = ["-n", tmp_path / "grid.nod.xml", "-e", tmp_path / "grid.edg.xml"]
    done, printed = sumo_programs.run("netconvert", [*sources, *options, "-o", tmp_path / "new.net.xml"])
    assert done, printed
    built = read_network(tmp_path / "new.net.xml")
    assert built == town
    avenue = [found for found in built.edges.values() if found.name == "Avenue Centrale"]
    assert math.isclose(sum(found.length_m for found in avenue) / 2, 1400, rel_tol=0.1)


def test_a_map_is_told_where_the_traffic_is_slow(town: Network) -> None:
    flow = jammed(town, "c1c2", speed_mps=2.0)
    assert flow.slow_edges() == (("c1c2", round(flow.relative_speed("c1c2"), 2)),)
    assert Route(AVENUE, town, flow).ahead(0, 0.0).slow_edges == flow.slow_edges()
    assert jammed(town).slow_edges() == ()


@pytest.mark.parametrize(
    ("params", "road_class"),
    [("bicycle_road=yes", "cycle_street"), ("cyclestreet=yes", "cycle_street"), ("cyclestreet=no", "residential")],
)
def test_a_cycle_street_is_a_class_of_its_own(net: Callable[..., Network], params: str, road_class: str) -> None:
    network = net(edge("ab", params, more='type="highway.residential"'), edge("bc"))
    assert network.edges["ab"].road_class == road_class


def test_with_its_joints_a_maps_roads_are_continuous(town: Network) -> None:
    """All lines of the map hang together, however large the junctions."""

    def pieces(lines: list[Shape]) -> int:
        groups: list[set[tuple[float, float]]] = []
        for line in lines:
            joined = [group for group in groups if group & {line[0], line[-1]}]
            groups = [group for group in groups if group not in joined]
            groups.append({line[0], line[-1]}.union(*joined))
        return len(groups)

    roads = [found.shape_m for found in town.edges.values()]
    assert pieces(roads) == len(roads)
    assert pieces([*roads, *town.joints_m]) == 1
