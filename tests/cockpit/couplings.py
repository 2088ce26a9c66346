"""What else each command may change in this car, as its couplings are meant."""

from collections.abc import Mapping
from typing import Any

from automotive_cosim.cockpit.signals import ADAS, CABIN, HMI, HVAC, LIGHTS, LINK, MEDIA, Signal
from automotive_cosim.cockpit.vehicle import MODES, WINDOWS

_LAMPS: tuple[Signal[Any], ...] = (
    LIGHTS.POSITION,
    LIGHTS.LOW_BEAM,
    LIGHTS.HIGH_BEAM,
    LIGHTS.FRONT_FOG,
    LIGHTS.REAR_FOG,
)


def _paths(*signals: Signal[Any]) -> frozenset[str]:
    return frozenset(signal.path for signal in signals)


_AIR = _paths(
    HVAC.FAN_SPEED,
    HVAC.AIR_CONDITIONING,
    HVAC.AIR_DISTRIBUTION,
    HVAC.RECIRCULATION,
    HVAC.DRIVER_TEMPERATURE,
    HVAC.PASSENGER_TEMPERATURE,
    HVAC.REAR_DEFROSTER,
    *MODES,
)
_MODE_SIGNALS = _paths(*MODES)
COUPLED: Mapping[str, frozenset[str]] = {
    **{mode.path: _AIR - {mode.path} for mode in MODES},
    HVAC.FAN_SPEED.path: _paths(HVAC.AIR_CONDITIONING) | _MODE_SIGNALS,
    HVAC.AIR_CONDITIONING.path: _paths(HVAC.FAN_SPEED) | _MODE_SIGNALS,
    HVAC.AIR_DISTRIBUTION.path: _MODE_SIGNALS,
    HVAC.RECIRCULATION.path: _MODE_SIGNALS,
    HVAC.REAR_DEFROSTER.path: _paths(HVAC.MAX_DEFROST),
    HVAC.AUTO.path: _paths(HVAC.FAN_SPEED, HVAC.AIR_CONDITIONING),
    HVAC.DRIVER_TEMPERATURE.path: _paths(HVAC.PASSENGER_TEMPERATURE) | _MODE_SIGNALS,
    HVAC.PASSENGER_TEMPERATURE.path: _paths(HVAC.SYNC),
    HVAC.SYNC.path: _paths(HVAC.PASSENGER_TEMPERATURE),
    **{window.path: _paths(HVAC.AIR_CONDITIONING) | _MODE_SIGNALS for window in WINDOWS},
    CABIN.SUNROOF.path: _paths(CABIN.SUNROOF_SHADE),
    LIGHTS.SWITCH.path: _paths(*_LAMPS),
    LIGHTS.POSITION.path: _paths(LIGHTS.SWITCH, *_LAMPS) - _paths(LIGHTS.POSITION),
    LIGHTS.LOW_BEAM.path: _paths(LIGHTS.SWITCH, *_LAMPS) - _paths(LIGHTS.LOW_BEAM),
    LIGHTS.FRONT_FOG.path: _paths(LIGHTS.REAR_FOG),
    LINK.BLUETOOTH.path: _paths(MEDIA.ACTION),
    MEDIA.SOURCE.path: _paths(MEDIA.SELECTED) | {"media.playlist"},
    MEDIA.SELECTED.path: _paths(MEDIA.SOURCE, MEDIA.ACTION) | {"media.playlist"},
    "media.playlist": _paths(MEDIA.SOURCE, MEDIA.SELECTED, MEDIA.ACTION),
    "navigation.destination": frozenset({"navigation.onward", "requests"}),
    "navigation.onward": frozenset({"navigation.destination", "requests"}),
    "calls": frozenset({"phone.on_call"}),
    "calls.answered": frozenset({"phone.on_call"}),
    "phone.on_call": frozenset({"phone.muted"}),
    "messages.sent": frozenset({"calls.declined"}),
    "apps.memos": frozenset({"apps.recording"}),
    ADAS.CRUISE_ENABLED.path: _paths(ADAS.CRUISE_ACTIVE),
    ADAS.CRUISE_ACTIVE.path: _paths(ADAS.LIMITER_ACTIVE),
    ADAS.LIMITER_ACTIVE.path: _paths(ADAS.CRUISE_ACTIVE),
    HMI.DAY_NIGHT.path: _paths(HMI.DAY_NIGHT_AUTO),
    HMI.DAY_NIGHT_AUTO.path: _paths(HMI.DAY_NIGHT),
}
"""By path of the signal or name of the app data."""
