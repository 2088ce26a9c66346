"""Stop and give-way signs: the approach that each is for, and the right of way that SUMO's junctions get from it.

OSM has the sign as a node on the approach, or on the junction (wiki pages "Tag:highway=stop", "Key:stop",
"Tag:highway=give_way", "Tag:highway=mini_roundabout"); netconvert reads none of them. So each is followed along its
road to the next junction here, and netconvert gets the priority of the approach as a patch, which names the edge as
netconvert does: a way is split where it meets another or has a signal. Where cars must stop, the network is told so
afterwards: a patch of the junction's type would take its signals away.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from automotive_cosim.osm.access import ENDS
from automotive_cosim.osm.area import KM_PER_DEG
from automotive_cosim.osm.barriers import Piece
from automotive_cosim.osm.extract import Node
from automotive_cosim.osm.facing import bearing_deg, ends_facing, facing
from automotive_cosim.osm.links import Link, Links
from automotive_cosim.osm.oneway import ROUND, Directions
from automotive_cosim.osm.roads import id_of

STOP, GIVE_WAY, MINI = "stop", "give_way", "mini_roundabout"
KINDS = (STOP, GIVE_WAY, MINI)
"""Values of ``highway`` on a node."""

ALL_WAY = frozenset(("all", "all_way", "4way", "4-way", "3way"))
"""Values of ``stop`` where every approach stops."""

FARTHEST_M = 100.0
"""A sign farther before a junction is for something else: a crossing, a railway, a gate."""

SIGNALS_WITHIN_M = 40.0
"""Signals this near to a junction may be its own: they decide, and a patch of its type would take them away."""

PRIORITY = {STOP: 0, GIVE_WAY: -1}
"""Of an approach with a sign, below every class of roads; who stops has it over who only yields."""

MAJOR = 14
"""Of the approaches without one, where their classes differ: as high as a motorway's."""


class Approach(NamedTuple):
    """Where a sign stands: a piece of road, by index, which cars leave in a direction of ``ENDS``."""

    piece: int
    end: str
    edge: str
    """The edge, as netconvert names it, without the number of its piece: ``"#2"``."""
    node: int
    """The junction that it leads to."""


@dataclass(slots=True)
class Signs:
    """The signs of a map, and what netconvert is told of them."""

    approaches: dict[Approach, tuple[str, list[int]]] = field(default_factory=dict)
    """The kind of sign, and its nodes."""
    types: dict[int, str] = field(default_factory=dict)
    """SUMO's type of a junction, by OSM node."""
    ruled: dict[int, bool] = field(default_factory=dict)
    """The junctions at which some approaches have signs and others do not, and whether they certainly have no
    signals."""
    majors: list[Approach] = field(default_factory=list)
    """Those others, where their classes differ."""
    by_class: dict[int, list[Approach]] = field(default_factory=dict)
    """The approaches of junctions at which the minor roads stop; which they are, the classes say."""
    minis: list[int] = field(default_factory=list)
    unplaced: dict[str, list[int]] = field(default_factory=dict)
    """Nodes of signs, by the reason for which they are for no approach."""

    def leave_out(self, why: str, node: int) -> None:
        """Notes a sign that is not followed."""
        self.unplaced.setdefault(why, []).append(node)


class Segment(NamedTuple):
    """A part of a piece that netconvert makes an edge of, by the first and the last index of its nodes."""

    first: int
    last: int
    suffix: str
    """What the edge's id has after the number of the piece."""


class Joints:
    """The pieces of a map as netconvert splits them: where they meet one another, and at signals."""

    def __init__(self, pieces: Sequence[Piece], may: Sequence[Directions], nodes: Mapping[int, Node]) -> None:
        """Counts how often each node is used.

        Args:
            pieces: the roads, cut at barriers.
            may: the directions open on each.
            nodes: the map's.
        """
        self.pieces, self.may, self.nodes = pieces, may, nodes
        self._first_at: dict[tuple[float, float], int] = {}
        self.at: dict[int, list[tuple[int, int]]] = {}
        """The pieces that have a node, and where."""
        self.arms: Counter[int] = Counter()
        self.paths = [self._path(piece.nodes) for piece in pieces]
        for index, path in enumerate(self.paths):
            for place, ref in enumerate(path):
                self.at.setdefault(ref, []).append((index, place))
            self.arms.update(path)
            self.arms.update(path[1:-1])

    def _path(self, refs: Sequence[int]) -> list[int]:
        """The nodes of a piece; netconvert takes nodes at one place for one, the first."""
        path: list[int] = []
        for ref in refs:
            node = self.nodes.get(ref)
            same = ref if node is None else self._first_at.setdefault((node.position[0], node.position[1]), ref)
            if not path or path[-1] != same:
                path.append(same)
        return path

    def has_signal(self, ref: int) -> bool:
        """Whether netconvert takes a node for a signal."""
        tags = self.nodes[ref].tags if ref in self.nodes else {}
        return "traffic_signal" in tags.get("highway", "") or "traffic_signals" in tags.get("crossing", "")

    def segments(self, piece: int) -> list[Segment]:
        """The edges that netconvert makes of a piece."""
        path = self.paths[piece]
        inner = [at for at in range(1, len(path) - 1) if len(self.at[path[at]]) + self.has_signal(path[at]) > 1]
        found: list[Segment] = []
        bounds = [0, *inner, len(path) - 1]
        number = 0 if inner else -1
        for first, last in pairwise(bounds):
            number = self._split(path, first, last, number, found)
        return found

    def _split(self, path: Sequence[int], first: int, last: int, number: int, found: list[Segment]) -> int:
        if path[first] == path[last]:
            middle = first + (last - first + 1) // 2
            if last - first < 2:
                return max(number, 0)
            number = self._split(path, first, middle, max(number, 0), found)
            return self._split(path, middle, last, number, found)
        found.append(Segment(first, last, f"#{number}" if number >= 0 else ""))
        return max(number, 0) + 1

    def length_m(self, piece: int, first: int, last: int) -> float:
        """Along a piece, between two of its nodes."""
        path = self.paths[piece][min(first, last) : max(first, last) + 1]
        places = [self.nodes[ref].position for ref in path if ref in self.nodes]
        return sum(
            1000 * KM_PER_DEG * math.hypot((b[0] - a[0]) * math.cos(math.radians(a[1])), b[1] - a[1])
            for a, b in pairwise(places)
        )

    def onward(self, piece: int, place: int, end: str) -> tuple[Approach, float] | None:
        """The approach by which cars that drive on from a node of a piece come to the next junction, and how far it
        is; None if they come to none."""
        way_m = 0.0
        for _ in range(len(self.pieces)):
            if not self.may[piece].open(end):
                return None
            segments = self.segments(piece)
            if end == "forward":
                ahead = [each for each in segments if each.last > place]
            else:
                ahead = [each for each in reversed(segments) if each.first < place]
            for each in ahead:
                goal = each.last if end == "forward" else each.first
                way_m += self.length_m(piece, place, goal)
                place, ref = goal, self.paths[piece][goal]
                if self.arms[ref] > 2:
                    return Approach(piece, end, each.suffix, ref), way_m
            others = [each for each in self.at[ref] if each[0] != piece] if ahead else []
            if len(others) != 1 or way_m > FARTHEST_M:
                return None
            piece, place = others[0]
            end = "forward" if place == 0 else "backward"
        return None

    def edge_id(self, approach: Approach) -> str:
        """The edge of an approach in the network."""
        piece = self.pieces[approach.piece]
        return f"{'-' * (approach.end == 'backward')}{id_of(piece.way.way_id, piece.part)}{approach.edge}"

    def arriving(self, ref: int) -> Iterator[Approach]:
        """The approaches of a junction."""
        for piece in dict.fromkeys(piece for piece, _ in self.at.get(ref, ())):
            path = self.paths[piece]
            for each in self.segments(piece):
                for end, goal in (("forward", each.last), ("backward", each.first)):
                    if path[goal] == ref and self.may[piece].open(end):
                        yield Approach(piece, end, each.suffix, ref)


def read_signs(joints: Joints) -> Signs:
    """The signs of a map, each with its approach."""
    signs = Signs()
    signals = [node.position for ref, node in joints.nodes.items() if joints.has_signal(ref)]
    every: set[int] = set()
    for ref, node in joints.nodes.items():
        kind = node.tags.get("highway", "")
        if kind not in KINDS or ref not in joints.at:
            continue
        if kind == MINI:
            (signs.minis.append(ref) if joints.arms[ref] > 2 else signs.leave_out("on no junction", ref))
        elif joints.arms[ref] > 2:
            if kind == STOP and node.tags.get("stop", "") in ALL_WAY:
                every.add(ref)
            elif kind == STOP and node.tags.get("stop") == "minor":
                signs.by_class[ref] = list(joints.arriving(ref))
            else:
                signs.leave_out("on a junction, without the road that it is for", ref)
        else:
            _place(kind, ref, node.tags, joints, signs)
            found = next((each for each, sign in signs.approaches.items() if ref in sign[1]), None)
            if found and node.tags.get("stop", "") in ALL_WAY:
                every.add(found.node)
    _rule(joints, signs, every, signals)
    return signs


def _place(kind: str, ref: int, tags: Mapping[str, str], joints: Joints, signs: Signs) -> None:
    """Finds the approaches of a sign on a road; if no direction is said, it is for the nearest junction."""
    here = joints.at[ref]
    piece, place = here[0]
    path = joints.paths[piece]
    told = facing(tags, kind)
    if told.unread:
        signs.leave_out(f"with {told.unread}", ref)
        return
    if told.front_deg is not None:
        ahead, behind = (path[min(place + 1, len(path) - 1)], path[max(place - 1, 0)])
        along = bearing_deg(joints.nodes[behind].position, joints.nodes[ahead].position)
        ends = ends_facing(told.front_deg, along)
        if len(ends) > 1:
            signs.leave_out("that face across the road", ref)
            return
    else:
        ends = told.ends or ENDS
    found: list[tuple[float, Approach]] = []
    for end in ends:
        starts = [
            each for each in here if (each[1] < len(joints.paths[each[0]]) - 1 if end == "forward" else each[1])
        ]
        ways = [joints.onward(*each, end) for each in (starts or here)]
        found += [(way[1], way[0]) for way in ways if way and way[1] <= FARTHEST_M]
    if told.ends is None and told.front_deg is None:
        found = sorted(found)[:1]
    if not found:
        signs.leave_out(f"with no junction within {FARTHEST_M:.0f} m", ref)
    for _, approach in found:
        before, nodes = signs.approaches.get(approach, (kind, []))
        signs.approaches[approach] = (STOP if STOP in (kind, before) else GIVE_WAY, [*nodes, ref])


def _rule(joints: Joints, signs: Signs, every: set[int], signals: Sequence[tuple[float, float]]) -> None:
    """Gives the junctions their types."""
    by_junction: dict[int, dict[Approach, str]] = {}
    for approach, (kind, _) in signs.approaches.items():
        by_junction.setdefault(approach.node, {})[approach] = kind
    for ref in every:
        by_junction.setdefault(ref, {})
    for ref in signs.minis:
        if not _near(joints.nodes[ref].position, signals):
            signs.types[ref] = "left_before_right"
    for ref, signed in by_junction.items():
        arriving = list(joints.arriving(ref))
        near = ref not in joints.nodes or _near(joints.nodes[ref].position, signals)
        rest = [each for each in arriving if each not in signed]
        if ref in every or (set(signed.values()) == {STOP} and not rest and len(arriving) > 1):
            signs.types |= {} if near else {ref: "allway_stop"}
        elif any(joints.pieces[each.piece].way.tags.get("junction") in ROUND for each in arriving):
            continue  # who is on a roundabout has priority anyway
        elif rest:
            signs.ruled[ref] = not near
            if len({joints.pieces[each.piece].way.road_class for each in rest}) > 1:
                signs.majors += rest


def _near(place: Sequence[float], signals: Iterable[tuple[float, float]]) -> bool:
    most_deg = SIGNALS_WITHIN_M / 1000 / KM_PER_DEG
    wide = math.cos(math.radians(place[1]))
    return any(
        abs(lat - place[1]) < most_deg and math.hypot((lon - place[0]) * wide, lat - place[1]) < most_deg
        for lon, lat in signals
    )


def patches(signs: Signs, first_number: int) -> dict[str, str]:
    """What netconvert is told of the signs, by the option that takes it; empty without any.

    Args:
        signs: the signs.
        first_number: of the pieces.
    """
    if not signs.types and not signs.ruled:
        return {}
    nodes = "".join(f'<node id="{ref}" type="{kind}"/>' for ref, kind in signs.types.items())
    nodes += "".join(f'<node id="{ref}" rightOfWay="edgePriority"/>' for ref, free in signs.ruled.items() if free)
    priorities = {each: PRIORITY[kind] for each, (kind, _) in signs.approaches.items() if each.node in signs.ruled}
    priorities |= dict.fromkeys(signs.majors, MAJOR)
    edges = "".join(
        f'<edge id="{"-" * (each.end == "backward")}{first_number + each.piece}{each.edge}" priority="{value}"/>'
        for each, value in priorities.items()
    )
    return {"--node-files": f"<nodes>{nodes}</nodes>", "--edge-files": f"<edges>{edges}</edges>"}


class Followed(NamedTuple):
    """What became of the signs in a built network."""

    edges: dict[str, str]
    """The edges at whose end cars give way as a sign says, or are to stop, and its kind."""
    left_out: dict[str, list[int]]
    """Nodes of the others, by the reason."""


def compare(signs: Signs, joints: Joints, links: Links, goals: Mapping[str, str]) -> Followed:
    """Compares a built network with the signs.

    Args:
        signs: those of the map.
        joints: its roads.
        links: the network's connections.
        goals: the junction at the end of each of its edges.
    """
    edges: dict[str, str] = {}
    left_out = {why: list(nodes) for why, nodes in signs.unplaced.items()}

    for approach, (kind, nodes) in signs.approaches.items():
        edge = joints.edge_id(approach)
        alone = approach.node not in signs.ruled and approach.node not in signs.types
        why = _why_not(kind, links.of.get(edge, ()), links.types.get(goals.get(edge, ""), ""), alone=alone)
        if why:
            left_out.setdefault(why, []).extend(nodes)
        else:
            edges[edge] = kind
    for ref, approaches in signs.by_class.items():
        arriving = [joints.edge_id(approach) for approach in approaches]
        minor = [edge for edge in arriving if {link.state for link in links.of.get(edge, ())} == {"m"}]
        edges |= dict.fromkeys(minor, STOP)
        if not minor:
            left_out.setdefault(AT_JOINED, []).append(ref)
    for ref in signs.minis:
        wanted = signs.types.get(ref)
        if not wanted or links.types.get(str(ref)) != wanted:
            left_out.setdefault(AT_JOINED if wanted else AT_SIGNALS, []).append(ref)
    return Followed(edges, left_out)


AT_SIGNALS = "at signals, which decide there"
AT_JOINED = "at junctions where netconvert gives right of way otherwise"
NO_CHOICE = "where no traffic crosses or joins"


def _why_not(kind: str, links: Sequence[Link], junction: str, *, alone: bool) -> str:
    """Why a network does not do what a sign says; empty if it does."""
    states = {link.state for link in links if link.direction != "t"}
    if junction.startswith("traffic_light"):
        return AT_SIGNALS
    if not states:
        return "at roads that are not in the network, or within a junction"
    if states <= {"s", "w"} or states == {"m"}:
        return ""
    return NO_CHOICE if alone and states == {"M"} else AT_JOINED


def doubts(found: Followed, kinds: Mapping[int, str]) -> Iterator[tuple[str, str, list[int]]]:
    """The signs that the network does not follow: the reason, the kind, and the nodes."""
    for why, nodes in sorted(found.left_out.items()):
        for kind in KINDS:
            of_kind = sorted({ref for ref in nodes if kinds[ref] == kind})
            if of_kind:
                yield why, kind, of_kind


def dark(joints: Joints, links: Links, goals: Mapping[str, str]) -> list[int]:
    """The nodes with signals that light no junction of the network, in the direction that they are for: those
    between junctions, as at crossings on foot, which netconvert discards. Those within a junction are part of it.

    Args:
        joints: the roads.
        links: the network's connections.
        goals: the junction at the end of each of its edges.
    """
    found: list[int] = []
    for ref in filter(joints.has_signal, joints.at):
        ends = facing(joints.nodes[ref].tags, "traffic_signals").ends or ENDS
        ways = [joints.onward(*place, end) for place in joints.at[ref] for end in ends]
        approaches = [*joints.arriving(ref)] if joints.arms[ref] > 2 else [way[0] for way in ways if way]
        there = {goals[edge] for edge in map(joints.edge_id, approaches) if edge in goals}
        inside = approaches and not there
        if not inside and not any(links.types.get(goal, "").startswith("traffic_light") for goal in there):
            found.append(ref)
    return found
