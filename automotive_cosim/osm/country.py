"""A country's defaults for what a map does not say: the driving side, and the limit where none is mapped.

The limits are those of the country's traffic code for a car in the dry, as collected on the OpenStreetMap wiki's
page "Default speed limits" and corrected where the code itself says otherwise (FR: code de la route R413-2 and -3;
DE: StVO § 3, 130 being advisory; CH: VRV art. 4a; JP: 30 without a centre line since 1 September 2026). They fill
gaps in a network where the rules of ``geo`` do not determine the limit, and are marked as assumed there: no verdict
rests on them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

KMH_PER_MPH = 1.609344

# fmt: off
LEFT_HAND = frozenset((
    "AG", "AI", "AU", "BB", "BD", "BM", "BN", "BS", "BT", "BW", "CC", "CK", "CX", "CY", "DM", "FJ", "FK", "GB",
    "GD", "GG", "GS", "GY", "HK", "ID", "IE", "IM", "IN", "JE", "JM", "JP", "KE", "KI", "KN", "KY", "LC", "LK",
    "LS", "MO", "MS", "MT", "MU", "MV", "MW", "MY", "MZ", "NA", "NF", "NP", "NR", "NU", "NZ", "PG", "PK", "PN",
    "SB", "SC", "SG", "SH", "SR", "SZ", "TC", "TH", "TK", "TL", "TO", "TT", "TV", "TZ", "UG", "VC", "VG", "VI",
    "WS", "ZA", "ZM", "ZW",
))
# fmt: on
"""ISO 3166-1 codes of the countries that drive on the left."""


@dataclass(frozen=True, slots=True)
class CountryLimits:
    """General limits of a country, km/h."""

    street: float
    """In built-up areas, on a residential street."""
    town: float
    """In built-up areas, on any larger road."""
    rural: float
    dual: float
    """Rural, separate carriageways (expressway, motor road)."""
    motorway: float


def _mph(street: float, town: float, rural: float, dual: float, motorway: float) -> CountryLimits:
    return CountryLimits(*(round(limit * KMH_PER_MPH, 3) for limit in (street, town, rural, dual, motorway)))


LIMITS: Mapping[str, CountryLimits] = {
    "AE": CountryLimits(40, 60, 100, 100, 120),
    "AR": CountryLimits(40, 60, 110, 120, 130),
    "AT": CountryLimits(50, 50, 100, 100, 130),
    "AU": CountryLimits(50, 50, 100, 100, 110),
    "BE": CountryLimits(50, 50, 70, 120, 120),
    "BG": CountryLimits(50, 50, 90, 120, 140),
    "BR": CountryLimits(30, 60, 100, 110, 110),
    "CA": CountryLimits(50, 50, 80, 100, 100),
    "CH": CountryLimits(50, 50, 80, 100, 120),
    "CN": CountryLimits(30, 50, 70, 70, 120),
    "CZ": CountryLimits(50, 50, 90, 110, 130),
    "DE": CountryLimits(50, 50, 100, 130, 130),
    "DK": CountryLimits(50, 50, 80, 80, 130),
    "EE": CountryLimits(50, 50, 90, 90, 90),
    "ES": CountryLimits(30, 50, 90, 90, 120),
    "FI": CountryLimits(50, 50, 80, 80, 120),
    "FR": CountryLimits(50, 50, 80, 110, 130),
    "GB": _mph(30, 30, 60, 70, 70),
    "GR": CountryLimits(50, 50, 90, 110, 130),
    "HR": CountryLimits(50, 50, 90, 110, 130),
    "HU": CountryLimits(50, 50, 90, 110, 130),
    "IE": CountryLimits(50, 50, 80, 100, 120),
    "IN": CountryLimits(70, 70, 70, 100, 120),
    "IT": CountryLimits(50, 50, 90, 110, 130),
    "JP": CountryLimits(30, 60, 60, 60, 100),
    "KR": CountryLimits(50, 50, 60, 80, 100),
    "LT": CountryLimits(50, 50, 90, 120, 130),
    "LU": CountryLimits(50, 50, 90, 90, 130),
    "LV": CountryLimits(50, 50, 90, 90, 90),
    "NL": CountryLimits(50, 50, 80, 100, 100),
    "NO": CountryLimits(50, 50, 80, 80, 110),
    "NZ": CountryLimits(50, 50, 100, 100, 100),
    "PL": CountryLimits(50, 50, 90, 100, 140),
    "PT": CountryLimits(50, 50, 90, 100, 120),
    "RO": CountryLimits(50, 50, 90, 100, 130),
    "SE": CountryLimits(50, 50, 70, 70, 110),
    "SI": CountryLimits(50, 50, 90, 110, 130),
    "SK": CountryLimits(50, 50, 90, 130, 130),
    "TR": CountryLimits(50, 50, 90, 110, 130),
    "US": _mph(30, 30, 55, 65, 65),
    "ZA": CountryLimits(60, 60, 100, 100, 120),
}
WORLD = CountryLimits(50, 50, 80, 100, 120)
"""For a country without a row above: the most common values among those that have one."""

LIVING_STREET_KMH = 20.0
"""Limit of mapped living streets without one; the codes say 20 km/h (FR R110-2, BE, CH) or walking pace (DE)."""


@cache
def country_codes() -> frozenset[str]:
    """Every ISO 3166-1 code, from the time zone database's ``iso3166.tab``."""
    text = (files("tzdata") / "zoneinfo" / "iso3166.tab").read_text(encoding="utf-8")
    return frozenset(line[:2] for line in text.splitlines() if line and not line.startswith("#"))


def limits_of(country: str) -> CountryLimits:
    """The general limits of a country, ``WORLD`` for one that is not listed."""
    return LIMITS.get(country, WORLD)


def assumed_limit_kmh(country: str, road_class: str, *, built_up: bool, dual: bool) -> float:
    """The most likely limit of a road for which the map states none.

    Args:
        country: ISO 3166-1 code.
        road_class: OSM highway value, or ``cycle_street``.
        built_up: whether the road lies in a town or village.
        dual: whether it is one carriageway of two.
    """
    limits = limits_of(country)
    if road_class == "motorway":
        return limits.motorway
    if road_class == "living_street":
        return min(LIVING_STREET_KMH, limits.street)
    if built_up:
        return limits.street if road_class in ("residential", "unclassified", "cycle_street") else limits.town
    return limits.dual if dual and road_class == "trunk" else limits.rural
