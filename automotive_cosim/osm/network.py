"""Builds a SUMO network from cleaned OSM XML, and describes it."""

from __future__ import annotations

import gzip
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import quoteattr

import shapely

from automotive_cosim.errors import ImportMapError
from automotive_cosim.osm.country import LEFT_HAND
from automotive_cosim.osm.extract import Position
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Edge, Network, read_network
from automotive_cosim.traffic.sumo_programs import first_error, home, run

KEPT_TAGS = (
    "bridge",
    "covered",
    "dual_carriageway",
    "hazard",
    "lane_markings",
    "layer",
    "lit",
    "maxspeed",
    "maxspeed:conditional",
    "maxspeed:type",
    "motorroad",
    "overtaking",
    "ref",
    "source:maxspeed",
    "surface",
    "toll",
    "tunnel",
    "zone:maxspeed",
    "zone:traffic",
)
"""OSM tags that become parameters of the edges."""

GEOMETRY = (
    "--proj.utm",
    "--output.street-names",
    "--keep-edges.by-vclass=passenger",
    "--keep-edges.components=1",
    "--junctions.join",
    "--junctions.join-dist=20",
    "--roundabouts.guess",
    "--ramps.guess",
    "--no-turnarounds.except-deadend",
)
"""Options for what to keep and how to connect it. Nodes between two edges stay (no ``--geometry.remove``): merging
edges also merges their parameters, which doubles the length of the tunnels of western Paris. Junctions are joined
over 20 m, because cars side by side on a shorter piece between two of them block each other's lanes for good."""

SIGNALS = (
    "--tls.guess-signals",
    "--tls.discard-simple",
    "--tls.default-type=actuated",
    "--tls.layout=opposites",
)
"""OSM has signals at the stop lines: SUMO guesses which junction they belong to, and their phases."""


CAMERA_WITHIN_M = 30.0
"""A camera farther from every road is at one that was not imported."""


@dataclass(frozen=True, slots=True)
class Built:
    """The network built from a map."""

    network: Network
    signals: int
    roundabouts: int

    @property
    def edges(self) -> tuple[Edge, ...]:
        """The edges, without those inside junctions."""
        return tuple(self.network.edges.values())

    def entries(self) -> frozenset[str]:
        """Edges by which traffic enters the map: only their own opposite direction leads to them."""
        from_where = _neighbours((edge.to_node, edge.from_node) for edge in self.edges)
        return frozenset(e.edge_id for e in self.edges if from_where.get(e.from_node, set()) <= {e.to_node})

    def exits(self) -> frozenset[str]:
        """Edges by which traffic leaves the map."""
        where_to = _neighbours((edge.from_node, edge.to_node) for edge in self.edges)
        return frozenset(e.edge_id for e in self.edges if where_to.get(e.to_node, set()) <= {e.from_node})


_ESCAPED_TWICE = re.compile(r"&amp;(amp|apos|gt|lt|quot);")
"""How netconvert writes an apostrophe in an OSM name (``Quai d'Orsay``)."""


def _neighbours(pairs: Iterable[tuple[str, str]]) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for node, other in pairs:
        found.setdefault(node, set()).add(other)
    return found


def convert(osm: Path, target: Path, country: str, cameras: Sequence[Position] = ()) -> Built:
    """Builds ``target`` (a ``.net.xml.gz``) with netconvert and reads it back.

    The same input gives the same bytes: netconvert's header with its date and paths is removed. Speed cameras
    become parameters of their edges.

    Raises:
        ImportMapError: netconvert refuses the map, or nothing drivable remains.
        SetupError: netconvert is not installed.
    """
    raw = osm.with_suffix(".net.xml")
    ok, printed = run(
        "netconvert",
        (
            f"--osm-files={osm}",
            f"--type-files={home() / 'data' / 'typemap' / 'osmNetconvert.typ.xml'}",
            "--osm.all-attributes",
            "--osm.lane-access",
            f"--osm.extra-attributes={','.join(KEPT_TAGS)}",
            *GEOMETRY,
            *SIGNALS,
            *(["--lefthand"] if country in LEFT_HAND else []),
            f"--output-file={raw}",
        ),
    )
    if not ok and "No nodes loaded" not in printed:
        raise ImportMapError(f"netconvert cannot build a network from this map: {first_error(printed)}")
    text = raw.read_text(encoding="utf-8") if ok else ""
    if "<lane " not in text:
        raise ImportMapError(
            "no drivable road remains of this map after reducing it to cars and to its largest connected part;"
            " give a larger extract"
        )
    text = re.sub(r"<!-- generated on .*?-->\s*", "", text, count=1, flags=re.DOTALL)
    text = _ESCAPED_TWICE.sub(r"&\1;", text)
    signals, roundabouts = text.count("<tlLogic "), text.count("<roundabout ")
    _write(text, target)
    network = read_network(target)
    watched = _watched(network, cameras)
    if watched:
        _write(_with_cameras(text, watched), target)
        network = read_network(target)
    return Built(network, signals, roundabouts)


def _write(text: str, target: Path) -> None:
    target.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def _watched(network: Network, cameras: Sequence[Position]) -> dict[str, list[float]]:
    """Edges with their cameras, in metres from the start. The map does not say which way a camera faces, so it
    counts for both directions."""
    if not cameras or network.map.projection is None:
        return {}
    edges = list(network.edges.values())
    lines = [shapely.LineString(edge.shape_m) for edge in edges]
    tree, to_metres = shapely.STRtree(lines), GeoReference(network.map)
    found: dict[str, list[float]] = {}
    for camera in cameras:
        point = shapely.Point(to_metres.x_y(*camera))
        index = tree.nearest(point)
        if lines[index].distance(point) > CAMERA_WITHIN_M:
            continue
        for edge_id in {edges[index].edge_id, network.opposite.get(edges[index].edge_id, "")} - {""}:
            edge = network.edges[edge_id]
            share = shapely.LineString(edge.shape_m).project(point, normalized=True)
            found.setdefault(edge_id, []).append(round(share * edge.length_m, 1))
    return found


def _with_cameras(text: str, watched: Mapping[str, Sequence[float]]) -> str:
    for edge_id, places_m in watched.items():
        start = text.index(f"<edge id={quoteattr(edge_id)} ")
        end = text.index("</edge>", start)
        value = " ".join(f"{place_m:g}" for place_m in sorted(places_m))
        text = f'{text[:end]}    <param key="speed_camera" value="{value}"/>\n    {text[end:]}'
    return text
