"""The lanes that netconvert is told of (OSM wiki, "Key:lanes", "Lanes", "Key:busway")."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.osm.lanes import SHARED, doubts, for_netconvert, lanes_of
from automotive_cosim.osm.oneway import directions

ONE = {"oneway": "yes"}
TWO_WITH_BUS = ["yes|designated", "designated|yes"]


@pytest.mark.parametrize(
    ("tags", "forward", "backward"),
    [
        ({}, None, None),
        ({"lanes": "4"}, None, None),
        ({"lanes:forward": "2", "lanes:backward": "1"}, 2, 1),
        ({"lanes": "3", "lanes:forward": "2"}, 2, 1),
        ({"lanes": "3", "lanes:backward": "2"}, 1, 2),
        ({"lanes": "3", "lanes:forward": "1", "lanes:backward": "1", "lanes:both_ways": "1"}, 1, 1),
        ({"lanes": "5", "lanes:both_ways": "1"}, 2, 2),
        (ONE | {"lanes": "3"}, 3, None),
        ({"oneway": "-1", "lanes": "3"}, None, 3),
        # buses against a one-way street: their lane is none for cars
        (ONE | {"lanes": "2", "lanes:forward": "1", "lanes:backward": "1", "oneway:bus": "no"}, 1, None),
        (ONE | {"lanes": "2", "oneway:bus": "no"}, 1, None),
        (ONE | {"lanes": "3", "oneway:psv": "no", "lanes:psv:backward": "1"}, 2, None),
        (ONE | {"lanes": "3", "busway": "opposite_lane"}, 2, None),
        (ONE | {"lanes": "1", "oneway:bus": "no"}, 1, None),
        ({"lanes": "2", "motor_vehicle:backward": "no"}, 2, None),
        # what is no number of lanes
        (ONE | {"lanes": "0"}, None, None),
        (ONE | {"lanes": "99"}, None, None),
        (ONE | {"lanes": "1.5"}, None, None),
        (ONE | {"lanes": "many"}, None, None),
        (ONE | {"lanes": "2;3"}, 2, None),
        ({"lanes:forward": "-1", "lanes:backward": "2"}, None, 2),
    ],
)
def test_how_many(tags: dict[str, str], forward: int | None, backward: int | None) -> None:
    found = lanes_of(tags, directions(tags))
    assert (found.forward, found.backward) == (forward, backward)


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        (ONE | {"lanes": "3", "lanes:psv": "1"}, {"bus:lanes": "yes|yes|designated"}),
        (ONE | {"lanes": "2", "lanes:bus": "1"}, {"bus:lanes": "yes|designated"}),
        (ONE | {"lanes": "2", "busway:right": "lane"}, {"bus:lanes": "yes|designated"}),
        (ONE | {"lanes": "2", "busway": "lane"}, {"bus:lanes": "yes|designated"}),
        (ONE | {"lanes": "2", "bus:lanes": "designated|yes", "lanes:bus": "1"}, {"bus:lanes": "designated|yes"}),
        (ONE | {"lanes": "1", "lanes:bus": "1"}, {}),
        ({"lanes": "4", "lanes:forward": "2", "lanes:psv:forward": "1"}, {"bus:lanes:forward": "yes|designated"}),
        (
            {"lanes": "4", "busway:both": "lane"},
            {f"bus:lanes:{end}": "yes|designated" for end in ("forward", "backward")},
        ),
        (ONE | {"lanes": "2", "motor_vehicle:lanes": "no|yes"}, {"vehicle:lanes": "no|yes"}),
        (ONE | {"lanes": "3", "hov:lanes": "designated|no|no"}, {"vehicle:lanes": "no|yes|yes"}),
        (ONE | {"lanes": "2", "hov:lanes": "yes|no"}, {"vehicle:lanes": "yes|yes"}),
        (
            ONE | {"lanes": "3", "hov:lanes": "designated||", "vehicle:lanes": "yes|yes|no"},
            {"vehicle:lanes": "no|yes|no"},
        ),
        (ONE | {"lanes": "2", "access:lanes": "destination|psv"}, {"vehicle:lanes": "yes|no"}),
        (
            ONE | {"lanes": "2", "vehicle:lanes": "no|yes", "motorcar:lanes": "yes|yes"},
            {"vehicle:lanes": "yes|yes"},
        ),
    ],
)
def test_lanes_of_buses(tags: dict[str, str], told: dict[str, str]) -> None:
    found = for_netconvert(tags, directions(tags))
    assert {key: value for key, value in found.items() if ":lanes" in key} == told


def test_buses_keep_to_the_kerb_on_the_left_too() -> None:
    tags = ONE | {"lanes": "3", "lanes:psv": "1"}
    assert for_netconvert(tags, directions(tags), left_hand=True)["bus:lanes"] == "designated|yes|yes"


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        ({"lanes": "1"}, [SHARED]),
        (ONE | {"lanes": "1"}, []),
        ({"lanes": "0"}, ["lanes=0, left out"]),
        ({"lanes": "99"}, ["lanes=99, left out"]),
        ({"lanes:forward": "11"}, ["lanes:forward=11, left out"]),
        ({"lanes": "2;3"}, ["lanes=2;3, the lowest taken"]),
        ({"lanes": "4", "lanes:forward": "2"}, []),
        ({"lanes": "3", "lanes:forward": "2", "lanes:backward": "1"}, []),
        ({"lanes": "4", "lanes:forward": "2", "lanes:backward": "1"},
         ["lanes=4, lanes:forward=2, lanes:backward=1, which do not add up"]),
        ({"lanes": "2", "lanes:forward": "2"}, ["lanes=2, lanes:forward=2, which do not add up"]),
        (ONE | {"lanes": "2", "lanes:forward": "2"}, []),
        ({"oneway": "-1", "lanes": "2", "lanes:forward": "2"}, ["lanes=2, lanes:forward=2, which do not add up"]),
        ({"lanes": "2"}, []),
    ],
)  # fmt: skip
def test_impossible_lanes_are_told(tags: dict[str, str], told: list[str]) -> None:
    assert list(doubts(tags, directions(tags))) == told


@given(
    st.dictionaries(
        st.sampled_from(
            ["lanes", "lanes:forward", "lanes:backward", "lanes:psv", "lanes:bus:backward", "busway", "oneway"]
        ),
        st.sampled_from(["0", "1", "2", "3", "7", "99", "yes", "-1", "lane", "2;4", "", "x"]),
    )
)
def test_every_direction_keeps_a_lane_for_cars(tags: dict[str, str]) -> None:
    may = directions(tags)
    found = lanes_of(tags, may)
    for count, buses in ((found.forward, found.buses_forward), (found.backward, found.buses_backward)):
        assert count is None or count > buses >= 0
    told = for_netconvert(tags, may)
    assert all(value.isdecimal() and int(value) > 0 for key, value in told.items() if key.startswith("lanes"))
