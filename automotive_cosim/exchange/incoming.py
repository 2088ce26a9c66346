"""Turns OpenSCENARIO XML into a scenario's folder: a declared subset; all else is refused by name and line.

The subset: vehicles with a place at the start (``WorldPosition``, or ``LanePosition`` on an OpenDRIVE file), a
speed and a route or destination; weather and time of day, at the start and later; and for vehicles other than the
ego, speeds and changes of lane. Triggers are times. The road is the OpenDRIVE file that the scenario names, turned
into a network by netconvert, or a SUMO network with the same coordinates.

The ego is the cockpit's car: SUMO's driver drives it, from the start of the edge on which the scenario places it.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime
from pathlib import Path
from typing import Any

import sumolib
from shapely import LineString, Point, STRtree

from automotive_cosim.contracts import KMH_PER_MPS, Weather
from automotive_cosim.errors import ScenarioError
from automotive_cosim.exchange.openscenario import KELVIN
from automotive_cosim.exchange.tree import XmlElement, read_tree
from automotive_cosim.osm.folder import WEATHER, appearing, toml_value, write_config
from automotive_cosim.scenarios import Sumo, load
from automotive_cosim.traffic.sumo_programs import first_error, run

EGO = "ego"
NEAR_M = 10.0
"""A place farther from every lane for cars is beside the road."""
ONWARD_M = 3000.0
"""How far a vehicle without a route goes straight on."""
OKTAS = {f"{word}Oktas": 12.5 * number for number, word in enumerate(
    ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight")
)}  # fmt: skip
CLOUDS = {"free": 0.0, "cloudy": 60.0, "overcast": 100.0, "rainy": 100.0, "skyOff": 100.0}
"""Cover in per cent by the former attribute ``cloudState``."""
NET, ROUTES = "road.net.xml", "none.rou.xml"


@dataclass(slots=True)
class _Vehicle:
    """An entity, as it is read."""

    name: str
    front_m: float
    """From the reference point to the front bumper."""
    place: XmlElement | None = None
    speed_mps: float = 0.0
    goals: list[XmlElement] = field(default_factory=list)
    """Positions of the route, the last is where it ends."""
    actions: list[dict[str, Any]] = field(default_factory=list)


@dataclass(slots=True)
class _Read:
    """What a file says."""

    road: Path | None
    vehicles: dict[str, _Vehicle]
    start: datetime | None = None
    skies: list[tuple[float, Weather]] = field(default_factory=list)


def import_openscenario(
    file: Path,
    out: Path,
    network: Path | None = None,
    ego: str = EGO,
    *,
    country: str = "",
    replaces: bool = False,
) -> Path:
    """Writes a scenario's folder.

    Args:
        file: OpenSCENARIO XML.
        out: the folder to create.
        network: a SUMO network in the file's coordinates, instead of the OpenDRIVE file that it names.
        ego: name of the entity that is the cockpit's car.
        country: ISO 3166-1 code, whose law holds; the format has no word for it.
        replaces: whether a scenario in that folder is replaced.

    Raises:
        ScenarioError: something is outside the subset, has no place on the road, or cannot be read.
        SetupError: netconvert is not installed.
    """
    read = _read(read_tree(file), file)
    if ego not in read.vehicles:
        raise ScenarioError(f"{file} has no entity {ego!r}; give --ego one of {', '.join(read.vehicles) or 'none'}")
    source = network or read.road
    if source is None:
        raise ScenarioError(f"{file} names no road (LogicFile); give --network a SUMO network")
    if not source.is_file():
        raise ScenarioError(f"there is no road {source}, which {file} needs; give --network a SUMO network")
    with appearing(out, replaces=replaces) as folder:
        _network(source, folder)
        roads = _Roads(sumolib.net.readNet(str(folder / NET), withInternal=False))
        _write(folder, out.name, file, read, roads, ego, country)
        load(folder)
    return out


# --- reading -----------------------------------------------------------------------------------------------------


def _read(root: XmlElement, file: Path) -> _Read:
    if root.tag != "OpenSCENARIO":
        raise root.refused("is not OpenSCENARIO XML")
    known = "FileHeader", "CatalogLocations", "ParameterDeclarations", "RoadNetwork", "Entities", "Storyboard"
    for part in root.only(*known):
        if part.tag in ("CatalogLocations", "ParameterDeclarations") and part.parts:
            raise part.parts[0].refused(
                "is outside the subset that is imported; write its values where they are used"
            )
    logic = (root.find("RoadNetwork") or root).find("LogicFile")
    read = _Read(None if logic is None else _beside(file, logic), {})
    for entity in (root.find("Entities") or root).only("ScenarioObject") if root.find("Entities") else ():
        vehicle = entity.one("Vehicle")
        read.vehicles[entity.text("name")] = _Vehicle(entity.text("name"), _front_m(vehicle))
    board = root.find("Storyboard")
    if board is None:
        raise root.refused("has no Storyboard")
    for part in board.only("Init", "Story", "StopTrigger"):
        if part.tag == "Init":
            _init(part.one("Actions"), read)
        elif part.tag == "Story":
            for act in part.only("Act"):
                _act(act, read)
    return read


def _front_m(vehicle: XmlElement) -> float:
    box = vehicle.find("BoundingBox")
    centre, size = (None, None) if box is None else (box.find("Center"), box.find("Dimensions"))
    return 0.0 if centre is None or size is None else centre.number("x") + size.number("length") / 2


def _entity(read: _Read, element: XmlElement) -> _Vehicle:
    name = element.text("entityRef")
    if name not in read.vehicles:
        raise element.refused(f"names no entity {name!r}")
    return read.vehicles[name]


def _init(actions: XmlElement, read: _Read) -> None:
    for part in actions.only("GlobalAction", "Private"):
        if part.tag == "GlobalAction":
            _environment(part.one("EnvironmentAction"), 0.0, read)
            continue
        vehicle = _entity(read, part)
        for action in part.only("PrivateAction"):
            what = action.one("TeleportAction", "LongitudinalAction", "RoutingAction")
            if what.tag == "TeleportAction":
                vehicle.place = _position(what.one("Position"))
            elif what.tag == "LongitudinalAction":
                vehicle.speed_mps = _speed(what)
            else:
                vehicle.goals = list(_route(what))


def _position(position: XmlElement) -> XmlElement:
    return position.one("WorldPosition", "LanePosition")


def _speed(action: XmlElement) -> float:
    speed = action.one("SpeedAction")
    speed.only("SpeedActionDynamics", "SpeedActionTarget")
    target = speed.find("SpeedActionTarget")
    if target is None:
        raise speed.refused("has no SpeedActionTarget")
    return target.one("AbsoluteTargetSpeed").number("value")


def _route(routing: XmlElement) -> Iterator[XmlElement]:
    action = routing.one("AssignRouteAction", "AcquirePositionAction")
    if action.tag == "AcquirePositionAction":
        yield _position(action.one("Position"))
        return
    for waypoint in action.one("Route").only("Waypoint"):
        yield _position(waypoint.one("Position"))


def _act(act: XmlElement, read: _Read) -> None:
    act.only("ManeuverGroup", "StartTrigger", "StopTrigger")
    begins_s = _time(act)
    for group in act.all("ManeuverGroup"):
        group.only("Actors", "Maneuver")
        actors = group.find("Actors")
        named = [] if actors is None else [_entity(read, ref) for ref in actors.only("EntityRef")]
        for maneuver in group.all("Maneuver"):
            for event in maneuver.only("Event"):
                event.only("Action", "StartTrigger")
                at_s = max(begins_s, _time(event))
                for action in event.all("Action"):
                    _story_action(action, at_s, named, read)


def _time(element: XmlElement) -> float:
    """When its trigger lets it begin."""
    trigger = element.find("StartTrigger")
    if trigger is None or not trigger.parts:
        return 0.0
    condition = trigger.one("ConditionGroup").one("Condition")
    time = condition.one("ByValueCondition").one("SimulationTimeCondition")
    if time.text("rule") not in ("greaterThan", "greaterOrEqual"):
        raise time.refused(f"has the rule {time.text('rule')}; greaterThan and greaterOrEqual are imported")
    return max(0.0, time.number("value") + condition.number("delay", 0.0))


def _story_action(action: XmlElement, at_s: float, actors: Sequence[_Vehicle], read: _Read) -> None:
    what = action.one("GlobalAction", "PrivateAction")
    if what.tag == "GlobalAction":
        _environment(what.one("EnvironmentAction"), at_s, read)
        return
    if what.find("RoutingAction") is not None and (way := what.one("RoutingAction").find("FollowTrajectoryAction")):
        raise way.refused("fixes where a vehicle is, which SUMO's drivers decide here; give a route and speeds")
    done = what.one("LongitudinalAction", "LateralAction")
    for vehicle in actors:
        if done.tag == "LongitudinalAction":
            vehicle.actions.append({"at_s": at_s, "speed_kmh": round(_speed(done) * KMH_PER_MPS, 3), "of": done})
        else:
            change = done.one("LaneChangeAction")
            change.only("LaneChangeActionDynamics", "LaneChangeTarget")
            target = change.find("LaneChangeTarget")
            if target is None:
                raise change.refused("has no LaneChangeTarget")
            lanes = round(target.one("RelativeTargetLane").number("value"))
            vehicle.actions.append({"at_s": at_s, "lanes": lanes, "of": done})


def _environment(action: XmlElement, at_s: float, read: _Read) -> None:
    made = action.one("Environment")
    made.only("TimeOfDay", "Weather", "RoadCondition", "ParameterDeclarations")
    clock, weather = made.find("TimeOfDay"), made.find("Weather")
    if clock is not None:
        if at_s > 0:
            raise clock.refused("can be set at the start alone")
        try:
            read.start = datetime.fromisoformat(clock.text("dateTime")).replace(tzinfo=None)
        except ValueError as error:
            raise clock.refused(f"has dateTime = {clock.text('dateTime')!r}, which is no date and time") from error
    if weather is not None:
        read.skies.append((at_s, _sky(weather, read.skies[-1][1] if read.skies else WEATHER)))


def _sky(weather: XmlElement, before: Weather) -> Weather:
    weather.only("Sun", "Fog", "Precipitation", "Wind")
    sky = before
    kelvin = weather.number("temperature", before.temperature_2m + KELVIN)
    cover = OKTAS.get(weather.attributes.get("fractionalCloudCover", ""), before.cloud_cover)
    cover = CLOUDS.get(weather.attributes.get("cloudState", ""), cover)
    sky = replace(sky, temperature_2m=round(kelvin - KELVIN, 2), cloud_cover=cover)
    fog, falls = weather.find("Fog"), weather.find("Precipitation")
    if falls is not None:
        kind = falls.text("precipitationType")
        mm_h = 0.0 if kind == "dry" else falls.number("precipitationIntensity", falls.number("intensity", 0.0))
        code = 0 if not mm_h else (71 if mm_h < 2 else 75) if kind == "snow" else (61 if mm_h < 4 else 65)
        sky = replace(
            sky, precipitation=mm_h, weather_code=code or before.weather_code * (before.precipitation == 0)
        )
    if fog is not None:
        seen_m = fog.number("visualRange")
        is_fog = seen_m < 1000 and not sky.precipitation
        sky = replace(sky, visibility=seen_m, weather_code=45 if is_fog else sky.weather_code)
    return sky


def _beside(file: Path, logic: XmlElement) -> Path:
    """The road that a file names, which may not be elsewhere on this machine."""
    named = logic.text("filepath")
    try:
        road = (file.parent / named).resolve()
        is_beside = road.is_relative_to(file.parent.resolve())
    except (OSError, ValueError):
        is_beside = False
    if not is_beside:
        raise logic.refused(f"names {named[:80]!r}, which is not beside it; copy it there, or give --network")
    return file.parent / named


# --- the road ----------------------------------------------------------------------------------------------------


def _network(source: Path, folder: Path) -> None:
    if source.name.endswith((".net.xml", ".xml")):
        shutil.copyfile(source, folder / NET)
        return
    if source.name.endswith(".xodr"):
        ours = "road.xodr"
        words: tuple[str, ...] = (
            f"--opendrive-files={ours}",
            "--offset.disable-normalization",
            "--output.original-names",
        )
    else:
        ours = f"{NET}.gz"
        words = "-s", ours, "--offset.disable-normalization"
    shutil.copyfile(source, folder / ours)
    ok, printed = run("netconvert", (*words, "-o", NET), folder)
    if not ok:
        raise ScenarioError(f"netconvert cannot read {source}: {first_error(printed)}")


class _Roads:
    """Where places are on a network's lanes, and what leads from one to another."""

    def __init__(self, net: Any) -> None:
        self._net = net
        self._pieces: dict[str, list[Any]] = {}
        every = [lane for edge in net.getEdges() for lane in edge.getLanes()]
        self._lanes = [lane for lane in every if lane.allows("passenger")]
        self._lines = [LineString(lane.getShape()) for lane in self._lanes]
        self._tree = STRtree(self._lines)
        for lane in every:
            for name in lane.getParam("origId", "").split():
                self._pieces.setdefault(name, []).append(lane)

    def lane_at(self, place: XmlElement, ahead_m: float) -> tuple[Any, float]:
        """A lane for cars and how far along it a place is, and ``ahead_m`` further on.

        Raises:
            ScenarioError: it is not on the road.
        """
        if place.tag == "LanePosition":
            return self._on(place, ahead_m)
        x_m, y_m = place.number("x"), place.number("y")
        here = Point(x_m, y_m)
        number, away_m = (
            found.tolist() for found in self._tree.query_nearest(here, return_distance=True, all_matches=False)
        )
        if away_m[0] > NEAR_M:
            raise place.refused(f"is {away_m[0]:.0f} m from the nearest lane for cars")
        lane = self._lanes[number[0]]
        along_m = float(self._lines[number[0]].project(here))
        return lane, min(along_m + ahead_m, lane.getLength())

    def _on(self, place: XmlElement, ahead_m: float) -> tuple[Any, float]:
        name = f"{place.text('roadId')}_{place.text('laneId')}"
        pieces = self._pieces.get(name, [])
        if not pieces:
            raise place.refused(f"is on road and lane {name}, which the network does not have")
        forward = int(place.text("laneId")) < 0
        total_m = sum(lane.getLength() for lane in pieces)
        left_m = place.number("s") if forward else total_m - place.number("s")
        ordered = sorted(pieces, key=lambda lane: lane.getEdge().getID())
        for lane in ordered:
            if left_m <= lane.getLength():
                return lane, min(max(0.0, left_m) + ahead_m, lane.getLength())
            left_m -= lane.getLength()
        return ordered[-1], ordered[-1].getLength()

    def way(self, vehicle: _Vehicle, first: Any) -> list[Any]:
        """Its edges: through its goals, or straight on.

        Raises:
            ScenarioError: no road leads to one of them.
        """
        edges = [first]
        for goal in vehicle.goals:
            target = self.lane_at(goal, 0.0)[0].getEdge()
            found, _ = self._net.getShortestPath(edges[-1], target, vClass="passenger")
            if found is None:
                raise goal.refused(f"cannot be reached by {vehicle.name} from edge {edges[-1].getID()}")
            edges += found[1:]
        return edges if vehicle.goals else edges + list(self._onward(first))

    def _onward(self, edge: Any) -> Iterator[Any]:
        left_m, seen = ONWARD_M, {edge}
        while left_m > 0:
            ways = [
                (connection.getDirection() != "s", there.getID(), there)
                for there, connections in edge.getOutgoing().items()
                for connection in connections
                if there.allows("passenger") and there not in seen
            ]
            if not ways:
                return
            edge = min(ways)[2]
            seen.add(edge)
            left_m -= edge.getLength()
            yield edge


# --- writing -----------------------------------------------------------------------------------------------------


def _write(folder: Path, name: str, file: Path, read: _Read, roads: _Roads, ego: str, country: str) -> None:
    mine = read.vehicles[ego]
    if mine.place is None:
        raise ScenarioError(f"{file}: {ego} has no TeleportAction in Init, so that it has no place")
    if not mine.goals:
        raise ScenarioError(
            f"{file}: {ego} has neither AssignRouteAction nor AcquirePositionAction in Init; give one"
        )
    if mine.actions:
        raise mine.actions[0]["of"].refused(f"acts on {ego}, which SUMO's driver drives; remove it")
    way = roads.way(mine, roads.lane_at(mine.place, 0.0)[0].getEdge())
    via = [roads.lane_at(goal, 0.0)[0].getEdge().getID() for goal in mine.goals[:-1]]
    ends = {way[0].getID(), way[-1].getID()}
    blocks: list[tuple[str, dict[str, Any]]] = [
        (
            "",
            {
                "name": name,
                "title": file.stem,
                "about": f"Imported from {file.name}.",
                "country": country,
                "time_zone": "UTC",
                "start": (read.start or datetime(2026, 6, 16, 10, 0)).replace(microsecond=0),
            },
        ),
        ("[sumo]", asdict(Sumo("road.sumocfg", warm_up_s=0.0))),
        ("[ego]", {"driver": "average"}),
        (
            "[[ego.trips]]",
            {
                "name": "imported",
                "from_edge": way[0].getID(),
                "to_edge": way[-1].getID(),
                "via": [edge for edge in via if edge not in ends] or None,
            },
        ),
    ]
    skies = sorted(read.skies, key=lambda each: each[0])
    if not skies or skies[0][0] > 0:
        skies.insert(0, (0.0, WEATHER))
    blocks += [("[[weather]]", {"at_s": at_s} | asdict(sky)) for at_s, sky in skies]
    for vehicle in read.vehicles.values():
        if vehicle is not mine and vehicle.place is not None:
            blocks += _scripted(vehicle, roads)
    text = ""
    for title, values in blocks:
        text += f"\n{title}\n" if title else ""
        text += "".join(f"{key} = {toml_value(value)}\n" for key, value in values.items() if value is not None)
    (folder / "scenario.toml").write_text(text, encoding="utf-8")
    (folder / ROUTES).write_text("<routes/>\n", encoding="utf-8")
    write_config(folder / "road.sumocfg", NET, ROUTES, Sumo("road.sumocfg", warm_up_s=0.0))


def _scripted(vehicle: _Vehicle, roads: _Roads) -> Iterator[tuple[str, dict[str, Any]]]:
    assert vehicle.place is not None
    lane, at_m = roads.lane_at(vehicle.place, vehicle.front_m)
    edge = lane.getEdge()
    for_cars = [each.getID() for each in edge.getLanes() if each.allows("passenger")]
    yield (
        "[[incidents]]",
        {
            "kind": "vehicle",
            "route": [each.getID() for each in roads.way(vehicle, edge)],
            "position_m": round(at_m, 2),
            "lane": for_cars.index(lane.getID()),
            "speed_kmh": round(vehicle.speed_mps * KMH_PER_MPS, 3),
        },
    )
    for action in sorted(vehicle.actions, key=lambda each: each["at_s"]):
        yield "[[incidents.actions]]", {key: value for key, value in action.items() if key != "of"}
