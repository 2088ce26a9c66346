"""The harm of a drive, on moments made by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from automotive_cosim.contracts import EgoEnd
from automotive_cosim.drives.harm import harm
from automotive_cosim.traffic.base import Event
from tests.drives.scenes import stream, vehicle


@pytest.mark.parametrize(
    ("ttc_s", "needed_mps2", "counts"),
    [(2.5, 4.0, True), (2.5, 2.5, False), (4.0, 4.0, False), (None, None, False)],
    ids=["near", "an ordinary stop", "far", "not closing"],
)
def test_a_near_collision_is_one_that_only_hard_braking_avoids(
    ttc_s: float | None, needed_mps2: float | None, counts: bool
) -> None:
    drive = stream(10, leader=vehicle(20.0, 10, time_to_collision_s=ttc_s, drac_mps2=needed_mps2))
    assert harm(drive).short_ttc_s == (10.0 if counts else 0.0)


def test_above_the_limit_time_and_metres_count() -> None:
    found = harm(stream(10, kmh=68.0))
    assert (found.over_limit_s, found.over_limit_m) == (10.0, pytest.approx(50.0))


def test_a_collision_of_two_others_is_not_the_cars() -> None:
    drive = stream(3)
    others = replace(drive[-1], events=(Event(3.0, "collision", "b hits c"),))
    assert not harm([*drive[:-1], others]).collided
    mine = replace(others, driving=replace(others.driving, end=EgoEnd.COLLIDED))
    assert harm([*drive[:-1], mine]).collided
