"""Android's VHAL names as aliases of the same signals.

    get_property(signals, "HVAC_FAN_SPEED", VehicleAreaSeat.ROW_1_LEFT)
    signal, value = resolve("HVAC_TEMPERATURE_SET", 22.5, VehicleAreaSeat.ROW_1_LEFT)

Names, areas, units and enumerations are those of ``android.hardware.automotive.vehicle``
(https://cs.android.com/android/platform/superproject/main/+/main:hardware/interfaces/automotive/vehicle/). Where
VHAL leaves the range to the car: fan speed is 0 to 10, seat warmth -2 to 2, window position per cent open. The
driver's seat is the left one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    CABIN,
    DRIVE,
    ENERGY,
    HMI,
    HVAC,
    LIGHTS,
    MIRROR,
    MOTION,
    OCCUPANT,
    OUTSIDE,
    SEAT,
    TYRE,
    LeafKind,
    Signal,
    Signals,
)
from automotive_cosim.cockpit.vehicle import BATTERY_KWH
from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.errors import SignalError, UnknownNameError

GLOBAL = 0
"""The area of properties without areas."""


class VehicleAreaSeat(IntEnum):
    """VHAL area ids of the seats."""

    ROW_1_LEFT = 0x01
    ROW_1_RIGHT = 0x04
    ROW_2_LEFT = 0x10
    ROW_2_CENTER = 0x20
    ROW_2_RIGHT = 0x40


class Door(IntEnum):
    """``VehicleAreaDoor``."""

    ROW_1_LEFT = 0x01
    ROW_1_RIGHT = 0x04
    ROW_2_LEFT = 0x10
    ROW_2_RIGHT = 0x40


class Window(IntEnum):
    """``VehicleAreaWindow``."""

    FRONT_WINDSHIELD = 0x01
    REAR_WINDSHIELD = 0x02
    ROW_1_LEFT = 0x10
    ROW_1_RIGHT = 0x40
    ROW_2_LEFT = 0x100
    ROW_2_RIGHT = 0x400


class Wheel(IntEnum):
    """``VehicleAreaWheel``."""

    LEFT_FRONT = 1
    RIGHT_FRONT = 2
    LEFT_REAR = 4
    RIGHT_REAR = 8


class Mirror(IntEnum):
    """``VehicleAreaMirror``."""

    DRIVER_LEFT = 1
    DRIVER_RIGHT = 2


@dataclass(frozen=True, slots=True)
class _Codec:
    """Conversion of values to and from VHAL."""

    read: Callable[[Any], Any]
    write: Callable[[Any], Any]


def _times(factor: float) -> _Codec:
    return _Codec(lambda value: value * factor, lambda value: value / factor)


def _steps(size: float) -> _Codec:
    return _Codec(lambda value: round(value / size), lambda value: value * size)


def _codes(table: Mapping[Any, int], read: Mapping[Any, int] | None = None) -> _Codec:
    """Enumerated values.

    Args:
        table: value to code.
        read: values that read as a code without being written by it.
    """
    back = {code: value for value, code in table.items()}
    return _Codec({**table, **(read or {})}.__getitem__, back.__getitem__)


_SAME = _Codec(lambda value: value, lambda value: value)
_LAMP = _codes({False: 0, True: 1})
_VENTILATION = _Codec(lambda value: max(0, round(-value / 50)), lambda value: -50.0 * value)
_WIPER = _codes({"OFF": 1, "INTERVAL": 3, "SLOW": 8, "MEDIUM": 9, "FAST": 10, "RAIN_SENSOR": 13})

_FRONT_SEATS = (VehicleAreaSeat.ROW_1_LEFT, VehicleAreaSeat.ROW_1_RIGHT)
_SEATS: Mapping[int, Signal[Any]] = {
    VehicleAreaSeat.ROW_1_LEFT: SEAT.DRIVER_HEATING,
    VehicleAreaSeat.ROW_1_RIGHT: SEAT.PASSENGER_HEATING,
    VehicleAreaSeat.ROW_2_LEFT: SEAT.REAR_LEFT_HEATING,
    VehicleAreaSeat.ROW_2_RIGHT: SEAT.REAR_RIGHT_HEATING,
}

_OCCUPANTS = {
    VehicleAreaSeat.ROW_1_LEFT: OCCUPANT.DRIVER,
    VehicleAreaSeat.ROW_1_RIGHT: OCCUPANT.PASSENGER,
    VehicleAreaSeat.ROW_2_LEFT: OCCUPANT.REAR_LEFT,
    VehicleAreaSeat.ROW_2_CENTER: OCCUPANT.REAR_MIDDLE,
    VehicleAreaSeat.ROW_2_RIGHT: OCCUPANT.REAR_RIGHT,
}


@dataclass(frozen=True, slots=True)
class _Property:
    """A VHAL property: the signal in each of its areas."""

    areas: Mapping[int, Signal[Any]]
    codec: _Codec = _SAME
    writable: bool = True
    """Whether the VHAL property can be set: a lamp's state cannot, its switch can."""


def _one(signal: Signal[Any], codec: _Codec = _SAME, *, writable: bool = True) -> _Property:
    return _Property({GLOBAL: signal}, codec, writable)


def _front(signal: Signal[Any], codec: _Codec = _SAME) -> _Property:
    """A property shared by both front seats."""
    return _Property(dict.fromkeys(_FRONT_SEATS, signal), codec)


def _lamps(name: str, areas: Mapping[int, Signal[Any]]) -> dict[str, _Property]:
    return {f"{name}_STATE": _Property(areas, _LAMP, False), f"{name}_SWITCH": _Property(areas, _LAMP)}


PROPERTIES: Mapping[str, _Property] = {
    "HVAC_AC_ON": _front(HVAC.AIR_CONDITIONING),
    "HVAC_MAX_AC_ON": _front(HVAC.MAX_COOLING),
    "HVAC_AUTO_ON": _front(HVAC.AUTO),
    "HVAC_DUAL_ON": _front(HVAC.SYNC),
    "HVAC_RECIRC_ON": _front(HVAC.RECIRCULATION),
    "HVAC_POWER_ON": _front(HVAC.FAN_SPEED, _Codec(lambda value: value > 0, lambda value: 30.0 if value else 0.0)),
    "HVAC_FAN_SPEED": _front(HVAC.FAN_SPEED, _steps(10)),
    "HVAC_FAN_DIRECTION": _front(HVAC.AIR_DISTRIBUTION, _codes({"MIDDLE": 1, "DOWN": 2, "UP": 4})),
    "HVAC_TEMPERATURE_SET": _Property(
        {
            VehicleAreaSeat.ROW_1_LEFT: HVAC.DRIVER_TEMPERATURE,
            VehicleAreaSeat.ROW_1_RIGHT: HVAC.PASSENGER_TEMPERATURE,
        }
    ),
    "HVAC_TEMPERATURE_CURRENT": _front(HVAC.CABIN_TEMPERATURE),
    "HVAC_DEFROSTER": _Property(
        {Window.FRONT_WINDSHIELD: HVAC.FRONT_DEFROSTER, Window.REAR_WINDSHIELD: HVAC.REAR_DEFROSTER}
    ),
    "HVAC_MAX_DEFROST_ON": _front(HVAC.MAX_DEFROST),
    "HVAC_SEAT_TEMPERATURE": _Property(_SEATS, _steps(50)),
    "HVAC_SEAT_VENTILATION": _Property({area: _SEATS[area] for area in _FRONT_SEATS}, _VENTILATION),
    "HVAC_STEERING_WHEEL_HEAT": _one(SEAT.STEERING_WHEEL_HEATING, _steps(100)),
    "HVAC_SIDE_MIRROR_HEAT": _Property(
        {Mirror.DRIVER_LEFT: MIRROR.DRIVER_HEATING, Mirror.DRIVER_RIGHT: MIRROR.PASSENGER_HEATING}, _LAMP
    ),
    "HEADLIGHTS_STATE": _one(LIGHTS.LOW_BEAM, _LAMP, writable=False),
    "HEADLIGHTS_SWITCH": _one(LIGHTS.SWITCH, _codes({"OFF": 0, "BEAM": 1, "AUTO": 0x100}, {"POSITION": 0})),
    **_lamps("HIGH_BEAM_LIGHTS", {GLOBAL: LIGHTS.HIGH_BEAM}),
    **_lamps("FRONT_FOG_LIGHTS", {GLOBAL: LIGHTS.FRONT_FOG}),
    **_lamps("REAR_FOG_LIGHTS", {GLOBAL: LIGHTS.REAR_FOG}),
    **_lamps("HAZARD_LIGHTS", {GLOBAL: LIGHTS.HAZARD}),
    **_lamps("CABIN_LIGHTS", {GLOBAL: CABIN.DOME_LIGHT}),
    **_lamps(
        "READING_LIGHTS",
        {
            VehicleAreaSeat.ROW_1_LEFT: CABIN.DRIVER_READING_LIGHT,
            VehicleAreaSeat.ROW_1_RIGHT: CABIN.PASSENGER_READING_LIGHT,
        },
    ),
    "WINDOW_POS": _Property(
        {
            Window.ROW_1_LEFT: CABIN.DRIVER_WINDOW,
            Window.ROW_1_RIGHT: CABIN.PASSENGER_WINDOW,
            Window.ROW_2_LEFT: CABIN.REAR_LEFT_WINDOW,
            Window.ROW_2_RIGHT: CABIN.REAR_RIGHT_WINDOW,
        },
        _steps(1),
    ),
    "WINDOW_LOCK": _Property(dict.fromkeys((Window.ROW_2_LEFT, Window.ROW_2_RIGHT), CABIN.WINDOW_LOCK)),
    "DOOR_LOCK": _Property(
        {
            Door.ROW_1_LEFT: CABIN.DRIVER_LOCK,
            Door.ROW_1_RIGHT: CABIN.PASSENGER_LOCK,
            Door.ROW_2_LEFT: CABIN.REAR_LEFT_LOCK,
            Door.ROW_2_RIGHT: CABIN.REAR_RIGHT_LOCK,
        }
    ),
    "DOOR_CHILD_LOCK_ENABLED": _Property(
        {Door.ROW_2_LEFT: CABIN.LEFT_CHILD_LOCK, Door.ROW_2_RIGHT: CABIN.RIGHT_CHILD_LOCK}
    ),
    "MIRROR_FOLD": _Property(
        {Mirror.DRIVER_LEFT: MIRROR.DRIVER_FOLDED, Mirror.DRIVER_RIGHT: MIRROR.PASSENGER_FOLDED}
    ),
    "SEAT_BELT_BUCKLED": _Property({area: seated.belted for area, seated in _OCCUPANTS.items()}),
    "SEAT_OCCUPANCY": _Property(
        {area: seated.occupied for area, seated in _OCCUPANTS.items()}, _codes({False: 1, True: 2})
    ),
    "WINDSHIELD_WIPERS_SWITCH": _Property(
        {Window.FRONT_WINDSHIELD: BODY.FRONT_WIPER, Window.REAR_WINDSHIELD: BODY.REAR_WIPER}, _WIPER
    ),
    "CURRENT_GEAR": _one(MOTION.GEAR, _codes({"N": 1, "R": 2, "P": 4, "D": 8})),
    "PARKING_BRAKE_ON": _one(DRIVE.PARKING_BRAKE),
    "NIGHT_MODE": _one(HMI.DAY_NIGHT, _Codec(lambda value: value == "NIGHT", lambda value: value), writable=False),
    "ENV_OUTSIDE_TEMPERATURE": _one(OUTSIDE.TEMPERATURE),
    "RANGE_REMAINING": _one(ENERGY.RANGE),
    "EV_BATTERY_LEVEL": _one(ENERGY.LEVEL, _times(BATTERY_KWH * 1000 / 100)),
    "TIRE_PRESSURE": _Property(
        {
            Wheel.LEFT_FRONT: TYRE.FRONT_LEFT,
            Wheel.RIGHT_FRONT: TYRE.FRONT_RIGHT,
            Wheel.LEFT_REAR: TYRE.REAR_LEFT,
            Wheel.RIGHT_REAR: TYRE.REAR_RIGHT,
        }
    ),
    "PERF_VEHICLE_SPEED": _one(MOTION.SPEED, _times(1 / KMH_PER_MPS)),
    "AUTOMATIC_EMERGENCY_BRAKING_ENABLED": _one(ADAS.EMERGENCY_BRAKING),
    "FORWARD_COLLISION_WARNING_ENABLED": _one(ADAS.FORWARD_COLLISION_WARNING),
    "BLIND_SPOT_WARNING_ENABLED": _one(ADAS.BLIND_SPOT),
    "LANE_DEPARTURE_WARNING_ENABLED": _one(ADAS.LANE_DEPARTURE),
    "LANE_KEEP_ASSIST_ENABLED": _one(ADAS.LANE_KEEPING),
    "CRUISE_CONTROL_ENABLED": _one(ADAS.CRUISE_ENABLED),
    "CRUISE_CONTROL_TYPE": _one(ADAS.CRUISE_ADAPTIVE, _codes({False: 1, True: 2})),
    "CRUISE_CONTROL_TARGET_SPEED": _one(ADAS.CRUISE_SPEED, _times(1 / KMH_PER_MPS)),
}
"""Every property by its name. An electric car has no ``FUEL_LEVEL``."""


def get_property(signals: Signals, name: str, area: int = GLOBAL) -> Any:
    """The value of a property in an area.

    Raises:
        UnknownNameError: no such property.
        SignalError: the property has no such area.
    """
    known = _named(name)
    return known.codec.read(signals[_at(name, known, area)])


def resolve(name: str, value: Any, area: int = GLOBAL) -> tuple[Signal[Any], Any]:
    """The signal behind a property and the value in its terms, ready to be commanded.

    Raises:
        UnknownNameError: no such property.
        SignalError: no such area, not to be set, or a value it cannot have.
    """
    known = _named(name)
    signal = _at(name, known, area)
    if not known.writable or signal.kind is not LeafKind.ACTUATOR:
        raise SignalError(f"{name} can only be read")
    try:
        translated = known.codec.write(value)
    except (KeyError, TypeError):
        raise SignalError(f"{name} is {value!r}, which {signal.path} cannot be ({signal.range})") from None
    return signal, signal.check(translated)


def _named(name: str) -> _Property:
    if name not in PROPERTIES:
        raise UnknownNameError("vehicle property", name, PROPERTIES)
    return PROPERTIES[name]


def _at(name: str, known: _Property, area: int) -> Signal[Any]:
    if area not in known.areas:
        areas = ", ".join(f"{int(one)} ({one.name})" if isinstance(one, IntEnum) else "0" for one in known.areas)
        raise SignalError(f"{name} has no area {area}; it has {areas}")
    return known.areas[area]
