"""The GPS receiver and the modem."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from automotive_cosim.contracts import DrivingState, GpsFix
from automotive_cosim.geo.connectivity import ATTACH_S, Modem
from automotive_cosim.geo.earth import METRES_PER_DEGREE
from automotive_cosim.geo.gps import (
    BUILT_UP_SIGMA_M,
    CANYON_SIGMA_M,
    CORRELATION_S,
    OPEN_SKY_SIGMA_M,
    REACQUIRE_S,
    Gps,
)

Drive = Callable[..., DrivingState]


def _gps(seed: int = 3) -> Gps:
    return Gps(np.random.default_rng(seed))


def _fix(gps: Gps, state: DrivingState, dt_s: float = 0.1) -> GpsFix:
    fix = gps.read(state, dt_s)
    assert fix is not None
    return fix


def _north_errors_m(gps: Gps, state: DrivingState, dt_s: float, count: int) -> list[float]:
    assert state.lat_deg is not None
    return [(_fix(gps, state, dt_s).lat_deg - state.lat_deg) * METRES_PER_DEGREE for _ in range(count)]


def test_without_projection_there_is_no_position(drive: Drive) -> None:
    assert _gps().read(drive(lon_deg=None, lat_deg=None), 0.1) is None


@pytest.mark.parametrize(
    ("built_up", "lane_count", "sigma_m"),
    [(False, 1, OPEN_SKY_SIGMA_M), (True, 3, BUILT_UP_SIGMA_M), (True, 1, CANYON_SIGMA_M)],
)
def test_the_error_is_as_large_as_claimed(drive: Drive, built_up: bool, lane_count: int, sigma_m: float) -> None:
    state = drive(built_up=built_up, lane_count=lane_count)
    errors = _north_errors_m(_gps(), state, 10 * CORRELATION_S, 4000)
    assert np.mean(errors) == pytest.approx(0.0, abs=0.1 * sigma_m)
    assert np.std(errors) == pytest.approx(sigma_m, rel=0.1)
    assert _fix(_gps(), state).accuracy_m == pytest.approx(sigma_m * math.sqrt(2))


def test_a_car_that_stands_stays_where_it_is_and_other_surroundings_come_slowly(drive: Drive) -> None:
    gps = Gps(np.random.default_rng(3), is_steady=True)
    assert len(set(_north_errors_m(gps, drive(speed_mps=0.0), 1.0, 60))) == 1
    there = _north_errors_m(gps, drive(speed_mps=15.0), 1.0, 20)
    here = _north_errors_m(gps, drive(speed_mps=15.0, built_up=True, lane_count=1), 1.0, 200)
    assert max(abs(b - a) for a, b in pairwise([*there, *here[:10]])) < BUILT_UP_SIGMA_M
    assert np.std(here) > OPEN_SKY_SIGMA_M


def test_the_error_wanders_slowly(drive: Drive) -> None:
    steps = [abs(b - a) for a, b in pairwise(_north_errors_m(_gps(), drive(), 0.1, 500))]
    assert max(steps) < OPEN_SKY_SIGMA_M
    spread = np.corrcoef(
        np.lib.stride_tricks.sliding_window_view(_north_errors_m(_gps(5), drive(), 1.0, 20_000), 31).T
    )
    assert spread[0, 30] == pytest.approx(math.exp(-30.0 / CORRELATION_S), abs=0.12)


def test_a_tunnel_takes_the_fix_and_the_last_one_ages(drive: Drive) -> None:
    gps = _gps()
    before = _fix(gps, drive())
    inside = [_fix(gps, drive(in_tunnel=True, lat_deg=48.9), 0.5) for _ in range(6)]
    assert not any(fix.has_fix for fix in inside)
    assert {(fix.lon_deg, fix.lat_deg) for fix in inside} == {(before.lon_deg, before.lat_deg)}
    assert [fix.age_s for fix in inside] == pytest.approx([0.5, 1.0, 1.5, 2.0, 2.5, 3.0])


def test_after_the_tunnel_the_fix_comes_back_with_a_delay(drive: Drive) -> None:
    gps = _gps()
    _fix(gps, drive())
    _fix(gps, drive(in_tunnel=True))
    outside = [_fix(gps, drive(), 0.5).has_fix for _ in range(8)]
    assert outside.index(True) == pytest.approx(REACQUIRE_S / 0.5 - 1)
    assert all(outside[outside.index(True) :])


def test_a_drive_that_begins_in_a_tunnel_has_no_fix(drive: Drive) -> None:
    gps = _gps()
    first = _fix(gps, drive(in_tunnel=True))
    assert not first.has_fix
    assert first.accuracy_m > 10 * OPEN_SKY_SIGMA_M
    assert _fix(gps, drive(in_tunnel=True), 4.0).age_s == pytest.approx(4.0)


def test_a_standing_car_keeps_its_heading(drive: Drive) -> None:
    gps = _gps()
    moving = _fix(gps, drive(heading_deg=10.0))
    assert moving.heading_deg == pytest.approx(10.0, abs=2.0)
    assert _fix(gps, drive(heading_deg=200.0, speed_mps=0.0)).heading_deg == moving.heading_deg


def test_same_seed_same_fixes_and_copies_go_on_alike(drive: Drive) -> None:
    one, other = _gps(7), _gps(7)
    path = [drive(in_tunnel=3 <= index < 6) for index in range(10)]
    assert [one.read(state, 0.5) for state in path] == [other.read(state, 0.5) for state in path]
    branch = one.copy()
    ahead = [one.read(state, 0.5) for state in path]
    assert [branch.read(state, 0.5) for state in path] == ahead
    assert _gps(8).read(path[0], 0.5) != _gps(7).read(path[0], 0.5)


@pytest.mark.parametrize(("lon", "lat"), [(180.0, 0.0), (-180.0, -17.0), (0.0, 90.0), (50.0, -90.0)])
def test_fixes_stay_on_earth(drive: Drive, lon: float, lat: float) -> None:
    gps = _gps()
    for _ in range(200):
        fix = _fix(gps, drive(lon_deg=lon, lat_deg=lat), 60.0)
        assert -180.0 <= fix.lon_deg <= 180.0
        assert -90.0 <= fix.lat_deg <= 90.0


def test_the_modem_is_offline_in_tunnels_and_back_after(drive: Drive) -> None:
    modem = Modem()
    assert modem.read(drive(), 0.0).online
    assert not modem.read(drive(in_tunnel=True), 1.0).online
    branch = modem.copy()
    after = [modem.read(drive(built_up=True), 1.0).online for _ in range(5)]
    assert after.index(True) == ATTACH_S - 1
    assert [branch.read(drive(built_up=True), 1.0).online for _ in range(5)] == after
