"""Couplings between switches, automatic lamps, and the battery."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, TypeVar

from automotive_cosim.cockpit.cabin import AIR_CP, BLOWER_FULL, Air, Controls, sweeps_per_minute
from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.occupants import breath
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    CABIN,
    DRIVE,
    ENERGY,
    HMI,
    HVAC,
    LIGHTS,
    LINK,
    MEDIA,
    MIRROR,
    MOTION,
    SEAT,
    Signal,
    Signals,
    picker,
)
from automotive_cosim.contracts.text import say

T = TypeVar("T")

DEFROST_FAN_PCT = 40.0
"""Minimum fan speed of front defrost: the second of five steps."""
LEAST_FAN_PCT = 20.0
"""Minimum fan speed for cooling, which requires air through the evaporator: the first of five steps."""
WINDOWS_PCT = 20.0
"""Maximum window opening for cooling."""
DARK_BELOW_DEG = 1.0
"""Sun elevation at which light sensors switch lamps on: about 1000 lux under a clear sky (UN R48, 6.2.7.6)."""

MODES: Mapping[Signal[bool], Mapping[Signal[Any], Any]] = {
    HVAC.FRONT_DEFROSTER: {
        HVAC.FAN_SPEED: DEFROST_FAN_PCT,
        HVAC.AIR_CONDITIONING: True,
        HVAC.AIR_DISTRIBUTION: "UP",
        HVAC.RECIRCULATION: False,
    },
    HVAC.MAX_DEFROST: {
        HVAC.FAN_SPEED: 100.0,
        HVAC.AIR_CONDITIONING: True,
        HVAC.AIR_DISTRIBUTION: "UP",
        HVAC.RECIRCULATION: False,
        HVAC.DRIVER_TEMPERATURE: HVAC.DRIVER_TEMPERATURE.high,
        HVAC.REAR_DEFROSTER: True,
    },
    HVAC.MAX_COOLING: {
        HVAC.FAN_SPEED: 100.0,
        HVAC.AIR_CONDITIONING: True,
        HVAC.AIR_DISTRIBUTION: "MIDDLE",
        HVAC.RECIRCULATION: True,
        HVAC.DRIVER_TEMPERATURE: HVAC.DRIVER_TEMPERATURE.low,
    },
}
"""Settings of each air mode, with a minimum fan speed; one mode is on at a time. Dry fresh air clears the
windshield; recirculated cooled air cools fastest."""
WINDOWS = (CABIN.DRIVER_WINDOW, CABIN.PASSENGER_WINDOW, CABIN.REAR_LEFT_WINDOW, CABIN.REAR_RIGHT_WINDOW)
LOCKS = (CABIN.DRIVER_LOCK, CABIN.PASSENGER_LOCK, CABIN.REAR_LEFT_LOCK, CABIN.REAR_RIGHT_LOCK)


def _paths(*signals: Signal[Any]) -> frozenset[str]:
    return frozenset(signal.path for signal in signals)


HELD: Mapping[str, str] = {
    **dict.fromkeys(
        _paths(SEAT.DRIVER_POSITION, SEAT.DRIVER_HEIGHT, SEAT.DRIVER_RECLINE),
        say("The driver's seat does not move while driving"),
    ),
    **dict.fromkeys(
        _paths(MIRROR.DRIVER_FOLDED, MIRROR.PASSENGER_FOLDED), say("Mirrors do not fold while driving")
    ),
    CABIN.TRUNK.path: say("The trunk stays shut while driving"),
    ENERGY.CHARGE_FLAP.path: say("The charging flap stays shut while driving"),
    DRIVE.PARKING_BRAKE.path: say("The parking brake works only when stopped"),
    SEAT.PASSENGER_AIRBAG.path: say("The airbag can be switched only when stopped"),
}
"""Actuators that are locked while the car moves, by path, and why."""


@dataclass(slots=True)
class Vehicle:
    """Signals and the wiring between them."""

    signals: Signals
    dark: bool = False
    """Reading of the light sensor."""
    before_mode: Mapping[Signal[Any], Any] = field(default_factory=dict)
    """Settings that a mode of the air overrode, to be restored when it is switched off."""
    lacks: tuple[Lacking, ...] = ()
    """What it was not fitted with, or is out of order."""

    def copy(self) -> Vehicle:
        return Vehicle(self.signals.copy(), self.dark, self.before_mode, self.lacks)

    def command(self, signal: Signal[T], value: T) -> str:
        """Sets an actuator and what is coupled to it.

        Returns:
            Why the car does not do it; empty if it does. A refused command changes nothing.

        Raises SignalError: the value is illegal."""
        value = signal.check(value)
        refusal = self._refusal(signal, value)
        if refusal:
            return refusal
        before = self.signals[signal]
        self.signals[signal] = value
        if value != before:
            self._climate(signal, value)
        self._lighting(signal, value)
        self._speed_keeping(signal, value)
        if signal is LINK.BLUETOOTH and not value and self.signals[MEDIA.SOURCE] == "BLUETOOTH":
            self.signals[MEDIA.ACTION] = "STOP"
        if signal is CABIN.SUNROOF and value:
            self.signals[CABIN.SUNROOF_SHADE] = 0.0
        if signal is HMI.DAY_NIGHT:
            self.signals[HMI.DAY_NIGHT_AUTO] = False
        self.follow_light(self.dark)
        return ""

    def held(self, signal: Signal[Any]) -> str:
        """Why the signal cannot be commanded while the car moves; empty if it can."""
        return HELD.get(signal.path, "") if self.signals[MOTION.IS_MOVING] else ""

    def follow_light(self, dark: bool) -> None:
        """Lamps on AUTO and a display on auto follow the light outside."""
        self.dark = dark
        now = self.signals
        switch = now[LIGHTS.SWITCH]
        beam = switch == "BEAM" or (switch == "AUTO" and dark)
        now[LIGHTS.LOW_BEAM] = beam
        now[LIGHTS.POSITION] = beam or switch == "POSITION"
        now[LIGHTS.HIGH_BEAM] = now[LIGHTS.HIGH_BEAM] and beam
        now[LIGHTS.FRONT_FOG] = now[LIGHTS.FRONT_FOG] and now[LIGHTS.POSITION]
        now[LIGHTS.REAR_FOG] = now[LIGHTS.REAR_FOG] and (beam or now[LIGHTS.FRONT_FOG])
        if now[HMI.DAY_NIGHT_AUTO]:
            now[HMI.DAY_NIGHT] = "NIGHT" if dark else "DAY"

    def controls(self, rain_mm_h: float) -> Controls:
        """The cabin's controls, from the switches."""
        return _controls(self.signals.picked(_read_controls), rain_mm_h, breath(self.signals))

    def use_energy(self, dt_s: float, air: Air, cabin_c: float) -> None:
        """Drains the battery by driving resistance and consumers."""
        power_w = _driving_w(air.speed_mps) + self._auxiliaries_w(air, cabin_c)
        used_pct = 100 * power_w * dt_s / (BATTERY_KWH * 3.6e6)
        level = max(0.0, self.signals[ENERGY.LEVEL] - used_pct)
        self.signals[ENERGY.LEVEL] = level
        self.signals[ENERGY.RANGE] = level / 100 * BATTERY_KWH / CONSUMPTION_KWH_KM * 1000

    def _refusal(self, signal: Signal[Any], value: Any) -> str:
        now = self.signals
        lacking = next((each for each in self.lacks if each.bars(signal, value)), None)
        if lacking is not None:
            return lacking.words
        held = self.held(signal)
        if held:
            return held
        if signal is CABIN.SUNROOF_SHADE and value and now[CABIN.SUNROOF]:
            return say("The shade needs a closed sunroof: close it first")
        if (
            signal is MEDIA.ACTION
            and value == "PLAY"
            and now[MEDIA.SOURCE] == "BLUETOOTH"
            and not now[LINK.BLUETOOTH]
        ):
            return say("The phone is not connected: switch Bluetooth on first")
        if value is not True:
            return ""
        if signal is HVAC.AIR_CONDITIONING and any(now[window] > WINDOWS_PCT for window in WINDOWS):
            return say(
                "Cooling needs closed windows: close them to {share} % or less first", share=f"{WINDOWS_PCT:.0f}"
            )
        if signal is LIGHTS.HIGH_BEAM and not now[LIGHTS.LOW_BEAM]:
            return say("High beam needs low beam: switch the lights to low beam first")
        if signal is LIGHTS.FRONT_FOG and not now[LIGHTS.POSITION]:
            return say("Front fog lamps need position lamps: switch the lights on first")
        if signal is LIGHTS.REAR_FOG and not (now[LIGHTS.LOW_BEAM] or now[LIGHTS.FRONT_FOG]):
            return say("The rear fog lamp needs low beam or front fog lamps: switch one of them on first")
        if signal is ADAS.CRUISE_ACTIVE and not now[ADAS.CRUISE_ENABLED]:
            return say("Cruise control is disabled")
        return ""

    def _climate(self, signal: Signal[Any], value: Any) -> None:
        now = self.signals
        if signal in MODES:
            self._mode(signal, value)
        elif signal is HVAC.AUTO and value:
            now[HVAC.AIR_CONDITIONING] = True
            now[HVAC.FAN_SPEED] = now[HVAC.FAN_SPEED] or LEAST_FAN_PCT
        elif signal is HVAC.AIR_CONDITIONING and value:
            now[HVAC.FAN_SPEED] = now[HVAC.FAN_SPEED] or LEAST_FAN_PCT
        elif (signal is HVAC.FAN_SPEED and not value) or (signal in WINDOWS and value > WINDOWS_PCT):
            now[HVAC.AIR_CONDITIONING] = False
        elif signal is HVAC.PASSENGER_TEMPERATURE:
            now[HVAC.SYNC] = now[HVAC.SYNC] and value == now[HVAC.DRIVER_TEMPERATURE]
        if now[HVAC.SYNC]:
            now[HVAC.PASSENGER_TEMPERATURE] = now[HVAC.DRIVER_TEMPERATURE]
        for mode, wanted in MODES.items():
            now[mode] = now[mode] and all(_meets(one, now[one], least) for one, least in wanted.items())

    def _mode(self, mode: Signal[bool], on: bool) -> None:
        """Applies a mode's settings, or restores the previous ones when it is switched off."""
        now = self.signals
        for other in MODES:
            if on and other is not mode and now[other]:
                now[other] = False
                self._mode(other, False)
        if on:
            wanted = MODES[mode]
            self.before_mode = {signal: now[signal] for signal in wanted}
            for signal, value in wanted.items():
                now[signal] = now[signal] if _meets(signal, now[signal], value) else value
        else:
            for signal, value in self.before_mode.items():
                now[signal] = value
            self.before_mode = {}

    def _speed_keeping(self, signal: Signal[Any], value: Any) -> None:
        """Makes cruise control and limiter mutually exclusive."""
        if signal is ADAS.CRUISE_ENABLED and not value:
            self.signals[ADAS.CRUISE_ACTIVE] = False
        elif signal is ADAS.CRUISE_ACTIVE and value:
            self.signals[ADAS.LIMITER_ACTIVE] = False
        elif signal is ADAS.LIMITER_ACTIVE and value:
            self.signals[ADAS.CRUISE_ACTIVE] = False

    def _lighting(self, signal: Signal[Any], value: Any) -> None:
        """Turns the light switch for a lamp that was commanded directly."""
        if signal is LIGHTS.LOW_BEAM:
            self.signals[LIGHTS.SWITCH] = "BEAM" if value else "POSITION"
        elif signal is LIGHTS.POSITION:
            self.signals[LIGHTS.SWITCH] = "POSITION" if value else "OFF"

    def _auxiliaries_w(self, air: Air, cabin_c: float) -> float:
        now = self.signals
        blown = BLOWER_FULL * now[HVAC.FAN_SPEED] / 100
        outside_c = cabin_c if now[HVAC.RECIRCULATION] else air.temperature_c
        wanted_c: float = now[HVAC.DRIVER_TEMPERATURE]
        heaters = (
            SEAT.DRIVER_HEATING,
            SEAT.PASSENGER_HEATING,
            SEAT.REAR_LEFT_HEATING,
            SEAT.REAR_RIGHT_HEATING,
            SEAT.STEERING_WHEEL_HEATING,
        )
        warmth_pct = sum(max(level, -level) for level in map(now.__getitem__, heaters))
        return (
            ELECTRONICS_W
            + blown * AIR_CP * abs(wanted_c - outside_c) / HEAT_PUMP_COP
            + (COMPRESSOR_W if now[HVAC.AIR_CONDITIONING] else 0.0)
            + (REAR_WINDOW_W if now[HVAC.REAR_DEFROSTER] else 0.0)
            + SEAT_W * warmth_pct / 100
        )


_SET = (
    *(HVAC.DRIVER_TEMPERATURE, HVAC.PASSENGER_TEMPERATURE, HVAC.FAN_SPEED, HVAC.AIR_DISTRIBUTION),
    *(HVAC.AIR_CONDITIONING, HVAC.RECIRCULATION, HVAC.FRONT_DEFROSTER, HVAC.MAX_DEFROST, HVAC.REAR_DEFROSTER),
    *(BODY.FRONT_WIPER, BODY.REAR_WIPER, HVAC.PURIFIER, *WINDOWS, CABIN.SUNROOF),
)
_read_controls = picker([signal.path for signal in _SET])


@lru_cache(maxsize=1024)
def _controls(values: tuple[Any, ...], rain_mm_h: float, people: float) -> Controls:
    """By the values of ``_SET``; cached, because they are mostly the same from second to second."""
    (
        driver_c,
        passenger_c,
        fan_pct,
        air,
        cooled,
        circulates,
        clears,
        dries,
        rear,
        front,
        back,
        purifies,
        *open_pct,
    ) = values
    return Controls(
        set_c=(driver_c + passenger_c) / 2,
        fan_pct=fan_pct,
        air_up=air == "UP",
        air_conditioning=cooled,
        recirculation=circulates,
        front_defroster=clears or dries,
        rear_defroster=rear,
        front_sweeps_per_minute=sweeps_per_minute(front, rain_mm_h),
        rear_sweeps_per_minute=sweeps_per_minute(back, rain_mm_h),
        purifier=purifies,
        windows_open=sum(open_pct) / 100,
        people=people,
    )


def _meets(signal: Signal[Any], value: Any, wanted: Any) -> bool:
    return bool(value >= wanted if signal is HVAC.FAN_SPEED else value == wanted)


BATTERY_KWH = 64.0
CONSUMPTION_KWH_KM = 0.165
"""Consumption for the displayed range: the WLTP figure of a mid-size electric car."""
MASS_KG, ROLLING, DRAG_AREA_M2, EFFICIENCY = 1900.0, 0.010, 0.65, 0.85
"""A mid-size electric car; rolling resistance coefficient and drag area as published for the class."""
ELECTRONICS_W, COMPRESSOR_W, REAR_WINDOW_W, SEAT_W, HEAT_PUMP_COP = 300.0, 500.0, 200.0, 60.0, 2.0


def _driving_w(speed_mps: float) -> float:
    """Rolling and air resistance at the battery's terminals."""
    force = MASS_KG * 9.81 * ROLLING + 0.5 * 1.2 * DRAG_AREA_M2 * speed_mps**2
    return force * speed_mps / EFFICIENCY if speed_mps > 0 else 0.0
