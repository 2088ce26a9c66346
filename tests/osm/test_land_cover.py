"""Water, green and buildings of a map: what is kept, how coarse, and what is left out."""

import gzip
import re
from dataclasses import replace
from pathlib import Path

import pytest
from pyproj import Proj
from shapely import Point, Polygon, union_all

from automotive_cosim.contracts import GroundKind, RoadNetwork
from automotive_cosim.osm import extract, land_cover
from automotive_cosim.osm.land_cover import COARSE, MappedArea, draw, kind_of

UTM = "+proj=utm +zone=31 +ellps=WGS84"
EAST_M, NORTH_M = Proj(UTM)(1.60, 48.30)
NETWORK = RoadNetwork((), (0.0, 0.0, 2000.0, 2000.0), UTM, (-EAST_M, -NORTH_M), False)


def mapped(kind: GroundKind, *rings: list[tuple[float, float]]) -> MappedArea:
    """An area of the map, its corners in the network's metres."""
    proj = Proj(UTM)
    outer, *holes = ([proj(x + EAST_M, y + NORTH_M, inverse=True) for x, y in ring] for ring in rings)
    return MappedArea(kind, Polygon(outer, holes))


def square(x: float, y: float, side: float) -> list[tuple[float, float]]:
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


def test_closed_ways_and_multipolygons_are_areas(formats: dict[str, Path]) -> None:
    found = extract.read(formats[""]).ground
    kinds = [area.kind for area in found]
    assert kinds.count(GroundKind.WATER) == 1, "neither the line nor what lies under ground"
    assert kinds.count(GroundKind.GREEN) == 2
    assert kinds.count(GroundKind.BUILDING) == 4


def test_a_relation_is_an_area_with_its_islands_and_a_cut_one_is_left_out(
    formats: dict[str, Path], tmp_path: Path
) -> None:
    text = formats[""].read_text(encoding="utf-8")
    ways = dict(re.findall(r'<way id="(\d+)" version="1">(.*?)</way>', text))
    outer, inner = (
        next(way for way, content in ways.items() if tag in content) for tag in ('v="park"', 'v="pavilion"')
    )
    members = f'<member type="way" ref="{outer}" role="outer"/><member type="way" ref="{inner}" role="inner"/>'
    tags = '<tag k="type" v="multipolygon"/><tag k="natural" v="water"/>'
    cut = f'<relation id="8" version="1"><member type="way" ref="999" role="outer"/>{tags}</relation>'
    relation = f'<relation id="7" version="1">{members}{tags}</relation>{cut}'
    path = tmp_path / "with.osm"
    path.write_text(text.replace("</osm>", f"{relation}</osm>"), encoding="utf-8")
    whole, found = (extract.read(file) for file in (formats[""], path))
    before, after = whole.ground, found.ground
    assert found.told == {("water that the extract cuts, left out", "relation"): (8,)}
    assert len(after) == len(before) + 1
    (lake,) = (area.shape for area in after if area.shape.interiors)
    assert len(lake.interiors) == 1


@pytest.mark.parametrize(
    ("tags", "kind"),
    [
        ({"natural": "water"}, GroundKind.WATER),
        ({"waterway": "riverbank"}, GroundKind.WATER),
        ({"landuse": "forest", "natural": "water"}, GroundKind.WATER),
        ({"leisure": "park"}, GroundKind.GREEN),
        ({"building": "church"}, GroundKind.BUILDING),
        ({"building": "no"}, None),
        ({"natural": "water", "tunnel": "yes"}, None),
        ({"landuse": "residential"}, None),
        ({}, None),
    ],
)
def test_the_tags_say_what_an_area_is(tags: dict[str, str], kind: GroundKind | None) -> None:
    assert kind_of(tags) is kind


def test_terraced_houses_are_one_block_and_sheds_are_none() -> None:
    houses = [mapped(GroundKind.BUILDING, square(100.0 + 10 * at, 100.0, 10.0)) for at in range(9)]
    (block,) = draw([*houses, mapped(GroundKind.BUILDING, square(500.0, 500.0, 4.0))], NETWORK).areas
    assert Polygon(block.outline_m).area == pytest.approx(900.0, rel=0.02)
    assert len(block.outline_m) < 8


def test_an_island_stays_dry_though_no_polygon_has_a_hole() -> None:
    lake = mapped(
        GroundKind.WATER, square(0, 0, 900), square(300, 300, 200), square(700, 100, 100), square(5, 5, 9)
    )
    areas = draw([lake], NETWORK).areas
    shapes = [Polygon(area.outline_m) for area in areas]
    assert all(shape.is_valid for shape in shapes)
    water = union_all([shape.buffer(0.2) for shape in shapes])
    assert not water.contains(Point(400.0, 400.0))
    assert not water.contains(Point(750.0, 150.0))
    assert water.contains(Point(9.0, 9.0)), "too small for an island"
    assert sum(shape.area for shape in shapes) == pytest.approx(900**2 - 200**2 - 100**2, rel=1e-3)


def test_what_lies_beyond_the_network_is_cut_off() -> None:
    wide, far = (mapped(GroundKind.GREEN, square(at, 0.0, 20_000.0)) for at in (-9_000.0, 50_000.0))
    (area,) = draw([wide, far], NETWORK).areas
    assert Polygon(area.outline_m).bounds == pytest.approx((-300.0, 0.0, 2300.0, 2300.0), abs=2.0)


def test_a_crossed_outline_and_no_projection_do_no_harm() -> None:
    crossed = mapped(GroundKind.GREEN, [(0, 0), (100, 100), (100, 0), (0, 100)])
    assert draw([crossed], NETWORK).areas
    assert draw([crossed], replace(NETWORK, projection=None)).areas == ()
    assert draw([], NETWORK).areas == ()


def test_of_too_many_areas_the_largest_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(land_cover, "COARSE", {kind: replace(each, most=2) for kind, each in COARSE.items()})
    found = draw([mapped(GroundKind.WATER, square(400.0 * at, 0, 100.0 + at)) for at in range(4)], NETWORK)
    assert (len(found.areas), found.too_many) == (2, 2)
    assert min(Polygon(area.outline_m).area for area in found.areas) > 101.5**2


def test_the_file_is_the_same_each_time(tmp_path: Path) -> None:
    areas = draw([mapped(GroundKind.WATER, square(0, 0, 900))], NETWORK).areas
    for name in ("a", "b"):
        land_cover.write(areas, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    assert 'type="water"' in gzip.decompress((tmp_path / "a").read_bytes()).decode()
