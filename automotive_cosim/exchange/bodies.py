"""What SUMO does not say of a vehicle's body: its axles, its height, its middle."""

from __future__ import annotations

from math import cos, radians, sin

from automotive_cosim.contracts import SeenVehicle

FRONT_AXLE, REAR_AXLE = 0.2, 0.8
"""Where the axles are, as shares of the length from the front bumper: our choice, as for a passenger car."""
WHEEL_M = 0.6
"""Diameter of a wheel: our choice."""
LONG_FROM_M = 5.5
"""A vehicle of this length is a van, bus or lorry, and twice as high as a car: our choice."""
GAP_S = 1.5
"""A vehicle that was not seen for longer had left the recorded surroundings."""


def heading_rad(vehicle: SeenVehicle) -> float:
    """Counter-clockwise from east."""
    return radians(90 - vehicle.heading_deg)


def height_m(vehicle: SeenVehicle) -> float:
    """A car's or a van's."""
    return 1.5 if vehicle.length_m < LONG_FROM_M else 3.0


def place_at(vehicle: SeenVehicle, share: float) -> tuple[float, float]:
    """x and y at a share of its length behind the front bumper: 0.5 is its middle, ``REAR_AXLE`` the rear axle."""
    heading, back_m = heading_rad(vehicle), share * vehicle.length_m
    return vehicle.x_m - back_m * cos(heading), vehicle.y_m - back_m * sin(heading)
