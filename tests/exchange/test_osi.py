"""A recorded trial as a trace of OSI ground truth, read back by the reader of asam-osi-utilities."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from automotive_cosim.contracts import LaneShape, RoadShapes, SeenVehicle, SumoSignal, Weather
from automotive_cosim.exchange.osi import trace_name, write_osi
from automotive_cosim.exchange.recording import Recording
from automotive_cosim.run.road import RoadRecord, Second

osi_utilities = pytest.importorskip("osi_utilities", reason="the extra safety is not installed")
pytest.importorskip("osi3", reason="the extra safety is not installed")

RADIUS_M, TURN_DEG = 100.0, 6.0
RAIN = Weather(12.0, 60.0, 4.0, 61, 100.0, 800.0, 5.0)
LANES = (
    LaneShape("", "road", 3.2, ((-300.0, 0.0), (0.0, 0.0), (50.0, 0.0)), (("c0", 1),)),
    LaneShape("", "bicycle", 1.5, ((50.0, -3.0), (-300.0, -3.0))),
    LaneShape("", "road", 3.2, ((2000.0, 0.0), (2100.0, 0.0))),
)


def circling(at_s):
    """A right-hand circle, past north, at a constant speed."""
    turned = math.radians(TURN_DEG * at_s)
    speed_mps = RADIUS_M * math.radians(TURN_DEG)
    x_m, y_m = 100 + RADIUS_M * math.sin(turned), 200 + RADIUS_M * math.cos(turned)
    return SeenVehicle("blue", "emergency", 6.0, 2.0, x_m, y_m, (90 + TURN_DEG * at_s) % 360, speed_mps, 2049)


def braking(at_s):
    return SeenVehicle("ego", "passenger", 4.5, 1.8, -50 + 20 * at_s - at_s**2, 0.4, 90.0, 20 - 2 * at_s, 8)


@pytest.fixture
def recording(tmp_path):
    """Ten seconds in which the car brakes towards a light, and an ambulance drives in a circle and leaves."""
    seconds = []
    for at_s in map(float, range(10)):
        seen = (braking(at_s), *((circling(at_s),) if at_s < 6 else ()))
        lights = {"c0": "Gu" if at_s < 5 else "GG"}
        clock = f"2026-01-05T23:59:{55 + int(at_s):02d}+01:00" if at_s < 5 else "2026-01-06T00:00:00+01:00"
        seconds.append(Second(at_s - 3, seen, lights, 10.0, (), clock, RAIN))
    return Recording(tmp_path, RoadRecord(RoadShapes(LANES, ()), tuple(seconds)), ())


def opened(path):
    reader = osi_utilities.MultiTraceReader() if path.suffix == ".mcap" else osi_utilities.SingleTraceReader()
    assert reader.open(path)
    return reader


@pytest.fixture(params=[".osi", ".mcap"])
def messages(request, recording, tmp_path):
    name = trace_name(recording) + request.param
    told = osi_utilities.parse_osi_trace_filename(name.replace(".mcap", ".osi"))
    assert (told["message_type"], told["number_of_frames"]) == (osi_utilities.MessageType.GROUND_TRUTH, 10)
    assert f"{told['timestamp']:%d %H:%M:%S}" == "05 22:59:55", "that of the first second, in UTC"
    write_osi(recording, tmp_path / name, tmp_path / "road.xodr")
    before = (tmp_path / name).read_bytes()
    write_osi(recording, tmp_path / name, tmp_path / "road.xodr")
    assert (tmp_path / name).read_bytes() == before
    with opened(tmp_path / name) as reader:
        read = list(reader)
    assert {each.message_type for each in read} == {osi_utilities.MessageType.GROUND_TRUTH}
    return [each.message for each in read]


def vehicles(message):
    return {each.source_reference[0].identifier[0]: each for each in message.moving_object}


def test_places_sizes_and_times_are_those_of_the_record(recording, messages):
    assert [osi_utilities.timestamp_to_seconds(each) for each in messages] == list(range(10))
    for second, message in zip(recording.road.seconds, messages, strict=True):
        found = vehicles(message)
        assert found.keys() == {each.vehicle_id for each in second.vehicles}
        for each in second.vehicles:
            base = found[each.vehicle_id].base
            ahead_m, yaw = base.dimension.length / 2, base.orientation.yaw
            front = base.position.x + ahead_m * math.cos(yaw), base.position.y + ahead_m * math.sin(yaw)
            assert math.dist(front, (each.x_m, each.y_m)) < 1e-6
            assert (base.dimension.length, base.dimension.width) == (each.length_m, each.width_m)
            assert math.hypot(base.velocity.x, base.velocity.y) == pytest.approx(each.speed_mps)
        host = next(each for each in message.moving_object if each.id.value == message.host_vehicle_id.value)
        assert host.source_reference[0].identifier == ["ego"]


def test_acceleration_and_turning_rate_follow_from_the_motion(messages):
    for message in messages:
        car = vehicles(message)["ego"].base
        assert (car.acceleration.x, car.acceleration.y) == (pytest.approx(-2), pytest.approx(0))
    for at_s in range(1, 5):
        base = vehicles(messages[at_s])["blue"].base
        towards = 100 - base.position.x, 200 - base.position.y
        rate = math.radians(TURN_DEG)
        assert base.orientation_rate.yaw == pytest.approx(-rate)
        assert math.hypot(base.acceleration.x, base.acceleration.y) == pytest.approx(RADIUS_M * rate**2, rel=0.01)
        assert base.acceleration.x * towards[0] + base.acceleration.y * towards[1] > 0


def test_classes_and_lamps(messages):
    car, blue = vehicles(messages[0])["ego"], vehicles(messages[0])["blue"]
    of, lamps = car.vehicle_classification, blue.vehicle_classification.light_state
    assert (of.type, of.role) == (of.TYPE_MEDIUM_CAR, of.ROLE_CIVIL)
    assert of.light_state.brake_light_state == of.light_state.BRAKE_LIGHT_STATE_NORMAL
    assert blue.vehicle_classification.role == of.ROLE_AMBULANCE
    assert lamps.indicator_state == lamps.INDICATOR_STATE_RIGHT
    assert lamps.emergency_vehicle_illumination == lamps.GENERIC_LIGHT_STATE_FLASHING_BLUE
    assert SumoSignal(2049) == SumoSignal.BLUE | SumoSignal.RIGHT


def test_lanes_have_their_borders_on_the_named_sides_and_the_host_has_its_own(messages):
    message = messages[0]
    lanes, borders = message.lane, {each.id.value: each for each in message.lane_boundary}
    assert len(lanes) == 2, "the third is out of sight"
    for lane, width_m in zip(lanes, (3.2, 1.5), strict=True):
        of = lane.classification
        begin, end = of.centerline[0], of.centerline[-1]
        for named, side in ((of.left_lane_boundary_id, 1), (of.right_lane_boundary_id, -1)):
            line = borders[named[0].value].boundary_line
            for middle, border in ((begin, line[0].position), (end, line[-1].position)):
                across = (end.x - begin.x) * (border.y - middle.y) - (end.y - begin.y) * (border.x - middle.x)
                assert math.copysign(1, across) == side
                assert math.dist((middle.x, middle.y), (border.x, border.y)) == pytest.approx(width_m / 2)
    road, cycle = (each.classification for each in lanes)
    assert (road.type, cycle.subtype) == (road.TYPE_DRIVING, cycle.SUBTYPE_BIKING)
    assert (road.is_host_vehicle_lane, cycle.is_host_vehicle_lane) == (True, False)
    (assigned,) = vehicles(message)["ego"].moving_object_classification.assigned_lane_id
    assert assigned.value == lanes[0].id.value


def test_lights_weather_and_time_of_day(messages):
    def lit(message):
        lamps = [each.classification for each in message.traffic_light]
        return {of.Color.Name(of.color) for of in lamps if of.mode == of.MODE_CONSTANT}

    assert (lit(messages[0]), lit(messages[-1])) == ({"COLOR_RED", "COLOR_YELLOW"}, {"COLOR_GREEN"})
    sky = messages[0].environmental_conditions
    assert (sky.precipitation, sky.fog) == (sky.PRECIPITATION_MODERATE, sky.FOG_LIGHT)
    assert [each.environmental_conditions.time_of_day.seconds_since_midnight for each in messages][4:6] == [
        86399,
        0,
    ]
    assert {each.map_reference for each in messages} == {"road.xodr"}


def test_no_two_things_share_an_id(messages):
    for message in messages:
        parts = message.moving_object, message.lane, message.lane_boundary, message.traffic_light
        ids = [each.id.value for part in parts for each in part]
        assert len(ids) == len(set(ids))


def test_a_record_without_lanes_or_weather_is_written(recording, tmp_path):
    seconds = tuple(replace(each, weather=None, local_time="") for each in recording.road.seconds)
    write_osi(replace(recording, road=RoadRecord(RoadShapes((), ()), seconds)), tmp_path / "trace_gt.osi")
    with opened(tmp_path / "trace_gt.osi") as reader:
        assert len(list(reader)) == len(seconds)
