"""The cockpit under fingers that do anything, with any text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.render import render
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import Direction, RoadNetwork, Surroundings

SIZES = tuple(ScreenSize)
SEEDS, TOUCHES = 20, 5000
DIRECTIONS = tuple(Direction)


def is_sound(cockpit: Cockpit) -> None:
    """Every signal legal, every widget on the screen."""
    for signal in cockpit.signals:
        assert signal.check(cockpit.signals[signal]) == cockpit.signals[signal]
    for widget in cockpit.tree.walk():
        assert cockpit.size.whole.encloses(widget.rect), f"{cockpit.screen}: {widget.key}"


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(SEEDS))
def test_a_hundred_thousand_touches_break_nothing(
    network: RoadNetwork, outdoors: Callable[..., Surroundings], seed: int
) -> None:
    rng = np.random.default_rng(seed)
    now = outdoors()
    cockpit = Cockpit(network, rng=rng, size=SIZES[seed % 3])
    cockpit.sense(now, 0.0)
    for touch in range(TOUCHES):
        x, y = int(rng.integers(cockpit.size.width)), int(rng.integers(cockpit.size.height))
        kind = rng.random()
        if kind < 0.7:
            cockpit.tap(x, y)
        elif kind < 0.9:
            cockpit.swipe(x, y, DIRECTIONS[int(rng.integers(4))])
        elif kind < 0.95:
            cockpit.type_text(chr(int(rng.integers(32, 0xD7FF))) * int(rng.integers(1, 5)))
        else:
            rng.choice([cockpit.double_tap, cockpit.long_press])(x, y)  # type: ignore[arg-type]
        if touch % 50 == 0:
            speed_mps = float(rng.choice([0.0, 14.0]))
            now = replace(now, driving=replace(now.driving, speed_mps=speed_mps, time_s=now.driving.time_s + 1))
            cockpit.sense(now, 1.0)
            is_sound(cockpit)
        if touch % 500 == 0:
            inks = render(cockpit.tree).inks
            assert all(cockpit.size.whole.encloses(ink.rect) for ink in inks), cockpit.screen
            cockpit.drain_requests()


@pytest.mark.slow
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.text(max_size=200), screen=st.sampled_from(sorted(pages())), clear=st.booleans())
def test_any_text_can_be_typed_and_drawn(
    network: RoadNetwork, outdoors: Callable[..., Surroundings], text: str, screen: str, clear: bool
) -> None:
    cockpit = Cockpit(network, rng=np.random.default_rng(1))
    standing = outdoors()
    cockpit.sense(replace(standing, driving=replace(standing.driving, speed_mps=0.0)), 0.0)
    cockpit.visit(screen)
    for element in cockpit.elements():
        if element.is_editable:
            box = element.bbox_pixels
            cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2)
            cockpit.type_text(text, clear)
    cockpit.key_enter()
    is_sound(cockpit)
    assert all(cockpit.size.whole.encloses(ink.rect) for ink in render(cockpit.tree).inks)
