"""What an import was not told clearly enough, left out or decided, in words, with the OSM numbers to look it up."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from automotive_cosim.contracts.plain import counted
from automotive_cosim.osm import access, arrows, barriers, lanes, oneway, speed_limits
from automotive_cosim.osm.extract import Extract, OsmWay
from automotive_cosim.osm.facing import facing
from automotive_cosim.osm.network import Built
from automotive_cosim.osm.roads import MappedRoad, way_of
from automotive_cosim.osm.signs import PRIORITY_ROAD, kind_of
from automotive_cosim.osm.unread import unread
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.posted_limits import clauses, names_holidays, timed_limits

SHOWN = 10
"""How many OSM numbers a line names where people read it; ``import.json`` has all."""

OF_SIGNS = re.compile(r"stop|give_way|yield|maxspeed|DE:20[56]|FR:AB[34]|US:R1-[12]|GB:60[12]")
"""Signs of right of way and limits that a node has as ``traffic_sign`` alone, in words or some lands' numbers."""

NOT_BUILT = {"traffic_calming", "priority"}
"""Keys of what stands at a road and SUMO does not have: humps, and narrow places where one direction goes first."""

_MANY = re.compile(rf"((?:-?\d+, ){{{SHOWN - 1}}}-?\d+)((?:, -?\d+)+)$")


def in_words(kind: str, numbers: Sequence[int]) -> str:
    """``"ways 1, 2, 3"``."""
    return f"{kind}{'s' * (len(numbers) > 1)} {', '.join(map(str, numbers))}"


def shortened(line: str) -> str:
    """A line with the first of many OSM numbers: ``"ways 1, 2 and 5 more"``."""
    return _MANY.sub(lambda numbers: f"{numbers[1]} and {numbers[2].count(',')} more", line)


def by_kind(lines: Iterable[str]) -> Iterator[str]:
    """One line for all that differ by their numbers and the values of tags alone."""
    kinds: dict[str, list[str]] = {}
    for line in lines:
        kinds.setdefault(re.sub(r"=[^\s,]+", "=…", line.partition(": ")[0]), []).append(line)
    for kind, alike in kinds.items():
        yield shortened(alike[0]) if len(alike) == 1 else f"{kind}: {len(alike)} forms; import.json has all"


def doubts(extract: Extract, roads: Mapping[int, MappedRoad], built: Built, country: str) -> Iterator[str]:
    """Everything about access, direction, barriers, turns, lanes and limits that somebody should look at."""
    for land, beyond in extract.other_side.items():
        about = f"where traffic keeps the other side, left out (for them instead: --country {land})"
        yield f"roads in {land}, {about}: {in_words('way', beyond)}"
    for land in sorted({road.country for road in roads.values()} - {country}):
        there = [way for way, road in roads.items() if road.country == land]
        yield f"roads in {land}, under its law: {in_words('way', there)}"
    everywhere = (*extract.ways, *extract.closed)
    for tag, ways in _by_tag((way, doubt) for way in everywhere for doubt in access.doubts(way.tags)):
        shut = {way.way_id for way in extract.closed}
        what = "closed to cars" if set(ways) <= shut else "open to cars" if not shut & set(ways) else "read by way"
        yield f"access that is doubtful, {what}: {tag}: {in_words('way', ways)}"
    for (what, kind), numbers in sorted(extract.told.items()):
        yield f"{what}: {in_words(kind, numbers)}"
    for tag, ways in _by_tag((way, doubt) for way in extract.ways for doubt in oneway.doubts(way.tags)):
        yield f"direction that is doubtful: {tag}: {in_words('way', ways)}"
    yield from _of_barriers(extract, built.cut)
    yield from _of_turns(built)
    if extract.other_classes:
        by_class = ", ".join(f"{count} {name}" for name, count in sorted(extract.other_classes.items()))
        yield f"ways of the extract that are left out for their class: {by_class}"
    for (why, kind), nodes in _of_signs(extract, built):
        yield f"{kind.replace('_', '-')} signs {why}, left out: {in_words('node', nodes)}"
    for tag, nodes in sorted(_not_built(extract, built).items()):
        yield f"{tag}: {in_words('node', nodes)}"
    for what, nodes in sorted(built.cameras.told.items()):
        yield f"speed cameras {what}: {in_words('node', nodes)}"
    for tag, ways in _by_tag(_of_arrows(extract, roads, built)):
        yield f"turn arrows not followed, the lanes lead by angle: {tag}: {in_words('way', ways)}"
    for kind in ("stop", "give_way"):
        if nodes := [ref for ref, node in sorted(extract.beside.items()) if node.tags["highway"] == kind]:
            yield f"{kind.replace('_', '-')} signs on no road for cars, left out: {in_words('node', nodes)}"
    if yielding := sorted(set(built.signs.yielding)):
        yield f"priority roads whose cars yield where netconvert decides so: {in_words('way', yielding)}"
    unread_limits = "limits under conditions that are not understood, left out: "
    per_way: tuple[tuple[str, Sequence[OsmWay], Callable[[OsmWay], Iterable[str]]], ...] = (
        ("", extract.ways, lambda way: _of_right_of_way(way.tags)),
        ("", extract.ways, lambda way: lanes.doubts(way.tags, roads[way.way_id].directions)),
        ("", extract.ways, lambda way: _of_limits(way.tags, roads[way.way_id].country)),
        (OTHER_LANES, extract.ways, lambda way: _of_lane_limits(way, roads)),
        ("tags that are not read, left out: ", extract.ways, lambda way: unread(way.tags)),
        (NO_CALENDAR, everywhere, lambda way: _of_holidays(way.tags)),
        (unread_limits, extract.ways, lambda way: _unread(way.tags)),
    )
    for about, some, doubts_of in per_way:
        for tag, ways in _by_tag((way, tag) for way in some for tag in doubts_of(way)):
            yield f"{about}{tag}: {in_words('way', ways)}"


OTHER_LANES = "limits of lanes of another number, the highest if all have one: "
NO_CALENDAR = "holidays, of which there is no calendar, taken for other days: "


def _of_limits(tags: Mapping[str, str], country: str) -> Iterator[str]:
    for doubt in speed_limits.doubts(tags, country):
        yield doubt if doubt == speed_limits.NO_UNIT else f"{doubt}, left out"


def _of_lane_limits(way: OsmWay, roads: Mapping[int, MappedRoad]) -> Iterator[str]:
    road = roads[way.way_id]
    for end, edge_id in zip(access.ENDS, ("", "-"), strict=True):
        if road.directions.open(end) and road.stated.lanes(edge_id) and not road.lane_signs(edge_id):
            key = next(key for key in (f"maxspeed:lanes:{end}", "maxspeed:lanes") if way.tags.get(key))
            yield f"{key}={way.tags[key]}"


def _of_holidays(tags: Mapping[str, str]) -> Iterator[str]:
    for key, value in tags.items():
        is_ours = key.startswith(("maxspeed", *access.KEYS, "oneway", "hov"))
        if is_ours and key.endswith(":conditional") and any(names_holidays(when) for _, when, _ in clauses(value)):
            yield f"{key}={value}"


def _unread(tags: Mapping[str, str]) -> Iterator[str]:
    """Limits that may be an ordinary car's; one for lorries (``80 @ (weight>3.5)``) says nothing about it."""
    for direction in access.ENDS:
        for part in timed_limits(speed_limits.conditional_of(tags, direction))[1]:
            if not all(access.OF_THE_VEHICLE.search(condition) for _, condition, _ in clauses(part)):
                yield part


def _of_right_of_way(tags: Mapping[str, str]) -> Iterator[str]:
    if "stop" in tags:
        yield f"stop signs on a whole way, left out: stop={tags['stop']}"
    for key, value in tags.items():
        if key.startswith("priority_road") and value not in PRIORITY_ROAD:
            yield f"priority roads, left out: {key}={value}"


def _by_tag(found: Iterable[tuple[OsmWay, str]]) -> list[tuple[str, list[int]]]:
    ways: dict[str, dict[int, None]] = {}
    for way, tag in found:
        ways.setdefault(tag, {})[way.way_id] = None
    return sorted((tag, list(numbers)) for tag, numbers in ways.items())


def _of_barriers(extract: Extract, cut: barriers.Cut) -> Iterator[str]:
    for found, about in (
        (cut.stopping, "barriers that cars cannot pass"),
        (cut.gates, "gates of which the map does not say for whom they open, passed"),
        (cut.unplaced, "barriers on a junction, of which the map does not say which road they close, passed"),
    ):
        tags: dict[str, list[int]] = {}
        for barrier in found:
            tags.setdefault(barrier.tag, []).append(barrier.node)
        for tag, nodes in sorted(tags.items()):
            yield f"{about}: {tag}: {in_words('node', nodes)}"
    further: dict[str, list[int]] = {}
    for ref, node in extract.nodes.items():
        for tag in barriers.doubts(node.tags) if "barrier" in node.tags else ():
            further.setdefault(tag, []).append(ref)
    for tag, nodes in sorted(further.items()):
        yield f"tags of barriers that are not followed: {tag}: {in_words('node', nodes)}"


def _of_turns(built: Built) -> Iterator[str]:
    for relations, about in (
        (built.turns.at_times, "turn restrictions under conditions that are not understood, left out"),
        (built.turns.over_ways, "turn restrictions over a way that is reached from elsewhere too, left out"),
        (built.turns.unread, "turn restrictions that are not understood, left out"),
    ):
        if relations:
            yield f"{about}: {in_words('relation', relations)}"


def _of_signs(extract: Extract, built: Built) -> list[tuple[tuple[str, str], list[int]]]:
    """The nodes of signs that the network does not follow, by the reason and the kind."""
    found: dict[tuple[str, str], set[int]] = {}
    for why, nodes in built.signs.left_out.items():
        for ref in nodes:
            found.setdefault((why, kind_of(extract.nodes[ref].tags)), set()).add(ref)
    return sorted((about, sorted(nodes)) for about, nodes in found.items())


def _of_arrows(extract: Extract, roads: Mapping[int, MappedRoad], built: Built) -> Iterator[tuple[OsmWay, str]]:
    """Ways whose lanes lead elsewhere at their end than the arrows there say, or end within a junction."""
    of_end: dict[tuple[int, bool], dict[str, Edge]] = {}
    for edge in built.edges:
        there = way_of(edge.edge_id), edge.edge_id.startswith("-")
        of_end.setdefault(there, {})[edge.from_node] = edge
    for way in extract.ways:
        road = roads[way.way_id]
        for number, end in enumerate(access.ENDS):
            wanted = arrows.arrows_of(way.tags, end, road.directions) if road.directions.open(end) else ()
            if not wanted or len(wanted) != road.built_lanes[number]:
                continue  # the latter is told by its number of lanes
            along = of_end.get((way.way_id, end == "backward"), {})
            last = [edge for edge in along.values() if edge.to_node not in along]
            if not last or not all(_leads_there(edge, wanted, built, roads) for edge in last):
                key = arrows.key_of(way.tags, end)
                yield way, f"{key}={way.tags[key]}"


def _leads_there(edge: Edge, wanted: arrows.LaneArrows, built: Built, roads: Mapping[int, MappedRoad]) -> bool:
    """Whether an edge at the end of a way leads where its arrows say; one without a choice does if it goes on into
    a road with arrows of its own."""
    links = built.links.of.get(edge.edge_id, ())
    onward = {link.to_edge for link in links if link.direction != "t"}
    if len(onward) == 1:
        beyond = onward.pop()
        road = roads[way_of(beyond)]
        if arrows.arrows_of(road.tags, access.ENDS[beyond.startswith("-")], road.directions):
            return True
    count = max(link.lane for link in links) + 1 if links else 0
    by_lane = [[(link.direction, link.to_edge) for link in links if link.lane == lane] for lane in range(count)]
    left_hand = roads[way_of(edge.edge_id)].left_hand
    return arrows.leads_there(wanted, by_lane if left_hand else by_lane[::-1])


def _not_built(extract: Extract, built: Built) -> dict[str, list[int]]:
    """What stands at the road and SUMO does not have: calming, and signals at no junction."""
    found: dict[str, list[int]] = {"signals at no junction with signals, left out": sorted(built.dark)}
    for ref, node in extract.nodes.items():
        for key in sorted(NOT_BUILT & node.tags.keys()):
            if node.tags[key] != "no":
                found.setdefault(f"traffic calming that SUMO does not have: {key}={node.tags[key]}", []).append(ref)
        sign = node.tags.get("traffic_sign", "")
        if OF_SIGNS.search(sign) and not kind_of(node.tags):
            found.setdefault(f"signs as traffic_sign={sign}, left out", []).append(ref)
        if node.tags.get("highway") == "traffic_signals":
            told = facing(node.tags, "traffic_signals")
            if told.unread:
                found.setdefault(f"signals with {told.unread}, for every direction", []).append(ref)
    return {tag: nodes for tag, nodes in found.items() if nodes}


def unconnected(extract: Extract, built: Built) -> Iterator[str]:
    """The roads that are not in the network, because no road leads from them to most of it."""
    there = {way_of(edge.edge_id) for edge in built.edges}
    missing = [way.way_id for way in extract.ways if way.way_id not in there]
    if missing:
        yield (
            f"{counted(len(missing), 'road')} left out, which no road for cars connects with the rest: "
            f"{in_words('way', missing)}"
        )
