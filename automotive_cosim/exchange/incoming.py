"""Turns OpenSCENARIO XML into a scenario's folder; what is not carried out is refused by name and line.

``openscenario.txt`` has a word for each element and attribute: ``words``. The road is the OpenDRIVE file that the
scenario names, turned into a network by netconvert, or a SUMO network with the same coordinates.

The ego is the cockpit's car, which SUMO's driver drives; other vehicles are incidents of the kind ``vehicle``.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

import sumolib

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.errors import ScenarioError
from automotive_cosim.exchange.catalogs import unread
from automotive_cosim.exchange.opendrive import ASSUMED
from automotive_cosim.exchange.positions import RoadPositions
from automotive_cosim.exchange.roads import OpenDriveRoad, mirror, read_roads
from automotive_cosim.exchange.storyboard import ReadStory, ScriptEntity, Waited, read_story
from automotive_cosim.formats import bounds
from automotive_cosim.formats.writing import copy, write_whole
from automotive_cosim.osm.folder import WEATHER, appearing, toml_value, write_config
from automotive_cosim.scenarios import Sumo, load
from automotive_cosim.traffic.network import NO_LIMIT_FROM_MPS, drives_on_left, open_to, read_network
from automotive_cosim.traffic.script import EGO as THE_EGO
from automotive_cosim.traffic.sumo_programs import first_error, run

_UNWRITTEN = "element", "when", "lane_id", "meets", "of_meets"
"""What of an action stands in other fields of the scenario."""
EGO = "ego"
TRIP = "imported"
REACTION_S, BRAKES_MPS2 = 1.0, 4.5
"""What SUMO's passenger car keeps and brakes with: its defaults."""
NO_TYPE = re.compile(rb'(<signal\b[^>]*\stype=)(""|\'\')')
"""A sign that says nothing of its kind: netconvert reads it only with a word that stands for none."""
HEIGHTS = re.compile(rb"\+(geoidgrids|geoid_crs|vunits)=[^\s<\]]*")
"""What a projection says of heights, which roads here have not; its grids are on few machines."""
AS_NETCONVERT_HAS = {"stop": "shoulder", "parking": "shoulder", "connectingRamp": "driving", "slipLane": "driving"}
"""Types of lanes that netconvert takes for others: it opens hard shoulders and parking spaces to all cars, and
leaves out ramps between motorways and slip lanes."""
NET, ROUTES = "road.net.xml", "none.rou.xml"


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
        network: a SUMO network in the file's coordinates, instead of the OpenDRIVE file that it names.
        ego: name of the entity that is the cockpit's car.
        country: ISO 3166-1 code, whose law holds; the format has no word for it.
        replaces: whether a scenario in that folder is replaced.

    Raises:
        ScenarioError: something is outside the subset, has no place on the road, or cannot be read.
        SetupError: netconvert is not installed.
    """
    story = read_story(file, ego)
    if ego not in story.entities:
        raise ScenarioError(
            f"{file} has no entity {ego!r}; give --ego one of {', '.join(story.entities) or 'none'}"
        )
    source = network or story.road
    if source is None:
        raise ScenarioError(f"{file} names no road (LogicFile); give --network a SUMO network")
    if not source.is_file():
        raise ScenarioError(f"there is no road {source}, which {file} needs; give --network a SUMO network")
    with appearing(out, replaces=replaces) as folder:
        net, road = road_network(source, folder), source if source.suffix == ".xodr" else story.road
        places = RoadPositions(net, road, keeps_left=drives_on_left(folder / NET))
        has_place = places.net.hasGeoProj() and not read_network(folder / NET).unplaced
        text = scenario_text(out.name, file, story, places, country, has_place=has_place)
        write_whole(folder / "scenario.toml", text)
        write_whole(folder / ROUTES, "<routes/>\n")
        write_config(folder / "road.sumocfg", NET, ROUTES, Sumo("road.sumocfg", warm_up_s=0.0))
        load(folder)
    return out


# --- the road ----------------------------------------------------------------------------------------------------


def road_network(source: Path, folder: Path) -> Any:
    """The network of a road, which is written into a folder.

    Raises:
        ScenarioError: netconvert cannot read the road, or reads it wrongly.
        SetupError: netconvert is not installed.
    """
    if source.name.endswith((".net.xml", ".xml")):
        copy(source, folder / NET, bounds.UNPACKED_BYTES)
        return sumolib.net.readNet(str(folder / NET), withInternal=False)
    ours = "road.xodr" if source.suffix == ".xodr" else f"{NET}.gz"
    words = ("-s", ours) if source.suffix != ".xodr" else (f"--opendrive-files={ours}", "--output.original-names")
    copy(source, folder / ours, bounds.UNPACKED_BYTES)
    keeps_left, limits = _for_netconvert(source, folder / ours) if source.suffix == ".xodr" else (False, {})
    ok, printed = run("netconvert", (*words, "--offset.disable-normalization", "-o", NET), folder)
    if not ok:
        raise ScenarioError(f"netconvert cannot read {source}: {first_error(printed)}")
    if limits:
        root = ET.parse(folder / NET).getroot()
        _mark_stated(root, limits)
        if keeps_left:
            _turn_back(root)
        write_whole(folder / NET, ET.tostring(root, encoding="UTF-8", xml_declaration=True))
    return sumolib.net.readNet(str(folder / NET), withInternal=False)


def _turn_back(net: ET.Element) -> None:
    """Makes a network of roads that were mirrored one that keeps left."""
    mirror(net)
    net.set("lefthand", "true")
    for location in net.iter("location"):
        for name in ("convBoundary", "origBoundary"):
            x, y, x_most, y_most = location.attrib[name].split(",")
            location.set(name, f"{x},{-float(y_most):.2f},{x_most},{-float(y):.2f}")


def _for_netconvert(source: Path, ours: Path) -> tuple[bool, dict[str, bool]]:
    """Makes a file of roads one that netconvert reads rightly; returns whether they keep left, and whether each
    lane, by road and number, has a limit wherever it is.

    It reads no rule: roads that keep left become their mirror image, which keeps right. It reads limits of lanes
    alone, and forgets who may use a lane where its limit changes. What OpenDRIVE 1.8 says of users it refuses.
    """
    roads = read_roads(source)
    keeps_left = any(road.keeps_left for road in roads.values())
    for road in roads.values():
        if road.keeps_left != keeps_left:
            raise road.element.refused("keeps to another side than others of the file, which is not imported")
    root = ET.fromstring(NO_TYPE.sub(rb'\1"-1"', HEIGHTS.sub(b"", ours.read_bytes())))
    for element in root.iter("road"):
        _tell_limits(element, roads[element.attrib["id"]])
    if keeps_left:
        mirror(root)
    write_whole(ours, ET.tostring(root))
    stated: dict[str, bool] = {}
    for element in root.iter("road"):
        if any(each.attrib == ASSUMED for each in element.iterfind("userData")):
            continue
        for lane in element.iterfind("lanes/laneSection/*/lane"):
            name = f"{element.attrib['id']}_{lane.attrib['id']}"
            stated[name] = stated.get(name, True) and any(_offset_m(each) == 0 for each in lane.iter("speed"))
    return keeps_left, stated


def _mark_stated(net: ET.Element, stated: Mapping[str, bool]) -> None:
    """Marks the limits of a network's edges that the roads' file states: they are posted, the others assumed."""
    for edge in net.iterfind("edge[lane]"):
        lanes = [lane for lane in edge.iterfind("lane") if open_to(lane.attrib)]
        names = [each.get("value", "") for lane in lanes for each in lane.iterfind("param[@key='origId']")]
        if names and all(stated.get(each) for name in names for each in name.split()):
            fastest_mps = max(float(lane.attrib["speed"]) for lane in lanes)
            told = "none" if fastest_mps >= NO_LIMIT_FROM_MPS else f"{fastest_mps * KMH_PER_MPS:.4g}"
            ET.SubElement(edge, "param", key="maxspeed", value=told)


def _tell_limits(element: ET.Element, road: OpenDriveRoad) -> None:
    """States the limits of a road for its lanes, up to where they state their own."""
    limits = sorted(road.limits())
    sections = element.findall("lanes/laneSection")
    ends_m = [*(float(section.attrib["s"]) for section in sections[1:]), road.length_m]
    for section, end_m in zip(sections, ends_m, strict=True):
        from_m = float(section.attrib["s"])
        here = {max(0.0, at_m - from_m): mps for at_m, mps in limits if at_m < end_m}
        for lane in section.iterfind("*/lane"):
            lane.set("type", AS_NETCONVERT_HAS.get(lane.get("type", ""), lane.get("type", "")))
            _restate(lane, here)


def _restate(lane: ET.Element, limits: Mapping[float, float]) -> None:
    """States the limits of the road up to the lane's own, and who may use it wherever its limit changes."""
    own_m = min(map(_offset_m, lane.findall("speed")), default=math.inf)
    for at_m, mps in limits.items():
        if at_m < own_m:
            ET.SubElement(lane, "speed", sOffset=repr(at_m), max=repr(mps))
    users: dict[float, list[dict[str, str]]] = {}
    for access in lane.findall("access"):
        parts = [{"restriction": each.attrib["type"]} for each in access.findall("restriction")]
        users.setdefault(_offset_m(access), []).extend(access.attrib | each for each in parts or [{}])
        lane.remove(access)
    for at_m in sorted({*users, *map(_offset_m, lane.findall("speed"))}):
        for attributes in users.get(max((each for each in users if each <= at_m), default=-1.0), ()):
            ET.SubElement(lane, "access", attributes | {"sOffset": repr(at_m)})


def _offset_m(element: ET.Element) -> float:
    return float(element.get("sOffset", "0"))


# --- writing -----------------------------------------------------------------------------------------------------


def scenario_text(
    name: str, file: Path, story: ReadStory, places: RoadPositions, country: str, *, has_place: bool
) -> str:
    """The ``scenario.toml`` of what a file says.

    Raises ScenarioError: something has no place on the road, acts on the ego, or is not imported."""
    mine = story.entities[story.ego]
    if mine.actions:
        raise mine.actions[0]["element"].refused(f"acts on {story.ego}, which SUMO's driver drives; remove it")
    lane, at_m = _start(mine, story, places)
    goals = [places.spot(goal, story.entities) for goal in mine.goals]
    way = places.way(mine.name, lane.getEdge(), goals)
    via = [places.lane_at(goal, is_goal=True)[0].getEdge().getID() for goal in goals[:-1]]
    ends = {way[0].getID(), way[-1].getID()}
    blocks: list[tuple[str, Mapping[str, Any]]] = [
        (
            "",
            {
                "name": name,
                "title": file.stem,
                "about": f"Imported from {file.name}.",
                "country": country,
                "time_zone": "UTC",
                "has_place": None if has_place else False,
                "start": (story.start or datetime(2026, 6, 16, 10, 0)).replace(microsecond=0),
            },
        ),
        ("[sumo]", asdict(Sumo("road.sumocfg", warm_up_s=0.0))),
        ("[ego]", {"driver": "average"}),
        (
            "[[ego.trips]]",
            {
                "name": TRIP,
                "from_edge": way[0].getID(),
                "to_edge": way[-1].getID(),
                "via": [edge for edge in via if edge not in ends] or None,
                "from_m": round(at_m, 2),
                "from_lane": _place_of(lane),
                "from_kmh": round(mine.speed_mps * KMH_PER_MPS, 3),
            },
        ),
    ]
    _check_room(story, places)
    skies = sorted(story.skies, key=lambda each: each[0])
    if not skies or skies[0][0] > 0:
        skies.insert(0, (0.0, WEATHER))
    blocks += [("[[weather]]", {"at_s": at_s} | asdict(sky)) for at_s, sky in skies]
    signals = _wanted(story)
    for entity in story.entities.values():
        if entity is not mine:
            blocks += _scripted(entity, story, places, signals)
            signals = []
    text = ""
    for title, values in blocks:
        text += f"\n{title}\n" if title else ""
        text += "".join(f"{key} = {toml_value(value)}\n" for key, value in values.items() if value is not None)
    for signal in story.signals:  # also those for which nothing waits name places
        for condition in (each for group in signal["when"] for each in group):
            _waits(condition, 0, story, places)
    unread(story.root)
    return text


def _start(entity: ScriptEntity, story: ReadStory, places: RoadPositions) -> tuple[Any, float]:
    """The lane on which a vehicle is at first, and how far along it its front bumper is."""
    if entity.place is None:
        raise entity.element.refused(f"named {entity.name} has no TeleportAction in Init, so that it has no place")
    return places.lane_at(places.spot(entity.place, story.entities), entity.front_m)


def _check_room(story: ReadStory, places: RoadPositions) -> None:
    """Checks that SUMO lets all in at their first speeds: a follower must be able to brake behind its leader."""
    by_lane: dict[str, list[tuple[float, float, ScriptEntity]]] = {}
    for entity in story.entities.values():
        lane, at_m = _start(entity, story, places)
        mps = min(entity.speed_mps, lane.getSpeed()) if entity.name == story.ego else entity.speed_mps
        by_lane.setdefault(lane.getID(), []).append((at_m, mps, entity))
    for each in by_lane.values():
        each.sort(key=lambda place: place[0])
        for (at_m, mps, follower), (ahead_m, ahead_mps, leader) in pairwise(each):
            gap_m = ahead_m - leader.length_m - at_m
            if gap_m < mps * REACTION_S + max(0.0, mps**2 - ahead_mps**2) / (2 * BRAKES_MPS2):
                raise follower.element.refused(
                    f"named {follower.name} begins {gap_m:.0f} m behind {leader.name} with {mps:.1f} m/s, too near "
                    "for SUMO to let it in; give it more room"
                )


def _place_of(lane: Any) -> int:
    """A lane's place among those for cars of its edge."""
    return [each.getID() for each in lane.getEdge().getLanes() if each.allows("passenger")].index(lane.getID())


def _wanted(story: ReadStory) -> list[dict[str, Any]]:
    """The beginnings and ends of acts that something waits for."""
    actions = [action for entity in story.entities.values() for action in entity.actions]
    waited = {each.get("of") for action in (*actions, *story.signals) for group in action["when"] for each in group}
    return [signal for signal in story.signals if signal["name"] in waited]


def _scripted(
    entity: ScriptEntity, story: ReadStory, places: RoadPositions, signals: list[dict[str, Any]]
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    lane, at_m = _start(entity, story, places)
    way = _way(entity, story, places)
    yield (
        "[[incidents]]",
        {
            "kind": "vehicle",
            "trip": TRIP,
            "name": _called(entity.name, story),
            "route": [each.getID() for each in way],
            "position_m": round(at_m, 2),
            "lane": _place_of(lane),
            "speed_kmh": round(entity.speed_mps * KMH_PER_MPS, 3),
            "length_m": entity.length_m,
            "keeps_lane": True,
        },
    )
    _check_lanes(entity, lane, way, -1 if places.keeps_left else 1)
    for name, action in {each["of"]: each for each in entity.actions if "lanes" in each}.items():
        if set(way).isdisjoint(_way(story.entities[name], story, places)):
            raise action["element"].refused(
                f"counts lanes from {name}, which never drives along with {entity.name}"
            )
    for action in sorted((*signals, *entity.actions), key=lambda each: each["at_s"]):
        told = {key: value for key, value in action.items() if key not in _UNWRITTEN}
        for key, whose in (("meets", entity), ("of_meets", story.entities.get(action.get("of", "")))):
            if key in action and whose is not None:
                there, there_m = places.lane_at(places.spot(action[key], story.entities), whose.front_m)
                told |= {f"{key}_edge": there.getEdge().getID(), f"{key}_m": round(there_m, 2)}
        if "of" in told:
            told["of"] = _called(told["of"], story)
        if "lane_id" in action:
            road = lane.getParam("origId", "").split(" ")[0].rpartition("_")[0]
            told["lane"] = places.lane_of(way, road, action["lane_id"])
            if told["lane"] is None:
                raise action["element"].refused(f"names lane {action['lane_id']}, which is no one lane of the way")
        yield "[[incidents.actions]]", told
        for number, group in enumerate(action["when"]):
            for condition in group:
                yield "[[incidents.actions.when]]", _waits(condition, number, story, places)


def _way(entity: ScriptEntity, story: ReadStory, places: RoadPositions) -> Sequence[Any]:
    """The edges along which a vehicle drives."""
    lane, _ = _start(entity, story, places)
    return places.way(entity.name, lane.getEdge(), [places.spot(goal, story.entities) for goal in entity.goals])


def _check_lanes(entity: ScriptEntity, lane: Any, way: Sequence[Any], left: int) -> None:
    """Checks that no change from its own lane leads onto the other side of the road, or off it."""
    counts = [sum(each.allows("passenger") for each in edge.getLanes()) for edge in way]
    everywhere = set(range(counts[0] - max(counts), max(counts)))
    at = {_place_of(lane)}
    for action in sorted(entity.actions, key=lambda each: each["at_s"]):
        if action.get("lanes") and action["of"] == entity.name:
            moved = everywhere & {each + left * action["lanes"] for each in at}
            if not moved:
                raise action["element"].refused(f"leads {entity.name} to a lane that its side of the road has not")
            at |= moved
        elif "lanes" in action or "lane_id" in action:
            at = everywhere


def _called(name: str, story: ReadStory) -> str:
    """What the scenario calls a vehicle: another than the ego may have its name in the file."""
    if name == story.ego:
        return THE_EGO
    return f"{name} of the file" if name == THE_EGO else name


def _waits(condition: Waited, group: int, story: ReadStory, places: RoadPositions) -> dict[str, Any]:
    told = {key: value for key, value in condition.items() if key not in ("element", "position") and value}
    told |= {
        key: _called(told[key], story)
        for key in ("of", "to")
        if told["what"] not in ("begun", "ended") and key in told
    }
    if "position" in condition:
        spot = places.spot(condition["position"], story.entities)
        x_m, y_m = places.front(spot, story.entities[condition["of"]].front_m)
        told |= {"x_m": round(x_m, 2), "y_m": round(y_m, 2)}
    return told | {"group": group}
