"""Couplings between switches, lamps that follow the light, and the battery."""

import numpy as np
import pytest

from automotive_cosim.cockpit.cabin import Air
from automotive_cosim.cockpit.restrictions import Restriction, restrictions
from automotive_cosim.cockpit.signals import (
    ACTUATORS,
    ADAS,
    BODY,
    CABIN,
    CATALOGUE,
    ENERGY,
    HMI,
    HVAC,
    LIGHTS,
    MOTION,
    Signal,
    Signals,
    difference,
    named,
)
from automotive_cosim.cockpit.vehicle import HELD, MODES, Vehicle

from .couplings import COUPLED

MILD = Air(15.0, 60.0, 0.0, 0.0)


@pytest.fixture
def car() -> Vehicle:
    return Vehicle(Signals())


def test_front_defrost_brings_fan_cooling_and_fresh_air_to_the_windshield(car: Vehicle) -> None:
    car.command(HVAC.RECIRCULATION, True)
    car.command(HVAC.FAN_SPEED, 10.0)
    before = car.signals.snapshot()
    assert car.command(HVAC.FRONT_DEFROSTER, True) == ""
    now = car.signals
    assert now[HVAC.FAN_SPEED] >= 40
    assert now[HVAC.AIR_CONDITIONING]
    assert now[HVAC.AIR_DISTRIBUTION] == "UP"
    assert not now[HVAC.RECIRCULATION]
    car.command(HVAC.FRONT_DEFROSTER, False)
    assert car.signals.snapshot() == before


@pytest.mark.parametrize(
    ("signal", "value"),
    [
        (HVAC.FAN_SPEED, 0.0),
        (HVAC.AIR_CONDITIONING, False),
        (HVAC.AIR_DISTRIBUTION, "DOWN"),
        (HVAC.RECIRCULATION, True),
    ],
)
def test_taking_away_what_defrosting_needs_ends_it(car: Vehicle, signal: object, value: object) -> None:
    car.command(HVAC.FRONT_DEFROSTER, True)
    car.command(signal, value)  # type: ignore[arg-type]
    assert not car.signals[HVAC.FRONT_DEFROSTER]


def test_cooling_needs_the_fan_and_the_fan_does_not_end_auto(car: Vehicle) -> None:
    car.command(HVAC.AUTO, True)
    car.command(HVAC.FAN_SPEED, 0.0)
    assert not car.signals[HVAC.AIR_CONDITIONING]
    assert car.signals[HVAC.AUTO]
    car.command(HVAC.AIR_CONDITIONING, True)
    assert car.signals[HVAC.FAN_SPEED] > 0


def test_sync_carries_the_passenger_along_until_they_choose(car: Vehicle) -> None:
    car.command(HVAC.DRIVER_TEMPERATURE, 24.0)
    assert car.signals[HVAC.PASSENGER_TEMPERATURE] == 24.0
    car.command(HVAC.PASSENGER_TEMPERATURE, 19.0)
    assert not car.signals[HVAC.SYNC]
    car.command(HVAC.DRIVER_TEMPERATURE, 25.0)
    assert car.signals[HVAC.PASSENGER_TEMPERATURE] == 19.0


def test_lamps_want_the_lamps_they_build_on(car: Vehicle) -> None:
    car.command(LIGHTS.SWITCH, "OFF")
    for lamp in (LIGHTS.FRONT_FOG, LIGHTS.REAR_FOG, LIGHTS.HIGH_BEAM):
        before = car.signals.snapshot()
        assert "first" in car.command(lamp, True)
        assert car.signals.snapshot() == before
    car.command(LIGHTS.SWITCH, "POSITION")
    assert car.command(LIGHTS.FRONT_FOG, True) == ""
    assert car.command(LIGHTS.REAR_FOG, True) == ""
    assert car.command(LIGHTS.HIGH_BEAM, True) != ""
    car.command(LIGHTS.SWITCH, "OFF")
    assert not any(car.signals[lamp] for lamp in (LIGHTS.FRONT_FOG, LIGHTS.REAR_FOG))


def test_lights_on_auto_follow_the_light_outside(car: Vehicle) -> None:
    car.follow_light(dark=True)
    assert car.signals[LIGHTS.LOW_BEAM]
    assert car.signals[HMI.DAY_NIGHT] == "NIGHT"
    car.command(LIGHTS.HIGH_BEAM, True)
    car.follow_light(dark=False)
    assert not car.signals[LIGHTS.LOW_BEAM]
    assert not car.signals[LIGHTS.HIGH_BEAM]
    assert car.signals[HMI.DAY_NIGHT] == "DAY"


def test_asking_for_low_beam_turns_the_switch(car: Vehicle) -> None:
    car.command(LIGHTS.LOW_BEAM, True)
    assert car.signals[LIGHTS.SWITCH] == "BEAM"
    car.command(LIGHTS.LOW_BEAM, False)
    assert car.signals[LIGHTS.POSITION]
    assert not car.signals[LIGHTS.LOW_BEAM]


def test_commands_change_only_what_they_are_coupled_with() -> None:
    rng = np.random.default_rng(7)
    car = Vehicle(Signals())
    for _ in range(4000):
        signal = CATALOGUE[ACTUATORS[int(rng.integers(len(ACTUATORS)))]]
        if signal.allowed:
            value = signal.allowed[int(rng.integers(len(signal.allowed)))]
        elif isinstance(signal.default, bool):
            value = bool(rng.integers(2))
        elif isinstance(signal.default, float):
            value = float(signal.low + rng.integers(5) / 4 * (signal.high - signal.low))
        else:
            continue
        before = car.signals.snapshot()
        refused = car.command(signal, value)
        changed = set(difference(before, car.signals.snapshot()))
        assert changed <= {signal.path} | COUPLED.get(signal.path, frozenset())
        if refused:
            assert not changed
        if rng.random() < 0.1:
            car.follow_light(bool(rng.integers(2)))


def test_cruise_control_goes_off_with_its_main_switch(car: Vehicle) -> None:
    assert car.command(ADAS.CRUISE_ACTIVE, True) == ""
    car.command(ADAS.CRUISE_ENABLED, False)
    assert not car.signals[ADAS.CRUISE_ACTIVE]
    assert car.command(ADAS.CRUISE_ACTIVE, True) != ""


def test_energy_for_a_kilometre_at_fifty() -> None:
    # (1900 * 9.81 * 0.010 + 0.5 * 1.2 * 0.65 * 13.89^2) / 0.85 = 308 N: 308 kJ a kilometre, and 300 W for 72 s
    car = Vehicle(Signals())
    car.command(HVAC.FAN_SPEED, 0.0)
    before = car.signals[ENERGY.LEVEL]
    car.use_energy(72.0, Air(21.0, 50.0, 0.0, 50 / 3.6), 21.0)
    used_kwh = (before - car.signals[ENERGY.LEVEL]) / 100 * 64
    assert used_kwh == pytest.approx((307_700 + 300 * 72) / 3.6e6, rel=0.01)


def test_heating_costs_range() -> None:
    plain, warm = Vehicle(Signals()), Vehicle(Signals())
    warm.command(HVAC.REAR_DEFROSTER, True)
    for car in (plain, warm):
        car.use_energy(600.0, MILD, 21.0)
    assert warm.signals[ENERGY.RANGE] < plain.signals[ENERGY.RANGE]


def test_an_empty_battery_stays_empty() -> None:
    car = Vehicle(Signals({ENERGY.LEVEL.path: 0.01}))
    car.use_energy(1e6, MILD, 21.0)
    assert car.signals[ENERGY.LEVEL] == 0.0


def test_restrictions_follow_the_motion() -> None:
    assert restrictions("P", 0.0) is Restriction.BASELINE
    idling = restrictions("D", 0.0)
    assert Restriction.NO_VIDEO in idling
    assert Restriction.NO_KEYBOARD not in idling
    assert restrictions("D", 30.0) == 511


def test_wiper_modes_are_those_the_physics_know() -> None:
    car = Vehicle(Signals())
    for mode in BODY.FRONT_WIPER.allowed:
        car.command(BODY.FRONT_WIPER, mode)
        assert car.controls(2.0).front_sweeps_per_minute >= 0


# --- modes, windows, roof ---------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.path)
def test_a_mode_sets_what_it_needs_and_gives_it_back(car: Vehicle, mode: Signal[bool]) -> None:
    before = car.signals.snapshot()
    car.command(mode, True)
    assert car.signals[mode]
    for signal, wanted in MODES[mode].items():
        value = car.signals[signal]
        assert value >= wanted if signal is HVAC.FAN_SPEED else value == wanted
    car.command(mode, False)
    assert car.signals.snapshot() == before


def test_modes_take_turns_and_the_last_one_gives_back_what_was_before_them_all(car: Vehicle) -> None:
    before = car.signals.snapshot()
    for mode in MODES:
        car.command(mode, True)
        assert [other for other in MODES if car.signals[other]] == [mode]
    car.command(tuple(MODES)[-1], False)
    assert car.signals.snapshot() == before


def test_a_mode_ends_when_what_it_needs_is_taken_away(car: Vehicle) -> None:
    car.command(HVAC.MAX_COOLING, True)
    car.command(HVAC.FAN_SPEED, 50.0)
    assert not car.signals[HVAC.MAX_COOLING]
    assert car.signals[HVAC.RECIRCULATION]


def test_cooling_wants_closed_windows(car: Vehicle) -> None:
    car.command(HVAC.AIR_CONDITIONING, True)
    car.command(CABIN.DRIVER_WINDOW, 20.0)
    assert car.signals[HVAC.AIR_CONDITIONING]
    car.command(CABIN.REAR_LEFT_WINDOW, 30.0)
    assert not car.signals[HVAC.AIR_CONDITIONING]
    assert "close" in car.command(HVAC.AIR_CONDITIONING, True)
    car.command(CABIN.REAR_LEFT_WINDOW, 0.0)
    assert car.command(HVAC.AIR_CONDITIONING, True) == ""


def test_an_open_sunroof_draws_its_shade_back(car: Vehicle) -> None:
    assert car.signals[CABIN.SUNROOF_SHADE] == 100.0
    car.command(CABIN.SUNROOF, 50.0)
    assert car.signals[CABIN.SUNROOF_SHADE] == 0.0
    assert car.command(CABIN.SUNROOF_SHADE, 100.0)
    car.command(CABIN.SUNROOF, 0.0)
    assert car.command(CABIN.SUNROOF_SHADE, 100.0) == ""


@pytest.mark.parametrize("path", sorted(HELD))
def test_some_things_wait_for_a_stop(car: Vehicle, path: str) -> None:
    signal = named(path)
    value = (not car.signals[signal]) if isinstance(signal.default, bool) else signal.high
    car.signals[MOTION.IS_MOVING] = True
    assert car.command(signal, value) == HELD[path]
    assert car.signals[signal] == signal.default
    car.signals[MOTION.IS_MOVING] = False
    assert car.command(signal, value) == ""
    assert car.signals[signal] == value
