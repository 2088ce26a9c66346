"""What a verdict says of an end state: what is, and what should be, in a reader's words.

fan speed is 30 %, should be 100 %
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from automotive_cosim.cockpit.signals import ACTUATORS, named
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.formats.shipped import shipped_table
from automotive_cosim.tasking.checks import (
    AlertGiven,
    AllOf,
    AnyOf,
    AppDataIs,
    Check,
    NamedCheck,
    SignalIs,
    SignalWithin,
)

SEATS = {
    ("Row1", "DriverSide"): "driver's",
    ("Row1", "PassengerSide"): "passenger's",
    ("Row2", "DriverSide"): "rear left",
    ("Row2", "PassengerSide"): "rear right",
    ("Mirrors", "DriverSide"): "driver's",
    ("Mirrors", "PassengerSide"): "passenger's",
}
GENERAL = frozenset({
    "Vehicle", "ADAS", "Body", "Cabin", "Chassis", "Connectivity", "HMI", "HVAC", "Infotainment", "Powertrain",
    "Privacy", "Seating", "Station", "Row1", "Row2", "Driver", "Passenger", "DriverSide", "PassengerSide",
    "Mirrors", "Door", "Lights", "AnyPosition", "Center", "Spotlight", "Backrest", "Equalizer", "Media", "Played",
    "AmbientLight", "Wiping", "TractionBattery", "ChargingPort", "Transmission",
})  # fmt: skip
"""Parts of a path that only say where the signal is filed."""
FIELD_WORDS = ("Active", "Enabled", "Engaged", "On", "Position", "Mode", "Level", "Cooling", "SpeedSet")
UNITS = {"percent": " %", "Celsius": " °C", "degrees": "°"}
NAMES = {
    "navigation.destination": "the destination",
    "navigation.onward": "the place after the destination",
    "navigation.avoid": "what routes avoid",
    "messages.sent": "messages sent",
    "messages.read": "messages read",
    "phone.do_not_disturb": "do not disturb",
    "requests": "requests to the road",
}
PATHS: Mapping[str, str] = shipped_table("tasking", "telling.toml")
"""Names where the path alone would not tell a reader."""


def told(key: str) -> str:
    """The name of an entry of ``Moment.commands`` in words: a signal's path, or a key of the apps' data."""
    if key in PATHS or key in NAMES:
        return PATHS.get(key) or NAMES[key]
    if not key.startswith("Vehicle."):
        return key.replace(".", " ").replace("_", " ")
    parts = key.split(".")
    seats = [word for pair, word in SEATS.items() if set(pair) <= set(parts)]
    words = [part for part in parts[:-1] if part not in GENERAL]
    last = parts[-1].removeprefix("Is")
    for ending in FIELD_WORDS:
        if last.endswith(ending) and (last != ending or words):
            last = last.removesuffix(ending)
            break
    if last == "Locked":
        last = "DoorLock"
    split = [word for part in (*words, last) for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", part)]
    return " ".join([*seats, *(word if word.isupper() and len(word) > 1 else word.lower() for word in split)])


def told_value(key: str, value: Any) -> str:
    """A value in words, with its unit."""
    if value is None or value == "":
        return "none"
    if isinstance(value, bool):
        return "on" if value else "off"
    unit = named(key).unit if key in ACTUATORS else ""
    if isinstance(value, int | float):
        return f"{value:g}{UNITS.get(unit, f' {unit}' if unit else '')}"
    return str(value)


def missing(check: Check, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> str:
    """What keeps a goal from being reached: what is, and what should be."""
    return "; ".join(dict.fromkeys(_lacks(check, hand_over, now, trace)))


def _lacks(check: Check, hand_over: Moment, now: Moment, trace: Sequence[Moment]) -> Iterator[str]:
    if check.holds(hand_over, now, trace):
        return
    match check:
        case AllOf(checks):
            for each in checks:
                yield from _lacks(each, hand_over, now, trace)
        case AnyOf(checks):
            yield ", or ".join(missing(each, hand_over, now, trace) for each in checks)
        case SignalIs(signal, values) | AppDataIs(signal, values):
            key = signal if isinstance(signal, str) else signal.path
            yield _is(key, now, " or ".join(told_value(key, value) for value in values))
        case NamedCheck("signal_raised", (signal, by)):
            least = float(hand_over.signals[signal.path]) + by
            yield _is(signal.path, now, f"{told_value(signal.path, least)} or more")
        case NamedCheck("signal_lowered", (signal, by)):
            most = float(hand_over.signals[signal.path]) - by
            yield _is(signal.path, now, f"{told_value(signal.path, most)} or less")
        case SignalWithin(signal, low, high):
            yield _is(signal.path, now, f"{told_value(signal.path, low)} to {told_value(signal.path, high)}")
        case NamedCheck("signal_changed", (signal,)):
            yield f"{told(signal.path)} is still {told_value(signal.path, now.signals[signal.path])}"
        case AlertGiven():
            given = now.commands["alerts"][len(hand_over.commands["alerts"]) :]
            yield f"{_alerts(given)}, should be {check}"
        case _:
            yield f"there should be {check}"


def _is(key: str, now: Moment, wanted: str) -> str:
    value = now.signals[key] if key in now.signals else now.commands[key]
    return f"{told(key)} is {told_value(key, value)}, should be {wanted}"


def _alerts(given: Sequence[Any]) -> str:
    if not given:
        return "no alert was given"
    words = (f"{one['kind']}" + (f" to {one['speed_kmh']:g} km/h" if one["speed_kmh"] else "") for one in given)
    return f"alerts given: {', '.join(words)}"
