"""OpenSCENARIO XML as a scenario: the declared subset, and what is outside."""

from __future__ import annotations

import math
import re
from datetime import datetime

import pytest

from automotive_cosim.contracts import LimitSource
from automotive_cosim.errors import ScenarioError
from automotive_cosim.exchange.incoming import NET, import_openscenario, road_network
from automotive_cosim.exchange.opendrive import write_opendrive
from automotive_cosim.formats.incidents import VehicleAction
from automotive_cosim.scenarios import load, open_scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.network import DERESTRICTED_MPS, read_network
from automotive_cosim.traffic.options import read_configuration
from automotive_cosim.traffic.sumo_programs import run

VEHICLE = """<ScenarioObject name="{}"><Vehicle name="car" vehicleCategory="car"><BoundingBox>
<Center x="1.35" y="0" z="0.75"/><Dimensions width="1.8" length="4.5" height="1.5"/></BoundingBox>
</Vehicle></ScenarioObject>"""
SPEED = """<PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics
dynamicsShape="step" dynamicsDimension="time" value="0"/><SpeedActionTarget>
<AbsoluteTargetSpeed value="{}"/></SpeedActionTarget></SpeedAction></LongitudinalAction>
</PrivateAction>"""
LANES = """<PrivateAction><LateralAction><LaneChangeAction><LaneChangeActionDynamics
dynamicsShape="step" dynamicsDimension="time" value="0"/><LaneChangeTarget>
<RelativeTargetLane entityRef="other" value="{}"/></LaneChangeTarget></LaneChangeAction></LateralAction>
</PrivateAction>"""
TRAJECTORY = """<PrivateAction><RoutingAction><FollowTrajectoryAction/></RoutingAction></PrivateAction>"""
PLACE = "<PrivateAction><TeleportAction><Position>{}</Position></TeleportAction></PrivateAction>"
GOAL = """<PrivateAction><RoutingAction><AcquirePositionAction><Position>
<WorldPosition x="1000" y="213"/></Position></AcquirePositionAction></RoutingAction></PrivateAction>"""
SKY = """<GlobalAction><EnvironmentAction><Environment name="sky">{}</Environment></EnvironmentAction>
</GlobalAction>"""


def event(name, at_s, action):
    return f"""<Event name="{name}" priority="override"><Action name="{name}">{action}</Action>
<StartTrigger><ConditionGroup><Condition name="t" delay="0" conditionEdge="none"><ByValueCondition>
<SimulationTimeCondition value="{at_s}"
rule="greaterThan"/></ByValueCondition></Condition></ConditionGroup></StartTrigger></Event>"""


FOG = """<TimeOfDay animation="true" dateTime="2026-11-05T07:30:00"/>
<Weather temperature="278.15"><Fog visualRange="150"/></Weather>"""
RAIN = '<Weather><Precipitation precipitationType="rain" precipitationIntensity="5"/></Weather>'
TEXT = f"""<?xml version="1.0" encoding="UTF-8"?>
<OpenSCENARIO><FileHeader/><CatalogLocations/>
<RoadNetwork><LogicFile filepath="road.xodr"/></RoadNetwork>
<Entities>{VEHICLE.format("ego")}{VEHICLE.format("other")}</Entities>
<Storyboard><Init><Actions>{SKY.format(FOG)}
<Private entityRef="ego">{PLACE.format('<WorldPosition x="320" y="239.9"/>')}{GOAL}</Private>
<Private entityRef="other">{PLACE.format('<WorldPosition x="420" y="231.4"/>')}{SPEED.format(8)}</Private>
</Actions></Init>
<Story name="s"><Act name="a"><ManeuverGroup name="g" maximumExecutionCount="1">
<Actors selectTriggeringEntities="false"><EntityRef entityRef="other"/></Actors><Maneuver name="m">
{event("moves", 4, LANES.format(1))}{event("brakes", 6, SPEED.format(3))}{event("rain", 30, SKY.format(RAIN))}
</Maneuver></ManeuverGroup><StartTrigger/></Act></Story><StopTrigger/></Storyboard></OpenSCENARIO>
"""


HERE = '<WorldPosition x="320" y="239.9"/>'


def grid():
    return read_configuration(open_scenario("grid").config).net


@pytest.fixture
def file(tmp_path):
    (tmp_path / "pass.xosc").write_text(TEXT, "utf-8")
    return tmp_path / "pass.xosc"


def test_the_subset_becomes_a_scenario(file, tmp_path):
    made = load(import_openscenario(file, tmp_path / "made", grid(), country="FR"))
    assert made.start.replace(tzinfo=None) == datetime(2026, 11, 5, 7, 30)
    (trip,) = made.ego.trips
    assert (trip.from_edge, trip.to_edge) == ("c0c1", "c3c4")
    first, later = made.weather
    assert (first.weather.visibility, first.weather.temperature_2m, first.weather.weather_code) == (150.0, 5.0, 45)
    assert (later.at_s, later.weather.precipitation, later.weather.visibility) == (30.0, 5.0, 150.0)
    (other,) = made.incidents
    assert other.route[0] == "c0c1"
    assert other.lane == 0
    assert other.position_m == pytest.approx(420 + 3.6 - 315.6, abs=1.0), "the front bumper"
    moves, brakes = other.actions
    assert moves == VehicleAction(4.0, lanes=1, name="moves", of="other", alone=True)
    assert brakes == VehicleAction(6.0, 10.8, name="brakes", alone=True)


@pytest.mark.slow
def test_an_opendrive_file_becomes_the_network(file, tmp_path):
    write_opendrive(grid(), tmp_path / "road.xodr")
    made = load(import_openscenario(file, tmp_path / "made"))
    (other,) = made.incidents
    assert other.position_m == pytest.approx(420 + 3.6 - 315.6, abs=1.0)
    on_lane = '<LanePosition roadId="210" laneId="-2" s="104.6"/>'
    file.write_text(TEXT.replace('<WorldPosition x="420" y="231.4"/>', on_lane), "utf-8")
    again = load(import_openscenario(file, tmp_path / "again"))
    assert again.incidents[0].route == other.route
    assert again.incidents[0].position_m == pytest.approx(other.position_m, abs=1.0)


@pytest.mark.sumo
def test_an_imported_vehicle_does_what_the_file_says(file, tmp_path, simulations: Simulations):
    scenario = open_scenario(import_openscenario(file, tmp_path / "made", grid(), country="FR"))
    traffic = simulations.warm(scenario).depart(EgoPlan(scenario.ego.trips[0], "average"))
    try:
        seen = {}
        for at_s in range(1, 13):
            traffic.advance(1.0)
            (seen[at_s],) = (each for each in traffic.look().vehicles if each.vehicle_id != "ego")
    finally:
        traffic.close()
    assert seen[3].speed_mps == pytest.approx(8.0, abs=0.2)
    assert seen[11].speed_mps == pytest.approx(3.0, abs=0.2)
    slope = -0.0384
    beside_m = [each.y_m - slope * each.x_m for each in (seen[3], seen[7])]
    assert beside_m[1] - beside_m[0] == pytest.approx(3.2, abs=0.1), "a lane to the left"


def of_entities(what):
    return f"""<StartTrigger><ConditionGroup><Condition name="t" delay="0" conditionEdge="rising">
<ByEntityCondition><TriggeringEntities triggeringEntitiesRule="any"><EntityRef entityRef="other"/>
</TriggeringEntities><EntityCondition>{what}</EntityCondition></ByEntityCondition></Condition></ConditionGroup></StartTrigger>"""


FAR = """<RelativeDistanceCondition entityRef="ego" value="55" freespace="false" relativeDistanceType="longitudinal"
rule="greaterThan"/>"""
AFTER = """<StartTrigger><ConditionGroup><Condition name="t" delay="2" conditionEdge="none"><ByValueCondition>
<StoryboardElementStateCondition storyboardElementType="event" storyboardElementRef="moves" state="endTransition"/>
</ByValueCondition></Condition></ConditionGroup></StartTrigger>"""


@pytest.mark.sumo
def test_a_vehicle_waits_for_what_the_file_says(file, tmp_path, simulations: Simulations):
    """It cuts in before the ego, into the ego's own lane, as soon as it is 55 m ahead, and brakes 2 s later."""
    head, moves = TEXT.split(LANES.format(1))
    begins, ends = moves.index("<StartTrigger>"), moves.index("</StartTrigger>") + len("</StartTrigger>")
    moves = moves[:begins] + of_entities(FAR) + moves[ends:]
    ends = moves.index('<Event name="brakes"')
    begins = moves.index("<StartTrigger>", ends)
    moves = moves[:begins] + AFTER + moves[moves.index("</StartTrigger>", begins) + len("</StartTrigger>") :]
    text = head + LANES.format(0).replace('entityRef="other"', 'entityRef="ego"') + moves
    text = text.replace('value="8"', 'value="16"').replace('x="420" y="231.4"', 'x="345" y="238"')
    file.write_text(text.replace('y="239.9"', 'y="236"'), "utf-8")
    scenario = open_scenario(import_openscenario(file, tmp_path / "made", grid(), country="FR"))
    traffic = simulations.warm(scenario).depart(EgoPlan(scenario.ego.trips[0], "average"))
    moved_s, beside_m = None, []
    try:
        for at_s in range(1, 25):
            traffic.advance(1.0)
            seen = traffic.look().vehicles
            ego, other = (
                next(each for each in seen if (each.vehicle_id == "ego") == mine) for mine in (True, False)
            )
            ahead_m = math.dist((ego.x_m, ego.y_m), (other.x_m, other.y_m))
            if moved_s is None and ahead_m > 55:
                moved_s = at_s
            beside_m.append((other.y_m + 0.0384 * other.x_m) - (ego.y_m + 0.0384 * ego.x_m))
            if moved_s is not None and at_s == moved_s + 9:
                break
    finally:
        traffic.close()
    assert moved_s is not None
    assert moved_s > 1
    assert other.speed_mps == pytest.approx(3.0, abs=0.2)
    assert abs(beside_m[moved_s - 2]) > 2
    assert abs(beside_m[moved_s + 1]) < 0.5, "in the lane of the ego"


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        (HERE, '<RoadPosition roadId="1"/>', r"line \d+: <RoadPosition> is on a road of an OpenDRIVE"),
        (HERE, '<WorldPosition x="320" y="900"/>', "the nearest lane for cars, beside"),
        (HERE, '<WorldPosition x="$x" y="2"/>', r"has x = \$x, but nothing declares x"),
        ('<WorldPosition x="420" y="231.4"/>', '<WorldPosition x="far" y="2"/>', "x = 'far', which is no number"),
        ('entityRef="ego">', 'entityRef="me">', "names no entity 'me'"),
        (LANES.format(1), SPEED.format(1).replace("Absolute", "Relative"), "<RelativeTargetSpeed>"),
        ('<EntityRef entityRef="other"/>', '<EntityRef entityRef="ego"/>', "acts on ego, which"),
        ("<CatalogLocations/>", "<CatalogLocations><VehicleCatalog/></CatalogLocations>", "<VehicleCatalog>"),
        ('rule="greaterThan"', 'rule="equalTo"', "has rule = 'equalTo'; what is imported is greaterThan"),
        (LANES.format(1), TRAJECTORY, r"line \d+: <FollowTrajectoryAction> in .* it fixes where"),
        ("<SimulationTimeCondition", "<TimeOfDayCondition", "<TimeOfDayCondition>"),
        ("road.xodr", "../road.xodr", "which is not beside it; copy it there"),
        ("road.xodr", "/etc/passwd", "which is not beside it; copy it there"),
        ("road.xodr", "file:///etc/passwd", "there is no road"),
    ],
)  # fmt: skip
def test_what_is_outside_is_refused_by_name_and_line(file, tmp_path, before, after, told):
    assert before in TEXT
    file.write_text(TEXT.replace(before, after), "utf-8")
    with pytest.raises(ScenarioError, match=told):
        import_openscenario(file, tmp_path / "made", None if "road" in before else grid())
    assert not (tmp_path / "made").exists()


LIMITS = """<OpenDRIVE><header revMajor="1" revMinor="7"/><road name="" length="600" id="1" junction="-1" rule="{}">
<type s="0" type="motorway"><speed max="130" unit="km/h"/></type><type s="200" type="rural"/>
<type s="300" type="town"><speed max="undefined"/></type>
<type s="400" type="rural"><speed max="40" unit="mph"/></type>
<type s="500" type="motorway"><speed max="no limit"/></type>
<planView><geometry s="0" x="0" y="0" hdg="0" length="600"><line/></geometry></planView>
<lanes>{}{}</lanes></road></OpenDRIVE>"""
LIMITED = """<laneSection s="{}"><{side}><lane id="{sign}1" type="driving">
<width sOffset="0" a="3.5" b="0" c="0" d="0"/>{}</lane></{side}>
<center><lane id="0" type="none"/></center></laneSection>"""


@pytest.mark.parametrize("rule", ["RHT", "LHT"])
def test_the_limits_of_a_road_are_those_of_its_lanes_that_state_none(rule, tmp_path, sumo):
    side = {"side": "right", "sign": "-"} if rule == "RHT" else {"side": "left", "sign": ""}
    own = LIMITED.format(0, '<speed sOffset="50" max="20"/><speed sOffset="100" max="72" unit="km/h"/>', **side)
    (tmp_path / "a.xodr").write_text(LIMITS.format(rule, own, LIMITED.format(250, "", **side)), "utf-8")
    edges = sorted(road_network(tmp_path / "a.xodr", tmp_path).getEdges(), key=lambda each: each.getShape()[0])
    limits_mps = {edge.getShape()[0][0]: edge.getSpeed() for edge in edges}
    told = {0: 130 / 3.6, 50: 20, 250: 130 / 3.6, 400: 40 * 0.44704, 500: DERESTRICTED_MPS}

    def seen(limits):
        return [limits[max(at_m for at_m in limits if at_m <= each)] for each in range(5, 600, 10)]

    assert seen(limits_mps) == pytest.approx(seen(told), abs=0.01)
    read = [read_network(tmp_path / NET).edges[edge.getID()] for edge in edges]
    assert {each.limit_source for each in read} == {LimitSource.POSTED}
    assert [each.edge_id for each in read if each.limit_mps is None] == [edges[-1].getID()]


def test_a_limit_that_a_road_does_not_state_is_assumed(tmp_path, sumo):
    own = LIMITED.format(0, '<speed sOffset="0" max="20"/>', side="right", sign="-")
    rest = LIMITED.format(300, '<speed sOffset="100" max="20"/>', side="right", sign="-")
    text = re.sub("<type .*", "", LIMITS)
    for name, sections, source in (("a", own, LimitSource.POSTED), ("b", own + rest, LimitSource.ASSUMED)):
        (tmp_path / f"{name}.xodr").write_text(text.format("RHT", sections, ""), "utf-8")
        road_network(tmp_path / f"{name}.xodr", tmp_path)
        assert {each.limit_source for each in read_network(tmp_path / NET).edges.values()} == {source}


NO_TRUCK = '<access sOffset="0" rule="deny"{}</access>'


@pytest.mark.parametrize(
    "deny", [NO_TRUCK.format(' restriction="truck">'), NO_TRUCK.format('><restriction type="truck"/>')]
)
def test_nobody_drives_on_shoulders_and_parking_spaces_and_ramps_are_roads(deny, tmp_path, sumo):
    side = {"side": "right", "sign": "-"}
    section = LIMITED.format(0, deny, **side)
    first, last = section.split("</right>")
    width = '<width sOffset="0" a="3.5" b="0" c="0" d="0"/>'
    kinds = "slipLane", "connectingRamp", "stop", "parking"
    more = "".join(f'<lane id="-{2 + n}" type="{kind}">{width}</lane>' for n, kind in enumerate(kinds))
    (tmp_path / "a.xodr").write_text(LIMITS.format("RHT", f"{first}{more}</right>{last}", ""), "utf-8")
    lanes = [edge.getLanes() for edge in road_network(tmp_path / "a.xodr", tmp_path).getEdges()]
    assert [[lane.allows("passenger") for lane in each] for each in lanes] == [[True] * 3] * 3
    assert [[lane.allows("truck") for lane in each] for each in lanes] == [[True, True, False]] * 3


WAYS = {"in": "a b 20", "slow": "b c 5", "up": "b d 30", "down": "d c 30", "out": "c e 20"}


def test_the_way_to_a_place_is_the_quickest(file, tmp_path, sumo):
    nodes = {"a": (0, 0), "b": (300, 0), "c": (600, 0), "d": (450, 150), "e": (900, 0)}
    places = "".join(f'<node id="{name}" x="{x}" y="{y}"/>' for name, (x, y) in nodes.items())
    rows = ((name, *way.split()) for name, way in WAYS.items())
    edges = "".join(f'<edge id="{name}" from="{a}" to="{b}" speed="{mps}"/>' for name, a, b, mps in rows)
    (tmp_path / "a.nod.xml").write_text(f"<nodes>{places}</nodes>")
    (tmp_path / "a.edg.xml").write_text(f"<edges>{edges}</edges>")
    ok, printed = run("netconvert", ("-n", "a.nod.xml", "-e", "a.edg.xml", "-o", "a.net.xml"), tmp_path)
    assert ok, printed
    text = TEXT.replace(HERE, '<WorldPosition x="50" y="-1.6"/>').replace("1000", "800").replace("213", "-1.6")
    there = PLACE.format('<WorldPosition x="100" y="-1.6"/>')
    text = text.replace(PLACE.format('<WorldPosition x="420" y="231.4"/>'), there + GOAL.replace("1000", "800"))
    file.write_text(text.replace("213", "-1.6").replace(event("moves", 4, LANES.format(1)), ""), "utf-8")
    (other,) = load(import_openscenario(file, tmp_path / "made", tmp_path / "a.net.xml")).incidents
    assert other.route == ("in", "up", "down", "out")
