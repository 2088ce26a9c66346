"""The signal catalogue and the store."""

import csv
import json
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import (
    ACTUATORS,
    ADAS,
    CABIN,
    CATALOGUE,
    DRIVE,
    DRIVER,
    HVAC,
    LIGHTS,
    MOTION,
    OF_ATTENTION,
    TYRE,
    LeafKind,
    Signal,
    Signals,
    difference,
    named,
)
from automotive_cosim.contracts import Surroundings
from automotive_cosim.errors import SignalError, UnknownNameError, UserError
from tests.laws import over

VSS = Path(__file__).with_name("vss.tsv")
"""What the newest release that has it says of each signal; ``python -m docs.outside vss`` tells what changed."""
COMMANDED_HERE = ("IsChildLockActive", "Sunroof.Position", "HMI.CurrentLanguage")
"""Sensors in VSS, which here are the switch as well."""

ANYTHING = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), st.binary(max_size=2)
)


@over(CATALOGUE.values())
def test_default_is_legal_and_path_is_vss(signal: Signal[Any]) -> None:
    assert signal.check(signal.default) == signal.default
    assert signal.path.startswith("Vehicle.")
    assert all(part[0].isupper() for part in signal.path.split("."))


@over(csv.DictReader(VSS.read_text(encoding="utf-8").splitlines(), delimiter="\t"))
def test_a_signal_of_vss_is_what_vss_says(stated: dict[str, str]) -> None:
    signal = CATALOGUE[stated["path"]]
    expected = "actuator" if signal.path.endswith(COMMANDED_HERE) else stated["type"]
    assert signal.kind == ("sensor" if signal is DRIVE.HORN else expected)
    assert signal.unit == stated["unit"]
    kinds = {"boolean": bool, "string": str}
    kind = float if signal.optional else type(signal.default)
    assert kind is kinds.get(stated["datatype"].removesuffix("[]"), float)
    if kind is float:
        least = 0.0 if signal is CABIN.AMBIENT_LIGHT else signal.minimum  # 0 is off
        assert not stated["min"] or (
            signal.minimum is not None and signal.minimum >= min(float(stated["min"]), least)
        )
        assert not stated["max"] or (signal.maximum is not None and signal.maximum <= float(stated["max"]))
        assert not stated["datatype"].startswith("uint") or signal.low >= 0
        assert "int" not in stated["datatype"] or signal.step == int(signal.step)
    assert not stated["allowed"] or set(signal.allowed) <= set(stated["allowed"].split(","))


@given(value=ANYTHING)
def test_a_store_holds_only_legal_values(value: Any) -> None:
    signals = Signals()
    for signal in CATALOGUE.values():
        before = signals[signal]
        try:
            signals[signal] = value
        except SignalError as error:
            assert signal.path in str(error)
            assert "\n" not in str(error)
            assert signals[signal] == before
        else:
            assert signal.check(signals[signal]) == signals[signal]


@pytest.mark.parametrize(
    ("signal", "value", "expected"),
    [
        (HVAC.FAN_SPEED, 101.0, "0 to 100 percent"),
        (HVAC.DRIVER_TEMPERATURE, 15.5, "16 to 28 Celsius"),
        (HVAC.FAN_SPEED, float("nan"), "float"),
        (HVAC.FAN_SPEED, True, "float"),
        (LIGHTS.SWITCH, "BRIGHT", "one of OFF, POSITION, AUTO, BEAM"),
        (LIGHTS.HIGH_BEAM, 1, "bool"),
        (ADAS.LIMIT_SIGN, -5.0, "or nothing"),
    ],
)
def test_illegal_values_are_refused_by_name_and_range(signal: Signal[Any], value: Any, expected: str) -> None:
    with pytest.raises(SignalError, match=expected) as caught:
        Signals()[signal] = value
    assert signal.path in str(caught.value)
    assert isinstance(caught.value, UserError)


def test_integers_become_floats() -> None:
    signals = Signals()
    signals[HVAC.FAN_SPEED] = 60
    assert type(signals[HVAC.FAN_SPEED]) is float


def test_unknown_path_is_refused_with_a_suggestion() -> None:
    with pytest.raises(UnknownNameError, match=r"did you mean 'Vehicle\.Speed'"):
        named("Vehicle.Sped")
    with pytest.raises(UnknownNameError):
        Signals({"Vehicle.Nothing": 1})


def test_snapshot_is_json_and_a_difference_lists_what_changed() -> None:
    signals = Signals({LIGHTS.HAZARD.path: True})
    before = signals.snapshot()
    assert json.loads(json.dumps(before.as_dict())) == before
    signals[HVAC.FAN_SPEED] = 80.0
    assert difference(before, signals.snapshot()) == {HVAC.FAN_SPEED.path: (30.0, 80.0)}


@pytest.mark.parametrize("distraction", [None, 0.0, 40.0])
def test_a_snapshot_is_the_dict_of_all_values_in_a_twentieth_of_the_room(distraction: float | None) -> None:
    signals = Signals({DRIVER.DISTRACTION.path: distraction, DRIVER.FATIGUE.path: distraction})
    held = {path: signal.default for path, signal in CATALOGUE.items()}
    held |= dict.fromkeys(OF_ATTENTION, distraction) if distraction is not None else {}
    told = {path: value for path, value in held.items() if path not in OF_ATTENTION or value is not None}
    first = signals.snapshot()
    assert first == told == dict(first) == first.as_dict()
    assert (list(first), len(first)) == (list(told), len(told))
    assert [path in first for path in CATALOGUE] == [path in told for path in CATALOGUE]
    assert [first.get(path) for path in CATALOGUE] == list(map(told.get, CATALOGUE))
    signals[MOTION.SPEED] = 50.0
    then = signals.snapshot()
    assert then != first
    assert difference(first, then) == {MOTION.SPEED.path: (0.0, 50.0)}
    parts = {id(part) for part in first._parts}
    new = [part for part in then._parts if id(part) not in parts]
    assert len(new) == 1
    room = sum(map(sys.getsizeof, (then, then._parts, *new)))
    assert 20 * room < sys.getsizeof(then.as_dict())
    signals[HVAC.FAN_SPEED] = 80.0
    assert first[HVAC.FAN_SPEED.path] == 30.0
    assert signals.snapshot()[HVAC.FAN_SPEED.path] == 80.0


def test_what_is_written_alike_is_kept_once_and_minus_zero_is_not() -> None:
    signals = Signals({MOTION.SPEED.path: 40.5})
    before = signals[MOTION.SPEED]
    signals[MOTION.SPEED] = float("40.5")
    assert signals[MOTION.SPEED] is before
    for value in (0.0, -0.0):
        signals[MOTION.SPEED] = value
        assert str(signals[MOTION.SPEED]) == str(value)


def test_copies_are_independent() -> None:
    signals = Signals()
    twin = signals.copy()
    twin[HVAC.FAN_SPEED] = 90.0
    assert signals[HVAC.FAN_SPEED] != twin[HVAC.FAN_SPEED]


def test_what_can_be_commanded_are_the_actuators() -> None:
    assert set(ACTUATORS) == {path for path, signal in CATALOGUE.items() if signal.kind is LeafKind.ACTUATOR}
    assert set(Signals().commanded()) == set(ACTUATORS)


def test_reset_restores_every_signal() -> None:
    signals = Signals()
    start = signals.snapshot()
    for signal in signals:
        if signal.allowed:
            signals[signal] = next(value for value in signal.allowed if value != signal.default)
        elif isinstance(signal.default, bool):
            signals[signal] = not signal.default
        elif isinstance(signal.default, str):
            signals[signal] = "something else"
        else:
            signals[signal] = signal.high if signal.default != signal.high and signal.maximum else signal.low + 1.0
    assert difference(start, signals.snapshot()).keys() == CATALOGUE.keys()
    signals.reset()
    assert signals.snapshot() == start


def test_an_injected_sensor_goes_on_reading_its_value(cockpit: Cockpit, around: Surroundings) -> None:
    cockpit.inject(TYRE.REAR_LEFT.path, 140.0)
    cockpit.inject(MOTION.SPEED.path, 0.0)
    cockpit.inject(HVAC.FAN_SPEED.path, 80.0)
    twin = cockpit.copy()
    for one in (cockpit, twin):
        one.sense(around, 5.0)
        assert one.signals[TYRE.REAR_LEFT] == 140.0
        assert one.vehicle_state().speed_kmh == 0.0
    cockpit.inject(HVAC.FAN_SPEED.path, 20.0)
    cockpit.sense(around, 1.0)
    assert cockpit.signals[HVAC.FAN_SPEED] == 20.0
    with pytest.raises(SignalError, match="0 to 2550 kPa"):
        cockpit.inject(TYRE.REAR_LEFT.path, 2600.0)
    with pytest.raises(UnknownNameError):
        cockpit.inject("Vehicle.Tyre", 1.0)
