"""Writes ``road.jsonl.gz`` while an episode runs; ``road`` describes the format and reads it."""

from __future__ import annotations

import gzip
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import datetime
from io import BufferedWriter
from itertools import pairwise
from pathlib import Path

from shapely import LineString, MultiPoint, Point, Polygon, STRtree

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    DrivingState,
    GroundArea,
    Json,
    LaneShape,
    RoadNetwork,
    RoadShapes,
    RoadSnapshot,
    Weather,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.session import JudgedSession
from automotive_cosim.formats.layout import ROAD
from automotive_cosim.formats.writing import growing, make_folder
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.geo.sun import elevation_deg
from automotive_cosim.run.road import FORMAT, SeenColumns
from automotive_cosim.run.timeline import limit_kmh
from automotive_cosim.run.trial import Shot, TrialObserver
from automotive_cosim.traffic.lookout import LOOK_RADIUS_M

EVERYWHERE_M = 1e9
AHEAD_M = 200.0
"""Lanes come into sight this much before they can have a vehicle on them; new ones are sought as often."""


class RoadRecorder(TrialObserver):
    """Writes the road of a trial into its record's folder while it runs."""

    looks = True

    def __init__(self, folder: Path, about: Json) -> None:
        """Nothing is written before the agent takes over.

        Args:
            folder: where the file goes; an observer that empties it comes first.
            about: what is run, by name, as the file tells it."""
        self._path = folder / ROAD
        self._about = about
        self._looked: dict[float, RoadSnapshot] = {}
        """Snapshots whose second has not been reported yet."""
        self._before: list[tuple[Moment, RoadSnapshot]] = []
        self._writer: RoadWriter | None = None
        self._session: JudgedSession | None = None

    def looked(self, snapshot: RoadSnapshot) -> None:
        """Keeps it until its second is reported."""
        self._looked[snapshot.time_s] = snapshot

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Writes a second of the drive, or keeps it until the agent takes over."""
        snapshot = self._looked.pop(moment.time_s)
        if self._writer is not None:
            self._writer.second(moment.driving, RoadFacts.of(moment), snapshot)
            return
        while self._before and self._before[-1][0].time_s >= moment.time_s:
            self._before.pop()  # an earlier departure, at which the situation did not arise
        self._before.append((moment, snapshot))

    def begun(self, session: JudgedSession, shot: Shot) -> None:
        """Begins the file with the drive so far."""
        now_s = shot.step.moment.time_s
        departed_s = session.drive[0].time_s if session.drive else now_s
        self._session = session
        make_folder(self._path.parent)
        about = self._about | {"goal": session.goal}
        traffic = session.world.traffic
        self._writer = RoadWriter(self._path, traffic.shapes(), traffic.network, about, now_s)
        for moment, snapshot in self._before:
            if moment.time_s > departed_s:
                self._writer.second(moment.driving, RoadFacts.of(moment), snapshot)
        self._before = []

    def finished(self, row: object, told: object) -> None:
        """Adds the baseline run of a judged session, and completes the file."""
        if self._writer is not None and self._session is not None and self._session.is_judged:
            self._writer.baseline(self._session.baseline_moments)
        self.close()

    def close(self) -> None:
        """Completes the file, even if the episode was broken off; may be called again."""
        if self._writer is not None:
            self._writer.close()


@dataclass(frozen=True, slots=True)
class RoadFacts:
    """What the file holds for a second besides vehicles and lights."""

    limit_kmh: float | None
    local_time: datetime
    speed_unit: str = "km/h"
    weather: Weather | None = None
    events: tuple[str, ...] = ()

    @classmethod
    def of(cls, moment: Moment) -> RoadFacts:
        """Those of a drive with a cockpit."""
        return cls(
            limit_kmh(limit_at(moment.context)),
            moment.local_time,
            moment.context.speed_unit,
            moment.weather,
            tuple(event.text for event in moment.events),
        )


class RoadWriter:
    """The file, and what has already been written to it."""

    def __init__(self, path: Path, shapes: RoadShapes, network: RoadNetwork, about: Json, begin_s: float) -> None:
        """Begins the file.

        Args:
            shapes: lanes, junctions and ground of the whole network.
            begin_s: simulation time from which the file counts."""
        self._raw = BufferedWriter(growing(path, anew=True))
        self._file = gzip.GzipFile(fileobj=self._raw, mode="wb", compresslevel=6, filename="", mtime=0)
        self._is_whole = True
        """Whether no line was broken off."""
        self._begin_s = begin_s
        self._index = _ShapeIndex(shapes)
        self._roads = {road.edge_id: road.shape_m for road in network.roads}
        self._lanes: set[int] = set()
        self._junctions: set[int] = set()
        self._ground: set[int] = set()
        self._sought_at: tuple[float, float] | None = None
        self._in_sight: set[str] = set()
        """Lights at the end of the lanes so far."""
        self._lights: dict[str, str] = {}
        self._weather: Json | None = None
        self._numbers: dict[str, int] = {}
        self._rows = SeenColumns()
        self._line(
            {
                "format": FORMAT,
                **about,
                "radius_m": LOOK_RADIUS_M,
                "left_hand": network.left_hand,
                "has_place": network.projection is not None,
            }
        )

    def second(self, driving: DrivingState, around: RoadFacts, snapshot: RoadSnapshot) -> None:
        """Writes one second of the drive, after the lanes and vehicles that are new in it."""
        self._seek(driving.x_m, driving.y_m)
        lat_deg, lon_deg = driving.lat_deg, driving.lon_deg
        sky = around.weather
        weather = None if sky is None else {name: round(value, 1) for name, value in asdict(sky).items()}
        changed = {} if weather in (None, self._weather) else {"weather": weather}
        self._weather = weather
        self._second(
            snapshot,
            {
                "speed_kmh": round(driving.speed_mps * KMH_PER_MPS, 1),
                "limit_kmh": around.limit_kmh,
                "speed_unit": around.speed_unit,
                "road": driving.road.name,
                "local_time": around.local_time.isoformat(timespec="seconds"),
                "sun_deg": None
                if lat_deg is None or lon_deg is None
                else round(elevation_deg(lat_deg, lon_deg, around.local_time), 1),
                "weather_code": None if sky is None else sky.weather_code,
                **changed,
                "incidents": [
                    [incident.kind, *(round(part, 1) for part in along(shape, incident.position_m))]
                    for incident in driving.ahead.incidents
                    if (shape := self._roads.get(incident.edge_id))
                ],
                "events": around.events,
            },
        )

    def fleet(self, snapshot: RoadSnapshot, events: Sequence[str]) -> None:
        """Writes one second of the cars of a network, all of which is in sight."""
        self._seek(0.0, 0.0, EVERYWHERE_M)
        self._second(snapshot, {"local_time": "", "sun_deg": None, "incidents": [], "events": events})

    def _second(self, snapshot: RoadSnapshot, facts: Json) -> None:
        new = [each for each in snapshot.vehicles if each.vehicle_id not in self._numbers]
        if new:
            for each in new:
                self._numbers[each.vehicle_id] = len(self._numbers)
            self._line(
                {
                    "vehicles": [
                        [self._numbers[each.vehicle_id], each.vehicle_id, each.kind, each.length_m, each.width_m]
                        for each in new
                    ]
                }
            )
        lights = {
            light: state
            for light, state in snapshot.lights
            if light in self._in_sight and self._lights.get(light) != state
        }
        self._lights |= lights
        self._line(
            {
                "at_s": round(snapshot.time_s - self._begin_s, 2),
                "seen": self._rows.packed(
                    [
                        [
                            self._numbers[each.vehicle_id],
                            round(each.x_m, 2),
                            round(each.y_m, 2),
                            round(each.heading_deg, 1) % 360,
                            round(each.speed_mps, 2),
                            each.signals,
                        ]
                        for each in snapshot.vehicles
                    ]
                ),
                "lights": lights,
                **facts,
            }
        )
        self._file.flush()
        self._raw.flush()

    def baseline(self, moments: Sequence[Moment]) -> None:
        """Writes the car in the baseline run."""
        rows = []
        for moment in moments:
            car, at_s = moment.driving, round(moment.time_s - self._begin_s, 2)
            heading_deg = round(car.heading_deg, 1) % 360
            rows.append([at_s, round(car.x_m, 2), round(car.y_m, 2), heading_deg, round(car.speed_mps, 2)])
        self._line({"baseline": rows})

    def close(self) -> None:
        """Completes the file; one with a line that was broken off ends before that line."""
        if self._is_whole:
            self._file.close()
        self._raw.close()

    def _seek(self, x_m: float, y_m: float, radius_m: float = LOOK_RADIUS_M + AHEAD_M) -> None:
        """Writes the lanes, junctions and ground that have come into sight."""
        if self._sought_at is not None and math.dist(self._sought_at, (x_m, y_m)) < AHEAD_M:
            return
        self._sought_at = x_m, y_m
        lanes, junctions, ground = self._index.near(x_m, y_m, radius_m)
        new = [number for number in lanes if number not in self._lanes]
        outlines = [number for number in junctions if number not in self._junctions]
        areas = [number for number in ground if number not in self._ground]
        self._lanes.update(new)
        self._junctions.update(outlines)
        self._ground.update(areas)
        shapes = self._index.shapes
        for number in new:
            self._in_sight.update(light for light, _ in shapes.lanes[number].links)
        if new or outlines or areas:
            self._line(
                {
                    "lanes": [_lane(shapes.lanes[number]) for number in new],
                    "junctions": [_flat(shapes.junctions[number]) for number in outlines],
                    "ground": [_area(shapes.ground[number]) for number in areas],
                }
            )

    def _line(self, entry: Json) -> None:
        """Writes a line, unless one was broken off before, as by Ctrl-C: after it, nothing could be read."""
        line = json.dumps(entry, ensure_ascii=False, separators=(",", ":")).encode() + b"\n"
        if self._is_whole:
            self._is_whole = False
            self._file.write(line)
            self._is_whole = True


class _ShapeIndex:
    """The lanes and junctions of a network, and the ground around them, by place."""

    def __init__(self, shapes: RoadShapes) -> None:
        """Indexes them: 10 ms for three thousand lanes."""
        self.shapes = shapes
        self._lanes = STRtree([LineString(lane.line_m) for lane in shapes.lanes])
        self._junctions = STRtree([Polygon(outline) for outline in shapes.junctions])
        self._ground = STRtree([MultiPoint(area.outline_m).envelope for area in shapes.ground])

    def near(self, x_m: float, y_m: float, radius_m: float) -> tuple[list[int], list[int], list[int]]:
        """The numbers of the lanes, of the junctions and of the areas (by their boxes) within that distance, in
        order."""
        here = Point(x_m, y_m)
        lanes, junctions, ground = (
            sorted(tree.query(here, predicate="dwithin", distance=radius_m).tolist())
            for tree in (self._lanes, self._junctions, self._ground)
        )
        return lanes, junctions, ground


def along(line: Sequence[tuple[float, float]], position_m: float) -> tuple[float, float]:
    """The point of a line at a distance from its start, or its end if it is shorter."""
    for before, after in pairwise(line):
        length_m = math.dist(before, after)
        if position_m <= length_m and length_m > 0:
            share = max(0.0, position_m) / length_m
            return before[0] + share * (after[0] - before[0]), before[1] + share * (after[1] - before[1])
        position_m -= length_m
    return line[-1]


def _lane(lane: LaneShape) -> list[object]:
    return [lane.kind, round(lane.width_m, 2), _flat(lane.line_m), [list(link) for link in lane.links]]


def _area(area: GroundArea) -> list[object]:
    return [area.kind, _flat(area.outline_m)]


def _flat(points: Sequence[tuple[float, float]]) -> list[float]:
    return [round(part, 1) for point in points for part in point]
