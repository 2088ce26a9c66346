"""A finger that is dragged: sliders, lists and the map follow it as far as it goes."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest

from automotive_cosim.cockpit.actions import parse, perform
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.widgets import Rows, Slider
from automotive_cosim.contracts import Direction, FeedbackCode, Surroundings

Make = Callable[..., Cockpit]


def sliders(cockpit: Cockpit) -> Iterator[Slider]:
    for widget in cockpit.tree.walk():
        if isinstance(widget, Slider) and widget.usable:
            yield widget


def knob(slider: Slider) -> tuple[int, int]:
    low, high = slider.signal.low, slider.signal.high
    return (
        round(slider.track.x + slider.track.width * (slider.value - low) / (high - low)),
        slider.track.centre[1],
    )


def test_every_slider_takes_the_value_where_the_finger_lets_go(
    make: Make, around: Surroundings, walker: Any
) -> None:
    parked = make(
        surroundings=replace(around, driving=replace(around.driving, speed_mps=0.0)),
        signals={"Vehicle.Powertrain.Transmission.Gear": "P"},
    )
    seen = set()
    for view in walker(parked):
        for slider in sliders(view.cockpit):
            seen.add(slider.key)
            x, y = knob(slider)
            for share in (0.0, 0.25, 0.8, 1.0):
                end = round(slider.track.x + share * slider.track.width)
                if end == x:
                    continue
                cockpit = view.cockpit.copy()
                way = Direction.RIGHT if end > x else Direction.LEFT
                cockpit.swipe(x, y, way, abs(end - x))
                wanted = slider.signal.low + share * (slider.signal.high - slider.signal.low)
                assert abs(cockpit.signals[slider.signal] - wanted) <= slider.signal.step / 2 + 1e-9, slider.key
    assert len(seen) >= 8


def test_a_drag_beyond_the_end_stops_there(make: Make) -> None:
    cockpit = make()
    cockpit.visit("settings")
    slider = next(sliders(cockpit))
    x, y = knob(slider)
    assert cockpit.swipe(x, y, Direction.RIGHT, 5000).code is FeedbackCode.OK
    assert cockpit.signals[slider.signal] == slider.signal.high


@pytest.mark.parametrize("rows_dragged", [1, 2, 4])
def test_a_list_moves_by_the_rows_the_finger_passes(make: Make, rows_dragged: int) -> None:
    cockpit = make()
    cockpit.visit("media")
    rows = next(widget for widget in cockpit.tree.walk() if isinstance(widget, Rows) and widget.key)
    x, y = rows.rect.centre
    assert cockpit.swipe(x, y, Direction.UP, rows_dragged * rows.rect.height // rows.shown).code is FeedbackCode.OK
    moved = next(widget for widget in cockpit.tree.walk() if widget.key == rows.key)
    assert isinstance(moved, Rows)
    assert moved.first == rows_dragged


def test_the_map_moves_with_the_finger_and_back(make: Make) -> None:
    cockpit = make()
    cockpit.visit("map")
    view = next(widget for widget in cockpit.tree.walk() if widget.key == "map.view").rect.centre
    assert cockpit.swipe(*view, Direction.LEFT, 100).code is FeedbackCode.OK
    away = cockpit.elements()
    assert cockpit.swipe(*view, Direction.LEFT, 50).code is FeedbackCode.OK
    assert cockpit.elements() != away
    assert cockpit.swipe(*view, Direction.RIGHT, 50).code is FeedbackCode.OK
    assert cockpit.elements() == away


def test_an_agent_drags_by_its_action(make: Make) -> None:
    cockpit = make()
    cockpit.visit("settings")
    slider = next(sliders(cockpit))
    x, y = knob(slider)
    drag = {"action_type": "swipe", "x": x, "y": y, "direction": "left", "distance_px": x - slider.track.x}
    assert perform(parse(drag), cockpit, cockpit.elements()).code is FeedbackCode.OK
    assert cockpit.signals[slider.signal] == slider.signal.low


def test_a_locked_slider_stays(make: Make, walker: Any) -> None:
    for view in walker(make()):
        for widget in view.cockpit.tree.walk():
            if isinstance(widget, Slider) and not widget.usable:
                before = view.cockpit.commands()
                code = view.cockpit.copy().swipe(*widget.rect.centre, Direction.RIGHT, 40).code
                assert code in (FeedbackCode.RESTRICTED, FeedbackCode.DISABLED)
                assert view.cockpit.commands() == before
