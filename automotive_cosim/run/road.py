"""``road.jsonl.gz``: the road of a recorded drive, with every vehicle around the car once a simulated second.

It is a gzipped text with one JSON object per line. Lengths are in metres in the network's coordinates (x to the
east, y to the north), angles in degrees clockwise from north, and times in seconds since the hand-over. The first
line says ``format`` and what is run; every other line has one of these keys:

    lanes      [[kind, width, [x, y, x, y, …], [[light, place], …]], …]   as they come into sight, each once
    junctions  [[x, y, x, y, …], …]                                       outlines, with the lanes
    ground     [[kind, [x, y, x, y, …]], …]                               outlines of green, water and buildings
    vehicles   [[number, id, class, length, width], …]                    before a vehicle is first seen
    at_s       one second of the drive:
               seen       [[number, x, y, heading, speed in m/s, signals], …]; x and y of the front bumper; the car
                          under test is ``ego``; signals are the bits of ``contracts.SumoSignal``
               lights     {light: state} of those that have changed; a lane's ``place`` is that of its letter
               speed_kmh, limit_kmh, speed_unit (of the signs), road, local_time, sun_deg (elevation; null without a
               place), weather_code (WMO)
               weather    {field of ``contracts.Weather``: value, …}, if it has changed
               incidents  [[kind, x, y], …]
               events     [text, …]
    baseline   [[at_s, x, y, heading, speed], …]                          the car in the baseline run, once judged

The file is written during the drive; after a kill, it can be read up to the last complete line.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

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

FORMAT = 1
PACKED = b"\x1f\x8b"

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

    Raises:
        UserError: it has none; of an evaluation's folder, the trials in it that have one are named.
    """
    found = roads_in(folder)
    if "" in found:
        return found[""]
    trials = [path.parent for path in found.values()]
    more = f", and {len(trials) - 3} more" if len(trials) > 3 else ""
    raise UserError(f"{folder} is an evaluation; give one of its runs: {', '.join(map(str, trials[:3]))}{more}")


def roads_in(folder: Path) -> dict[str, Path]:
    """The recorded roads of a trial's folder, by an empty name, or of an evaluation's, by trial.

    Raises:
        UserError: it has none.
    """
    if (folder / ROAD).is_file():
        return {"": folder / ROAD}
    found = {path.parent.name: path for path in sorted(folder.glob(f"{PICTURES}/**/{ROAD}"))}
    if not found:
        raise UserError(f"{folder} has no {ROAD}; `run`, `drive --out` and `eval --pictures all` record the road")
    return found


def read_record(path: Path) -> RoadRecord:
    """A whole file, or as much as was written before a kill.

    Raises:
        UserError: it cannot be read, or has another format.
    """
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
            seen = tuple(SeenVehicle(*names[number], *rest) for number, *rest in entry["seen"])
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
    """The lines of a file, or those written before a kill.

    Raises:
        UserError: it cannot be read, or has another format.
    """
    try:
        with open_file(path) as file:
            if (head := file.read(2)) and head != PACKED:
                raise ValueError("it is not packed")
        with opened(path, growing=True) as file:
            begun = False
            for entry in json_lines(file, bounds.ROAD_VALUES, growing=True):
                if not begun and entry.get("format") != FORMAT:
                    raise UserError(f"{path} has format {entry.get('format')!r}; this version reads {FORMAT}")
                begun = True
                yield entry
    except (OSError, ValueError, AttributeError) as error:
        raise UserError(f"cannot read {path}: {error}") from error


def _points(flat: Sequence[float]) -> GroundLine:
    return tuple(zip(flat[::2], flat[1::2], strict=True))
