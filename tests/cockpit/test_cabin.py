"""The cabin's physics against values worked by hand or printed in tables."""

from dataclasses import replace
from itertools import product

import pytest

from automotive_cosim.cockpit.cabin import (
    AIR_CP,
    AIR_DENSITY,
    BLOWER_FULL,
    CABIN_LOSS,
    CABIN_VOLUME_M3,
    COMPRESSOR_MINIMUM_C,
    COOLANT_C,
    EVAPORATOR_C,
    FOG_OPAQUE,
    HEATER_W,
    LEAK_PER_HOUR,
    LEAK_PER_HOUR_KMH,
    OCCUPANT_HEAT_W,
    Air,
    Cabin,
    CabinStart,
    Controls,
    dew_point_c,
    hottest_c,
    humidity_ratio,
    relative_humidity_pct,
    saturation_hpa,
    sweeps_per_minute,
)
from automotive_cosim.errors import UnknownNameError, UserError
from tests.laws import over

COLD_DAMP = Air(4.0, 92.0, 0.0, 50 / 3.6)
MUGGY = Air(28.0, 85.0, 0.0, 8.0)
WET_CROWD = CabinStart(wet_clothes=True, temperature_c=17.0, humidity_pct=40.0)
IDLE = Controls(21.0, 20.0, False, False, False, False, False, 0.0, 0.0)
CLOSED = replace(IDLE, recirculation=True)
CROWDED = replace(CLOSED, people=4.0)
EMPTY = replace(IDLE, people=0.0)
DEFROST = replace(IDLE, people=4.0, fan_pct=40.0, air_up=True, air_conditioning=True, front_defroster=True)


@pytest.mark.parametrize(("temperature", "pressure"), [(0.0, 6.11), (10.0, 12.28), (20.0, 23.39), (30.0, 42.47)])
def test_saturation_pressure_agrees_with_steam_tables(temperature: float, pressure: float) -> None:
    assert saturation_hpa(temperature) == pytest.approx(pressure, rel=0.004)


@pytest.mark.parametrize(
    ("temperature", "humidity", "dew"), [(20, 50, 9.3), (25, 60, 16.7), (17, 75, 12.5), (4, 92, 2.8)]
)
def test_dew_point_agrees_with_psychrometric_tables(temperature: float, humidity: float, dew: float) -> None:
    assert dew_point_c(temperature, humidity) == pytest.approx(dew, abs=0.1)


def test_humidity_ratio_of_a_mild_room() -> None:
    # 20 °C, 50 %: 0.622 * 11.67 / (1013.25 - 11.67) = 7.25 g/kg
    assert humidity_ratio(20, 50) == pytest.approx(7.25e-3, rel=0.005)
    assert relative_humidity_pct(20, humidity_ratio(20, 50)) == pytest.approx(50, abs=1e-6)


def test_settled_glass_balances_the_heat_from_both_sides() -> None:
    # h_out = 9 + 4 * 13.89 = 64.6; 1/8 + 0.005 + 1/64.6 = 0.1455 m2K/W; 13 K across it: 89.4 W/m2
    # inner surface: 17 - 89.4 / 8 = 5.83 °C, outer: 4 + 89.4 / 64.6 = 5.38 °C
    pane = Cabin.at(replace(WET_CROWD, temperature_c=17.0), COLD_DAMP).windshield
    assert pane.inner_c == pytest.approx(5.83, abs=0.02)
    assert pane.outer_c == pytest.approx(5.38, abs=0.02)


def test_settled_glass_stays_settled() -> None:
    warm = Air(10.0, 40.0, 0.0, 10.0)
    cabin = Cabin.at(CabinStart(temperature_c=10.0, humidity_pct=30.0), warm)
    later = cabin.after(120.0, replace(EMPTY, fan_pct=0.0), warm)
    assert later.temperature_c == pytest.approx(10.0, abs=1e-6)
    assert later.windshield.temperature_c == pytest.approx(10.0, abs=1e-6)


def test_people_add_their_moisture_to_a_closed_cabin() -> None:
    # 4 people x (60 + 100) g/h = 0.178 g/s into 3.6 kg of air: 0.0494 g/kg a second, less 0.2 % a second by leaks
    start = Cabin.at(WET_CROWD, COLD_DAMP)
    later = start.after(10.0, CROWDED, COLD_DAMP)
    assert later.moisture - start.moisture == pytest.approx(0.49e-3, rel=0.05)


def test_a_damp_closed_cabin_fogs_its_windows_within_two_minutes_and_not_at_once() -> None:
    cabin = Cabin.at(WET_CROWD, COLD_DAMP)
    assert cabin.after(20.0, CROWDED, COLD_DAMP).windshield.fog_inside < 0.05
    later = cabin.after(120.0, CROWDED, COLD_DAMP)
    assert later.windshield.fog_inside > 0.5
    assert later.rear_window.fog_inside > 0.3
    assert later.windshield.film_outside == 0.0


def test_fog_grows_only_below_the_dew_point() -> None:
    cabin = Cabin.at(WET_CROWD, COLD_DAMP)
    for _ in range(150):
        following = cabin.after(1.0, CROWDED, COLD_DAMP)
        if following.windshield.fog > cabin.windshield.fog:
            assert following.windshield.inner_c < following.dew_point_c + 0.1
        cabin = following


def test_fresh_air_keeps_dry_people_s_windows_clear() -> None:
    # 4 x 60 g/h into 66 g/s of air and 4.5 of leaks: 0.95 g/kg above the 4.65 outside; the glass takes 5.8
    people = Cabin.at(replace(WET_CROWD, wet_clothes=False), COLD_DAMP)
    airy = people.after(300.0, replace(IDLE, fan_pct=60.0, people=4.0), COLD_DAMP)
    assert airy.moisture == pytest.approx(5.6e-3, rel=0.01)
    assert airy.windshield.fog_inside == 0.0
    assert people.after(300.0, CROWDED, COLD_DAMP).windshield.fog_inside > 0.2


def test_the_front_defroster_clears_an_opaque_windshield_in_about_a_minute() -> None:
    fogged = Cabin.at(WET_CROWD, COLD_DAMP).after(140.0, CROWDED, COLD_DAMP)
    assert fogged.windshield.fog >= FOG_OPAQUE
    assert fogged.after(10.0, DEFROST, COLD_DAMP).windshield.fog_inside > 0.3
    assert fogged.after(60.0, DEFROST, COLD_DAMP).windshield.fog_inside < 0.05
    assert fogged.after(60.0, CROWDED, COLD_DAMP).windshield.fog_inside == 1.0


def test_the_rear_heater_warms_and_clears_the_rear_window_in_some_minutes() -> None:
    fogged = Cabin.at(WET_CROWD, COLD_DAMP).after(140.0, CROWDED, COLD_DAMP)
    airy = replace(IDLE, fan_pct=60.0, rear_defroster=True)
    cleared = fogged.after(300.0, airy, COLD_DAMP)
    assert cleared.rear_window.inner_c > fogged.rear_window.inner_c + 5
    assert cleared.rear_window.fog_inside < 0.05


def test_chilled_glass_dews_outside_in_muggy_air_and_only_the_wiper_clears_it_at_once() -> None:
    chilled = replace(IDLE, set_c=18.0, fan_pct=80.0, air_up=True, air_conditioning=True)
    cabin = Cabin.at(CabinStart(temperature_c=26.0, humidity_pct=50.0), MUGGY).after(80.0, chilled, MUGGY)
    assert cabin.windshield.outer_c < dew_point_c(28, 85)
    assert cabin.windshield.film_outside > 0.5
    assert cabin.windshield.fog_inside == 0.0
    wiped = cabin.after(5.0, replace(chilled, front_sweeps_per_minute=40.0), MUGGY)
    assert wiped.windshield.film_outside < 0.1


@pytest.mark.parametrize("mode", ["SLOW", "MEDIUM", "FAST", "RAIN_SENSOR"])
def test_rain_covers_the_glass_unless_it_is_wiped(mode: str) -> None:
    rain = Air(12.0, 90.0, 5.0, 14.0)
    cabin = Cabin.at(CabinStart(), rain)
    assert cabin.after(90.0, IDLE, rain).windshield.film_outside > 0.9
    wiping = replace(IDLE, front_sweeps_per_minute=sweeps_per_minute(mode, rain.rain_mm_h))
    wiped = cabin.after(90.0, wiping, rain)
    assert wiped.windshield.film_outside < 0.15
    assert wiped.rear_window.film_outside > 0.9


def test_the_rain_sensor_rests_in_the_dry_and_hurries_in_a_downpour() -> None:
    assert sweeps_per_minute("RAIN_SENSOR", 0.0) == 0.0
    assert sweeps_per_minute("RAIN_SENSOR", 1.0) < sweeps_per_minute("RAIN_SENSOR", 4.0)
    assert sweeps_per_minute("RAIN_SENSOR", 50.0) == sweeps_per_minute("FAST", 50.0)


def test_heating_and_cooling_go_to_the_set_temperature() -> None:
    winter, summer = Air(-5.0, 80.0, 0.0, 10.0), Air(33.0, 40.0, 0.0, 10.0)
    warm = Cabin.at(CabinStart(temperature_c=5.0), winter).after(1200.0, replace(IDLE, fan_pct=60.0), winter)
    cool_down = replace(IDLE, fan_pct=80.0, air_conditioning=True)
    cool = Cabin.at(CabinStart(temperature_c=40.0), summer).after(1200.0, cool_down, summer)
    assert warm.temperature_c == pytest.approx(21.0, abs=3.0)
    assert cool.temperature_c == pytest.approx(21.0, abs=3.0)


@pytest.mark.slow
@over(product((-15, 0, 10, 25, 40), (20, 50, 100), (19.0, 24.0), (False, True)))
def test_the_cabin_settles_at_what_is_set_where_the_power_suffices(
    outside_c: int, fan_pct: int, set_c: float, is_closed: bool
) -> None:
    air = Air(outside_c, 50.0, 0.0, 50 / 3.6)
    set_up = Controls(set_c, fan_pct, False, True, is_closed, False, False, 0.0, 0.0)
    later = Cabin.at(CabinStart(temperature_c=21.0), air).after(900.0, set_up, air)
    leak = AIR_DENSITY * CABIN_VOLUME_M3 * (LEAK_PER_HOUR + LEAK_PER_HOUR_KMH * 50) / 3600
    gained_w = (CABIN_LOSS + leak * AIR_CP) * (outside_c - set_c) + OCCUPANT_HEAT_W
    needed_c = set_c - gained_w / (BLOWER_FULL * fan_pct / 100 * AIR_CP)
    taken_c = set_c if is_closed else outside_c
    coldest_c = min(taken_c, EVAPORATOR_C) if outside_c > COMPRESSOR_MINIMUM_C else taken_c
    if coldest_c <= needed_c <= hottest_c(coldest_c, BLOWER_FULL * fan_pct / 100):
        assert later.temperature_c == pytest.approx(set_c, abs=0.5)
    else:
        assert (later.temperature_c > set_c) is (needed_c < coldest_c)


@pytest.mark.parametrize("outside_c", [-15, -5, 0, 8])
def test_what_is_set_counts_at_a_low_fan_and_a_full_one_helps_no_more_than_it_blows(outside_c: int) -> None:
    """Three tenths of the fan hold what is set as far as the heater can, and full fan warms some times faster."""
    air = Air(outside_c, 50.0, 0.0, 50 / 3.6)

    def warmed(set_c: float, fan_pct: float, seconds: float, begun_c: float = 10.0) -> float:
        set_up = Controls(set_c, fan_pct, False, False, False, False, False, 0.0, 0.0)
        start = Cabin.at(CabinStart(temperature_c=begun_c), air)
        return start.after(seconds, set_up, air).temperature_c

    hottest_hold_c = warmed(28.0, 30.0, 3600.0)
    assert hottest_hold_c > {-15: 11.5, -5: 18.0, 0: 21.0, 8: 25.0}[outside_c]
    for set_c in (16.0, 18.0, 21.0, 24.0):
        assert warmed(set_c, 30.0, 3600.0) == pytest.approx(min(set_c, hottest_hold_c), abs=0.3)
    slow, fast = (warmed(24.0, fan_pct, 30.0) - 10.0 for fan_pct in (30.0, 100.0))
    assert 1.0 < fast / slow < 12.0
    for blown in (0.01, 0.03, 0.06, 0.11):
        given_w = blown * AIR_CP * (hottest_c(outside_c, blown) - outside_c)
        assert 0 < given_w <= HEATER_W + 1e-6
        assert hottest_c(outside_c, blown) < COOLANT_C


def test_shorter_steps_change_little() -> None:
    coarse = Cabin.at(WET_CROWD, COLD_DAMP).after(60.0, CROWDED, COLD_DAMP)
    fine = Cabin.at(WET_CROWD, COLD_DAMP)
    for _ in range(600):
        fine = fine.after(0.1, CROWDED, COLD_DAMP)
    assert fine.temperature_c == pytest.approx(coarse.temperature_c, abs=0.02)
    assert fine.windshield.fog_inside == pytest.approx(coarse.windshield.fog_inside, abs=0.02)


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"wet_cloths": True}, UnknownNameError, "did you mean 'wet_clothes'"),
        ({"humidity_pct": 0.0}, UserError, "0 to 100 % humidity"),
        ({"temperature_c": "warm"}, UserError, "initial conditions"),
    ],
)
def test_impossible_starts_are_refused(given: dict[str, object], error: type[UserError], words: str) -> None:
    with pytest.raises(error, match=words):
        CabinStart.read(given)


DUSTY = Air(20.0, 40.0, 0.0, 0.0, fine_dust=200.0)


def test_dust_settles_between_what_comes_in_and_what_is_taken_out() -> None:
    # fan at 20 %: 0.022 kg/s / 1.2 = 0.01833 m3/s fresh; leaks 0.5 / h * 3 m3 = 0.000417 m3/s at rest
    # (0.000417 + 0.5 * 0.01833) / (0.000417 + 0.01833) * 200 = 102.2 ug/m3
    cabin = Cabin.at(CabinStart(), DUSTY).after(3600.0, IDLE, DUSTY)
    assert cabin.fine_dust == pytest.approx(102.2, abs=0.1)
    # the purifier takes 60 m3/h = 0.01667 m3/s more: 1.917 / 0.03542 = 54.1 ug/m3
    purified = cabin.after(3600.0, replace(IDLE, purifier=True), DUSTY)
    assert purified.fine_dust == pytest.approx(54.1, abs=0.1)
    # round and round with the purifier: 0.0833 / (0.000417 + 0.009167 + 0.01667) = 3.2 ug/m3
    assert cabin.after(3600.0, replace(CLOSED, purifier=True), DUSTY).fine_dust == pytest.approx(3.2, abs=0.1)


def test_an_open_window_brings_the_air_of_outside_in() -> None:
    # one window open at 36 km/h: 10 + 1.5 * 36 = 64 changes an hour, and 0.5 + 0.08 * 36 = 3.4 by gaps
    frost = Air(0.0, 80.0, 0.0, 10.0, fine_dust=50.0)
    start = Cabin.at(CabinStart(fine_dust=0.0), frost)
    still = replace(CLOSED, people=0.0, fan_pct=0.0, windows_open=1.0)
    assert start.after(60.0, still, frost).fine_dust == pytest.approx(50 * (1 - 2.71828 ** (-67.4 / 60)), abs=0.1)
    shut = replace(still, windows_open=0.0)
    # 64 changes of 3.6 kg an hour: 0.064 kg/s * 1006 J/(kg K) * 20 K * 60 s / 60 kJ/K = 1.29 K, less as both cool
    colder = start.after(60.0, shut, frost).temperature_c - start.after(60.0, still, frost).temperature_c
    assert colder == pytest.approx(1.25, abs=0.1)
    damp = Cabin.at(WET_CROWD, COLD_DAMP)
    aired = damp.after(120.0, replace(CROWDED, windows_open=1.0), COLD_DAMP)
    assert aired.windshield.fog_inside < damp.after(120.0, CROWDED, COLD_DAMP).windshield.fog_inside / 2


def test_dust_never_swings_beyond_its_sources_whatever_is_open() -> None:
    cabin = Cabin.at(CabinStart(fine_dust=0.0), DUSTY)
    for _ in range(50):
        cabin = cabin.after(1.0, replace(IDLE, windows_open=5.0), replace(DUSTY, speed_mps=70.0))
        assert 0.0 <= cabin.fine_dust <= 200.0
        assert -40 < cabin.temperature_c < 60
