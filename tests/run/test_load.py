"""The driver's load against values worked by hand."""

from dataclasses import asdict
from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.contracts import Action, ActionType, BoundingBox, Element
from automotive_cosim.run.figures import NOTICE, driver_load, reading_s


def step(time_s: float, action: ActionType | None = None, said: str = "", speed_mps: float = 10.0) -> Any:
    notice = Element(said, "", "TextView", BoundingBox(0, 0, 9, 9), NOTICE, "")
    driving = SimpleNamespace(speed_mps=speed_mps)
    return SimpleNamespace(
        moment=SimpleNamespace(time_s=time_s, driving=driving),
        elements=(notice,) if said else (),
        action=None if action is None else Action(action),
    )


def test_reading_goes_by_words() -> None:
    # 238 words a minute
    assert reading_s("one two three four") == pytest.approx(4 * 60 / 238)


def test_touches_and_new_notices_count_while_moving() -> None:
    steps = [
        step(0.0),
        step(1.0, ActionType.CLICK),
        step(2.0, ActionType.SHOW_ALERT, "Slow down now"),
        step(5.0, ActionType.WAIT, "Slow down now"),
        step(6.0, ActionType.SWIPE, "Slow down now"),
        step(7.0, ActionType.CLICK, "Something else", speed_mps=0.0),
    ]
    load = driver_load(steps)
    assert load.interaction_s == 2.0
    assert load.reading_s == pytest.approx(3 * 60 / 238, abs=1e-3)
    assert load.within_guideline


def test_a_long_text_or_a_long_task_is_beyond_the_guideline() -> None:
    assert not driver_load([step(0.0), step(1.0, ActionType.SHOW_ALERT, "word " * 9)]).within_guideline
    long = [step(float(at), ActionType.CLICK) for at in range(14)]
    assert driver_load(long).interaction_s == 13.0
    assert not driver_load(long).within_guideline


def test_an_episode_reports_it(run: Any) -> None:
    load = asdict(run().memory.told.load)
    assert load["interaction_s"] >= 0
    assert set(load) == {"interaction_s", "reading_s", "longest_reading_s", "within_guideline"}
