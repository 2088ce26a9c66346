"""Measures of analytic encounters, in closed form to one step, and the exposure of a drive."""

from collections.abc import Callable, Iterable
from math import cos, hypot, radians, sin

import pytest

from automotive_cosim.contracts import SeenVehicle
from automotive_cosim.measures.encounters import (
    Encounter,
    EncounterKind,
    PairOrder,
    RoadScene,
    as_csv,
    encounters,
    pair_readings,
)
from automotive_cosim.measures.exposure import DriveStretch, exposure
from automotive_cosim.measures.formulas import (
    crossing_drac_mps2,
    delta_v_mps,
    drac_mps2,
    gap_time_s,
    headway_time_s,
    required_deceleration_mps2,
)
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS, Thresholds

LENGTH_M, WIDTH_M, STEP_S = 5.0, 2.0, 0.1
Way = Callable[[float], tuple[float, float]]
"""Distance from the origin along the heading, and speed, at a time."""


def steadily(from_m: float, mps: float) -> Way:
    return lambda time_s: (from_m + mps * time_s, mps)


def scenes(seconds: float, *vehicles: tuple[str, float, float, Way]) -> Iterable[RoadScene]:
    """Vehicles by name, heading, offset to the right of the origin, and way."""
    for step in range(round(seconds / STEP_S) + 1):
        time_s = step * STEP_S
        there = []
        for name, heading_deg, right_m, way in vehicles:
            along_m, mps = way(time_s)
            east, north = sin(radians(heading_deg)), cos(radians(heading_deg))
            x_m, y_m = along_m * east + right_m * north, along_m * north - right_m * east
            there.append(SeenVehicle(name, "passenger", LENGTH_M, WIDTH_M, x_m, y_m, heading_deg, mps, 0))
        yield time_s, there


@pytest.mark.parametrize("heading_deg", [0.0, 90.0, 217.0])
def test_following_equals_its_closed_form(heading_deg: float) -> None:
    """20 m/s behind 10 m/s, from a gap of 40 m down to 5 m, then equally fast."""

    def braking(time_s: float) -> tuple[float, float]:
        return (20 * time_s, 20.0) if time_s < 3.5 else (70 + 10 * (time_s - 3.5), 10.0)

    road = ("ego", heading_deg, 0.0, braking), ("lead", heading_deg, 0.3, steadily(45.0, 10.0))
    (found,) = encounters(scenes(6.0, *road))
    threshold_s, nearest_s = DEFAULT_THRESHOLDS.ttc_s, 0.5
    assert (found.vehicle, found.other, found.kind, found.order) == ("ego", "lead", "following", "follows")
    assert found.min_ttc_s == pytest.approx(nearest_s, abs=1.01 * STEP_S)
    assert found.tet_s == pytest.approx(threshold_s - nearest_s, abs=2 * STEP_S)
    assert found.tit_s2 == pytest.approx((threshold_s - nearest_s) ** 2 / 2, abs=threshold_s * STEP_S)
    assert found.max_drac_mps2 == pytest.approx(10**2 / (2 * 6.0), abs=0.01)
    assert found.min_gap_time_s == pytest.approx(6.0 / 20.0, abs=0.01)
    assert found.delta_v_mps == pytest.approx(5.0)
    (behind,) = encounters(scenes(6.0, *road), ego="lead")
    assert behind.order == PairOrder.LEADS
    assert behind.min_ttc_s == found.min_ttc_s


def test_the_lane_beside_is_no_encounter() -> None:
    road = ("ego", 0.0, 0.0, steadily(0.0, 20.0)), ("beside", 0.0, 3.0, steadily(20.0, 10.0))
    assert list(pair_readings(scenes(5.0, *road))) == []
    assert encounters(scenes(5.0, *road)) == ()


def test_one_who_meets_head_on_closes_at_both_speeds() -> None:
    first = next(
        iter(
            pair_readings(
                scenes(0.0, ("ego", 0.0, 0.0, steadily(0.0, 10.0)), ("to", 180.0, 0.0, steadily(-40.0, 15.0)))
            )
        )
    )
    assert first.kind == EncounterKind.ONCOMING
    assert first.ttc_s == pytest.approx(40 / 25)


@pytest.mark.parametrize(("angle_deg", "kind"), [(90.0, "crossing"), (60.0, "merging")])
def test_paths_that_cross_have_the_planned_post_encroachment_time(angle_deg: float, kind: str) -> None:
    """The ego's rear leaves the origin at 5.5 s; the other's front reaches it at 6.5 s."""
    road = ("ego", 0.0, 0.0, steadily(-50.0, 10.0)), ("foe", angle_deg, 0.0, steadily(-65.0, 10.0))
    (found,) = encounters(scenes(10.0, *road))
    assert (found.kind, found.order) == (kind, PairOrder.LEADS)
    assert found.pet_s == pytest.approx(1.0, abs=0.01)
    assert found.pet_swept_s == pytest.approx(1.0 - 0.1 - 0.1, abs=0.02)
    assert found.min_ttc_s is None
    (mirrored,) = encounters(scenes(10.0, *road), ego="foe")
    assert mirrored.pet_s == pytest.approx(found.pet_s)
    assert mirrored.order == PairOrder.FOLLOWS


def test_two_who_reach_a_crossing_together_collide() -> None:
    road = ("ego", 0.0, 0.0, steadily(-30.0, 10.0)), ("foe", 90.0, 0.0, steadily(-32.0, 10.0))
    first = next(iter(pair_readings(scenes(0.0, *road))))
    assert first.ttc_s == pytest.approx(3.2)
    assert first.delta_v_mps == pytest.approx(hypot(10, 10) / 2)
    assert first.drac_mps2 == pytest.approx(2 * (10 - 32 / 3.5) / 3.5)


def test_thresholds_and_range_decide_what_is_critical() -> None:
    road = ("ego", 0.0, 0.0, steadily(0.0, 20.0)), ("lead", 0.0, 0.0, steadily(45.0, 18.0))
    assert encounters(scenes(2.0, *road)) == ()
    assert len(encounters(scenes(2.0, *road), thresholds=Thresholds(ttc_s=25.0))) == 1
    assert not list(pair_readings(scenes(2.0, *road), thresholds=Thresholds(range_m=30.0)))


def test_a_short_break_does_not_make_two_encounters() -> None:
    def wavering(time_s: float) -> tuple[float, float]:
        return 20 * min(time_s, 1.0), 20.0 if time_s < 1 or 2 < time_s < 3 else 10.0

    road = ("ego", 0.0, 0.0, wavering), ("lead", 0.0, 0.0, lambda _: (30.0, 10.0))
    assert len(encounters(scenes(4.0, *road))) == 1
    assert len(encounters(scenes(4.0, *road), thresholds=Thresholds(joins_s=0.5))) == 2


def test_required_deceleration_is_the_least_that_keeps_off_a_braking_leader() -> None:
    assert required_deceleration_mps2(39.0, 20.0, 10.0) == drac_mps2(39.0, 10.0)
    assert required_deceleration_mps2(20.0, 10.0, 10.0, 2.0) == pytest.approx(100 / (2 * (20 + 25)))
    assert required_deceleration_mps2(5.0, 22.0, 20.0, 2.0) == pytest.approx(2.0 + 4 / 10)
    assert required_deceleration_mps2(5.0, 10.0, 20.0) is None
    for gap_m, back_mps, front_mps, brakes_mps2 in (
        (20.0, 10.0, 10.0, 2.0),
        (5.0, 22.0, 20.0, 2.0),
        (9.0, 8.0, 9.0, 4.0),
    ):
        needed = required_deceleration_mps2(gap_m, back_mps, front_mps, brakes_mps2)
        assert needed is not None
        assert _least_gap_m(gap_m, back_mps, front_mps, brakes_mps2, needed) == pytest.approx(0.0, abs=0.05)


def _least_gap_m(gap_m: float, back_mps: float, front_mps: float, front_mps2: float, back_mps2: float) -> float:
    def gone_m(mps: float, mps2: float, time_s: float) -> float:
        moving_s = min(time_s, mps / mps2)
        return mps * moving_s - mps2 * moving_s**2 / 2

    return min(
        gap_m + gone_m(front_mps, front_mps2, step / 1000) - gone_m(back_mps, back_mps2, step / 1000)
        for step in range(15000)
    )


def test_simple_forms() -> None:
    assert gap_time_s(20.0, 10.0) == 2.0
    assert headway_time_s(15.0, 5.0, 10.0) == 2.0
    assert gap_time_s(20.0, 0.0) is None
    assert delta_v_mps(1500, 1500, (10, 0), (0, 10)) == pytest.approx(7.071, abs=1e-3)
    assert delta_v_mps(1500, 13500, (10, 0), (0, 0)) == pytest.approx(9.0)
    assert crossing_drac_mps2(30.0, 10.0, 2.9) is None
    assert crossing_drac_mps2(5.0, 10.0, 20.0) == pytest.approx(10.0)


def test_a_table_has_a_column_for_each_field() -> None:
    road = ("ego", 0.0, 0.0, steadily(-50.0, 10.0)), ("foe", 90.0, 0.0, steadily(-65.0, 10.0))
    heads, line = as_csv(encounters(scenes(10.0, *road)), Encounter).splitlines()
    assert heads.startswith("vehicle,other,kind,order,begins_s")
    assert line.startswith("ego,foe,crossing,leads,")


def test_exposure_keeps_all_time_and_way() -> None:
    drive = [
        DriveStretch(3600.0, 40_000.0, 40.0, "primary", "dry", "day"),
        DriveStretch(1800.0, 10_000.0, 20.0, "primary", "fog", "day"),
        DriveStretch(1800.0, 60_000.0, 120.0, "motorway", "dry", "night"),
        DriveStretch(3600.0, 40_000.0, 40.0, "primary", "dry", "day"),
    ]
    cells = exposure(drive)
    assert [(cell.speed_band, cell.hours) for cell in cells] == [
        ("30 to 50", 2.0),
        ("from 100", 0.5),
        ("0 to 30", 0.5),
    ]
    assert sum(cell.hours for cell in cells) == 3.0
    assert sum(cell.kilometres for cell in cells) == 150.0
