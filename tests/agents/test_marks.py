"""The numbers on the picture are the indices of the list."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from automotive_cosim.agents.marks import Leaps, label, listed, marked, marks, overlap
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.contracts import BoundingBox

from ..cockpit.conftest import outside, town

WIDTH, HEIGHT = 320, 180
PLAIN = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)


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
    picture = marked(PLAIN, elements)
    placed = marks(PLAIN, elements)
    assert [mark.index for mark in placed] == [index for index, _ in listed(elements)] == [0, 2, 3, 4]
    for mark in placed:
        assert read_back(picture, mark.label.x_min, mark.label.y_min) == [mark.index]


def test_the_numbers_stand_inside_the_picture(elements):
    for mark in marks(PLAIN, elements):
        assert 0 <= mark.label.x_min < mark.label.x_max <= WIDTH
        assert 0 <= mark.label.y_min < mark.label.y_max <= HEIGHT


def test_the_screenshot_itself_stays_as_it_is(elements):
    plain = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    plain.flags.writeable = False
    assert (marked(plain, elements) != plain).any()
    assert (plain == 40).all()


@pytest.mark.slow
def test_on_every_screen_numbers_stand_beside_their_boxes_and_cover_no_letter_and_no_other_number():
    """By day and by night in turn."""
    cockpit = Cockpit(town(), rng=np.random.default_rng(1))
    for number, screen in enumerate(pages()):
        cockpit.sense(outside(sun_elevation_deg=-20.0 if number % 2 else 40.0), 0.0)
        cockpit.visit(screen)
        shot = cockpit.screenshot()
        ink, placed = Leaps(shot), marks(shot, cockpit.elements())
        assert len(placed) > 20
        assert not [mark for mark in placed if overlap(mark.label, mark.box)], screen
        assert not [mark for mark in placed if ink.under(mark.label)], screen
        assert not [pair for pair in combinations(placed, 2) if overlap(pair[0].label, pair[1].label)], screen
