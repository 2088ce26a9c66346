"""Tyre pressure: the air in a tyre keeps its volume, so that absolute pressure follows absolute temperature.

(p + p_air) / T = constant                      Gay-Lussac; p is the gauge pressure on the display
tau dT/dt = T_air + warming * speed - T         first order
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

COLD_C = 20.0
"""Temperature of cold inflation pressures here."""
KELVIN = 273.15
AIR_KPA = 101.325
WARMING_K_PER_KMH = 0.25
"""Tyres are some 25 K warmer than the air at 100 km/h: an assumption in line with measurements."""
SETTLING_S = 600.0
"""Time constant: settled after half an hour of driving, as long as rolling resistance is warmed up for tests."""


@dataclass(frozen=True, slots=True)
class Tyres:
    """All four tyres, at the same temperature."""

    cold_kpa: tuple[float, ...]
    """Gauge pressures at ``COLD_C``."""
    temperature_c: float

    def after(self, dt_s: float, air_c: float, speed_kmh: float) -> Tyres:
        """The tyres some seconds later."""
        settled_c = air_c + WARMING_K_PER_KMH * speed_kmh
        left = math.exp(-dt_s / SETTLING_S)
        return Tyres(self.cold_kpa, settled_c + (self.temperature_c - settled_c) * left)

    def changed(self, tyre: int, pressure_kpa: Callable[[float], float]) -> Tyres:
        """The tyres with another cold pressure in one of them, given its present one."""
        cold = self.cold_kpa
        return replace(self, cold_kpa=(*cold[:tyre], float(pressure_kpa(cold[tyre])), *cold[tyre + 1 :]))

    @property
    def pressures_kpa(self) -> tuple[float, ...]:
        """Gauge pressures now; an empty tyre stays empty."""
        warmer = (self.temperature_c + KELVIN) / (COLD_C + KELVIN)
        return tuple(max(0.0, (cold + AIR_KPA) * warmer - AIR_KPA) if cold > 0 else 0.0 for cold in self.cold_kpa)
