"""A recorded trial in the formats of other tools."""

from __future__ import annotations

import csv
import json
import math
import struct
import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import pairwise
from xml.sax.saxutils import quoteattr

import numpy as np
import pyproj
import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts import RoadShapes, SeenVehicle, Weather
from automotive_cosim.errors import UserError
from automotive_cosim.exchange.incoming import road_network
from automotive_cosim.exchange.opendrive import ACCESS, pose_at, write_opendrive
from automotive_cosim.exchange.openscenario import write_openscenario
from automotive_cosim.exchange.recording import RecordedAct, Recording, read_recording
from automotive_cosim.exchange.ssam import DIMENSIONS, FORMAT, TIMESTEP, VEHICLE, write_trajectories
from automotive_cosim.exchange.trajectories import write_csv, write_parquet
from automotive_cosim.formats.files import opened
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.road import RoadRecord, Second
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.run.trial import run_trial
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.traffic.network import drives_on_left
from automotive_cosim.traffic.options import read_configuration
from automotive_cosim.traffic.sumo_programs import run

CLEAR = Weather(12.0, 60.0, 0.0, 1, 20.0, 20_000.0, 5.0)
FOG = replace(CLEAR, weather_code=45, cloud_cover=100.0, visibility=80.0)
SNOW = replace(FOG, weather_code=73, temperature_2m=-4.0, precipitation=1.5)


def vehicle(name, at_s, kind="passenger"):
    turned = math.radians(6 * at_s)  # a circle to the right, past north
    return SeenVehicle(
        name, kind, 4.5, 1.8, 100 * math.sin(turned), 100 * math.cos(turned), (90 + 6 * at_s) % 360, 10.0, 0
    )


@pytest.fixture
def recording(tmp_path):
    """A minute: one car all the time, a bus that goes and comes back, a light, fog and snow, and two acts."""
    seconds = []
    for at_s in map(float, range(-10, 50)):
        seen = [vehicle("ego", at_s)]
        if at_s <= 5 or 20 <= at_s < 30:
            seen.append(vehicle("line$1:2", at_s - 3, "bus"))
        weather = CLEAR if at_s < 10 else FOG if at_s < 20 else SNOW
        lights = {"c0": "rG" if at_s < 15 else "Gr"}
        local = f"2026-01-05T08:00:{int(at_s) + 10:02d}+01:00"
        seconds.append(Second(at_s, tuple(seen), lights, 10.0, (), local, weather))
    acts = (
        RecordedAct(3.0, {"action_type": "show_alert"}, "warns"),
        RecordedAct(7.0, {"action_type": "click"}, "taps"),
    )
    about = {"task": "a", "scenario": "grid", "agent": "oracle", "seed": 0}
    return Recording(tmp_path, RoadRecord(RoadShapes((), ()), tuple(seconds), about), acts)


@pytest.fixture
def scenario(recording, tmp_path):
    road = tmp_path / "road.xodr"
    road.write_text('<OpenDRIVE><signal id="7" name="c0_0"/><signal id="8" name="c0_1"/></OpenDRIVE>', "utf-8")
    write_openscenario(recording, tmp_path / "a.xosc", road=road)
    return ET.parse(tmp_path / "a.xosc").getroot()


def front_bumpers(scenario):
    """(simulation time, entity) -> x, y of the front bumper, as another tool reads them."""
    found = {}
    for entity in scenario.iterfind("Entities/ScenarioObject"):
        name, box = entity.attrib["name"], entity.find("Vehicle/BoundingBox")
        ahead_m = float(box.find("Center").attrib["x"]) + float(box.find("Dimensions").attrib["length"]) / 2
        for group in scenario.iter("ManeuverGroup"):
            if [ref.attrib["entityRef"] for ref in group.iter("EntityRef")] == [name]:
                for vertex in group.iter("Vertex"):
                    place = {key: float(value) for key, value in vertex.find("Position/WorldPosition").items()}
                    x_m, y_m = (place[axis] + ahead_m * turn(place["h"]) for axis, turn in FORWARD)
                    found[float(vertex.attrib["time"]), name] = x_m, y_m, place["h"]
    return found


FORWARD = ("x", math.cos), ("y", math.sin)


def test_positions_read_back_are_those_of_the_record(recording, scenario):
    found = front_bumpers(scenario)
    names = {"ego": "ego", "line$1:2": "line_1_2"}
    recorded = {
        (second.at_s + 10, names[each.vehicle_id]): (each.x_m, each.y_m)
        for second in recording.road.seconds
        for each in second.vehicles
    }
    assert found.keys() == recorded.keys()
    assert max(math.dist(found[key][:2], recorded[key]) for key in found) < 0.002
    headings = [found[at_s, "ego"][2] for at_s in map(float, range(60))]
    assert all(abs(before - after) < 0.2 for before, after in pairwise(headings))


def test_who_leaves_is_deleted_and_added_again(scenario):
    at_s = {
        event.find("Action").attrib["name"]: float(event.find(".//SimulationTimeCondition").attrib["value"])
        for event in scenario.iter("Event")
        if event.find(".//EntityAction") is not None
    }
    assert at_s == {"delete 1": 15.1, "add 2": 30.0, "delete 2": 39.1}
    init = [private.attrib["entityRef"] for private in scenario.iter("Private")]
    assert init == ["ego", "line_1_2"]


def test_weather_time_lights_and_acts_are_told(scenario):
    skies = [
        sky for environment in scenario.iter("Environment") if (sky := environment.find("Weather")) is not None
    ]
    assert [float(sky.find("Fog").attrib["visualRange"]) for sky in skies] == [20_000, 80, 80]
    assert [sky.find("Precipitation").attrib["precipitationType"] for sky in skies] == ["dry", "dry", "snow"]
    assert [sky.attrib["fractionalCloudCover"] for sky in skies] == ["twoOktas", "eightOktas", "eightOktas"]
    assert [each.attrib["dateTime"] for each in scenario.iter("TimeOfDay")] == ["2026-01-05T08:00:00+01:00"]
    phases = [
        (float(phase.attrib["duration"]), [state.attrib["state"] for state in phase])
        for phase in scenario.iter("Phase")
    ]
    assert phases == [(25.0, ["on;off;off", "off;off;on"]), (35.0, ["off;off;on", "on;off;off"])]
    commands = [json.loads(each.text)["action_type"] for each in scenario.iter("CustomCommandAction")]
    assert commands == ["show_alert", "click"]


def test_every_reference_resolves_and_names_differ(scenario):
    entities = {each.attrib["name"] for each in scenario.iterfind("Entities/ScenarioObject")}
    assert {each.attrib["entityRef"] for each in scenario.iter() if "entityRef" in each.attrib} <= entities
    events = [event.attrib["name"] for event in scenario.iter("Event")]
    assert len(events) == len(set(events))


def test_another_version_is_refused(recording, tmp_path):
    with pytest.raises(UserError, match=r"1\.0 cannot be written; give one of 1\.2, 1\.3"):
        write_openscenario(recording, tmp_path / "a.xosc", "1.0")


def lane_lines(road):
    """Lane id -> the middle of its start and of its end."""
    found = {}
    offset = road.find("lanes/laneOffset")
    shift_m = 0.0 if offset is None else float(offset.attrib["a"])
    for side, sign in (("left", 1), ("right", -1)):
        lanes = road.findall(f"lanes/laneSection/{side}/lane")
        at_m = shift_m
        for lane in sorted(lanes, key=lambda each: abs(int(each.attrib["id"]))):
            width_m = float(lane.find("width").attrib["a"])
            middle_m, at_m = at_m + sign * width_m / 2, at_m + sign * width_m
            ends = []
            for x_m, y_m, heading in (pose_at(road, 0), pose_at(road, 1)):
                ends.append((x_m - middle_m * math.sin(heading), y_m + middle_m * math.cos(heading)))
            found[int(lane.attrib["id"])] = ends
    return found


@pytest.fixture(scope="module", params=["grid", "london"])
def drawn(request, tmp_path_factory):
    """A network that keeps right, and one that keeps left, and the OpenDRIVE of each."""
    net = read_configuration(open_scenario(request.param).config).net
    target = tmp_path_factory.mktemp("opendrive") / "road.xodr"
    write_opendrive(net, target)
    return net, ET.parse(target).getroot()


@pytest.mark.slow
def test_lanes_lie_where_they_are_in_sumo_and_meet_in_junctions(drawn):
    net, root = drawn
    with opened(net) as file:
        sumo = ET.parse(file).getroot()
    lines = [
        [tuple(map(float, point.split(",")[:2])) for point in lane.attrib["shape"].split()]
        for edge in sumo.iter("edge")
        if edge.get("function") is None
        for lane in edge.iter("lane")
    ]
    roads = {road.attrib["id"]: (road, lane_lines(road)) for road in root.iter("road")}
    straight = [made for road, each in roads.values() if road.attrib["junction"] == "-1" for made in each.values()]
    assert len(straight) == len(lines)
    off_m = sorted(
        min(max(math.dist(begin, line[0]), math.dist(end, line[-1])) for line in lines) for begin, end in straight
    )
    assert off_m[int(0.98 * len(off_m))] < 0.1
    assert off_m[-1] < 1.0, "lanes that end beside each other at an angle"
    for connection in root.iter("connection"):
        (_, before), (way, through) = (
            roads[connection.attrib[name]] for name in ("incomingRoad", "connectingRoad")
        )
        _, after = roads[way.find("link/successor").attrib["elementId"]]
        for link in connection.iter("laneLink"):
            here = through[int(link.attrib["to"])]
            assert math.dist(before[int(link.attrib["from"])][1], here[0]) < 0.02
            lane = next(each for each in way.iter("lane") if each.attrib["id"] == link.attrib["to"])
            assert math.dist(after[int(lane.find("link/successor").attrib["id"])][0], here[1]) < 0.02
    location, header = sumo.find("location").attrib, root.find("header")
    easting_m, northing_m = (-float(each) for each in location["netOffset"].split(","))
    assert header.find("offset") is None
    on_earth = pyproj.Proj(location["projParameter"])(easting_m + 500, northing_m + 300, inverse=True)
    assert pyproj.Proj(header.findtext("geoReference"))(*on_earth) == pytest.approx((500, 300), abs=1e-3)
    keeps_left = drives_on_left(net)
    assert {road.get("rule") for road, _ in roads.values()} == {"LHT" if keeps_left else None}
    assert all((lane > 0) == keeps_left for _, each in roads.values() for lane in each)


@pytest.mark.slow
def test_curves_are_told_no_longer_than_they_are_and_signals_have_numbers(drawn):
    _, root = drawn
    at = (np.arange(20_000) + 0.5) / 20_000
    for geometry in root.iter("geometry"):
        if (curve := geometry.find("paramPoly3")) is not None and curve.get("pRange") == "normalized":
            slopes = [
                b + at * (2 * c + at * 3 * d)
                for b, c, d in ([float(curve.attrib[f"{power}{axis}"]) for power in "bcd"] for axis in "UV")
            ]
            long_m = float(np.hypot(*slopes).mean())
            assert 0 < long_m - float(geometry.attrib["length"]) < 1e-5
    signals = [signal.attrib["id"] for signal in root.iter("signal")]
    assert sorted(map(int, signals)) == list(range(len(signals)))
    assert {control.attrib["signalId"] for control in root.iter("control")} <= set(signals)


LANES = (
    ({"allow": "bus taxi"}, {"bus", "taxi"}),
    ({"disallow": "truck"}, set(ACCESS) - {"truck"}),
    ({}, set(ACCESS)),
)


def test_a_road_that_is_read_back_has_lanes_for_the_same_vehicles(tmp_path, sumo):
    rows = "".join(
        f"<lane index='{at}' {' '.join(f'{name}={quoteattr(value)}' for name, value in attributes.items())}/>"
        for at, (attributes, _) in enumerate(LANES)
    )
    (tmp_path / "a.nod.xml").write_text("<nodes><node id='a' x='0' y='0'/><node id='b' x='300' y='0'/></nodes>")
    edge = f"<edge id='ab' from='a' to='b' numLanes='{len(LANES)}' speed='14'>{rows}</edge>"
    (tmp_path / "a.edg.xml").write_text(f"<edges>{edge}</edges>")
    ok, printed = run("netconvert", ("-n", "a.nod.xml", "-e", "a.edg.xml", "-o", "a.net.xml"), tmp_path)
    assert ok, printed
    write_opendrive(tmp_path / "a.net.xml", tmp_path / "a.xodr")
    (again,) = road_network(tmp_path / "a.xodr", tmp_path).getEdges()
    for lane, (_, classes) in zip(again.getLanes(), LANES, strict=True):
        assert {each for each in ACCESS if lane.allows(each)} == classes


def test_a_road_that_is_read_back_has_signs_where_it_had_them(tmp_path, sumo):
    nodes = "".join(f"<node id='{at}' x='{300 * number}' y='0'/>" for number, at in enumerate("abc"))
    (tmp_path / "a.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (tmp_path / "a.edg.xml").write_text(
        "<edges><edge id='ab' from='a' to='b' speed='14'/>"
        "<edge id='bc' from='b' to='c' speed='14'><param key='maxspeed' value='50'/></edge></edges>"
    )
    ok, printed = run("netconvert", ("-n", "a.nod.xml", "-e", "a.edg.xml", "-o", "a.net.xml"), tmp_path)
    assert ok, printed
    write_opendrive(tmp_path / "a.net.xml", tmp_path / "a.xodr")
    posted = [edge.getParam("maxspeed") for edge in road_network(tmp_path / "a.xodr", tmp_path).getEdges()]
    assert sorted(map(str, posted)) == ["50.4", "None"]


def read_trajectories(path):
    """Kind and fields of each record of SSAM's format, by its specification."""
    layouts, data, at = (FORMAT, DIMENSIONS, TIMESTEP, VEHICLE), path.read_bytes(), 0
    assert [struct.calcsize(each) for each in layouts] == [6, 22, 5, 42]
    while at < len(data):
        kind, *values = struct.unpack_from(layouts[data[at]], data, at)
        at += struct.calcsize(layouts[kind])
        yield kind, values


def test_trajectories_for_ssam_pass_through_the_recorded_places(recording, tmp_path):
    write_trajectories(recording, tmp_path / "a.trj")
    (first, form), (second, (_, scale, *bounds)), *records = read_trajectories(tmp_path / "a.trj")
    assert (first, second, form[0], scale) == (0, 1, ord("L"), 1.0)
    assert form[1] == pytest.approx(1.04)
    found, at_s = {}, None
    for kind, values in records:
        if kind == 2:
            (at_s,) = values
            continue
        number, link, lane, *line = values
        assert (link, lane) == (0, 0)
        found[number, round(at_s, 3)] = line
        assert bounds[0] <= line[0] <= bounds[2]
        assert bounds[1] <= line[1] <= bounds[3]
        assert math.dist(line[0:2], line[2:4]) == pytest.approx(line[4], abs=1e-3)
    assert len({at_s for _, at_s in found}) == 591, "tenths of a second"
    for number, name in ((1, "ego"), (2, "line$1:2")):
        for second in recording.road.seconds:
            seen = [each for each in second.vehicles if each.vehicle_id == name]
            at = number, second.at_s - recording.begin_s
            assert (at in found) == bool(seen)
            for each in seen:
                assert math.dist(found[at][:2], (each.x_m, each.y_m)) < 1e-3
                assert found[at][4:7] == pytest.approx((each.length_m, each.width_m, each.speed_mps))
    assert (2, 15.5) not in found, "it was gone a half second later"
    steps = [found[1, round(tenth / 10, 1)] for tenth in range(591)]
    assert all(math.dist((0, 0), line[:2]) == pytest.approx(100, abs=0.1) for line in steps), "the circle"


@pytest.mark.sumo
def test_an_episode_is_exported_by_command(tmp_path, simulations, cli):
    setup = EpisodeSetup(task="hvac_fan_max", scenario="grid", agent="oracle", model="none")
    run_trial(setup, make_agent("oracle"), [RoadRecorder(tmp_path / "kept", setup.about)], simulations=simulations)
    told = cli("export", tmp_path / "kept", "openscenario-1.3", "opendrive", "fcd", "csv", "ssam")
    assert told.code == 0, told.err
    folder = tmp_path / "kept" / "exchange"
    scenario = ET.parse(folder / "scenario.xosc").getroot()
    record = read_recording(tmp_path / "kept")
    seen = {
        (round(second.at_s - record.begin_s, 2), each.vehicle_id): (each.x_m, each.y_m)
        for second in record.road.seconds
        for each in second.vehicles
    }
    found = front_bumpers(scenario)
    assert {key for key in seen if key[1] == "ego"} <= found.keys()
    assert max(math.dist(found[key][:2], seen[key]) for key in found) < 0.1
    signals = {signal.attrib["id"] for signal in ET.parse(folder / "road.xodr").iter("signal")}
    lit = {state.attrib["trafficSignalId"] for state in scenario.iter("TrafficSignalState")}
    assert lit
    assert lit <= signals
    weather = record.road.seconds[0].weather
    assert float(next(scenario.iter("Fog")).attrib["visualRange"]) == weather.visibility
    rows = list(csv.DictReader((folder / "trajectories.csv").read_text("utf-8").splitlines()))
    fcd = list(ET.parse(folder / "fcd.xml").iter("vehicle"))
    assert len(rows) == len(fcd) == len(seen)
    assert (float(rows[0]["x_m"]), rows[0]["vehicle_id"]) == (float(fcd[0].attrib["x"]), fcd[0].attrib["id"])
    assert sum(kind == 2 for kind, _ in read_trajectories(folder / "trajectories.trj")) > 10
    assert cli("export", tmp_path / "kept").code == 2


def test_a_table_of_all_vehicles_as_parquet(recording, tmp_path):
    pd = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    write_csv(recording, tmp_path / "a.csv")
    write_parquet(recording, tmp_path / "a.parquet")
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "a.parquet"), pd.read_csv(tmp_path / "a.csv"))
