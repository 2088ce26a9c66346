"""Tags about cars that no reader reads: whatever mappers write, a road's tags are followed or listed.

A key is taken apart at its colons. Its first word says what it is about; keys of these families that are not in
``READ``, and not about other vehicles or remarks, are listed (OSM wiki, "Key:access", "Conditional restrictions",
"Lanes", "Key:maxspeed", "Key:oneway", "Key:turn", "Key:hov", "Key:toll", "Key:priority", "Key:priority_road").
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache

_END = "(:forward|:backward)?"
_CAR = "(motorcar|motor_vehicle|vehicle|access)"

FAMILIES = re.compile(
    rf"({_CAR}|hov|oneway|lanes|turn|maxspeed|zone|priority|priority_road|toll|psv|bus|taxi|busway|stop|give_way|junction)"
    r"(?=:|$)"
)
"""What keys about cars begin with."""

READ = re.compile(
    rf"{_CAR}{_END}(:conditional)?|{_CAR}:lanes{_END}|hov(:lanes)?{_END}(:conditional)?|hov:minimum"
    rf"|oneway(:motorcar|:motor_vehicle|:vehicle)?(:conditional)?"
    rf"|lanes(:forward|:backward|:both_ways)?|lanes:(psv|bus){_END}|(psv|bus):lanes{_END}|turn(:lanes)?{_END}"
    rf"|maxspeed(:motorcar|:motor_vehicle)?{_END}(:conditional)?|maxspeed:lanes{_END}|maxspeed:type"
    rf"|zone:(maxspeed|traffic)|priority_road{_END}|toll(:motor_vehicle|:motorcar)?|busway(:both|:left|:right)?"
    r"|stop|junction"
)
"""The keys that are read; each reader lists the values that it does not follow."""

OTHERS = frozenset(
    ("hgv", "hgv_articulated", "goods", "lhv", "bdouble", "bus", "psv", "taxi", "minibus", "share_taxi", "coach",
     "tourist_bus", "school_bus", "trolleybus", "tram", "train", "bicycle", "cycle", "cargo_bike", "mtb", "foot",
     "dog", "horse", "carriage", "moped", "mofa", "motorcycle", "speed_pedelec", "small_electric_vehicle",
     "kick_scooter", "motorhome", "caravan", "trailer", "agricultural", "tractor", "forestry", "emergency", "ski",
     "snowmobile", "atv", "golf_cart", "disabled", "hazmat", "nev", "inline_skates", "wheelchair", "tank",
     "articulated", "hand_cart", "boat", "ship")
)  # fmt: skip
"""Words of keys about others than an ordinary car."""

REMARKS = frozenset(
    ("note", "source", "reason", "advisory", "advised", "practical", "proposed", "signed", "name", "description",
     "comment", "fixme", "date", "ref", "operator", "website", "wikidata", "check_date", "old", "was", "history",
     "en", "opening_hours", "payment", "charge", "fee", "width", "length", "colour", "material", "type", "count",
     "minimum", "survey", "lit", "direction")
)  # fmt: skip
"""Words of keys that tell something beside the rule."""

_WHO = re.compile(f"({_CAR}|oneway)(:|$)")
_CLASS = re.compile("[nlmt][1-7]")
"""Classes of vehicles beside passenger cars, M1, as ``toll:N3`` has them; UNECE."""


def unread(tags: Mapping[str, str]) -> Iterator[str]:
    """The tags of a road that nobody reads, ``"maxspeed:variable=yes"``."""
    for key, value in tags.items():
        if _is_unread(key) and (value not in ("no", "none", "0", "") or _WHO.match(key)):
            yield f"{key}={value}"


@lru_cache(4096)
def _is_unread(key: str) -> bool:
    if not FAMILIES.match(key) or READ.fullmatch(key):
        return False
    words = key.lower().split(":")
    if {"psv", "bus", "taxi"} & set(words) and "lanes" in words:
        return not REMARKS & set(words)  # a bus lane at certain hours is the cars' at others
    others = {word for word in words if word in OTHERS or (_CLASS.fullmatch(word) and word != "m1")}
    return not others and not REMARKS & set(words[1:]) and words[0] not in ("psv", "bus", "taxi", "busway")
