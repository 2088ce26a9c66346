"""A network of two ways that can be reckoned by hand, drawn here, and studies of it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.traffic import sumo_programs

NODES = {
    "start": (0, 0),
    "fork": (500, 0),
    "side": (1000, 400),
    "join": (1500, 0),
    "goal": (2000, 0),
    "off": (1600, -400),
}
EDGES = {
    "access": ("start", "fork", 500.0),
    "main": ("fork", "join", 1000.0),
    "out": ("fork", "side", 750.0),
    "back": ("side", "join", 750.0),
    "exit": ("join", "goal", 500.0),
    "leave": ("join", "off", 500.0),
}
SPEED_MPS, SLOW_MPS = 10.0, 5.0
LORRY_EVERY_S = 10.0
LORRIES = f"""<routes>
    <vType id="lorry" vClass="truck" length="7.5" maxSpeed="{SLOW_MPS}" sigma="0" speedFactor="1" speedDev="0"/>
    <vType id="car" vClass="passenger" sigma="0" speedFactor="1" speedDev="0"/>
    <route id="slowly" edges="main leave"/>
    <flow id="lorries" type="lorry" route="slowly" begin="0" end="20000" period="{LORRY_EVERY_S}" departPos="100"
          departSpeed="max"/>
</routes>"""
SCENARIO = """name = "two_ways"
title = "Two ways"
about = "Lorries crawl on the main road; the other way is longer and free."
country = "FR"
start = "2026-03-10T08:30:00"
time_zone = "Europe/Paris"

[sumo]
config = "two.sumocfg"
step_length_s = 1.0
warm_up_s = 600.0
background_rerouting = 0.0

[ego]
driver = "steady"

[[ego.trips]]
name = "across"
from_edge = "access"
to_edge = "exit"

[[weather]]
at_s = 0.0
temperature_2m = 12.0
relative_humidity_2m = 60.0
precipitation = 0.0
weather_code = 1
cloud_cover = 10.0
visibility = 30000.0
wind_speed_10m = 5.0
"""
MORE_TRIPS = """
[[ego.trips]]
name = "nowhere_else"
from_edge = "main"
to_edge = "leave"

[[ego.trips]]
name = "free"
from_edge = "out"
to_edge = "exit"

[[ego.trips]]
name = "stands"
from_edge = "exit"
to_edge = "exit"
"""
Draw = Callable[..., Path]


@pytest.fixture(scope="session")
def two_ways(sumo: None, tmp_path_factory: pytest.TempPathFactory) -> Draw:
    """Draws the network in a new folder, with other demand or more in its ``scenario.toml`` if wanted.

    Edges meet in points: junctions have no length, so that a way is as long as its edges."""
    drawn = tmp_path_factory.mktemp("drawn")
    nodes = "".join(f'<node id="{name}" x="{x}" y="{y}" type="priority"/>' for name, (x, y) in NODES.items())
    edges = "".join(
        f'<edge id="{name}" from="{begin}" to="{end}" numLanes="1" speed="{SPEED_MPS}" length="{length_m}"/>'
        for name, (begin, end, length_m) in EDGES.items()
    )
    (drawn / "two.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (drawn / "two.edg.xml").write_text(f"<edges>{edges}</edges>")
    files = ("-n", drawn / "two.nod.xml", "-e", drawn / "two.edg.xml", "-o", drawn / "two.net.xml")
    built, printed = sumo_programs.run("netconvert", [*files, "--no-internal-links", "--no-turnarounds"])
    assert built, printed

    def draw(demand: str = LORRIES, more: str = "") -> Path:
        folder = tmp_path_factory.mktemp("two_ways")
        (folder / "two.net.xml").write_bytes((drawn / "two.net.xml").read_bytes())
        (folder / "two.rou.xml").write_text(demand)
        (folder / "two.sumocfg").write_text(
            '<configuration><input><net-file value="two.net.xml"/><route-files value="two.rou.xml"/></input>'
            "</configuration>"
        )
        (folder / "scenario.toml").write_text("has_place = false\n" + SCENARIO + more)
        return folder

    return draw


@pytest.fixture(scope="session")
def small(two_ways: Draw) -> StudyPlan:
    """One drive with one decision."""
    return StudyPlan(str(two_ways()), departures_s=(0.0,), seeds=(0,), per_drive=1)
