"""First-order models of seat temperature and display contrast.

C dT/dt = heater + UA (T_cabin - T)             the seat's surface
contrast = (L_white + L_glare) / (L_black + L_glare)      the display in the light that falls on it
"""

from __future__ import annotations

import math

from automotive_cosim.cockpit.vehicle import SEAT_W

SEAT_LOSS_W_K = 3.0
"""Heat transfer to the cabin and the driver: 20 K at full power; an assumption."""
SEAT_CAPACITY_J_K = 540.0
"""Cover and heating mat of seat and back: warm within three minutes (a time constant); an assumption."""
VENTILATION_K = 4.0
"""Cooling by full ventilation of a seat at cabin temperature: an assumption."""
WHITE_CD_M2, BLACK_CD_M2 = 1000.0, 1.0
"""Luminance of a car's display at full brightness, and of its black."""
SUN_LUX = 100_000.0
"""Illuminance of direct sun and sky at full daylight."""
SHADED = 0.1
"""Share of the daylight that falls on the display under the roof: an assumption."""
REFLECTANCE = 0.01
"""Reflectance of an anti-glare cover glass, taken as diffuse."""


def seat_after(temperature_c: float, dt_s: float, cabin_c: float, level_pct: float) -> float:
    """Surface temperature of a seat after some seconds; a negative level ventilates."""
    if level_pct >= 0:
        settled_c = cabin_c + SEAT_W * level_pct / 100 / SEAT_LOSS_W_K
    else:
        settled_c = cabin_c + VENTILATION_K * level_pct / 100
    left = math.exp(-dt_s * SEAT_LOSS_W_K / SEAT_CAPACITY_J_K)
    return settled_c + (temperature_c - settled_c) * left


def display_contrast(brightness_pct: float, light_pct: float) -> float:
    """Visible contrast of the display at a share of full daylight outside."""
    glare = SUN_LUX * SHADED * light_pct / 100 * REFLECTANCE / math.pi
    white = max(BLACK_CD_M2, WHITE_CD_M2 * brightness_pct / 100)
    return (white + glare) / (BLACK_CD_M2 + glare)
