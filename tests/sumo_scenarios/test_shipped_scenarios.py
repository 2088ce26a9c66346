"""Laws that every scenario in the package keeps."""

import tomllib
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from shapely import LineString, Point, Polygon, STRtree, union_all

from automotive_cosim import scenarios
from automotive_cosim.contracts import GroundKind
from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.geo.place import Atlas
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.sumo_scenarios import build
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.network import NO_LIMIT_FROM_MPS
from tests.laws import over

from .proven import changed

Net = Callable[[str], Any]
SHIPPED = scenarios.shipped()
TOWNS = tomllib.loads(Path(__file__).with_name("towns.toml").read_text(encoding="utf-8"))
COUNTRIES = {"border": {"IE", "GB"}}
"""Of a network that lies in several."""


def signed_kmh(maxspeed: str) -> float:
    """``"50"`` or ``"30 mph"``, as OpenStreetMap writes limits."""
    number, _, unit = maxspeed.partition(" ")
    assert unit in ("", "mph")
    return float(number) * (1.609344 if unit else 1.0)


def test_every_scenario_is_as_it_was_proven() -> None:
    names = " ".join(changed())
    assert not names, f"prove again what has changed: python -m tests.sumo_scenarios.proven {names}"


def test_the_catalogue_is_shipped() -> None:
    places = {"paris_centre", "peripherique", "beauce", "autobahn", "london", "alpine_pass", "new_york"}
    assert places <= set(SHIPPED)


@pytest.mark.parametrize("name", SHIPPED)
def test_it_loads_and_explains_itself(name: str) -> None:
    scenario = scenarios.load(name)
    assert scenario.name == name == scenario.folder.name
    assert scenario.start.tzinfo is not None
    readme = (scenario.folder / "README.md").read_text(encoding="utf-8")
    assert all(f"`{trip.name}`" in readme for trip in scenario.ego.trips)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_net_is_projected(name: str, net: Net) -> None:
    assert net(name).hasGeoProj()


@pytest.mark.parametrize("name", SHIPPED)
def test_it_lies_in_its_country_and_time_zone(name: str, net: Net) -> None:
    scenario = scenarios.load(name)
    start = net(name).getEdge(scenario.ego.trips[0].from_edge).getShape()[0]
    place = Atlas().place(*net(name).convertXY2LonLat(*start))
    assert (place.country, place.time_zone) == (scenario.country, str(scenario.start.tzinfo))


BRIDGE_M = 350.0
"""No street is over water for longer: Pont de Bir-Hakeim is, with its island, 237 m long, Waterloo Bridge 370 m."""


@over(SHIPPED)
def test_bridges_cross_the_water_and_no_street_runs_in_it(name: str) -> None:
    network = network_of(scenarios.load(name))
    water = [Polygon(area.outline_m) for area in network.map.ground if area.kind is GroundKind.WATER]
    assert all(area.is_valid for area in water)
    lake = union_all(water)
    for edge in network.edges.values():
        line = LineString(edge.shape_m)
        assert line.intersection(lake).length <= BRIDGE_M, f"{edge.edge_id} runs in the water"
        ends = Point(edge.shape_m[0]), Point(edge.shape_m[-1])
        assert not any(lake.contains(end) for end in ends), f"{edge.edge_id} ends in the water"


def test_the_rivers_have_bridges() -> None:
    for name, bridge in (("paris_centre", "Pont Royal"), ("london", "Waterloo Bridge")):
        network = network_of(scenarios.load(name))
        water = union_all([Polygon(area.outline_m) for area in network.map.ground if area.kind is GroundKind.WATER])
        over_it = {edge.name for edge in network.edges.values() if LineString(edge.shape_m).crosses(water)}
        assert bridge in over_it, name


@pytest.mark.parametrize("name", SHIPPED)
def test_every_trip_can_be_driven(name: str, net: Net) -> None:
    for trip in scenarios.load(name).ego.trips:
        stops = [net(name).getEdge(edge) for edge in (trip.from_edge, *trip.via, trip.to_edge)]
        for a, b in pairwise(stops):
            assert net(name).getOptimalPath(a, b)[0], f"{trip.name}: no way from {a.getID()} to {b.getID()}"


@pytest.mark.parametrize("name", SHIPPED)
def test_every_edge_says_what_its_signs_say(name: str, net: Net) -> None:
    for edge in net(name).getEdges():
        params = edge.getParams()
        assert edge.getName(), edge.getID()
        assert edge.getType().startswith("highway."), edge.getID()
        assert params["lit"] in ("yes", "no"), edge.getID()
        country, _, zone = params["zone:traffic"].partition(":")
        assert country in COUNTRIES.get(name, {scenarios.load(name).country}), edge.getID()
        assert zone in ("urban", "rural", "motorway"), edge.getID()
        if params.get("maxspeed") == "none":
            assert edge.getSpeed() >= NO_LIMIT_FROM_MPS, edge.getID()
        elif "maxspeed" in params:
            assert edge.getSpeed() * 3.6 == pytest.approx(signed_kmh(params["maxspeed"]), abs=0.05), edge.getID()


def named(table: str) -> list[tuple[str, str]]:
    """Each entry of a table of ``towns.toml``, with its town."""
    return [(town, entry) for town, known in TOWNS.items() for entry in known.get(table, ())]


@pytest.mark.parametrize(("town", "street"), named("posted"))
def test_streets_are_signed_as_they_are_known(town: str, street: str, net: Net) -> None:
    edges = [edge for edge in net(town).getEdges() if edge.getName() == street]
    assert {edge.getParam("maxspeed") or "" for edge in edges} == {*TOWNS[town]["posted"][street]}


@pytest.mark.parametrize(("town", "junction"), named("at"))
def test_junctions_lie_beside_their_landmarks(
    town: str, junction: str, net: Net, metres: Callable[..., float], lonlat: Callable[..., Any]
) -> None:
    lon_deg, lat_deg, *height_m = TOWNS[town]["at"][junction]
    assert metres((lon_deg, lat_deg), lonlat(town, junction)) < TOWNS[town]["within_m"]
    if height_m:
        assert net(town).getNode(junction).getCoord3D()[2] == pytest.approx(height_m[0], abs=20)


@pytest.mark.parametrize("name", SHIPPED)
def test_streets_cross_at_junctions_bridges_and_tunnels_only(name: str, net: Net) -> None:
    """Two lines that cross on paper without a junction are a slip of the pen, unless one passes over the other."""
    edges = net(name).getEdges()
    lines = [LineString(edge.getShape()) for edge in edges]
    first, second = STRtree(lines).query(lines, predicate="crosses")
    for i, j in zip(first, second, strict=True):
        a, b = edges[i], edges[j]
        if i < j and not _levels_differ(a, b):
            ends = {a.getFromNode(), a.getToNode()} & {b.getFromNode(), b.getToNode()}
            where = lines[i].intersection(lines[j])
            assert any(where.distance(Point(end.getCoord())) < 40 for end in ends), (a.getID(), b.getID())


def _levels_differ(a: Any, b: Any) -> bool:
    """One lies on another layer, as OpenStreetMap counts them, or is a tunnel; in Paris the périphérique in its
    cutting, the low road along the Seine and the bridges are known by their names."""
    low = ("Boulevard Périphérique", "Voie Georges-Pompidou", "Pont ")
    a_layer, b_layer = (edge.getParam("layer", "0") for edge in (a, b))
    return a_layer != b_layer or any(e.getParam("tunnel") == "yes" or e.getName().startswith(low) for e in (a, b))


@pytest.mark.sumo
@pytest.mark.parametrize(
    "name", [name if name == "grid" else pytest.param(name, marks=pytest.mark.proof) for name in build.buildable()]
)
def test_the_shipped_net_is_what_its_plain_xml_builds(name: str) -> None:
    built = build.compile_net(name)
    shipped = build.shipped_net(name)
    assert built == shipped, f"run python -m automotive_cosim.sumo_scenarios.build {name}"


def test_no_path_or_date_is_left_in_a_net() -> None:
    for name in build.buildable():
        head = build.shipped_net(name)[:2000]
        assert b"generated on" not in head
        assert b"output-file" not in head


def test_an_unknown_scenario_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'paris_centre'"):
        build.compile_net("paris_center")


@pytest.mark.sumo
def test_what_netconvert_refuses_comes_back_as_one_line(
    tmp_path: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    sumo_programs.home()
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "broken.netccfg").write_text("<configuration><nonsense/></configuration>")
    monkeypatch.setattr(build, "ROOT", tmp_path)
    with pytest.raises(ScenarioError, match="netconvert refused broken"):
        build.compile_net("broken")
    assert build.main(["broken"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "broken" / "broken.net.xml.gz").exists()


@pytest.mark.parametrize("name", SHIPPED)
def test_sumo_opens_it_without_a_complaint(name: str, complaints: Callable[..., str]) -> None:
    assert complaints(scenarios.load(name), 1, "--end", "60", "--duration-log.disable") == ""


@pytest.mark.parametrize("name", SHIPPED)
def test_the_ego_arrives(name: str, rides: Callable[[str], Any]) -> None:
    assert [trip for trip, ride in rides(name).items() if not ride.arrived] == []


@pytest.mark.parametrize("name", SHIPPED)
def test_traffic_stays_alive_for_an_hour(name: str, hour: Callable[[str], Any]) -> None:
    """From 900 s on and for 3,600 s: under a quarter halted, nobody teleported. SUMO teleports whoever waits for
    300 s, so none did."""
    seen = hour(name)
    assert len(seen.running) >= 3600
    assert seen.teleports == 0
    assert seen.collisions == 0
    assert seen.worst_halted < 0.25, f"{seen.worst_halted:.3f} halted at worst"
    first, last = (sum(part) / len(part) for part in (seen.running[:900], seen.running[-900:]))
    assert last < 1.25 * first, "traffic piles up"
