"""Driver profiles, in SUMO's terms where it has them; their figures are in ``profiles.toml``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.shipped import shipped_table

EARLY_MPS2, HURRIED_MPS2 = 2.5, 3.0
"""How hard people brake for what they see standing ahead: before a signal 2.2 m/s2 in the mean, and 3.0 at the 85th
percentile (Gates and others, 2007)."""


@dataclass(frozen=True, slots=True)
class DriverProfile:
    """A kind of driver, in SUMO's terms where it has them (Krauss model)."""

    name: str
    about: str
    speed_ratio: float
    """Speed on a clear road, as a factor on the posted limit (SUMO ``speedFactor``)."""
    over_limit_max_kmh: float
    """Maximum excess over the limit."""
    top_speed_kmh: float
    """Speed without a limit."""
    headway_s: float
    """Time gap kept to the leader (SUMO ``tau``)."""
    min_gap_m: float
    acceleration_mps2: float
    deceleration_mps2: float
    early_mps2: float
    """How hard the driver brakes on a drive for what stands ahead; SUMO's model brakes as late as that allows."""
    imperfection: float
    """How unevenly the speed is kept, 0 to 1 (SUMO ``sigma``)."""
    overtaking: float
    """How readily the driver changes lanes to go faster (SUMO ``lcSpeedGain``)."""
    reaction_s: float
    """Median time to react to a request."""
    compliance: float
    """Share of requests that are followed."""
    caution: float
    """How far speed and gap are adapted to the weather: 1 as much as other drivers do, 0 not at all."""


def _read() -> Mapping[str, DriverProfile]:
    told = shipped_table("traffic", "profiles.toml")
    return {name: DriverProfile(**told[AVERAGE] | fields | {"name": name}) for name, fields in told.items()}


AVERAGE = "average"
"""From whom the others differ."""
PROFILES = _read()
"""The driver profiles.

The average one's acceleration, deceleration and overtaking are SUMO's defaults for passenger cars (sumo.dlr.de,
"Vehicle Type Parameter Defaults"). 2 s is the minimum gap in French law (code de la route R412-12); the
tailgating one keeps a quarter of it. This one and the pressing one, who look only at whom they follow, brake as
late as SUMO's model does: from 50 km/h at 21 m. Reaction times lie around the 1.25 s that Green (2000, "How long
does it take to stop?") gives for a common unexpected signal, shorter for alert drivers (0.7 s when expected),
longer for drowsy ones. The speeds of the hurried and the tailgating driver, the evenness, the compliance and the
caution are chosen, not measured."""


def profile(name: str) -> DriverProfile:
    """The profile of that name. Raises UnknownNameError: there is no such profile."""
    if name not in PROFILES:
        raise UnknownNameError("driver", name, PROFILES)
    return PROFILES[name]
