"""One mapped road between the map and the network: what netconvert is told, and what its edges keep.

netconvert takes the first of several keys about speed that it meets, whichever that is (``maxspeed``,
``maxspeed:type``, ``maxspeed:forward``, ``zone:maxspeed``), and reads their zones by a table of its own. So it is
given one limit for each direction and no other key about speed; the edges get their tags afterwards.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from automotive_cosim.geo.place import Atlas, Place
from automotive_cosim.osm.assumed import assumed_sign
from automotive_cosim.osm.extract import Extract, OsmWay
from automotive_cosim.osm.limits import Stated, built_up_of, stated_limits
from automotive_cosim.osm.towns import is_dense, town_cells

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
    "maxspeed:conditional",
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

SPEED_KEYS = ("maxspeed", "source:maxspeed", "zone")
TYPE_KEYS = ("railway", "cycleway", "sidewalk", "public_transport", "route")
"""Keys that make netconvert give a road a compound type instead of its class."""

_UNTOLD = re.compile(rf"(?:{'|'.join((*SPEED_KEYS, *TYPE_KEYS))})(?::.*)?")
"""What netconvert is not told: these keys, with any suffix after a colon."""

_WAY = re.compile(r"-?(\d+)")


def way_of(edge_id: str) -> int:
    """The OSM way of an edge: netconvert adds a minus, and a suffix to its pieces.

    Raises:
        ValueError: it is not such an edge.
    """
    match = _WAY.match(edge_id)
    if match is None:
        raise ValueError(f"{edge_id!r} is not an edge made from an OSM way")
    return int(match[1])


@dataclass(frozen=True, slots=True)
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

    @property
    def name(self) -> str:
        """Its name, or its number (``"A 5"``), as on signposts; empty without either."""
        return self.tags.get("name") or self.tags.get("ref", "")

    @property
    def is_two_way(self) -> bool:
        """Whether cars drive in both directions."""
        circle = self.tags.get("junction") in ("roundabout", "circular")
        usual = "yes" if circle or self.tags["highway"].startswith("motorway") else "no"
        return self.tags.get("oneway", usual) in ("no", "false", "0")

    def limit(self, edge_id: str) -> str:
        """The limit of one of its edges, as netconvert reads it."""
        return self.stated.of(edge_id) or self.assumed

    def lanes(self, edge_id: str) -> int | None:
        """The lanes of one of its edges, those for buses included; None if its tags do not determine the number."""
        keys = ["lanes:backward" if edge_id.startswith("-") else "lanes:forward"]
        if not self.is_two_way:
            keys.append("lanes")
        return next((int(self.tags[key]) for key in keys if self.tags.get(key, "").isdecimal()), None)

    def for_netconvert(self) -> dict[str, str]:
        """The tags from which netconvert builds the road. The limit backwards is told of a two-way road only:
        netconvert would open another to both directions. A lane of both directions is left out: netconvert would
        give it to the one backwards."""
        tags = {key: value for key, value in self.tags.items() if not _UNTOLD.fullmatch(key)}
        if self.name:
            tags["name"] = self.name
        if self.is_two_way:
            each = [tags.get(f"lanes:{direction}", "") for direction in ("forward", "backward")]
            if all(map(str.isdecimal, each)):
                tags["lanes"] = str(sum(map(int, each)))
            return tags | {"maxspeed": self.limit(""), "maxspeed:backward": self.limit("-")}
        return tags | {"maxspeed": self.limit("-" if self.tags.get("oneway") == "-1" else "")}

    def parameters(self, edge_id: str) -> dict[str, str]:
        """The parameters of one of its edges: OSM's own keys, ``maxspeed`` only where a limit is stated, and what
        was assumed under keys that end in ``:assumed``."""
        kept = {key: self.tags[key] for key in KEPT_TAGS if key in self.tags}
        direction = "backward" if edge_id.startswith("-") else "forward"
        conditional = self.tags.get(f"maxspeed:{direction}:conditional")
        if conditional:
            kept["maxspeed:conditional"] = conditional
        posted = self.stated.of(edge_id)
        if posted is not None:
            kept["maxspeed"] = posted
        elif self.assumed == "none":
            kept["maxspeed:assumed"] = "none"
        if self.built_up is None:
            kept["zone:traffic:assumed"] = f"{self.country}:{'urban' if self.is_dense else 'rural'}"
        elif "zone:traffic" not in kept:
            kept["zone:traffic"] = f"{self.country}:{'urban' if self.built_up else 'rural'}"
        return dict(sorted(kept.items()))


def describe(extract: Extract, atlas: Atlas, country: str) -> dict[int, MappedRoad]:
    """The roads of a map, by OSM way.

    Args:
        extract: the map.
        atlas: the law of every place, which sets the limits that no sign does.
        country: ISO 3166-1 code of the map; a way in another country is under the law of this one all the same, so
            that a wrong position near a border changes nothing.
    """
    towns = town_cells(extract)
    roads: dict[int, MappedRoad] = {}
    for way in extract.ways:
        place = _place_of(way, extract, atlas, country)
        built_up, dense = built_up_of(way.tags), is_dense(way, extract.nodes, towns)
        in_town = dense if built_up is None else built_up
        assumed = assumed_sign(way.tags, atlas, place, built_up=in_town)
        roads[way.way_id] = MappedRoad(way.tags, country, stated_limits(way.tags), assumed, built_up, dense)
    return roads


def _place_of(way: OsmWay, extract: Extract, atlas: Atlas, country: str) -> Place:
    place = atlas.place(*extract.nodes[way.nodes[len(way.nodes) // 2]].position)
    if place.country == country:
        return place
    return Place(
        country=country, layers=tuple(layer for layer in atlas.country(country) if layer.kind == "country")
    )
