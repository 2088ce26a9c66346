"""Who may drive which way: every combination of tags that the OSM wiki documents (pages "Key:access", "Key:oneway",
"Conditional restrictions", "Key:barrier")."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.osm import access, barriers, oneway
from automotive_cosim.osm.access import CLOSED, KEYS, OPEN, lets_in
from automotive_cosim.osm.expected import expect
from automotive_cosim.osm.oneway import directions
from tests.laws import over

NO_DIRECTION = (
    *({"highway": f"{road}_link"} for road in ("motorway", "trunk", "primary", "secondary", "tertiary")),
    *({"junction": value} for value in ("jughandle", "filter", "intersection", "yes")),
    {"motorroad": "yes"},
    {"dual_carriageway": "yes"},
)
"""What the wiki does not let imply one direction."""

BOTH, WITH, AGAINST, NEITHER = (True, True), (True, False), (False, True), (False, False)


@over(sorted(OPEN | CLOSED))
def test_every_value_alone(value: str) -> None:
    """The wiki's list of values: an ordinary car is let in by some, kept out by all others."""
    closed = (
        "no private agricultural forestry military emergency psv bus taxi delivery official permit hgv residents"
    )
    assert lets_in(value) == (value in OPEN)
    assert not set(closed.split()) & OPEN
    assert {"yes", "permissive", "designated", "destination", "customers"} <= OPEN


@over([(left, right) for left, right in product(sorted(OPEN | CLOSED), repeat=2) if left < right])
def test_a_list_lets_in_whom_any_of_its_values_lets_in(left: str, right: str) -> None:
    for text in (f"{left};{right}", f"{right}; {left}", f"{left},{right}"):
        assert lets_in(text) == (lets_in(left) or lets_in(right))


@pytest.mark.parametrize(
    ("tags", "may"),
    [
        # nothing said
        ({}, BOTH),
        ({"access": "yes"}, BOTH),
        # the nearer key decides, whatever the farther ones say
        ({"access": "no"}, NEITHER),
        *(
            ({"access": "no", key: value}, BOTH)
            for key in KEYS[:3]
            for value in ("yes", "destination", "permissive")
        ),
        *(({"access": "yes", key: "no"}, NEITHER) for key in KEYS[:3]),
        ({"vehicle": "no", "motor_vehicle": "yes"}, BOTH),
        ({"vehicle": "yes", "motor_vehicle": "no"}, NEITHER),
        ({"motor_vehicle": "no", "motorcar": "yes"}, BOTH),
        ({"motor_vehicle": "yes", "motorcar": "no"}, NEITHER),
        ({"access": "private", "motor_vehicle": "designated"}, BOTH),
        # keys about others say nothing about cars
        ({"hgv": "no", "bus": "designated", "bicycle": "no", "foot": "no", "motorcycle": "no"}, BOTH),
        # roads for cars with passengers
        *(({"hov": value}, NEITHER) for value in access.HOV_ONLY),
        *(({"hov": value}, BOTH) for value in ("yes", "no", "lane")),
        ({"hov": "designated", "motor_vehicle": "yes"}, BOTH),
        ({"hov:forward": "designated"}, AGAINST),
        ({"hov:lanes": "designated|designated"}, NEITHER),
        ({"hov:lanes": "designated|no|no"}, BOTH),
        ({"hov": "designated", "hov:conditional": "no @ (Sa,Su)"}, BOTH),
        ({"hov:conditional": "designated @ (Mo-Fr 06:00-09:00)"}, BOTH),
        ({"highway": "construction", "construction": "primary"}, NEITHER),
        ({"access": "no", "bus": "yes", "bicycle": "yes", "foot": "yes", "emergency": "yes"}, NEITHER),
        # lists
        ({"motor_vehicle": "agricultural;forestry"}, NEITHER),
        ({"vehicle": "psv;delivery"}, NEITHER),
        ({"motor_vehicle": "no;destination"}, BOTH),
        # one direction
        *(({f"{key}:backward": "no"}, WITH) for key in KEYS),
        *(({f"{key}:forward": "no"}, AGAINST) for key in KEYS),
        ({"motor_vehicle:forward": "no", "motor_vehicle:backward": "private"}, NEITHER),
        ({"motor_vehicle": "no", "motor_vehicle:forward": "yes"}, WITH),
        ({"vehicle:backward": "no", "motor_vehicle": "yes"}, BOTH),
        ({"motor_vehicle:backward": "no", "vehicle": "yes"}, WITH),
        ({"motor_vehicle:backward": "destination"}, BOTH),
        # lanes
        ({"motor_vehicle:lanes": "yes|no"}, BOTH),
        ({"vehicle:lanes:backward": "no|no"}, WITH),
        ({"access:lanes": "no|no", "motor_vehicle": "yes"}, BOTH),
        ({"psv:lanes:backward": "designated"}, WITH),
        ({"bus:lanes:forward": "designated|designated"}, AGAINST),
        ({"bus:lanes:backward": "yes|designated"}, BOTH),
        ({"bus:lanes:backward": "designated", "motor_vehicle": "yes"}, BOTH),
        # oneway in all its spellings
        *(({"oneway": value}, WITH) for value in ("yes", "true", "1")),
        *(({"oneway": value}, AGAINST) for value in ("-1", "reverse")),
        *(({"oneway": value}, BOTH) for value in ("no", "false", "0", "alternating", "perhaps", "")),
        ({"oneway": "reversible"}, WITH),
        *(({f"oneway:{kind}": "yes"}, WITH) for kind in ("vehicle", "motor_vehicle", "motorcar")),
        ({"oneway:motor_vehicle": "-1"}, AGAINST),
        ({"oneway": "yes", "oneway:motor_vehicle": "no"}, BOTH),
        ({"oneway": "no", "oneway:motorcar": "yes"}, WITH),
        ({"oneway:motor_vehicle": "yes", "oneway:motorcar": "no"}, BOTH),
        ({"oneway:bicycle": "yes"}, BOTH),
        ({"oneway": "yes", "oneway:bicycle": "no", "oneway:bus": "no", "oneway:psv": "no"}, WITH),
        ({"oneway": "yes", "motor_vehicle:forward": "no"}, NEITHER),
        # implied
        ({"junction": "roundabout"}, WITH),
        ({"junction": "circular"}, WITH),
        ({"junction": "roundabout", "oneway": "-1"}, AGAINST),
        ({"highway": "motorway"}, WITH),
        *((tags, BOTH) for tags in NO_DIRECTION),
        ({"highway": "motorway_link", "oneway": "no"}, BOTH),
        ({"highway": "trunk"}, BOTH),
    ],
)
def test_which_way_cars_may_drive(tags: dict[str, str], may: tuple[bool, bool]) -> None:
    assert directions({"highway": "tertiary"} | tags) == may


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        ({"access": "No"}, ["access=No"]),
        ({"motor_vehicle": "hov"}, ["motor_vehicle=hov"]),
        ({"motor_vehicle": "restricted"}, ["motor_vehicle=restricted"]),
        ({"motor_vehicle": "use_sidepath"}, ["motor_vehicle=use_sidepath"]),
        ({"motor_vehicle": "yes;no"}, ["motor_vehicle=yes;no"]),
        ({"access": "unknown"}, ["access=unknown"]),
        ({"access": "tourists", "motor_vehicle": "yes"}, []),
        ({"access": "private"}, []),
        ({"motor_vehicle": "no;destination"}, []),
        (
            {"motor_vehicle:conditional": "no @ (sunset-sunrise)"},
            ["motor_vehicle:conditional=no @ (sunset-sunrise)"],
        ),
        (
            {"motor_vehicle": "no", "motor_vehicle:conditional": "yes @ low_traffic"},
            ["motor_vehicle:conditional=yes @ low_traffic"],
        ),
        ({"motor_vehicle:conditional": "no @ (Mo-Fr 07:00-09:00)"}, []),
        ({"motor_vehicle": "no", "motor_vehicle:conditional": "yes @ (18:00-06:00)"}, []),
        ({"access:conditional": "destination @ (18:00-06:00)"}, []),
        ({"access:conditional": "no @ (weight>3.5)"}, []),
        ({"access:conditional": "no @ (20:00-06:00)", "motor_vehicle": "yes"}, []),
        ({"motor_vehicle": "private", "access:conditional": "yes @ (20:00-06:00)"}, []),
        ({"oneway": "reversible"}, ["oneway=reversible"]),
        ({"oneway": "alternating"}, ["oneway=alternating"]),
        ({"junction": "roundabout", "oneway": "no"}, ["junction=roundabout with oneway=no, both directions"]),
        ({"highway": "trunk_link", "oneway": "no"}, []),
        ({"oneway": "perhaps"}, ["oneway=perhaps"]),
        ({"oneway": "yes", "oneway:conditional": "no @ (22:00-06:00)"}, []),
        ({"oneway": "yes", "oneway:conditional": "no @ destination"}, ["oneway:conditional=no @ destination"]),
        ({"oneway": "yes"}, []),
    ],
)
def test_doubtful_access_and_directions_are_told(tags: dict[str, str], told: list[str]) -> None:
    assert list(dict.fromkeys([*access.doubts(tags), *oneway.doubts(tags)])) == told


@pytest.mark.parametrize(
    ("tags", "hours", "may"),
    [
        ({"access:conditional": "no @ (Mo-Fr 07:30-08:30)"}, "no @ (Mo-Fr 07:30-08:30)", BOTH),
        ({"motor_vehicle:conditional": "delivery @ (06:00-11:00)"}, "no @ (06:00-11:00)", BOTH),
        ({"access": "no", "access:conditional": "yes @ (18:00-06:00)"}, "no @ (24/7); yes @ (18:00-06:00)", BOTH),
        ({"vehicle:conditional": "no @ (Sa 10:00-18:00); no @ snow"}, "no @ (Sa 10:00-18:00); no @ (snow)", BOTH),
        (
            {"access:conditional": "no @ (07:00-19:00)", "motorcar:conditional": "destination @ (10:00-12:00)"},
            "no @ (07:00-19:00); yes @ (10:00-12:00)",
            BOTH,
        ),
        ({"motor_vehicle:backward:conditional": "no @ (Mo-Fr 07:00-09:00)"}, "", BOTH),
        ({"access": "no", "access:forward:conditional": "yes @ 24/7"}, "no @ (24/7); yes @ (24/7)", WITH),
        ({"access:conditional": "no @ (20:00-06:00)", "motor_vehicle": "yes"}, "", BOTH),
        ({"access": "no", "access:conditional": "yes @ (weight<3.5)"}, "", NEITHER),
        ({"oneway:conditional": "-1 @ (Mo-Fr 07:00-09:00)"}, "no @ (Mo-Fr 07:00-09:00)", BOTH),
        ({"oneway:conditional": "yes @ (Mo-Fr 07:00-09:00)"}, "", BOTH),
        ({"oneway": "-1", "oneway:conditional": "no @ (22:00-06:00)"}, "no @ (24/7); yes @ (22:00-06:00)", BOTH),
        ({"oneway": "yes", "oneway:conditional": "no @ destination"}, "", WITH),
        ({"oneway": "yes", "lanes": "3", "oneway:conditional": "-1 @ (07:00-09:00)"}, "no @ (07:00-09:00)", WITH),
        ({"oneway": "yes", "oneway:motorcar": "no", "oneway:conditional": "-1 @ (07:00-09:00)"}, "", BOTH),
        ({"access": "no", "access:conditional": "yes @ (sunrise-sunset)"}, "", NEITHER),
    ],
)
def test_access_at_certain_hours(tags: dict[str, str], hours: str, may: tuple[bool, bool]) -> None:
    """With the nodes of the way; a road that is ever open is in the network."""
    assert oneway.at_hours(tags, "forward") == hours
    assert directions({"highway": "tertiary"} | tags) == may
    expected = expect({"highway": "tertiary"} | tags, "DE", miles=(), metric=("DE",))
    assert (expected.forward, expected.backward) == may, "the second reading says the same"


@given(st.dictionaries(st.sampled_from(KEYS), st.text(max_size=8), max_size=4))
def test_what_is_not_known_keeps_cars_out_and_is_told(tags: dict[str, str]) -> None:
    found = access.access(tags)
    words = {part.strip().lower() for part in found.tag.partition("=")[2].replace(",", ";").split(";")}
    if found.tag:
        assert found.is_open == bool(words & OPEN)
        assert found.is_doubtful or words <= OPEN | CLOSED


@pytest.mark.parametrize(
    ("tags", "stops"),
    [
        *(
            ({"barrier": kind}, True)
            for kind in ("bollard", "block", "jersey_barrier", "chain", "log", "cycle_barrier")
        ),
        *(
            ({"barrier": kind}, True)
            for kind in ("bus_trap", "sump_buster", "kissing_gate", "stile", "debris", "yes")
        ),
        *(({"barrier": kind}, False) for kind in ("toll_booth", "cattle_grid", "border_control", "entrance", "no")),
        *(({"barrier": kind}, False) for kind in ("gate", "lift_gate", "swing_gate", "height_restrictor", "kerb")),
        *(({"barrier": "gate", "access": value}, True) for value in ("private", "no", "permit", "agricultural")),
        *(({"barrier": "lift_gate", "access": value}, False) for value in ("yes", "destination", "customers")),
        ({"barrier": "gate", "motor_vehicle": "no", "access": "yes"}, True),
        ({"barrier": "gate", "access": "no", "motor_vehicle": "yes"}, False),
        ({"barrier": "bollard", "motor_vehicle": "yes"}, False),
        ({"barrier": "bollard", "bicycle": "yes", "foot": "yes"}, True),
        ({"barrier": "toll_booth", "access": "private"}, True),
        ({"access": "private"}, False),
        ({"highway": "crossing"}, False),
    ],
)
def test_which_barriers_stop_cars(tags: dict[str, str], stops: bool) -> None:
    assert (barriers.stops(tags) is not None) == stops


@over([(kind, {"barrier": kind}) for kind in sorted(barriers.GATES)])
def test_a_gate_without_a_word_is_passed_and_told(kind: str, tags: dict[str, str]) -> None:
    assert barriers.stops(tags) is None
    assert barriers.is_unclear_gate(tags)
    assert not barriers.is_unclear_gate(tags | {"access": "yes"})
    assert kind not in barriers.STOPPING | barriers.PASSABLE


@over([
    *((dict([tag.split("=")]), "") for tag in sorted(access.TOLD)),
    *(({"hov": value}, "") for value in sorted(access.HOV_ONLY)),
    ({"hov:conditional": "designated @ (Mo-Fr 06:00-09:00)"}, "no @ (Mo-Fr 06:00-09:00)"),
    ({"hov": "designated", "hov:conditional": "no @ (Sa,Su)"}, "no @ (24/7); yes @ (Sa,Su)"),
    ({"hov:conditional": "designated @ sunset-sunrise"}, ""),
    ({"hov:lanes:conditional": "designated|| @ (Mo-Fr 06:00-09:00)"}, ""),
    ({"highway": "construction", "construction": "primary", "opening_date": "2020-01-01"}, ""),
])  # fmt: skip
def test_what_is_not_for_every_car_is_told_or_closed_at_its_hours(tags: dict[str, str], hours: str) -> None:
    assert access.at_hours(tags, "forward") == hours
    listed = list(access.doubts(tags))
    assert bool(listed) or hours
    assert not listed or any("=" in tag for tag in listed)
