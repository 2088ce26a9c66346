"""A verdict says what is and what should be, in a reader's words."""

from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.cockpit.signals import ACTUATORS, HVAC, LIGHTS, SEAT
from automotive_cosim.contracts import AlertKind, Reroute
from automotive_cosim.tasking.checks import (
    AlertGiven,
    AllOf,
    AnyOf,
    AppDataIs,
    Check,
    SignalIs,
    SignalWithin,
    road_asked,
    signal_changed,
    signal_lowered,
    signal_raised,
)
from automotive_cosim.tasking.telling import missing, told

FAN, SEAT_HEAT = HVAC.FAN_SPEED, SEAT.DRIVER_HEATING


def moment(**commands: Any) -> Any:
    signals = {FAN.path: 30.0, SEAT_HEAT.path: 0.0, LIGHTS.LOW_BEAM.path: True}
    data = {"navigation.destination": "Home", "alerts": [], "requests": []} | commands
    return SimpleNamespace(signals=signals, commands=data | signals, context=None)


def alert(kind: AlertKind, speed_kmh: float | None = None) -> dict[str, Any]:
    return {"kind": kind, "speed_kmh": speed_kmh}


@pytest.mark.parametrize(
    ("check", "words"),
    [
        (SignalIs(FAN, (100.0,)), "fan speed is 30 %, should be 100 %"),
        (SignalIs(SEAT_HEAT, (50.0, 100.0)), "driver's seat heating is 0 %, should be 50 % or 100 %"),
        (SignalIs(LIGHTS.LOW_BEAM, (False,)), "dipped beam is on, should be off"),
        (signal_raised(FAN, 20.0), "fan speed is 30 %, should be 50 % or more"),
        (signal_lowered(FAN, 10.0), "fan speed is 30 %, should be 20 % or less"),
        (SignalWithin(FAN, 40.0, 60.0), "fan speed is 30 %, should be 40 % to 60 %"),
        (signal_changed(FAN), "fan speed is still 30 %"),
        (AppDataIs("navigation.destination", ("Work",)), "the destination is Home, should be Work"),
        (AlertGiven(AlertKind.TUNNEL), "no alert was given, should be exactly one tunnel alert"),
        (road_asked(Reroute("A 4")), "there should be exactly one reroute request, to A 4"),
        (
            AllOf((SignalIs(FAN, (30.0,)), SignalIs(SEAT_HEAT, (50.0,)))),
            "driver's seat heating is 0 %, should be 50 %",
        ),
        (
            AnyOf((SignalIs(FAN, (100.0,)), SignalIs(SEAT_HEAT, (50.0,)))),
            "fan speed is 30 %, should be 100 %, or driver's seat heating is 0 %, should be 50 %",
        ),
        (SignalIs(FAN, (30.0,)), ""),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_lacks_is_told_as_what_is_and_what_should_be(check: Check, words: str) -> None:
    start = moment()
    assert missing(check, start, moment(), [start]) == words


@pytest.mark.parametrize(
    ("check", "short_pct", "enough_pct"),
    [
        (SignalIs(FAN, (100.0,)), 99.0, 100.0),
        (signal_raised(FAN, 20.0), 49.0, 50.0),
        (signal_lowered(FAN, 10.0), 21.0, 20.0),
        (SignalWithin(FAN, 40.0, 60.0), 39.0, 40.0),
        (SignalWithin(FAN, 40.0, 60.0), 61.0, 60.0),
        (signal_changed(FAN), 30.0, 31.0),
    ],
)
def test_a_signal_holds_from_its_bound_on(check: Check, short_pct: float, enough_pct: float) -> None:
    start = moment()
    for fan_pct, holds in ((short_pct, False), (enough_pct, True)):
        now = SimpleNamespace(signals=start.signals | {FAN.path: fan_pct}, commands=start.commands)
        assert check.holds(start, now, [start, now]) is holds, fan_pct


def test_a_wrong_alert_is_told() -> None:
    start, now = moment(), moment(alerts=[alert(AlertKind.SPEED, 80.0)])
    told_of = missing(AlertGiven(AlertKind.SPEED, 50.0), start, now, [start, now])
    assert told_of == (
        "alerts given: speed to 80 km/h, should be exactly one speed alert (any advised speed must be 50 km/h)"
    )


def test_every_command_has_a_name_of_its_own() -> None:
    names = [told(path) for path in ACTUATORS]
    assert len(set(names)) == len(names)
    assert not any(word in name for name in names for word in ("Vehicle", "Row", "Is", "."))
