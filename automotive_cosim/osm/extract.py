"""Reads an OSM extract of any format and reduces it to the roads that cars use, and the ground around them.

libosmium reads every format and detects truncated files; the output for netconvert is always plain OSM XML. Other
ways (paths, railways) are removed, because each path that meets a road would split it in two.
"""

from __future__ import annotations

import gc
import os
import re
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field, replace
from functools import partial
from importlib import import_module
from itertools import compress, product
from pathlib import Path
from typing import Any, NamedTuple

from automotive_cosim.contracts import GroundKind
from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import is_utf8, open_file, opened
from automotive_cosim.formats.limited import read_limited
from automotive_cosim.formats.writing import drafted
from automotive_cosim.formats.xml import FilePlace, scan
from automotive_cosim.osm import land_cover
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.land_cover import MappedArea
from automotive_cosim.osm.oneway import directions
from automotive_cosim.osm.overpass_json import COUNTS, OverpassJson, is_json, refuse_broken_off
from automotive_cosim.osm.shores import closed_water, cut_water
from automotive_cosim.traffic.sumo_programs import INSTALL

LINKED = ("motorway", "trunk", "primary", "secondary", "tertiary")
"""Classes whose ramps and slip roads have a class of their own, ``…_link``."""

ROAD_CLASSES = frozenset(
    (*LINKED, *(f"{road}_link" for road in LINKED), "unclassified", "residential", "living_street")
)
"""OSM highway values to keep. Service roads are left out: SUMO's type map opens them to deliveries only."""

MAYBE_ROADS = frozenset(("service", "track", "road", "pedestrian", "busway", "bus_guideway", "escape", "raceway"))
"""Further OSM highway values of which cars may use some."""

CAMERA = "speed_camera"
TAGGED = (CAMERA, "stop", "give_way")
"""OSM highway values of what may also stand beside the road."""

POSITION = re.compile(r"-?\d{1,3}(\.\d*)?([eE]-?\d{1,2})?")
"""A latitude or longitude as OpenStreetMap writes it."""


_ID = re.compile(r"-?\d{1,19}")


class Position(NamedTuple):
    """WGS 84."""

    lon_deg: float
    lat_deg: float


@dataclass(frozen=True, slots=True)
class OsmWay:
    """One road of the extract."""

    way_id: int
    tags: Mapping[str, str]
    nodes: tuple[int, ...]

    @property
    def road_class(self) -> str:
        """OSM highway value."""
        return self.tags["highway"]


@dataclass(frozen=True, slots=True)
class Node:
    """One point of a road, with the objects there (signals, crossings)."""

    position: Position
    tags: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Relation:
    """A relation; members are (``"n"`` or ``"w"``, id, role)."""

    relation_id: int
    tags: Mapping[str, str]
    members: tuple[tuple[str, int, str], ...]


Passage = tuple[Position, Position]
"""Where watched traffic comes from and goes to."""


@dataclass(frozen=True, slots=True)
class MappedCamera:
    """A speed camera, on a road or beside it."""

    node: int
    position: Position
    tags: Mapping[str, str]
    courses: tuple[Passage, ...] = ()
    """The traffic that it watches, by the enforcement relations of which it is the device."""


@dataclass(frozen=True, slots=True)
class Extract:
    """The roads of an OSM extract."""

    ways: tuple[OsmWay, ...]
    """Those that cars may drive, in the order of their ids."""
    nodes: Mapping[int, Node]
    restrictions: tuple[Relation, ...]
    cameras: tuple[MappedCamera, ...] = ()
    ground: tuple[MappedArea, ...] = ()
    """Water, green and buildings, wherever in the extract."""
    closed: tuple[OsmWay, ...] = ()
    """Roads that cars may not drive in any direction."""
    told: Mapping[tuple[str, str], tuple[int, ...]] = field(default_factory=dict)
    """What is only listed: how (``TOLD_RELATIONS``), and whether these are relations or ways."""
    beside: Mapping[int, Node] = field(default_factory=dict)
    """Stop and give-way signs on no road for cars."""
    other_classes: Mapping[str, int] = field(default_factory=dict)
    """How many roads were left out for their class, by the class (``MAYBE_ROADS``)."""
    other_side: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    """Ways that were left out, all or in part, because traffic keeps the other side there, by country."""

    def crop(self, area: Area) -> Extract:
        """The part within an area; of a road that leaves and comes back, the longest stretch.

        Raises UserError: it contains no road."""
        part = self.part({ref: node for ref, node in self.nodes.items() if area.holds(*node.position)})
        if not part.ways:
            west, south, east, north = self.bounds
            raise UserError(
                f"no road in the --bbox; the map reaches from {west:.4f},{south:.4f} to {east:.4f},{north:.4f}"
            )
        return replace(
            part,
            cameras=tuple(camera for camera in self.cameras if area.holds(*camera.position)),
            beside={ref: node for ref, node in self.beside.items() if area.holds(*node.position)},
        )

    def part(self, nodes: Mapping[int, Node]) -> Extract:
        """The part with these nodes alone; of a road that leaves it and comes back, the longest stretch."""
        ways = tuple(piece for way in self.ways for piece in _known_pieces(way, nodes))
        kept = {way.way_id for way in ways}
        used = {ref for way in ways for ref in way.nodes}
        return replace(
            self,
            ways=ways,
            nodes={ref: node for ref, node in nodes.items() if ref in used},
            restrictions=tuple(
                turn
                for turn in self.restrictions
                if all(kind != "w" or ref in kept for kind, ref, _ in turn.members)
            ),
            closed=tuple(way for way in self.closed if nodes.keys() & set(way.nodes)),
        )

    @property
    def bounds(self) -> Area:
        """The smallest area that contains every road."""
        lons = [node.position.lon_deg for node in self.nodes.values()]
        lats = [node.position.lat_deg for node in self.nodes.values()]
        return Area(min(lons), min(lats), max(lons), max(lats))

    @property
    def centre(self) -> Position:
        """The median node: a position on the mapped roads even if a distant way stretches the box."""
        lons = sorted(node.position.lon_deg for node in self.nodes.values())
        lats = sorted(node.position.lat_deg for node in self.nodes.values())
        return Position(lons[len(lons) // 2], lats[len(lats) // 2])


def read(source: Path) -> Extract:
    """Reads the roads of an extract: OSM XML, plain, gzip or bzip2, PBF, or JSON of an Overpass server, detected by
    content, not by name.

    Raises:
        UserError: the file is missing, empty, truncated, not OSM data, or without roads.
        SetupError: the osmium package is not installed.
    """
    if not is_json(_head(source)):
        _osmium()
    return read_limited(_read, source, bounds.MAP, UserError)


def _read(source: Path) -> Extract:
    """Runs in a process with limits: how much an extract unpacks to, only its readers know."""
    os.environ["OSMIUM_POOL_THREADS"] = "2"  # each of as many as there are cores would reserve memory
    gc.disable()  # the process ends with this map: looking for cycles among its nodes takes a tenth of the time
    ways, relations, nodes, tagged, areas, others, water = (_read_json if is_json(_head(source)) else _read_osm)(
        source
    )
    ways.sort(key=lambda way: way.way_id)
    complete = [piece for way in ways for piece in _known_pieces(way, nodes)]
    is_open = [any(directions(way.tags)) for way in complete]
    opened = tuple(compress(complete, is_open))
    if not opened:
        raise UserError(
            f"{source} has no roads for cars ({len(ways)} ways tagged as such, with {len(nodes)} of their nodes);"
            " give an extract that keeps highway=* ways and their nodes"
        )
    used = {ref for way in opened for ref in way.nodes}
    cameras = {ref: node for ref, node in tagged.items() if node.tags["highway"] == CAMERA}
    listed = [((kind, "relation"), each.relation_id) for each in relations if (kind := _told_kind(each.tags))]
    told: dict[tuple[str, str], tuple[int, ...]] = {}
    for how, number in sorted([*listed, *water]):
        told[how] = (*told.get(how, ()), number)
    return Extract(
        opened,
        {ref: node for ref, node in sorted(nodes.items()) if ref in used},
        tuple(sorted(filter(_is_restriction, relations), key=lambda turn: turn.relation_id)),
        tuple(_watching(cameras, relations, nodes, {way.way_id: way for way in ways})),
        land_cover.in_order(areas),
        tuple(way for way, there in zip(complete, is_open, strict=True) if not there),
        told,
        {ref: node for ref, node in tagged.items() if ref not in used and ref not in cameras},
        others,
    )


def _watching(
    tagged: Mapping[int, Node], relations: Iterable[Relation], nodes: Mapping[int, Node], ways: Mapping[int, OsmWay]
) -> Iterator[MappedCamera]:
    """The nodes tagged as speed cameras, and the devices of relations that enforce a limit, with what these say."""
    cameras, courses = dict(tagged), dict[int, list[Passage]]()

    def place(kind: str, ref: int) -> Position | None:
        if kind == "w" and ref in ways:
            ref = ways[ref].nodes[len(ways[ref].nodes) // 2]
        return nodes[ref].position if ref in nodes else None

    for relation in filter(_is_enforcement, relations):
        roles: dict[str, list[Position]] = {}
        for kind, ref, role in relation.members:
            if there := place(kind, ref):
                roles.setdefault(role, []).append(there)
        for kind, ref, role in relation.members:
            if kind != "n" or role != "device" or ref not in nodes:
                continue
            if relation.tags.get("enforcement") in LIMITS_ENFORCED:
                cameras.setdefault(ref, nodes[ref])
            here = [nodes[ref].position]
            course = product(roles.get("from", here), roles.get("to", here))
            courses.setdefault(ref, []).extend((start, goal) for start, goal in course if start != goal)
    for ref, node in sorted(cameras.items()):
        yield MappedCamera(ref, node.position, node.tags, tuple(courses.get(ref, ())))


LIMITS_ENFORCED = frozenset(("maxspeed", "average_speed"))
"""Values of ``enforcement`` that are about speed (OSM wiki, "Relation:enforcement")."""

_Nodes = dict[int, Node]
_Listed = list[tuple[tuple[str, str], int]]
_Parts = tuple[
    list[OsmWay], tuple[Relation, ...], _Nodes, _Nodes, tuple[MappedArea, ...], Mapping[str, int], _Listed
]
"""Ways open to cars, relations, the nodes of both, those with a ``TAGGED`` thing, the ground, how many ways of
other classes there are, and the water that is not whole."""


def _read_osm(source: Path) -> _Parts:
    kind = _format(source, _head(source))
    deleted, version = _checked(source) if kind != "pbf" else (set[tuple[str, int]](), "")
    osmium = _osmium()
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-map-") as scratch:
        try:
            file = source
            if kind != "pbf" and version in OLD_VERSIONS:
                file, kind = _as_new(source, Path(scratch) / "new.osm"), "osm"
            if deleted:
                return _read_sorted(file, kind, deleted, Path(scratch))
            try:
                return _read_file(osmium.io.File(str(file), kind))
            except RuntimeError as error:
                if not _UNSORTED.search(str(error)):
                    raise
                return _read_sorted(file, kind, deleted, Path(scratch))
        except (RuntimeError, ValueError, ArithmeticError, MemoryError, osmium.InvalidLocationError) as error:
            raise UserError(_explain(source, str(error))) from error


OLD_VERSIONS = ("1", "1.0", "")
"""What tools write (OSMnx before 1.3) or leave out that mean the present version of the format, 0.6."""

_ROOT = re.compile(rb"<(osm|osmChange)\b")
_VERSION = re.compile(rb"""\sversion=["'][^"']*["']""")


def _as_new(source: Path, target: Path) -> Path:
    """Writes a file unpacked, with the present version, without what Overpass adds (``out geom``, ``center``)."""
    with opened(source) as old, drafted(target) as new:
        text = old.read()
        start = _ROOT.search(text)
        at, end = (start.end(), text.index(b">", start.end())) if start else (0, 0)
        root = b' version="0.6"' + _VERSION.sub(b"", text[at:end])
        body = re.sub(rb"<(bounds|center)\b[^>]*>(\s*</(bounds|center)>)?", b"", text[end:])
        body = re.sub(rb"<member\b([^>]*[^/>])>.*?</member>", rb"<member\1/>", body, flags=re.DOTALL)
        new.write(text[:at] + root + body)
    return target


_UNSORTED = re.compile(r"out of order|twice")
"""What libosmium says of a file whose elements are not sorted, or are there twice."""


def _read_sorted(source: Path, kind: str, deleted: Set[tuple[str, int]], scratch: Path) -> _Parts:
    """Reads a file in which elements are in any order, more than once (the newest version counts), or deleted."""
    osmium = _osmium()
    merged = osmium.MergeInputReader()
    named = scratch / f"map.{kind}"  # by its ending libosmium knows the format here
    named.symlink_to(source.absolute())
    merged.add_file(str(named))
    target = osmium.io.File(str(scratch / "sorted.osm.pbf"), "pbf,add_metadata=false")
    with osmium.SimpleWriter(target) as writer:

        def keep(kind: str, element: Any) -> None:
            if element.visible and (kind, element.id) not in deleted:
                getattr(writer, f"add_{kind}")(element)

        handler = osmium.make_simple_handler(
            node=partial(keep, "node"), way=partial(keep, "way"), relation=partial(keep, "relation")
        )
        merged.apply(handler, simplify=True)
    return _read_file(osmium.io.File(str(scratch / "sorted.osm.pbf"), "pbf"))


def _read_file(file: Any) -> _Parts:
    carried: dict[int, Node] = {}
    ways, relations, others = _read_ways(file, carried)
    nodes = carried | _read_nodes(file, _wanted(ways, relations))
    lines = [[nodes[ref].position for ref in way.nodes if ref in nodes] for way in ways]
    water: _Listed = []
    areas = tuple(_read_ground(file, [line for line in lines if len(line) > 1], water))
    return ways, relations, nodes, _read_tagged(file), areas, others, water


def _wanted(ways: Iterable[OsmWay], relations: Iterable[Relation]) -> set[int]:
    """The nodes of roads, and of what enforces a limit."""
    members = (member for relation in relations if _is_enforcement(relation) for member in relation.members)
    return {ref for way in ways for ref in way.nodes} | {ref for kind, ref, _ in members if kind == "n"}


def _read_json(source: Path) -> _Parts:
    read = OverpassJson(source)
    ways = [OsmWay(way_id, tags, nodes) for way_id, tags, nodes in read.ways() if _is_road(tags)]
    others = Counter(left_out for _, tags, _ in read.ways() if (left_out := _left_out(tags)))
    relations = tuple(filter(_is_kept, (Relation(*relation) for relation in read.relations())))
    wanted = _wanted(ways, relations)
    outlines = [(kind, refs) for _, tags, refs in read.ways() if (kind := _ground_of(tags, refs)) is not None]
    corners = {ref for _, refs in outlines for ref in refs}
    places: dict[int, Position] = {}
    nodes: dict[int, Node] = {}
    tagged: dict[int, Node] = {}
    for node_id, tags, place in read.nodes():
        if node_id in corners:
            places[node_id] = Position(*place)
        if node_id in wanted:
            nodes[node_id] = Node(Position(*place), tags)
        if tags.get("highway") in TAGGED:
            tagged[node_id] = Node(Position(*place), tags)
    areas = (
        MappedArea.of(kind, [places[ref] for ref in refs]) for kind, refs in outlines if places.keys() >= set(refs)
    )
    in_json = ("water in JSON, left out", "relation")
    water: _Listed = [
        (in_json, ref) for ref, tags, _ in read.relations() if land_cover.kind_of(tags) is GroundKind.WATER
    ]
    return ways, relations, dict(sorted(nodes.items())), tagged, tuple(areas), others, water


def _ground_of(tags: Mapping[str, str], refs: tuple[int, ...]) -> GroundKind | None:
    """What a way is the outline of; None if it is none."""
    return land_cover.kind_of(tags) if len(refs) > 3 and refs[0] == refs[-1] else None


def _osmium() -> Any:
    try:
        return import_module("osmium")
    except ImportError as error:
        cause: BaseException | None = error
        while cause is not None:  # Ctrl-C while compiled modules load comes as an error of loading
            if isinstance(cause, KeyboardInterrupt):
                raise cause from None
            cause = cause.__cause__ or cause.__context__
        raise SetupError(f"importing maps requires the osmium package: {INSTALL}") from error


def _head(source: Path) -> bytes:
    try:
        with open_file(source) as stream:
            return stream.read(4096)
    except OSError as error:
        raise UserError(f"{source}: {error.strerror or error}; give the path of an OSM extract") from error


class _UnreadableError(UserError):
    """XML that osmium's own words describe better."""


def _checked(source: Path) -> tuple[set[tuple[str, int]], str]:
    """Refuses positions that libosmium would misread (1e300 becomes 0), an archive of more than is read, and what a
    server broke off.

    Returns:
        The elements that JOSM keeps although they were deleted, by kind and id: libosmium takes them for real. And
        the version of the format.
    """
    deleted: set[tuple[str, int]] = set()
    version, within, place = "0.6", "", FilePlace()

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal version, within
        if name in ("tag", "nd"):  # most of the elements
            version = "" if name == "nd" and within == "relation" else version
            return
        if name in ("osm", "osmChange"):
            version = attributes.get("version", "")
        elif name in ("node", "way", "relation"):
            within = name
        elif name == "center" or (name == "bounds" and within):
            version = ""
        elif name == "count":
            raise UserError(f"{source} {COUNTS}")
        elif name == "remark":
            with opened(source) as stream:
                remark = re.search(rb"<remark>(.*?)</remark>", stream.read(), re.DOTALL)
            refuse_broken_off(source, remark[1].decode("utf-8", "replace") if remark else "")
        for key, most in (("lat", 90), ("lon", 180)) if name == "node" else ():
            text = attributes.get(key, "0")
            if not POSITION.fullmatch(text) or abs(float(text)) > most:
                raise UserError(f"{source} line {place.line}: {key} is {text[:40]!r}; it is from {-most} to {most}")
        if attributes.get("action") == "delete" or attributes.get("visible") == "false":
            number = attributes.get("id", "")
            if _ID.fullmatch(number):
                deleted.add((name, int(number)))

    try:
        scan(source, start, place=place, error=_UnreadableError)
    except _UnreadableError as error:
        if isinstance(error.__cause__, OSError):
            raise UserError(f"{source} is truncated or damaged ({error.__cause__})") from error
    return deleted, version


def _format(source: Path, head: bytes) -> str:
    if not head:
        raise UserError(f"{source} is empty; download the extract again")
    if head.startswith(b"\x1f\x8b"):
        return "osm.gz"
    if head.startswith(b"BZh"):
        return "osm.bz2"
    if b"OSMHeader" in head:
        return "pbf"
    if head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return "osm"
    kind = "a zip archive; unpack it and" if head.startswith(b"PK\x03\x04") else "not OSM data;"
    raise UserError(f"{source} is {kind} give OSM XML (plain, .gz or .bz2), .osm.pbf or Overpass JSON")


def _explain(source: Path, error: str) -> str:
    if "top-level element" in error:
        return f"{source} is XML but not OSM ({error}); give an extract whose root is <osm>"
    if "gzip error" in error or "bzip2 error" in error or "EOF" in error or "truncated" in error:
        return f"{source} is truncated or damaged ({error}); download it again"
    if "unknown encoding" in error or ("invalid token" in error and not is_utf8(source)):
        return (
            f"{source} has letters that are not in the encoding that it names, or that is not read ({error});"
            ' save it as UTF-8, or begin it with <?xml version="1.0" encoding="ISO-8859-1"?> if it is in Latin-1'
        )
    if "XML parsing error" in error:
        return f"{source} is truncated or not OSM XML ({error}); download it again"
    return f"{source} cannot be read as OSM data ({error}); give OSM XML (plain, .gz or .bz2) or .osm.pbf"


def _read_ways(file: Any, carried: dict[int, Node]) -> tuple[list[OsmWay], tuple[Relation, ...], Mapping[str, int]]:
    """Roads and relations, the nodes that ways carry along with their positions (``out geom``), and how many ways
    of other classes there are."""
    osmium = _osmium()
    ways: list[OsmWay] = []
    others: Counter[str] = Counter()
    relations: list[Relation] = []
    wanted = osmium.filter.KeyFilter("highway", "type")
    for item in osmium.FileProcessor(file, osmium.osm.WAY | osmium.osm.RELATION).with_filter(wanted):
        tags = {tag.k: tag.v for tag in item.tags}
        if item.is_way():
            if _is_road(tags):
                ways.append(OsmWay(item.id, tags, tuple(node.ref for node in item.nodes)))
                known = [node for node in item.nodes if node.location.valid()]
                carried |= {node.ref: Node(Position(node.lon, node.lat), {}) for node in known}
            elif left_out := _left_out(tags):
                others[left_out] += 1
        else:
            members = tuple((member.type, member.ref, member.role) for member in item.members)
            relations.append(Relation(item.id, tags, members))
    return ways, tuple(filter(_is_kept, relations)), others


def _is_kept(relation: Relation) -> bool:
    return _is_restriction(relation) or _is_enforcement(relation) or _told_kind(relation.tags) != ""


TOLD_RELATIONS = {
    ("boundary", "low_emission_zone"): "low-emission zones, taken as open to any car",
    ("boundary", "limited_traffic_zone"): "limited-traffic zones, taken as open to any car",
    ("type", "connectivity"): "lanes that lead elsewhere than by their arrows, left out",
    ("type", "stop"): "stop signs as relations, left out",
    ("type", "give_way"): "give-way signs as relations, left out",
}
"""Relations that are only listed, by a tag, and how."""


def _told_kind(tags: Mapping[str, str]) -> str:
    return next((kind for (key, value), kind in TOLD_RELATIONS.items() if tags.get(key) == value), "")


def _is_restriction(relation: Relation) -> bool:
    return relation.tags.get("type", "").partition(":")[0] == "restriction"


def _is_enforcement(relation: Relation) -> bool:
    return relation.tags.get("type") == "enforcement"


def _is_road(tags: Mapping[str, str]) -> bool:
    road = tags.get("highway")
    return (tags.get("construction") if road == "construction" else road) in ROAD_CLASSES and tags.get(
        "area"
    ) != "yes"


def _left_out(tags: Mapping[str, str]) -> str:
    """The class of a way on which cars may drive, but which is not read; several, as tools write them, count."""
    value = tags.get("highway", "")
    words = set(re.findall(r"\w+", value.lower())) if value not in ROAD_CLASSES and not _is_road(tags) else ()
    return value if value in MAYBE_ROADS or ROAD_CLASSES.intersection(words) else ""


def _read_nodes(file: Any, wanted: set[int]) -> dict[int, Node]:
    osmium = _osmium()
    nodes: dict[int, Node] = {}
    # No IdFilter: its bitmap of all ids up to the highest takes a gigabyte.
    for node in osmium.FileProcessor(file, osmium.osm.NODE):
        if node.id in wanted and node.location.valid():
            tags = {tag.k: tag.v for tag in node.tags}
            nodes[node.id] = Node(Position(node.location.lon, node.location.lat), tags)
    return nodes


def _read_tagged(file: Any) -> dict[int, Node]:
    osmium = _osmium()
    tagged = osmium.filter.TagFilter(*(("highway", value) for value in TAGGED))
    found = osmium.FileProcessor(file, osmium.osm.NODE).with_filter(tagged)
    return {
        node.id: Node(Position(node.location.lon, node.location.lat), {tag.k: tag.v for tag in node.tags})
        for node in found
        if node.location.valid()
    }


def _read_ground(file: Any, roads: list[list[Position]], told: _Listed) -> Iterator[MappedArea]:
    """Areas of closed ways and of multipolygons; of those that the extract cuts, only water (``shores``)."""
    osmium = _osmium()
    whole: set[tuple[str, int]] = set()
    tagged = osmium.filter.KeyFilter(*land_cover.KEYS)
    areas = osmium.FileProcessor(file).with_areas(tagged).with_filter(tagged)
    for area in areas.with_filter(osmium.filter.EntityFilter(osmium.osm.AREA)):
        kind = land_cover.kind_of({tag.k: tag.v for tag in area.tags})
        if kind is None:
            continue
        if area.num_rings()[0]:
            whole.add(("way" if area.from_way() else "relation", area.orig_id()))
        for outer in area.outer_rings():
            yield MappedArea.of(kind, _line(outer), map(_line, area.inner_rings(outer)))
    waters = [water for water in _waters(osmium, file) if (water.kind, water.number) not in whole]
    lines = _lines(osmium, file, {way for water in waters for way in (*water.outer, *water.inner)})
    for water in waters:
        outer, inner = ([lines[way] for way in ways if way in lines] for ways in (water.outer, water.inner))
        shapes = cut_water([*outer, *inner], roads)
        if water.number and not shapes:
            shapes = closed_water(outer, inner, roads)
            done = "closed by straight lines" if shapes else "left out"
            told.append(((f"water that the extract cuts, {done}", water.kind), water.number))
        yield from (MappedArea(GroundKind.WATER, shape) for shape in shapes)


class _Water(NamedTuple):
    """A water whose outline may not be whole; the coast has no number."""

    kind: str
    number: int
    outer: tuple[int, ...]
    inner: tuple[int, ...] = ()


def _waters(osmium: Any, file: Any) -> Iterator[_Water]:
    """Closed ways and multipolygons of water, and all coastlines."""
    values = [(key, value) for key, words in land_cover.TAGS[GroundKind.WATER].items() for value in words]
    tagged = osmium.filter.TagFilter(*values, ("natural", "coastline"))
    coast: list[int] = []
    for item in osmium.FileProcessor(file, osmium.osm.WAY | osmium.osm.RELATION).with_filter(tagged):
        tags = {tag.k: tag.v for tag in item.tags}
        if tags.get("natural") == "coastline" and item.is_way():
            coast.append(item.id)
        elif land_cover.kind_of(tags) is not GroundKind.WATER:
            continue
        elif item.is_relation() and tags.get("type") in ("multipolygon", "boundary"):
            ways = sorted((member.role == "inner", member.ref) for member in item.members if member.type == "w")
            of_role = (tuple(ref for is_inner, ref in ways if is_inner is role) for role in (False, True))
            yield _Water("relation", item.id, *of_role)
        elif item.is_way() and len(item.nodes) > 3 and item.nodes[0].ref == item.nodes[-1].ref:
            yield _Water("way", item.id, (item.id,))
    if coast:
        yield _Water("way", 0, tuple(coast))


def _lines(osmium: Any, file: Any, wanted: set[int]) -> dict[int, list[tuple[float, float]]]:
    """What is known of these ways."""
    if not wanted:
        return {}
    only_ways = osmium.filter.EntityFilter(osmium.osm.WAY)
    ways = osmium.FileProcessor(file, osmium.osm.NODE | osmium.osm.WAY).with_locations().with_filter(only_ways)
    return {way.id: _line(node for node in way.nodes if node.location.valid()) for way in ways if way.id in wanted}


def _line(nodes: Iterable[Any]) -> list[tuple[float, float]]:
    return [(node.lon, node.lat) for node in nodes]


def _known_pieces(way: OsmWay, nodes: Mapping[int, Node]) -> Iterator[OsmWay]:
    """The part of a way whose nodes are in the extract: the longest stretch, if clipping left gaps."""
    stretches: list[list[int]] = [[]]
    for ref in way.nodes:
        if ref in nodes:
            stretches[-1].append(ref)
        elif stretches[-1]:
            stretches.append([])
    longest = max(stretches, key=len)
    if len(longest) > 1:
        yield OsmWay(way.way_id, way.tags, tuple(longest))
