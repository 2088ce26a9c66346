"""The two readings of the tags, which share no code, say the same about every road."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.osm import expected
from automotive_cosim.osm.access import CLOSED, KEYS, OPEN
from automotive_cosim.osm.agreement import MILES
from automotive_cosim.osm.barriers import GATES, PASSABLE, STOPPING, stops
from automotive_cosim.osm.country import country_codes
from automotive_cosim.osm.expected import expect, expect_stop, expect_turn
from automotive_cosim.osm.limits import CAR_KEYS, ZONE_KEYS, kmh_of, stated_limits
from automotive_cosim.osm.oneway import KEYS as ONEWAY_KEYS
from automotive_cosim.osm.oneway import VALUES, directions
from automotive_cosim.osm.turns import CARS, KINDS, NO_BAN, value_for_cars
from tests.laws import over

CLASSES = (
    "construction",
    "motorway",
    "motorway_link",
    "trunk",
    "primary",
    "tertiary",
    "residential",
    "living_street",
)
SPEEDS = ("50", "30 mph", "30mph", "30 MPH", "none", "walk", "70;90", "0", "7.5", "500", "1", "fast", "FR:urban",
          "DE:zone30", "GB:20", "UK:nsl_dual", "XX:30", "de:rural")  # fmt: skip
POOLS = (
    ([f"{key}{end}" for key in KEYS for end in ("", ":forward", ":backward")],
     [*sorted(OPEN | CLOSED), "No", "x", "no;destination", "psv;delivery", ""]),
    (ONEWAY_KEYS, [*VALUES, "perhaps", ""]),
    ([f"{key}{end}" for key in CAR_KEYS for end in ("", ":forward", ":backward")], SPEEDS),
    ([*ZONE_KEYS, "zone:traffic"], SPEEDS),
    (["maxspeed:lanes", "maxspeed:lanes:backward"], ["100|80", "none|50", "|30 mph"]),
    (["psv:lanes:backward", "vehicle:lanes", "motor_vehicle:lanes:forward"],
     ["designated", "no|no", "yes|no", "|psv"]),
    (["hov", "hov:forward", "hov:lanes", "hov:lanes:backward"],
     ["designated", "yes", "no", "2+", "3", "lane", "designated|no", "designated|designated"]),
    (["hov:conditional"], ["designated @ (Mo-Fr 06:00-09:00)", "no @ (Sa,Su)"]),
    (["construction"], ["minor"]),
    (["junction"], ["roundabout", "circular", "yes"]),
    (["motorroad"], ["yes"]),
)  # fmt: skip


def test_they_share_no_code() -> None:
    text = Path(expected.__file__).read_text(encoding="utf-8")
    assert not re.search(r"^(from|import) automotive_cosim", text, re.MULTILINE)


@pytest.mark.slow
def test_directions_and_limits_of_every_combination() -> None:
    rng = np.random.default_rng(0)
    for _ in range(4_000):
        tags = {"highway": str(rng.choice(CLASSES))}
        for keys, values in POOLS:
            for key in rng.choice(keys, rng.integers(0, min(3, len(keys)) + 1), replace=False):
                tags[str(key)] = str(rng.choice(values))
        country = str(rng.choice(["DE", "GB", "IM", "FR"]))
        other = expect(tags, country, miles=MILES, metric=country_codes())
        assert (other.forward, other.backward) == directions(tags), tags
        stated = stated_limits(tags, country)
        for sign, kmh in ((stated.forward, other.limit_forward_kmh), (stated.backward, other.limit_backward_kmh)):
            assert kmh == (None if sign is None else pytest.approx(kmh_of(sign))), tags


BARRIERS = sorted(PASSABLE | GATES | STOPPING | {"yes", "something"})
SAID = (
    ("name", "x"),
    ("access", "private"),
    ("access", "destination"),
    ("motor_vehicle", "yes"),
    ("bicycle", "yes"),
)


@over([{"barrier": kind, key: value} for kind, (key, value) in product(BARRIERS, SAID)])
def test_barriers(tags: dict[str, str]) -> None:
    assert expect_stop(tags) == (stops(tags) is not None)


TYPES = ("restriction", "restriction:motorcar", "restriction:hgv", "route")
RESTRICTION_KEYS = ("restriction", *(f"restriction:{kind}" for kind in (*CARS, "hgv")))
SPARED = ("", "motorcar", "bus;bicycle", "psv;vehicle")


@over([{"type": kind, key: value, "except": spared}
       for kind, key, value, spared in product(TYPES, RESTRICTION_KEYS, sorted(KINDS | NO_BAN), SPARED)
])  # fmt: skip
def test_turns(tags: dict[str, str]) -> None:
    value = value_for_cars(tags)
    turn = expect_turn(tags, (("w", 1, "from"), ("n", 2, "via"), ("w", 3, "to")))
    assert (turn is not None) == (value in KINDS)
    assert turn is None or turn.is_only == value.startswith("only_")
