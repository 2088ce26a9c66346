"""Where the sites are, on the grid, and which counts are doubted."""

from collections.abc import Mapping

import pytest

from automotive_cosim import scenarios
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.studies.calibration.capacity import Capacity
from automotive_cosim.studies.calibration.counts import Counts, SitePlace
from automotive_cosim.studies.calibration.sites import Mapped, map_sites
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Network


@pytest.fixture(scope="module")
def grid() -> Network:
    return network_of(scenarios.load("grid"))


def mapped(
    network: Network, flows: Mapping[str, float], places: Mapping[str, SitePlace], most: float = 1e4
) -> Mapped:
    capacity = Capacity(dict.fromkeys(network.edges, most), {})
    return map_sites(Counts({(site, 8): flow for site, flow in flows.items()}, places, "a test"), network, capacity)


def test_every_edge_is_found_by_a_position_on_it_and_its_bearing(grid: Network) -> None:
    """The opposite direction is as near, so without a bearing there is a doubt."""
    reference = GeoReference(grid.map)
    for name, edge in grid.edges.items():
        (x0, y0), (x1, y1) = edge.shape_m[0], edge.shape_m[-1]
        position = reference.lon_lat((x0 + x1) / 2, (y0 + y1) / 2)
        bearing = {(True, True): 90.0, (True, False): 270.0, (False, True): 0.0, (False, False): 180.0}[
            abs(x1 - x0) > abs(y1 - y0), (x1 - x0 if abs(x1 - x0) > abs(y1 - y0) else y1 - y0) > 0
        ]
        found = mapped(grid, {"s": 10.0}, {"s": SitePlace(position=position, bearing_deg=bearing)})
        assert found.edges == {"s": name}
        assert not found.doubts


def test_without_a_bearing_both_directions_are_meant(grid: Network) -> None:
    edge = grid.edges["cwc0"]
    (x0, y0), (x1, y1) = edge.shape_m[0], edge.shape_m[-1]
    position = GeoReference(grid.map).lon_lat((x0 + x1) / 2, (y0 + y1) / 2)
    found = mapped(grid, {"s": 10.0}, {"s": SitePlace(position=position)})
    assert found.edges["s"] in ("cwc0", "c0cw")
    (doubt,) = found.doubts
    assert "about as near" in doubt


def test_what_has_no_place_is_left_out_with_its_reason(grid: Network) -> None:
    places = {
        "far": SitePlace(position=(20.0, 50.0)),
        "gone": SitePlace("nowhere"),
        "one": SitePlace("cwc0"),
        "two": SitePlace("cwc0"),
    }
    found = mapped(grid, dict.fromkeys([*places, "bare"], 10.0), places)
    assert found.edges == {"one": "cwc0"}
    assert found.unmapped == {
        "bare": "its place is not given",
        "far": "no road for cars in its direction within 30 m",
        "gone": "the network has no edge for cars 'nowhere'",
        "two": "it stands on the edge of one",
    }


def test_a_count_beyond_the_road_is_doubted(grid: Network) -> None:
    found = mapped(grid, {"s": 2000.0}, {"s": SitePlace("cwc0")}, most=1800.0)
    assert found.doubts == ("s: 2000 vehicles at 8 h, but cwc0 carries about 1800",)


def test_two_counts_of_one_road_that_differ_are_doubted() -> None:
    """On the pass, one road follows the other for kilometres."""
    network = network_of(scenarios.load("alpine_pass"))
    before: dict[str, int] = {}
    for followers in network.crossings.values():
        for follower in followers:
            before[follower] = before.get(follower, 0) + 1
    first, second = next(
        (edge, follower)
        for edge, followers in network.crossings.items()
        for follower in followers
        if len(followers) == 1 and before[follower] == 1
    )
    places = {"a": SitePlace(first), "b": SitePlace(second)}
    (doubt,) = mapped(network, {"a": 500.0, "b": 900.0}, places).doubts
    assert "500 and 900 vehicles at 8 h" in doubt
    assert not mapped(network, {"a": 500.0, "b": 520.0}, places).doubts
