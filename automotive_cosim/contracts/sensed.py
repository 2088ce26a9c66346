"""What the car itself notices around, ahead and aboard."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class SightKind(StrEnum):
    """What can be noticed; the values are also the ends of the screen's resource ids."""

    DRIVER_BELT = "driver_belt"
    """The driver's belt is open while the car is in gear."""
    PASSENGER_BELT = "passenger_belt"
    """The belt of another seat that is taken is open while the car is in gear."""
    WITHOUT_DRIVER = "without_driver"
    """The driver has left the parked car: who or what is still aboard."""
    PHONE = "phone"
    """The driver uses a phone."""
    EYES = "eyes"
    """The driver's eyes are off the road."""
    TAILGATE = "tailgate"
    CHARGE_FLAP = "charge_flap"
    TYRE = "tyre"
    """The softest tyre, if it has too little air."""
    DRIVING_TIME = "driving_time"
    """How long the driver has been driving without a break."""
    EMERGENCY_VEHICLE = "emergency_vehicle"
    """With its blue lights on, behind."""
    VEHICLE_BEHIND = "vehicle_behind"
    """It comes up from behind."""
    VEHICLE_AHEAD = "vehicle_ahead"
    TUNNEL = "tunnel"
    LIMIT = "limit"
    """The next other limit that a sign states."""
    SCHOOL_ZONE = "school_zone"
    JAM = "jam"
    BREAKDOWN = "breakdown"
    ROADWORKS = "roadworks"
    CLOSURE = "closure"


@dataclass(frozen=True, slots=True)
class Sight:
    """One thing that the car notices: a measurement or a message, never a judgement."""

    kind: SightKind
    text: str
    """What the screen says, in English and in the driver's units."""
    distance_m: float | None = None
    """Distance along the route, bumper to bumper for vehicles; 0 inside; None for what is aboard."""
    value: float | None = None
    """Limit in km/h (None also if it is lifted), pressure in kPa, hours of driving, closing speed in m/s, and in a
    jam the metres that are left of it."""
    hours: str = ""
    """When it holds, as its sign says: ``"Mo-Fr 08:00-09:30"``; empty if at all hours."""
