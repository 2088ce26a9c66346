"""The limit of every combination of tags that the OSM wiki documents (pages "Key:maxspeed", "Key:maxspeed:type",
"Key:source:maxspeed", "Key:zone:maxspeed", "Key:zone:traffic", "Lanes", "Conditional restrictions")."""

import re
import string
from dataclasses import replace
from itertools import product

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from automotive_cosim.geo.place import Atlas, Place, shipped
from automotive_cosim.osm.assumed import assumed_sign
from automotive_cosim.osm.country import LEFT_HAND, LIMITS, WORLD, assumed_limit_kmh
from automotive_cosim.osm.extract import ROAD_CLASSES, Extract, Node, OsmWay, Position
from automotive_cosim.osm.roads import MappedRoad, describe, on_one_side
from automotive_cosim.osm.speed_limits import (
    CAR_KEYS,
    NO_UNIT,
    ZONE_KEYS,
    built_up_of,
    doubts,
    kmh_of,
    stated_limits,
)
from tests.laws import over

NETCONVERT_READS = re.compile(r"none|\d+(\.\d+)?( mph)?")

ZONES = (
    "FR:urban",
    "DE:zone:30",
    "GB:zone20",
    "GB:nsl_dual",
    "US-CA:urban",
    "DE:motorway",
    "sign",
    "RU:rural",
    "zone",
)
VALUES = st.one_of(
    st.text(string.printable, max_size=12),
    st.sampled_from(["50", "30 mph", "30mph", "none", "walk", "signals", "70;90", "0", "7.5", "100|80", *ZONES]),
)
DIRECTED = [f"{key}{ending}" for key in CAR_KEYS for ending in ("", ":forward", ":backward", ":lanes")]
TAGS = st.dictionaries(
    st.sampled_from([*DIRECTED, *ZONE_KEYS, "zone:traffic", "oneway", "motorroad", "lanes", "lanes:forward"]),
    VALUES,
)


def read(tags: dict[str, str], country: str = "FR", road_class: str = "tertiary") -> MappedRoad:
    """A road outside towns."""
    tags = {"highway": road_class} | tags
    place = Place(country=country, layers=tuple(e for e in shipped().country(country) if e.kind == "country"))
    built_up = built_up_of(tags)
    assumed = assumed_sign(tags, shipped(), place, built_up=bool(built_up))
    return MappedRoad(tags, country, stated_limits(tags), assumed, built_up, is_dense=False)


@given(TAGS, st.sampled_from(sorted(ROAD_CLASSES)), st.sampled_from([*LIMITS, "", "XX"]))
def test_every_road_gets_one_limit_for_each_direction(tags: dict[str, str], road_class: str, country: str) -> None:
    road = read(tags, country, road_class)
    told = road.for_netconvert()
    limits = {key: value for key, value in told.items() if re.match("maxspeed|zone|source:maxspeed", key)}
    assert limits.keys() == ({"maxspeed", "maxspeed:backward"} if road.is_two_way else {"maxspeed"})
    assert all(NETCONVERT_READS.fullmatch(value) for value in limits.values())
    for edge in ("1", "-1#0"):
        assert ("maxspeed" in road.parameters(edge)) == (road.stated.of(edge) is not None)
        assert ("zone:traffic:assumed" in road.parameters(edge)) == (road.built_up is None)


@given(TAGS, st.sampled_from(ZONES), st.sampled_from([*ZONE_KEYS, "zone:traffic"]))
def test_no_zone_overrides_a_sign(tags: dict[str, str], zone: str, key: str) -> None:
    """Whatever else is said: adding or changing a zone leaves the limit of a road with a number as it is. It is not
    so without a limit: a motorway can have none, a street in a zone cannot."""
    assume(not {"none", "unlimited"} & set("|".join(tags.values()).split("|")))
    signed = tags | {"maxspeed": "30"}
    assert stated_limits(signed | {key: zone}) == stated_limits(signed)


ZONE_NAMES = ("FR:urban", "DE:motorway", "GB:zone20", "GB:nsl_single", "FR:zone50", "IT:urban", "sign")


@over(product(ZONE_NAMES, [*ZONE_KEYS, "zone:traffic"], ["30", "30 mph", "walk"]))
def test_value_unit_and_zone(zone: str, key: str, value: str) -> None:
    limit = "7" if value == "walk" else value
    assert stated_limits({key: zone, "maxspeed": value}).forward == limit
    assert read({key: zone, "maxspeed": value}).for_netconvert()["maxspeed"] == limit


@pytest.mark.parametrize(
    ("tags", "forward", "backward"),
    [
        # a number and its unit
        ({"maxspeed": "50"}, "50", "50"),
        ({"maxspeed": "50 km/h"}, "50", "50"),
        ({"maxspeed": "50kph"}, "50", "50"),
        ({"maxspeed": "7.5"}, "7.5", "7.5"),
        ({"maxspeed": "20 mph"}, "20 mph", "20 mph"),
        ({"maxspeed": "20mph"}, "20 mph", "20 mph"),
        # words
        ({"maxspeed": "none"}, "none", "none"),
        ({"maxspeed": "unlimited"}, "none", "none"),
        ({"maxspeed": "walk"}, "7", "7"),
        ({"maxspeed": "signals"}, None, None),
        ({"maxspeed": "variable"}, None, None),
        ({"maxspeed": "fast"}, None, None),
        ({"maxspeed": "0"}, None, None),
        # several values: the lowest, in whatever unit
        ({"maxspeed": "70;90"}, "70", "70"),
        ({"maxspeed": "50;20 mph"}, "20 mph", "20 mph"),
        # directions
        ({"maxspeed:forward": "70"}, "70", None),
        ({"maxspeed:backward": "70"}, None, "70"),
        ({"maxspeed": "50", "maxspeed:forward": "70"}, "70", "50"),
        ({"maxspeed": "50", "maxspeed:backward": "30 mph"}, "50", "30 mph"),
        ({"maxspeed:forward": "70", "source:maxspeed": "DE:zone:30"}, "70", "30"),
        # who is bound
        ({"maxspeed": "90", "maxspeed:motorcar": "70"}, "70", "70"),
        ({"maxspeed": "90", "maxspeed:motor_vehicle": "80"}, "80", "80"),
        ({"maxspeed": "90", "maxspeed:motorcar:backward": "70"}, "90", "70"),
        ({"maxspeed": "90", "maxspeed:hgv": "60"}, "90", "90"),
        ({"maxspeed:hgv": "60"}, None, None),
        ({"maxspeed:bus": "60"}, None, None),
        # what is no limit
        ({"maxspeed:advisory": "40"}, None, None),
        ({"maxspeed:practical": "40"}, None, None),
        ({"minspeed": "60"}, None, None),
        # lanes: the highest, if each has a sign; an empty part has that of the road
        ({"maxspeed:lanes": "100|80|60"}, "100", "100"),
        ({"maxspeed:lanes": "100|none"}, "none", "none"),
        ({"maxspeed:lanes": "100||60"}, None, None),
        ({"maxspeed": "80", "maxspeed:lanes": "100||60"}, "100", "100"),
        ({"maxspeed": "100", "maxspeed:lanes": "||70"}, "100", "100"),
        ({"maxspeed:lanes": "||"}, None, None),
        ({"maxspeed": "80", "maxspeed:lanes": "|"}, "80", "80"),
        ({"maxspeed": "DE:zone30", "maxspeed:lanes": "20|"}, "30", "30"),
        ({"maxspeed:lanes:forward": "80|60"}, "80", None),
        ({"maxspeed": "90", "maxspeed:lanes": "100|80"}, "100", "100"),
        # conditions: a limit of their own, at their hours
        ({"maxspeed": "50", "maxspeed:conditional": "30 @ (Mo-Fr 07:00-17:00)"}, "50", "50"),
        ({"maxspeed:conditional": "30 @ wet"}, None, None),
        # zones with a number
        ({"maxspeed": "DE:zone:30"}, "30", "30"),
        ({"zone:maxspeed": "FR:30"}, "30", "30"),
        ({"zone:maxspeed": "DE:zone30"}, "30", "30"),
        ({"zone:maxspeed": "30"}, "30", "30"),
        ({"zone:maxspeed": "20 mph"}, "20 mph", "20 mph"),
        ({"source:maxspeed": "DE:zone:30"}, "30", "30"),
        ({"source:maxspeed": "BE:zone30"}, "30", "30"),
        ({"maxspeed:type": "GB:zone20"}, "20 mph", "20 mph"),
        ({"maxspeed:type": "GB:20"}, "20 mph", "20 mph"),
        ({"maxspeed:type": "US-NY:zone25"}, "25 mph", "25 mph"),
        # zones without one
        ({"maxspeed": "FR:urban"}, None, None),
        ({"maxspeed": "DE:motorway"}, None, None),
        ({"source:maxspeed": "FR:rural"}, None, None),
        ({"maxspeed:type": "GB:nsl_single"}, None, None),
        ({"zone:traffic": "FR:urban"}, None, None),
        ({"zone:traffic": "DE:30"}, None, None),
        ({"source:maxspeed": "DE:living_street"}, None, None),
        # how it is known
        ({"source:maxspeed": "sign"}, None, None),
        ({"maxspeed:type": "sign", "maxspeed": "50"}, "50", "50"),
        ({"source:maxspeed": "markings", "maxspeed": "30 mph"}, "30 mph", "30 mph"),
        ({}, None, None),
    ],
)
def test_what_mappers_write(tags: dict[str, str], forward: str | None, backward: str | None) -> None:
    assert stated_limits(tags) == stated_limits(tags | {"zone:traffic": "FR:rural"})
    assert (stated_limits(tags).forward, stated_limits(tags).backward) == (forward, backward)


@pytest.mark.parametrize(
    ("country", "tags", "sign"),
    [
        ("FR", {"maxspeed": "FR:urban"}, "50"),
        ("FR", {"source:maxspeed": "FR:rural"}, "80"),
        ("FR", {"zone:traffic": "FR:motorway"}, "130"),
        ("DE", {"maxspeed": "DE:rural"}, "100"),
        ("DE", {"source:maxspeed": "DE:urban"}, "50"),
        ("DE", {"source:maxspeed": "DE:motorway"}, "none"),
        ("GB", {"maxspeed:type": "GB:nsl_single"}, "60 mph"),
        ("GB", {"maxspeed:type": "GB:nsl_dual"}, "70 mph"),
        ("GB", {"maxspeed:type": "GB:motorway"}, "70 mph"),
        ("GB", {"maxspeed:type": "GB:nsl_restricted"}, "30 mph"),
        ("GB", {"maxspeed:type": "GB-WLS:nsl_restricted"}, "20 mph"),
        ("US", {"maxspeed": "US-CA:urban"}, "25 mph"),
        ("US", {"maxspeed": "US-FL:urban"}, "30 mph"),
        ("FR", {"maxspeed": "DE:rural"}, "100"),
        ("US", {"maxspeed": "US-GA:urban"}, "30 mph"),
        ("US", {"maxspeed": "US-NC:urban"}, "35 mph"),
        ("US", {"maxspeed": "US-AZ:rural"}, "65 mph"),
        ("DE", {"bicycle_road": "yes", "source:maxspeed": "DE:urban"}, "30"),
        ("GB", {"maxspeed:type": "UK:nsl_single"}, "60 mph"),
        ("GB", {"source:maxspeed": "UK:nsl_dual"}, "70 mph"),
        ("GB", {"maxspeed": "UK:motorway"}, "70 mph"),
        ("GB", {"maxspeed:type": "gb:nsl_single"}, "60 mph"),
        ("DE", {"source:maxspeed": "de:urban"}, "50"),
        ("DE", {"source:maxspeed": "DE:bicycle_road"}, "30"),
        ("DE", {"maxspeed": "DE:bicycle_zone"}, "30"),
        ("BE", {"source:maxspeed": "BE:cyclestreet"}, "30"),
        ("DE", {"maxspeed": "DE:walk"}, "7"),
        ("AT", {"source:maxspeed": "AT:pedestrian"}, "7"),
        ("CZ", {"zone:traffic": "CZ:pedestrian_zone"}, "20"),
        ("DE", {"source:maxspeed": "DE:living_street"}, "7"),
        ("BE", {"source:maxspeed": "BE-BRU:urban"}, "30"),
        ("BE", {"source:maxspeed": "BE-VLG:rural"}, "70"),
        ("BE", {"source:maxspeed": "BE-WAL:rural"}, "90"),
        ("GB", {"maxspeed": "1000"}, "60 mph"),
        ("BE", {"cyclestreet": "yes", "zone:traffic": "BE:urban"}, "30"),
        ("DE", {"bicycle_road": "no", "source:maxspeed": "DE:urban"}, "50"),
    ],
)
def test_the_law_of_a_zone_sets_the_limit_that_it_does_not_state(
    country: str, tags: dict[str, str], sign: str
) -> None:
    road = read(tags, country)
    assert road.for_netconvert()["maxspeed"] == sign
    assert "maxspeed" not in road.parameters("1"), "no sign with that number was mapped"


@pytest.mark.parametrize(
    ("tags", "built_up"),
    [
        ({"zone:traffic": "FR:urban"}, True),
        ({"source:maxspeed": "IT:urban", "maxspeed": "30"}, True),
        ({"maxspeed:type": "GB:nsl_restricted"}, True),
        ({"maxspeed": "DE:living_street"}, True),
        ({"zone:maxspeed": "US-CA:rural"}, False),
        ({"maxspeed:type": "GB:nsl_dual"}, False),
        ({"source:maxspeed": "DE:motorway"}, False),
        ({"zone:traffic": "DE:rural", "source:maxspeed": "DE:urban"}, False),
        ({"source:maxspeed": "DE:zone:30", "zone:traffic": "DE:urban"}, True),
        ({"source:maxspeed": "DE:zone:30"}, None),
        ({"source:maxspeed": "sign"}, None),
        ({"source:maxspeed": "de:urban"}, True),
        ({"source:maxspeed": "XX:urban"}, None),
        ({}, None),
    ],
)
def test_every_zone_says_whether_it_is_built_up(tags: dict[str, str], built_up: bool | None) -> None:
    assert built_up_of(tags) is built_up
    params = read(tags).parameters("1")
    if built_up is None:
        assert params["zone:traffic:assumed"] == "FR:rural"
    else:
        assert params["zone:traffic"].rpartition(":")[2] == ("urban" if built_up else "rural")


@pytest.mark.parametrize(
    ("country", "tags", "found"),
    [
        ("GB", {"maxspeed": "30"}, [NO_UNIT]),
        ("US", {"maxspeed:backward": "25"}, [NO_UNIT]),
        ("GB", {"maxspeed": "30 mph"}, []),
        ("GB", {"maxspeed": "48 km/h"}, []),
        ("GB", {"highway": "living_street", "maxspeed": "none"}, ["maxspeed=none"]),
        ("DE", {"highway": "residential", "maxspeed": "unlimited"}, ["maxspeed=unlimited"]),
        ("DE", {"highway": "tertiary", "maxspeed": "none"}, ["maxspeed=none"]),
        ("DE", {"highway": "trunk", "source:maxspeed": "DE:urban", "maxspeed": "none"}, ["maxspeed=none"]),
        ("DE", {"highway": "trunk", "maxspeed": "none"}, []),
        ("DE", {"highway": "primary", "motorroad": "yes", "maxspeed": "none"}, []),
        ("IM", {"highway": "tertiary", "maxspeed": "none"}, []),
        ("IM", {"highway": "residential", "maxspeed": "none"}, ["maxspeed=none"]),
        ("DE", {"maxspeed": "1000"}, ["maxspeed=1000"]),
        ("DE", {"maxspeed": "1"}, ["maxspeed=1"]),
        ("US", {"maxspeed": "100 mph"}, ["maxspeed=100 mph"]),
        ("US", {"maxspeed": "85 mph"}, []),
        ("FR", {"maxspeed:type": "XX:urban"}, ["maxspeed:type=XX:urban"]),
        ("FR", {"source:maxspeed": "EU:rural"}, ["source:maxspeed=EU:rural"]),
        ("FR", {"zone:traffic": "FR:moon"}, ["zone:traffic=FR:moon"]),
        ("GB", {"maxspeed:type": "UK:nsl_single"}, []),
        ("DE", {"maxspeed": "50", "source:maxspeed": "DE:zone30"}, ["maxspeed=50 in a zone of 30, the zone"]),
        ("DE", {"maxspeed": "30", "source:maxspeed": "DE:zone30"}, []),
        ("FR", {"maxspeed": "30"}, []),
        ("FR", {"maxspeed": "fast"}, ["maxspeed=fast"]),
        ("FR", {"maxspeed": "signals"}, ["maxspeed=signals"]),
        ("FR", {"maxspeed": "FR:urban"}, []),
        ("FR", {}, []),
    ],
)
def test_doubtful_limits_are_told(country: str, tags: dict[str, str], found: list[str]) -> None:
    assert list(doubts(tags, country)) == found


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        ({"oneway": "yes"}, "70"),
        ({"oneway": "-1"}, "30"),
        ({"junction": "roundabout"}, "70"),
        ({"highway": "motorway"}, "70"),
    ],
)
def test_a_road_of_one_direction_has_that_directions_limit(tags: dict[str, str], told: str) -> None:
    road = read(tags | {"maxspeed:forward": "70", "maxspeed:backward": "30"})
    assert road.for_netconvert()["maxspeed"] == told
    assert "maxspeed:backward" not in road.for_netconvert(), "netconvert would open it to both directions"


def test_hours_may_differ_by_direction() -> None:
    hours = {"maxspeed:conditional": "50 @ (06:00-22:00)", "maxspeed:backward:conditional": "30 @ (07:00-09:00)"}
    road = read({"maxspeed": "70"} | hours)
    assert road.parameters("1")["maxspeed:conditional"] == "50 @ (06:00-22:00)"
    assert road.parameters("-1")["maxspeed:conditional"] == "50 @ (06:00-22:00); 30 @ (07:00-09:00)"


@pytest.mark.parametrize(
    ("key", "forward", "backward"),
    [
        ("maxspeed:conditional", True, True),
        ("maxspeed:forward:conditional", True, False),
        ("maxspeed:motor_vehicle:conditional", True, True),
        ("maxspeed:motorcar:conditional", True, True),
        ("maxspeed:motorcar:backward:conditional", False, True),
        ("maxspeed:hgv:conditional", False, False),
        ("maxspeed:bus:conditional", False, False),
    ],
)
def test_a_conditional_limit_counts_if_it_is_about_cars(key: str, forward: bool, backward: bool) -> None:
    road = read({"maxspeed": "50", key: "30 @ (22:00-06:00)"})
    found = tuple("maxspeed:conditional" in road.parameters(edge) for edge in ("1", "-1"))
    assert found == (forward, backward)


def test_of_conditional_limits_the_one_for_cars_comes_last() -> None:
    tags = {"maxspeed:motorcar:conditional": "30 @ wet", "maxspeed:conditional": "40 @ wet"}
    assert read(tags).parameters("1")["maxspeed:conditional"] == "40 @ wet; 30 @ wet"


@pytest.mark.parametrize(
    ("tags", "forward"),
    [
        ({"highway": "motorway", "maxspeed": "none"}, "none"),
        ({"highway": "trunk_link", "maxspeed": "none"}, "none"),
        ({"highway": "primary", "motorroad": "yes", "maxspeed": "none"}, "none"),
        ({"highway": "tertiary", "maxspeed": "none"}, None),
        ({"highway": "residential", "maxspeed": "unlimited"}, None),
        ({"highway": "residential", "maxspeed": "none", "maxspeed:type": "GB:zone20"}, "20 mph"),
        ({"highway": "trunk", "maxspeed": "none", "source:maxspeed": "DE:urban"}, None),
        ({"highway": "tertiary", "maxspeed": "500"}, None),
        ({"highway": "tertiary", "maxspeed": "50;500"}, "50"),
        ({"highway": "tertiary", "maxspeed": "90 mph"}, None),
        ({"highway": "tertiary", "maxspeed": "30 MPH"}, "30 mph"),
        ({"highway": "tertiary", "maxspeed": "30 mph; GB:nsl_single"}, "30 mph"),
    ],
)
def test_what_nobody_could_have_signed_is_not_posted(tags: dict[str, str], forward: str | None) -> None:
    assert stated_limits(tags).forward == forward


@over([code for code in shipped().codes() if "-" in code and code.rpartition("-")[2].isupper()])
def test_a_region_named_exactly_gives_the_answer_of_its_own_ground(code: str) -> None:
    """And one without rules of its own that of the ground around the road."""
    country = code[:2]
    layers = {layer.code: layer for layer in shipped().country(country)}
    for zone in ("urban", "rural"):
        for road_class in ("residential", "secondary", "trunk"):
            place = Place(country=country, layers=(layers[code], layers[country]))
            tags = {"highway": road_class, "source:maxspeed": f"{country}:{zone}"}
            plain = assumed_sign(tags, shipped(), place, built_up=zone == "urban")
            for named in (f"{code}:{zone}", f"{country}-NOWHERE:{zone}"):
                exact = assumed_sign(tags | {"source:maxspeed": named}, shipped(), place, built_up=zone == "urban")
                assert exact == plain, named


def test_the_lane_of_both_directions_is_nobodys() -> None:
    assert read({"lanes": "3", "lanes:forward": "1", "lanes:backward": "1"}).for_netconvert()["lanes"] == "2"


@pytest.mark.parametrize("road_class", sorted(ROAD_CLASSES))
def test_an_unknown_place_gets_the_most_common_limits(road_class: str) -> None:
    sign = assumed_sign({"highway": road_class}, Atlas(), Place(), built_up=False)
    assert kmh_of(sign) == assumed_limit_kmh("", road_class, built_up=False, dual=False)


@over([*LIMITS, ""])
def test_limits_rise_from_the_street_to_the_motorway(country: str) -> None:
    limits = LIMITS.get(country, WORLD)
    rising = (limits.street, limits.town, limits.rural, limits.dual, limits.motorway)
    assert list(rising) == sorted(rising)
    in_town = assumed_limit_kmh(country, "secondary", built_up=True, dual=False)
    assert in_town <= assumed_limit_kmh(country, "secondary", built_up=False, dual=False)


def test_miles_are_whole() -> None:
    for country in ("GB", "US"):
        limits = LIMITS[country]
        for kmh in (limits.street, limits.town, limits.rural, limits.dual, limits.motorway):
            assert kmh / 1.609344 == pytest.approx(round(kmh / 1.609344), abs=0.01)


def test_countries_are_codes_and_differ_in_the_side() -> None:
    assert all(re.fullmatch("[A-Z]{2}", code) for code in LEFT_HAND | set(LIMITS))
    assert {"GB", "JP", "AU", "ZA", "IN"} <= LEFT_HAND
    assert not {"FR", "DE", "US", "CH", "SE"} & LEFT_HAND


LANDS = (
    ("CN", "HK", (114.06, 22.60), (114.17, 22.40)),
    ("MO", "CN", (113.55, 22.19), (113.50, 22.28)),
    ("LA", "TH", (102.62, 17.97), (102.75, 17.80)),
    ("US", "CA", (-83.06, 42.35), (-83.00, 42.28)),
    ("DE", "FR", (7.83, 48.57), (7.74, 48.58)),
    ("CH", "FR", (6.14, 46.20), (6.10, 46.26)),
    ("NL", "BE", (4.950, 51.445), (4.928, 51.4372)),
    ("BE", "NL", (4.928, 51.4372), (4.905, 51.445)),
    ("US", "MX", (-117.03, 32.56), (-117.03, 32.52)),
    ("GB", "IE", (-7.30, 55.00), (-7.35, 55.10)),
)
"""Two lands, and a place in each; Baarle is Belgian in the Netherlands."""


@over(LANDS)
def test_each_road_is_under_the_law_of_its_land(
    here: str, there: str, place: tuple[float, float], beyond: tuple[float, float]
) -> None:
    nodes = {
        number: Node(Position(lon + step / 1000, lat), {})
        for number, ((lon, lat), step) in enumerate(product((place, beyond), range(2)))
    }
    ways = tuple(OsmWay(way, {"highway": "primary"}, (2 * way, 2 * way + 1)) for way in range(2))
    extract = Extract(ways, nodes, ())
    roads = describe(extract, shipped(), here)
    assert [roads[way].country for way in range(2)] == [here, there]
    assert roads[1].assumed == describe(extract, shipped(), there)[1].assumed
    kept = on_one_side(extract, shipped(), here)
    same_side = (here in LEFT_HAND) is (there in LEFT_HAND)
    assert [way.way_id for way in kept.ways] == ([0, 1] if same_side else [0])
    assert kept.other_side == ({} if same_side else {there: (1,)})
    across = OsmWay(2, {"highway": "primary"}, (0, 1, 2, 3))
    assert on_one_side(replace(extract, ways=(across,)), shipped(), here).ways[0].nodes == (
        across.nodes if same_side else (0, 1)
    ), "cut where the side changes"
    assert {road.country for road in describe(extract, shipped(), "JP").values()} == {"JP"}, "not where it says"
