"""A recorded trial as a trace of ASAM OSI ground truth: a ``GroundTruth`` message for each recorded second.

Messages have the car and every recorded vehicle with place, size, motion, class and lamps, the lanes and the lamps
of traffic lights around the car, and the weather. Time 0 is the first recorded second, coordinates are the
network's (x to the east, y to the north). OSI places a vehicle by the middle of its bounding box, SUMO by its front
bumper.
Velocity and heading are SUMO's, acceleration and turning rate follow from the seconds before and after.

A trace is a file of OSI's own (``.osi``) or one of MCAP (``.mcap``), which says what is in it. Names are those that
OSI recommends, from which readers of ``.osi`` take the kind of its messages.
"""

from __future__ import annotations

import errno
import tempfile
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from shapely import LineString, Point, STRtree

from automotive_cosim.contracts import LaneShape, SeenVehicle, SumoSignal, Weather
from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.exchange.bodies import GAP_S, REAR_AXLE, WHEEL_M, heading_rad, height_m, place_at
from automotive_cosim.exchange.openscenario import FULL, KELVIN, OKTAS
from automotive_cosim.exchange.recording import Recording
from automotive_cosim.formats.writing import copy
from automotive_cosim.run.road import Second

NEEDS = f"OSI traces need the extra safety: {install_hint('safety')}"
AROUND_M = 200.0
"""Lanes and traffic lights within this distance of the car are in a message: our choice, as each repeats them."""
SHARPEST = 0.25
"""Least cosine of half a bend by which a lane's border is moved outwards, so that a hairpin has no spike."""
CLASSES = {
    "bicycle": "BICYCLE", "bus": "BUS", "coach": "BUS", "motorcycle": "MOTORBIKE", "moped": "MOTORBIKE",
    "truck": "HEAVY_TRUCK", "trailer": "HEAVY_TRUCK", "delivery": "DELIVERY_VAN", "emergency": "VAN",
    "tram": "TRAM", "rail": "TRAIN", "rail_urban": "TRAIN", "rail_electric": "TRAIN", "rail_fast": "TRAIN",
}  # fmt: skip
"""SUMO's vehicle class -> OSI's type; any other is a medium-sized car."""
ROLES = {"emergency": "AMBULANCE", "bus": "PUBLIC_TRANSPORT", "tram": "PUBLIC_TRANSPORT"}
LANES = {
    "road": ("DRIVING", "NORMAL"), "bus": ("DRIVING", "RESTRICTED"), "bicycle": ("NONDRIVING", "BIKING"),
    "foot": ("NONDRIVING", "SIDEWALK"),
}  # fmt: skip
"""``LaneShape.kind`` -> OSI's type and subtype of a lane; any other is ``OTHER``."""
RAIN_MM_H = (0.1, 0.5, 1.9, 8.1, 34.0, 149.0)
RAINS = ("NONE", "VERY_LIGHT", "LIGHT", "MODERATE", "HEAVY", "VERY_HEAVY", "EXTREME")
FOG_M = (50.0, 200.0, 1000.0, 2000.0, 4000.0, 10_000.0, 40_000.0)
FOGS = (
    "DENSE", "THICK", "LIGHT", "MIST", "POOR_VISIBILITY", "MODERATE_VISIBILITY", "GOOD_VISIBILITY",
    "EXCELLENT_VISIBILITY",
)  # fmt: skip
"""Bounds and names of OSI's classes of precipitation and fog (osi_environment.proto)."""
BULBS = {"RED": ("ru", 3.0), "YELLOW": ("yuo", 2.7), "GREEN": ("g", 2.4)}
"""Colour -> SUMO's letters, in lower case, under which it is lit, and its height in metres, our choice."""
FLASHING = "o"
BULB_M = 0.2


def trace_name(recording: Recording) -> str:
    """The name that OSI recommends, without its end: time of the first second, kind, versions, number of messages.

    Raises SetupError: the extra ``safety`` is not installed."""
    osi, protobuf = (version.replace(".", "") for version in _versions())
    begins = recording.road.seconds[0].local_time
    at = datetime.fromisoformat(begins).astimezone(UTC) if begins else datetime.fromtimestamp(0, UTC)
    return f"{at:%Y%m%dT%H%M%SZ}_gt_{osi}_{protobuf}_{len(recording.road.seconds)}_trial"


def write_osi(recording: Recording, target: Path, road: Path | None = None) -> None:
    """Writes a trial as a trace; the same record gives the same bytes.

    Args:
        target: the file, ``*_gt_*.osi`` or ``*.mcap``.
        road: the road's OpenDRIVE file, which the messages then name.

    Raises:
        SetupError: the extra ``safety`` is not installed.
        OSError: it cannot be written.
    """
    osi, protobuf = _versions()
    from osi_utilities import MultiTraceWriter, SingleTraceWriter

    messages = _Messages(recording, "" if road is None else road.name)
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-osi-") as scratch:
        made = Path(scratch) / target.name  # its library takes no open file
        trace: Any = MultiTraceWriter() if target.suffix == ".mcap" else SingleTraceWriter()
        with trace:
            about = {
                "version": osi,
                "zero_time": recording.road.seconds[0].local_time,
                "description": recording.title,
            }
            for end in ("min", "max"):
                about |= {f"{end}_osi_version": osi, f"{end}_protobuf_version": protobuf}
            if not (trace.open(made, about) if target.suffix == ".mcap" else trace.open(made)):
                raise OSError(errno.EIO, "its library cannot write it", str(target))
            if target.suffix == ".mcap":
                channel = {"osi_version": osi, "protobuf_version": protobuf, "description": recording.title}
                named = {f"net.asam.osi.trace.channel.{name}": value for name, value in channel.items()}
                trace.add_channel("GroundTruth", messages.truth, named)
            if not all(map(trace.write_message, messages)):
                raise OSError(errno.EIO, "its library cannot write it", str(target))
        copy(made, target, made.stat().st_size)


def _versions() -> tuple[str, str]:
    """Of OSI's messages, and of the package that writes them.

    Raises SetupError: the extra ``safety`` is not installed."""
    try:
        import osi_utilities  # noqa: F401, whether it is there
        from google import protobuf
        from osi3 import osi_version_pb2
    except ImportError as error:
        raise SetupError(NEEDS) from error
    options: Any = osi_version_pb2.DESCRIPTOR.GetOptions()
    osi = options.Extensions[osi_version_pb2.current_interface_version]
    return f"{osi.version_major}.{osi.version_minor}.{osi.version_patch}", protobuf.__version__


@dataclass(frozen=True, slots=True)
class _Motion:
    """How a vehicle's motion changes."""

    acceleration_mps2: tuple[float, float]
    """To the east and to the north."""
    turning_radps: float


class _Messages:
    """The messages of a record, in order."""

    def __init__(self, recording: Recording, road: str) -> None:
        from osi3 import (
            osi_groundtruth_pb2,
            osi_lane_pb2,
            osi_object_pb2,
            osi_trafficlight_pb2,
            osi_version_pb2,
        )

        self.truth = osi_groundtruth_pb2.GroundTruth
        self._vehicle = osi_object_pb2.MovingObject
        self._light = osi_trafficlight_pb2.TrafficLight
        options: Any = osi_version_pb2.DESCRIPTOR.GetOptions()
        self._version = options.Extensions[osi_version_pb2.current_interface_version]
        self._recording, self._road = recording, road
        seen = {each.vehicle_id: None for second in recording.road.seconds for each in second.vehicles}
        self._ids = {vehicle_id: number for number, vehicle_id in enumerate(seen, 1)}
        self._lanes = _Lanes(recording.road.shapes.lanes, len(self._ids) + 1, osi_lane_pb2)

    def __iter__(self) -> Iterator[Any]:
        seconds = self._recording.road.seconds
        for number, second in enumerate(seconds):
            around = seconds[max(0, number - 1) : number + 2]
            yield self._message(second, _motions(around))

    def _message(self, second: Second, motions: Mapping[str, _Motion]) -> Any:
        made = self.truth()
        made.version.CopyFrom(self._version)
        _stamp(made.timestamp, second.at_s - self._recording.begin_s)
        made.map_reference = self._road
        if second.weather is not None:
            _weather(made.environmental_conditions, second.weather, second.local_time)
        ego = next((each for each in second.vehicles if each.vehicle_id == "ego"), None)
        middles = [place_at(each, 0.5) for each in second.vehicles]
        on = self._lanes.under(middles)
        for vehicle, middle, lane in zip(second.vehicles, middles, on, strict=True):
            self._add(made.moving_object.add(), vehicle, middle, motions.get(vehicle.vehicle_id))
            if lane is not None:
                assigned = made.moving_object[-1].moving_object_classification.assigned_lane_id
                assigned.add().value = self._lanes.first_id + 3 * lane
        if ego is None:
            return made
        made.host_vehicle_id.value = self._ids["ego"]
        near = self._lanes.near(ego.x_m, ego.y_m)
        made.lane.extend(self._lanes.lanes[number] for number in near)
        made.lane_boundary.extend(border for number in near for border in self._lanes.borders[number])
        own = on[second.vehicles.index(ego)]
        if own in near:
            made.lane[near.index(own)].classification.is_host_vehicle_lane = True
        for number in near:
            self._lights(made.traffic_light, number, second.lights)
        return made

    def _add(self, made: Any, vehicle: SeenVehicle, middle: tuple[float, float], motion: _Motion | None) -> None:
        kinds, heading, tall_m = self._vehicle, heading_rad(vehicle), height_m(vehicle)
        east, north = cos(heading), sin(heading)
        made.id.value = self._ids[vehicle.vehicle_id]
        source = made.source_reference.add()
        source.type = "org.eclipse.sumo"
        source.identifier.append(vehicle.vehicle_id)
        base = made.base
        base.dimension.length, base.dimension.width, base.dimension.height = (
            vehicle.length_m,
            vehicle.width_m,
            tall_m,
        )
        _vector(base.position, *middle, tall_m / 2)
        _angles(base.orientation, _turn(heading))
        _vector(base.velocity, vehicle.speed_mps * east, vehicle.speed_mps * north)
        if motion is not None:
            _vector(base.acceleration, *motion.acceleration_mps2)
            _angles(base.orientation_rate, motion.turning_radps)
        if vehicle.kind == "pedestrian":
            made.type = kinds.TYPE_PEDESTRIAN
            return
        made.type = kinds.TYPE_VEHICLE
        rear_m = (0.5 - REAR_AXLE) * vehicle.length_m
        _vector(made.vehicle_attributes.bbcenter_to_rear, rear_m, 0.0, WHEEL_M / 2 - tall_m / 2)
        of = made.vehicle_classification
        of.type = of.Type.Value(f"TYPE_{CLASSES.get(vehicle.kind, 'MEDIUM_CAR')}")
        of.role = of.Role.Value(f"ROLE_{ROLES.get(vehicle.kind, 'CIVIL')}")
        lamps, shows = of.light_state, SumoSignal(vehicle.signals)
        right, left = SumoSignal.RIGHT in shows, SumoSignal.LEFT in shows
        blinks = "WARNING" if SumoSignal.HAZARD in shows or (right and left) else ""
        blinks = blinks or ("RIGHT" if right else "LEFT" if left else "OFF")
        lamps.indicator_state = lamps.IndicatorState.Value(f"INDICATOR_STATE_{blinks}")
        brakes = "NORMAL" if SumoSignal.BRAKE in shows else "OFF"
        lamps.brake_light_state = lamps.BrakeLightState.Value(f"BRAKE_LIGHT_STATE_{brakes}")
        if vehicle.kind == "emergency":
            blue = "FLASHING_BLUE" if SumoSignal.BLUE in shows else "OFF"
            lamps.emergency_vehicle_illumination = lamps.GenericLightState.Value(f"GENERIC_LIGHT_STATE_{blue}")

    def _lights(self, made: Any, number: int, states: Mapping[str, str]) -> None:
        """The lamps at the end of a lane: three for each of its links."""
        lane = self._lanes.shapes[number]
        (x_m, y_m), (ahead_x, ahead_y) = lane.line_m[-1], lane.line_m[-2]
        facing = float(np.arctan2(ahead_y - y_m, ahead_x - x_m))
        for link, (light, place) in enumerate(lane.links):
            letter = states.get(light, "")[place : place + 1]
            for bulb, (colour, (lit, up_m)) in enumerate(BULBS.items()):
                each = made.add()
                each.id.value = self._lanes.bulb_ids[number] + len(BULBS) * link + bulb
                size = each.base.dimension
                size.length = size.width = size.height = BULB_M
                _vector(each.base.position, x_m, y_m, up_m)
                _angles(each.base.orientation, facing)
                of = each.classification
                of.color = of.Color.Value(f"COLOR_{colour}")
                of.icon = of.ICON_NONE
                mode = "OFF" if not letter or letter.lower() not in lit else "CONSTANT"
                mode = "FLASHING" if mode == "CONSTANT" and letter == FLASHING else mode
                of.mode = of.Mode.Value(f"MODE_{mode}")
                of.assigned_lane_id.add().value = self._lanes.first_id + 3 * number


class _Lanes:
    """Every lane that the record has seen, and its two borders, made once."""

    def __init__(self, shapes: Sequence[LaneShape], first_id: int, kinds: Any) -> None:
        self.shapes, self.first_id = shapes, first_id
        self.lanes: list[Any] = []
        self.borders: list[tuple[Any, Any]] = []
        self.bulb_ids: list[int] = []
        """Of the first bulb of each lane."""
        next_id = first_id + 3 * len(shapes)
        for number, shape in enumerate(shapes):
            made, (kind, subtype) = kinds.Lane(), LANES.get(shape.kind, ("OTHER", "OTHER"))
            made.id.value = first_id + 3 * number
            of = made.classification
            of.type, of.subtype = of.Type.Value(f"TYPE_{kind}"), of.Subtype.Value(f"SUBTYPE_{subtype}")
            of.centerline_is_driving_direction, of.is_host_vehicle_lane = True, False
            for x_m, y_m in shape.line_m:
                _vector(of.centerline.add(), x_m, y_m)
            sides = []
            for step, (side, named) in enumerate(
                ((1.0, of.left_lane_boundary_id), (-1.0, of.right_lane_boundary_id)), 1
            ):
                border = kinds.LaneBoundary()
                named.add().value = border.id.value = made.id.value + step
                border.classification.type = border.classification.TYPE_OTHER
                border.classification.color = border.classification.COLOR_OTHER
                for x_m, y_m in _beside(shape.line_m, side * shape.width_m / 2):
                    _vector(border.boundary_line.add().position, x_m, y_m)
                sides.append(border)
            self.lanes.append(made)
            self.borders.append((sides[0], sides[1]))
            self.bulb_ids.append(next_id)
            next_id += len(BULBS) * len(shape.links)
        self._widths_m = np.array([shape.width_m for shape in shapes])
        self._tree = STRtree([LineString(shape.line_m) for shape in shapes])

    def near(self, x_m: float, y_m: float) -> list[int]:
        """The lanes around a place, in the record's order."""
        return sorted(self._tree.query(Point(x_m, y_m), predicate="dwithin", distance=AROUND_M).tolist())

    def under(self, places: Sequence[tuple[float, float]]) -> list[int | None]:
        """The lane on which each place is; None in junctions and beside the road."""
        found: list[int | None] = [None] * len(places)
        if not self.shapes or not places:
            return found
        (inputs, lanes), away_m = self._tree.query_nearest(
            [Point(place) for place in places], return_distance=True, all_matches=False
        )
        for number, lane, off_m in zip(inputs.tolist(), lanes.tolist(), away_m.tolist(), strict=True):
            if off_m <= self._widths_m[lane] / 2:
                found[number] = lane
        return found


def _beside(line: Sequence[tuple[float, float]], left_m: float) -> list[tuple[float, float]]:
    """A line at a distance to the left of another, with as many points."""
    points = np.array(line)
    steps = np.diff(points, axis=0)
    ahead = steps / np.maximum(np.hypot(steps[:, 0], steps[:, 1]), 1e-9)[:, None]
    before, after = np.vstack((ahead[:1], ahead)), np.vstack((ahead, ahead[-1:]))
    middle = before + after
    middle /= np.maximum(np.hypot(middle[:, 0], middle[:, 1]), 1e-9)[:, None]
    stretch = np.maximum(SHARPEST, (middle * after).sum(axis=1))[:, None]
    moved = points + left_m * np.column_stack((-middle[:, 1], middle[:, 0])) / stretch
    return [(round(x_m, 3), round(y_m, 3)) for x_m, y_m in moved.tolist()]


def _motions(around: Sequence[Second]) -> dict[str, _Motion]:
    """The changes of each vehicle's motion over a second and its neighbours, as far as they follow closely."""
    ends: dict[str, tuple[float, SeenVehicle, float, SeenVehicle]] = {}
    for before, now in pairwise(around):
        if now.at_s - before.at_s > GAP_S:
            continue
        later = {each.vehicle_id: each for each in now.vehicles}
        for each in before.vehicles:
            if each.vehicle_id in later:
                first_s, first = ends.get(each.vehicle_id, (before.at_s, each))[:2]
                ends[each.vehicle_id] = first_s, first, now.at_s, later[each.vehicle_id]
    found = {}
    for vehicle_id, (first_s, first, last_s, last) in ends.items():
        span_s, begins, ends_at = last_s - first_s, heading_rad(first), heading_rad(last)
        change_x = last.speed_mps * cos(ends_at) - first.speed_mps * cos(begins)
        change_y = last.speed_mps * sin(ends_at) - first.speed_mps * sin(begins)
        turning = _turn(ends_at - begins) / span_s
        found[vehicle_id] = _Motion((change_x / span_s, change_y / span_s), turning)
    return found


def _weather(made: Any, sky: Weather, local_time: str) -> None:
    made.temperature = sky.temperature_2m + KELVIN
    made.relative_humidity = sky.relative_humidity_2m
    falls = RAINS[bisect_right(RAIN_MM_H, sky.precipitation)]
    made.precipitation = made.Precipitation.Value(f"PRECIPITATION_{falls}")
    made.fog = made.Fog.Value(f"FOG_{FOGS[bisect_right(FOG_M, sky.visibility)]}")
    oktas = OKTAS[round(sky.cloud_cover / 100 * FULL)].upper()
    made.clouds.fractional_cloud_cover = made.clouds.FractionalCloudCover.Value(
        f"FRACTIONAL_CLOUD_COVER_{oktas}_OKTAS"
    )
    if local_time:
        clock = datetime.fromisoformat(local_time)
        made.time_of_day.seconds_since_midnight = 3600 * clock.hour + 60 * clock.minute + clock.second
        made.unix_timestamp = round(clock.timestamp())


def _stamp(made: Any, time_s: float) -> None:
    nanos = round(time_s * 1e9)
    made.seconds, made.nanos = divmod(nanos, 10**9)


def _vector(made: Any, x: float, y: float, z: float = 0.0) -> None:
    made.x, made.y, made.z = x, y, z


def _turn(angle: float) -> float:
    """The same between -pi and pi."""
    return (angle + pi) % (2 * pi) - pi


def _angles(made: Any, yaw: float) -> None:
    made.roll, made.pitch, made.yaw = 0.0, 0.0, yaw
