"""Which projections are believed, and where a network lies that was moved."""

import gzip
import math
import re
from pathlib import Path

import pytest
from pyproj import Proj

from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import load, open_scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.georeference import GeoReference, doubt, middle, moved
from automotive_cosim.traffic.network import drives_on_left, read_network
from automotive_cosim.traffic.options import Setup
from automotive_cosim.traffic.sumo import load_library
from automotive_cosim.traffic.world import World

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
        ("+proj=merc +a=6378137 +b=6378137 +units=m", (-1258000.0, -5553000.0), "", "a metre is 1.4"),
        ("+proj=merc +lat_ts=44.5 +units=m", (-898000.0, -3963000.0), "", ""),
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


GEO = ("--fcd-output.geo", "--precision.geo", "12")
CODES = [  # code, and where it is used; from 28992 on, registries know several changes of datum that are as good
    ("EPSG:2154", (2.3, 48.9)),
    ("EPSG:25832", (11.4, 48.8)),
    ("EPSG:27700", (-1.5, 52.0)),
    ("EPSG:2056", (8.5, 47.4)),
    ("EPSG:28992", (5.2, 52.1)),
    ("EPSG:31370", (4.4, 50.8)),
    ("EPSG:5514", (14.4, 50.05)),
    ("EPSG:5514", (17.6, 48.85)),  # on both sides of a border
    ("EPSG:5514", (20.0, 48.8)),
]


@pytest.mark.parametrize(
    ("code", "north_first"),
    [
        *((code, True) for code in ("EPSG:31468", "EPSG:2180", "EPSG:3035", "EPSG:5513", "EPSG:2065")),
        ("EPSG:5514", False),
        ("EPSG:25833", False),
    ],
)
def test_a_network_with_its_axes_the_other_way_round_is_told(
    code: str, north_first: bool, tmp_path: Path, sumo: None
) -> None:
    """As netconvert 1.28 makes one of a code that counts northings first."""
    (tmp_path / "a.nod.xml").write_text(
        '<nodes><node id="a" x="15" y="50"/><node id="b" x="15.01" y="50"/><node id="c" x="15" y="50.01"/></nodes>'
    )
    (tmp_path / "a.edg.xml").write_text(
        '<edges><edge id="e" from="a" to="b"/><edge id="n" from="a" to="c"/></edges>'
    )
    options = ["-n", "a.nod.xml", "-e", "a.edg.xml", "--proj", code, "-o", "a.net.xml"]
    assert sumo_programs.run("netconvert", options, tmp_path)[0]
    network = read_network(tmp_path / "a.net.xml")
    (x1, y1), *_, (x2, y2) = network.edges["e"].shape_m
    assert (abs(y2 - y1) > abs(x2 - x1)) == north_first, "the road east leads north"
    assert ("axes the other way round" in network.unplaced) == north_first


@pytest.mark.parametrize(("code", "where"), CODES)
def test_a_code_is_written_out_so_that_sumo_has_the_same_place_and_its_library_loads_it(
    code: str, where: tuple[float, float], tmp_path: Path, sumo: None
) -> None:
    """``sumo`` itself reads the code; libsumo 1.28 cannot ("Could not build projection!")."""
    x_m, y_m = Proj(code)(*where)
    offset = f"{round(500 - x_m, 2)},{round(250 - y_m, 2)}"
    made_from = f"{where[0] - 0.1},{where[1] - 0.1},{where[0] + 0.1},{where[1] + 0.1}"
    net = tmp_path / "coded.net.xml"
    text = (load("grid").folder / "grid.net.xml").read_text(encoding="utf-8")
    for key, value in (("projParameter", code), ("netOffset", offset), ("origBoundary", made_from)):
        text = re.sub(rf'{key}="[^"]*"', f'{key}="{value}"', text, count=1)
    net.write_text(text, encoding="utf-8")
    (tmp_path / "one.rou.xml").write_text('<routes><trip id="v" depart="0" from="c1c2" to="c2c3"/></routes>')
    (tmp_path / "one.sumocfg").write_text(
        '<configuration><net-file value="coded.net.xml"/><route-files value="one.rou.xml"/></configuration>'
    )
    done, told = sumo_programs.run(
        "sumo", ["-c", "one.sumocfg", "-e", "1", "--fcd-output", "f.xml", *GEO], tmp_path
    )
    assert done, told
    of_sumo = [float(each) for each in re.findall(r' [xy]="([^"]*)"', (tmp_path / "f.xml").read_text())]
    scenario = open_scenario(tmp_path / "one.sumocfg")
    (tmp_path / "scratch").mkdir()
    world, library = World(Setup(scenario), tmp_path / "scratch"), load_library()
    try:
        world.step()
        at_m = library.position("v")
        ours = GeoReference(world.network.map).lon_lat(*at_m), library.to_lon_lat(*at_m)
    finally:
        world.close()
    assert scenario.has_place
    for lon_deg, lat_deg in ours:
        east_mm = (lon_deg - of_sumo[0]) * 111e6 * math.cos(math.radians(where[1]))
        assert math.hypot(east_mm, (lat_deg - of_sumo[1]) * 111e6) < 0.1


@pytest.mark.parametrize(("name", "left"), [("grid", False), ("london", True), ("tokyo", True), ("gulf", False)])
def test_the_side_of_the_road_is_in_the_first_line(name: str, left: bool) -> None:
    net = next(load(name).folder.glob("*.net.xml*"))
    assert drives_on_left(net) is left
    assert read_network(net).map.left_hand is left


def test_what_is_no_xml_is_one_line(tmp_path: Path) -> None:
    for name, content in (("a.xml", b""), ("b.xml", b"text"), ("d.gz", gzip.compress(b"<"))):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ScenarioError, match="is not XML"):
            drives_on_left(tmp_path / name)
    with pytest.raises(ScenarioError, match="is missing"):
        drives_on_left(tmp_path / "nothing.xml")
