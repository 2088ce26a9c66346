"""The driver's attention: what takes it, for how long, and what SUMO makes of it."""

import shutil
from contextlib import closing
from itertools import groupby
from math import ceil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.cockpit.signals import CALL
from automotive_cosim.cosim.attention import (
    FADES_S,
    FRESH_H,
    GLANCE_S,
    LEAST,
    SPENT,
    SPENT_H,
    TASK_S,
    Asked,
    Attention,
)
from automotive_cosim.errors import ScenarioError
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked


def state(hours: float = 0.0, *, sun_deg: float = 30.0, partner: str = "", phone: str = "AWAY") -> Any:
    """What attention reads of a cockpit, by day on an empty road unless told otherwise."""
    driving = SimpleNamespace(speed_mps=20.0, around=SimpleNamespace(leader=None))
    outside = SimpleNamespace(
        driving=driving, sun_elevation_deg=sun_deg, weather=SimpleNamespace(visibility=20_000.0)
    )
    signals: dict[Any, Any] = {CALL.PARTNER: partner, CALL.PHONE: phone}
    return SimpleNamespace(
        notices=(), signals=signals, driven_s=hours * 3600, time_s=0.0, departed_s=0.0, outside=outside
    )


def course(seconds: int, asked: Asked | None = None, at: Any = None) -> list[float]:
    """Awareness second by second after something was asked."""
    attention, found = Attention(), list[float]()
    if asked is not None:
        attention.ask(asked)
    for _ in range(seconds):
        attention.think(at or state())
        found.append(attention.awareness)
        attention.passed(at or state(), 1.0)
    return found


def test_who_is_asked_nothing_stays_attentive() -> None:
    assert set(course(300)) == {1.0}


@pytest.mark.parametrize("look_s", [0.25, 1.0, 2.0, 5.0, 12.0, 60.0])
def test_no_glance_is_longer_than_the_longest_and_no_task_than_the_longest(look_s: float) -> None:
    attention, away = Attention(), list[bool]()
    attention.ask(Asked(0.0, look_s=look_s))
    for _ in range(80):
        away.append(attention.is_away)
        attention.passed(state(), 1.0)
    runs = [len(list(run)) for is_away, run in groupby(away) if is_away]
    assert max(runs) <= GLANCE_S
    assert sum(runs) == ceil(min(look_s, TASK_S))
    assert course(80, Asked(0.0, look_s=look_s))[-20:] == [1.0] * 20


def test_words_take_less_than_talk_and_both_fade() -> None:
    heard, talked = course(60, Asked(0.0, hear_s=8.0)), course(60, Asked(0.0, talk_s=8.0))
    assert talked[0] == 0.78 < heard[0] < 1.0
    assert set(talked[:8]) == {0.78}
    assert talked[8:] == sorted(talked[8:])
    assert talked[8 + round(3 * FADES_S)] == heard[8 + round(3 * FADES_S)] == 1.0


def test_a_call_lasts_and_loads_more_in_the_dark_and_a_phone_in_the_hand_takes_the_eyes_too() -> None:
    by_day, by_night = (course(30, at=state(partner="Anna", sun_deg=deg)) for deg in (30.0, -10.0))
    assert set(by_day) == {0.78}
    assert set(by_night) == {0.67}
    assert min(course(30, at=state(phone="HAND"))) < 0.3
    assert set(course(30, at=state(sun_deg=-10.0))) == {1.0}, "the road alone takes nothing"


def test_hours_at_the_wheel_tire() -> None:
    found = [course(2, at=state(hours))[-1] for hours in (0.0, FRESH_H, 4.0, 7.0, SPENT_H, 20.0)]
    assert found == sorted(found, reverse=True)
    assert (found[1], found[-1]) == (1.0, SPENT)


def test_awareness_is_never_less_than_sumo_knows() -> None:
    attention = Attention(eyes_s=0.0, is_away=True, look_s=9.0, load=4.0)
    assert attention.awareness == LEAST


@pytest.mark.sumo
def test_a_model_that_does_not_heed_it_is_told_before_the_start(tmp_path: Path) -> None:
    folder = tmp_path / "grid"
    shutil.copytree(scenarios.load("grid").folder, folder)
    for name, heeds in (("EIDM", False), ("IDM", True)):
        for path in folder.glob("*.rou.xml"):
            text = (scenarios.load("grid").folder / path.name).read_text()
            head, end, rest = text.partition("<routes")[2].partition(">")
            kind = f'<vType id="DEFAULT_VEHTYPE" carFollowModel="{name}"/>'
            path.write_text(f"{text[: text.index('<routes')]}<routes{head}{end}{kind}{rest}")
        scenario = scenarios.load(folder)
        with closing(Forked(scenario, seed=1)) as simulation:
            plan = EgoPlan(scenario.ego.trips[0], attention=True)
            if heeds:
                simulation.depart(plan).close()
            else:
                with pytest.raises(ScenarioError, match="carFollowModel Krauss or IDM"):
                    simulation.depart(plan)
