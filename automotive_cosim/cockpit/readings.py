"""What the car's sensors and switches read, as an agent may see it."""

from __future__ import annotations

from automotive_cosim.cockpit.occupants import in_words
from automotive_cosim.cockpit.signals import ADAS, BODY, ENERGY, HVAC, LIGHTS, MOTION, OUTSIDE
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import VehicleState


def readings(state: State) -> VehicleState:
    """The present readings."""
    now = state.signals
    return VehicleState(
        speed_kmh=now[MOTION.SPEED],
        gear=now[MOTION.GEAR],
        restrictions=int(state.restrictions),
        ambient_temperature_c=now[OUTSIDE.TEMPERATURE],
        cabin_temperature_c=now[HVAC.CABIN_TEMPERATURE],
        cabin_humidity_pct=now[HVAC.CABIN_HUMIDITY],
        rain_intensity_pct=now[BODY.RAIN_INTENSITY],
        driver_temperature_set_c=now[HVAC.DRIVER_TEMPERATURE],
        fan_speed_pct=now[HVAC.FAN_SPEED],
        is_low_beam_on=now[LIGHTS.LOW_BEAM],
        is_high_beam_on=now[LIGHTS.HIGH_BEAM],
        is_front_fog_on=now[LIGHTS.FRONT_FOG],
        is_rear_fog_on=now[LIGHTS.REAR_FOG],
        is_hazard_on=now[LIGHTS.HAZARD],
        energy_level_pct=now[ENERGY.LEVEL],
        range_km=now[ENERGY.RANGE] / 1000,
        speed_limit_sign_kmh=now[ADAS.LIMIT_SIGN],
        leader_gap_m=now[ADAS.LEADER_DISTANCE],
        leader_time_to_collision_s=now[ADAS.LEADER_TIME_TO_COLLISION],
        aboard=in_words(now),
    )
