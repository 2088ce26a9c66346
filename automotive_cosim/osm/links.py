"""The connections of a built network, as text: which lane leads where, and with what right of way."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence, Set
from typing import NamedTuple

_CONNECTION = re.compile(
    r'<connection from="([^"]*)" to="([^"]*)" fromLane="(\d+)" toLane="(\d+)"(?:[^>]*? via="([^"]*)")?[^>]*?'
    r' dir="(.)" state="(.)"'
)
_JUNCTION = re.compile(r'<junction id="([^":][^"]*)" type="([^"]*)"')


class Link(NamedTuple):
    """A connection from a lane onto another."""

    lane: int
    """From the kerb."""
    to_edge: str
    to_lane: int
    via: str
    """The lane through the junction; empty without one."""
    direction: str
    """SUMO's letter: ``s`` straight, ``l`` left, ``L`` slightly left, ``t`` back, ..."""
    state: str
    """SUMO's letter for its right of way: ``M`` has it, ``m`` yields, ``s`` stops, ``w`` at an all-way stop."""


class Links(NamedTuple):
    """Those of all edges, also inside junctions, and the types of the junctions."""

    of: Mapping[str, Sequence[Link]]
    types: Mapping[str, str]


def read_links(text: str) -> Links:
    """Reads a network's text."""
    found: dict[str, list[Link]] = {}
    for from_edge, to_edge, lane, to_lane, via, direction, state in _CONNECTION.findall(text):
        link = Link(int(lane), to_edge, int(to_lane), via, direction, state)
        found.setdefault(from_edge, []).append(link)
    return Links(found, dict(_JUNCTION.findall(text)))


def with_stops(text: str, links: Links, edges: Set[str], junctions: Set[str]) -> tuple[str, Links]:
    """A network's text and connections with cars that stop before they yield."""

    def stopping(link: re.Match[str]) -> str:
        return f'{link[0][:-2]}s"' if link[1] in edges and link[7] == "m" else link[0]

    def typed(junction: re.Match[str]) -> str:
        is_stop = junction[1] in junctions and junction[2] == "priority"
        return f'<junction id="{junction[1]}" type="priority_stop"' if is_stop else junction[0]

    stopped = {
        edge: [link._replace(state="s") if link.state == "m" else link for link in links.of.get(edge, ())]
        for edge in edges
    }
    types = {ref: "priority_stop" for ref in junctions if links.types.get(ref) == "priority"}
    text = _JUNCTION.sub(typed, _CONNECTION.sub(stopping, text))
    return text, Links({**links.of, **stopped}, {**links.types, **types})
