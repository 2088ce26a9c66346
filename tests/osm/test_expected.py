"""The two readings of the tags, which share no code, say the same about every road."""

import re
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.osm import access, barriers, expected, oneway, speed_limits, turns
from automotive_cosim.osm.access import CLOSED, KEYS, OPEN
from automotive_cosim.osm.agreement import MILES
from automotive_cosim.osm.barriers import GATES, PASSABLE, STOPPING
from automotive_cosim.osm.country import country_codes
from automotive_cosim.osm.expected import expect, expect_stop, expect_turn
from automotive_cosim.osm.oneway import KEYS as ONEWAY_KEYS
from automotive_cosim.osm.oneway import VALUES
from automotive_cosim.osm.speed_limits import CAR_KEYS, ZONE_KEYS, kmh_of, stated_limits
from automotive_cosim.osm.turns import CARS, KINDS, NO_BAN, value_for_cars

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
          "DE:zone30", "GB:20", "UK:nsl_dual", "XX:30", "de:rural", "20 knots")  # fmt: skip
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
    ([f"{key}{end}:conditional" for key in KEYS for end in ("", ":forward", ":backward")],
     ["no @ (Mo-Fr 07:00-09:00)", "yes @ (22:00-06:00)", "no @ (Mo[1,3])", "yes @ (week 40)",
      "no @ (weight>3.5)", "yes @ (sunset-sunrise)", "destination @ (Dec 24-26,Jan 1); no @ (snow)"]),
    (["hov:conditional"], ["designated @ (Mo-Fr 06:00-09:00)", "no @ (Sa,Su)"]),
    (["construction"], ["minor"]),
    (["junction"], ["roundabout", "circular", "yes"]),
    (["motorroad"], ["yes"]),
)  # fmt: skip


def test_they_share_no_code() -> None:
    text = Path(expected.__file__).read_text(encoding="utf-8")
    assert not re.search(r"^(from|import) automotive_cosim", text, re.MULTILINE)


def disagreements(samples: int) -> Iterator[object]:
    """Tags, of a seed, of which the two readings say something else: of ways, barriers and turns."""
    rng = np.random.default_rng(0)
    for _ in range(samples):
        tags = {"highway": str(rng.choice(CLASSES))}
        for keys, values in POOLS:
            for key in rng.choice(keys, rng.integers(0, min(3, len(keys)) + 1), replace=False):
                tags[str(key)] = str(rng.choice(values))
        country = str(rng.choice(["DE", "GB", "IM", "FR"]))
        other = expect(tags, country, miles=MILES, metric=country_codes())
        stated = stated_limits(tags, country)
        limits = [None if sign is None else kmh_of(sign) for sign in (stated.forward, stated.backward)]
        theirs = (other.limit_forward_kmh, other.limit_backward_kmh)
        same = all(
            (ours is None) is (kmh is None) and ours == (None if kmh is None else pytest.approx(kmh))
            for ours, kmh in zip(limits, theirs, strict=True)
        )
        if not same or (other.forward, other.backward) != oneway.directions(tags):
            yield tags
        simple = {key: tags[key] for key in list(tags)[:2]}  # most keys decide nothing where there are many
        other = expect(simple, country, miles=MILES, metric=country_codes())
        if (other.forward, other.backward) != oneway.directions(simple):
            yield simple
    yield from (tags for tags in GUARDED if expect_stop(tags) != (barriers.stops(tags) is not None))
    for tags in BANNED:
        value, turn = value_for_cars(tags), expect_turn(tags, (("w", 1, "from"), ("n", 2, "via"), ("w", 3, "to")))
        if (turn is not None) != (value in turns.KINDS) or (
            turn is not None and turn.is_only != turns._is_only(turns._kinds(value))
        ):
            yield tags


@pytest.mark.slow
def test_the_readings_agree_on_every_combination() -> None:
    assert not list(disagreements(4_000))


MISREADINGS: dict[str, tuple[object, str, object]] = {
    "a motorway_link implies a direction": (
        oneway, "IMPLIED", oneway.IMPLIED | {("highway", "motorway_link"): oneway.Implied(True, "")}),
    "circular implies none": (
        oneway, "IMPLIED", {key: row for key, row in oneway.IMPLIED.items() if key != ("junction", "circular")}),
    "-1 is with the nodes": (oneway, "VALUES", oneway.VALUES | {"-1": oneway.WITH}),
    "oneway of all before that of cars": (oneway, "KEYS", oneway.KEYS[::-1]),
    "private is open": (access, "OPEN", access.OPEN | {"private"}),
    "destination is closed": (access, "OPEN", access.OPEN - {"destination"}),
    "access before motorcar": (access, "KEYS", access.KEYS[::-1]),
    "a driver alone shares": (access, "HOV_ONLY", frozenset[str]()),
    "a bollard is passed": (barriers, "PASSABLE", barriers.PASSABLE | {"bollard"}),
    "a gate stops": (barriers, "GATES", frozenset[str]()),
    "a mile is a kilometre": (speed_limits, "KMH_PER_MPH", 1.0),
    "a knot is a kilometre": (speed_limits, "KMH_PER_KNOT", 1.0),
    "the limit of all before that of cars": (speed_limits, "CAR_KEYS", speed_limits.CAR_KEYS[::-1]),
    "every road can be without a limit": (speed_limits, "may_be_unlimited", lambda tags, country="": True),
    "a zone has no number": (speed_limits, "_ZONE_NUMBER", re.compile("x")),
    "no straight on is no ban": (turns, "KINDS", turns.KINDS - {"no_straight_on"}),
    "only is a ban": (turns, "_is_only", lambda kinds: False),
}  # fmt: skip
"""What the first reading could believe by mistake: a module, a name in it, and its value then."""


@pytest.mark.parametrize("belief", MISREADINGS)
def test_the_second_reading_notices_a_misreading(belief: str, monkeypatch: pytest.MonkeyPatch) -> None:
    module, name, value = MISREADINGS[belief]
    monkeypatch.setattr(module, name, value)
    assert next(disagreements(1_000), None) is not None


BARRIERS = sorted(PASSABLE | GATES | STOPPING | {"yes", "something"})
SAID = (
    ("motor_vehicle:forward", "no"),
    ("access:backward", "yes"),
    ("oneway", "-1"),
    ("name", "x"),
    ("access", "private"),
    ("access", "destination"),
    ("motor_vehicle", "yes"),
    ("bicycle", "yes"),
)


GUARDED = [{"barrier": kind, key: value} for kind, (key, value) in product(BARRIERS, SAID)]

TYPES = ("restriction", "restriction:motorcar", "restriction:hgv", "route")
RESTRICTION_KEYS = ("restriction", *(f"restriction:{kind}" for kind in (*CARS, "hgv")))
SPARED = ("", "motorcar", "bus;bicycle", "psv;vehicle")


BANNED = [
    {"type": kind, key: value, "except": spared}
    for kind, key, value, spared in product(TYPES, RESTRICTION_KEYS, sorted(KINDS | NO_BAN), SPARED)
]
