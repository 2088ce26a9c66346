"""Turn arrows of lanes: what netconvert is told of them, and whether the lanes that it built lead where they point.

The words are those of the OSM wiki's page "Key:turn". netconvert takes the arrows only if they are as many as the
lanes, and drops them in places for reasons of its own, so that its result is compared with them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from automotive_cosim.contracts.plain import counted
from automotive_cosim.osm.access import ENDS
from automotive_cosim.osm.oneway import Directions

TURNS = {
    "reverse": 3,
    "sharp_left": 2,
    "left": 2,
    "slight_left": 1,
    "through": 0,
    "slight_right": -1,
    "right": -2,
    "sharp_right": -2,
}
"""How far each points to the left."""

BUILT = {"t": 3, "l": 2, "L": 1, "s": 0, "R": -1, "r": -2}
"""SUMO's letters for the direction of a connection, likewise."""

AHEAD = frozenset("LsR")
"""Where a road parts and none leads aside."""

MERGES = frozenset(("merge_to_left", "merge_to_right"))
NO_ARROW = frozenset(("", "none"))

KNOWN = TURNS.keys() | MERGES | NO_ARROW
"""The values of a lane."""

LaneArrows = tuple[frozenset[str], ...]
"""The arrows of each lane, from the left."""


def arrows_of(tags: Mapping[str, str], end: str, may: Directions) -> LaneArrows:
    """Those of a direction of ``access.ENDS``; empty if the tags have none, or arrows on no lane."""
    text = tags.get(f"turn:lanes:{end}", "")
    if not text and not may.is_two_way:
        text = tags.get("turn:lanes", "")
    if not text and "|" not in (turn := tags.get(f"turn:{end}", "" if may.is_two_way else tags.get("turn", ""))):
        text = turn
    lanes = tuple(frozenset(word.strip().lower() for word in lane.split(";")) for lane in text.split("|"))
    return lanes if any(lane - NO_ARROW for lane in lanes) else ()


def key_of(tags: Mapping[str, str], end: str) -> str:
    """The key from which ``arrows_of`` has them."""
    return next(
        (key for key in (f"turn:lanes:{end}", "turn:lanes", f"turn:{end}", "turn") if tags.get(key)), "turn:lanes"
    )


def for_netconvert(
    tags: Mapping[str, str], may: Directions, counts: Sequence[int], *, left_hand: bool = False
) -> dict[str, str]:
    """The arrows in the words that netconvert reads, where they are as many as the lanes. Where traffic keeps left,
    it builds the network in a mirror, but not its arrows.

    Args:
        tags: the way's.
        counts: the lanes that netconvert is told of, with the way's nodes and against them.
    """
    told: dict[str, str] = {}
    for end, count in zip(ENDS, counts, strict=True):
        lanes = arrows_of(tags, end, may) if may.open(end) else ()
        if lanes and len(lanes) == count:
            key = f"turn:lanes:{end}" if may.is_two_way or end == "backward" else "turn:lanes"
            words = [";".join(sorted(lane & (TURNS.keys() | MERGES))) for lane in lanes]
            told[key] = _MIRRORED.sub(_mirror, "|".join(words[::-1])) if left_hand else "|".join(words)
    return told


BuiltLanes = Sequence[Sequence[tuple[str, str]]]
"""The connections of each lane from the left: the letter and the edge that it leads onto."""


_MIRRORED = re.compile("left|right")


def _mirror(word: re.Match[str]) -> str:
    return "left" if word[0] == "right" else "right"


def leads_there(lanes: LaneArrows, built: BuiltLanes) -> bool:
    """Whether the lanes of an edge lead where their arrows point, and nowhere else.

    By the angles of the roads, or by their order where a road parts: what a mapper calls left and right there,
    netconvert may call straight on and slightly right.

    Args:
        built: the connections, also of lanes beyond those with arrows.
    """
    if len(built) < len(lanes):
        return False
    pairs = list(zip(lanes, built, strict=False))
    by_angle = all(_fits(arrows, [letter for letter, _ in links]) for arrows, links in pairs)
    return (by_angle and _apart(pairs)) or _in_order(pairs, built)


def _apart(pairs: Sequence[tuple[frozenset[str], Sequence[tuple[str, str]]]]) -> bool:
    """Whether no two lanes whose arrows all differ lead to the same roads."""
    said = [(arrows, {onto for _, onto in links}) for arrows, links in pairs if arrows and arrows <= TURNS.keys()]
    return not any(here == there and not one & other for (one, here), (other, there) in combinations(said, 2))


def _in_order(pairs: Sequence[tuple[frozenset[str], Sequence[tuple[str, str]]]], built: BuiltLanes) -> bool:
    """Whether each lane leads onto the roads that are as far to the left among all as its arrows."""
    if not all(arrows and arrows <= TURNS.keys() - {"reverse"} for arrows, _ in pairs):
        return False
    letter_of: dict[str, str] = {}
    for lane in built:  # of roads at the same angle, the lane farther to the left leads to the one to the left
        letter_of |= {onto: letter for letter, onto in lane if letter != "t" and onto not in letter_of}
    roads = sorted(letter_of, key=lambda onto: -BUILT[letter_of[onto]])
    wanted = sorted(frozenset[str]().union(*(arrows for arrows, _ in pairs)), key=lambda arrow: -TURNS[arrow])
    if len(wanted) != len(roads) or not AHEAD.issuperset(letter_of.values()):
        return False
    onto = dict(zip(wanted, roads, strict=True))
    return all({onto[arrow] for arrow in arrows} == {road for _, road in links} for arrows, links in pairs)


def _fits(arrows: frozenset[str], letters: Sequence[str]) -> bool:
    if not arrows - NO_ARROW:
        return True
    if arrows - KNOWN:
        return False
    wanted = {TURNS[arrow] for arrow in arrows & TURNS.keys()}
    made = {BUILT[letter] for letter in letters}
    if not wanted:
        return len(made) <= 1  # a lane that merges ends, or goes straight on into one that another leads into
    if NO_ARROW & arrows:
        return _each_near(wanted, made)
    return _each_near(wanted, made) and _each_near(made - {TURNS["reverse"]}, wanted)


def _each_near(these: set[int], those: set[int]) -> bool:
    """Whether each direction of some has one among others that is the same, or the next: what a mapper calls a
    slight turn, netconvert may call straight, by the angle."""
    return all(any(abs(here - there) <= 1 and (here == 3) is (there == 3) for there in those) for here in these)


def doubts(tags: Mapping[str, str], may: Directions, counts: Sequence[int]) -> Iterator[str]:
    """Arrows that netconvert is not told of, as their number is not that of the lanes, or which are unknown."""
    for end, count in zip(ENDS, counts, strict=True):
        lanes = arrows_of(tags, end, may) if may.open(end) else ()
        key = key_of(tags, end)
        if lanes and len(lanes) != count:
            yield f"{key}={tags[key]} on {counted(count, 'lane')}"
        elif lanes and any(lane - KNOWN for lane in lanes):
            yield f"{key}={tags[key]}"
    if (
        may.is_two_way
        and "|" in tags.get("turn:lanes", "")
        and not any(f"turn:lanes:{end}" in tags for end in ENDS)
    ):
        yield f"turn:lanes={tags['turn:lanes']} on a road of two directions"
