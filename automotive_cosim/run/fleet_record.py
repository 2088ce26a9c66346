"""Where the cars of a fleet drove, and what was done in them; report and pages read it."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from shapely import LineString

from automotive_cosim.contracts import Json, RoadShapes, RoadSnapshot
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import LIVE, ROAD
from automotive_cosim.formats.writing import is_being_written, make_folder
from automotive_cosim.run.road import read_road
from automotive_cosim.run.road_recorder import RoadWriter
from automotive_cosim.traffic.fork import RemoteRoad

FAILS = "loses its assistant:"
"""How a note of a car's begins whose agent failed."""
SMOOTH_M = 4.0
"""How far a drawn way may be from where the car drove."""
EVERY_S = 1.0
"""Between two looks at the cars."""


class FleetRecord:
    """Writes the road of a fleet second by second; a full disk ends that, not the fleet."""

    def __init__(
        self,
        folder: Path,
        name: str,
        road: RemoteRoad,
        shapes: RoadShapes,
        look: Callable[[], RoadSnapshot],
        about: Json,
    ) -> None:
        """Begins the file.

        Args:
            folder: of all results.
            name: of the fleet, for its folder below ``live``.
            shapes: the whole network.
            look: gives where the cars are.
            about: what is run, and by SUMO's ids under ``cars`` the trials of cars that have one."""
        self._road, self._look = road, look
        self._next_s = road.time_s
        self._notes: list[str] = []
        self._writer: RoadWriter | None = None
        with suppress(OSError):
            path = make_folder(make_folder(folder, LIVE), name) / ROAD
            self._writer = RoadWriter(path, shapes, road.source.network, about, road.time_s)

    def note(self, words: str) -> None:
        """Notes what has happened in a car, whose name comes first."""
        self._notes.append(words)

    def look(self) -> None:
        """Writes where the equipped cars are, if a second has passed."""
        if self._writer is None or self._road.time_s < self._next_s - self._road.step_s / 2:
            return
        self._next_s = self._road.time_s + EVERY_S
        notes, self._notes = self._notes, []
        try:
            self._writer.fleet(self._look(), notes)
        except OSError:
            self.close()

    def close(self) -> None:
        """Completes the file; may be called again."""
        writer, self._writer = self._writer, None
        with suppress(OSError):
            if writer is not None:
                writer.close()


@dataclass(frozen=True, slots=True)
class DrivenFleet:
    """The cars of a fleet, as they drove."""

    roads: Sequence[Sequence[tuple[float, float]]]
    ways: Mapping[str, Sequence[tuple[float, float]]]
    """By car, where it drove."""
    notes: Mapping[str, Sequence[tuple[float, str]]] = field(default_factory=dict)
    """By car, when and what was done in it or asked of its driver, in seconds after the beginning."""
    trials: Mapping[str, str] = field(default_factory=dict)
    """By car, the id of its trial, if it has one."""

    @property
    def box_m(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top of the roads."""
        xs, ys = ([place[axis] for road in self.roads for place in road] or [0.0] for axis in (0, 1))
        return min(xs), min(ys), max(xs), max(ys)


def fleets_in(folder: Path) -> Iterator[tuple[str, bool]]:
    """The names of the fleets that have been driven or are being driven, and whether they are."""
    for path in sorted((folder / LIVE).glob(f"*/{ROAD}")):
        yield path.parent.name, is_being_written(path)


def read_fleet(folder: Path, name: str) -> DrivenFleet | None:
    """A fleet's cars; None if they were not recorded. Raises UserError: the file is damaged."""
    path = folder / LIVE / name / ROAD
    if not path.is_file():
        return None
    roads: list[list[tuple[float, float]]] = []
    names: dict[int, str] = {}
    places: dict[str, list[tuple[float, float]]] = defaultdict(list)
    notes: dict[str, list[tuple[float, str]]] = defaultdict(list)
    trials: dict[str, str] = {}
    try:
        for entry in read_road(path):
            trials |= entry.get("cars", {})
            roads += (_points(line) for _, _, line, _ in entry.get("lanes", ()))
            names |= {number: car for number, car, *_ in entry.get("vehicles", ())}
            for number, x_m, y_m, *_ in entry.get("seen", ()):
                if not (way := places[names[number]]) or math.dist(way[-1], (x_m, y_m)) > SMOOTH_M:
                    way.append((x_m, y_m))
            for note in entry.get("events", ()):
                car, _, words = note.partition(": ")
                notes[car].append((entry["at_s"], words))
    except (LookupError, TypeError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error
    return DrivenFleet(roads, {car: _smoothed(way) for car, way in places.items()}, notes, trials)


def _smoothed(way: Sequence[tuple[float, float]]) -> Sequence[tuple[float, float]]:
    return way if len(way) < 2 else list(LineString(way).simplify(SMOOTH_M).coords)  # type: ignore[arg-type]


def _points(flat: Sequence[float]) -> list[tuple[float, float]]:
    return list(zip(flat[::2], flat[1::2], strict=True))
