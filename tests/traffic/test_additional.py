"""Water, green and buildings: which polygons of additional files are areas, and what is wrong with one."""

from collections.abc import Callable
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import GroundArea, GroundKind
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic import additional
from automotive_cosim.traffic.additional import read_mapped
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.options import Configuration

NET = scenarios.load("grid").folder / "grid.net.xml"
SHAPE = 'shape="0,0 10,0 10,10"'

Read = Callable[..., tuple[GroundArea, ...]]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    def read(*polygons: str, net: Path = NET) -> tuple[GroundArea, ...]:
        rows = "\n".join(f'<poly id="p{at}" {words}/>' for at, words in enumerate(polygons))
        file = tmp_path / "some.poly.xml"
        file.write_text(f"<additional>\n{rows}\n</additional>", encoding="utf-8")
        return read_mapped(Configuration(net, net, files={"additional-files": (file,)})).map.ground

    return read


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        ("water", GroundKind.WATER),
        ("natural.water", GroundKind.WATER),
        ("waterway.riverbank", GroundKind.WATER),
        ("forest", GroundKind.GREEN),
        ("leisure.park", GroundKind.GREEN),
        ("building.yes", GroundKind.BUILDING),
        ("Building", GroundKind.BUILDING),
        ("landuse.residential", None),
        ("", None),
    ],
)
def test_the_type_says_what_an_area_is(read: Read, words: str, kind: GroundKind | None) -> None:
    found = read(f'type="{words}" fill="true" {SHAPE}')
    assert [area.kind for area in found] == ([] if kind is None else [kind])


def test_a_line_is_no_area_and_a_closed_one_is(read: Read) -> None:
    assert read(f'type="water" {SHAPE}') == ()
    assert read('type="water" fill="1" shape="0,0 5,5"', 'type="water" fill="1" shape="0,0 5,5 0,0"') == ()
    assert read('type="water" shape="0,0 10,0 10,10 0,0"') == read(f'type="water" fill="1" {SHAPE}')
    assert read('type="water" fill="1" shape="0,0,3 10,0,3 10,10,3"') == read(f'type="water" fill="1" {SHAPE}')


def test_buildings_are_drawn_last_and_green_first(read: Read) -> None:
    found = read(*(f'type="{words}" fill="1" {SHAPE}' for words in ("building", "water", "park")))
    assert [area.kind for area in found] == [GroundKind.GREEN, GroundKind.WATER, GroundKind.BUILDING]


def test_longitudes_and_latitudes_become_metres(read: Read) -> None:
    reference = GeoReference(network_of(scenarios.load("grid")).map)
    (area,) = read('type="park" fill="1" geo="true" shape="0.110,49.495 0.112,49.495 0.112,49.496"')
    assert reference.lon_lat(*area.outline_m[1]) == pytest.approx((0.112, 49.495), abs=2e-6)


def test_without_a_projection_there_is_no_place_for_longitudes(read: Read, tmp_path: Path) -> None:
    net = tmp_path / "flat.net.xml"
    net.write_text(NET.read_text(encoding="utf-8").replace('projParameter="+proj', 'projParameter="!'))
    shape = 'shape="0.110,49.495 0.112,49.495 0.112,49.496"'
    assert len(read(f'type="park" fill="1" {SHAPE}', f'type="park" fill="1" geo="1" {shape}', net=net)) == 1


@pytest.mark.parametrize(
    "words",
    [
        'type="water" fill="1"',
        'type="water" fill="1" shape="0,0 x,0 10,10"',
        'type="water" fill="1" shape="0,0 nan,0 10,10"',
        'type="water" fill="1" shape="0 10 20"',
        'type="water" fill="perhaps" shape="0,0 10,0 10,10"',
        'type="water" fill="1" geo="1" shape="0,0 200,0 10,10"',
        'type="nothing known" shape="0,0 1e99,0 10,10"',
    ],
)
def test_a_broken_polygon_is_refused_with_its_line(read: Read, words: str) -> None:
    with pytest.raises(ScenarioError, match=r"some\.poly\.xml line 3: polygon 'p1': "):
        read(f'type="park" fill="1" {SHAPE}', words)


def test_of_too_many_areas_the_largest_are_kept(read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(additional, "AREAS_LIMIT", 2)
    sides = (3, 9, 1, 5)
    found = read(*(f'type="park" fill="1" shape="0,0 {side},0 {side},{side}"' for side in sides))
    assert [area.outline_m[1][0] for area in found] == [9, 5]
