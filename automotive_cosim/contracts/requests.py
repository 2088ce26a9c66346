"""The cockpit's requests to the road, and the answers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class AlertKind(StrEnum):
    """Kinds of alerts to the driver, in the order of the action space."""

    SPEED = "speed"
    DISTANCE = "distance"
    COLLISION = "collision"
    LANE = "lane"
    FATIGUE = "fatigue"
    DISTRACTION = "distraction"
    SEAT_BELT = "seat_belt"
    VISIBILITY = "visibility"
    SLIPPERY = "slippery"
    WEATHER = "weather"
    TRAFFIC = "traffic"
    CORRIDOR = "corridor"
    YIELD = "yield"
    MOVE_OVER = "move_over"
    SCHOOL = "school"
    TUNNEL = "tunnel"
    VEHICLE = "vehicle"


class Severity(StrEnum):
    """Urgency of an alert."""

    INFO = "info"
    WARNING = "warning"
    CRITICAL = "critical"


@dataclass(frozen=True, slots=True)
class Alert:
    """Tells the driver something; a driver who complies slows down or opens the gap."""

    kind: AlertKind
    severity: Severity = Severity.WARNING
    text: str = ""
    speed_kmh: float | None = None
    """The advised speed; None means the posted limit."""


@dataclass(frozen=True, slots=True)
class SlowDown:
    """Asks the driver to go no faster than this."""

    speed_kmh: float


@dataclass(frozen=True, slots=True)
class Cruise:
    """Cruise control: keep at most this speed; None switches it off."""

    speed_kmh: float | None


@dataclass(frozen=True, slots=True)
class Hazards:
    """The hazard lights, which other drivers see."""

    on: bool


@dataclass(frozen=True, slots=True)
class PullOver:
    """Asks the driver to stop at the side as soon as that is safe."""


@dataclass(frozen=True, slots=True)
class Reroute:
    """Asks for another route: to a street, edge or lon/lat, or along given edges."""

    destination: str = ""
    """Edge id, street name or ``lon,lat``; empty keeps the destination, and the route if none is quicker now."""
    edges: tuple[str, ...] = ()
    """The whole route from the current edge; empty lets the router choose."""


@dataclass(frozen=True, slots=True)
class Redraw:
    """An experimenter's, no cockpit's: the driver draws as for a request that is not made, so that later answers
    stay what they were; or, with a seed, traffic and driver have other random numbers from here on."""

    seed: int | None = None


@dataclass(frozen=True, slots=True)
class Aware:
    """No cockpit's either: how much of the driver's attention is on the road from here on."""

    awareness: float
    """0.1 to 1; 1 is all of it."""


RoadRequest = Alert | SlowDown | Cruise | Hazards | PullOver | Reroute | Redraw | Aware


@dataclass(frozen=True, slots=True)
class Answer:
    """The road's answer to a request."""

    accepted: bool
    reason: str
    """Why not, or what will happen, in words."""
