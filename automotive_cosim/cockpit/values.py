"""Values in words, in the units of the display."""

from __future__ import annotations

from automotive_cosim.cockpit.signals import HMI, Signals
from automotive_cosim.contracts.text import Quantity

MILE_KM, PSI_KPA = 1.609344, 6.894757


def temperature(signals: Signals, celsius: float, digits: int = 1) -> str:
    """A value in the unit of the display."""
    if signals[HMI.TEMPERATURE_UNIT] == "F":
        return f"{celsius * 1.8 + 32:.0f} °F"
    return Quantity(f"{celsius:.{digits}f} °C".replace("-0 ", "0 ").replace("-0.0", "0.0"))


def speed(signals: Signals, kmh: float) -> str:
    """The number alone, in the unit of the display."""
    return f"{kmh / MILE_KM if signals[HMI.DISTANCE_UNIT] == 'MILES' else kmh:.0f}"


def speed_unit(signals: Signals) -> str:
    """Unit of ``speed``."""
    return "mph" if signals[HMI.DISTANCE_UNIT] == "MILES" else "km/h"


def sign_figure(kmh: float, unit: str) -> str:
    """The figure on a limit sign, in the unit of the signs there, whatever the display shows."""
    return f"{kmh / MILE_KM if unit == 'mph' else kmh:.0f}"


def sign_in_words(signals: Signals, kmh: float, unit: str) -> str:
    """The figure on a limit sign; with its unit where that is not the display's."""
    figure = sign_figure(kmh, unit)
    return figure if unit == speed_unit(signals) else f"{figure} {unit}"


def distance(signals: Signals, metres: float) -> str:
    """A distance, rounded as on signs."""
    if signals[HMI.DISTANCE_UNIT] == "MILES":
        miles = metres / 1000 / MILE_KM
        return Quantity(f"{miles:.1f} mi") if miles < 100 else f"{miles:.0f} mi"
    if metres < 1000:
        return f"{round(metres, -1):.0f} m"
    return Quantity(f"{metres / 1000:.1f} km") if metres < 100_000 else f"{metres / 1000:.0f} km"


def pressure(signals: Signals, kpa: float) -> str:
    """A value in the unit of the display."""
    unit = signals[HMI.PRESSURE_UNIT]
    if unit == "PSI":
        return f"{kpa / PSI_KPA:.0f} psi"
    return Quantity(f"{kpa / 100:.1f} bar") if unit == "BAR" else f"{kpa:.0f} kPa"


def minutes(seconds: float) -> str:
    """Minutes and seconds."""
    whole = int(seconds)
    if whole >= 3600:
        return f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"
    return f"{whole // 60}:{whole % 60:02d}"
