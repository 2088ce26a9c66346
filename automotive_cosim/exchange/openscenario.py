"""A recorded trial as OpenSCENARIO XML: every vehicle on its trajectory, lights, weather, and the agent's acts.

Simulation time 0 is the first recorded second. Positions are those of the network, and of its OpenDRIVE file. The
standard places a vehicle by the middle of its rear axle, SUMO by its front bumper: axles, which SUMO does not know,
are taken to lie at ``FRONT_AXLE`` and ``REAR_AXLE`` of the length. A vehicle that leaves the recorded surroundings
is deleted, and added again if it comes back. A light's controller goes through its recorded states in turn. What
the standard has no word for, a tap or an alert, is a ``CustomCommandAction`` of the type ``automotive-cosim``, with
the action as JSON.
"""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi
from pathlib import Path

from automotive_cosim.contracts import SeenVehicle, Weather
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.exchange.bodies import FRONT_AXLE, GAP_S, REAR_AXLE, WHEEL_M, heading_rad, height_m, place_at
from automotive_cosim.exchange.recording import Recording
from automotive_cosim.formats.xml import read_tree, write_xml

VERSIONS = "1.2", "1.3"
"""Of the standard that can be written."""
CATEGORIES = {
    "bicycle": "bicycle", "bus": "bus", "coach": "bus", "motorcycle": "motorbike", "moped": "motorbike",
    "truck": "truck", "trailer": "truck", "delivery": "van", "emergency": "van", "tram": "tram", "rail": "train",
    "rail_urban": "train", "rail_electric": "train", "rail_fast": "train",
}  # fmt: skip
"""SUMO's vehicle class -> the standard's category; any other is a car."""
LAMPS = {"r": "on;off;off", "u": "on;on;off", "y": "off;on;off", "g": "off;off;on"}
"""A signal's red, yellow and green lamp by SUMO's letter, in lower case; any other is dark."""
COMMAND = "automotive-cosim"
FULL = 8
"""Eighths of the sky (oktas)."""
OKTAS = "zero", "one", "two", "three", "four", "five", "six", "seven", "eight"
KELVIN = 273.15
SNOW = frozenset({71, 73, 75, 77, 85, 86})
"""WMO 4677."""

SeenEntity = tuple[float, SeenVehicle]


@dataclass(frozen=True, slots=True)
class _Stay:
    """A vehicle in the recorded surroundings, without a break."""

    sightings: tuple[SeenEntity, ...]
    """Seconds of the recording, and the vehicle then."""
    leaves: bool
    """Whether it has gone before the end."""


def write_openscenario(recording: Recording, target: Path, version: str = "1.3", road: Path | None = None) -> None:
    """Writes a trial as OpenSCENARIO XML; the same record gives the same bytes.

    Args:
        version: of the standard, one of ``VERSIONS``.
        road: the road's OpenDRIVE file, beside the target; without it, the file names neither road nor lights.

    Raises UserError: the version cannot be written."""
    if version not in VERSIONS:
        raise UserError(f"OpenSCENARIO {version} cannot be written; give one of {', '.join(VERSIONS)}")
    root = _scenario(recording, version, road)
    ET.indent(root)
    write_xml(target, root)


def _scenario(recording: Recording, version: str, road: Path | None) -> ET.Element:
    seconds, begin_s = recording.road.seconds, recording.begin_s
    end_s = seconds[-1].at_s - begin_s
    stays = _stays(recording)
    names = _names(stays)
    root = ET.Element("OpenSCENARIO")
    major, minor = version.split(".")
    _add(
        root, "FileHeader", revMajor=major, revMinor=minor, date=seconds[0].local_time,
        description=recording.title, author="automotive-cosim",
    )  # fmt: skip
    _add(root, "CatalogLocations")
    network = _add(root, "RoadNetwork")
    if road is not None:
        _add(network, "LogicFile", filepath=road.name)
        _lights(network, recording, _signals_of(road))
    entities = _add(root, "Entities")
    for vehicle_id, each in stays.items():
        _vehicle(
            _add(entities, "ScenarioObject", name=names[vehicle_id]), names[vehicle_id], each[0].sightings[0][1]
        )
    storyboard = _add(root, "Storyboard")
    init = _add(_add(storyboard, "Init"), "Actions")
    first, *later = _skies(recording)
    _environment(_add(init, "GlobalAction"), "departure", first[1], seconds[0].local_time)
    for vehicle_id, each in stays.items():
        at_s, vehicle = each[0].sightings[0]
        if at_s == 0:
            action = _add(_add(init, "Private", entityRef=names[vehicle_id]), "PrivateAction")
            _position(_add(action, "TeleportAction"), vehicle)
    act = _add(_add(storyboard, "Story", name="recorded"), "Act", name="drive")
    for vehicle_id, each in stays.items():
        _drive(act, names[vehicle_id], each)
    if later:
        maneuver = _maneuver(act, "weather", ())
        for number, (at_s, sky) in enumerate(later, 1):
            event = _event(maneuver, f"weather {number}", at_s)
            _environment(
                _add(_add(event, "Action", name=f"weather {number}"), "GlobalAction"), f"at {at_s:g} s", sky
            )
            _after(event, at_s)
    acts = [each for each in recording.acts if 0 <= each.at_s - begin_s <= end_s]
    if acts:
        maneuver = _maneuver(act, "agent", (names["ego"],))
        for number, done in enumerate(acts, 1):
            event = _event(maneuver, f"act {number}", done.at_s - begin_s)
            action = _add(_add(event, "Action", name=f"{number}: {done.words}"), "UserDefinedAction")
            command = _add(action, "CustomCommandAction", type=COMMAND)
            command.text = json.dumps(done.action, ensure_ascii=False, sort_keys=True)
            _after(event, done.at_s - begin_s)
    _trigger(act, "StartTrigger", "start", 0.0)
    _trigger(storyboard, "StopTrigger", "end", end_s)
    return root


def _add(parent: ET.Element, tag: str, **attributes: object) -> ET.Element:
    return ET.SubElement(parent, tag, {name: str(value) for name, value in attributes.items()})


# --- vehicles ----------------------------------------------------------------------------------------------------


def _stays(recording: Recording) -> dict[str, list[_Stay]]:
    """The stays of each vehicle, the ego first."""
    seen: dict[str, list[SeenEntity]] = {"ego": []}
    for second in recording.road.seconds:
        for vehicle in second.vehicles:
            seen.setdefault(vehicle.vehicle_id, []).append((round(second.at_s - recording.begin_s, 2), vehicle))
    end_s = round(recording.road.seconds[-1].at_s - recording.begin_s, 2)
    found: dict[str, list[_Stay]] = {}
    for vehicle_id, sightings in seen.items():
        parts: list[list[SeenEntity]] = [sightings[:1]]
        for before, now in pairwise(sightings):
            if now[0] - before[0] > GAP_S:
                parts.append([])
            parts[-1].append(now)
        if sightings:
            found[vehicle_id] = [_Stay(tuple(part), part[-1][0] < end_s) for part in parts]
    return found


def _names(vehicle_ids: Iterable[str]) -> Mapping[str, str]:
    """The entities' names: those of SUMO, with the standard's own characters replaced."""
    names: dict[str, str] = {}
    taken: set[str] = set()
    for number, vehicle_id in enumerate(vehicle_ids):
        plain = re.sub(r"[^\w.-]", "_", vehicle_id)
        name = plain if plain not in taken else f"{plain}_{number}"
        taken.add(name)
        names[vehicle_id] = name
    return names


def reference_point(vehicle: SeenVehicle) -> tuple[float, float, float]:
    """The middle of its rear axle, x and y in metres, and its heading in radians, counter-clockwise from east."""
    return *place_at(vehicle, REAR_AXLE), heading_rad(vehicle)


def _vehicle(parent: ET.Element, name: str, seen: SeenVehicle) -> None:
    length_m, tall_m = seen.length_m, height_m(seen)
    role = {"role": "ambulance"} if seen.kind == "emergency" else {}
    made = _add(parent, "Vehicle", name=name, vehicleCategory=CATEGORIES.get(seen.kind, "car"), **role)
    box = _add(made, "BoundingBox")
    _add(box, "Center", x=round((REAR_AXLE - 0.5) * length_m, 3), y=0, z=tall_m / 2)
    _add(box, "Dimensions", width=seen.width_m, length=length_m, height=tall_m)
    _add(made, "Performance", maxSpeed=70, maxAcceleration=10, maxDeceleration=10)
    axles = _add(made, "Axles")
    places_m = {"FrontAxle": round((REAR_AXLE - FRONT_AXLE) * length_m, 3), "RearAxle": 0.0}
    for axle, place_m in places_m.items():
        _add(
            axles, axle, maxSteering=0.5 if place_m else 0.0, wheelDiameter=WHEEL_M, trackWidth=seen.width_m,
            positionX=place_m, positionZ=WHEEL_M / 2,
        )  # fmt: skip
    properties = _add(made, "Properties")
    _add(properties, "Property", name="sumo:vClass", value=seen.kind)


def _position(parent: ET.Element, vehicle: SeenVehicle, heading: float | None = None) -> None:
    x_m, y_m, own = reference_point(vehicle)
    turned = own if heading is None else heading
    _add(_add(parent, "Position"), "WorldPosition", x=f"{x_m:.3f}", y=f"{y_m:.3f}", z=0, h=f"{turned:.5f}")


def _drive(act: ET.Element, name: str, stays: Sequence[_Stay]) -> None:
    maneuver = _maneuver(act, name, (name,))
    for number, stay in enumerate(stays, 1):
        (enters_s, vehicle), (leaves_s, _) = stay.sightings[0], stay.sightings[-1]
        if enters_s > 0:
            event = _event(maneuver, f"{name} appears {number}", enters_s)
            _position(_add(_entity(event, f"add {number}", name), "AddEntityAction"), vehicle)
            _after(event, enters_s)
        if len(stay.sightings) > 1:
            event = _event(maneuver, f"{name} drives {number}", enters_s)
            action = _add(_add(event, "Action", name=f"follow {number}"), "PrivateAction")
            _trajectory(_add(action, "RoutingAction"), f"{name} {number}", stay)
            _after(event, enters_s)
        if stay.leaves:
            event = _event(maneuver, f"{name} leaves {number}", leaves_s)
            _add(_entity(event, f"delete {number}", name), "DeleteEntityAction")
            _after(event, leaves_s + 0.1)


def _trajectory(routing: ET.Element, name: str, stay: _Stay) -> None:
    follow = _add(routing, "FollowTrajectoryAction")
    timing = _add(_add(follow, "TimeReference"), "Timing")
    timing.attrib.update(domainAbsoluteRelative="absolute", scale="1", offset="0")
    _add(follow, "TrajectoryFollowingMode", followingMode="position")
    shape = _add(_add(_add(follow, "TrajectoryRef"), "Trajectory", name=name, closed="false"), "Shape")
    line = _add(shape, "Polyline")
    heading = reference_point(stay.sightings[0][1])[2]
    for at_s, vehicle in stay.sightings:
        heading += (reference_point(vehicle)[2] - heading + pi) % (2 * pi) - pi  # never a whole turn in between
        _position(_add(line, "Vertex", time=f"{at_s:g}"), vehicle, heading)


def _entity(event: ET.Element, action: str, name: str) -> ET.Element:
    return _add(_add(_add(event, "Action", name=action), "GlobalAction"), "EntityAction", entityRef=name)


# --- the story ---------------------------------------------------------------------------------------------------


def _maneuver(act: ET.Element, name: str, actors: Iterable[str]) -> ET.Element:
    group = _add(act, "ManeuverGroup", maximumExecutionCount=1, name=f"{name} group")
    listed = _add(group, "Actors", selectTriggeringEntities="false")
    for actor in actors:
        _add(listed, "EntityRef", entityRef=actor)
    return _add(group, "Maneuver", name=f"{name} maneuver")


def _event(maneuver: ET.Element, name: str, at_s: float) -> ET.Element:
    return _add(maneuver, "Event", name=f"{name}, {at_s:g} s", priority="parallel", maximumExecutionCount=1)


def _after(event: ET.Element, at_s: float) -> None:
    """Starts an event at a time; its actions come first in the file."""
    _trigger(event, "StartTrigger", "time", at_s)


def _trigger(parent: ET.Element, tag: str, name: str, at_s: float) -> None:
    group = _add(_add(parent, tag), "ConditionGroup")
    condition = _add(group, "Condition", name=name, delay=0, conditionEdge="none")
    value = _add(condition, "ByValueCondition")
    _add(value, "SimulationTimeCondition", value=f"{at_s:g}", rule="greaterOrEqual")


# --- weather -----------------------------------------------------------------------------------------------------


def _skies(recording: Recording) -> Iterator[tuple[float, Weather | None]]:
    """The weather at the beginning, and each later one with its time."""
    before: Weather | None = None
    for number, second in enumerate(recording.road.seconds):
        if number == 0 or second.weather != before:
            yield round(second.at_s - recording.begin_s, 2), second.weather
        before = second.weather


def _environment(action: ET.Element, name: str, sky: Weather | None, local_time: str = "") -> None:
    made = _add(_add(action, "EnvironmentAction"), "Environment", name=name)
    if local_time:
        _add(made, "TimeOfDay", animation="true", dateTime=local_time)
    if sky is None:
        return
    okta = OKTAS[round(sky.cloud_cover / 100 * FULL)]
    weather = _add(
        made, "Weather", fractionalCloudCover=f"{okta}Oktas", temperature=round(sky.temperature_2m + KELVIN, 2)
    )
    _add(weather, "Fog", visualRange=sky.visibility)
    falls = "dry" if not sky.precipitation else "snow" if sky.weather_code in SNOW else "rain"
    _add(weather, "Precipitation", precipitationType=falls, precipitationIntensity=sky.precipitation)


# --- lights ------------------------------------------------------------------------------------------------------


def _signals_of(road: Path) -> Mapping[str, Mapping[int, str]]:
    """The signals of an exported OpenDRIVE file: light -> place of the link's letter -> id."""
    found: dict[str, dict[int, str]] = {}
    for signal in read_tree(road, error=ScenarioError).iter("signal"):
        light, _, place = signal.attrib["name"].rpartition("_")
        if light and place.isdecimal():
            found.setdefault(light, {})[int(place)] = signal.attrib["id"]
    return found


def _lights(network: ET.Element, recording: Recording, signals: Mapping[str, Mapping[int, str]]) -> None:
    """A controller for each light in sight, whose phases are its recorded states one after the other."""
    states: dict[str, list[tuple[float, str]]] = {}
    for second in recording.road.seconds:
        for light, state in second.lights.items():
            mine = states.setdefault(light, [])
            if light in signals and (not mine or mine[-1][1] != state):
                mine.append((round(second.at_s - recording.begin_s, 2) if mine else 0.0, state))
    known = {light: mine for light, mine in states.items() if mine}
    if not known:
        return
    end_s = recording.road.seconds[-1].at_s - recording.begin_s + 1
    made = _add(network, "TrafficSignals")
    for light, mine in known.items():
        controller = _add(made, "TrafficSignalController", name=light)
        for (from_s, state), (to_s, _) in pairwise((*mine, (end_s, ""))):
            phase = _add(controller, "Phase", name=f"from {from_s:g} s", duration=f"{to_s - from_s:.2f}")
            for place, signal_id in sorted(signals[light].items()):
                lamps = LAMPS.get(state[place].lower(), "off;off;off") if place < len(state) else "off;off;off"
                _add(phase, "TrafficSignalState", trafficSignalId=signal_id, state=lamps)
