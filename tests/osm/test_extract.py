import bz2
import gzip
import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.osm import extract
from automotive_cosim.osm.roads import id_of, way_of
from automotive_cosim.osm.towns import is_dense, town_cells

OSM = b'<?xml version="1.0"?><osm version="0.6">%s</osm>'


def test_every_format_gives_the_same_roads(formats: dict[str, Path]) -> None:
    plain = extract.read(formats[""])
    assert plain.ways
    assert plain.nodes
    for ending in (".gz", ".bz2", ".pbf", ".xml"):
        assert extract.read(formats[ending]) == plain


def test_the_content_decides_and_not_the_name(formats: dict[str, Path], tmp_path: Path) -> None:
    for ending, path in formats.items():
        renamed = tmp_path / f"download{ending.replace('.', '-')}"
        renamed.write_bytes(path.read_bytes())
        assert extract.read(renamed) == extract.read(formats[""])


def _as_json(path: Path, *, with_positions: bool) -> bytes:
    """The file as an Overpass server answers ``[out:json]``, the nodes apart or (``out geom``) with the ways."""
    import osmium

    positions: dict[int, dict[str, float]] = {}
    elements: list[dict[str, object]] = []
    for item in osmium.FileProcessor(str(path)):
        tags = {tag.k: tag.v for tag in item.tags}
        if item.is_node():
            positions[item.id] = {"lat": item.location.lat, "lon": item.location.lon}
            if tags or not with_positions:
                elements.append({"type": "node", "id": item.id, "tags": tags} | positions[item.id])
        elif item.is_way():
            refs = [node.ref for node in item.nodes]
            way: dict[str, object] = {"type": "way", "id": item.id, "tags": tags, "nodes": refs}
            elements.append(way | ({"geometry": [positions[ref] for ref in refs]} if with_positions else {}))
    return json.dumps({"version": 0.6, "generator": "Overpass API", "elements": elements}).encode()


@pytest.mark.parametrize("version", ["1", "1.0", ""])
@pytest.mark.parametrize("ending", ["", ".gz", ".bz2"])
def test_files_that_say_version_1_are_read(
    version: str, ending: str, formats: dict[str, Path], tmp_path: Path
) -> None:
    data = (
        formats[""]
        .read_bytes()
        .replace(b'<osm version="0.6"', f'<osm version="{version}"'.encode() if version else b"<osm")
    )
    file = tmp_path / f"map.osm{ending}"
    file.write_bytes({"": bytes, ".gz": gzip.compress, ".bz2": bz2.compress}[ending](data))
    assert extract.read(file) == extract.read(formats[""])


def test_ways_may_carry_their_nodes(formats: dict[str, Path], tmp_path: Path) -> None:
    file = tmp_path / "geom.osm"
    inner = b'<nd ref="1" lat="48.3" lon="1.6"/><nd ref="2" lat="48.31" lon="1.6"/>'
    bounds = b'<bounds minlat="48.3" minlon="1.6" maxlat="48.31" maxlon="1.6"/>'
    beyond, tag = b'<nd ref="3"/>', b'<tag k="highway" v="primary"/></way>'
    member = b'<member type="way" ref="5" role="from"><nd lat="48.3" lon="1.6"/><nd/></member>'
    turn = b'<relation id="6">%s%s<tag k="type" v="restriction"/></relation>' % (bounds, member)
    for content in (inner, inner + beyond, bounds + inner):
        for more in (b"", turn):
            file.write_bytes(OSM % (b'<way id="5">' + content + tag + more))
            found = extract.read(file)
            assert [node.position for node in found.nodes.values()] == [(1.6, 48.3), (1.6, 48.31)]
            assert len(found.restrictions) == bool(more)


def test_a_class_as_a_tool_writes_several_is_counted(tmp_path: Path) -> None:
    values = ("['residential', 'tertiary']", "residential;service", "service", "footway", "Residential")
    file, way = tmp_path / "classes.osm", '<way id="{}"><nd ref="1"/><nd ref="2"/><tag k="highway" v="{}"/></way>'
    nodes = '<node id="1" lat="48.3" lon="1.6"/><node id="2" lat="48.31" lon="1.6"/>'
    ways = (way.format(*each) for each in enumerate(("primary", *values), start=1))
    file.write_bytes(OSM % (nodes + "".join(ways)).encode())
    assert dict(extract.read(file).other_classes) == {value: 1 for value in values if value != "footway"}


@pytest.mark.parametrize("with_positions", [False, True])
@pytest.mark.parametrize("packed", [False, True])
def test_the_json_of_a_server_gives_the_same_roads(
    with_positions: bool, packed: bool, formats: dict[str, Path], tmp_path: Path
) -> None:
    data = _as_json(formats[""], with_positions=with_positions)
    file = tmp_path / "answer"
    file.write_bytes(gzip.compress(data) if packed else data)
    assert extract.read(file) == extract.read(formats[""])


def test_only_roads_that_cars_may_use_are_read(formats: dict[str, Path]) -> None:
    roads = extract.read(formats[""])
    assert all(way.road_class in extract.ROAD_CLASSES for way in roads.ways)
    assert not [way for way in roads.ways if way.tags.get("access") == "private"]
    assert {ref for way in roads.ways for ref in way.nodes} == set(roads.nodes)


@pytest.mark.parametrize(
    ("tags", "may"),
    [
        ({}, True),
        ({"access": "no", "motor_vehicle": "yes"}, True),
        ({"access": "yes", "motorcar": "no"}, False),
        ({"access": "destination"}, True),
        ({"vehicle": "private"}, False),
    ],
)
def test_the_access_key_nearest_to_cars_decides(tags: dict[str, str], may: bool, tmp_path: Path) -> None:
    rows = "".join(f'<tag k="{key}" v="{value}"/>' for key, value in tags.items())
    body = (
        '<node id="1" lat="48" lon="2"/><node id="2" lat="48.01" lon="2"/><way id="1"><nd ref="1"/><nd ref="2"/>'
        f'<tag k="highway" v="residential"/>{rows}</way>'
    )
    file = tmp_path / "one.osm"
    file.write_bytes(OSM % body.encode())
    if may:
        assert len(extract.read(file).ways) == 1
    else:
        with pytest.raises(UserError, match="no roads for cars"):
            extract.read(file)


def test_a_way_clipped_by_the_extract_keeps_its_longest_stretch(tmp_path: Path) -> None:
    nodes = "".join(f'<node id="{n}" lat="48.00{n}" lon="2"/>' for n in (1, 2, 4, 5, 6))
    refs = "".join(f'<nd ref="{n}"/>' for n in range(1, 7))
    file = tmp_path / "clipped.osm"
    file.write_bytes(OSM % f'{nodes}<way id="1">{refs}<tag k="highway" v="primary"/></way>'.encode())
    assert [way.nodes for way in extract.read(file).ways] == [(4, 5, 6)]


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is empty"),
        (b"PK\x03\x04rest of it", "zip archive"),
        (b"once upon a time", "not OSM data"),
        (b'<?xml version="1.0"?><net version="1.20"><edge id="a"/></net>', "not OSM"),
        (b"<!DOCTYPE html><html><body>429 Too Many Requests</body></html>", "not OSM"),
        (b'{"version": 0.6, "elements": []}', "no roads for cars"),
        (b'{"version": 0.6}', "no OSM elements"),
        (b'{"version": 0.6, "elements": [', "truncated"),
        (b'[{"type": "Feature"}]', "no OSM elements"),
        (b'{"elements": [], "remark": "runtime error: Query timed out in \\"query\\""}', "the server stopped"),
        (b'{"elements": [{"type": "count", "id": 0, "tags": {"total": "5"}}]}', "only counts elements"),
        (OSM % b'<count id="0"><tag k="total" v="5"/></count>', "only counts elements"),
        (OSM % b"<remark> runtime error: Query timed out </remark>", "the server stopped"),
        (OSM % b"<remark> runtime error: Query run out of memory </remark>", "the server stopped"),
        (OSM % b"<remark> considered </remark>", "no roads for cars"),
        (b'{"elements": [{"type": "way", "id": 1, "tags": {"highway": "primary"}}]}', "without its nodes"),
        (b'{"elements": [{"type": "node", "id": 1, "lat": 99, "lon": 2}]}', "without a position"),
        (OSM % b"", "no roads for cars"),
        (OSM % b'<node id="1" lat="48" lon="2"/>', "no roads for cars"),
        (OSM % b'<node id="1" lat="nan" lon="2"/>', "lat is 'nan'; it is from -90 to 90"),
        (OSM % b'<node id="1" lat="1e300" lon="2"/>', "lat is '1e300'; it is from -90 to 90"),
        (OSM % b'<node id="1" lat="48" lon="-180.1"/>', "lon is '-180.1'; it is from -180 to 180"),
        (OSM % '<node id="1" lat="\u0661" lon="2"/><way id="1"><nd ref="1"/></way>'.encode(), "coordinate"),
        (OSM % b'<node id="99999999999999999999" lat="48" lon="2"/><way id="1"><nd ref="1"/></way>', "id"),
        (OSM % b'<way id="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/></way>', "no roads for cars"),
    ],
)
def test_what_is_no_map_is_refused_on_one_line(content: bytes, says: str, tmp_path: Path) -> None:
    file = tmp_path / "map.osm"
    file.write_bytes(content)
    with pytest.raises(UserError, match=says) as refused:
        extract.read(file)
    assert "map.osm" in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("ending", ["", ".gz", ".bz2", ".pbf"])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.999])
def test_a_cut_off_file_is_refused(ending: str, share: float, formats: dict[str, Path], tmp_path: Path) -> None:
    whole = formats[ending].read_bytes()
    cut = tmp_path / f"cut.osm{ending}"
    cut.write_bytes(whole[: int(len(whole) * share)])
    with pytest.raises(UserError, match=r"truncated") as refused:
        extract.read(cut)
    assert "\n" not in str(refused.value)


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "nowhere.osm", tmp_path):
        with pytest.raises(UserError, match="give the path of an OSM extract"):
            extract.read(path)


def test_without_osmium_the_mend_is_named(formats: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "osmium", None)
    with pytest.raises(SetupError, match=re.escape(install_hint("maps"))):
        extract.read(formats[""])


def test_town_and_country_are_told_apart(make_village: Callable[..., object], formats: dict[str, Path]) -> None:
    roads = extract.read(formats[""])
    towns = town_cells(roads)
    dense = {way.tags["name"]: is_dense(way, roads.nodes, towns) for way in roads.ways if "name" in way.tags}
    assert dense["Rue du Lavoir"]
    assert dense["Allée 3"]
    assert not dense["Chemin du Haut"]


ROAD = (
    '<way id="{}" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/>'
    '<tag k="name" v="{}"/></way>'
)
NODES = '<node id="1" version="1" lat="48" lon="2"/><node id="2" version="1" lat="48.01" lon="2"/>'


def _named(folder: Path, body: str, head: str = "", encoding: str = "utf-8") -> dict[int, str]:
    """The roads of a file, by number."""
    file = folder / "map.osm"
    file.write_bytes(f'{head}<osm version="0.6">{body}</osm>'.encode(encoding))
    return {way.way_id: way.tags["name"] for way in extract.read(file).ways}


def test_elements_may_come_in_any_order_and_twice(tmp_path: Path) -> None:
    ways = [ROAD.format(number, f"road {number}") for number in (7, 5, 6)]
    roads = {number: f"road {number}" for number in (5, 6, 7)}
    assert _named(tmp_path, NODES + "".join(ways)) == roads
    assert _named(tmp_path, "".join(ways) + NODES) == roads
    assert _named(tmp_path, NODES + "".join(ways) + NODES + "".join(ways)) == roads
    newer = ROAD.format(6, "renamed").replace('version="1"', 'version="2"')
    for order in ([newer, *ways], [*ways, newer]):
        assert _named(tmp_path, NODES + "".join(order)) == roads | {6: "renamed"}


def test_what_josm_drew_is_there_and_what_it_deleted_is_not(tmp_path: Path) -> None:
    """New objects count down from -1, have no version, and follow in any order; deleted ones stay in the file."""
    new = ROAD.format(-3, "new").replace(' version="1"', " action='modify'")
    gone = [
        ROAD.format(8, "gone").replace("version", f"{mark} version")
        for mark in ("action='delete'", "visible='false'")
    ]
    for ways in ([ROAD.format(4, "old"), new], [new, ROAD.format(4, "old")]):
        assert _named(tmp_path, NODES + "".join(ways)) == {-3: "new", 4: "old"}
    for way in gone:
        assert _named(tmp_path, NODES + way + ROAD.format(4, "old")) == {4: "old"}
    drawn = NODES.replace('id="', 'id="-').replace('version="1"', "action='modify'")
    assert _named(tmp_path, drawn + new.replace('ref="', 'ref="-')) == {-3: "new"}


@pytest.mark.parametrize("way", [1, -1, 12, -12])
@pytest.mark.parametrize("part", [1, 2, 11])
@pytest.mark.parametrize("added", ["{}", "-{}", "{}#3", "-{}#0-AddedOnRampEdge"])
def test_the_id_of_an_edge_tells_its_way(way: int, part: int, added: str) -> None:
    assert way_of(added.format(id_of(way, part))) == way


def test_latin_letters_are_read_if_the_file_says_so(tmp_path: Path) -> None:
    encoding = "ISO-8859-1"
    road = NODES + ROAD.format(1, "Straße")
    assert _named(tmp_path, road, f'<?xml version="1.0" encoding="{encoding}"?>', encoding) == {1: "Straße"}
    with pytest.raises(UserError, match="save it as UTF-8"):
        _named(tmp_path, road, '<?xml version="1.0" encoding="UTF-8"?>', encoding)


def test_relations_by_kind_of_vehicle_are_read(tmp_path: Path) -> None:
    rows = "".join(
        f'<relation id="{number}"><member type="way" ref="1" role="from"/><tag k="type" v="{kind}"/></relation>'
        for number, kind in enumerate(("restriction", "restriction:hgv", "route", "restrictions"), start=1)
    )
    file = tmp_path / "map.osm"
    file.write_text(f'<osm version="0.6">{NODES}{ROAD.format(1, "x")}{rows}</osm>', encoding="utf-8")
    assert [turn.relation_id for turn in extract.read(file).restrictions] == [1, 2]
