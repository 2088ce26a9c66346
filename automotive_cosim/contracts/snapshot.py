"""The road as a picture shows it: what does not move, and everything that does at one instant."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntFlag

from automotive_cosim.contracts.roads import GroundArea


class SumoSignal(IntFlag):
    """SUMO's bits for what a vehicle shows; others are ignored."""

    RIGHT = 1
    LEFT = 2
    HAZARD = 4
    BRAKE = 8
    BLUE = 2048
    """The blue lights of an emergency vehicle."""


@dataclass(frozen=True, slots=True)
class LaneShape:
    """One lane outside junctions, a band along its centre line."""

    lane_id: str
    kind: str
    """``road``, or ``bus``, ``bicycle``, ``foot`` or ``rail`` if no car may use it."""
    width_m: float
    line_m: tuple[tuple[float, float], ...]
    """Centre line in driving direction, network coordinates (x, y)."""
    links: tuple[tuple[str, int], ...] = ()
    """Traffic lights at its end: the signal program, and the place of the link's letter in the program's state."""


@dataclass(frozen=True, slots=True)
class RoadShapes:
    """All that a picture of the road shows and that does not move."""

    lanes: tuple[LaneShape, ...]
    junctions: tuple[tuple[tuple[float, float], ...], ...]
    """Outlines, network coordinates."""
    ground: tuple[GroundArea, ...] = ()
    """Water, green and buildings around the roads."""
    crossings: tuple[LaneShape, ...] = ()
    """Where people cross, each along their way; empty in a recording."""


@dataclass(frozen=True, slots=True)
class SeenVehicle:
    """One vehicle, where and how SUMO has it."""

    vehicle_id: str
    kind: str
    """SUMO's vehicle class: ``passenger``, ``bus``, ``truck``, ``bicycle``, ``emergency``, ..."""
    length_m: float
    width_m: float
    x_m: float
    y_m: float
    """Middle of the front bumper, network coordinates."""
    heading_deg: float
    """Clockwise from north."""
    speed_mps: float
    signals: int
    """Bits of ``SumoSignal``."""


@dataclass(frozen=True, slots=True)
class RoadSnapshot:
    """Every vehicle around the ego, itself included, at one instant. Empty once its drive has ended."""

    time_s: float
    """SUMO simulation time."""
    vehicles: tuple[SeenVehicle, ...]
    lights: tuple[tuple[str, str], ...]
    """The state of each signal program, with one of SUMO's letters per link: ``G g y Y r R u s o O``."""
    people: tuple[SeenVehicle, ...] = ()
    """Who walks."""
    closed: tuple[str, ...] = ()
    """Lanes that roadworks and closures keep cars out of."""
