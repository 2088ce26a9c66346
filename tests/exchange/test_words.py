"""The table of what the import makes of OpenSCENARIO's elements and attributes, held against what it does."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import pytest
import sumolib

from automotive_cosim.errors import ScenarioError
from automotive_cosim.exchange.catalogs import CARRIED, DIFFERENT, REFUSED, Catalogs, _copied, table
from automotive_cosim.exchange.incoming import import_openscenario, road_network, scenario_text
from automotive_cosim.exchange.positions import RoadPositions
from automotive_cosim.exchange.storyboard import read_story
from automotive_cosim.exchange.tree import XmlElement, read_tree
from automotive_cosim.scenarios import load, open_scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.network import drives_on_left

LANE = '<lane id="{}" type="driving" level="false"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>'
SECTION = """<laneSection s="{}"><left>{}</left><center>
<lane id="0" type="none" level="false"/></center><right>{}</right>
</laneSection>"""


def section(at_m, right=3):
    """A lane section with three lanes on the left."""
    left, right_ = (
        "".join(LANE.format(sign * each) for each in range(1, n + 1)) for sign, n in ((1, 3), (-1, right))
    )
    return SECTION.format(at_m, left, right_)


def road(*sections, rule="RHT"):
    """A straight road of 1200 m along the x axis, so that x is s."""
    return f"""<OpenDRIVE><header revMajor="1" revMinor="6"/><road name="main" length="1200" id="1" junction="-1"
rule="{rule}"><planView><geometry s="0" x="0" y="0" hdg="0" length="1200"><line/></geometry></planView>
<lanes>{"".join(sections)}</lanes></road></OpenDRIVE>"""


VEHICLE = """<Vehicle name="{}" vehicleCategory="car" mass="1" role="none" model3d="x"><ParameterDeclarations>
<ParameterDeclaration name="size" parameterType="double" value="1.8"/></ParameterDeclarations><BoundingBox>
<Center x="1.4" y="0" z="0.75"/><Dimensions width="$size" length="4.5" height="1.5"/></BoundingBox>
<Trailer><TrailerRef entityRef=""/></Trailer></Vehicle>"""
SKY = """<Environment name="{}"><ParameterDeclarations><ParameterDeclaration name="far" parameterType="double"
value="150"/></ParameterDeclarations><TimeOfDay animation="true" dateTime="2026-11-05T07:30:00"/>
<Weather fractionalCloudCover="twoOktas" cloudState="cloudy" temperature="278.15" atmosphericPressure="1000">
<Fog visualRange="$far"/><Precipitation precipitationType="rain" intensity="0.1" precipitationIntensity="3"/>
</Weather></Environment>"""
ROUTE = """<Route name="{}" closed="false"><ParameterDeclarations><ParameterDeclaration name="end"
parameterType="double" value="900"/></ParameterDeclarations><Waypoint routeStrategy="shortest"><Position>
<LanePosition roadId="1" laneId="-2" s="700"/></Position></Waypoint><Waypoint routeStrategy="shortest"><Position>
<LanePosition roadId="1" laneId="-2" s="$end"/></Position></Waypoint></Route>"""
TIME = """<Condition name="c" delay="{}" conditionEdge="{}"><ByValueCondition><SimulationTimeCondition value="{}"
rule="greaterThan"/></ByValueCondition></Condition>"""
SPEED = """<LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape="{}"
dynamicsDimension="{}" value="{}" followingMode="position"/>
<SpeedActionTarget>{}</SpeedActionTarget></SpeedAction></LongitudinalAction>"""
LANES = """<LateralAction><LaneChangeAction targetLaneOffset="0.1"><LaneChangeActionDynamics
dynamicsShape="sinusoidal" dynamicsDimension="time" value="3" followingMode="position"/>
<LaneChangeTarget>{}</LaneChangeTarget>
</LaneChangeAction></LateralAction>"""
OFF = """<ControllerAction><OverrideControllerValueAction><Throttle value="0" active="false"/><Brake value="0"
active="false"/><Clutch value="0" active="false"/><ParkingBrake value="0" active="false"/><SteeringWheel value="0"
active="false"/><Gear number="0" active="false"/></OverrideControllerValueAction></ControllerAction>"""
HANDS = """<ControllerAction><AssignControllerAction activateLateral="false" activateLongitudinal="false">
<Controller name="x"/></AssignControllerAction></ControllerAction><ControllerAction><ActivateControllerAction
lateral="false" longitudinal="false"/></ControllerAction>"""
MANEUVER = """<Maneuver name="{}"><ParameterDeclarations><ParameterDeclaration name="to" parameterType="double"
value="3"/></ParameterDeclarations>{}</Maneuver>"""


def position(what):
    return f"<Position>{what}</Position>"


def private(name, place, *actions):
    told = "".join(map(do, actions))
    teleport = f"<PrivateAction><TeleportAction>{position(place)}</TeleportAction></PrivateAction>"
    return f'<Private entityRef="{name}">{teleport}{told}</Private>'


def trigger(kind, *conditions):
    return f"<{kind}><ConditionGroup>{''.join(conditions)}</ConditionGroup></{kind}>"


def entities(what, edge="rising"):
    return f"""<Condition name="c" delay="1" conditionEdge="{edge}"><ByEntityCondition><TriggeringEntities
triggeringEntitiesRule="any"><EntityRef entityRef="other"/><EntityRef entityRef="third"/></TriggeringEntities>
<EntityCondition>{what}</EntityCondition></ByEntityCondition></Condition>"""


def event(name, action, *conditions):
    return f"""<Event name="{name}" priority="overwrite" maximumExecutionCount="1"><Action name="do {name}">{action}
</Action>{trigger("StartTrigger", *conditions)}</Event>"""


def do(action):
    return f"<PrivateAction>{action}</PrivateAction>"


DISTANCE = 'entityRef="ego" value="20" freespace="true" rule="lessThan" relativeDistanceType="euclidianDistance"'
WHILE = (
    '<ReachPositionCondition tolerance="3"><Position><LanePosition roadId="1" laneId="-2" s="400"/></Position>'
    "</ReachPositionCondition>",
    f"<RelativeDistanceCondition {DISTANCE}/>",
    f'<TimeHeadwayCondition alongRoute="true" {DISTANCE}/>',
    '<TimeToCollisionCondition value="2" freespace="true" rule="lessThan" relativeDistanceType="euclidianDistance">'
    '<TimeToCollisionConditionTarget><EntityRef entityRef="ego"/></TimeToCollisionConditionTarget>'
    "</TimeToCollisionCondition>",
    '<SpeedCondition value="9" rule="lessThan"/>',
    '<AccelerationCondition value="1" rule="lessThan"/>',
    '<RelativeSpeedCondition entityRef="ego" value="1" rule="lessThan"/>',
    '<StandStillCondition duration="2"/>',
    '<EndOfRoadCondition duration="2"/>',
    '<TraveledDistanceCondition value="50"/>',
)
EVENTS = "".join(
    event(
        f"e{number}",
        do(SPEED.format("linear", "rate", number + 1, '<AbsoluteTargetSpeed value="3"/>')),
        entities(what),
    )
    for number, what in enumerate(WHILE)
).replace(
    '"e1" priority="overwrite" maximumExecutionCount="1"', '"e1" priority="overwrite" maximumExecutionCount="2"'
)
STATE = """<Condition name="c" delay="0" conditionEdge="none"><ByValueCondition><StoryboardElementStateCondition
storyboardElementType="{}" storyboardElementRef="{}" state="{}"/></ByValueCondition></Condition>"""
IF = """<Condition name="c" delay="0" conditionEdge="none"><ByValueCondition><ParameterCondition parameterRef="is"
rule="equalTo" value="yes"/></ByValueCondition></Condition>"""
ASKED = SPEED.format("step", "time", 0, '<AbsoluteTargetSpeed value="${$v / 3.6}"/>')
FACTOR = '<RelativeTargetSpeed entityRef="ego" value="1.2" speedTargetValueType="factor" continuous="false"/>'
DELTA = '<RelativeTargetSpeed entityRef="ego" value="$to" speedTargetValueType="delta" continuous="true"/>'
ROUTED = f"""<RoutePosition><RouteRef>{ROUTE.format("p")}</RouteRef><InRoutePosition><FromLaneCoordinates
pathS="60" laneId="-2"/></InRoutePosition></RoutePosition>"""
AHEAD = '<Position><WorldPosition x="900" y="-5.2"/></Position>'
MEETS = """<SynchronizeAction masterEntityRef="ego" targetTolerance="1" targetToleranceMaster="1"><TargetPosition>{}
</TargetPosition><TargetPositionMaster>{}</TargetPositionMaster><FinalSpeed>{}</FinalSpeed></SynchronizeAction>"""
KEEPS = """<LongitudinalAction><LongitudinalDistanceAction entityRef="third" continuous="true" freespace="true"
displacement="any" {}="3"/></LongitudinalAction>"""
SPEEDS = ('<AbsoluteSpeed value="7"/>', '<RelativeSpeedToMaster value="3" speedTargetValueType="delta"/>')
PLACES = {
    "ego": ('<LanePosition roadId="1" laneId="-2" offset="0.2" s="50"/>', ASKED,
            '<VisibilityAction graphics="true" sensors="true" traffic="true"/>',
            f"<RoutingAction><AssignRouteAction>{ROUTE.format('r')}</AssignRouteAction></RoutingAction>"),
    "other": ('<LanePosition roadId="1" laneId="-3" s="80"><Orientation type="relative" h="0.1"/></LanePosition>',
              SPEED.format("step", "time", 0, FACTOR),
              f"<RoutingAction><AcquirePositionAction>{AHEAD}</AcquirePositionAction></RoutingAction>",
              OFF, *re.findall("(?s)<ControllerAction>.*?</ControllerAction>", HANDS)),
    "third": ('<RelativeLanePosition entityRef="other" dLane="1" ds="20" offset="0.1"/>',
              '<RoutingAction><AssignRouteAction><CatalogReference catalogName="Route" entryName="there"/>'
              "</AssignRouteAction></RoutingAction>"),
    "fourth": ('<RelativeRoadPosition entityRef="other" ds="40" dt="0.1"/>',),
    "fifth": ('<RelativeObjectPosition entityRef="third" dx="60" dy="0.1"/>',),
    "sixth": ('<RelativeWorldPosition entityRef="third" dx="80" dy="0.1"/>',),
    "box": ('<LanePosition roadId="1" laneId="-1" s="800"/>',),
    "eighth": ('<WorldPosition x="300" y="-3.6"/>',),
    "ninth": (ROUTED,),
    "tenth": (re.sub("(?s)<RouteRef>.*</RouteRef>", '<RouteRef><CatalogReference catalogName="Route" '
              'entryName="there"/></RouteRef>', ROUTED).replace("60", "120"),),
    "seventh": ('<RoadPosition roadId="1" s="250" t="-5.2"/>',),
}  # fmt: skip
SIZES = "".join(f'<ParameterAssignment parameterRef="{name}" value="{value}"/>' for name, value in
                (("size", 2), ("long", 6)))  # fmt: skip
OTHER_CAR = f"""<CatalogReference catalogName="Vehicle" entryName="long"><ParameterAssignments>{SIZES}
</ParameterAssignments></CatalogReference>"""
BOUNDS = """<BoundingBox><Center x="1" y="0" z="0"/><Dimensions width="2" length="4" height="1"/></BoundingBox>"""
TRAILER = """<Trailer><Trailer name="t"><Vehicle name="t" vehicleCategory="trailer">{}<TrailerCoupler dx="3.5"/>
{}</Vehicle></Trailer></Trailer>"""
LAST = (
    '<TrailerHitch dx="-1.5"/><Trailer><Trailer name="l"><CatalogReference catalogName="Vehicle" entryName="last"/>'
)
TOWING = re.sub(
    "(?s)<Trailer>.*</Trailer>",
    f'<TrailerHitch dx="-1"/>{TRAILER.format(BOUNDS, f"{LAST}</Trailer></Trailer>")}',
    VEHICLE.format("v"),
)
"""A car with two trailers: 3.65 m before its reference point and 10.5 m behind it."""
CARS = "".join(
    f'<ScenarioObject name="{name}">{special.get(name, VEHICLE.format("v"))}</ScenarioObject>'
    for special in ({"other": OTHER_CAR, "eighth": TOWING},)
    for name in PLACES
    if name != "box"
)
BOX = """<ScenarioObject name="box"><MiscObject name="b" miscObjectCategory="obstacle" mass="1">
<ParameterDeclarations><ParameterDeclaration name="long" parameterType="double" value="2"/></ParameterDeclarations>
<BoundingBox><Center x="0" y="0" z="0"/><Dimensions width="2" length="$long" height="1"/></BoundingBox></MiscObject>
</ScenarioObject>"""
FOLDERS = "".join(
    f'<{kind}Catalog><Directory path="{kind}"/></{kind}Catalog>'
    for kind in ("Environment", "Maneuver", "MiscObject", "Pedestrian", "Route", "Trajectory", "Vehicle")
)
MOVES = "".join((
    event("moves", do(LANES.format('<RelativeTargetLane entityRef="ego" value="1"/>')), TIME.format(1, "none", 9),
          IF),
    event("brakes", do(SPEED.format("linear", "time", 2, '<AbsoluteTargetSpeed value="$to"/>')),
          STATE.format("event", "moves", "endTransition")),
    event("returns", do(LANES.format('<AbsoluteTargetLane value="-2"/>')),
          *(STATE.format(*each) for each in (
            ("act", "a", "startTransition"), ("action", "do moves", "runningState"),
            ("maneuver", "m", "completeState"), ("maneuverGroup", "g", "startTransition")))),
    event("sky", "<GlobalAction><EnvironmentAction><CatalogReference catalogName='Environment' entryName='fog'/>"
          "</EnvironmentAction></GlobalAction>", TIME.format(0, "none", 8)),
    EVENTS,
    *(event(f"meets {number}", do(MEETS.format(each[0], each[0], SPEEDS[number % 2])), TIME.format(0, "none", 9))
      for number, each in enumerate(PLACES.values())),
    *(event(f"keeps {gap}", do(KEEPS.format(gap)), TIME.format(0, "none", 9)) for gap in ("distance", "timeGap")),
))  # fmt: skip
FILE = f"""<?xml version="1.0" encoding="UTF-8"?>
<OpenSCENARIO><FileHeader revMajor="1" revMinor="1" date="2026-01-01T00:00:00" description="d" author="a"/>
<ParameterDeclarations><ParameterDeclaration name="is" parameterType="string" value="yes"/><ParameterDeclaration
name="v" parameterType="double" value="36"/></ParameterDeclarations><CatalogLocations>{FOLDERS}</CatalogLocations>
<RoadNetwork><LogicFile filepath="road.xodr"/></RoadNetwork><Entities>{CARS}{BOX}</Entities>
<Storyboard><Init><Actions><GlobalAction><EnvironmentAction>{SKY.format("e")}</EnvironmentAction></GlobalAction>
{"".join(private(name, *told) for name, told in PLACES.items())}</Actions></Init>
<Story name="s"><ParameterDeclarations><ParameterDeclaration name="who" parameterType="string" value="other"/>
</ParameterDeclarations><Act name="a"><ManeuverGroup name="g" maximumExecutionCount="1"><Actors
selectTriggeringEntities="false"><EntityRef entityRef="$who"/></Actors>{MANEUVER.format("m", MOVES)}
<CatalogReference catalogName="Maneuver" entryName="kept"/></ManeuverGroup>
{trigger("StartTrigger", TIME.format(0, "none", 2))}{trigger("StopTrigger", TIME.format(0, "none", 50))}
</Act></Story>{trigger("StopTrigger", TIME.format(0, "none", 60))}</Storyboard></OpenSCENARIO>
"""
WEATHER = '<Environment name="fog"><Weather><Fog visualRange="99"/></Weather></Environment>'
CATALOGS = {
    "Vehicle": VEHICLE.format("long").replace('length="4.5"', 'length="$long"').replace(
        "</ParameterDeclarations>", '<ParameterDeclaration name="long" parameterType="double" value="5"/>'
        "</ParameterDeclarations>")
        + f'<Vehicle name="last" vehicleCategory="semitrailer">{BOUNDS}<TrailerCoupler dx="4"/></Vehicle>',
    "Environment": WEATHER,
    "Route": ROUTE.format("there"),
    "Maneuver": MANEUVER.format("kept", event("last", do(SPEED.format("step", "time", 0, DELTA)),
                                            TIME.format(0, "none", 30))),
}  # fmt: skip


class WordsSample(NamedTuple):
    """A file in which everything is that is carried out, and its road."""

    file: Path
    places: RoadPositions

    def tree(self):
        """The whole file."""
        self.file.write_text(FILE, "utf-8")
        return read_tree(self.file)

    def text(self, root=None):
        """The scenario that it becomes, or that a changed tree of it does."""
        if root is not None:
            self.file.write_text(written(root), "utf-8")
        story = read_story(self.file, "ego")
        places = RoadPositions(self.places.net, self.file.parent / "road.xodr")
        return f"{story.road}\n" + scenario_text("x", self.file, story, places, "FR", has_place=False)


def written(element):
    attributes = "".join(f' {name}="{value}"' for name, value in element.attributes.items())
    return f"<{element.tag}{attributes}>{''.join(map(written, element.parts))}</{element.tag}>"


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sample")
    for name, entry in CATALOGS.items():
        text = f'<OpenSCENARIO><Catalog name="{name}">{entry}</Catalog></OpenSCENARIO>'
        (folder / name).mkdir()
        (folder / name / "kept.xosc").write_text(text, "utf-8")
    (folder / "road.xodr").write_text(road(section(0)), "utf-8")
    (folder / "all.xosc").write_text(FILE, "utf-8")
    net = road_network(folder / "road.xodr", folder / "Route")
    return WordsSample(folder / "all.xosc", RoadPositions(net, folder / "road.xodr"))


def walk(element):
    """Every element, with the row of the table that is looked into."""
    if table().get(element.tag) is None or table()[element.tag].word == CARRIED:
        yield element
        for part in element.parts:
            yield from walk(part)


def test_every_word_of_the_table_is_refused_or_has_a_stated_difference_or_is_carried_out():
    for tag, row in table().items():
        for name, word, difference in row.told():
            assert word in (CARRIED, DIFFERENT, REFUSED)
            assert difference or word != DIFFERENT or row.word != CARRIED, f"{tag}: {name}"
            assert not difference or word != CARRIED, f"{tag}: {name}"
            if not name.startswith("@") and name in table() and row.word == CARRIED and word == CARRIED:
                assert table()[name].word == CARRIED, f"{name} is carried out in {tag} and refused everywhere"


def ways(homes):
    """To each element of the schemas the one that it is put into: through what is read, if that leads there."""
    found = dict.fromkeys(homes, "")
    for through in (CARRIED, DIFFERENT), (CARRIED, DIFFERENT, REFUSED):
        reached = list(found)
        for tag in reached:
            for part, word in table()[tag].parts.items() if tag in table() else ():
                if part not in found and word in through:
                    found[part] = tag
                    reached.append(part)
    return found


class Grafted(NamedTuple):
    """A file with an element that the sample may not have, within those that can have it."""

    root: XmlElement
    element: XmlElement
    refused: str
    """How the first that is refused around it is told; empty if none is."""
    is_read: bool
    """Whether the import looks into it."""


def grafted(root, tag, way):
    around = [tag]
    while way[around[0]]:
        around.insert(0, way[around[0]])
    made = _copied(root)
    element = next(each for each in walk(made) if each.tag == around[0])
    refused, is_read = "", True
    for above, part in pairwise(around):
        if is_read and table()[above].parts[part] == REFUSED:
            refused, is_read = f"line {element.line}: <{part}> in <{above}>: outside", False
        is_read &= part not in table() or table()[part].word == CARRIED
        element.parts.append(XmlElement(part, {}, element.line, element.path))
        element = element.parts[-1]
    return Grafted(made, element, refused, is_read)


@pytest.mark.slow
def test_what_the_table_refuses_is_refused_by_name_and_line(sample):
    root = sample.tree()
    way, tried, missing = ways(dict.fromkeys(each.tag for each in walk(root))), 0, []
    for tag, row in table().items():
        if tag not in way:
            missing.append(tag)
            continue
        refused = grafted(root, tag, way).refused
        for name, word, _ in row.told():
            file = grafted(root, tag, way)
            if name.startswith("@"):
                told = refused or f"line {file.element.line}: <{tag}> has {name[1:]} = '1': outside"
                file.element.attributes = {**file.element.attributes, name[1:]: "1"}
            else:
                told = refused or f"line {file.element.line}: <{name}> in <{tag}>: outside"
                file.element.parts.append(XmlElement(name, {}, file.element.line, file.element.path))
            if refused or (word == REFUSED and file.is_read):
                tried += 1
                with pytest.raises(ScenarioError, match=re.escape(f"all.xosc {told}")):
                    Catalogs(file.root).complete(file.root, {})
            else:
                assert word != REFUSED, f"{tag}: {name} is refused where nothing looks"
    assert set(missing) <= {"OpenScenario"}
    assert tried > 400


NEEDS_A_VALUE = {"coordinateSystem": "lane", "dsLane": "20", "model3d": "x"}


@pytest.mark.slow
def test_what_has_a_stated_difference_is_imported(sample):
    """With each that the sample has not, what it becomes differs at most where the difference is stated."""
    root = sample.tree()
    right = sample.text(root)
    way = ways(dict.fromkeys(each.tag for each in walk(root)))
    given = {(each.tag, name) for each in walk(root) for name in each.attributes}
    given |= {(each.tag, part.tag) for each in walk(root) for part in each.parts}
    tried = 0
    for tag in set(way) & set(table()):
        for name, word, difference in table()[tag].told():
            file = grafted(root, tag, way)
            if word != DIFFERENT or file.refused or (tag, name.lstrip("@")) in given:
                continue
            if name.startswith("@"):
                value = NEEDS_A_VALUE.get(name[1:], "0")
                file.element.attributes = {**file.element.attributes, name[1:]: value}
            else:
                file.element.parts.append(XmlElement(name, {}, file.element.line, file.element.path))
            tried += 1
            if file.is_read:
                assert sample.text(file.root) == right, f"{tag}: {name} ({difference})"
            else:
                Catalogs(file.root).complete(file.root, {})
    assert tried > 100


OTHER = {"true": "false", "false": "true", "greaterThan": "lessThan", "lessThan": "greaterThan", "any": "all"}


def other(value):
    try:
        return f"{float(value) + 1.7}"
    except ValueError:
        return OTHER.get(value, f"{value}1")


@pytest.mark.slow
def test_what_is_carried_out_changes_the_scenario(sample):
    root = sample.tree()
    right = sample.text(root)
    left = {
        (tag, name)
        for tag, row in table().items()
        for name, word, _ in row.told()
        if row.word == word == CARRIED and tag != "Catalog"
    }
    for number, element in enumerate(walk(root)):
        left -= {(element.tag, part.tag) for part in element.parts}
        for name, value in element.attributes.items():
            if (element.tag, f"@{name}") not in left:
                continue
            changed = _copied(root)
            place = list(walk(changed))[number]
            place.attributes = {**place.attributes, name: other(value)}
            try:
                has_changed = sample.text(changed) != right
            except ScenarioError:
                has_changed = True
            left -= {(element.tag, f"@{name}")} if has_changed else set()
    assert not left, f"{sorted(left)} neither does it change anything, nor is it refused"


# --- places ------------------------------------------------------------------------------------------------------

LAID = """<OpenSCENARIO><FileHeader/><RoadNetwork><LogicFile filepath="road.xodr"/></RoadNetwork><Entities>
<ScenarioObject name="ego">{car}</ScenarioObject><ScenarioObject name="other">{car}</ScenarioObject></Entities>
<Storyboard><Init><Actions><Private entityRef="ego"><PrivateAction><TeleportAction><Position>
<LanePosition roadId="1" laneId="{ahead}" s="600"/></Position></TeleportAction></PrivateAction></Private>
<Private entityRef="other">
<PrivateAction><TeleportAction><Position>{place}</Position></TeleportAction></PrivateAction></Private></Actions></Init>
</Storyboard></OpenSCENARIO>"""
TURNED = """<LanePosition roadId="1" laneId="-1" s="300"><Orientation type="relative" h="3.14"/></LanePosition>"""
FRONT_M = 1.4 + 4.5 / 2


def laid(folder, place, rule="RHT"):
    """The other vehicle's front bumper: x, y, and whether it drives along the x axis."""
    sections = section(0, 2), section(90), section(500, 2), section(1000)
    (folder / "road.xodr").write_text(road(*sections, rule=rule), "utf-8")
    ahead = 1 if rule == "LHT" else -1
    (folder / "laid.xosc").write_text(LAID.format(car=VEHICLE.format("v"), place=place, ahead=ahead), "utf-8")
    made = load(import_openscenario(folder / "laid.xosc", folder / "made", country="FR", replaces=True))
    (other,) = made.incidents
    back = {edge.removeprefix("-") if edge.startswith("-") else f"-{edge}" for edge in other.route}
    assert not back & set(other.route), "it turns round at the end of the road"
    net = sumolib.net.readNet(str(folder / "made" / "road.net.xml"))
    lane = [each for each in net.getEdge(other.route[0]).getLanes() if each.allows("passenger")][other.lane]
    x_m, y_m = sumolib.geomhelper.positionAtShapeOffset(lane.getShape(), other.position_m)
    assert drives_on_left(folder / "made" / "road.net.xml") == (rule == "LHT")
    return x_m, y_m, lane.getShape()[-1][0] > lane.getShape()[0][0]


@pytest.mark.parametrize("rule", ["RHT", "LHT"])
@pytest.mark.parametrize(("lane", "s_m"), [(1, 50), (-1, 1100), (-2, 300), (3, 700), (-1, 40), (2, 1150)])
def test_a_place_on_a_road_of_several_lane_sections_is_where_the_file_has_it(tmp_path, rule, lane, s_m):
    x_m, y_m, is_along = laid(tmp_path, f'<LanePosition roadId="1" laneId="{lane}" s="{s_m}"/>', rule)
    assert is_along == ((lane < 0) == (rule == "RHT"))
    assert x_m == pytest.approx(s_m + (FRONT_M if is_along else -FRONT_M), abs=0.3)
    assert y_m == pytest.approx((abs(lane) - 0.5) * 3.5 * (1 if lane > 0 else -1), abs=0.1)


@pytest.mark.parametrize(
    ("place", "told"),
    [
        ('<LanePosition roadId="1" laneId="-1" s="300" offset="-13"/>', r"xosc line \d+: <LanePosition> .* beside"),
        ('<LanePosition roadId="1" laneId="-3" s="50"/>', "lane -3 of road 1, which has none at s = 50"),
        ('<LanePosition roadId="1" laneId="-1" s="1300"/>', "s = 1300 m of road 1, which is 1200 m long"),
        ('<LanePosition roadId="2" laneId="-1" s="0"/>', "is on road '2', which .* does not have"),
        (TURNED, "<LanePosition> heads against"),
        ('<WorldPosition x="300" y="-1.8" h="3.14"/>', "<WorldPosition> heads against or across the lane"),
        ('<RoadPosition roadId="1" s="300" t="1.8"/>', "<RoadPosition> heads against"),
        ('<RelativeRoadPosition entityRef="other" ds="3" dt="0"/>', "counts from 'other', which has no place"),
    ],
)  # fmt: skip
def test_a_place_that_is_not_carried_out_is_refused(tmp_path, place, told):
    with pytest.raises(ScenarioError, match=told):
        laid(tmp_path, place)


@pytest.mark.sumo
def test_a_road_that_keeps_left_is_driven(tmp_path, simulations: Simulations):
    laid(tmp_path, '<LanePosition roadId="1" laneId="1" s="700"/>', "LHT")
    scenario = open_scenario(tmp_path / "made")
    traffic = simulations.warm(scenario).depart(EgoPlan(scenario.ego.trips[0], "average"))
    try:
        traffic.advance(3.0)
        (ego,) = (each for each in traffic.look().vehicles if each.vehicle_id == "ego")
    finally:
        traffic.close()
    assert ego.x_m > 600 + FRONT_M
    assert ego.y_m == pytest.approx(1.75, abs=0.2)


def test_trailers_make_a_vehicle_longer_in_it_or_as_entities(sample):
    """The reference points hang 1 + 3.5 m and 1.5 + 4 m behind each other; the last one ends 1 m behind its own."""
    length_m = FRONT_M + 4.5 + 5.5 + 1.0
    sample.file.write_text(FILE, "utf-8")
    assert f"length_m = {length_m}" in sample.text()
    car = VEHICLE.format("v")
    alone = TRAILER.format(BOUNDS, "")
    (trailer,) = re.findall("(?s)<Vehicle.*</Vehicle>", alone)
    towing = re.sub(
        "(?s)<Trailer>.*</Trailer>", '<TrailerHitch dx="-1"/><Trailer><TrailerRef entityRef="x"/></Trailer>', car
    )
    story = f"""<PrivateAction><TeleportAction>{AHEAD}</TeleportAction></PrivateAction>"""
    file = (
        FILE.replace(TOWING, towing)
        .replace("</Entities>", f'<ScenarioObject name="x">{trailer}</ScenarioObject></Entities>')
        .replace("</Actions></Init>", f'<Private entityRef="x">{story}</Private></Actions></Init>')
    )
    sample.file.write_text(file, "utf-8")
    assert f"length_m = {FRONT_M + 4.5 + 1.0}" in sample.text()
    for before, after, told in (
        ('entityRef="x"/></Trailer>', 'entityRef=""/></Trailer>', "named x is a trailer that nothing pulls"),
        ('entityRef="x"/></Trailer>', 'entityRef="y"/></Trailer>', "<Trailer> names 'y', which is no entity"),
        ('<TrailerHitch dx="-1"/>', "", "<Vehicle> has no TrailerHitch"),
    ):
        assert before in file
        sample.file.write_text(file.replace(before, after), "utf-8")
        with pytest.raises(ScenarioError, match=told):
            sample.text()


def test_what_an_act_does_ends_with_its_stop(sample):
    early = FILE.replace('<SimulationTimeCondition value="50"', '<SimulationTimeCondition value="20"')
    assert early != FILE
    sample.file.write_text(FILE, "utf-8")
    assert 'name = "last"' in sample.text()
    sample.file.write_text(early, "utf-8")
    assert 'name = "last"' not in sample.text(), "it would begin at 30 s"


# --- what vehicles do together -----------------------------------------------------------------------------------

TOGETHER = """<OpenSCENARIO><FileHeader/><RoadNetwork><LogicFile filepath="road.xodr"/></RoadNetwork><Entities>
<ScenarioObject name="ego">{car}</ScenarioObject><ScenarioObject name="other">{car}</ScenarioObject></Entities>
<Storyboard><Init><Actions>{places}</Actions></Init><Story name="s"><Act name="a"><ManeuverGroup name="g"
maximumExecutionCount="1"><Actors selectTriggeringEntities="false"><EntityRef entityRef="other"/></Actors>
<Maneuver name="m">{events}</Maneuver></ManeuverGroup></Act></Story></Storyboard></OpenSCENARIO>"""
AT = '<LanePosition roadId="1" laneId="{}" s="{}"/>'
WITHIN = """<Condition name="c" delay="0" conditionEdge="rising"><ByEntityCondition><TriggeringEntities
triggeringEntitiesRule="any"><EntityRef entityRef="ego"/></TriggeringEntities><EntityCondition>
<RelativeDistanceCondition entityRef="other" value="40" freespace="false" rule="{}Than"
relativeDistanceType="longitudinal"/></EntityCondition></ByEntityCondition></Condition>"""


def together(folder, simulations, *events, other_mps=15, seconds=60, right=(), lane=-2):
    """How far the ego is along the road, how far the other one, its speed, and its y, each second."""
    first = SPEED.format("step", "time", 0, '<AbsoluteTargetSpeed value="{}"/>')
    places = private("ego", AT.format(-1, 50), first.format(10)) + private(
        "other", AT.format(lane, 150), first.format(other_mps)
    )
    (folder / "road.xodr").write_text(road(section(0, *right), section(110)), "utf-8")
    text = TOGETHER.format(car=VEHICLE.format("v"), places=places, events="".join(events))
    (folder / "told.xosc").write_text(text, "utf-8")
    scenario = open_scenario(import_openscenario(folder / "told.xosc", folder / "made", country="FR"))
    traffic = simulations.warm(scenario).depart(EgoPlan(scenario.ego.trips[0], "average"))
    seen = []
    try:
        for _ in range(seconds):
            traffic.advance(1.0)
            cars = {each.vehicle_id == "ego": each for each in traffic.look().vehicles}
            if len(cars) == 2:
                seen.append((cars[True].x_m, cars[False].x_m, cars[False].speed_mps, cars[False].y_m))
    finally:
        traffic.close()
    return seen


@pytest.mark.sumo
@pytest.mark.parametrize(("gap", "value"), [("distance", 40), ("timeGap", 2)])
def test_a_distance_is_come_to_and_kept(tmp_path, simulations: Simulations, gap, value):
    keeps = KEEPS.replace("third", "ego").replace('freespace="true"', 'freespace="false"').format(gap)
    told = event("keeps", do(keeps.replace('"3"', f'"{value}"')), TIME.format(0, "none", 1))
    seen = together(tmp_path, simulations, told, seconds=40)
    assert len(seen) == 40
    for ego_m, other_m, mps, _ in seen[-8:]:
        assert other_m - ego_m == pytest.approx(value if gap == "distance" else value * mps, abs=3)


@pytest.mark.sumo
@pytest.mark.parametrize(("value", "lane"), [(0, 1), (-1, 2), (-2, 3)])
def test_lanes_are_counted_from_another_ones_where_fewer_are(tmp_path, simulations: Simulations, value, lane):
    target = LANES.format(f'<RelativeTargetLane entityRef="ego" value="{value}"/>')
    told = event("moves", do(target), TIME.format(0, "none", 1))
    seen = together(tmp_path, simulations, told, seconds=5, right=(2,))
    assert seen[-1][3] == pytest.approx(-3.5 * (lane - 0.5), abs=0.1)


def test_lanes_are_not_counted_from_an_oncoming_vehicle(tmp_path):
    target = LANES.format('<RelativeTargetLane entityRef="ego" value="1"/>')
    told = event("moves", do(target), TIME.format(0, "none", 1))
    with pytest.raises(ScenarioError, match="counts lanes from ego, which never drives along"):
        together(tmp_path, None, told, seconds=1, lane=1)


@pytest.mark.sumo
def test_two_vehicles_come_to_their_places_at_once(tmp_path, simulations: Simulations):
    meets = MEETS.format(AT.format(-2, 600), AT.format(-1, 400), SPEEDS[0])
    seen = together(tmp_path, simulations, event("meets", do(meets), TIME.format(0, "none", 1)))
    when = next(number for number, (ego_m, *_) in enumerate(seen) if ego_m >= 400 + FRONT_M)
    assert seen[when][1] == pytest.approx(600 + FRONT_M, abs=15)
    assert seen[when + 3][2] == pytest.approx(7, abs=0.5)


@pytest.mark.sumo
@pytest.mark.parametrize(("times", "starts"), [(1, 1), (9, 2)])
def test_what_is_carried_out_again_waits_anew(tmp_path, simulations: Simulations, times, starts):
    speed = SPEED.format("step", "time", 0, '<AbsoluteTargetSpeed value="{}"/>')
    told = [event("drives", do(speed.format(20)), WITHIN.format("less")),
            event("stops", do(speed.format(0)), WITHIN.format("greater"))]  # fmt: skip
    again = [each.replace('maximumExecutionCount="1"', f'maximumExecutionCount="{times}"') for each in told]
    seen = together(tmp_path, simulations, *again, other_mps=0, seconds=50)
    moves = [mps > 3 for _, _, mps, _ in seen]
    begun = sum(now and not before for before, now in pairwise(moves))
    assert begun >= starts
    assert begun == 1 or times > 1


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        (' maximumExecutionCount="1"><Action name="do moves"', ' maximumExecutionCount="2"><Action name="do moves"',
         "<Event> is carried out again at once"),
        ('storyboardElementRef="moves"', 'storyboardElementRef="e1"', "event that is carried out more than once"),
        ('<AbsoluteSpeed value="7"', '<AbsoluteSpeed value="-7"', "<AbsoluteSpeed> .* do not reverse"),
        ('traffic="true"', 'traffic="false"', "<VisibilityAction> hides a vehicle from traffic"),
        ('pathS="60" laneId="-2"', 'pathS="60" laneId="-7"', "is on lane -7, which the route does not have there"),
        ('pathS="60"', 'pathS="6000"', r"<RoutePosition> is \d+ m beyond the end of its route"),
        ('<AbsoluteTargetLane value="-2"', '<RelativeTargetLane entityRef="other" value="3"',
         "leads other to a lane that its side"),
        ('displacement="any" distance', 'displacement="leadingReferencedEntity" distance', "<LongitudinalDistance"),
    ],
)  # fmt: skip
def test_what_vehicles_cannot_do_is_refused(sample, before, after, told):
    assert before in FILE
    sample.file.write_text(FILE.replace(before, after), "utf-8")
    with pytest.raises(ScenarioError, match=told):
        sample.text()
