"""Reads the JSON of an Overpass server (``[out:json]``), also as OSMnx caches it, plain or gzipped.

Ways name their nodes, which follow as elements of their own (``out body; >; out skel;``), or carry them along with
their positions (``out geom;``).
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.words import shown

Tags = Mapping[str, str]

LARGEST_ID = 2**63 - 1
"""OpenStreetMap's ids have 64 bits."""


def is_json(head: bytes) -> bool:
    """Whether a file that begins with these bytes is JSON, also gzipped."""
    if head.startswith(b"\x1f\x8b"):
        try:
            head = zlib.decompressobj(wbits=31).decompress(head, 64)
        except zlib.error:
            return False
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith((b"{", b"["))


COUNTS = "only counts elements (out count;); ask for them: out body; >; out skel;"
"""What is wrong with an answer without a map."""

BROKEN_OFF = re.compile(r"error|timed out|out of memory")
"""What a server's remark says if the answer before it is not whole, although it answers with success."""


def refuse_broken_off(source: Path, remark: str) -> None:
    """Refuses an answer after which a server says that it stopped. Raises UserError: it says so."""
    if BROKEN_OFF.search(remark):
        words = " ".join(remark.split())
        raise UserError(
            f"{source} is not whole: the server stopped ({words}); ask it again, for less or with a longer timeout"
        )


class OverpassJson:
    """The elements of one answer."""

    def __init__(self, source: Path) -> None:
        """Reads a file. Raises UserError: it is truncated, or not the JSON of an Overpass server."""
        try:
            # As many values as there are bytes: the process that reads it has limits.
            read = read_json(source, bounds.UNPACKED_BYTES)
        except (OSError, ValueError) as error:
            raise UserError(f"{source} is truncated or not JSON ({error}); download it again") from error
        elements = read.get("elements") if isinstance(read, dict) else None
        if not isinstance(elements, list) or not all(isinstance(element, dict) for element in elements):
            raise UserError(
                f"{source} is JSON but has no OSM elements; give the answer of an Overpass server ([out:json])"
            )
        refuse_broken_off(source, str(read.get("remark", "")))
        if elements and all(element.get("type") == "count" for element in elements):
            raise UserError(f"{source} {COUNTS}")
        self._source = source
        self._elements: list[dict[str, Any]] = elements

    def ways(self) -> Iterator[tuple[int, Tags, tuple[int, ...]]]:
        """Id, tags and nodes of each way."""
        for way in self._of("way"):
            yield self._number(way, "id"), _tags(way), tuple(self._refs(way))

    def nodes(self) -> Iterator[tuple[int, Tags, tuple[float, float]]]:
        """Id, tags, longitude and latitude of each node, those that ways carry along first."""
        for way in self._of("way"):
            for ref, place in zip(self._refs(way), self._list(way, "geometry"), strict=False):
                if isinstance(place, dict):
                    yield ref, {}, self._position(place)
        for node in self._of("node"):
            yield self._number(node, "id"), _tags(node), self._position(node)

    def relations(self) -> Iterator[tuple[int, Tags, tuple[tuple[str, int, str], ...]]]:
        """Id, tags and members of each relation."""
        for relation in self._of("relation"):
            members = [member for member in self._list(relation, "members") if isinstance(member, dict)]
            rows = tuple((str(m.get("type"))[:1], self._number(m, "ref"), str(m.get("role", ""))) for m in members)
            yield self._number(relation, "id"), _tags(relation), rows

    def _of(self, kind: str) -> Iterator[dict[str, Any]]:
        return (element for element in self._elements if element.get("type") == kind)

    def _refs(self, way: Mapping[str, Any]) -> list[int]:
        refs = way.get("nodes")
        if not isinstance(refs, list) or not all(isinstance(ref, int) and abs(ref) <= LARGEST_ID for ref in refs):
            raise UserError(
                f"{self._source} has way {shown(way.get('id'))} without its nodes; ask for them: "
                "out body; >; out skel;"
            )
        return refs

    def _number(self, element: Mapping[str, Any], key: str) -> int:
        value = element.get(key)
        if not isinstance(value, int) or abs(value) > LARGEST_ID:
            raise UserError(f"{self._source} has an element whose {key} is {shown(value)}; download it again")
        return value

    def _position(self, element: Mapping[str, Any]) -> tuple[float, float]:
        lon, lat = element.get("lon"), element.get("lat")
        if isinstance(lon, int | float) and isinstance(lat, int | float) and abs(lon) <= 180 and abs(lat) <= 90:
            return float(lon), float(lat)
        raise UserError(f"{self._source} has node {shown(element.get('id'))} without a position on earth")

    def _list(self, element: Mapping[str, Any], key: str) -> list[Any]:
        value = element.get(key) or []
        if not isinstance(value, list):
            raise UserError(f"{self._source} has an element whose {key} is {shown(value)}; download it again")
        return value


def _tags(element: Mapping[str, Any]) -> Tags:
    tags = element.get("tags")
    return {str(key): str(value) for key, value in tags.items()} if isinstance(tags, dict) else {}
