"""The lanes of a road for netconvert, one count for each direction, and which of them are for buses.

The words are those of the OSM wiki's pages "Key:lanes", "Lanes", "Key:busway" and "Bus lanes". ``lanes`` counts
every lane of both directions, those for buses and those of buses against a one-way street included; netconvert
gives a one-way street all of them, knows no ``lanes:bus`` or ``lanes:psv``, and drops a road with ``lanes=0``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from automotive_cosim.osm import access, arrows
from automotive_cosim.osm.oneway import Directions

MOST = 10
"""More lanes in one direction are a typing error: the widest toll plazas have more, ordinary roads do not."""

USUAL = {"motorway": 2, "trunk": 2, "primary": 2}
"""Lanes in one direction of SUMO's type map, where it is not one."""

BUS_KINDS = ("psv", "bus")
SIDES = {"forward": "right", "backward": "left"}
"""The kerb side of a two-way road, seen along its nodes, where traffic keeps right."""


@dataclass(frozen=True, slots=True)
class LaneCounts:
    """The lanes of a road; None where its tags do not tell the number."""

    forward: int | None = None
    backward: int | None = None
    buses_forward: int = 0
    """How many of them, from the kerb, only count (``lanes:bus``) or name (``busway``) as the buses'."""
    buses_backward: int = 0

    def of(self, edge_id: str) -> int | None:
        """Those of an edge: netconvert marks the direction against the way's nodes by a minus."""
        return self.backward if edge_id.startswith("-") else self.forward


def lanes_of(tags: Mapping[str, str], may: Directions, *, left_hand: bool = False) -> LaneCounts:
    """The lanes that the tags of a way give to each direction in which cars may drive."""
    total, forward, backward = (_count(tags, key) for key in ("lanes", "lanes:forward", "lanes:backward"))
    both = _count(tags, "lanes:both_ways") or 0
    if may.is_two_way:
        if total is not None:
            rest = max(total - both, 1)
            if forward is not None and backward is None:
                backward = max(1, rest - forward)
            elif backward is not None and forward is None:
                forward = max(1, rest - backward)
            elif forward is None and both:
                forward, backward = max(1, (rest + 1) // 2), max(1, rest // 2)
    elif may.forward:
        forward = forward if forward is not None else _rest(total, backward, both, _against(tags, "backward"))
        backward = None
    else:
        backward = backward if backward is not None else _rest(total, forward, both, _against(tags, "forward"))
        forward = None
    counts: list[int | None] = []
    buses: list[int] = []
    for end, count, is_open in zip(access.ENDS, (forward, backward), may, strict=True):
        if count is None and total is None and is_open:
            count = len(arrows.arrows_of(tags, end, may)) or None
        taken = _for_buses(tags, end, may, left_hand=left_hand) if is_open else 0
        if taken and count is None:
            halves = total is not None and may.is_two_way
            count = max(1, (total or 0) // 2) if halves else USUAL.get(tags.get("highway", ""), 1) + taken
        counts.append(count)
        buses.append(min(taken, (count or 1) - 1))
    return LaneCounts(counts[0], counts[1], buses[0], buses[1])


def built_of(tags: Mapping[str, str], may: Directions, *, left_hand: bool = False) -> tuple[int, int]:
    """The lanes that netconvert builds with the nodes of a way and against them, where its tags do not tell all."""
    lanes, total = lanes_of(tags, may, left_hand=left_hand), _count(tags, "lanes")
    if total is not None and may.is_two_way and lanes.forward is None and lanes.backward is None:
        return (total + 1) // 2, max(1, total // 2)
    usual = USUAL.get(tags.get("highway", ""), 1)
    return lanes.forward or usual, lanes.backward or usual


def for_netconvert(tags: Mapping[str, str], may: Directions, *, left_hand: bool = False) -> dict[str, str]:
    """The tags about lanes from which netconvert builds a road."""
    lanes = lanes_of(tags, may, left_hand=left_hand)
    total = _count(tags, "lanes")
    told: dict[str, str] = {}
    if may.is_two_way and lanes.forward is not None and lanes.backward is not None:
        told |= {"lanes": str(lanes.forward + lanes.backward), "lanes:forward": str(lanes.forward)}
    elif not may.is_two_way and (count := lanes.forward or lanes.backward):
        told["lanes"] = str(count)
    elif may.is_two_way:
        told |= {"lanes": str(total)} if total is not None else {}
        told |= {
            f"lanes:{end}": str(each)
            for end, each in zip(access.ENDS, (lanes.forward, lanes.backward), strict=True)
            if each
        }
    for end, count, buses, is_open in (
        ("forward", lanes.forward, lanes.buses_forward, may.forward),
        ("backward", lanes.backward, lanes.buses_backward, may.backward),
    ):
        if is_open:
            told |= _access_of_lanes(tags, end, count, buses, is_two_way=may.is_two_way, left_hand=left_hand)
    if not any(key.startswith("turn") for key in tags):
        return told
    counts = built_of(tags, may, left_hand=left_hand)
    return told | arrows.for_netconvert(tags, may, counts, left_hand=left_hand)


def doubts(tags: Mapping[str, str], may: Directions) -> Iterator[str]:
    """The tags about lanes that are not followed, and what was done: impossible or contradictory numbers, a lane
    that both directions share, which SUMO does not know, and arrows."""
    said = {key: tags[key] for key in COUNTED if tags.get(key)}
    for key, value in said.items():
        if _count(tags, key) is None:
            yield f"{key}={value}, left out"
        elif ";" in value:
            yield f"{key}={value}, the lowest taken"
        elif key == "lanes:both_ways":
            yield f"{key}={value}, which SUMO does not have, left out"
    total, *parts = (_count(tags, key) for key in COUNTED)
    known = sum(filter(None, parts))
    unknown = sum(part is None and is_open for part, is_open in zip(parts[:2], may, strict=True))
    if total and known and (known + unknown > total or (known < total and not unknown and None not in parts[:2])):
        yield f"{', '.join(f'{key}={value}' for key, value in said.items())}, which do not add up"
    if may.is_two_way and total == 1:
        yield SHARED
    if tags.get("oneway") in ("-1", "reverse"):
        yield from (
            f"{key}={value}, taken from the left of the traffic, which drives against the way's nodes"
            for key, value in tags.items()
            if key.endswith(":lanes")
        )
    if any(key.startswith("turn") for key in tags):
        yield from (f"{arrow}, left out" for arrow in arrows.doubts(tags, may, built_of(tags, may)))


COUNTED = ("lanes", "lanes:forward", "lanes:backward", "lanes:both_ways")

SHARED = "one lane for both directions, a lane each was built"
"""The doubt about a two-way road with ``lanes=1``: each direction gets a lane."""


def _count(tags: Mapping[str, str], key: str) -> int | None:
    """A number of lanes; the lowest of several, None for what is none."""
    parts = [part.strip() for part in tags.get(key, "").split(";")]
    if not all(part.isascii() and part.isdecimal() for part in parts):
        return None
    least = min(map(int, parts))
    most = MOST if ":" in key else 2 * MOST
    return least if 0 < least <= most else None


def _rest(total: int | None, other: int | None, both: int, against: int) -> int | None:
    """The lanes of a one-way street, without those of buses against it."""
    return None if total is None else max(1, total - (other or against) - both)


def _against(tags: Mapping[str, str], end: str) -> int:
    """Lanes of buses against a one-way street."""
    counted = max((_count(tags, f"lanes:{kind}:{end}") or 0 for kind in BUS_KINDS), default=0)
    told = any(tags.get(f"oneway:{kind}") == "no" for kind in BUS_KINDS) or any(
        value in ("opposite_lane", "opposite") for key, value in tags.items() if key.startswith("busway")
    )
    return counted or int(told)


def _for_buses(tags: Mapping[str, str], end: str, may: Directions, *, left_hand: bool) -> int:
    """Lanes of one direction that are only counted as the buses', or named by ``busway``."""
    if any(f"{kind}:lanes{ending}" in tags for kind in BUS_KINDS for ending in ("", f":{end}")):
        return 0
    names = [f"lanes:{kind}:{end}" for kind in BUS_KINDS]
    if not may.is_two_way:
        names += [f"lanes:{kind}" for kind in BUS_KINDS]
    counted = max((_count(tags, name) or 0 for name in names), default=0)
    side = SIDES[end]
    if left_hand:
        side = {"left": "right", "right": "left"}[side]
    busways = {"busway", "busway:both", f"busway:{side}"} | (
        {"busway:left", "busway:right"} if not may.is_two_way else set()
    )
    return counted or int(any(tags.get(key) in ("lane", "yes") for key in busways))


def _access_of_lanes(
    tags: Mapping[str, str], end: str, count: int | None, buses: int, *, is_two_way: bool, left_hand: bool
) -> dict[str, str]:
    """Who may use each lane of a direction, in the words that netconvert reads; lanes for cars with passengers are
    not for a driver alone."""
    suffix = f":{end}" if is_two_way or end == "backward" else ""
    told: dict[str, str] = {}
    for kind in BUS_KINDS:
        value = tags.get(f"{kind}:lanes:{end}") or (
            "" if is_two_way and end == "backward" else tags.get(f"{kind}:lanes", "")
        )
        if value:
            told[f"{kind}:lanes{suffix}"] = value
    if not told and buses and count is not None:
        lanes = ["designated"] * buses + ["yes"] * (count - buses)
        told[f"bus:lanes{suffix}"] = "|".join(lanes if left_hand else reversed(lanes))
    of_all: list[str] = []
    for key in (*access.KEYS, "hov"):
        value = tags.get(f"{key}:lanes:{end}") or (
            "" if is_two_way and end == "backward" else tags.get(f"{key}:lanes", "")
        )
        if not value or (of_all and key != "hov"):
            continue
        words = [lane.strip() for lane in value.split("|")]
        if key == "hov":
            closed = ["no" if word in access.HOV_ONLY else "yes" for word in words]
            words = closed if not of_all else [min(pair) for pair in zip(of_all, closed, strict=False)]
        of_all = ["yes" if not word or access.lets_in(word) else "no" for word in words]
    if of_all:
        told[f"vehicle:lanes{suffix}"] = "|".join(of_all)
    return told
