"""Taps by pixel against values worked by hand."""

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.contracts import Action, ActionType, BoundingBox, Element
from automotive_cosim.run.figures import PixelTaps, margin_px, pixel_taps

BOX = BoundingBox(100, 100, 140, 120)


def _step(action: Action | None = None, *boxes: BoundingBox, clickable: bool = True) -> Any:
    elements = tuple(Element("", "", "Button", box, "", "", is_clickable=clickable) for box in boxes)
    return SimpleNamespace(action=action, elements=elements)


def _tap(x: int, y: int) -> Action:
    return Action(ActionType.CLICK, x=x, y=y)


@pytest.mark.parametrize(
    ("x", "y", "margin"),
    [
        (120, 110, 9.5),
        (100, 110, 0.5),
        (139, 110, 0.5),
        (140, 110, -0.5),
        (99, 110, -0.5),
        (143, 123, -(2**0.5) * 3.5),
    ],
)
def test_the_margin_of_a_pixel(x: int, y: int, margin: float) -> None:
    assert margin_px(BOX, x, y) == pytest.approx(margin)


@given(st.integers(80, 160), st.integers(80, 140))
def test_it_is_positive_exactly_inside(x: int, y: int) -> None:
    assert (margin_px(BOX, x, y) > 0) is (100 <= x < 140 and 100 <= y < 120)


def test_taps_count_against_what_was_seen_before_them() -> None:
    other = BoundingBox(300, 300, 310, 310)
    steps = [_step(None, BOX), _step(_tap(120, 110), other), _step(_tap(120, 110), BOX), _step(_tap(305, 305))]
    taps = pixel_taps(steps)
    assert taps is not None
    assert (taps.count, taps.hits) == (3, 1)


def test_taps_by_index_and_other_actions_do_not_count() -> None:
    steps = [_step(None, BOX), _step(Action(ActionType.CLICK, index=0), BOX), _step(Action(ActionType.WAIT), BOX)]
    assert pixel_taps(steps) is None


def test_what_cannot_be_clicked_is_no_target() -> None:
    label = _step(None, BOX, clickable=False)
    label.elements += _step(None, BoundingBox(200, 100, 240, 120)).elements
    assert pixel_taps([label, _step(_tap(120, 110))]) == PixelTaps(1, 0, -79.5)
