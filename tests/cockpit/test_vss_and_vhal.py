"""The signals as a VSS tree, and under their Android names."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest

from automotive_cosim.cockpit import vss
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import CATALOGUE, HVAC, LIGHTS, MOTION, TYRE, LeafKind, Signals, difference
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.cockpit.vhal import PROPERTIES, VehicleAreaSeat, Wheel, Window, get_property, resolve
from automotive_cosim.contracts import FeedbackCode, Hazards, Surroundings
from automotive_cosim.errors import SignalError, UnknownNameError
from tests.laws import over


def leaves(nodes: dict[str, Any], path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    for name, node in nodes.items():
        if node["type"] == "branch":
            assert node["children"]
            assert set(node) == {"type", "description", "children"}
            yield from leaves(node["children"], f"{path}{name}.")
        else:
            yield path + name, node


def test_the_tree_has_every_signal_once_with_what_vss_wants_of_a_leaf() -> None:
    tree = json.loads(json.dumps(vss.tree()))
    assert set(tree) == {"Vehicle"}
    found = list(leaves(tree))
    assert [path for path, _ in found] == [*dict(found)]
    assert dict(found).keys() == CATALOGUE.keys()
    for path, leaf in found:
        assert leaf["type"] in ("sensor", "actuator", "attribute")
        assert leaf["datatype"] in ("boolean", "float", "string")
        assert leaf["description"]
        signal = CATALOGUE[path]
        assert ("comment" in leaf) == signal.overlay
        assert leaf.get("default") == signal.default
        assert (leaf.get("min"), leaf.get("max")) == (signal.minimum, signal.maximum)
        if leaf.get("allowed"):
            assert leaf["default"] in leaf["allowed"]


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


@over(PROPERTIES)
def test_what_is_read_can_be_written_back(name: str) -> None:
    for area, signal in PROPERTIES[name].areas.items():
        signals = Signals()
        value = get_property(signals, name, area)
        if not PROPERTIES[name].writable or signal.kind is not LeafKind.ACTUATOR:
            with pytest.raises(SignalError, match="only be read"):
                resolve(name, value, area)
            continue
        found, back = resolve(name, value, area)
        assert found is signal
        signals[found] = back
        assert get_property(signals, name, area) == value


def test_android_s_units_and_codes() -> None:
    signals = Signals({MOTION.SPEED.path: 36.0, TYRE.REAR_LEFT.path: 231.0})
    assert get_property(signals, "PERF_VEHICLE_SPEED") == pytest.approx(10.0)
    assert get_property(signals, "CURRENT_GEAR") == 8
    assert get_property(signals, "TIRE_PRESSURE", Wheel.LEFT_REAR) == 231.0
    assert get_property(signals, "EV_BATTERY_LEVEL") == pytest.approx(0.72 * 64_000)
    assert resolve("HVAC_FAN_DIRECTION", 4, VehicleAreaSeat.ROW_1_LEFT) == (HVAC.AIR_DISTRIBUTION, "UP")
    assert resolve("HVAC_FAN_SPEED", 7, VehicleAreaSeat.ROW_1_RIGHT) == (HVAC.FAN_SPEED, 70.0)
    assert resolve("HEADLIGHTS_SWITCH", 0x100) == (LIGHTS.SWITCH, "AUTO")
    assert resolve("WINDSHIELD_WIPERS_SWITCH", 13, Window.FRONT_WINDSHIELD)[1] == "RAIN_SENSOR"


def test_a_property_set_takes_along_what_hangs_on_its_signal() -> None:
    car = Vehicle(Signals())
    assert car.command(*resolve("HVAC_DEFROSTER", True, Window.FRONT_WINDSHIELD)) == ""
    assert get_property(car.signals, "HVAC_AC_ON", VehicleAreaSeat.ROW_1_LEFT)
    assert get_property(car.signals, "HVAC_FAN_DIRECTION", VehicleAreaSeat.ROW_1_LEFT) == 4


@pytest.mark.parametrize(
    ("name", "value", "area", "words"),
    [
        ("HVAC_FAN_SPEED", 11, VehicleAreaSeat.ROW_1_LEFT, "0 to 100 percent"),
        ("HVAC_FAN_SPEED", 3, 0, "no area 0"),
        ("HVAC_FAN_DIRECTION", 3, VehicleAreaSeat.ROW_1_LEFT, "one of UP"),
        ("HAZARD_LIGHTS_SWITCH", "on", 0, "true or false"),
        ("HAZARD_LIGHTS_STATE", 1, 0, "only be read"),
        ("WINDOW_POS", "half", Window.ROW_1_LEFT, "0 to 100"),
    ],
)
def test_what_cannot_be_is_refused_by_name(name: str, value: Any, area: int, words: str) -> None:
    with pytest.raises(SignalError, match=words):
        resolve(name, value, area)


def test_an_unknown_property_is_refused_with_a_suggestion() -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'HVAC_FAN_SPEED'"):
        get_property(Signals(), "HVAC_FANSPEED")


def test_the_cockpit_obeys_android_s_names_and_tells_the_road(cockpit: Cockpit) -> None:
    assert cockpit.set_property("HAZARD_LIGHTS_SWITCH", 1).code is FeedbackCode.OK
    assert cockpit.get_property("HAZARD_LIGHTS_STATE") == 1
    assert Hazards(True) in cockpit.drain_requests()
    assert cockpit.set_property("REAR_FOG_LIGHTS_SWITCH", 1).code is FeedbackCode.REFUSED


def test_an_injected_sensor_goes_on_reading_its_value(cockpit: Cockpit, around: Surroundings) -> None:
    cockpit.inject(TYRE.REAR_LEFT.path, 140.0)
    cockpit.inject(MOTION.SPEED.path, 0.0)
    cockpit.inject(HVAC.FAN_SPEED.path, 80.0)
    twin = cockpit.copy()
    for one in (cockpit, twin):
        one.sense(around, 5.0)
        assert one.signals[TYRE.REAR_LEFT] == 140.0
        assert one.vehicle_state().speed_kmh == 0.0
    assert cockpit.set_property("HVAC_FAN_SPEED", 2, VehicleAreaSeat.ROW_1_LEFT).code is FeedbackCode.OK
    cockpit.sense(around, 1.0)
    assert cockpit.signals[HVAC.FAN_SPEED] == 20.0
    with pytest.raises(SignalError, match="0 to 2550 kPa"):
        cockpit.inject(TYRE.REAR_LEFT.path, 2600.0)
    with pytest.raises(UnknownNameError):
        cockpit.inject("Vehicle.Tyre", 1.0)
