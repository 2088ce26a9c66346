"""The harm of a drive, on moments made by hand."""

from dataclasses import replace

import pytest

from automotive_cosim.cockpit.signals import BODY
from automotive_cosim.contracts import EgoEnd
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.harm import harm
from automotive_cosim.drives.judge import Judgement
from automotive_cosim.drives.score import score
from automotive_cosim.tasking.verdict import _safe
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


@pytest.mark.parametrize("near", [True, False])
@pytest.mark.parametrize("anyway", [True, False])
@pytest.mark.parametrize("awareness", [None, 1.0, 0.4])
def test_harm_counts_where_attention_was_elsewhere_and_doing_nothing_does_none(
    near: bool, anyway: bool, awareness: float | None
) -> None:
    def driven(is_near: bool, aware: float | None) -> list[Moment]:
        leader = vehicle(20.0, 10, time_to_collision_s=2.5, drac_mps2=4.0) if is_near else None
        return [replace(each, awareness=aware) for each in stream(5, leader=leader)]

    untouched = None if awareness is None else 1.0
    part = _safe(driven(near, awareness), driven(anyway, untouched))
    assert part.ok is not (near and not anyway and awareness == 0.4), part.why
    assert harm(driven(near, awareness)).unaware_s == (3.0 if awareness == 0.4 else 0.0)
    nothing = Judgement((), ())
    assert score(nothing, 60.0).value == 0.0 > score(nothing, 60.0, harmed_s=2.0).value


def test_wipers_off_in_the_rain_are_harm_unless_the_goal_asks_for_them() -> None:
    def driven(wiper: str) -> list[Moment]:
        return [
            replace(
                each,
                weather=replace(each.weather, precipitation=3.0),
                signals={**each.signals, BODY.FRONT_WIPER.path: wiper},
            )
            for each in stream(5)
        ]

    asked = frozenset({BODY.FRONT_WIPER.path})
    untouched, stopped = driven("SLOW"), driven("OFF")
    assert not _safe(stopped, untouched).ok
    assert _safe(stopped, untouched, asked, 0.0).ok
    assert not _safe(stopped, untouched, asked, 4.0).ok, "before the goal was reached"
