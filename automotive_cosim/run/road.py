"""``road.jsonl.gz``: the road of a recorded drive, with every vehicle around the car once a simulated second.

It is a gzipped text with one JSON object per line. Lengths are in metres in the network's coordinates (x to the
east, y to the north), angles in degrees clockwise from north, and times in seconds since the hand-over. The first
line says ``format`` and what is run; every other line has one of these keys:

    lanes      [[kind, width, [x, y, x, y, …], [[light, place], …]], …]   as they come into sight, each once
    junctions  [[x, y, x, y, …], …]                                       outlines, with the lanes
    ground     [[kind, [x, y, x, y, …]], …]                               outlines of green, water and buildings
    vehicles   [[number, id, class, length, width], …]                    before a vehicle is first seen
    at_s       one second of the drive:
               seen       [[number, …], [x, …], [y, …], [heading, …], [speed, …], [signals, …]], in cm, tenths of a
                          degree and cm/s, as ``SeenColumns`` says; x and y of the front bumper; the car under test
                          is ``ego``; signals are the bits of ``contracts.SumoSignal``
               lights     {light: state} of those that have changed; a lane's ``place`` is that of its letter
               speed_kmh, limit_kmh, speed_unit (of the signs), road, local_time, sun_deg (elevation; null without a
               place), weather_code (WMO)
               weather    {field of ``contracts.Weather``: value, …}, if it has changed
               incidents  [[kind, x, y], …]
               events     [text, …]
               (of a fleet, no figures of a single car; events begin with the car that each is about)
    baseline   [[at_s, x, y, heading, speed], …]                          the car in the baseline run, once judged

The file is written during the drive; after a kill, it can be read up to the last complete line. In format 1,
``seen`` had a row for each vehicle, ``[number, x, y, heading, speed, signals]`` in m and m/s.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import (
    GroundArea,
    GroundKind,
    Json,
    LaneShape,
    RoadShapes,
    SeenVehicle,
    Weather,
    in_drawing_order,
)
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import json_lines, open_file, opened
from automotive_cosim.formats.layout import PICTURES, ROAD
from automotive_cosim.traffic.records import make_seen

FORMAT = 2
FORMER = 1
PACKED = b"\x1f\x8b"
_UNIT = 2**20
_SINES = tuple(round(_UNIT * math.sin(math.radians(tenth / 10))) for tenth in range(3600))
"""Whole numbers, so that every machine expects the same."""
SeenRow = list[Any]
"""``[number, x, y, heading, speed, signals]`` in m, degrees and m/s."""


class SeenColumns:
    """The vehicles of successive seconds as columns of small whole numbers, which take half the room.

    Numbers are told as steps from the one before. A vehicle that was also seen the second before is told by what
    has changed: heading, speed and signals, and how far it is from where heading and the mean of both speeds lead.
    """

    def __init__(self) -> None:
        self._before: dict[int, tuple[int, int, int, int, int]] = {}

    def packed(self, rows: Sequence[SeenRow]) -> list[list[int]]:
        """The columns of the next second."""
        columns: list[list[int]] = [[], [], [], [], [], []]
        last, now = 0, {}
        for number, x_m, y_m, heading_deg, speed_mps, signals in rows:
            x, y, speed = round(100 * x_m), round(100 * y_m), round(100 * speed_mps)
            heading = round(10 * heading_deg) % 3600
            x0, y0, heading0, speed0, signals0 = self._expected(number, heading, speed)
            row = number - last, x - x0, y - y0, heading - heading0, speed - speed0, signals - signals0
            for column, value in zip(columns, row, strict=True):
                column.append(value)
            last, now[number] = number, (x, y, heading, speed, signals)
        self._before = now
        return columns

    def unpacked(self, columns: Sequence[Sequence[int]]) -> list[SeenRow]:
        """The rows of the next second.

        Raises:
            ValueError, TypeError, LookupError: they are not columns of such numbers."""
        rows: list[SeenRow] = []
        number, now, before = 0, {}, self._before
        for step, x, y, heading, speed, signals in zip(*columns, strict=True):
            number += step
            if (known := before.get(number)) is not None:
                heading += known[2]
                speed += known[3]
                signals += known[4]
                way = known[3] + speed
                x += known[0] + way * _SINES[heading] // (2 * _UNIT)
                y += known[1] + way * _SINES[heading - 2700] // (2 * _UNIT)
            now[number] = x, y, heading, speed, signals
            rows.append([number, x / 100, y / 100, heading / 10, speed / 100, signals])
        self._before = now
        return rows

    def _expected(self, number: int, heading: int, speed: int) -> tuple[int, int, int, int, int]:
        known = self._before.get(number)
        if known is None:
            return 0, 0, 0, 0, 0
        way = known[3] + speed
        x, y = (way * _SINES[at] // (2 * _UNIT) for at in (heading, heading - 2700))
        return known[0] + x, known[1] + y, *known[2:]


GroundLine = tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Second:
    """The road at one second of a drive."""

    at_s: float
    vehicles: tuple[SeenVehicle, ...]
    lights: dict[str, str]
    """The state of every light in sight."""
    sun_deg: float | None
    incidents: tuple[tuple[str, float, float], ...]
    """Kind, x and y."""
    local_time: str = ""
    """ISO 8601, with the zone's offset."""
    weather: Weather | None = None
    """Unknown in records from before it was written."""


@dataclass(frozen=True)
class RoadRecord:
    """A whole file."""

    shapes: RoadShapes
    seconds: tuple[Second, ...]
    about: Json = field(default_factory=dict)
    """What was run, by name: the first line."""

    def at(self, at_s: float) -> Second | None:
        """The last second up to that time, else the first; None if there is none."""
        index = bisect_right(self._times, at_s + 0.05) - 1
        return self.seconds[max(0, index)] if self.seconds else None

    @cached_property
    def _times(self) -> list[float]:
        return [second.at_s for second in self.seconds]


EMPTY = RoadRecord(RoadShapes((), ()), ())
"""Of a drive without observers."""


def road_in(folder: Path) -> Path:
    """The recorded road of a trial's folder.

    Raises UserError: it has none; of an evaluation's folder, the trials in it that have one are named."""
    found = roads_in(folder)
    if "" in found:
        return found[""]
    trials = [path.parent for path in found.values()]
    more = f", and {len(trials) - 3} more" if len(trials) > 3 else ""
    raise UserError(f"{folder} is an evaluation; give one of its runs: {', '.join(map(str, trials[:3]))}{more}")


def roads_in(folder: Path) -> dict[str, Path]:
    """The recorded roads of a trial's folder, by an empty name, or of an evaluation's, by trial.

    Raises UserError: it has none."""
    if (folder / ROAD).is_file():
        return {"": folder / ROAD}
    found = {path.parent.name: path for path in sorted(folder.glob(f"{PICTURES}/**/{ROAD}"))}
    if not found:
        raise UserError(f"{folder} has no {ROAD}; `run` and `eval --pictures all` record the road")
    return found


def read_record(path: Path) -> RoadRecord:
    """A whole file, or as much as was written before a kill.

    Raises UserError: it cannot be read, or has another format."""
    try:
        return _record(path)
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise UserError(f"cannot read {path}: {type(error).__name__}: {error}") from error


def _record(path: Path) -> RoadRecord:
    lanes: list[LaneShape] = []
    junctions: list[GroundLine] = []
    ground: list[GroundArea] = []
    names: dict[int, tuple[str, str, float, float]] = {}
    lights: dict[str, str] = {}
    seconds: list[Second] = []
    weather: Weather | None = None
    about: Json = {}
    for entry in read_road(path):
        about = about or entry
        for kind, width_m, line, links in entry.get("lanes", ()):
            lanes.append(LaneShape("", kind, width_m, _points(line), tuple((light, at) for light, at in links)))
        junctions += map(_points, entry.get("junctions", ()))
        ground += (GroundArea(GroundKind(kind), _points(outline)) for kind, outline in entry.get("ground", ()))
        names |= {number: (name, *rest) for number, name, *rest in entry.get("vehicles", ())}
        if "at_s" in entry:
            lights = lights | entry["lights"]
            seen = tuple([make_seen(*names[number], *rest) for number, *rest in entry["seen"]])
            incidents = tuple((kind, x_m, y_m) for kind, x_m, y_m in entry["incidents"])
            weather = Weather(**entry["weather"]) if "weather" in entry else weather
            seconds.append(
                Second(
                    entry["at_s"], seen, lights, entry["sun_deg"], incidents, entry.get("local_time", ""), weather
                )
            )
    shapes = RoadShapes(tuple(lanes), tuple(junctions), in_drawing_order(ground))
    return RoadRecord(shapes, tuple(seconds), about)


def read_road(path: Path) -> Iterator[Json]:
    """The lines of a file, or those written before a kill; ``seen`` has a row for each vehicle (``SeenRow``).

    Raises UserError: it cannot be read, or has another format."""
    try:
        with open_file(path) as file:
            if (head := file.read(2)) and head != PACKED:
                raise ValueError("it is not packed")
        with opened(path, growing=True) as file:
            form, rows = None, SeenColumns()
            for entry in json_lines(file, bounds.ROAD_VALUES, growing=True):
                form = form or entry.get("format")
                if form not in (FORMAT, FORMER):
                    raise UserError(f"{path} has format {form!r}; this version reads {FORMAT} and {FORMER}")
                if form == FORMAT and "seen" in entry:
                    entry["seen"] = rows.unpacked(entry["seen"])
                yield entry
    except (OSError, ArithmeticError, ValueError, TypeError, LookupError, AttributeError) as error:
        raise UserError(f"cannot read {path}: {error}") from error


def _points(flat: Sequence[float]) -> GroundLine:
    return tuple(zip(flat[::2], flat[1::2], strict=True))
