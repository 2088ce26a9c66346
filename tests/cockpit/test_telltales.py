"""Tell-tales and the last sign: each state has its picture, and the list says the same in words."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.notices import NAMES, lit
from automotive_cosim.cockpit.signals import ADAS, CABIN, ENERGY, HMI, LIGHTS, OUTSIDE, SEAT, TYRE
from automotive_cosim.cockpit.telltales import RoadSign, SignKind, Telltale, sign_picture, symbol
from automotive_cosim.contracts import Element, Limit, LimitSource, Surroundings
from automotive_cosim.contracts.ids import key_of
from tests.cockpit.fingers import find

from .conftest import View

CAUSES = {
    Telltale.BELT: {SEAT.DRIVER_BELT.path: False},
    Telltale.DOOR: {CABIN.TRUNK.path: True},
    Telltale.BATTERY: {ENERGY.LEVEL.path: 9.0},
    Telltale.HAZARD: {LIGHTS.HAZARD.path: True},
    Telltale.TYRE: {TYRE.REAR_LEFT.path: 150.0},
    Telltale.STABILITY: {ADAS.STABILITY_CONTROL.path: False},
    Telltale.FROST: {OUTSIDE.TEMPERATURE.path: -2.0},
    Telltale.HIGH_BEAM: {LIGHTS.HIGH_BEAM.path: True},
    Telltale.LOW_BEAM: {LIGHTS.LOW_BEAM.path: True},
    Telltale.POSITION: {LIGHTS.POSITION.path: True},
    Telltale.FRONT_FOG: {LIGHTS.FRONT_FOG.path: True},
    Telltale.REAR_FOG: {LIGHTS.REAR_FOG.path: True},
}
MASTER = {Telltale.BATTERY, Telltale.TYRE, Telltale.DOOR}


@pytest.mark.parametrize("telltale", CAUSES)
def test_a_telltale_lights_up_on_the_picture_and_is_named_in_the_list(cockpit: Cockpit, telltale: Telltale) -> None:
    for path, value in CAUSES[Telltale.BELT].items():
        cockpit.inject(path, not value)
    assert lit(cockpit._state) == ()
    dark, listed = cockpit.screenshot(), pictures(cockpit)
    for path, value in CAUSES[telltale].items():
        cockpit.inject(path, value)
    expected = {telltale} | ({Telltale.WARNING} if telltale in MASTER else set())
    assert set(lit(cockpit._state)) == expected
    assert (dark[:64, 216:371] != cockpit.screenshot()[:64, 216:371]).any()
    told = {each.content_description for each in pictures(cockpit)} - {each.content_description for each in listed}
    assert told == {f"Dashboard lights: {', '.join(NAMES[each] for each in Telltale if each in expected)}"}


def pictures(cockpit: Cockpit) -> list[Element]:
    wanted = ("status.telltales", "home.telltales")
    return [each for each in cockpit.elements() if key_of(each.resource_id) in wanted]


def test_every_symbol_and_sign_has_a_shape_of_its_own() -> None:
    drawn = [symbol(telltale, 28).tobytes() for telltale in Telltale]
    signs = [sign_picture(kind, "", 64).tobytes() for kind in SignKind]
    assert len(set(drawn)) == len(Telltale)
    assert len(set(signs)) == len(SignKind)
    assert all(20 < np.count_nonzero(symbol(telltale, 28)) < 600 for telltale in Telltale)
    assert sign_picture(SignKind.LIMIT, "50", 64).tobytes() != sign_picture(SignKind.LIMIT, "80", 64).tobytes()


def test_the_last_sign_is_the_one_passed_last(make: Callable[..., Cockpit], around: Surroundings) -> None:
    cockpit = make()
    assert cockpit._state.last_sign == RoadSign(SignKind.LIMIT, 50.0)
    here = around.driving.road
    no_limit = Limit(None, LimitSource.POSTED)
    drive = (
        (replace(here, in_tunnel=True), RoadSign(SignKind.TUNNEL)),
        (here, RoadSign(SignKind.TUNNEL)),
        (replace(here, limit=Limit(30 / 3.6, LimitSource.POSTED)), RoadSign(SignKind.LIMIT, 30.0)),
        (replace(here, limit=no_limit), RoadSign(SignKind.END_OF_LIMIT)),
        (replace(here, limit=no_limit, school_zone=True), RoadSign(SignKind.SCHOOL)),
    )
    seen = []
    for road, sign in drive:
        cockpit.sense(replace(around, driving=replace(around.driving, road=road)), 1.0)
        assert cockpit._state.last_sign == sign
        seen.append(find(cockpit, "home.sign").content_description)
    words = ("Tunnel", "Tunnel", "Limit sign 30", "End of limit", "School zone")
    assert seen == [f"Last sign: {word}" for word in words]


def test_without_the_camera_there_is_no_sign(make: Callable[..., Cockpit]) -> None:
    cockpit = make(sign_camera=False)
    assert cockpit._state.last_sign is None
    keys = {key_of(each.resource_id) for each in cockpit.elements()}
    assert "home.telltales" in keys
    assert "home.sign" not in keys


FIGURES = {"km/h": (50 / 3.6, "50"), "mph": (30 * 0.44704, "30")}


@pytest.mark.slow
def test_a_sign_shows_its_own_figure_on_every_screen(
    cockpit: Cockpit, around: Surroundings, walker: Callable[[Cockpit], tuple[View, ...]]
) -> None:
    for view, signed, shown in product(walker(cockpit), FIGURES, FIGURES):
        limit_mps, figure = FIGURES[signed]
        there = replace(around.driving.road, limit=Limit(limit_mps, LimitSource.POSTED))
        view.cockpit.inject(HMI.DISTANCE_UNIT.path, "MILES" if shown == "mph" else "KILOMETERS")
        view.cockpit.sense(replace(around, driving=replace(around.driving, road=there), sign_unit=signed), 1.0)
        words = figure if signed == shown else f"{figure} {signed}"
        elements = {key_of(each.resource_id): each for each in view.cockpit.elements()}
        plate = elements["status.limit_sign"]
        assert (plate.text, plate.content_description) == (figure, f"Limit sign {words}"), view.name
        for key in elements.keys() & {"home.sign", "map.sign"}:
            assert elements[key].content_description == f"Last sign: Limit sign {words}", view.name
