from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.osm.country import LEFT_HAND, LIMITS, WORLD, assumed_limit_kmh
from automotive_cosim.osm.extract import ROAD_CLASSES
from automotive_cosim.osm.limits import LIMIT_KEYS, ZONE_KEYS, complete, stated_limit

NETCONVERT_READS = re.compile(r"none|\d+(\.\d+)?( mph)?")

VALUES = st.one_of(
    st.text(max_size=12),
    st.sampled_from(
        ["50", "30 mph", "30mph", "none", "walk", "FR:urban", "DE:zone:30", "signals", "70;90", "RU:rural"]
    ),
)
TAGS = st.dictionaries(st.sampled_from([*LIMIT_KEYS, *ZONE_KEYS, "oneway", "motorroad"]), VALUES) | st.just(
    {"oneway": "yes", "maxspeed": "50", "maxspeed:backward": "30"}
)


@given(TAGS, st.sampled_from(sorted(ROAD_CLASSES)), st.sampled_from([*LIMITS, "", "XX"]), st.booleans())
def test_every_road_gets_a_limit_that_netconvert_reads(
    tags: dict[str, str], road_class: str, country: str, built_up: bool
) -> None:
    done = complete(tags | {"highway": road_class}, country, built_up=built_up)
    found = {key: value for key, value in done.items() if key in LIMIT_KEYS}
    assert found
    assert ("maxspeed" in found) == (stated_limit(tags) is not None)
    assert all(NETCONVERT_READS.fullmatch(value) for value in found.values())
    if tags.get("oneway") == "yes":
        assert "maxspeed:backward" not in found, "netconvert would open the road the other way"


@pytest.mark.parametrize(
    ("tags", "limit"),
    [
        ({"maxspeed": "50"}, "50"),
        ({"maxspeed": "50 km/h"}, "50"),
        ({"maxspeed": "20 mph"}, "20 mph"),
        ({"maxspeed": "20mph"}, "20 mph"),
        ({"maxspeed": "none"}, "none"),
        ({"maxspeed": "70;90"}, "70"),
        ({"maxspeed": "FR:urban"}, "50"),
        ({"maxspeed": "FR:rural"}, "80"),
        ({"maxspeed": "DE:rural"}, "100"),
        ({"zone:maxspeed": "FR:30"}, "30"),
        ({"source:maxspeed": "DE:zone:30"}, "30"),
        ({"source:maxspeed": "sign"}, None),
        ({"maxspeed:type": "GB:zone20"}, "20 mph"),
        ({"maxspeed:forward": "70"}, "70"),
        ({"maxspeed": "signals"}, None),
        ({"maxspeed": "fast"}, None),
        ({"zone:traffic": "FR:urban"}, None),
        ({}, None),
    ],
)
def test_what_mappers_write(tags: dict[str, str], limit: str | None) -> None:
    assert stated_limit(tags) == limit


@pytest.mark.parametrize("country", [*LIMITS, ""])
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
