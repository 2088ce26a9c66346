"""Which traffic is meant by what stands at a road: a sign, a signal, a camera, a gate.

The words are those of the OSM wiki's pages "Key:direction", "Key:stop:direction", "Key:traffic_signals:direction"
and "Tag:highway=speed_camera": ``forward`` and ``backward`` are along the way that has the node, degrees and points
of the compass are where the front of the thing faces, which traffic that comes from there sees.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from automotive_cosim.osm.access import ENDS
from automotive_cosim.osm.area import KM_PER_DEG

POINTS = ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW")
"""Of the compass, 22.5 degrees apart."""

WORDS = {"forward": ENDS[:1], "backward": ENDS[1:], "both": ENDS}
"""What is said along a way."""

ALONG_DEG = 60.0
"""Traffic within this angle of the direction that a thing faces sees it; beyond, it is not clear whether."""


class Facing(NamedTuple):
    """What the tags of a node say about the traffic that is meant."""

    ends: tuple[str, ...] | None = None
    """Of ``access.ENDS``, along the way; None if they do not say so."""
    front_deg: float | None = None
    """Where its front faces, clockwise from north; None if they do not say."""
    unread: str = ""
    """The tag that is not understood, ``"direction=up"``."""


def facing(tags: Mapping[str, str], kind: str = "") -> Facing:
    """Reads ``KIND:direction``, else ``direction``."""
    for key in (f"{kind}:direction", "direction"):
        value = tags.get(key, "").strip()
        if not value:
            continue
        word = value.lower().replace(" ", "")
        if word in WORDS:
            return Facing(WORDS[word])
        if value.upper() in POINTS:
            return Facing(front_deg=22.5 * POINTS.index(value.upper()))
        try:
            front_deg = float(word.removesuffix("°"))
        except ValueError:
            front_deg = math.nan
        return Facing(front_deg=front_deg % 360) if math.isfinite(front_deg) else Facing(unread=f"{key}={value}")
    return Facing()


def ends_facing(front_deg: float, along_deg: float) -> tuple[str, ...]:
    """The traffic on a way that comes from where a thing faces; both directions, or none, if it faces across.

    Args:
        along_deg: where the way leads, with its nodes.
    """
    against = turned_deg(front_deg, along_deg)
    if against > 180 - ALONG_DEG:
        return ENDS[:1]
    return ENDS[1:] if against < ALONG_DEG else ENDS


def turned_deg(one_deg: float, other_deg: float) -> float:
    """The angle between two directions, up to 180."""
    return abs((one_deg - other_deg + 180) % 360 - 180)


def bearing_deg(start: Sequence[float], goal: Sequence[float]) -> float:
    """From one longitude and latitude to another near it, clockwise from north."""
    east = (goal[0] - start[0]) * math.cos(math.radians(start[1]))
    return math.degrees(math.atan2(east, goal[1] - start[1])) % 360


def away_m(start: Sequence[float], goal: Sequence[float]) -> float:
    """How far one longitude and latitude is from another near it."""
    east = (goal[0] - start[0]) * math.cos(math.radians(start[1]))
    return 1000 * KM_PER_DEG * math.hypot(east, goal[1] - start[1])
