"""The network that netconvert builds, of roads with every kind of tag: no traffic is tried."""

import gzip
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import pytest

from automotive_cosim.contracts import LimitSource
from automotive_cosim.geo.place import shipped
from automotive_cosim.osm import arrows, extract, network
from automotive_cosim.osm.agreement import differences
from automotive_cosim.osm.doubts import doubts
from automotive_cosim.osm.extract import Extract
from automotive_cosim.osm.network import Built
from automotive_cosim.osm.ramps import in_words, widened
from automotive_cosim.osm.roads import MappedRoad, describe, way_of
from tests.osm import lost
from tests.osm.maps import Map

pytestmark = pytest.mark.sumo

Build = Callable[[Map], "World"]


class World(NamedTuple):
    """A map and its network."""

    map: Extract
    roads: dict[int, MappedRoad]
    built: Built
    country: str

    def ends(self, way: int) -> set[str]:
        """The directions of a way that were built."""
        edges = [edge.edge_id for edge in self.built.edges if way_of(edge.edge_id) == way]
        return {"-" if edge.startswith("-") else "+" for edge in edges}

    def reaches(self, start: str, goal: int) -> bool:
        """Whether cars that start on an edge come to a way without another road between."""
        seen, waiting = {start}, [start]
        while waiting:
            for onward in self.built.network.crossings.get(waiting.pop(), {}):
                if way_of(onward) == goal:
                    return True
                if way_of(onward) == way_of(start) and onward not in seen:
                    seen.add(onward)
                    waiting.append(onward)
        return False


@pytest.fixture
def build(sumo: None, tmp_path: Path) -> Build:
    def build(made: Map, country: str = "DE") -> World:
        file = tmp_path / "map.osm"
        file.write_text(made.xml(), encoding="utf-8")
        mapped = extract.read(file)
        roads = describe(mapped, shipped(), country)
        built = network.convert(mapped, roads, tmp_path / "town.net.xml.gz", country, tmp_path)
        return World(mapped, roads, built, country)

    return build


def ladder(rungs: Sequence[dict[str, str]], middle: Sequence[dict[str, str]] = ()) -> Map:
    """Two streets, ways 100 and 101 (and 102, 103 at their ends), with a rung between them for each set of tags,
    from way 104 on; ``middle`` has tags for the node in the middle of a rung."""
    made = Map((8.70, 48.59))
    for index in range(len(rungs) + 2):
        made.nodes |= {f"s{index}": (index * 150.0, 0.0), f"n{index}": (index * 150.0, 160.0)}
    for side in "sn":
        made.way(" ".join(f"{side}{index}" for index in range(len(rungs) + 2)), highway="tertiary", name=side)
    for index in (0, len(rungs) + 1):
        made.way(f"s{index} n{index}", highway="tertiary", name=f"end {index}")
    for index, tags in enumerate(rungs, start=1):
        made.nodes[f"m{index}"] = (index * 150.0, 80.0)
        made.node_tags[f"m{index}"] = middle[index - 1] if middle else {}
        made.ways.append(
            ([f"s{index}", f"m{index}", f"n{index}"], {"highway": "tertiary", "name": f"{index}"} | tags)
        )
    return made


FIRST = 104
"""The way of the first rung."""


def test_every_road_is_open_the_way_its_tags_say(build: Build) -> None:
    rungs: tuple[tuple[dict[str, str], str], ...] = (
        ({}, "+-"),
        ({"access": "no", "motor_vehicle": "yes"}, "+-"),
        ({"access": "no", "motorcar": "destination"}, "+-"),
        ({"access": "private"}, ""),
        ({"motor_vehicle": "agricultural;forestry"}, ""),
        ({"motor_vehicle:backward": "no"}, "+"),
        ({"vehicle:forward": "no"}, "-"),
        ({"oneway:motor_vehicle": "-1"}, "-"),
        ({"oneway": "yes", "oneway:motorcar": "no"}, "+-"),
        ({"oneway": "yes", "oneway:bus": "no", "lanes": "2"}, "+"),
        ({"oneway": "yes", "lanes": "0"}, "+"),
        ({"lanes": "99"}, "+-"),
        ({"oneway": "reversible"}, "+"),
        ({"oneway": "reversible", "oneway:conditional": "yes @ (05:00-21:00);-1 @ (21:00-05:00)"}, "+-"),
        ({"sidewalk": "both", "cycleway": "lane", "railway": "tram", "bicycle:lanes": "|designated"}, "+-"),
    )
    world = build(ladder([tags for tags, _ in rungs]))
    found = {index: world.ends(FIRST + index) for index in range(len(rungs))}
    assert found == {index: set(ends) for index, (_, ends) in enumerate(rungs)}
    assert not list(differences(world.map, world.built, world.roads, world.country))


def test_cars_stop_at_barriers_and_nowhere_else(build: Build) -> None:
    middle: tuple[tuple[dict[str, str], bool], ...] = (
        ({"barrier": "bollard"}, False),
        ({"barrier": "gate", "access": "private"}, False),
        ({"barrier": "lift_gate", "motor_vehicle": "no"}, False),
        ({"barrier": "block"}, False),
        ({"barrier": "bollard", "motor_vehicle": "yes"}, True),
        ({"barrier": "toll_booth"}, True),
        ({"barrier": "gate"}, True),
        ({"highway": "crossing", "access": "no"}, True),
    )
    world = build(ladder([{} for _ in middle], [tags for tags, _ in middle]))
    for index, (tags, passes) in enumerate(middle):
        way = FIRST + index
        assert world.reaches(str(way), 101) == passes, tags
        south = [edge.edge_id for edge in world.built.edges if way_of(edge.edge_id) == way]
        north = max((edge for edge in south if edge.startswith("-")), key=len)
        assert world.reaches(north, 100) == passes, tags
    assert not list(differences(world.map, world.built, world.roads, world.country))
    told = "\n".join(doubts(world.map, world.roads, world.built, world.country))
    assert "barrier=bollard: node" in told
    assert "for whom they open, passed: barrier=gate: node" in told


def test_a_barrier_where_one_way_ends_and_the_next_begins(build: Build) -> None:
    made = ladder([{}, {}], [{"barrier": "bollard"}, {}])
    nodes, tags = made.ways.pop(FIRST - 100)
    made.ways += [(nodes[:2], tags), (nodes[1:], tags)]
    world = build(made)
    assert not world.reaches("105", 106)
    assert not list(differences(world.map, world.built, world.roads, world.country))


def test_lanes_of_buses_are_not_for_cars(build: Build) -> None:
    one = {"oneway": "yes"}
    rungs = (
        (one | {"lanes": "3", "lanes:psv": "1"}, 2, True),
        (one | {"lanes": "2", "lanes:bus": "1"}, 1, True),
        (one | {"lanes": "2", "bus:lanes": "yes|designated"}, 1, True),
        (one | {"lanes": "2", "busway:right": "lane"}, 1, True),
        (one | {"lanes": "2", "oneway:psv": "no"}, 1, False),
        (one | {"lanes": "2", "access:lanes": "yes|no"}, 1, False),
        (one | {"lanes": "3", "hov:lanes": "designated|no|no"}, 2, False),
        (one | {"lanes": "2"}, 2, False),
    )
    for country in ("DE", "GB"):
        world = build(ladder([tags for tags, _, _ in rungs]), country)  # type: ignore[call-arg]
        for index, (tags, lanes, has_bus_lane) in enumerate(rungs):
            edge = world.built.network.edges[str(FIRST + index)]
            assert (len(edge.lane_ids), edge.bus_lane) == (lanes, has_bus_lane), (country, tags)
            if has_bus_lane and "bus:lanes" not in tags:
                assert f"{edge.edge_id}_0" not in edge.lane_ids, "buses drive at the kerb"


CROSSINGS: tuple[tuple[dict[str, str], str], ...] = (
    ({"type": "restriction", "restriction": "no_left_turn"}, "rs"),
    ({"type": "restriction", "restriction:motorcar": "no_left_turn"}, "rs"),
    ({"type": "restriction", "restriction:motor_vehicle": "no_left_turn"}, "rs"),
    ({"type": "restriction", "restriction:vehicle": "no_left_turn"}, "rs"),
    ({"type": "restriction:motorcar", "restriction": "no_left_turn"}, "rs"),
    ({"type": "restriction:hgv", "restriction": "no_left_turn"}, "lrs"),
    ({"type": "restriction", "restriction:hgv": "no_left_turn"}, "lrs"),
    ({"type": "restriction", "restriction": "no_left_turn", "except": "motorcar"}, "lrs"),
    ({"type": "restriction", "restriction": "no_left_turn", "except": "bus;motor_vehicle"}, "lrs"),
    ({"type": "restriction", "restriction": "no_left_turn", "except": "bus;bicycle"}, "rs"),
    ({"type": "restriction", "restriction": "no_left_turn", "restriction:motorcar": "none"}, "lrs"),
    ({"type": "restriction", "restriction": "no_left_turn_on_red"}, "lrs"),
    ({"type": "restriction", "restriction": "only_left_turn"}, "l"),
    ({"type": "restriction", "restriction:conditional": "no_left_turn @ (sunset-sunrise)"}, "lrs"),
    ({"type": "restriction", "restriction": "no_left_turn", "hour_on": "7:00", "hour_off": "9:00"}, "lrs"),
    ({"type": "restriction", "restriction": "keep_left"}, "lrs"),
    ({"type": "route", "restriction": "no_left_turn"}, "lrs"),
)
"""What a relation says about turning from the south into the west, and the turns that remain."""


def crossings(
    relations: Sequence[dict[str, str]], members: str = "from:s via:x to:w"
) -> tuple[Map, list[dict[str, str]]]:
    """A street with a crossing for each relation; and for each, the ways of its arms."""
    made, arms = Map((8.70, 48.59)), []
    count = len(relations) + 2
    for index in range(count):
        made.nodes |= {f"{row}{index}": (index * 150.0, y) for row, y in (("s", -150.0), ("x", 0.0), ("n", 150.0))}
    for side in "sn":
        made.way(" ".join(f"{side}{index}" for index in range(count)), highway="tertiary", name=side)
    for index in (0, count - 1):
        made.way(f"s{index} x{index} n{index}", highway="tertiary", name=f"end {index}")
    for index in range(count - 1):
        made.way(f"x{index} x{index + 1}", highway="tertiary", name="main")
    first = 100 + len(made.ways)
    for index, tags in enumerate(relations, start=1):
        made.way(f"s{index} x{index}", highway="tertiary")
        made.way(f"x{index} n{index}", highway="tertiary")
        arm = {"s": first + 2 * index - 2, "n": first + 2 * index - 1, "w": 103 + index, "e": 104 + index}
        arms.append({name: str(way) for name, way in arm.items()})
        pairs = [tuple(member.split(":")) for member in members.split()]
        made.relations.append(
            ([(role, f"x{index}" if what == "x" else str(arm[what])) for role, what in pairs], tags)
        )
    return made, arms


def turns(world: World, arms: dict[str, str], start: str = "s") -> str:
    """The turns from an arm: l, r, s and u, seen from the south."""
    names = {arms["w"]: "l", arms["e"]: "r", arms["n"]: "s", arms["s"]: "u"}
    edge = arms[start] if start in "sw" else f"-{arms[start]}"
    return "".join(sorted(names[str(way_of(onward))] for onward in world.built.network.crossings.get(edge, {})))


def test_every_restriction_bars_the_turns_that_it_bars_to_cars(build: Build) -> None:
    made, arms = crossings([tags for tags, _ in CROSSINGS])
    world = build(made)
    found = [turns(world, each) for each in arms]
    assert found == ["".join(sorted(left)) for _, left in CROSSINGS]
    assert not list(differences(world.map, world.built, world.roads, world.country))
    told = "\n".join(doubts(world.map, world.roads, world.built, world.country))
    assert "under conditions that are not understood, left out: relations 14, 15" in told
    assert "not understood, left out: relation 16" in told


HOURS: tuple[tuple[dict[str, str], dict[str, list[tuple[bool, str]]]], ...] = (
    ({"restriction:conditional": "no_left_turn @ (Mo-Fr 07:00-19:00)"}, {"l": [(False, "Mo-Fr 07:00-19:00")]}),
    (
        {"restriction": "no_left_turn", "restriction:conditional": "none @ (Sa-Su)"},
        {"l": [(False, ""), (True, "Sa-Su")]},
    ),
    (
        {"restriction:motorcar:conditional": "only_left_turn @ 16:00-18:00"},
        {"r": [(False, "16:00-18:00")], "s": [(False, "16:00-18:00")]},
    ),
    ({"restriction:conditional": "no_left_turn @ (weight>7.5)"}, {}),
    ({"restriction:hgv:conditional": "no_left_turn @ (07:00-19:00)"}, {}),
    ({"restriction:conditional": "no_left_turn @ (07:00-19:00)", "except": "bus"}, {"l": [(False, "07:00-19:00")]}),
    ({"restriction:conditional": "no_left_turn @ (07:00-19:00)", "except": "motorcar"}, {}),
)
"""What a relation says; and of the turns from the south that are not always open, when they are."""


def test_turns_and_roads_at_certain_hours_are_in_the_network_with_their_hours(build: Build) -> None:
    made, arms = crossings([{"type": "restriction"} | tags for tags, _ in HOURS])
    made.ways[0][1]["access:conditional"] = "no @ (Mo-Fr 07:30-08:30)"  # type: ignore[index]
    world = build(made)
    found = []
    for each in arms:
        assert turns(world, each) == "lrs"
        names = {each["w"]: "l", each["e"]: "r", each["n"]: "s"}
        timed = world.built.network.edges[each["s"]].timed_turns
        found.append(
            {names[str(way_of(goal))]: [(at.is_open, at.hours.text) for at in access] for goal, access in timed}
        )
    assert found == [hours for _, hours in HOURS]
    assert {way_of(edge.edge_id) for edge in world.built.edges if edge.timed_access} == {100}
    always = world.built.network.open_at_all_hours().crossings
    assert {way_of(edge_id) for edge_id in always} == world.roads.keys() - {100}
    assert not list(differences(world.map, world.built, world.roads, world.country))
    assert not [text for text in doubts(world.map, world.roads, world.built, world.country) if "access" in text]


@pytest.mark.parametrize(
    ("restriction", "members", "left"),
    [
        ("no_entry", "from:s from:e via:x to:w", {"s": "rs", "e": "su"}),
        ("no_exit", "from:s via:x to:w to:n", {"s": "r"}),
        ("only_straight_on", "from:s via:x to:n", {"s": "s"}),
        ("only_straight_on", "from:s via:x to:n to:e", {"s": "rs"}),
        ("no_u_turn", "from:s via:x to:s", {"s": "lrs"}),
        ("no_left_turn;no_straight_on", "from:s via:x to:w to:n", {"s": "r"}),
        ("no_left_turn", "from:s to:w", {"s": "rs"}),
        ("no_left_turn", "from:s via:x to:w location_hint:x", {"s": "rs"}),
    ],
)
def test_several_members(restriction: str, members: str, left: dict[str, str], build: Build) -> None:
    made, arms = crossings([{"type": "restriction", "restriction": restriction}], members)
    world = build(made)
    assert {arm: turns(world, arms[0], arm) for arm in left} == left
    assert not list(differences(world.map, world.built, world.roads, world.country))


def test_a_turn_over_a_way_is_barred_where_only_its_start_leads_onto_that_way(build: Build) -> None:
    """A street joins one side of a dual carriageway, and cars may not turn back by the link to the other."""
    made = Map((8.70, 48.59))
    made.nodes |= {"a": (0.0, 0.0), "b": (300.0, 0.0), "c": (600.0, 0.0)}
    made.nodes |= {"d": (600.0, 60.0), "e": (300.0, 60.0), "f": (0.0, 60.0), "g": (300.0, 200.0)}
    one = {"highway": "primary", "oneway": "yes"}
    for nodes in ("a b", "b c", "c d", "d e", "e f", "f a"):
        made.ways.append((nodes.split(), one | {"name": nodes}))
    made.way("b e", highway="primary_link", oneway="yes", name="link")
    made.way("e g", highway="tertiary", name="street")
    made.relations.append(
        ([("from", "100"), ("via", "106"), ("to", "104")], {"type": "restriction", "restriction": "no_u_turn"})
    )
    world = build(made)
    assert not any(way_of(onward) == 104 for onward in world.built.network.crossings["106"])
    assert any(way_of(onward) == 107 for onward in world.built.network.crossings["106"])
    made.way("b g", highway="tertiary", name="another way onto the link")
    world = build(made)
    assert any(way_of(onward) == 104 for onward in world.built.network.crossings["106"])
    assert world.built.turns.over_ways == [1]


def test_a_network_that_is_not_as_the_map_says_is_told(build: Build) -> None:
    """The second reading finds what the first gets wrong: here it is given another map than was built."""
    made, _ = crossings([{"type": "restriction", "restriction:hgv": "no_left_turn"}])
    made.ways[0][1]["maxspeed"] = "50"  # type: ignore[index]
    world = build(made)
    ways = {way.way_id: dict(way.tags) for way in world.map.ways}
    for tags, what in (
        ({"maxspeed": "70"}, "limit"),
        ({"oneway": "yes"}, "access"),
        ({"motor_vehicle": "no"}, "access"),
    ):
        for way in world.map.ways:
            way.tags.clear()  # type: ignore[attr-defined]
            way.tags.update(ways[way.way_id] | (tags if way.way_id == 100 else {}))  # type: ignore[attr-defined]
        assert what in {found.what for found in differences(world.map, world.built, world.roads, "DE")}
    world.map.restrictions[0].tags["restriction"] = "no_left_turn"  # type: ignore[index]
    assert "turn" in {found.what for found in differences(world.map, world.built, world.roads, "DE")}
    next(iter(world.map.nodes.values())).tags["barrier"] = "bollard"  # type: ignore[index]
    assert "barrier" in {found.what for found in differences(world.map, world.built, world.roads, "DE")}


def test_lanes_for_leaving_and_joining_are_told_and_are_no_difference(build: Build) -> None:
    made = Map((8.70, 48.59))
    made.nodes = {f"m{index}": (index * 300.0, 0.0) for index in range(5)}
    made.nodes |= {"off": (600.0, -150.0), "on": (300.0, 150.0), "back": (0.0, 300.0)}
    fast = {"highway": "motorway", "oneway": "yes", "maxspeed": "120"}
    for index, lanes in enumerate("2232"):
        made.way(f"m{index} m{index + 1}", **fast, lanes=lanes)
    made.way("m1 off", highway="motorway_link", oneway="yes", lanes="1")
    made.way("off m3", highway="motorway_link", oneway="yes", lanes="1")
    made.way("m4 on", highway="motorway_link", oneway="yes", lanes="1")
    made.way("on back m0", highway="motorway_link", oneway="yes", lanes="1")
    world = build(made)
    found = list(widened(world.built.edges, world.roads))
    assert {(way_of(each.edge_id), each.mapped, each.built) for each in found} == {(100, 2, 3), (103, 2, 4)}
    assert in_words(found) == "way 103: 2 as 4, way 100: 2 as 3"
    assert not list(differences(world.map, world.built, world.roads, world.country))
    wider = replace(world.roads[101], tags=world.roads[101].tags | {"lanes": "1"})
    wrong = differences(world.map, world.built, world.roads | {101: wider}, world.country)
    assert [str(each)[:24] for each in wrong] == ["way 101: lanes: 1 in the"]


def told(world: World) -> str:
    """What the import lists."""
    return "\n".join(doubts(world.map, world.roads, world.built, world.country))


def row_of_crossings(
    arms: Sequence[dict[str, str]], signs: Sequence[dict[str, dict[str, str]]] = ()
) -> tuple[Map, list[int]]:
    """A street, way 100, with a crossing for each set of tags of its southern arm, which leads north; ``signs`` has
    tags of nodes on each crossing: ``"s"`` on the southern arm, ``"n"`` on the northern, ``"x"`` in its middle.

    Returns:
        The map, and the ways of the southern arms."""
    made, ways = Map((8.70, 48.59)), []
    for index in range(len(arms) + 2):
        for row, y in (("a", -150.0), ("s", -8.0), ("x", 0.0), ("n", 8.0), ("b", 150.0)):
            made.nodes[f"{row}{index}"] = (index * 150.0, y)
    for row in "xab":
        made.way(" ".join(f"{row}{index}" for index in range(len(arms) + 2)), highway="tertiary", name=row)
    for index in (0, len(arms) + 1):
        made.way(f"a{index} x{index} b{index}", highway="tertiary", name=f"end {index}")
    for index, tags in enumerate(arms, start=1):
        made.node_tags |= {f"{row}{index}": each for row, each in (signs[index - 1] if signs else {}).items()}
        ways.append(100 + len(made.ways))
        made.ways.append(([f"{row}{index}" for row in "asx"], {"highway": "tertiary"} | tags))
        made.ways.append(([f"{row}{index}" for row in "xnb"], {"highway": "tertiary"}))
    return made, ways


ONE = {"oneway": "yes"}
ARROWS = (
    *({"turn:lanes": f"{value}|"} for value in sorted(arrows.KNOWN - {""})),
    *({"turn:lanes": f"|{value}"} for value in sorted(arrows.KNOWN - {""})),
    {"turn:lanes": "left|through;right"},
    {"turn:lanes": "left;through|right"},
    {"turn:lanes:forward": "left|through;right"},
    {"turn:lanes": "left|through|right", "lanes": "3"},
    {"turn:lanes": "left|through|right"},
    {"turn:lanes": "left|left|right", "lanes": "3"},
    {"turn:lanes": "left|sideways"},
    {"turn:lanes": "through"},
    {"turn": "left"},
    {"turn": "right", "lanes": "1"},
)


POINTS = {"left": "lL", "sharp_left": "lL", "slight_left": "lLs", "through": "LsR", "slight_right": "sRr",
          "right": "Rr", "sharp_right": "Rr"}  # fmt: skip
"""SUMO's letters that an arrow may mean."""


@pytest.mark.parametrize("country", ["DE", "GB"])
def test_lanes_lead_where_arrows_point_or_the_list_names_the_way(build: Build, country: str) -> None:
    made, ways = row_of_crossings([ONE | {"lanes": "2"} | tags for tags in ARROWS])
    world = build(made, country)  # type: ignore[call-arg]
    listed = {
        int(number) for line in told(world).splitlines() if "turn" in line for number in NUMBERS.findall(line)
    }
    followed = 0
    for way, tags in zip(ways, ARROWS, strict=True):
        links = world.built.links.of[str(way)]
        count = 1 + max(link.lane for link in links)
        by_lane = [{link.direction for link in links if link.lane == lane} for lane in range(count)]
        lanes = by_lane if country == "GB" else by_lane[::-1]
        wanted = [set(lane.split(";")) for lane in next(iter(tags.values())).split("|")]
        fits = len(wanted) == count and all(
            words <= {"", "none"} or (words <= POINTS.keys() and lane and all(
                any(letter in POINTS[word] for word in words) for letter in lane
            ) and all(lane & set(POINTS[word]) for word in words))
            for words, lane in zip(wanted, lanes, strict=True)
        )  # fmt: skip
        merges = any("merge" in word for words in wanted for word in words)
        assert (way in listed) is not fits or (merges and way not in listed), (tags, links)
        followed += fits
    assert followed >= 8, "most that are possible"


NUMBERS = re.compile(r"\b1\d\d\b")

STATES = (
    ({"s": {"highway": "stop"}}, "s", ""),
    ({"s": {"highway": "stop", "direction": "forward"}}, "s", ""),
    ({"s": {"highway": "stop", "stop:direction": "forward"}}, "s", ""),
    ({"s": {"highway": "stop", "direction": "both"}}, "s", ""),
    ({"s": {"highway": "stop", "direction": "180"}}, "s", ""),
    ({"s": {"highway": "stop", "direction": "S"}}, "s", ""),
    ({"s": {"highway": "stop", "direction": "backward"}}, "", "stop signs with no junction"),
    ({"s": {"highway": "stop", "direction": "90"}}, "", "stop signs that face across the road"),
    ({"s": {"highway": "stop", "direction": "up"}}, "", "stop signs with direction=up"),
    ({"s": {"highway": "give_way"}}, "m", ""),
    ({"s": {"highway": "give_way", "direction": "forward"}}, "m", ""),
    ({"s": {"highway": "give_way"}, "n": {"highway": "stop"}}, "m", ""),
    ({"s": {"highway": "stop", "stop": "minor"}}, "s", ""),
    ({"s": {"highway": "stop", "stop": "all"}}, "w", ""),
    ({"x": {"highway": "stop", "stop": "all"}}, "w", ""),
    ({"x": {"highway": "stop"}}, "", "stop signs on a junction"),
    ({"x": {"highway": "give_way"}}, "", "give-way signs on a junction"),
    ({"x": {"highway": "mini_roundabout"}}, "=", ""),
    ({"a": {"highway": "mini_roundabout"}}, "", ""),
    ({}, "", ""),
)
"""Signs, SUMO's letter of the right of way from the south, and how those that are not followed are listed."""


def test_right_of_way_is_as_signed_or_the_list_names_the_sign(build: Build) -> None:
    made, ways = row_of_crossings([{} for _ in STATES], [signs for signs, _, _ in STATES])
    world = build(made)
    list_of = told(world)
    numbers = {name: number for number, name in enumerate(made.nodes, start=1)}
    for index, (way, (signs, state, listed)) in enumerate(zip(ways, STATES, strict=True), start=1):
        links = [link for link in world.built.links.of[str(way)] if link.direction != "t"]
        if state:
            assert {link.state for link in links} == {state}, (signs, links)
        if state in "sm" and state:
            assert world.built.network.edges[str(way)].sign == {"s": "stop", "m": "give_way"}[state]
        for row in signs:
            named = re.search(rf"signs .*\b{numbers[f'{row}{index}']}\b", list_of)
            assert bool(named) is bool(listed), (signs, list_of)
            assert listed in list_of


CAMERA = {"highway": "speed_camera"}
BOTH_TAKEN, NOBODY, UNSAID = "both directions taken", "nobody drives", ""
CAMERAS: tuple[tuple[dict[str, str], dict[str, str], str, str], ...] = (
    ({}, {}, "+-", BOTH_TAKEN),
    ({"direction": "forward"}, {}, "+", UNSAID),
    ({"direction": "backward"}, {}, "-", UNSAID),
    ({"direction": "both"}, {}, "+-", UNSAID),
    ({"direction": "180"}, {}, "+", UNSAID),
    ({"direction": "0"}, {}, "-", UNSAID),
    ({"direction": "350°"}, {}, "-", UNSAID),
    ({"direction": "N"}, {}, "-", UNSAID),
    ({"direction": "SSE"}, {}, "+", UNSAID),
    ({"direction": "90"}, {}, "+-", BOTH_TAKEN),
    ({"direction": "W"}, {}, "+-", BOTH_TAKEN),
    ({"direction": "up"}, {}, "+-", BOTH_TAKEN),
    ({"direction": "0"}, ONE, "+", UNSAID),
    ({}, ONE, "+", UNSAID),
    ({"direction": "backward"}, ONE, "", NOBODY),
)
"""Tags of a camera and of its road, which leads north; the directions that it watches, and what is listed."""


def test_a_camera_watches_whom_the_map_says(build: Build) -> None:
    made = ladder([road for _, road, _, _ in CAMERAS], [CAMERA | tags for tags, _, _, _ in CAMERAS])
    watched = {1: ("s1", "n1", "+"), 2: ("n2", "s2", "-")}
    for index, (start, goal, _) in watched.items():
        made.nodes[f"cam{index}"] = (index * 150.0 + 6, 60.0)
        made.node_tags[f"cam{index}"] = {"man_made": "surveillance"}
        members = (("device", f"cam{index}"), ("from", start), ("to", goal))
        made.relations.append((members, {"type": "enforcement", "enforcement": "maxspeed"}))
    world = build(made)
    listed = told(world)
    assert world.built.cameras.count == sum(bool(ends) for _, _, ends, _ in CAMERAS) + sum(map(bool, watched))
    for index, (tags, road, ends, line) in enumerate(CAMERAS, start=1):
        way = FIRST + index - 1
        found = sorted(
            ("-" if edge.edge_id.startswith("-") else "+")
            for edge in world.built.edges
            if way_of(edge.edge_id) == way
            for _ in edge.cameras_m
        )
        assert found == sorted(ends + watched.get(index, ("", "", ""))[2]), (tags, road)
        node = list(made.nodes).index(f"m{index}") + 1
        lines = [text for text in listed.splitlines() if "camera" in text and re.search(rf"\b{node}\b", text)]
        assert len(lines) == bool(line), (tags, lines)
        assert all(line in text for text in lines)


ONE_SIDED: tuple[tuple[dict[str, str], str], ...] = (
    ({"barrier": "gate", "motor_vehicle:forward": "no"}, "-"),
    ({"barrier": "gate", "motor_vehicle:backward": "no"}, "+"),
    ({"barrier": "lift_gate", "access": "yes", "motorcar:backward": "private"}, "+"),
    ({"barrier": "bollard", "motor_vehicle:forward": "yes"}, "+"),
    ({"barrier": "entrance", "oneway": "yes"}, "+"),
    ({"barrier": "entrance", "oneway": "-1"}, "-"),
    ({"barrier": "entrance", "vehicle:forward": "no", "vehicle:backward": "no"}, ""),
    ({"barrier": "entrance", "oneway": "no"}, "+-"),
)
"""Barriers in the middle of a road, and the directions in which cars pass."""


def test_a_barrier_for_one_direction_closes_that_alone(build: Build) -> None:
    world = build(ladder([{} for _ in ONE_SIDED], [tags for tags, _ in ONE_SIDED]))
    for index, (tags, ends) in enumerate(ONE_SIDED):
        way = FIRST + index
        pieces = [edge.edge_id for edge in world.built.edges if way_of(edge.edge_id) == way]
        north = max((edge for edge in pieces if edge.startswith("-")), key=len)
        passed = "+" * world.reaches(str(way), 101) + "-" * world.reaches(north, 100)
        assert passed == ends, tags
    assert not list(differences(world.map, world.built, world.roads, world.country))


def test_what_sumo_does_not_have_is_listed_by_its_value(build: Build) -> None:
    calming = ("bump", "hump", "table", "cushion", "chicane", "choker", "island", "rumble_strip", "dip", "yes")
    middle = [{"traffic_calming": value} for value in calming]
    middle += [
        {"highway": "traffic_signals", "traffic_signals:direction": end} for end in ("forward", "both", "up")
    ]
    world = build(ladder([{} for _ in middle], middle))
    listed = told(world)
    assert all(f"traffic_calming={value}: node" in listed for value in calming)
    assert re.search("signals at no junction with signals, left out: nodes (\\d+, ){2}\\d+", listed)
    assert "signals with traffic_signals:direction=up, for every direction: node" in listed


LANE_LIMITS: tuple[tuple[dict[str, str], tuple[int | str, ...]], ...] = (
    ({"lanes": "3", "maxspeed:lanes": "||70"}, ("-", "-", 70)),
    ({"lanes": "3", "maxspeed:lanes": "100|80|"}, (100, 80, "-")),
    ({"lanes": "3", "maxspeed": "90", "maxspeed:lanes": "||70"}, (90, 90, 70)),
    ({"lanes": "2", "maxspeed": "60", "maxspeed:lanes": "100|80"}, (100, 80)),
    ({"lanes": "2", "maxspeed:lanes:forward": "50|30"}, (50, 30)),
    ({"lanes": "2", "maxspeed:lanes": "50 mph|30 mph"}, (80, 48)),
    ({"lanes": "2", "maxspeed:lanes": "none|80", "highway": "trunk"}, ("none", 80)),
    ({"lanes": "2", "maxspeed:lanes": "walk|fast"}, (7, "-")),
    ({"lanes": "2", "maxspeed:lanes": "|"}, ("-", "-")),
    ({"lanes": "2", "maxspeed:lanes": "100|80|60"}, (100, 100)),
    ({"lanes": "2", "maxspeed": "50", "maxspeed:lanes": "||60"}, (60, 60)),
    ({"lanes": "2", "maxspeed:lanes": "||60"}, ("-", "-")),
)
"""Tags of a one-way road and the limit on the sign of each lane from the left; ``-`` without one."""


@pytest.mark.parametrize("country", ["DE", "GB"])
def test_each_lane_has_the_limit_of_its_own_sign(build: Build, tmp_path: Path, country: str) -> None:
    world = build(ladder([ONE | tags for tags, _ in LANE_LIMITS]), country)  # type: ignore[call-arg]
    net = ET.fromstring(gzip.decompress((tmp_path / "town.net.xml.gz").read_bytes()))
    lanes = {lane.get("id", ""): float(lane.get("speed", "")) for lane in net.iter("lane")}
    for index, (tags, signs) in enumerate(LANE_LIMITS):
        edge = world.built.network.edges[str(FIRST + index)]
        left_first = edge.lane_ids if country == "GB" else edge.lane_ids[::-1]
        whole = edge.limit_source is LimitSource.POSTED
        for lane, sign in zip(left_first, signs, strict=True):
            assert (whole or lane in edge.signed_lanes) is (sign != "-"), tags
            if sign != "-":
                assert round(lanes[lane] * 3.6) == (142 if sign == "none" else sign), tags
        assert edge.speed_mps == max(lanes[lane] for lane in left_first)
    assert not list(differences(world.map, world.built, world.roads, world.country))
    listed = set(re.findall(r"(?<=: )maxspeed:lanes=[^:,]*|^maxspeed:lanes=[^:,]*", told(world), re.MULTILINE))
    for tags, signs in LANE_LIMITS:
        parts = tags.get("maxspeed:lanes", "").split("|")
        odd = "fast" in parts or (len(parts) != len(signs) and "maxspeed:lanes" in tags)
        assert (f"maxspeed:lanes={tags.get('maxspeed:lanes')}" in listed) is odd, tags


def test_signs_at_what_netconvert_has_not_cost_no_map(build: Build, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(network, "patches", lambda *_: {"--edge-files": '<edges><edge id="99#0"/></edges>'})
    made, _ = row_of_crossings([{}], [{"s": {"highway": "stop"}}])
    assert "stop signs at junctions where netconvert gives right of way otherwise" in told(build(made))


LISTED = (
    *({f"{car}{key}": value} for car in ("access", "motor_vehicle") for key, value in (
        (":both_ways", "no"), (":lanes:conditional", "no @ (07:00-09:00)|"), (":motorcar", "no"),
        (":conditional", "no @ (sunset-sunrise)"), ("", "sometimes"), ("", "discouraged"),
    )),
    *({f"maxspeed{key}": value} for key, value in (
        (":variable", "yes"), (":wet", "80"), (":lanes:conditional", "30 @ (22:00-06:00)|"), (":both_ways", "40"),
        (":conditional", "30 @ (2026 May)"), ("", "signals"), ("", "national"), ("", "50|30"),
    )),
    *({f"turn{key}": value, "lanes": "3"} for key, value in (
        (":lanes:both_ways", "left"), (":lanes", "left|right"), (":lanes:forward", "slide_left|")
    )),
    *({f"lanes:{key}": value, "lanes": "3"} for key, value in (
        ("both_ways", "1"), ("reversible", "1"), ("bus:conditional", "1 @ (07:00-09:00)")
    )),
    *({"oneway" + key: value} for key, value in (
        ("", "reversible"), ("", "alternating"), ("", "recommended"), (":conditional", "yes @ (sunset-sunrise)"),
    )),
    *({key: "yes"} for key in (
        "toll", "ice_road", "4wd_only", "abandoned", "proposed", "seasonal", "stop", "give_way"
    )),
    {"oneway": "yes", "oneway:conditional": "no @ (22:00-06:00)", "access:conditional": "no @ (07:00-09:00)"},
    {"toll:lanes": "yes|no"}, {"hov": "lane"}, {"hov:lanes": "lane|"}, {"taxi:lanes": "|designated"},
    {"bus:lanes:conditional": "|designated @ (07:00-09:00)"}, {"priority": "forward"}, {"priority_road": "maybe"},
    {"maxwidth": "1.8"}, {"maxheight": "1.7 m"}, {"junction": "jughandle"}, {"dual_carriageway": "yes"},
)  # fmt: skip
UNLISTED = (
    *({f"maxspeed:{key}": "60"} for key in ("hgv", "bus", "trailer", "advisory", "hgv:forward")),
    {"maxspeed:reason": "noise"}, {"oneway:bicycle": "no"}, {"access:bicycle": "yes"}, {"toll:hgv": "yes"},
    {"toll:N3": "yes"}, {"bus": "yes"}, {"bus:conditional": "no @ (22:00-06:00)"}, {"hov": "yes"},
    {"priority_road": "designated"}, {"maxheight": "4"}, {"maxheight": "default"}, {"lanes": "2"}, {"toll": "no"},
    {"motor_vehicle:conditional": "no @ (weight>7.5)"}, {"maxspeed": "20 knots"}, {"source:maxspeed": "survey"},
)  # fmt: skip


def test_every_tag_about_cars_is_followed_or_listed(build: Build) -> None:
    rungs = [*LISTED, *UNLISTED]
    named = set(map(int, NUMBERS.findall(told(build(ladder(rungs))))))
    assert [tags for number, tags in enumerate(rungs) if (FIRST + number in named) is not (tags in LISTED)] == []


PRIORITY: tuple[tuple[dict[str, str], bool], ...] = (
    ({"priority_road": "designated"}, True),
    ({"priority_road": "yes_unposted"}, True),
    ({"priority_road:forward": "yes"}, True),
    ({"priority_road:backward": "yes"}, False),
    ({"priority_road": "end"}, False),
)


def test_who_joins_a_priority_road_yields(build: Build) -> None:
    made, ways = row_of_crossings([{"highway": "residential"} | tags for tags, _ in PRIORITY])
    world = build(made)
    for way, (tags, goes_first) in zip(ways, PRIORITY, strict=True):
        states = {link.state for link in world.built.links.of[str(way)] if link.direction != "t"}
        assert ("M" in states) is goes_first, tags


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in lost.SMALL else pytest.mark.proof) for name in lost.shown()]
)
def test_nothing_of_the_maps_of_others_is_lost(sumo: None, name: str) -> None:
    source = lost.extracts().get(name)
    if source is None:
        pytest.skip("AUTOMOTIVE_COSIM_TEST_DATA names no folder with this extract")
    found = lost.counts(source)
    assert {kind: each.lost for kind, each in found.items() if each.lost} == {}
    assert [str(found[kind]) for kind in lost.KINDS] == lost.shown()[name], (
        "python -m tests.osm.lost renews the table"
    )
