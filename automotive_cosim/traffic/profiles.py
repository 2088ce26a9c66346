"""Driver profiles, in SUMO's terms where it has them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from automotive_cosim.errors import UnknownNameError

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


AVERAGE = DriverProfile(
    name="average",
    about="keeps the limit",
    speed_ratio=1.0,
    over_limit_max_kmh=0,
    top_speed_kmh=130,
    headway_s=1.4,
    min_gap_m=2.5,
    acceleration_mps2=2.6,
    deceleration_mps2=4.5,
    early_mps2=EARLY_MPS2,
    imperfection=0.3,
    overtaking=1.0,
    reaction_s=1.1,
    compliance=0.95,
    caution=1.0,
)
"""From whom the others differ."""
PROFILES: Mapping[str, DriverProfile] = {
    profile.name: profile
    for profile in (
        replace(
            AVERAGE,
            name="calm",
            about="keeps just under the limit and well back",
            speed_ratio=0.95,
            top_speed_kmh=120,
            headway_s=2.0,
            min_gap_m=3.0,
            acceleration_mps2=1.8,
            deceleration_mps2=3.5,
            imperfection=0.2,
            overtaking=0.5,
            reaction_s=1.0,
            compliance=1.0,
        ),
        AVERAGE,
        replace(
            AVERAGE,
            name="steady",
            about="exactly the limit, without variation: for studies with calculations by hand",
            headway_s=1.0,
            imperfection=0.0,
            reaction_s=1.0,
            compliance=1.0,
        ),
        replace(
            AVERAGE,
            name="hurried",
            about="far over the limit where the road is clear",
            speed_ratio=1.62,
            over_limit_max_kmh=31,
            top_speed_kmh=170,
            headway_s=0.9,
            min_gap_m=2.0,
            acceleration_mps2=3.0,
            early_mps2=HURRIED_MPS2,
            imperfection=0.1,
            overtaking=5.0,
            reaction_s=0.9,
            compliance=0.9,
            caution=0.0,
        ),
        replace(
            AVERAGE,
            name="brisk",
            about="a hair over the limit, as speedometers allow",
            speed_ratio=1.04,
            over_limit_max_kmh=2,
            imperfection=0.1,
        ),
        replace(
            AVERAGE,
            name="pressing",
            about="keeps the limit, close behind whoever is ahead, and does not pass",
            headway_s=0.5,
            min_gap_m=1.5,
            acceleration_mps2=2.9,
            early_mps2=4.5,
            imperfection=0.1,
            overtaking=0.0,
            reaction_s=0.9,
            caution=0.0,
        ),
        replace(AVERAGE, name="careless", about="keeps the limit in any weather", imperfection=0.1, caution=0.0),
        replace(
            AVERAGE,
            name="tailgating",
            about="a little over the limit and close behind whoever is ahead",
            speed_ratio=1.1,
            over_limit_max_kmh=15,
            top_speed_kmh=150,
            headway_s=0.5,
            min_gap_m=1.5,
            acceleration_mps2=2.9,
            early_mps2=4.5,
            imperfection=0.1,
            overtaking=2.0,
            reaction_s=0.9,
            compliance=0.85,
            caution=0.0,
        ),
        replace(
            AVERAGE,
            name="drowsy",
            about="uneven in speed and late to react",
            top_speed_kmh=120,
            headway_s=1.6,
            acceleration_mps2=2.0,
            early_mps2=HURRIED_MPS2,
            imperfection=0.9,
            overtaking=0.3,
            reaction_s=2.0,
            compliance=0.8,
            caution=0.5,
        ),
    )
}
"""The driver profiles.

The average one's acceleration, deceleration and overtaking are SUMO's defaults for passenger cars (sumo.dlr.de,
"Vehicle Type Parameter Defaults"). 2 s is the minimum gap in French law (code de la route R412-12); the
tailgating one keeps a quarter of it. This one and the pressing one, who look only at whom they follow, brake as
late as SUMO's model does: from 50 km/h at 21 m. Reaction times lie around the 1.25 s that Green (2000, "How long
does it take to stop?") gives for a common unexpected signal, shorter for alert drivers (0.7 s when expected),
longer for drowsy ones. The speeds of the hurried and the tailgating driver, the evenness, the compliance and the
caution are chosen, not measured.
"""


def profile(name: str) -> DriverProfile:
    """The profile of that name.

    Raises:
        UnknownNameError: there is no such profile.
    """
    if name not in PROFILES:
        raise UnknownNameError("driver", name, PROFILES)
    return PROFILES[name]
