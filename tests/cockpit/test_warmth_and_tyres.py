"""Tyres, seats and the display in daylight against values worked by hand."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.sensing import display_contrast, seat_after
from automotive_cosim.cockpit.signals import HMI, SEAT, TYRE
from automotive_cosim.cockpit.tyres import Tyres
from automotive_cosim.contracts import Surroundings


def test_pressure_falls_by_about_a_tenth_of_a_bar_for_ten_degrees() -> None:
    # (250 + 101.325) * 283.15 / 293.15 - 101.325 = 238.0 kPa; at -10 °C 351.325 * 263.15 / 293.15 - 101.325
    assert Tyres((250.0,), 10.0).pressures_kpa[0] == pytest.approx(238.02, abs=0.01)
    assert Tyres((250.0,), -10.0).pressures_kpa[0] == pytest.approx(214.05, abs=0.02)
    assert Tyres((250.0, 0.0), 20.0).pressures_kpa == pytest.approx((250.0, 0.0))


def test_driving_warms_the_tyres() -> None:
    # settled 20 + 0.25 * 100 = 45 °C; after one time constant 63.2 % of the way: 35.8 °C
    cold = Tyres((250.0,), 20.0)
    assert cold.after(600.0, 20.0, 100.0).temperature_c == pytest.approx(35.80, abs=0.01)
    assert cold.after(1e5, 20.0, 100.0).pressures_kpa[0] == pytest.approx(279.96, abs=0.01)
    halves = cold.after(300.0, 20.0, 100.0).after(300.0, 20.0, 100.0)
    assert halves.temperature_c == pytest.approx(cold.after(600.0, 20.0, 100.0).temperature_c)


def test_a_seat_warms_in_minutes_and_a_ventilated_one_is_cooler_than_the_cabin() -> None:
    # 60 W / 3 W/K = 20 K above 15 °C; time constant 540 / 3 = 180 s: 15 + 20 * (1 - 1/e) = 27.6 °C
    assert seat_after(15.0, 180.0, 15.0, 100.0) == pytest.approx(27.64, abs=0.01)
    assert seat_after(15.0, 1e5, 15.0, 50.0) == pytest.approx(25.0)
    assert seat_after(30.0, 1e5, 30.0, -100.0) == pytest.approx(26.0)
    assert seat_after(22.0, 60.0, 22.0, 0.0) == pytest.approx(22.0)


def test_daylight_washes_the_display_out_and_brightness_helps() -> None:
    # 100,000 lx * 0.1 * 0.01 / pi = 31.8 cd/m2: (1000 + 31.8) / (1 + 31.8) = 31.4; at 20 %: 231.8 / 32.8 = 7.06
    assert display_contrast(100.0, 100.0) == pytest.approx(31.43, abs=0.02)
    assert display_contrast(20.0, 100.0) == pytest.approx(7.06, abs=0.01)
    assert display_contrast(20.0, 0.0) == pytest.approx(200.0)


def test_the_signals_follow(make: Callable[..., Cockpit], around: Surroundings) -> None:
    cold = replace(around, weather=replace(around.weather, temperature_2m=-10.0))
    cockpit = make(surroundings=cold, signals={TYRE.REAR_LEFT.path: 180.0, SEAT.DRIVER_HEATING.path: 100.0})
    start = cockpit.signals[SEAT.DRIVER_TEMPERATURE], cockpit.signals[SEAT.PASSENGER_TEMPERATURE]
    assert cockpit.signals[TYRE.FRONT_LEFT] == pytest.approx(214.05, abs=0.1)
    assert cockpit.signals[TYRE.REAR_LEFT] == pytest.approx((180 + 101.325) * 263.15 / 293.15 - 101.325, abs=0.1)
    cockpit.sense(cold, 120.0)
    assert cockpit.signals[SEAT.DRIVER_TEMPERATURE] > start[0] + 5
    assert cockpit.signals[TYRE.FRONT_LEFT] > 214.1
    assert cockpit.signals[HMI.CONTRAST] == pytest.approx(
        display_contrast(cockpit.signals[HMI.BRIGHTNESS], 100 * 0.87), rel=0.2
    )
