"""Turns that a car may not make, from turn restrictions (OSM wiki, "Relation:restriction").

netconvert applies a restriction to every vehicle whatever its key says, takes one way of each role, and only nodes
as via. So each is read here, for cars, and told as bans of one turn each: from one road, at a node, into another.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import NamedTuple

from automotive_cosim.osm.access import ALWAYS, OF_THE_VEHICLE, timed
from automotive_cosim.osm.barriers import Piece
from automotive_cosim.osm.extract import Relation
from automotive_cosim.osm.oneway import Directions
from automotive_cosim.traffic.posted_limits import clauses, is_understood

CARS = ("motorcar", "motor_vehicle", "vehicle")
"""Kinds of vehicles that a car is one of, the most specific first."""

KINDS = frozenset(
    ("no_left_turn", "no_right_turn", "no_straight_on", "no_u_turn", "no_entry", "no_exit",
     "only_left_turn", "only_right_turn", "only_straight_on", "only_u_turn")
)  # fmt: skip

NO_BAN = frozenset(("none", "no", "no_right_turn_on_red", "no_left_turn_on_red", "no_turn_on_red", "give_way"))
"""Values that bar no turn: one on red is allowed at green."""

AT_HOURS = ("day_on", "day_off", "hour_on", "hour_off")
"""Keys of before there were conditional restrictions."""


class Ban(NamedTuple):
    """A turn that cars may not make: between pieces of roads, by index, at a node."""

    from_piece: int
    via: int
    to_piece: int


@dataclass(slots=True)
class BannedTurns:
    """What the restrictions of a map say for cars."""

    bans: dict[Ban, int] = field(default_factory=dict)
    """Each with the first relation that states it."""
    only: dict[Ban, int] = field(default_factory=dict)
    """The same, of turns beside which every other turn from that road is barred."""
    timed: dict[Ban, str] = field(default_factory=dict)
    """Turns that cars may make at certain hours only, and when (``timed_access``)."""
    at_times: list[int] = field(default_factory=list)
    """Relations under conditions that are not understood, left out."""
    unread: list[int] = field(default_factory=list)
    """Relations whose value, or whose roads, are not understood, left out."""
    over_ways: list[int] = field(default_factory=list)
    """Relations over a way that SUMO cannot apply, as other roads lead onto that way too, left out."""


def value_for_cars(tags: Mapping[str, str]) -> str:
    """What a relation says to cars: a value of ``restriction``, empty if it is not about them."""
    return _said(tags, "")


def conditional_for_cars(tags: Mapping[str, str]) -> str:
    """What it says to them under conditions: a value of ``restriction:conditional``."""
    return _said(tags, ":conditional")


def _said(tags: Mapping[str, str], ending: str) -> str:
    kind, _, whom = tags.get("type", "").partition(":")
    if kind != "restriction" or (whom and whom not in CARS):
        return ""
    if {part.strip() for part in tags.get("except", "").split(";")} & {*CARS, "car"}:
        return ""
    keys = (*(f"restriction:{car}{ending}" for car in CARS), f"restriction{ending}")
    return next((tags[key] for key in keys if tags.get(key)), "")


class _RoadGraph:
    """The pieces of roads that meet at each node, and the directions open on them."""

    def __init__(self, pieces: Sequence[Piece], may: Sequence[Directions]) -> None:
        self._pieces, self._may = pieces, may
        self._of_way: dict[int, list[int]] = {}
        self._at: dict[int, list[int]] = {}
        for index, piece in enumerate(pieces):
            self._of_way.setdefault(piece.way.way_id, []).append(index)
            for ref in set(piece.nodes):
                self._at.setdefault(ref, []).append(index)

    def pieces_of(self, way: int) -> Sequence[int]:
        return self._of_way.get(way, ())

    def at(self, way: int, node: int) -> list[int]:
        """The pieces of a way that have a node."""
        return [index for index in self.pieces_of(way) if node in self._pieces[index].nodes]

    def nodes(self, way: int) -> set[int]:
        return {ref for index in self.pieces_of(way) for ref in self._pieces[index].nodes}

    def arriving(self, node: int) -> Iterator[int]:
        """The pieces by which cars come to a node."""
        for index in self._at.get(node, ()):
            nodes, may = self._pieces[index].nodes, self._may[index]
            if (may.forward and node in nodes[1:]) or (may.backward and node in nodes[:-1]):
                yield index

    def leaving(self, node: int) -> Iterator[int]:
        """The pieces by which cars leave a node."""
        for index in self._at.get(node, ()):
            nodes, may = self._pieces[index].nodes, self._may[index]
            if (may.forward and node in nodes[:-1]) or (may.backward and node in nodes[1:]):
                yield index

    def is_clear(self, piece: int, node: int) -> bool:
        """Whether it is clear which side of a node is meant: a two-way road ends there, as the wiki asks for."""
        return node not in self._pieces[piece].nodes[1:-1] or not self._may[piece].is_two_way


def read_turns(restrictions: Iterable[Relation], pieces: Sequence[Piece], may: Sequence[Directions]) -> BannedTurns:
    """The bans for cars that the restrictions of a map state.

    Args:
        pieces: the roads, cut at barriers.
    """
    network, turns = _RoadGraph(pieces, may), BannedTurns()
    for relation in restrictions:
        if any(key in relation.tags for key in AT_HOURS):
            turns.at_times.append(relation.relation_id)
            continue
        kinds = _kinds(value_for_cars(relation.tags))
        if not set(kinds) <= KINDS:
            turns.unread.append(relation.relation_id)
            continue
        conditional = conditional_for_cars(relation.tags)
        at_hours = _at_hours(kinds, conditional) if conditional else {}
        if at_hours is None:
            turns.at_times.append(relation.relation_id)
        elif at_hours:
            for is_only, hours in at_hours.items():
                for ban, alone in _bans(relation, is_only, network, turns):
                    for each in _others([ban], network) if alone else (ban,):
                        turns.timed.setdefault(each, hours)
            continue
        if kinds:
            for ban, alone in _bans(relation, _is_only(kinds), network, turns):
                (turns.only if alone else turns.bans).setdefault(ban, relation.relation_id)
    return turns


def _kinds(value: str) -> list[str]:
    """The kinds of turns that a value of ``restriction`` bars, or allows alone."""
    values = (part.strip().lower() for part in value.split(";"))
    return [part for part in values if part and part not in NO_BAN]


def _is_only(kinds: Sequence[str]) -> bool:
    return bool(kinds) and kinds[0].startswith("only_")


def _at_hours(usual: Sequence[str], conditional: str) -> dict[bool, str] | None:
    """When turns of a relation may be made, those that it bars (False) and those beside its only ones (True); empty
    if it says nothing to ordinary cars, None if that is not understood."""
    said: list[tuple[list[str], str]] = []
    for value, condition, _ in clauses(conditional):
        kinds = _kinds(value)
        if value and OF_THE_VEHICLE.search(condition):
            continue
        if not value or not set(kinds) <= KINDS or not is_understood(condition):
            return None
        said.append((kinds, condition))
    if not said:
        return {}
    every = [(list(usual), ALWAYS)] * bool(usual) + said
    return {
        is_only: timed((not kinds or _is_only(kinds) is not is_only, condition) for kinds, condition in every)
        for is_only in {_is_only(kinds) for kinds, _ in every if kinds}
    }


def _bans(relation: Relation, is_only: bool, network: _RoadGraph, turns: BannedTurns) -> Iterator[tuple[Ban, bool]]:
    """The bans of one relation, and whether each is of a turn beside which every other one is barred; a relation
    with a member that is no road for cars bars nothing more."""
    froms, tos = (
        [ref for kind, ref, role in relation.members if (kind, role) == ("w", end)] for end in ("from", "to")
    )
    vias = [(kind, ref) for kind, ref, role in relation.members if role == "via"]
    froms = [way for way in froms if network.pieces_of(way)]
    known = [way for way in tos if network.pieces_of(way)]
    if not froms or (not known and not is_only):
        return
    if not vias and len(froms) == len(tos) == 1:
        shared = network.nodes(froms[0]) & network.nodes(tos[0])
        vias = [("n", ref) for ref in shared] if len(shared) == 1 else []
    if len(vias) == 1 and vias[0][0] == "n":
        found = [(is_only, _at_node(froms, vias[0][1], known, network))]
    elif vias and all(kind == "w" for kind, _ in vias):
        if not all(network.pieces_of(way) for _, way in vias):
            return
        over = _over_ways(froms, [way for _, way in vias], known, network)
        if over is None:
            turns.over_ways.append(relation.relation_id)
            return
        onto, off = over
        found = [(is_only, off), *([(True, onto)] if is_only else [])]
    else:
        found = []
    if not any(bans for _, bans in found):
        turns.unread.append(relation.relation_id)
    for bans_others, bans in found:
        alone = bans_others and len({ban.to_piece for ban in bans}) == 1
        yield from ((ban, alone) for ban in (_others(bans, network) if bans_others and not alone else bans))


def _at_node(froms: Sequence[int], via: int, tos: Sequence[int], network: _RoadGraph) -> list[Ban]:
    """The turns of a relation over a node."""
    starts, goals = (
        [piece for way in ways for piece in network.at(way, via) if network.is_clear(piece, via)]
        for ways in (froms, tos)
    )
    return [Ban(start, via, goal) for start, goal in product(starts, goals)]


def _others(only: Sequence[Ban], network: _RoadGraph) -> list[Ban]:
    """Every turn beside those that are the only ones allowed."""
    allowed = set(only)
    return [
        Ban(start, via, goal)
        for start, via in dict.fromkeys((ban.from_piece, ban.via) for ban in only)
        for goal in network.leaving(via)
        if Ban(start, via, goal) not in allowed
    ]


def _over_ways(
    froms: Sequence[int], vias: Sequence[int], tos: Sequence[int], network: _RoadGraph
) -> tuple[list[Ban], list[Ban]] | None:
    """The turns onto a way over which a relation leads, and off it. What it bars is the latter, if cars come onto
    that way from its ``from`` alone; None if they do not, because SUMO knows no turn over several junctions."""
    if len(vias) != 1 or len(froms) != 1:
        return None
    nodes = network.nodes(vias[0])
    first = network.nodes(froms[0]) & nodes
    last = ({ref for way in tos for ref in network.nodes(way)} & nodes) - first
    if len(first) != 1 or not last:
        return None
    (start,) = first
    own = set(network.pieces_of(vias[0]))
    others = set(network.arriving(start)) - set(network.at(froms[0], start))
    inside = {piece for ref in nodes - last - first for piece in network.arriving(ref)}
    if (others | inside) - own:
        return None
    onto = _at_node(froms, start, vias, network)
    return onto, [ban for end in sorted(last) for ban in _at_node(vias, end, tos, network)]
