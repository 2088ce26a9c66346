"""What an OpenSCENARIO file says: its vehicles, what they do and when, and the sky."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import KMH_PER_MPS, Weather
from automotive_cosim.exchange.catalogs import Catalogs
from automotive_cosim.exchange.openscenario import KELVIN
from automotive_cosim.exchange.tree import XmlElement, read_tree
from automotive_cosim.osm.folder import WEATHER

OKTAS = {f"{word}Oktas": min(100.0, 12.5 * number) for number, word in enumerate(
    ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
)}  # fmt: skip
CLOUDS = {"free": 0.0, "cloudy": 60.0, "overcast": 100.0, "rainy": 100.0, "skyOff": 100.0}
"""Cover in per cent by the former attribute ``cloudState``."""
VIOLENT_MM_H = 50.0
"""The rain whose share the former attribute ``intensity`` is: from here on the Met Office calls it violent."""
DRIVEN = "car", "van", "truck", "bus", "motorbike"
"""Categories of vehicles whose place a car of their length takes."""
TRAILERS = "trailer", "semitrailer"
BELOW = {"greaterThan": False, "greaterOrEqual": False, "lessThan": True, "lessOrEqual": True}
BEGUN, ENDED = ("startTransition", "runningState"), ("endTransition", "completeState")
"""States of the storyboard's elements."""
_NAMED = "Story", "Act", "ManeuverGroup", "Maneuver", "Event"
OFFSET_M = 0.5
"""A vehicle that is to keep so far off the middle of its lane is in the middle of it."""

Waited = dict[str, Any]
"""As in ``[[incidents.actions.when]]``; ``position`` stands for x_m and y_m until the road is known."""
WaitedGroups = list[list[Waited]]
"""Groups of conditions, of which all of one must hold."""


@dataclass(slots=True)
class ScriptEntity:
    """A vehicle, as it is read."""

    name: str
    element: XmlElement
    front_m: float
    """From the reference point to the front bumper."""
    length_m: float
    place: XmlElement | None = None
    speed_mps: float = 0.0
    goals: list[XmlElement] = field(default_factory=list)
    """Positions of the route, the last is where it ends."""
    actions: list[dict[str, Any]] = field(default_factory=list)


@dataclass(slots=True)
class ReadStory:
    """What a file says."""

    root: XmlElement
    road: Path | None
    entities: dict[str, ScriptEntity] = field(default_factory=dict)
    ego: str = ""
    pulled: set[str] = field(default_factory=set)
    """Entities that are trailers: parts of what pulls them."""
    start: datetime | None = None
    skies: list[tuple[float, Weather]] = field(default_factory=list)
    names: dict[int, str] = field(default_factory=dict)
    """What each event is called."""
    parts: dict[tuple[str, str], list[tuple[str, str]]] = field(default_factory=dict)
    """Events and their acts by the type and name of the element of the storyboard that they are in."""
    again: set[str] = field(default_factory=set)
    """The events that are carried out more than once."""
    signals: list[dict[str, Any]] = field(default_factory=list)
    """Actions without an effect: they begin when an act begins or stops."""


def read_story(file: Path, ego: str) -> ReadStory:
    """What a file says.

    Args:
        file: OpenSCENARIO XML.
        ego: name of the entity that is the cockpit's car.

    Raises ScenarioError: something is outside what is imported."""
    root = read_tree(file)
    if root.tag != "OpenSCENARIO":
        raise root.refused("is not OpenSCENARIO XML")
    Catalogs(root).complete(root, {})
    logic = (root.find("RoadNetwork") or root).find("LogicFile")
    story = ReadStory(root, None if logic is None else logic.beside("filepath"), ego=ego)
    for entities in root.all("Entities"):
        every = {entity.text("name"): entity for entity in entities.all("ScenarioObject")}
        for entity in every.values():
            if (made := _entity(entity, every, story)) is not None:
                story.entities[made.name] = made
        for name in every.keys() - story.entities.keys() - story.pulled:
            raise every[name].refused(f"named {name} is a trailer that nothing pulls; remove it")
    board = root.part("Storyboard")
    if (init := board.find("Init")) is not None:
        _init(init.part("Actions"), story)
    _number(board, story)
    until = _trigger(board.find("StopTrigger"), story)
    for part in board.all("Story"):
        for act in part.all("Act"):
            _act(act, story, until)
    return story


def _entity(entity: XmlElement, every: Mapping[str, XmlElement], story: ReadStory) -> ScriptEntity | None:
    """None for a trailer, which is a part of what pulls it."""
    vehicle = entity.find("Vehicle") or entity.part("MiscObject")
    if vehicle.tag == "Vehicle" and vehicle.word("vehicleCategory", *DRIVEN, *TRAILERS) in TRAILERS:
        return None
    box = vehicle.part("BoundingBox")
    front_m = box.part("Center").number("x") + box.part("Dimensions").number("length") / 2
    return ScriptEntity(entity.text("name"), entity, front_m, front_m - _rear_m(vehicle, every, story))


def _rear_m(vehicle: XmlElement, every: Mapping[str, XmlElement], story: ReadStory) -> float:
    """How far before its reference point a vehicle ends, with the trailers behind it; less than 0."""
    box = vehicle.part("BoundingBox")
    ends_m = box.part("Center").number("x") - box.part("Dimensions").number("length") / 2
    hitch, coupler, trailer = (vehicle.find(name) for name in ("TrailerHitch", "TrailerCoupler", "Trailer"))
    for part in filter(None, (hitch, coupler)):  # of account only where something is pulled
        part.number("dx")
    if trailer is None:
        return ends_m
    pulled: XmlElement | None = trailer.find("TrailerRef") or trailer.part("Trailer")
    if pulled is not None and pulled.tag == "TrailerRef":
        if not (name := pulled.text("entityRef")):
            return ends_m
        if (pulled := every.get(name)) is None or name in story.pulled:
            raise trailer.refused(f"names {name!r}, which is no entity, or is pulled already")
        story.pulled.add(name)
    assert pulled is not None
    pulled.text("name", "")
    behind = pulled.part("Vehicle")
    behind.word("vehicleCategory", *TRAILERS)
    hangs_m = vehicle.part("TrailerHitch").number("dx") - behind.part("TrailerCoupler").number("dx")
    return min(ends_m, hangs_m + _rear_m(behind, every, story))


def _named(story: ReadStory, element: XmlElement) -> ScriptEntity:
    name = element.text("entityRef")
    if name not in story.entities:
        raise element.refused(f"names no entity {name!r}")
    return story.entities[name]


# --- the start ---------------------------------------------------------------------------------------------------


def _init(actions: XmlElement, story: ReadStory) -> None:
    for part in actions.only("GlobalAction", "Private"):
        if part.tag == "GlobalAction":
            _environment(part.one("EnvironmentAction"), 0.0, story)
            continue
        if part.text("entityRef") in story.pulled:
            for action in part.all("PrivateAction"):
                action.one("TeleportAction").take()
            continue
        entity = _named(story, part)
        for action in part.all("PrivateAction"):
            for what in action.only(*_AT_THE_START):
                _AT_THE_START[what.tag](what, entity, story)


def _starts_at(action: XmlElement, entity: ScriptEntity, story: ReadStory) -> None:
    entity.place = action.part("Position")


def _starts_with(action: XmlElement, entity: ScriptEntity, story: ReadStory) -> None:
    made = _speed(action, story)
    if "bumper" in made:
        if entity.name != story.ego:
            entity.actions.append(made | {"name": "", "at_s": 0.0, "when": [], "element": action})
            return
        raise action.refused(f"acts on {story.ego}, which SUMO's driver drives; remove it")
    target = action.one("SpeedAction").part("SpeedActionTarget").parts[0]
    over = {key: made[key] for key in ("over_s", "over_m", "rate") if key in made}
    if "of" not in made:
        mps = target.number("value")
    else:  # that of the other one so far
        mps = made["speed_share"] * _named(story, target).speed_mps + made.get("faster_kmh", 0.0) / KMH_PER_MPS
    if over or made.get("keeps"):
        if entity.name == story.ego:
            made = {}
        else:
            entity.actions.append(made | {"name": "", "at_s": 0.0, "when": [], "element": action})
    if not over:
        entity.speed_mps = mps


def _takes(routing: XmlElement, entity: ScriptEntity, story: ReadStory) -> None:
    action = routing.one("AssignRouteAction", "AcquirePositionAction")
    if action.tag == "AcquirePositionAction":
        entity.goals = [action.part("Position")]
        return
    entity.goals = route_goals(action.one("Route"))


def route_goals(route: XmlElement) -> list[XmlElement]:
    """The positions of a route. Raises ScenarioError: it goes round, or has none."""
    if route.is_true("closed"):
        raise route.refused("has closed = true, which is not imported; end it at its last waypoint")
    goals = [waypoint.part("Position") for waypoint in route.all("Waypoint")]
    if not goals:
        raise route.refused("has no Waypoint")
    return goals


def _driven_by(action: XmlElement, entity: ScriptEntity, story: ReadStory) -> None:
    """SUMO's driver drives, whichever controller does elsewhere; pedals and wheel are nobody else's."""
    for part in action.all("OverrideControllerValueAction"):
        for value in part.only("Brake", "Clutch", "Gear", "ParkingBrake", "SteeringWheel", "Throttle"):
            if value.is_true("active"):
                raise value.refused("has active = true, which is not imported; SUMO's drivers drive")


def _is_seen(action: XmlElement, entity: ScriptEntity, story: ReadStory) -> None:
    if not action.is_true("traffic"):
        raise action.refused("hides a vehicle from traffic, which is not imported; remove it")


def _looks(action: XmlElement, entity: ScriptEntity, story: ReadStory) -> None:
    """Lamps and gestures are not shown."""


_AT_THE_START = {
    "ActivateControllerAction": _driven_by,
    "AppearanceAction": _looks,
    "ControllerAction": _driven_by,
    "LongitudinalAction": _starts_with,
    "RoutingAction": _takes,
    "TeleportAction": _starts_at,
    "VisibilityAction": _is_seen,
}


_WITHOUT_EFFECT = "ActivateControllerAction", "AppearanceAction", "ControllerAction", "VisibilityAction"
"""Actions that change nothing here, or are refused."""


def _environment(action: XmlElement, at_s: float, story: ReadStory) -> None:
    made = action.one("Environment")
    clock, weather = made.find("TimeOfDay"), made.find("Weather")
    if clock is not None:
        if at_s > 0:
            raise clock.refused("can be set at the start alone")
        try:
            story.start = datetime.fromisoformat(clock.text("dateTime")).replace(tzinfo=None)
        except ValueError as error:
            raise clock.refused(f"has dateTime = {clock.text('dateTime')!r}, which is no date and time") from error
    if weather is not None:
        story.skies.append((at_s, _sky(weather, story.skies[-1][1] if story.skies else WEATHER)))


def _sky(weather: XmlElement, before: Weather) -> Weather:
    cover = before.cloud_cover
    for name, covers in (("fractionalCloudCover", OKTAS), ("cloudState", CLOUDS)):
        if name in weather.attributes:
            cover = covers[weather.word(name, *covers)]
    kelvin = weather.number("temperature", before.temperature_2m + KELVIN)
    sky = replace(before, temperature_2m=round(kelvin - KELVIN, 2), cloud_cover=cover)
    fog, falls = weather.find("Fog"), weather.find("Precipitation")
    if falls is not None:
        kind = falls.word("precipitationType", "dry", "rain", "snow")
        share = falls.number("intensity", 0.0)
        if not 0 <= share <= 1:
            raise falls.refused(
                f"has intensity = {share:g}, a share from 0 to 1; give precipitationIntensity in mm/h"
            )
        mm_h = falls.number("precipitationIntensity", VIOLENT_MM_H * share)
        mm_h = 0.0 if kind == "dry" else mm_h
        code = 0 if not mm_h else (71 if mm_h < 2 else 75) if kind == "snow" else (61 if mm_h < 4 else 65)
        sky = replace(
            sky, precipitation=mm_h, weather_code=code or before.weather_code * (before.precipitation == 0)
        )
    if fog is not None:
        seen_m = fog.number("visualRange")
        is_fog = seen_m < 1000 and not sky.precipitation
        sky = replace(sky, visibility=seen_m, weather_code=45 if is_fog else sky.weather_code)
    return sky


# --- when --------------------------------------------------------------------------------------------------------


def _number(board: XmlElement, story: ReadStory) -> None:
    """Gives every event a name of its own, and notes which events each element of the storyboard has."""
    events: list[tuple[XmlElement, list[XmlElement]]] = []

    def walk(element: XmlElement, around: list[XmlElement]) -> None:
        if element.tag == "Event":
            events.append((element, around))
        for part in element.parts:
            if part.tag in _NAMED:
                part.text("name", "")
                element.taken.add(part.tag)
                walk(part, [*around, part])

    walk(board, [])
    count = Counter(event.text("name") for event, _ in events)
    for event, around in events:
        name = event.text("name")
        if count[name] > 1:
            name = " / ".join(each.text("name") for each in around)
        if name in story.names.values():
            raise event.refused(f"has name = {name!r} as another event here has; give it one of its own")
        story.names[id(event)] = name
        if event.number("maximumExecutionCount", 1.0) > 1:
            story.again.add(name)
        act = f"act {next(each for each in around if each.tag == 'Act').text('name')}"
        for each in (*around, *event.all("Action")):
            key = each.tag[0].lower() + each.tag[1:], each.text("name")
            story.parts.setdefault(key, []).append((name, act))


def _trigger(trigger: XmlElement | None, story: ReadStory) -> WaitedGroups:
    """Its conditions; none if there is no trigger. What can never hold is left out."""
    found: WaitedGroups = []
    for group in () if trigger is None else trigger.all("ConditionGroup"):
        alternatives: WaitedGroups = [[]]
        for condition in group.all("Condition"):
            ways = list(_condition(condition, story))
            alternatives = [[*before, *way] for before in alternatives for way in ways]
        found += alternatives
    return found


def _condition(condition: XmlElement, story: ReadStory) -> Iterator[list[Waited]]:
    """The ways in which it can hold."""
    edge = condition.word("conditionEdge", "none", "rising", "falling", "risingOrFalling", otherwise="none")
    shared: Waited = {
        "edge": "" if edge == "none" else edge,
        "delay_s": max(0.0, condition.number("delay", 0.0)),
    }
    by = condition.one("ByValueCondition", "ByEntityCondition")
    if by.tag == "ByValueCondition":
        yield from _by_value(by, shared, story)
        return
    actors = by.part("TriggeringEntities")
    wanted = actors.word("triggeringEntitiesRule", "any", "all")
    what = by.part("EntityCondition").one(*_OF_ENTITIES)
    each = [shared | {"of": _named(story, ref).name} | _of_entity(what, story) for ref in actors.all("EntityRef")]
    if wanted == "all":
        yield each
    else:
        yield from ([one] for one in each)


def _by_value(by: XmlElement, shared: Waited, story: ReadStory) -> Iterator[list[Waited]]:
    what = by.one("SimulationTimeCondition", "ParameterCondition", "StoryboardElementStateCondition")
    if what.tag == "SimulationTimeCondition":
        rule = what.word("rule", *BELOW)
        yield [shared | {"what": "time", "value": what.number("value"), "below": BELOW[rule]}]
    elif what.tag == "ParameterCondition":
        name = what.attributes.get("parameterRef", "").lstrip("$")
        what.taken.update(("parameterRef", "value", "rule"))
        if not name:
            return
        if name not in what.scope:
            raise what.refused(f"names no parameter {name!r}")
        if _holds(what.scope[name], what.word("rule", *BELOW, "equalTo", "notEqualTo"), what.text("value")):
            yield []
    else:
        kind, name = what.text("storyboardElementType"), what.text("storyboardElementRef").rpartition("::")[2]
        events = story.parts.get((kind, name), [])
        state = what.word("state", *BEGUN, *ENDED)
        if not events:
            raise what.refused(f"names no {kind} {name!r}")
        is_each = state == "endTransition" or (state in BEGUN and kind in ("event", "action"))
        if is_each and any(event in story.again for event, _ in events):
            raise what.refused("waits for an event that is carried out more than once, which is not imported")
        if shared["edge"] == "falling":
            return
        shared = {**shared, "edge": ""}  # what has begun or ended stays so
        if state in ENDED:
            yield [shared | {"what": "ended", "of": event} for event in dict.fromkeys(event for event, _ in events)]
        elif kind == "story":
            yield [shared | {"what": "time", "value": 0.0, "below": False}]  # it begins with the storyboard
        else:  # a group of manoeuvres and a manoeuvre begin with their act
            begins = dict.fromkeys(event if kind in ("event", "action") else act for event, act in events)
            yield from ([shared | {"what": "begun", "of": each}] for each in begins)


def _holds(value: str, rule: str, wanted: str) -> bool:
    if rule in ("equalTo", "notEqualTo"):
        return (value == wanted) == (rule == "equalTo")
    try:
        difference = float(value) - float(wanted)
    except ValueError:
        return False
    return difference < 0 if BELOW[rule] else difference > 0 or (rule == "greaterOrEqual" and difference == 0)


def _of_entity(what: XmlElement, story: ReadStory) -> Waited:
    name, number = _OF_ENTITIES[what.tag]
    made: Waited = {"what": name, "value": what.number(number), "below": False, "element": what}
    if what.tag == "ReachPositionCondition":
        return made | {"position": what.part("Position"), "below": True}
    if "rule" in what.attributes:
        rule = what.word("rule", *BELOW, "equalTo")
        made |= {"below": BELOW.get(rule, False), "equal": rule == "equalTo"}
    if "entityRef" in what.attributes:
        made["to"] = _named(story, what).name
    if what.tag == "TimeToCollisionCondition":
        made["to"] = _named(story, what.part("TimeToCollisionConditionTarget").one("EntityRef")).name
    if what.tag in ("RelativeDistanceCondition", "TimeHeadwayCondition", "TimeToCollisionCondition"):
        made["bumper"] = what.is_true("freespace")
        kinds = "longitudinal", "euclidianDistance", "cartesianDistance"
        made["straight"] = what.word("relativeDistanceType", *kinds, otherwise="longitudinal") != "longitudinal"
    return made


_OF_ENTITIES = {
    "AccelerationCondition": ("acceleration", "value"),
    "EndOfRoadCondition": ("left", "duration"),
    "ReachPositionCondition": ("place", "tolerance"),
    "RelativeDistanceCondition": ("distance", "value"),
    "RelativeSpeedCondition": ("faster", "value"),
    "SpeedCondition": ("speed", "value"),
    "StandStillCondition": ("stands", "duration"),
    "TimeHeadwayCondition": ("headway", "value"),
    "TimeToCollisionCondition": ("collision_time", "value"),
    "TraveledDistanceCondition": ("travelled", "value"),
}
"""What they are called here, and the attribute with the number."""


def _at_s(trigger: WaitedGroups) -> float | None:
    """When it holds, if that is a matter of time alone, and lasts."""
    times: list[float] = []
    for group in trigger:
        if any(each["what"] != "time" or each["below"] for each in group):
            return None
        times.append(max((each["value"] + each["delay_s"] for each in group), default=0.0))
    return max(0.0, min(times, default=0.0))


# --- what then ---------------------------------------------------------------------------------------------------


def _act(act: XmlElement, story: ReadStory, until: WaitedGroups) -> None:
    name = f"act {act.text('name')}"
    if any(each["name"] == name for each in story.signals):
        raise act.refused(f"has name = {act.text('name')!r} as another act has; give it one of its own")
    begins, stops = _begins(act, story), [*until, *_trigger(act.find("StopTrigger"), story)]
    if begins is None:
        return
    begins_s, ends_s = _at_s(begins), _at_s(stops) if stops else float("inf")
    story.signals.append({"name": name, "at_s": begins_s or 0.0, "when": begins if begins_s is None else []})
    also: list[Waited] = [] if begins_s is not None else [{"what": "begun", "of": name}]
    if ends_s is None:
        story.signals.append({"name": f"end of {name}", "at_s": 0.0, "when": stops})
        also.append({"what": "begun", "of": f"end of {name}", "below": True})
        ends_s = float("inf")
    for group in act.all("ManeuverGroup"):
        if _times(group) > 1:
            raise group.refused("is carried out more than once, which is not imported; write it as often")
        actors = group.part("Actors")
        if actors.is_true("selectTriggeringEntities", otherwise="false"):
            raise actors.refused("has selectTriggeringEntities = true, which is not imported; name them")
        named = [_named(story, ref) for ref in actors.all("EntityRef")]
        for maneuver in group.all("Maneuver"):
            for event in maneuver.all("Event"):
                _event(event, (begins_s or 0.0, ends_s), also, named, story)


def _begins(element: XmlElement, story: ReadStory) -> WaitedGroups | None:
    """When an act or event begins: at once without a trigger, never (None) if nothing in it can hold."""
    start = element.find("StartTrigger")
    if start is None or not start.parts:
        return [[]]
    return _trigger(start, story) or None


def _event(
    event: XmlElement,
    lasts: tuple[float, float],
    also: Sequence[Waited],
    actors: Sequence[ScriptEntity],
    story: ReadStory,
) -> None:
    times = _times(event)
    begins_s, ends_s = lasts
    trigger = _begins(event, story)
    at_s = None if trigger is None else _at_s(trigger)
    if at_s is not None and times > 1:
        if any(not each["edge"] for group in trigger or () for each in group or ({"edge": ""},)):
            raise event.refused("is carried out again at once, which is not imported; give it a condition")
        times = 1  # a time comes once
    is_over = trigger is None or max(begins_s, at_s or 0.0) >= ends_s
    when: WaitedGroups = []
    if at_s is None and ends_s < float("inf"):
        also = [*also, {"what": "time", "value": ends_s, "below": True}]
    for group in trigger or ():
        when.append([*also, *(group if at_s is None else ())])
    shared: dict[str, Any] = {
        "name": story.names[id(event)],
        "at_s": max(begins_s, at_s or 0.0),
        "when": [group for group in when if group],
        "alone": event.word("priority", "overwrite", "override", "parallel") != "parallel",
    }
    again = {"times": times} if times > 1 else {}
    signal = {"name": shared["name"], "at_s": shared["at_s"], "when": shared["when"]} | again
    for action in event.all("Action"):
        what = action.one("GlobalAction", "PrivateAction")
        if what.tag == "GlobalAction":
            if shared["when"]:
                raise what.refused("waits for more than a time, which is not imported")
            if is_over:
                raise what.refused("can never happen; remove it")
            _environment(what.one("EnvironmentAction"), shared["at_s"], story)
            story.signals.append(signal)
            continue
        done = what.one(*_CHANGES, *_WITHOUT_EFFECT)
        if done.tag in _WITHOUT_EFFECT:
            for actor in actors:
                _AT_THE_START[done.tag](done, actor, story)
            if not is_over:
                story.signals.append(signal)
            continue
        change = _CHANGES[done.tag]
        for actor in actors:
            made = shared | change(done, story) | {"element": done} | again
            if not is_over:
                actor.actions.append(made)


def _times(element: XmlElement) -> int:
    times = element.number("maximumExecutionCount", 1.0)
    if times < 1 or times != round(times):
        raise element.refused(f"has maximumExecutionCount = {times:g}; a whole number from 1 on is needed")
    return round(times)


def _dynamics(dynamics: XmlElement) -> dict[str, Any]:
    """How a change comes about."""
    shape = dynamics.word("dynamicsShape", "step", "linear", "sinusoidal", "cubic")
    kind, value = dynamics.word("dynamicsDimension", "time", "rate", "distance"), abs(dynamics.number("value"))
    if shape == "step" or not value:
        return {}
    if kind == "distance":
        return {"over_m": value}
    return {"over_s": value} if kind == "time" else {"rate": value}


def _speed(action: XmlElement, story: ReadStory) -> dict[str, Any]:
    speed = action.one("SpeedAction", "LongitudinalDistanceAction")
    if speed.tag == "LongitudinalDistanceAction":
        return _gap(speed, story)
    made = _dynamics(speed.part("SpeedActionDynamics"))
    target = speed.part("SpeedActionTarget").one("AbsoluteTargetSpeed", "RelativeTargetSpeed")
    value = target.number("value")
    if target.tag == "AbsoluteTargetSpeed":
        if value < 0:
            raise target.refused(f"has value = {value:g}; vehicles do not reverse here")
        return made | {"speed_kmh": round(value * KMH_PER_MPS, 3)}
    made |= {"of": _named(story, target).name, "keeps": target.is_true("continuous")}
    if target.word("speedTargetValueType", "delta", "factor") == "factor":
        return made | {"speed_share": value}
    return made | {"speed_share": 1.0, "faster_kmh": round(value * KMH_PER_MPS, 3)}


def _gap(action: XmlElement, story: ReadStory) -> dict[str, Any]:
    sides = "any", "trailingReferencedEntity"
    made = {
        "of": _named(story, action).name,
        "keeps": action.is_true("continuous"),
        "bumper": action.is_true("freespace"),
        "trails": action.word("displacement", *sides, otherwise="any") != "any",
    }
    given = [name for name in ("distance", "timeGap") if name in action.attributes]
    if len(given) != 1:
        raise action.refused("needs either distance or timeGap")
    value = action.number(given[0])
    if value < 0:
        raise action.refused(f"has {given[0]} = {value:g}, which must not be negative")
    return made | {"gap_m" if given[0] == "distance" else "gap_s": value}


def _lane(action: XmlElement, story: ReadStory) -> dict[str, Any]:
    change = action.one("LaneChangeAction")
    offset_m = change.number("targetLaneOffset", 0.0)
    if abs(offset_m) > OFFSET_M:
        raise change.refused(f"has targetLaneOffset = {offset_m:g}; vehicles keep the middle of their lane")
    made = _dynamics(change.part("LaneChangeActionDynamics"))
    target = change.part("LaneChangeTarget").one("RelativeTargetLane", "AbsoluteTargetLane")
    value = target.number("value")
    if value != round(value):
        raise target.refused(f"has value = {value:g}, which is no lane")
    if target.tag == "AbsoluteTargetLane":
        return made | {"lane_id": round(value)}
    return made | {"lanes": round(value), "of": _named(story, target).name}


def _meeting(action: XmlElement, story: ReadStory) -> dict[str, Any]:
    """Two vehicles come to their places at once."""
    name = action.text("masterEntityRef")
    if name not in story.entities:
        raise action.refused(f"names no entity {name!r}")
    made = {"of": name, "meets": action.part("TargetPosition"), "of_meets": action.part("TargetPositionMaster")}
    final = action.find("FinalSpeed")
    if final is None:
        return made
    speed = final.one("AbsoluteSpeed", "RelativeSpeedToMaster")
    value = speed.number("value")
    if speed.tag == "AbsoluteSpeed":
        if value < 0:
            raise speed.refused(f"has value = {value:g}; vehicles do not reverse here")
        return made | {"speed_kmh": round(value * KMH_PER_MPS, 3)}
    if speed.word("speedTargetValueType", "delta", "factor") == "factor":
        return made | {"speed_share": value}
    return made | {"speed_share": 1.0, "faster_kmh": round(value * KMH_PER_MPS, 3)}


_CHANGES = {"LongitudinalAction": _speed, "LateralAction": _lane, "SynchronizeAction": _meeting}
"""What changes how a vehicle drives."""
