"""A second reading of the tags, for cars only, that shares no code with the first.

The import decides by ``access``, ``oneway``, ``speed_limits``, ``barriers`` and ``turns``. This module reads the
same tags once more in another way: it takes each key apart, ranks what it is about, and lets the highest rank
decide. Where the two disagree about a road that was built, ``agreement`` tells; at least one of them is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping
from typing import NamedTuple

GROUPS = ("access", "vehicle", "motor_vehicle", "motorcar")
"""Who is meant, from everybody to cars."""

FOR_CARS = re.compile(r"yes|true|1|permissive|designated|destination|customers|public|unknown|discouraged|variable")

ONE_WAY = {"yes": 1, "true": 1, "1": 1, "reversible": 1, "-1": -1, "reverse": -1}
TWO_WAY = ("no", "false", "0", "alternating")

SPEED = re.compile(r"([0-9]+(?:\.[0-9]+)?) *(mph|MPH|knots|[kK][mM]?(?:/?[hH]|[pP][hH]))?")
MILE_KM = 1.609344

OPENING = ("gate", "lift_gate", "swing_gate", "sliding_gate", "sliding_beam", "hampshire_gate", "gates",
           "wire_gate", "tube_gate", "retractable", "door")  # fmt: skip
NO_HINDRANCE = ("no", "entrance", "border_control", "toll_booth", "checkpoint", "cattle_grid", "sally_port", "kerb",
                "coupure", "height_restrictor", "width_restrictor", "bump_gate", "rumble_strip", "arch",
                "traffic_island", "gate_removed")  # fmt: skip


class Expected(NamedTuple):
    """What the tags of a way say about cars, with its nodes and against them, at some hours at least."""

    forward: bool
    backward: bool
    limit_forward_kmh: float | None
    """The limit on a sign; infinite where a sign says that there is none, None without a sign."""
    limit_backward_kmh: float | None

    def open(self, edge_id: str) -> bool:
        """Whether cars may drive on an edge."""
        return self.backward if edge_id[:1] == "-" else self.forward

    def limit_kmh(self, edge_id: str) -> float | None:
        """The posted limit of an edge."""
        return self.limit_backward_kmh if edge_id[:1] == "-" else self.limit_forward_kmh


class ExpectedTurn(NamedTuple):
    """A turn restriction over a node, for cars."""

    from_ways: frozenset[int]
    via_node: int
    to_ways: frozenset[int]
    is_only: bool
    """Whether only these turns are allowed, not barred."""


def expect(tags: Mapping[str, str], country: str, *, miles: Container[str], metric: Container[str]) -> Expected:
    """Reads the tags of a way.

    Args:
        country: ISO 3166-1 code of the map.
        miles: the countries in whose zones a number is in miles per hour.
        metric: those where it is in kilometres per hour.
    """
    way = _one_way(tags)
    if way and tags.get("lanes", "1") == "1" and _turns_at_times(tags, way):
        way = 0
    forward, backward = (_admits(tags, side) or _at_times(tags, side) for side in ("forward", "backward"))
    limits = [_limit(tags, side, country, miles=miles, metric=metric) for side in ("forward", "backward")]
    return Expected(forward and way >= 0, backward and way <= 0, limits[0], limits[1])


def expect_stop(tags: Mapping[str, str]) -> bool:
    """Whether the tags of a node stop cars."""
    kind = tags.get("barrier", "no").lower()
    if kind == "no":
        return False
    passes = kind in OPENING + NO_HINDRANCE
    way = ONE_WAY.get(tags.get("oneway", ""), 0)
    for side, sign in (("forward", -1), ("backward", 1)):
        said = sorted(_ranked(tags, side, _ACCESS))
        if way != sign and (_for_cars(said[-1][1]) if said else passes):
            return False
    return True


def expect_turn(tags: Mapping[str, str], members: tuple[tuple[str, int, str], ...]) -> ExpectedTurn | None:
    """Reads a relation; None if it bars no turn of cars at all hours, or not over a single node."""
    kind = tags.get("type", "")
    if kind not in ("restriction", *(f"restriction:{group}" for group in GROUPS[1:])):
        return None
    spared = {word.strip() for word in tags.get("except", "").split(";")}
    at_times = any(key.startswith(("day_o", "hour_o")) or key.endswith(":conditional") for key in tags)
    if at_times or spared.intersection((*GROUPS[1:], "car")):
        return None
    said = [
        tags[key] for key in ("restriction", *(f"restriction:{group}" for group in GROUPS[1:])) if tags.get(key)
    ]
    words = [word.strip().lower() for word in said[-1].split(";")] if said else []
    bars = [word for word in words if word[:3] == "no_" and not word.endswith("_on_red")]
    only = [word for word in words if word[:5] == "only_"]
    vias = [(what, ref) for what, ref, role in members if role == "via"]
    if not (bars or only) or len(vias) != 1 or vias[0][0] != "n":
        return None
    ends = [frozenset(ref for what, ref, role in members if what == "w" and role == end) for end in ("from", "to")]
    return ExpectedTurn(ends[0], vias[0][1], ends[1], is_only=bool(only) and not bars)


def _ranked(tags: Mapping[str, str], side: str, about: re.Pattern[str]) -> Iterator[tuple[int, str]]:
    """The values of the keys of a kind that hold for one direction, each with its rank."""
    for key, value in tags.items():
        match = about.fullmatch(key)
        if match and value and match["side"] in (None, side):
            group = match["group"] or "access"
            yield 2 * GROUPS.index(group) + (match["side"] is not None), value


_ACCESS = re.compile(r"(?P<group>access|vehicle|motor_vehicle|motorcar)(?::(?P<side>forward|backward))?")
_ACCESS_OF_LANES = re.compile(
    r"(?P<group>access|vehicle|motor_vehicle|motorcar):lanes(?::(?P<side>forward|backward))?"
)
_MAXSPEED = re.compile(r"maxspeed(?::(?P<group>motor_vehicle|motorcar))?(?::(?P<side>forward|backward))?")


_FOR_TWO = re.compile(r"designated|only|[23]\+?")


def _admits(tags: Mapping[str, str], side: str) -> bool:
    """Whether a driver alone may drive there, at any hour."""
    if tags.get("highway") == "construction":
        return False
    whole = sorted(_ranked(tags, side, _ACCESS))
    if whole:
        return _for_cars(whole[-1][1])
    shared = [tags.get(key, "") for key in ("hov", f"hov:{side}", "hov:lanes", f"hov:lanes:{side}")]
    if any(text and all(_FOR_TWO.fullmatch(part.strip()) for part in text.split("|")) for text in shared):
        return False
    lanes = sorted(_ranked(tags, side, _ACCESS_OF_LANES))
    if lanes:
        return any(not lane.strip() or _for_cars(lane) for lane in lanes[-1][1].split("|"))
    of_buses = (tags.get(f"{kind}:lanes:{side}") for kind in ("bus", "psv"))
    return not any(words and not re.sub(r"designated|\|", "", words) for words in of_buses)


def _at_times(tags: Mapping[str, str], side: str) -> bool:
    """Whether cars are let in at hours, by a condition on the clock, the calendar or the weather."""
    by_rank: list[tuple[int, bool]] = []
    if tags.get("highway") == "construction":
        return False
    for key, value in tags.items():
        name = key.removesuffix(":conditional")
        if key != name and name in ("hov", f"hov:{side}"):
            found = [word for word, when in _CLAUSE.findall(value) if _CLOCK.fullmatch(when)]
            if any(word in ("yes", "no") for word in found):
                by_rank.append((9, True))
        match = _ACCESS.fullmatch(name)
        if match is None or not value or match["side"] not in (None, side):
            continue
        rank = 2 * GROUPS.index(match["group"]) + (match["side"] is not None)
        if not key.endswith(":conditional"):
            by_rank.append((rank, False))
        elif any(_for_cars(word) and _CLOCK.fullmatch(when) for word, when in _CLAUSE.findall(value)):
            by_rank.append((rank, True))
    return max(by_rank, default=(0, False))[1]


_CLAUSE = re.compile(r"(-?[\w][\w;,/]*?) *@ *(\([^()]*\)|[^;()]+)")
_CLOCK = re.compile(
    r"\(?(?:24/7|\d\d?:\d\d|(?:Mo|Tu|We|Th|Fr|Sa|Su)\[-?[1-5](?:,-?[1-5])*\]|/\d\d?|week \d\d?\b"
    r"|(?:Mo|Tu|We|Th|Fr|Sa|Su|PH|SH|off|week|wet|snow|AND)\b|\d\d?\b(?=[-/ ])|(?<=-)\d\d?\b(?!:)"
    r"|(?:Jan|Feb|Mar|Apr|May|Jun|Jul|Aug|Sep|Oct|Nov|Dec)\b(?: \d\d?\b)?|[-–,;: ])+\)?"
)


def _for_cars(value: str) -> bool:
    words = [word.strip().lower() for word in value.replace(",", ";").split(";")]
    return any(FOR_CARS.fullmatch(word) for word in words)


def _one_way(tags: Mapping[str, str]) -> int:
    """1 with the nodes, -1 against them, 0 both."""
    found = 0
    if tags.get("junction") in ("roundabout", "circular") or tags.get("highway") == "motorway":
        found = 1
    for key in ("oneway", *(f"oneway:{group}" for group in GROUPS[1:])):
        word = tags.get(key, "").strip().lower()
        if word in TWO_WAY:
            found = 0
        found = ONE_WAY.get(word, found)
    return found


def _turns_at_times(tags: Mapping[str, str], way: int) -> bool:
    """Whether a one-way road is open in the other direction at some hours."""
    for group in (*reversed(GROUPS[1:]), ""):
        key = f"oneway:{group}" if group else "oneway"
        if tags.get(key) or tags.get(f"{key}:conditional"):
            said = _CLAUSE.findall(tags.get(f"{key}:conditional", ""))
            words = [word for word, when in said if _CLOCK.fullmatch(when)]
            return any(word in TWO_WAY or ONE_WAY.get(word, way) != way for word in words)
    return False


def _limit(
    tags: Mapping[str, str], side: str, country: str, *, miles: Container[str], metric: Container[str]
) -> float | None:
    fast = tags.get("highway", "")[:5] in ("motor", "trunk") or tags.get("motorroad") == "yes"
    fast = fast or (country == "IM" and tags.get("highway") not in ("residential", "living_street"))
    zones = [value for key, value in tags.items() if _ZONE_KEY.fullmatch(key) for value in _zones(value)]
    in_town = _in_town(tags)
    free = fast and in_town is not True and not any(_zone_kmh(value, miles=miles, metric=metric) for value in zones)
    whole = _whole_limit(tags, side, free=free, miles=miles, metric=metric)
    text = tags.get(f"maxspeed:lanes:{side}") or tags.get("maxspeed:lanes") or ""
    each = [_kmh(part.strip()) for part in text.split("|")]
    each = [None if kmh is not None and kmh > 1e9 and not free else kmh for kmh in each]
    if not any(each):
        return whole
    every = [whole if kmh is None else kmh for kmh in each]
    return None if None in every else max(kmh for kmh in every if kmh is not None)


def _whole_limit(
    tags: Mapping[str, str], side: str, *, free: bool, miles: Container[str], metric: Container[str]
) -> float | None:
    """The limit of a direction, whatever those of its lanes are."""
    ranked = sorted(_ranked(tags, side, _MAXSPEED), reverse=True)
    for _, value in ranked:
        kmh = _kmh(value)
        if kmh is not None and (kmh != float("inf") or free):
            return kmh
    for key in ("maxspeed", "zone:maxspeed", "maxspeed:type", "source:maxspeed"):
        for value in tags.get(key, "").split(";"):
            kmh = _zone_kmh(value.strip(), miles=miles, metric=metric)
            if kmh is None and key == "zone:maxspeed":
                kmh = _kmh(value)
            if kmh is not None and kmh < 1e9:
                return kmh
    return None


_ZONE_KEY = re.compile(
    r"zone:traffic|zone:maxspeed|maxspeed:type|source:maxspeed|maxspeed(:motorcar|:motor_vehicle)?"
)
_NUMBERED = re.compile(r"([A-Za-z]{2})(?:-[A-Za-z0-9]+)?: *(?:[zZ]one[:_ ]?)?([0-9]+)")


def _zones(value: str) -> list[str]:
    return [part.strip() for part in value.split(";")]


def _zone_kmh(value: str, *, miles: Container[str], metric: Container[str]) -> float | None:
    match = _NUMBERED.fullmatch(value)
    if match is None or not (match[1].upper() in miles or match[1].upper() in metric):
        return None
    return _within(float(match[2]), is_mph=match[1].upper() in miles)


def _in_town(tags: Mapping[str, str]) -> bool | None:
    """Whether a zone says so; of several, the first of the keys in this order that says anything."""
    for key in ("zone:traffic", "maxspeed:motorcar", "maxspeed:motor_vehicle", "maxspeed", "zone:maxspeed",
                "maxspeed:type", "source:maxspeed"):  # fmt: skip
        for value in _zones(tags.get(key, "")):
            name = value.partition(":")[2].strip().lower()
            if name in ("urban", "living_street", "nsl_restricted", "urban_motorway", "urban_trunk"):
                return True
            if name in ("rural", "trunk", "motorway", "expressway", "motorroad", "nsl_single", "nsl_dual"):
                return False
    return None


def _kmh(value: str) -> float | None:
    if value in ("none", "unlimited"):
        return float("inf")
    if value == "walk":
        return 7.0
    found = [SPEED.fullmatch(part.strip()) for part in value.split(";")]
    all_kmh = [
        _within(float(m[1]) * (1.852 if m[2] == "knots" else 1), is_mph=(m[2] or "").lower() == "mph")
        for m in found
        if m
    ]
    return min((kmh for kmh in all_kmh if kmh is not None), default=None)


def _within(number: float, *, is_mph: bool) -> float | None:
    """In km/h; None beyond what is posted anywhere."""
    kmh = number * MILE_KM if is_mph else number
    return kmh if kmh >= 3 and number <= (85 if is_mph else 160) else None
