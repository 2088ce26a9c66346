"""One mapped road between the map and the network: what netconvert is told, and what its edges keep.

netconvert takes the first of several keys about speed that it meets, whichever that is (``maxspeed``,
``maxspeed:type``, ``maxspeed:forward``, ``zone:maxspeed``), and reads their zones by a table of its own. So it is
given one limit for each direction and no other key about speed; the edges get their tags afterwards.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from automotive_cosim.geo.place import Atlas, Place
from automotive_cosim.osm import lanes
from automotive_cosim.osm.access import ENDS
from automotive_cosim.osm.assumed import assumed_sign
from automotive_cosim.osm.country import LEFT_HAND
from automotive_cosim.osm.extract import Extract, OsmWay
from automotive_cosim.osm.oneway import Directions, at_hours, directions
from automotive_cosim.osm.speed_limits import Stated, built_up_of, conditional_of, kmh_of, stated_limits
from automotive_cosim.osm.towns import is_dense, town_cells
from automotive_cosim.traffic.network import TIMED_ACCESS

KEPT_TAGS = (
    "bicycle_road",
    "bridge",
    "covered",
    "cyclestreet",
    "dual_carriageway",
    "hazard",
    "lane_markings",
    "layer",
    "lit",
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

TOLD = re.compile(r"highway|junction|layer|bridge|tunnel|bus|psv|foot|(?:bicycle:lanes|change|width)(?::.*)?")
"""The tags that netconvert is told as they are. All others that it knows are about speed, access, direction and the
number of lanes, which are read here first, or make it give a road a compound type instead of its class."""

ONEWAY = {(True, True): "no", (True, False): "yes", (False, True): "-1"}

_WAY = re.compile(r"-?(new)?(\d+)")
"""An edge's id begins with the way's: ``100``, ``-100#1``, ``100.2`` beyond a barrier, ``new5`` for way -5."""


def way_of(edge_id: str) -> int:
    """The OSM way of an edge: netconvert adds a minus, and a suffix to its pieces.

    Raises ValueError: it is not such an edge."""
    match = _WAY.match(edge_id)
    if match is None:
        raise ValueError(f"{edge_id!r} is not an edge made from an OSM way")
    return -int(match[2]) if match[1] else int(match[2])


def id_of(way: int, part: int = 1) -> str:
    """The id of a way's edges, without what netconvert adds.

    Args:
        way: its OSM number, negative if JOSM drew it and it was not uploaded.
        part: which of the pieces into which barriers cut it.
    """
    return f"{f'new{-way}' if way < 0 else way}{f'.{part}' if part > 1 else ''}"


@dataclass(frozen=True)
class MappedRoad:
    """A way of the map, with what was read from its tags and from what surrounds it."""

    tags: Mapping[str, str]
    country: str
    """ISO 3166-1 code."""
    stated: Stated
    """The limits that its tags state."""
    assumed: str
    """The limit in a direction for which they state none, as netconvert reads it."""
    built_up: bool | None
    """Whether its tags put it in a built-up area; None if they do not say."""
    is_dense: bool
    """Whether the streets around it are as dense as in a built-up area."""
    left_hand: bool = False
    """Whether traffic keeps left."""

    @property
    def name(self) -> str:
        """Its name, or its number (``"A 5"``), as on signposts; empty without either."""
        return self.tags.get("name") or self.tags.get("ref", "")

    @cached_property
    def directions(self) -> Directions:
        """The directions open to cars."""
        return directions(self.tags)

    @property
    def is_two_way(self) -> bool:
        """Whether cars drive in both directions."""
        return self.directions.is_two_way

    def limit(self, edge_id: str) -> str:
        """The limit of one of its edges, as netconvert reads it: the highest of its lanes'."""
        signs = [self.stated.of(edge_id) or self.assumed, *self.lane_signs(edge_id)]
        return self.stated.of(edge_id) or max(filter(None, signs), key=kmh_of)

    def lane_signs(self, edge_id: str) -> tuple[str | None, ...]:
        """The limits on the signs of each lane of an edge from the left, None where the lane has none; empty if the
        lanes have none of their own, or others in number."""
        signs = self.stated.lanes(edge_id)
        return signs if signs and len(signs) == self.built_lanes[edge_id.startswith("-")] else ()

    @cached_property
    def _lanes(self) -> lanes.LaneCounts:
        return lanes.lanes_of(self.tags, self.directions, left_hand=self.left_hand)

    @cached_property
    def built_lanes(self) -> tuple[int, int]:
        """The lanes that netconvert builds with its nodes and against them."""
        return lanes.built_of(self.tags, self.directions, left_hand=self.left_hand)

    def lanes(self, edge_id: str) -> int | None:
        """The lanes of one of its edges, those for buses included; None if its tags do not determine the number."""
        return self._lanes.of(edge_id)

    def for_netconvert(self) -> dict[str, str]:
        """The tags from which netconvert builds the road. The limit backwards is told of a two-way road only:
        netconvert would open another to both directions."""
        may = self.directions
        tags = {key: value for key, value in self.tags.items() if TOLD.fullmatch(key)}
        tags |= lanes.for_netconvert(self.tags, may, left_hand=self.left_hand) | {"oneway": ONEWAY[may]}
        if self.name:
            tags["name"] = self.name
        if may.is_two_way:
            return tags | {"maxspeed": self.limit(""), "maxspeed:backward": self.limit("-")}
        return tags | {"maxspeed": self.limit("" if may.forward else "-")}

    def parameters(self, edge_id: str) -> dict[str, str]:
        """The parameters of one of its edges: OSM's own keys, ``maxspeed`` only where a limit is stated, and what
        was assumed under keys that end in ``:assumed``."""
        kept = {key: self.tags[key] for key in KEPT_TAGS if key in self.tags}
        conditional = conditional_of(self.tags, "backward" if edge_id.startswith("-") else "forward")
        if conditional:
            kept["maxspeed:conditional"] = conditional
        hours = at_hours(self.tags, ENDS[edge_id.startswith("-")])
        if hours:
            kept[TIMED_ACCESS] = hours
        posted = self.stated.of(edge_id)
        if posted is not None:
            kept["maxspeed"] = posted
        elif self.limit(edge_id) == "none":
            kept["maxspeed:assumed"] = "none"
        if self.built_up is None:
            kept["zone:traffic:assumed"] = f"{self.country}:{'urban' if self.is_dense else 'rural'}"
        elif "zone:traffic" not in kept:
            kept["zone:traffic"] = f"{self.country}:{'urban' if self.built_up else 'rural'}"
        return dict(sorted(kept.items()))


def describe(extract: Extract, atlas: Atlas, country: str) -> dict[int, MappedRoad]:
    """The roads of a map, by OSM way.

    Args:
        atlas: the law of every place, which sets the limits that no sign does.
        country: ISO 3166-1 code of the map. Each road is under the law of the land on which it lies; if none lies
            in this country, the map's positions are not trusted, and all are under its law.
    """
    towns, left = town_cells(extract), country in LEFT_HAND
    places = {way.way_id: _place_of(way, extract, atlas) for way in extract.ways}
    trusted = any(place.country == country for place in places.values())
    layers = tuple(layer for layer in atlas.country(country) if layer.kind == "country")
    roads: dict[int, MappedRoad] = {}
    for way in extract.ways:
        place = places[way.way_id]
        if not trusted or not place.country:
            place = Place(country=country, layers=layers)
        built_up, dense = built_up_of(way.tags), is_dense(way, extract.nodes, towns)
        in_town = dense if built_up is None else built_up
        assumed = assumed_sign(way.tags, atlas, place, built_up=in_town)
        roads[way.way_id] = MappedRoad(
            way.tags, place.country, stated_limits(way.tags, place.country), assumed, built_up, dense, left
        )
    return roads


def _place_of(way: OsmWay, extract: Extract, atlas: Atlas) -> Place:
    return atlas.place(*extract.nodes[way.nodes[len(way.nodes) // 2]].position)


def on_one_side(extract: Extract, atlas: Atlas, country: str) -> Extract:
    """The map without the roads of lands where traffic keeps the other side: a SUMO network keeps one.

    Args:
        country: ISO 3166-1 code of the one whose side the network keeps; if nothing lies in it, the map's positions
            are not trusted, and all is kept.
    """
    land = {ref: atlas.country_at(*node.position) for ref, node in extract.nodes.items()}
    left, lands = country in LEFT_HAND, set(land.values())
    beyond = {code for code in lands - {""} if (code in LEFT_HAND) is not left}
    if country not in lands or not beyond:
        return extract
    other_side = {
        code: tuple(way.way_id for way in extract.ways if any(land[ref] == code for ref in way.nodes))
        for code in sorted(beyond)
    }
    kept = {ref: node for ref, node in extract.nodes.items() if land[ref] not in beyond}
    return replace(extract.part(kept), other_side=other_side)
