"""The car's controls: what each is called, where its signal is commanded, once for all screens.

Range, unit and step stand in ``signals``, why a control is locked while driving in ``vehicle.HELD``. A screen that
has no room for a name gives its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

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
    SEAT,
    VOICE,
    Signal,
    Signals,
)
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.values import speed, speed_unit, temperature
from automotive_cosim.contracts.text import Quantity, say, say_in


@dataclass(frozen=True, slots=True)
class StepWords:
    """What minus and plus do, why they do nothing at the ends, and how they look."""

    less: str
    more: str
    least: str
    most: str
    icons: tuple[Icon, Icon] = (Icon.MINUS, Icon.PLUS)
    more_first: bool = False
    """Whether plus is on the left, where it leads."""


def lower_higher(name: str, by: str) -> StepWords:
    """For what has more or less."""
    return StepWords(
        say("{name} lower by {step}", name=name, step=by),
        say("{name} higher by {step}", name=name, step=by),
        say("It is at its lowest"),
        say("It is at its highest"),
    )


def forward_back(name: str, by: str) -> StepWords:
    """For a seat, whose position counts from the front."""
    return StepWords(
        say("{name} forward by {step}", name=name, step=by),
        say("{name} back by {step}", name=name, step=by),
        say("It is as far forward as it goes"),
        say("It is as far back as it goes"),
    )


def upright_back(name: str, by: str) -> StepWords:
    """For a backrest, whose angle counts from upright."""
    return StepWords(
        say("{name} more upright by {step}", name=name, step=by),
        say("{name} further back by {step}", name=name, step=by),
        say("It is as upright as it goes"),
        say("It is as far back as it goes"),
    )


def left_right(name: str, by: str) -> StepWords:
    """For a mirror, whose angle counts to the left (VSS, ``Vehicle.Body.Mirrors.DriverSide.Pan``)."""
    return StepWords(
        say("{name} to the right by {step}", name=name, step=by),
        say("{name} to the left by {step}", name=name, step=by),
        say("It is as far to the right as it goes"),
        say("It is as far to the left as it goes"),
        (Icon.TO_THE_RIGHT, Icon.TO_THE_LEFT),
        more_first=True,
    )


def _balance(signals: Signals, value: float) -> str:
    share = f"{abs(value):.0f}"
    if not value:
        return share
    return say("right {share}", share=share) if value > 0 else say("left {share}", share=share)


def _fader(signals: Signals, value: float) -> str:
    share = f"{abs(value):.0f}"
    if not value:
        return share
    return say("front {share}", share=share) if value > 0 else say("rear {share}", share=share)


def _angle(signals: Signals, value: float) -> str:
    return f"{value:+.0f}" if value else "0"


BY_UNIT: Mapping[str, Callable[[Signals, float], str]] = {
    "Celsius": temperature,
    "km/h": lambda signals, value: f"{speed(signals, value)} {speed_unit(signals)}",
    "percent": lambda signals, value: f"{value:.0f} %",
    "mm": lambda signals, value: f"{value:.0f} mm",
    "degrees": lambda signals, value: f"{value:.0f}°",
    "dB": lambda signals, value: f"{value:+.0f} dB" if value else "0",
    "s": lambda signals, value: Quantity(f"{value:.1f} s"),
}
"""A value in words, in the display's units; by the signal's."""


class Control(NamedTuple):
    """What a screen knows of a signal that it commands."""

    key: str
    """Of its widget."""
    name: str
    icon: Icon
    ways: Callable[[str, str], StepWords] = lower_higher
    """What minus and plus do, from a name and a step."""
    shown: Callable[[Signals, float], str] | None = None
    """A value in words, where the unit does not say how."""


CONTROLS: Mapping[Signal[Any], Control] = {
    HVAC.DRIVER_TEMPERATURE: Control("hvac.driver_temperature", say("Driver's temperature"), Icon.CLIMATE),
    HVAC.PASSENGER_TEMPERATURE: Control("hvac.passenger_temperature", say("Passenger's temperature"), Icon.CLIMATE),
    HVAC.FAN_SPEED: Control("hvac.fan", say("Fan speed"), Icon.CLIMATE),
    HVAC.AIR_CONDITIONING: Control("hvac.air_conditioning", say("A/C"), Icon.SNOWFLAKE),
    HVAC.AUTO: Control("hvac.auto", say("Auto"), Icon.AUTO),
    HVAC.RECIRCULATION: Control("hvac.recirculation", say("Recirculate"), Icon.RECIRCULATION),
    HVAC.MAX_COOLING: Control("hvac.max_cooling", say("Max A/C"), Icon.SNOWFLAKE),
    HVAC.FRONT_DEFROSTER: Control("hvac.front_defroster", say("Front defrost"), Icon.DEFROST_FRONT),
    HVAC.REAR_DEFROSTER: Control("hvac.rear_defroster", say("Rear defrost"), Icon.DEFROST_REAR),
    HVAC.MAX_DEFROST: Control("hvac.max_defrost", say("Max defrost"), Icon.DEFROST_FRONT),
    HVAC.PURIFIER: Control("hvac.purifier", say("Purifier"), Icon.PURIFIER),
    HVAC.SYNC: Control("hvac.sync", say("Sync"), Icon.SYNC),
    HVAC.KEPT: Control("cabin.keep_climate", say("Keep climate on"), Icon.CLIMATE),
    SEAT.DRIVER_HEATING: Control("hvac.driver_seat_heating", say("Seat heat"), Icon.SEAT_HEATER),
    SEAT.PASSENGER_HEATING: Control("hvac.passenger_seat_heating", say("Seat heat"), Icon.SEAT_HEATER),
    SEAT.REAR_LEFT_HEATING: Control("hvac.rear_left_seat_heating", say("Left"), Icon.SEAT_HEATER),
    SEAT.REAR_RIGHT_HEATING: Control("hvac.rear_right_seat_heating", say("Right"), Icon.SEAT_HEATER),
    SEAT.STEERING_WHEEL_HEATING: Control("hvac.steering_wheel_heating", say("Steering wheel heat"), Icon.STEERING),
    SEAT.DRIVER_POSITION: Control("seat.driver.position", say("Position"), Icon.SEAT, forward_back),
    SEAT.DRIVER_HEIGHT: Control("seat.driver.height", say("Height"), Icon.SEAT),
    SEAT.DRIVER_RECLINE: Control("seat.driver.recline", say("Backrest"), Icon.SEAT, upright_back),
    SEAT.DRIVER_LUMBAR: Control("seat.driver.lumbar", say("Lumbar"), Icon.SEAT),
    SEAT.DRIVER_MASSAGE: Control("seat.driver.massage", say("Massage"), Icon.MASSAGE),
    SEAT.PASSENGER_POSITION: Control("seat.passenger.position", say("Position"), Icon.SEAT, forward_back),
    SEAT.PASSENGER_HEIGHT: Control("seat.passenger.height", say("Height"), Icon.SEAT),
    SEAT.PASSENGER_RECLINE: Control("seat.passenger.recline", say("Backrest"), Icon.SEAT, upright_back),
    SEAT.PASSENGER_LUMBAR: Control("seat.passenger.lumbar", say("Lumbar"), Icon.SEAT),
    SEAT.PASSENGER_MASSAGE: Control("seat.passenger.massage", say("Massage"), Icon.MASSAGE),
    SEAT.BELT_REMINDER: Control("cabin.belt_reminder", say("Belt chime"), Icon.SEAT_BELT),
    SEAT.PASSENGER_AIRBAG: Control("cabin.passenger_airbag", say("Passenger airbag"), Icon.AIRBAG),
    CABIN.DRIVER_LOCK: Control("door.driver", say("Driver"), Icon.DOOR),
    CABIN.PASSENGER_LOCK: Control("door.passenger", say("Passenger"), Icon.DOOR),
    CABIN.REAR_LEFT_LOCK: Control("door.rear_left", say("Rear left"), Icon.DOOR),
    CABIN.REAR_RIGHT_LOCK: Control("door.rear_right", say("Rear right"), Icon.DOOR),
    CABIN.LEFT_CHILD_LOCK: Control("door.child_left", say("Left child lock"), Icon.CHILD),
    CABIN.RIGHT_CHILD_LOCK: Control("door.child_right", say("Right child lock"), Icon.CHILD),
    CABIN.TRUNK: Control("door.trunk", say("Trunk"), Icon.TRUNK),
    CABIN.DRIVER_WINDOW: Control("window.driver", say("Driver"), Icon.WINDOW),
    CABIN.PASSENGER_WINDOW: Control("window.passenger", say("Passenger"), Icon.WINDOW),
    CABIN.REAR_LEFT_WINDOW: Control("window.rear_left", say("Rear left"), Icon.WINDOW),
    CABIN.REAR_RIGHT_WINDOW: Control("window.rear_right", say("Rear right"), Icon.WINDOW),
    CABIN.SUNROOF: Control("window.sunroof", say("Sunroof"), Icon.WINDOW),
    CABIN.SUNROOF_SHADE: Control("window.shade", say("Shade closed"), Icon.WINDOW),
    CABIN.WINDOW_LOCK: Control("window.lock", say("Window lock"), Icon.CHILD),
    CABIN.DOME_LIGHT: Control("light.dome", say("Dome light"), Icon.DOME_LIGHT),
    CABIN.DRIVER_READING_LIGHT: Control("light.driver_reading", say("Driver's reading light"), Icon.READING_LIGHT),
    CABIN.PASSENGER_READING_LIGHT: Control(
        "light.passenger_reading", say("Passenger's reading light"), Icon.READING_LIGHT
    ),
    CABIN.AMBIENT_LIGHT: Control("light.ambient", say("Ambient light"), Icon.PALETTE),
    MIRROR.DRIVER_FOLDED: Control("mirror.driver.fold", say("Fold"), Icon.MIRROR),
    MIRROR.DRIVER_HEATING: Control("mirror.driver.heat", say("Heat"), Icon.HEAT),
    MIRROR.DRIVER_PAN: Control(
        "mirror.driver.pan", say("Driver's mirror sideways"), Icon.MIRROR, left_right, _angle
    ),
    MIRROR.DRIVER_TILT: Control("mirror.driver.tilt", say("Driver's mirror up, down"), Icon.MIRROR, shown=_angle),
    MIRROR.PASSENGER_FOLDED: Control("mirror.passenger.fold", say("Fold"), Icon.MIRROR),
    MIRROR.PASSENGER_HEATING: Control("mirror.passenger.heat", say("Heat"), Icon.HEAT),
    MIRROR.PASSENGER_PAN: Control(
        "mirror.passenger.pan", say("Passenger's mirror sideways"), Icon.MIRROR, left_right, _angle
    ),
    MIRROR.PASSENGER_TILT: Control(
        "mirror.passenger.tilt", say("Passenger's mirror up, down"), Icon.MIRROR, shown=_angle
    ),
    LIGHTS.LOW_BEAM: Control("lights.low_beam", say("Low beam"), Icon.LOW_BEAM),
    LIGHTS.HIGH_BEAM: Control("lights.high_beam", say("High beam"), Icon.HIGH_BEAM),
    LIGHTS.FRONT_FOG: Control("lights.front_fog", say("Front fog"), Icon.FRONT_FOG),
    LIGHTS.REAR_FOG: Control("lights.rear_fog", say("Rear fog"), Icon.REAR_FOG),
    LIGHTS.HAZARD: Control("lights.hazard", say("Hazards"), Icon.HAZARD),
    ADAS.FORWARD_COLLISION_WARNING: Control("adas.collision_warning", say("Collision warning"), Icon.COLLISION),
    ADAS.EMERGENCY_BRAKING: Control("adas.emergency_braking", say("Emergency braking"), Icon.BRAKE),
    ADAS.SPEED_WARNING: Control("adas.speed_warning", say("Speed warning"), Icon.SPEED),
    ADAS.LANE_DEPARTURE: Control("adas.lane_departure", say("Lane departure"), Icon.LANE),
    ADAS.LANE_KEEPING: Control("adas.lane_keeping", say("Lane keeping"), Icon.STEERING),
    ADAS.STABILITY_CONTROL: Control("adas.stability_control", say("Stability control"), Icon.STABILITY),
    ADAS.BLIND_SPOT: Control("adas.blind_spot", say("Blind spot"), Icon.CAR_BESIDE),
    ADAS.PARKING_SENSORS: Control("adas.parking_sensors", say("Parking sensors"), Icon.PARKING),
    ADAS.DRIVER_MONITORING: Control("adas.driver_monitoring", say("Attention"), Icon.EYE),
    ADAS.CRUISE_ENABLED: Control("adas.cruise_enabled", say("Cruise control available"), Icon.CRUISE),
    ADAS.CRUISE_ACTIVE: Control("adas.cruise", say("Cruise control active"), Icon.CRUISE),
    ADAS.CRUISE_SPEED: Control("adas.cruise_speed", say("Cruise control, set speed"), Icon.CRUISE),
    ADAS.CRUISE_ADAPTIVE: Control("adas.cruise_adaptive", say("Adaptive"), Icon.DISTANCE),
    ADAS.CRUISE_GAP: Control("adas.cruise_gap", say("Gap"), Icon.DISTANCE),
    ADAS.LIMITER_ACTIVE: Control("adas.limiter", say("Limiter active"), Icon.SLOWER),
    ADAS.LIMITER_SPEED: Control("adas.limiter_speed", say("Limiter, set speed"), Icon.SLOWER),
    DRIVE.PARKING_BRAKE: Control("drive.parking_brake", say("Parking brake"), Icon.PARKING_BRAKE),
    DRIVE.PARKING_BRAKE_AUTO: Control(
        "drive.parking_brake_auto", say("Automatic parking brake"), Icon.PARKING_BRAKE
    ),
    ENERGY.CHARGE_LIMIT: Control("charging.limit", say("Charge to"), Icon.BATTERY),
    ENERGY.CHARGE_FLAP: Control("charging.flap", say("Charging flap open"), Icon.FLAP),
    MEDIA.VOLUME: Control("sound.media", say("Media"), Icon.MEDIA),
    MEDIA.MUTED: Control("sound.mute", say("Mute media"), Icon.MUTE),
    MEDIA.SHUFFLE: Control("media.shuffle", say("Shuffle"), Icon.SHUFFLE),
    MEDIA.REPEAT: Control("media.repeat", say("Repeat"), Icon.REPEAT),
    MEDIA.BASS: Control("sound.bass", say("Bass"), Icon.EQUALIZER),
    MEDIA.MIDDLE: Control("sound.middle", say("Mid"), Icon.EQUALIZER),
    MEDIA.TREBLE: Control("sound.treble", say("Treble"), Icon.EQUALIZER),
    MEDIA.BALANCE: Control("sound.balance", say("Left, right"), Icon.EQUALIZER, shown=_balance),
    MEDIA.FADER: Control("sound.fader", say("Rear, front"), Icon.EQUALIZER, shown=_fader),
    VOICE.GUIDANCE_VOLUME: Control("sound.guidance", say("Guidance"), Icon.VOICE),
    VOICE.CALL_VOLUME: Control("sound.calls", say("Calls"), Icon.PHONE),
    VOICE.TOUCH_SOUNDS: Control("settings.touch_sounds", say("Touch sounds"), Icon.VOLUME),
    HMI.BRIGHTNESS: Control("settings.brightness", say("Brightness"), Icon.BRIGHTNESS),
    HMI.REAR_SCREEN: Control("cabin.rear_screen", say("Rear screen, brightness"), Icon.SCREEN),
    LINK.MOBILE_DATA: Control("link.mobile", say("Mobile data"), Icon.MOBILE),
    LINK.WIFI: Control("link.wifi", say("Wi-Fi"), Icon.WIFI),
    LINK.HOTSPOT: Control("link.hotspot", say("Hotspot"), Icon.HOTSPOT),
    LINK.BLUETOOTH: Control("link.bluetooth", "Bluetooth", Icon.BLUETOOTH),
    LINK.SHARE_POSITION: Control("privacy.position", say("Share position"), Icon.GPS),
    LINK.SHARE_DRIVING: Control("privacy.driving", say("Share driving data"), Icon.CAR_BESIDE),
    LINK.VOICE_ASSISTANT: Control("privacy.microphone", say("Voice assistant"), Icon.MICROPHONE),
}
"""By signal: switches and numbers."""

NamedValue = tuple[str, str, Icon | None]
"""Key, name and icon of one of several values."""
_WIPING: Mapping[str, NamedValue] = {
    "OFF": ("off", say("Off"), None),
    "RAIN_SENSOR": ("auto", say("Auto"), None),
    "INTERVAL": ("interval", say("Interval"), None),
    "SLOW": ("slow", say("Slow"), None),
    "MEDIUM": ("medium", say("Medium"), None),
    "FAST": ("fast", say("Fast"), None),
}
CHOICES: Mapping[Signal[str], tuple[str, Mapping[str, NamedValue]]] = {
    HVAC.AIR_DISTRIBUTION: (
        "hvac.air",
        {
            "UP": ("up", say("Windshield"), Icon.AIR_UP),
            "MIDDLE": ("middle", say("Face"), Icon.AIR_MIDDLE),
            "DOWN": ("down", say("Feet"), Icon.AIR_DOWN),
        },
    ),
    CABIN.AMBIENT_COLOUR: (
        "light.colour",
        {
            "#FFE3B0": ("warm", say("Warm"), None),
            "#4FA8FF": ("blue", say("Blue"), None),
            "#45D18A": ("green", say("Green"), None),
            "#B57BFF": ("violet", say("Violet"), None),
            "#FF5C5C": ("red", say("Red"), None),
        },
    ),
    LIGHTS.SWITCH: (
        "lights.switch",
        {
            "OFF": ("off", say("Off"), Icon.LIGHTS_OFF),
            "POSITION": ("position", say_in("lights", "Position"), Icon.POSITION),
            "AUTO": ("auto", say("Auto"), Icon.LIGHTS_AUTO),
            "BEAM": ("low_beam", say("Low beam"), Icon.LOW_BEAM),
        },
    ),
    BODY.FRONT_WIPER: ("wiper.front", _WIPING),
    BODY.REAR_WIPER: (
        "wiper.rear",
        {mode: words for mode, words in _WIPING.items() if mode in BODY.REAR_WIPER.allowed},
    ),
    DRIVE.MODE: (
        "drive.mode",
        {
            "NORMAL": ("normal", say("Normal"), None),
            "ECONOMY": ("economy", say("Economy"), None),
            "SPORT": ("sport", say("Sport"), None),
            "SNOW": ("snow", say("Snow"), None),
            "RAIN": ("rain", say("Rain"), None),
        },
    ),
    MEDIA.SOURCE: (
        "media.source",
        {
            "BLUETOOTH": ("bluetooth", say("Phone"), Icon.BLUETOOTH),
            "FM": ("fm", "FM", Icon.RADIO),
            "DAB": ("dab", "DAB", Icon.RADIO_TOWER),
            "USB": ("usb", "USB", Icon.USB),
            "INTERNET": ("internet", say_in("source", "Podcasts"), Icon.PODCAST),
        },
    ),
    VOICE.GUIDANCE: (
        "route.voice",
        {
            "UNMUTED": ("all", say_in("guidance", "All"), None),
            "ALERT_ONLY": ("alerts", say("Alerts"), None),
            "MUTED": ("off", say("Off"), None),
        },
    ),
    HMI.DISTANCE_UNIT: (
        "settings.distance",
        {"KILOMETERS": ("kilometres", say("Kilometres"), None), "MILES": ("miles", say("Miles"), None)},
    ),
    HMI.TEMPERATURE_UNIT: (
        "settings.temperature",
        {"C": ("celsius", say("Celsius"), None), "F": ("fahrenheit", say("Fahrenheit"), None)},
    ),
    HMI.PRESSURE_UNIT: (
        "settings.pressure",
        {"BAR": ("bar", "bar", None), "KPA": ("kpa", "kPa", None), "PSI": ("psi", "psi", None)},
    ),
    HMI.TIME_FORMAT: (
        "language.time",
        {"HR_24": ("24", say("{n} hours", n=24), None), "HR_12": ("12", say("{n} hours", n=12), None)},
    ),
}
"""By signal: the key of its row, and each value's; of the language, the list of ``settings`` says more."""


def shown(signal: Signal[float], signals: Signals, value: float | None = None) -> str:
    """A value of a number in words, the present one by default."""
    told = CONTROLS[signal].shown or BY_UNIT[signal.unit]
    return told(signals, signals[signal] if value is None else value)
