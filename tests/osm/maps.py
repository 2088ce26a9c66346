"""OSM files in the making."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

ORIGIN = (1.60, 48.30)
EAST_DEG = 1 / 74_000
"""Degrees of longitude a metre there; likewise north."""
NORTH_DEG = 1 / 111_200


@dataclass
class Map:
    """An OSM file in the making; positions in metres from its origin."""

    origin: tuple[float, float] = ORIGIN
    nodes: dict[str, tuple[float, float]] = field(default_factory=dict)
    node_tags: dict[str, Mapping[str, str]] = field(default_factory=dict)
    ways: list[tuple[Sequence[str], Mapping[str, str]]] = field(default_factory=list)
    relations: list[tuple[Sequence[tuple[str, str]], Mapping[str, str]]] = field(default_factory=list)
    """Members by role and name of a node, or number of a way; tags."""

    def way(self, nodes: str, **tags: str) -> None:
        """A road along named nodes; ``__`` in a key stands for ``:``."""
        self.ways.append((nodes.split(), {key.replace("__", ":"): value for key, value in tags.items()}))

    def area(self, name: str, x: float, y: float, side: float, **tags: str) -> None:
        """A square, by its lower left corner."""
        corners = ((x, y), (x + side, y), (x + side, y + side), (x, y + side))
        self.nodes |= {f"{name}{number}": corner for number, corner in enumerate(corners)}
        self.way(" ".join(f"{name}{number}" for number in (0, 1, 2, 3, 0)), **tags)

    def xml(self) -> str:
        numbers = {name: index for index, name in enumerate(self.nodes, start=1)}
        lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6">']
        for name, (x, y) in self.nodes.items():
            lon, lat = self.origin[0] + x * EAST_DEG, self.origin[1] + y * NORTH_DEG
            tags = _tags(self.node_tags.get(name, {}))
            lines.append(f'<node id="{numbers[name]}" version="1" lat="{lat:.7f}" lon="{lon:.7f}">{tags}</node>')
        for number, (nodes, tags) in enumerate(self.ways, start=100):
            refs = "".join(f'<nd ref="{numbers[node]}"/>' for node in nodes)
            lines.append(f'<way id="{number}" version="1">{refs}{_tags(tags)}</way>')
        for number, (members, tags) in enumerate(self.relations, start=1):
            rows = "".join(
                f'<member type="node" ref="{numbers[ref]}" role="{role}"/>'
                if ref in numbers
                else f'<member type="way" ref="{ref}" role="{role}"/>'
                for role, ref in members
            )
            lines.append(f'<relation id="{number}" version="1">{rows}{_tags(tags)}</relation>')
        return "\n".join([*lines, "</osm>", ""])


def _tags(tags: Mapping[str, str]) -> str:
    return "".join(f"<tag k={quoteattr(key)} v={quoteattr(value)}/>" for key, value in tags.items())
