"""Looks at everything around the ego, for pictures and records; nothing that is simulated depends on it.

Nothing is read unless somebody looks. SUMO finds the vehicles in its own index of lanes, by a subscription that
ends at once: reading the position of each vehicle in a town takes several times as long.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence

from automotive_cosim.contracts import LaneShape, RoadShapes, RoadSnapshot, SeenVehicle
from automotive_cosim.traffic.records import make_seen
from automotive_cosim.traffic.sumo import LibSumo

LOOK_RADIUS_M = 800.0
"""How far a snapshot reaches: beyond what a driver sees of a street, and as far as a picture of the road goes."""

KINDS = (("bus", {"bus", "coach", "taxi"}), ("bicycle", {"bicycle"}), ("foot", {"pedestrian"}))
"""What a lane is that is closed to cars, by a vehicle class that may use it; any other is for rails."""

CROSSING = re.compile(r":.+_c\d+")
"""How netconvert names the edge of a pedestrian crossing."""

Size = tuple[str, float, float]
"""Vehicle class, length and width."""


class Lookout:
    """Takes snapshots around one vehicle."""

    def __init__(self, sumo: LibSumo, vehicle: str) -> None:
        self._sumo = sumo
        self._vehicle = vehicle
        self._lights: Sequence[str] | None = None
        self._sizes: dict[str, Size] = {}
        """By vehicle type: SUMO gives a vehicle that is changed a type of its own."""

    def look(self) -> RoadSnapshot:
        """The road around the vehicle now; without vehicles if it is no longer on it."""
        sumo = self._sumo
        try:
            found = sumo.vehicles_around(self._vehicle, LOOK_RADIUS_M)
        except sumo.refusals:
            found = ()
        vehicles = tuple(
            make_seen(vehicle, *self._size(kind), x_m, y_m, heading_deg, speed_mps, signals)
            for vehicle, kind, (x_m, y_m), heading_deg, speed_mps, signals in found
        )
        if self._lights is None:
            self._lights = sumo.light_ids()
        state = sumo.light_state
        lights = tuple((light, state(light)) for light in self._lights)
        people = tuple(self._people(sumo.position(self._vehicle) if vehicles else ()))
        return RoadSnapshot(sumo.time(), vehicles, lights, people)

    def _people(self, here: Sequence[float]) -> Iterator[SeenVehicle]:
        """Who walks in sight of a place."""
        person = self._sumo.person
        for name in person.getIDList() if here else ():
            x_m, y_m = person.getPosition(name)
            if not person.getVehicle(name) and math.dist((x_m, y_m), here) <= LOOK_RADIUS_M:
                size = self._size(person.getTypeID(name))
                yield make_seen(name, *size, x_m, y_m, person.getAngle(name), person.getSpeed(name), 0)

    def _size(self, kind: str) -> Size:
        size = self._sizes.get(kind)
        if size is None:
            types = self._sumo.type
            size = types.getVehicleClass(kind), types.getLength(kind), types.getWidth(kind)
            self._sizes[kind] = size
        return size


def read_shapes(sumo: LibSumo) -> RoadShapes:
    """The whole network as a picture shows it: 20 ms for three thousand lanes."""
    links, lane, every = _links(sumo), sumo.lane, sumo.lane.getIDList()

    def shaped(lanes: Iterable[str]) -> tuple[LaneShape, ...]:
        return tuple(
            LaneShape(
                each,
                _kind(lane.getAllowed(each)),
                lane.getWidth(each),
                _line(lane.getShape(each)),
                links.get(each, ()),
            )
            for each in lanes
        )

    lanes = shaped(each for each in every if not each.startswith(":"))
    crossings = shaped(each for each in every if CROSSING.fullmatch(each.rpartition("_")[0]))
    shape, ids = sumo.junction.getShape, sumo.junction.getIDList()
    outlines = (_line(shape(each)) for each in ids if not each.startswith(":"))
    return RoadShapes(lanes, tuple(outline for outline in outlines if len(outline) > 2), crossings=crossings)


def _links(sumo: LibSumo) -> dict[str, tuple[tuple[str, int], ...]]:
    """The links with a signal at the end of each lane."""
    found: dict[str, tuple[tuple[str, int], ...]] = {}
    for light in sumo.light_ids():
        for index, ways in enumerate(sumo.controlled_links(light)):
            for lane in {way[0] for way in ways}:
                found[lane] = (*found.get(lane, ()), (light, index))
    return found


def _kind(allowed: tuple[str, ...]) -> str:
    """What a lane is for; SUMO allows everything if the list is empty."""
    if not allowed or "passenger" in allowed:
        return "road"
    return next((kind for kind, classes in KINDS if classes.intersection(allowed)), "rail")


def _line(shape: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    return tuple((float(x_m), float(y_m)) for x_m, y_m in shape)
