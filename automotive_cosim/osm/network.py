"""Builds a SUMO network from cleaned OSM XML, and describes it."""

from __future__ import annotations

import gzip
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from xml.sax.saxutils import quoteattr, unescape

from automotive_cosim.contracts import Tell
from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.osm.barriers import Cut, Piece, cut
from automotive_cosim.osm.cameras import Cameras, cameras_of
from automotive_cosim.osm.country import LEFT_HAND
from automotive_cosim.osm.extract import Extract
from automotive_cosim.osm.links import Links, read_links, with_stops
from automotive_cosim.osm.repair import open_traps
from automotive_cosim.osm.roads import MappedRoad, id_of, way_of
from automotive_cosim.osm.signs import STOP, Joints, MappedSigns, dark, followed, patches, read_signs
from automotive_cosim.osm.turns import Ban, BannedTurns, read_turns
from automotive_cosim.traffic.network import DERESTRICTED_MPS, SIGN, TIMED_TURN, Edge, Network, read_network
from automotive_cosim.traffic.posted_limits import sign_mps
from automotive_cosim.traffic.sumo_programs import first_error, home, run

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


@dataclass(frozen=True, slots=True)
class Built:
    """The network built from a map."""

    network: Network
    edges: tuple[Edge, ...]
    """Its edges, without those inside junctions."""
    signals: int
    roundabouts: int
    cut: Cut
    """The roads, and the barriers at which they were cut."""
    turns: BannedTurns
    """The turn restrictions, as read for cars."""
    signs: MappedSigns
    """Its stop and give-way signs."""
    cameras: Cameras
    """Its speed cameras."""
    links: Links
    """The connections of all edges."""
    opened: tuple[str, ...] = ()
    """Edges with a lane that was opened to cars, so that none is trapped beside it."""
    dark: tuple[int, ...] = ()
    """Nodes with signals that light no junction."""


def entries(edges: Sequence[Edge]) -> frozenset[str]:
    """Edges by which traffic enters a map: only their own opposite direction leads to them."""
    from_where = _neighbours((edge.to_node, edge.from_node) for edge in edges)
    return frozenset(e.edge_id for e in edges if from_where.get(e.from_node, set()) <= {e.to_node})


def exits(edges: Sequence[Edge]) -> frozenset[str]:
    """Edges by which traffic leaves a map."""
    where_to = _neighbours((edge.from_node, edge.to_node) for edge in edges)
    return frozenset(e.edge_id for e in edges if where_to.get(e.to_node, set()) <= {e.from_node})


_ESCAPED_TWICE = re.compile(r"&amp;(amp|apos|gt|lt|quot);")
"""How netconvert writes an apostrophe in an OSM name (``Quai d'Orsay``)."""


def _neighbours(pairs: Iterable[tuple[str, str]]) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for node, other in pairs:
        found.setdefault(node, set()).add(other)
    return found


def convert(
    extract: Extract,
    roads: Mapping[int, MappedRoad],
    target: Path,
    country: str,
    scratch: Path,
    tell: Tell = lambda stage, share: None,
) -> Built:
    """Builds ``target`` (a ``.net.xml.gz``) with netconvert and reads it back.

    The same input gives the same bytes: netconvert's header with its date and paths is removed. Each edge gets the
    parameters of its road (``MappedRoad.parameters``), and the positions of its speed cameras.

    Args:
        roads: its roads, by OSM way.
        country: ISO 3166-1 code, which decides the driving side.

    Raises:
        UserError: netconvert refuses the map, or nothing drivable remains.
        SetupError: netconvert is not installed.
    """
    raw = scratch / "roads.net.xml"

    def heard(line: str) -> None:
        if stage := _stage(line):
            tell(f"building the network, {stage}", None)

    barred = cut(extract)
    may = [roads[piece.way.way_id].directions for piece in barred.pieces]
    turns = read_turns(extract.restrictions, barred.pieces, may)
    turns.bans |= {Ban(*passing): 0 for passing in barred.one_way}
    joints = Joints(barred.pieces, may, extract.nodes)
    signs = read_signs(joints)
    write_osm(extract, barred, turns, roads, scratch / "roads.osm")

    def converted(more: Mapping[str, str]) -> tuple[bool, str]:
        for option, patch in more.items():
            write_whole(scratch / f"signs{option}.xml", patch)
        return run(
            "netconvert",
            (
                "--osm-files=roads.osm",
                f"--type-files={home() / 'data' / 'typemap' / 'osmNetconvert.typ.xml'}",
                "--osm.lane-access",
                "--osm.turn-lanes",
                "--verbose",
                *GEOMETRY,
                *SIGNALS,
                *(["--lefthand"] if country in LEFT_HAND else []),
                *(f"{option}=signs{option}.xml" for option in more),
                f"--output-file={raw.name}",
            ),
            folder=scratch,
            heard=heard,
        )

    patched = patches(signs, FIRST_NUMBER)
    ok, printed = converted(patched)
    if not ok and patched and _PATCH_FAILED.search(printed):
        ok, printed = converted({})
    if not ok and "No nodes loaded" not in printed:
        raise UserError(f"netconvert cannot build a network from this map: {first_error(printed)}")
    text = raw.read_text(encoding="utf-8") if ok else ""
    if "<lane " not in text:
        raise UserError(
            "no drivable road remains of this map after reducing it to cars and to its largest connected part;"
            " give a larger extract"
        )
    text = re.sub(r"<!-- generated on .*?-->\s*", "", text, count=1, flags=re.DOTALL)
    text = _ESCAPED_TWICE.sub(r"&\1;", text)
    text = _NUMBER.sub(lambda number: _id_of(barred.pieces[int(number[0]) - FIRST_NUMBER]), text)
    tell("building the network, its lanes", None)
    links, goals = read_links(text), dict(_GOAL.findall(text))
    text, opened = open_traps(text, links)
    tell("building the network, its parameters", None)
    signed = followed(signs, joints, links, goals)
    if stops := {edge_id for edge_id, kind in signed.items() if kind == STOP}:
        text, links = with_stops(text, links, stops, {goals[edge_id] for edge_id in stops})
    named = {edge_id: {SIGN: kind} for edge_id, kind in signed.items()}
    text = _with_parameters(
        text, lambda edge_id: roads[way_of(edge_id)].parameters(edge_id) | named.get(edge_id, {})
    )
    if any(road.stated.lanes_forward or road.stated.lanes_backward for road in roads.values()):
        text = _with_lane_signs(text, roads)
    signals, roundabouts = text.count("<tlLogic "), text.count("<roundabout ")
    write_whole(raw, text.encode())
    tell("reading the network", None)
    network = read_network(raw)
    cameras = cameras_of(network, extract)
    more = {edge_id: {"speed_camera": places} for edge_id, places in cameras.beside.items()}
    for (edge_id, to_edge), hours in _timed_turns(network, barred.pieces, turns).items():
        more.setdefault(edge_id, {})[f"{TIMED_TURN}{to_edge}"] = hours
    if more:
        text = _with_parameters(text, lambda edge_id: more.get(edge_id, {}))
        write_whole(raw, text.encode())
        network = read_network(raw)
    write_whole(target, gzip.compress(text.encode(), compresslevel=9, mtime=0))
    edges, unlit = tuple(network.edges.values()), tuple(dark(joints, links, goals))
    return Built(network, edges, signals, roundabouts, barred, turns, signs, cameras, links, opened, unlit)


_PATCH_FAILED = re.compile(r"Missing position|(?:from|to)-node is not given")
"""What netconvert says of a sign at an edge or a junction that it has not: without the signs, it builds the map."""


def _stage(line: str) -> str:
    """What netconvert says it does, without dots, times and warnings; empty for other lines."""
    found = re.match(r"[A-Z][a-z]+ing [\w\s-]+", line)
    words = found[0].strip() if found else ""
    return re.sub(r" (from|to|in|of|with|for)$", "", words[:1].lower() + words[1:])  # a file's name came next


FIRST_NUMBER = 7 * 10**17
"""netconvert knows the pieces of roads by numbers from here on, all equally long: it looks for the ways of a turn
restriction by the first digits of its edges' ids, so that way 12 would be way 123 too. OSM's ids are smaller, and
no other number in a network looks like these."""

_NUMBER = re.compile(r"(?<![\d.])70{9}\d{8}(?!\d)")


def _id_of(piece: Piece) -> str:
    return id_of(piece.way.way_id, piece.part)


def write_osm(
    extract: Extract, barred: Cut, turns: BannedTurns, roads: Mapping[int, MappedRoad], target: Path
) -> None:
    """Writes the roads as OSM XML for netconvert (``MappedRoad.for_netconvert``), numbered from
    ``FIRST_NUMBER``."""
    osmium = import_module("osmium")
    mutable = osmium.osm.mutable
    threads = osmium.io.ThreadPool(1)  # of its own: a process that reads a map must not be forked from shared ones
    with osmium.SimpleWriter(osmium.io.File(str(target), "osm"), overwrite=True, thread_pool=threads) as writer:
        for node_id, node in extract.nodes.items():
            writer.add_node(mutable.Node(id=node_id, location=node.position, tags=dict(node.tags)))
        for node_id, position in barred.ends.items():
            writer.add_node(mutable.Node(id=node_id, location=position))
        for number, piece in enumerate(barred.pieces, start=FIRST_NUMBER):
            tags = roads[piece.way.way_id].for_netconvert()
            writer.add_way(mutable.Way(id=number, nodes=piece.nodes, tags=tags))
        told = (("no_entry", turns.bans), ("only_straight_on", turns.only))
        bans = ((kind, ban) for kind, barred_turns in told for ban in barred_turns)
        for relation, (kind, ban) in enumerate(bans, start=1):
            members = (
                ("w", FIRST_NUMBER + ban.from_piece, "from"),
                ("n", ban.via, "via"),
                ("w", FIRST_NUMBER + ban.to_piece, "to"),
            )
            tags = {"type": "restriction", "restriction": kind}
            writer.add_relation(mutable.Relation(id=relation, members=members, tags=tags))


def _timed_turns(network: Network, pieces: Sequence[Piece], turns: BannedTurns) -> dict[tuple[str, str], str]:
    """The turns from edge to edge that cars may make at certain hours only, and when. Of several between the same
    roads, those at the node that is meant."""
    of_piece: dict[str, list[str]] = {}
    for edge_id in network.edges if turns.timed else ():
        of_piece.setdefault(edge_id.lstrip("-").partition("#")[0], []).append(edge_id)
    found: dict[tuple[str, str], str] = {}
    for ban, hours in turns.timed.items():
        froms, tos = (of_piece.get(_id_of(pieces[each]), ()) for each in (ban.from_piece, ban.to_piece))
        made = [(start, goal) for start in froms for goal in tos if goal in network.crossings.get(start, {})]
        there = [turn for turn in made if str(ban.via) in _DIGITS.findall(network.edges[turn[0]].to_node)]
        found |= dict.fromkeys(there or made, hours)
    return found


_DIGITS = re.compile(r"\d+")
"""The OSM nodes in the id of a junction; netconvert joins several into one."""


_EDGE = re.compile(r'(<edge id=("[^":][^"]*")(?: [^>]*)?[^/]>.*?)(\s*</edge>)', re.DOTALL)
"""An edge that is not inside a junction: all before its end, its quoted id, its end."""


_GOAL = re.compile(r'<edge id="([^":][^"]*)" from="[^"]*" to="([^"]*)"')
"""The id of an edge, and the junction to which it leads."""

_LANE = re.compile(r'<lane ([^>]*?)speed="[^"]*"([^>]*?)/>')
"""A lane without parameters."""


def _with_lane_signs(text: str, roads: Mapping[int, MappedRoad]) -> str:
    """The network's text with the limits of lanes that have signs of their own."""

    def signed(edge: re.Match[str]) -> str:
        road, edge_id = roads[way_of(unescape(edge[2][1:-1]))], unescape(edge[2][1:-1])
        signs = road.lane_signs(edge_id)
        if not signs:
            return edge[0]
        lanes = _LANE.findall(edge[0])
        added: list[str | None] = [None] * (len(lanes) - len(signs))
        from_kerb = iter([*signs, *added] if road.left_hand else [*added, *signs[::-1]])

        def speed(lane: re.Match[str]) -> str:
            sign = next(from_kerb)
            mps = sign_mps(sign or road.assumed) or DERESTRICTED_MPS
            told = f'><param key="maxspeed" value="{sign}"/></lane>' if sign else "/>"
            return f'<lane {lane[1]}speed="{mps:.2f}"{lane[2]}{told}'

        return _LANE.sub(speed, edge[0])

    return _EDGE.sub(signed, text)


def _with_parameters(text: str, of: Callable[[str], Mapping[str, str]]) -> str:
    """The network's text with parameters added to its edges, by their ids."""

    def extended(edge: re.Match[str]) -> str:
        params = "".join(
            f"\n        <param key={quoteattr(key)} value={quoteattr(value)}/>"
            for key, value in of(unescape(edge[2][1:-1])).items()
        )
        return f"{edge[1]}{params}{edge[3]}"

    return _EDGE.sub(extended, text)
