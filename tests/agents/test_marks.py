"""The numbers on the picture are the indices of the list."""

from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.agents.marks import label, listed, marked, marks
from automotive_cosim.contracts import BoundingBox

WIDTH, HEIGHT = 320, 180


@pytest.fixture
def elements(button):
    boxes = [(0, 0, 90, 40), (100, 0, 200, 40), (300, 160, 320, 180), (100, 80, 100, 80), (0, 60, 90, 120)]
    made = [replace(button(f"e{n}"), bbox_pixels=BoundingBox(*box)) for n, box in enumerate(boxes)]
    made[1] = replace(made[1], is_visible=False)
    return tuple(made)


def read_back(picture: np.ndarray, left: int, top: int) -> list[int]:
    """The numbers whose drawing stands at that corner."""
    found = []
    for index in range(12):
        tag = np.array(label(index))
        there = picture[top : top + tag.shape[0], left : left + tag.shape[1]]
        if there.shape == tag.shape and np.array_equal(there, tag):
            found.append(index)
    return found


def test_each_visible_element_has_its_own_number_on_the_picture(elements):
    picture = marked(np.full((HEIGHT, WIDTH, 3), 40, np.uint8), elements)
    placed = marks(elements, WIDTH, HEIGHT)
    assert [mark.index for mark in placed] == [index for index, _ in listed(elements)] == [0, 2, 3, 4]
    for mark in placed:
        assert read_back(picture, mark.label.x_min, mark.label.y_min) == [mark.index]


def test_the_numbers_stand_inside_the_picture(elements):
    for mark in marks(elements, WIDTH, HEIGHT):
        assert 0 <= mark.label.x_min < mark.label.x_max <= WIDTH
        assert 0 <= mark.label.y_min < mark.label.y_max <= HEIGHT


def test_the_screenshot_itself_stays_as_it_is(elements):
    plain = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    plain.flags.writeable = False
    assert (marked(plain, elements) != plain).any()
    assert (plain == 40).all()
