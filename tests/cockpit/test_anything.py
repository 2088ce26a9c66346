"""The cockpit under fingers that do anything, with any text."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import apps, apps_in, pages
from automotive_cosim.cockpit.render import render
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    Answer,
    Direction,
    FeedbackCode,
    RoadNetwork,
    Severity,
    Surroundings,
)

SIZES = tuple(ScreenSize)
DIRECTIONS = tuple(Direction)


def is_sound(cockpit: Cockpit) -> None:
    """Every signal legal, every widget on the screen."""
    for signal in cockpit.signals:
        assert signal.check(cockpit.signals[signal]) == cockpit.signals[signal]
    for widget in cockpit.tree.walk():
        assert cockpit.size.whole.encloses(widget.rect), f"{cockpit.screen}: {widget.key}"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "touches"),
    [(seed, 1000) for seed in range(3)] + [pytest.param(seed, 5000, marks=pytest.mark.proof) for seed in range(20)],
)
def test_thousands_of_touches_break_nothing(
    network: RoadNetwork, outdoors: Callable[..., Surroundings], seed: int, touches: int
) -> None:
    rng = np.random.default_rng(seed)
    now, names, visited = outdoors(), tuple(apps()), set()
    cockpit = Cockpit(network, rng=rng, size=SIZES[seed % 3])
    cockpit.sense(now, 0.0)
    for touch in range(touches):
        x, y = int(rng.integers(-20, cockpit.size.width + 20)), int(rng.integers(-20, cockpit.size.height + 20))
        way, kind = DIRECTIONS[int(rng.integers(4))], rng.random()
        if kind < 0.6:
            feedback = cockpit.tap(x, y)
        elif kind < 0.75:
            feedback = cockpit.swipe(x, y, way)
        elif kind < 0.85:
            feedback = cockpit.scroll(None, way)
        elif kind < 0.9:
            feedback = cockpit.type_text(chr(int(rng.integers(32, 0xD7FF))) * int(rng.integers(1, 5)))
        elif kind < 0.92:
            feedback = cockpit.back()
        else:
            feedback = rng.choice([cockpit.double_tap, cockpit.long_press])(x, y)  # type: ignore[arg-type]
        assert feedback.text
        visited.add(cockpit.screen)
        if touch % 20 == 0:
            cockpit.open_app(names[touch // 20 % len(names)])
        if touch % 50 == 0:
            speed_mps, time_s = float(rng.choice([0.0, 5.0, 14.0])), now.driving.time_s + 1
            driving = replace(now.driving, speed_mps=speed_mps, time_s=time_s)
            now = replace(now, driving=driving, sun_elevation_deg=float(rng.uniform(-30, 30)))
            cockpit.sense(now, 1.0)
            is_sound(cockpit)
            for request in cockpit.drain_requests():
                cockpit.answered(request, Answer(bool(rng.integers(2)), "So it is."))
        if touch % 200 == 0:
            inks = render(cockpit.tree).inks
            assert all(cockpit.size.whole.encloses(ink.rect) for ink in inks), cockpit.screen
    assert visited >= {app.name for app in apps_in(Where.DOCK)}


@pytest.mark.slow
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.text(max_size=200), screen=st.sampled_from(sorted(pages())), clear=st.booleans())
def test_any_text_can_be_typed_shown_and_said(
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
            assert cockpit.type_text(text, clear).code is FeedbackCode.OK
    cockpit.key_enter()
    cockpit.open_app(text)
    cockpit.alert(Alert(AlertKind.WEATHER, Severity.INFO, text))
    is_sound(cockpit)
    assert all(cockpit.size.whole.encloses(ink.rect) for ink in render(cockpit.tree).inks)
    assert all(len(element.text) <= 240 for element in cockpit.elements())
