"""What the roads of a network carry at most: bounds on the flow of every edge and every turn.

A fit that meets all counts on paper may send more vehicles to a signal than its green time serves; the queue then
blocks everyone else. The bounds are those of a lane's saturation flow and, at fixed signals, of its green share.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.errors import UserError
from automotive_cosim.formats.xml import scan

LANE_PER_H = 1800.0
"""Saturation flow of a lane, vehicles per hour: SUMO's default driver keeps about two seconds."""

YIELDING_PER_H = 700.0
"""Flow of a lane that must give way, a middle value: it depends on the traffic that has priority."""

YIELDS = frozenset("mswy")
"""SUMO's states of links that give way."""

USABLE = 0.9
"""Share of a bound that a fit may use: at the bound itself, queues grow without end."""

Movement = tuple[str, str]
"""An edge and the next."""


@dataclass(frozen=True, slots=True)
class Capacity:
    """Bounds in vehicles per hour."""

    edges: Mapping[str, float]
    """What leaves an edge; edges that end at the map's border have those of their lanes."""
    turns: Mapping[Movement, float]


def read_capacity(net: Path, additional: Iterable[Path] = ()) -> Capacity:
    """Reads the bounds of a network.

    Args:
        net: the network's file.
        additional: files that may hold other signal programs, as SUMO loads them.

    Raises UserError: one is no XML."""
    lanes: dict[str, int] = {}
    links: list[dict[str, str]] = []
    programs: dict[str, list[tuple[float, str]] | None] = {}
    edge = program = ""

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal edge, program
        match tag:
            case "edge":
                edge = attributes["id"] if attributes.get("function", "normal") == "normal" else ""
                if edge:
                    lanes[edge] = 0
            case "lane" if edge:
                lanes[edge] += 1
            case "connection" if "from" in attributes:
                links.append(attributes)
            case "tlLogic":
                program = attributes["id"]
                programs[program] = [] if attributes.get("type", "static") == "static" else None
            case "phase" if (phases := programs.get(program)) is not None:
                phases.append((float(attributes.get("duration", 0)), attributes.get("state", "")))

    for path in (net, *additional):
        scan(path, start, error=UserError)
    turns: dict[Movement, float] = defaultdict(float)
    of_lane: dict[tuple[str, str], float] = defaultdict(float)
    for link in links:
        if link["from"] not in lanes or link.get("to") not in lanes:
            continue
        per_h = _of_link(link, programs)
        lane = (link["from"], link.get("fromLane", "0"))
        turns[link["from"], link["to"]] += per_h
        of_lane[lane] = max(of_lane[lane], per_h)
    edges: dict[str, float] = defaultdict(float)
    for (edge, _), per_h in of_lane.items():
        edges[edge] += per_h
    return Capacity({edge: edges.get(edge) or count * LANE_PER_H for edge, count in lanes.items()}, dict(turns))


def _of_link(link: Mapping[str, str], programs: Mapping[str, list[tuple[float, str]] | None]) -> float:
    program = programs.get(link.get("tl", ""))
    index = int(link.get("linkIndex", -1))
    if not program or index < 0:
        return YIELDING_PER_H if link.get("state", "M") in YIELDS else LANE_PER_H
    cycle_s = sum(duration_s for duration_s, _ in program)
    states = [(duration_s, state[index]) for duration_s, state in program if index < len(state)]
    first = sum(duration_s for duration_s, state in states if state == "G")
    second = sum(duration_s for duration_s, state in states if state == "g")
    return (first * LANE_PER_H + second * YIELDING_PER_H) / cycle_s if cycle_s else LANE_PER_H
