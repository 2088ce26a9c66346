"""The timer counts simulated seconds and says once that they are over."""

from collections.abc import Callable

import pytest

from automotive_cosim.cockpit.apps.timer import MOST_MIN, STEP_MIN
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import FeedbackCode
from tests.cockpit.fingers import press, shown

from .conftest import outside

Make = Callable[..., Cockpit]


@pytest.fixture
def timer(make: Make) -> Cockpit:
    cockpit = make()
    cockpit.visit("timer")
    return cockpit


def test_it_has_to_be_installed_first(make: Make) -> None:
    cockpit = make(surroundings=outside(speed_kmh=0.0))
    assert cockpit.open_app("timer").code is FeedbackCode.REFUSED
    assert "timer" not in cockpit.commands()["apps.installed"]


def test_it_tells_once_that_the_minutes_are_over(timer: Cockpit) -> None:
    assert press(timer, "timer.length.5") is FeedbackCode.OK
    assert press(timer, "timer.run") is FeedbackCode.OK
    timer.sense(outside(1199.0), 299.0)
    assert shown(timer, "timer.left") == "0:01"
    assert timer.commands()["timer.running"]
    for time_s in (1200.0, 1201.0, 1600.0):
        timer.sense(outside(time_s), 1.0)
        assert not timer.commands()["timer.running"]
    assert [notice.text for notice in timer._state.notices] == ["5 minutes are up"]
    assert shown(timer, "timer.left") == "5:00"


def test_one_that_is_stopped_says_nothing_and_one_that_is_prolonged_says_it_later(timer: Cockpit) -> None:
    press(timer, "timer.run")
    stopped = timer.copy()
    press(stopped, "timer.run")
    press(timer, "timer.more")
    for cockpit, tells_s in ((timer, 20 * 60), (stopped, None)):
        for passed_s in (15 * 60, 20 * 60):
            cockpit.sense(outside(900.0 + passed_s), 300.0)
            assert bool(cockpit._state.notices) == (passed_s == tells_s)


def test_its_length_has_bounds(timer: Cockpit) -> None:
    for key, bound in (("timer.less", STEP_MIN), ("timer.more", MOST_MIN)):
        while press(timer, key) is FeedbackCode.OK:
            pass
        assert press(timer, key) is FeedbackCode.DISABLED
        assert timer.commands()["timer.minutes"] == bound


def test_what_is_over_leads_to_the_timer(timer: Cockpit) -> None:
    press(timer, "timer.run")
    timer.home()
    timer.sense(outside(1800.0), 900.0)
    assert press(timer, "status.notice") is FeedbackCode.OK
    assert timer.screen == "timer"
