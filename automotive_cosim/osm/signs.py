"""Stop and give-way signs: the approach that each is for, and the right of way that SUMO's junctions get from it.

OSM has the sign as a node on the approach, or on the junction (wiki pages "Tag:highway=stop", "Key:stop",
"Tag:highway=give_way", "Tag:highway=mini_roundabout"); netconvert reads none of them. So each is followed along its
road to the next junction here, and netconvert gets the priority of the approach as a patch, which names the edge as
netconvert does: a way is split where it meets another or has a signal. Where cars must stop, the network is told so
afterwards: a patch of the junction's type would take its signals away.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import compress, pairwise
from typing import NamedTuple

from automotive_cosim.osm.access import ENDS
from automotive_cosim.osm.barriers import Piece
from automotive_cosim.osm.extract import Node, Position
from automotive_cosim.osm.facing import away_m, bearing_deg, ends_facing, facing
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

BAND_DEG = 0.0005
"""Bands of latitude in which signals are looked up, wider than that distance."""

PRIORITY = {STOP: 0, GIVE_WAY: -1}
"""Of an approach with a sign, below every class of roads; who stops has it over who only yields."""

MAJOR = 14
"""Of the approaches without one, where their classes differ: as high as a motorway's."""

PRIORITY_ROAD = {"yes": True, "designated": True, "yes_unposted": True, "no": False, "end": False}
"""Values of ``priority_road`` (OSM wiki, "Key:priority_road"): who joins such a road gives way."""

AT_SIGNALS = "at signals, which decide there"
AT_JOINED = "at junctions where netconvert gives right of way otherwise"
UNCLEAR = "on a junction, without the road that it is for"


class Approach(NamedTuple):
    """A piece of road, by index, which cars leave in a direction of ``ENDS``."""

    piece: int
    end: str
    suffix: str
    """What netconvert's edge has after the number of its piece: ``"#2"``."""
    node: int
    """The junction that it leads to."""


class Joints:
    """The pieces of a map as netconvert splits them: where they meet one another, and at signals."""

    def __init__(self, pieces: Sequence[Piece], may: Sequence[Directions], nodes: Mapping[int, Node]) -> None:
        """Counts how often each node is used."""
        self.pieces, self.may, self.nodes = pieces, may, nodes
        self.at: dict[int, list[tuple[int, int]]] = {}
        """The pieces that have a node, and where."""
        self.arms: Counter[int] = Counter()
        self.paths: list[list[int]] = []
        first_at: dict[Position, int] = {}
        for index, piece in enumerate(pieces):
            path: list[int] = []
            for ref in piece.nodes:  # netconvert takes nodes at one place for one, the first
                same = first_at.setdefault(nodes[ref].position, ref) if ref in nodes else ref
                if path[-1:] != [same]:
                    self.at.setdefault(same, []).append((index, len(path)))
                    path.append(same)
            self.paths.append(path)
            self.arms.update(path)
            self.arms.update(path[1:-1])

    def has_signal(self, ref: int) -> bool:
        """Whether netconvert takes a node for a signal."""
        tags = self.nodes[ref].tags if ref in self.nodes else {}
        return "traffic_signal" in tags.get("highway", "") or "traffic_signals" in tags.get("crossing", "")

    def segments(self, piece: int) -> list[tuple[int, int, str]]:
        """The edges that netconvert makes of a piece, by the first and the last of its nodes, and their suffixes;
        none of a loop, which it splits otherwise."""
        path = self.paths[piece]
        if len(set(path)) < len(path):
            return []
        inner = [at for at in range(1, len(path) - 1) if len(self.at[path[at]]) + self.has_signal(path[at]) > 1]
        bounds = [0, *inner, len(path) - 1]
        return [(*ends, f"#{number}" * bool(inner)) for number, ends in enumerate(pairwise(bounds))]

    def onward(self, piece: int, place: int, end: str) -> tuple[float, Approach] | None:
        """How far it is to the next junction for cars that drive on from a node of a piece, and their approach;
        None if there is none within ``FARTHEST_M``."""
        way_m = 0.0
        while self.may[piece].open(end) and way_m <= FARTHEST_M:
            ref, ahead = None, self.segments(piece)
            for first, last, suffix in ahead if end == "forward" else ahead[::-1]:
                goal = last if end == "forward" else first
                if (goal > place) is not (end == "forward") or goal == place:
                    continue
                path = self.paths[piece][min(place, goal) : max(place, goal) + 1]
                way_m += sum(
                    away_m(self.nodes[one].position, self.nodes[other].position)
                    for one, other in pairwise(path)
                    if one in self.nodes and other in self.nodes
                )
                place, ref = goal, self.paths[piece][goal]
                if self.arms[ref] > 2:
                    return (way_m, Approach(piece, end, suffix, ref)) if way_m <= FARTHEST_M else None
            others = [each for each in self.at[ref] if each[0] != piece] if ref is not None else []
            if len(others) != 1:
                return None
            piece, place = others[0]
            end = "forward" if place == 0 else "backward"
        return None

    def arriving(self, ref: int) -> Iterator[Approach]:
        """The approaches of a junction."""
        for piece in dict.fromkeys(piece for piece, _ in self.at.get(ref, ())):
            for first, last, suffix in self.segments(piece):
                for end, goal in zip(ENDS, (last, first), strict=True):
                    if self.paths[piece][goal] == ref and self.may[piece].open(end):
                        yield Approach(piece, end, suffix, ref)

    def edge_id(self, approach: Approach) -> str:
        """The edge of an approach in the network."""
        piece = self.pieces[approach.piece]
        return f"{'-' * (approach.end == 'backward')}{id_of(piece.way.way_id, piece.part)}{approach.suffix}"


@dataclass(slots=True)
class MappedSigns:
    """The signs of a map, and what netconvert is told of them."""

    approaches: dict[Approach, tuple[str, list[int]]] = field(default_factory=dict)
    """The kind of sign, and its nodes."""
    on_junctions: dict[int, str] = field(default_factory=dict)
    """Junctions with a sign of their own, and SUMO's type for it; empty where the minor roads stop, by class."""
    types: dict[int, str] = field(default_factory=dict)
    """Types that junctions get."""
    ruled: dict[int, bool] = field(default_factory=dict)
    """The junctions of which some approaches have signs, and whether they certainly have no signals."""
    majors: list[Approach] = field(default_factory=list)
    """The other approaches there, where their classes differ, and all of ``prior``."""
    prior: list[Approach] = field(default_factory=list)
    """Those of priority roads, where others join."""
    yielding: list[int] = field(default_factory=list)
    """Priority roads, by their ways, whose cars the network makes yield where others join."""
    left_out: dict[str, list[int]] = field(default_factory=dict)
    """Nodes of signs that are not followed, by the reason."""

    def leave_out(self, why: str, *nodes: int) -> None:
        """Notes signs that are not followed."""
        self.left_out.setdefault(why, []).extend(nodes)


def kind_of(tags: Mapping[str, str]) -> str:
    """The value of ``KINDS`` that a node has, also among others, or by its ``stop`` alone; empty without."""
    values = tags.get("highway", "").replace(" ", "").split(";")
    return next((kind for kind in KINDS if kind in values), STOP if "stop" in tags and values == [""] else "")


def read_signs(joints: Joints) -> MappedSigns:
    """The signs of a map, each with its approach."""
    signs, every = MappedSigns(), set[int]()
    for ref, node in joints.nodes.items():
        kind, stop = kind_of(node.tags), node.tags.get("stop", "")
        if not kind or ref not in joints.at:
            continue
        if joints.arms[ref] <= 2:
            found = _place(kind, ref, node.tags, joints, signs) if kind != MINI else []
            every |= {approach.node for approach in found} if stop in ALL_WAY else set()
            if kind == MINI:
                signs.leave_out("on no junction", ref)
        elif kind == MINI or (kind == STOP and stop in {*ALL_WAY, "minor"}):
            signs.on_junctions[ref] = {MINI: "left_before_right"}.get(kind, "allway_stop" * (stop != "minor"))
        else:
            signs.leave_out(UNCLEAR, ref)
    _rule(joints, signs, every)
    return signs


def _place(kind: str, ref: int, tags: Mapping[str, str], joints: Joints, signs: MappedSigns) -> list[Approach]:
    """Finds the approaches of a sign on a road; if no direction is said, it is for the nearest junction."""
    told = facing(tags, kind)
    ends: tuple[str, ...] = ENDS
    piece, place = joints.at[ref][0]
    if told.front_deg is not None:
        path = joints.paths[piece]
        behind, ahead = path[max(place - 1, 0)], path[min(place + 1, len(path) - 1)]
        ends = ends_facing(told.front_deg, bearing_deg(joints.nodes[behind].position, joints.nodes[ahead].position))
    if told.unread or (told.front_deg is not None and len(ends) > 1):
        signs.leave_out(f"with {told.unread}" if told.unread else "that face across the road", ref)
        return []
    ways = [joints.onward(*each, end) for end in told.ends or ends for each in joints.at[ref]]
    found = sorted(way for way in ways if way)
    if not told.ends and told.front_deg is None:
        found = found[:1]
    if not found:
        signs.leave_out(f"with no junction within {FARTHEST_M:.0f} m", ref)
    for _, approach in found:
        before, nodes = signs.approaches.get(approach, (kind, []))
        signs.approaches[approach] = (STOP if STOP in (kind, before) else GIVE_WAY, [*nodes, ref])
    return [approach for _, approach in found]


def has_priority(tags: Mapping[str, str], end: str) -> bool:
    """Whether a road is a priority road, in a direction of ``access.ENDS``."""
    return PRIORITY_ROAD.get(tags.get(f"priority_road:{end}") or tags.get("priority_road", ""), False)


def _prior(joints: Joints) -> Iterator[tuple[int, list[Approach]]]:
    """The junctions where roads join a priority road, and its approaches."""
    prior = [any(has_priority(piece.way.tags, end) for end in ENDS) for piece in joints.pieces]
    for ref in dict.fromkeys(ref for path in compress(joints.paths, prior) for ref in path if joints.arms[ref] > 2):
        arriving = list(joints.arriving(ref))
        first = [each for each in arriving if has_priority(joints.pieces[each.piece].way.tags, each.end)]
        if first and len(first) < len(arriving):
            yield ref, first


def _rule(joints: Joints, signs: MappedSigns, every: set[int]) -> None:
    """Says which junctions get a type, and at which the approaches get priorities."""
    signals: dict[int, list[Position]] = {}
    for ref in filter(joints.has_signal, joints.nodes):
        place = joints.nodes[ref].position
        signals.setdefault(round(place.lat_deg / BAND_DEG), []).append(place)

    def is_free(ref: int) -> bool:
        here = joints.nodes[ref].position
        band = round(here.lat_deg / BAND_DEG)
        near = (place for each in (band - 1, band, band + 1) for place in signals.get(each, ()))
        return all(away_m(here, place) > SIGNALS_WITHIN_M for place in near)

    by_junction: dict[int, set[Approach]] = {}
    for approach in signs.approaches:
        by_junction.setdefault(approach.node, set()).add(approach)
    wanted = {ref: kind for ref, kind in signs.on_junctions.items() if kind} | dict.fromkeys(every, "allway_stop")
    for ref, signed in by_junction.items():
        arriving = list(joints.arriving(ref))
        rest = [each for each in arriving if each not in signed]
        if not rest and len(arriving) > 1 and all(signs.approaches[each][0] == STOP for each in signed):
            wanted.setdefault(ref, "allway_stop")
        is_round = any(joints.pieces[each.piece].way.tags.get("junction") in ROUND for each in arriving)
        if rest and ref not in wanted and not is_round:  # who is on a roundabout has priority anyway
            signs.ruled[ref] = is_free(ref)
            if len({joints.pieces[each.piece].way.road_class for each in rest}) > 1:
                signs.majors += rest
    for ref, first in _prior(joints):
        is_round = any(joints.pieces[each.piece].way.tags.get("junction") in ROUND for each in joints.arriving(ref))
        if ref not in wanted and not is_round and not by_junction.get(ref, set()) & set(first):
            signs.ruled[ref] = is_free(ref)
            signs.majors += first
            signs.prior += first
    signs.types = {ref: kind for ref, kind in wanted.items() if ref in joints.nodes and is_free(ref)}


def patches(signs: MappedSigns, first_number: int) -> dict[str, str]:
    """What netconvert is told of the signs, by the option that takes it; empty without any."""
    if not signs.types and not signs.ruled:
        return {}
    nodes = "".join(f'<node id="{ref}" type="{kind}"/>' for ref, kind in signs.types.items())
    nodes += "".join(f'<node id="{ref}" rightOfWay="edgePriority"/>' for ref, free in signs.ruled.items() if free)
    priorities = {each: PRIORITY[kind] for each, (kind, _) in signs.approaches.items() if each.node in signs.ruled}
    edges = "".join(
        f'<edge id="{"-" * (each.end == "backward")}{first_number + each.piece}{each.suffix}" priority="{value}"/>'
        for each, value in (priorities | dict.fromkeys(signs.majors, MAJOR)).items()
    )
    return {"--node-files": f"<nodes>{nodes}</nodes>", "--edge-files": f"<edges>{edges}</edges>"}


def followed(signs: MappedSigns, joints: Joints, links: Links, goals: Mapping[str, str]) -> dict[str, str]:
    """The edges of a built network at whose end cars yield as a sign says, or are to stop, and its kind; the other
    signs are left out."""
    edges: dict[str, str] = {}
    for approach, (kind, nodes) in signs.approaches.items():
        edge = joints.edge_id(approach)
        why = _why_not(links.of.get(edge, ()), links.types.get(goals.get(edge, ""), ""))
        if why == AT_JOINED and approach.node not in signs.ruled.keys() | signs.types.keys():
            why = "where no traffic crosses or joins"
        if why:
            signs.leave_out(why, *nodes)
        else:
            edges[edge] = kind
    for ref, kind in signs.on_junctions.items():
        arriving = [] if kind else [joints.edge_id(approach) for approach in joints.arriving(ref)]
        minor = [edge for edge in arriving if {link.state for link in links.of.get(edge, ())} == {"m"}]
        edges |= dict.fromkeys(minor, STOP)
        if not minor and (not kind or links.types.get(str(ref)) != kind):
            signs.leave_out(AT_JOINED if ref in signs.types or not kind else AT_SIGNALS, ref)
    for approach in signs.prior:
        edge = joints.edge_id(approach)
        states = {link.state for link in links.of.get(edge, ()) if link.direction != "t"}
        if (
            states
            and "M" not in states
            and not links.types.get(goals.get(edge, ""), "").startswith("traffic_light")
        ):
            signs.yielding.append(joints.pieces[approach.piece].way.way_id)
    return edges


def _why_not(links: Sequence[Link], junction: str) -> str:
    """Why cars do not yield at the end of an edge; empty if they do."""
    states = {link.state for link in links if link.direction != "t"}
    if junction.startswith("traffic_light"):
        return AT_SIGNALS
    if not states:
        return "at roads that are not in the network, or within a junction"
    return "" if states <= {"s", "w"} or states == {"m"} else AT_JOINED


def dark(joints: Joints, links: Links, goals: Mapping[str, str]) -> Iterator[int]:
    """The nodes with signals that light no junction of the network, in the direction that they are for: those
    between junctions, as at crossings on foot, which netconvert discards. Those within a junction are part of it.

    Args:
        goals: the junction at the end of each of its edges.
    """
    for ref in filter(joints.has_signal, joints.at):
        ends = facing(joints.nodes[ref].tags, "traffic_signals").ends or ENDS
        ways = [joints.onward(*place, end) for place in joints.at[ref] for end in ends]
        approaches = list(joints.arriving(ref)) if joints.arms[ref] > 2 else [way[1] for way in ways if way]
        there = {goals[edge] for edge in map(joints.edge_id, approaches) if edge in goals}
        is_inside = approaches and not there
        if not is_inside and not any(links.types.get(goal, "").startswith("traffic_light") for goal in there):
            yield ref
