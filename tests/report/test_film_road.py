"""The film's road shows what was recorded, where it was."""

from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.cockpit.drawing import Canvas
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.contracts import GroundArea, GroundKind, LaneShape, RoadNetwork, RoadShapes, SeenVehicle
from automotive_cosim.report import filmroad
from automotive_cosim.report.filmroad import DAILY, LIGHTS, METRES_PER_PIXEL, NIGHTLY, RoadPainter
from automotive_cosim.run.road import EMPTY, RoadRecord, Second
from automotive_cosim.run.timeline import Sample

AREA = Rect(0, 0, 400, 400)
LANE = LaneShape("a_0", "road", 3.2, ((0.0, -200.0), (0.0, 40.0)), (("light", 1),))


def drawn(record: RoadRecord) -> np.ndarray:
    canvas = Canvas.plain(400, 400, 1.0, (0, 0, 0))
    painter = RoadPainter(record, RoadMap(RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False)))
    painter.draw(canvas, AREA, [Sample(0.0, 50.0, 50.0, "", 0.0, 0.0, 0.0)], ())
    return canvas.pixels()


def record(*vehicles: SeenVehicle, state: str = "Gr", sun_deg: float = 30.0, incidents=()) -> RoadRecord:
    ego = SeenVehicle("ego", "passenger", 4.5, 1.8, 0.0, 0.0, 0.0, 10.0, 0)
    return RoadRecord(
        RoadShapes((LANE,), ()), (Second(0.0, (ego, *vehicles), {"light": state}, sun_deg, incidents),)
    )


def with_ground(given: RoadRecord) -> RoadRecord:
    water = GroundArea(GroundKind.WATER, ((-30.0, 0.0), (30.0, 0.0), (30.0, 40.0), (-30.0, 40.0)))
    return replace(given, shapes=replace(given.shapes, ground=(water,)))


def pixel(picture: np.ndarray, x_m: float, y_m: float) -> tuple[int, ...]:
    x, y = 200 + x_m / METRES_PER_PIXEL, 400 * 0.68 - y_m / METRES_PER_PIXEL
    return tuple(picture[round(y), round(x)].tolist())


def car(heading_deg: float = 0.0, signals: int = 0, kind: str = "passenger") -> SeenVehicle:
    return SeenVehicle("other", kind, 5.0, 1.8, 0.0, 30.0, heading_deg, 5.0, signals)


def test_another_car_is_drawn_behind_its_front_bumper_at_its_angle():
    without, northward = drawn(record()), drawn(record(car()))
    assert pixel(northward, 0.0, 27.5) == DAILY.vehicle
    assert pixel(without, 0.0, 27.5) == DAILY.road
    eastward = drawn(record(car(90.0)))
    assert pixel(eastward, -2.5, 30.0) == DAILY.vehicle
    assert pixel(eastward, 0.0, 27.5) == DAILY.road


@pytest.mark.parametrize(("signals", "where"), [(8, (0.5, 25.0)), (1, (0.8, 25.4)), (2, (-0.8, 25.4))])
def test_brake_lights_and_indicators_show(signals, where):
    lit, dark = drawn(record(car(signals=signals))), drawn(record(car()))
    assert pixel(lit, *where) != pixel(dark, *where)


def test_a_stop_line_has_the_colour_of_its_light():
    for state, letter in (("rG", "G"), ("Gy", "y"), ("Gr", "r")):
        assert pixel(drawn(record(state=state)), 0.0, 40.0) == LIGHTS[letter]


def test_night_is_dark_and_a_bus_is_not_a_car():
    assert pixel(drawn(record(sun_deg=-20.0)), 20.0, 20.0) == NIGHTLY.land
    assert pixel(drawn(record(car(kind="bus"))), 0.0, 27.5) == DAILY.heavy


def test_the_ground_lies_under_the_lanes():
    for sun_deg, colours in ((30.0, DAILY), (-20.0, NIGHTLY)):
        picture = drawn(with_ground(record(sun_deg=sun_deg)))
        assert pixel(picture, 20.0, 20.0) == colours.ground[GroundKind.WATER]
        assert pixel(picture, 0.0, 20.0) == colours.road
        assert pixel(picture, 20.0, -10.0) == colours.land


def test_incidents_show():
    assert not np.array_equal(drawn(record()), drawn(record(incidents=(("breakdown", 0.0, 30.0),))))


def test_without_a_record_the_car_is_still_drawn():
    assert pixel(drawn(EMPTY), 0.0, -2.0) == filmroad.NIGHT.accent
