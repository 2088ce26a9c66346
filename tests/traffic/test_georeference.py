"""Which projections are believed, and where a network lies that was moved."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import pytest

from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import load
from automotive_cosim.traffic.georeference import GeoReference, doubt, middle, moved
from automotive_cosim.traffic.network import drives_on_left, read_network, root_of

UTM32 = "+proj=utm +zone=32 +ellps=WGS84 +datum=WGS84 +units=m +no_defs"
LOCAL = "+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +no_defs"


def _network(projection: str | None, offset_m: tuple[float, float]) -> RoadNetwork:
    return RoadNetwork((), (0.0, 0.0, 2000.0, 1000.0), projection, offset_m, left_hand=False)


@pytest.mark.parametrize(
    ("projection", "offset_m", "made_from", "said"),
    [
        # What netconvert writes for OpenStreetMap data: coordinates in degrees.
        (UTM32, (-684000.0, -4928000.0), "11.31,44.48,11.33,44.49", ""),
        # A crop of a larger map keeps the larger map's bounds.
        (UTM32, (-684000.0, -4928000.0), "8.0,43.0,13.0,49.0", ""),
        # Made from projected coordinates, e.g. OpenDRIVE with a geoReference.
        (UTM32, (-684000.0, -4928000.0), "684000,4928000,686000,4929000", ""),
        (LOCAL, (0.0, 0.0), "0,0,2000,1000", ""),
        (UTM32, (-684000.0, -4928000.0), "", ""),
        # Made from a drawing's own metres, with a projection put on afterwards.
        (UTM32, (-684000.0, -4928000.0), "-346.83,0,1817.58,2148.55", "contradicts its coordinates"),
        (UTM32, (-684000.0, -4928000.0), "2.2,48.8,2.4,48.9", "contradicts its coordinates"),
        (UTM32, (0.0, 0.0), "0,0,2000,1000", "outside every UTM zone"),
        ("+proj=nonsense", (0.0, 0.0), "", "invalid projection"),
        (None, (0.0, 0.0), "", "has no projection"),
    ],
)
def test_a_projection_is_believed_if_the_coordinates_bear_it_out(
    projection: str | None, offset_m: tuple[float, float], made_from: str, said: str
) -> None:
    found = doubt(_network(projection, offset_m), {"origBoundary": made_from})
    assert (said in found) if said else found == ""


def test_a_moved_network_keeps_its_metres_and_has_its_middle_at_the_origin() -> None:
    network = moved(_network(None, (0.0, 0.0)), (151.2, -33.9))
    assert network.bounds_m == (0.0, 0.0, 2000.0, 1000.0)
    assert middle(network) == pytest.approx((151.2, -33.9), abs=1e-12)
    reference = GeoReference(network)
    lon_deg, lat_deg = reference.lon_lat(0.0, 0.0)
    assert lon_deg < 151.2
    assert lat_deg < -33.9
    assert reference.x_y(lon_deg, lat_deg) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_a_network_whose_projection_is_not_believed_has_none(tmp_path: Path) -> None:
    text = (load("grid").folder / "grid.net.xml").read_text(encoding="utf-8")
    net = tmp_path / "x.net.xml"
    net.write_text(re.sub(r'origBoundary="[^"]*"', 'origBoundary="0,0,1400,450"', text), encoding="utf-8")
    network = read_network(net)
    assert network.map.projection is None
    assert "contradicts its coordinates" in network.unplaced
    placed = network.at((2.35, 48.85))
    assert placed.unplaced == ""
    assert placed.moved
    assert placed.edges == network.edges


@pytest.mark.parametrize(("name", "left"), [("grid", False), ("london", True), ("tokyo", True), ("gulf", False)])
def test_the_side_of_the_road_is_in_the_first_line(name: str, left: bool) -> None:
    net = next(load(name).folder.glob("*.net.xml*"))
    assert drives_on_left(net) is left
    assert read_network(net).map.left_hand is left


def test_what_is_no_xml_is_one_line(tmp_path: Path) -> None:
    for name, content in (
        ("a.xml", b""),
        ("b.xml", b"text"),
        ("d.gz", gzip.compress(b"<")),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ScenarioError, match="is not XML"):
            root_of(tmp_path / name)
    with pytest.raises(ScenarioError, match="is missing"):
        root_of(tmp_path / "nothing.xml")
