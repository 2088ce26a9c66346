"""POIs: places by name, generated from a seed, on streets of the network."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

import numpy as np

from automotive_cosim.cockpit.map import MOTORWAYS, RoadMap
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import Quantity, say

PLACES = 80
"""Number of places, limited by the streets of the network."""
FAVOURITE_STREETS = 6
ZONES = (say("Zone A"), say("Zone B"), say("Zone C"))
PRICES = {"Zone A": 4.0, "Zone B": 2.5, "Zone C": 1.2}
"""Price of an hour's parking by zone; each car park lies in one, which its details name."""


class PoiKind(StrEnum):
    """Kinds of POIs."""

    HOME = "home"
    WORK = "work"
    CHARGING = "charging"
    PARKING = "parking"
    RESTAURANT = "restaurant"
    CAFE = "cafe"
    SHOP = "shop"
    HOSPITAL = "hospital"
    PHARMACY = "pharmacy"
    HOTEL = "hotel"
    STATION = "station"
    MUSEUM = "museum"
    SCHOOL = "school"
    PARK = "park"
    GYM = "gym"


@dataclass(frozen=True, slots=True)
class Sort:
    """Title, icon and names of a kind of place."""

    title: str
    icon: Icon
    count: int
    pattern: str
    words: str


SORTS: Mapping[PoiKind, Sort] = {
    PoiKind.HOME: Sort(say("Home"), Icon.HOME, 1, "{}", "Home"),
    PoiKind.WORK: Sort(say("Work"), Icon.WORK, 1, "{}", "Work"),
    PoiKind.CHARGING: Sort(
        say("Charging"),
        Icon.CHARGING,
        10,
        "{} Charging",
        "Volta Lumen Amber Spark Pulse Helio Nova Plus Metro Ion Rapid",
    ),
    PoiKind.PARKING: Sort(
        say("Parking"), Icon.PARKING, 8, "{} Car Park", "Central North South Market Station Theatre Garden Bridge"
    ),
    PoiKind.RESTAURANT: Sort(
        say("Restaurants"),
        Icon.RESTAURANT,
        10,
        "{} Kitchen",
        "Olive Basil Saffron Anchor Lantern Corner Ginger Cedar Bay Fig",
    ),
    PoiKind.CAFE: Sort(say("Cafés"), Icon.CAFE, 8, "Café {}", "Horizon Luna Aroma Paloma Bloom Tempo Verde Azur"),
    PoiKind.SHOP: Sort(
        say("Shops"), Icon.SHOP, 8, "{} Market", "Fresh Daily Green Family Golden Corner Union City"
    ),
    PoiKind.HOSPITAL: Sort(say("Hospitals"), Icon.HOSPITAL, 3, "{} Hospital", "General University Children's"),
    PoiKind.PHARMACY: Sort(
        say("Pharmacies"), Icon.PHARMACY, 6, "{} Pharmacy", "Linden Crown Park Sun Eagle Bridge"
    ),
    PoiKind.HOTEL: Sort(say("Hotels"), Icon.HOTEL, 6, "Hotel {}", "Aurora Central Bellevue Meridian Royal Astoria"),
    PoiKind.STATION: Sort(say("Stations"), Icon.STATION, 3, "{} Station", "Central East West"),
    PoiKind.MUSEUM: Sort(say("Museums"), Icon.MUSEUM, 4, "{} Museum", "City Science Modern Maritime"),
    PoiKind.SCHOOL: Sort(say("Schools"), Icon.SCHOOL, 4, "{} School", "Hill River Oak Meadow"),
    PoiKind.PARK: Sort(say("Parks"), Icon.PARK, 4, "{} Park", "Lake Rose Castle Maple"),
    PoiKind.GYM: Sort(say("Gyms"), Icon.GYM, 4, "{} Gym", "Iron Active Summit Pace"),
}
"""Counts add up to ``PLACES``."""


@dataclass(frozen=True, slots=True)
class Destination:
    """A place."""

    name: str
    kind: PoiKind
    street: str
    edge_id: str
    x_m: float
    y_m: float
    detail: str
    """Details of a place."""

    @property
    def icon(self) -> Icon:
        return SORTS[self.kind].icon

    def away_m(self, x_m: float, y_m: float) -> float:
        """Straight-line distance."""
        return math.hypot(self.x_m - x_m, self.y_m - y_m)


@dataclass(frozen=True, slots=True)
class Gazetteer(AppData):
    """All places, and the initial favourite streets."""

    places: tuple[Destination, ...]
    streets: tuple[str, ...]

    def names(self, state: State) -> Mapping[str, tuple[str, ...]]:
        return {"places": tuple(place.name for place in self.places)}

    def named(self, destination: str) -> str:
        """Name of a destination: of the place on that edge of the network, else its own."""
        place = self.at(destination)
        return destination if place is None else place.name

    def find(self, name: str) -> Destination | None:
        return next((place for place in self.places if place.name == name), None)

    def at(self, edge_id: str) -> Destination | None:
        """The place on that edge of the network."""
        return next((place for place in self.places if place.edge_id == edge_id), None)

    def of(self, kind: PoiKind) -> tuple[Destination, ...]:
        return tuple(place for place in self.places if place.kind is kind)

    @property
    def favourites(self) -> tuple[str, ...]:
        """Home, work and some streets: what the driver has saved."""
        own = [place.name for place in self.places if place.kind in (PoiKind.HOME, PoiKind.WORK)]
        return (*own, *self.streets)


def atlas(roads: RoadMap, rng: np.random.Generator, on: frozenset[str] | None = None) -> Gazetteer:
    """Draws the places of a network, each on a street of its own, and on these edges if any are named."""
    streets = tuple(roads.names[int(i)] for i in rng.permutation(len(roads.names))[:FAVOURITE_STREETS])
    addresses = _addresses(roads)
    if on is not None:
        addresses = tuple(at for at in addresses if roads.roads[at].edge_id in on) or addresses
    chosen = rng.permutation(len(addresses))[:PLACES]
    names = _names(rng)[: len(chosen)]
    return Gazetteer(
        tuple(
            _place(roads, addresses[int(at)], kind, name, rng)
            for at, (kind, name) in zip(chosen, names, strict=True)
        ),
        streets,
    )


def _names(rng: np.random.Generator) -> list[tuple[PoiKind, str]]:
    """One of each kind in turn, so that a small network has some of all."""
    left = {
        kind: [
            sort.title if sort.count == 1 else sort.pattern.format(word)
            for word in rng.permutation(sort.words.split())[: sort.count]
        ]
        for kind, sort in SORTS.items()
    }
    names: list[tuple[PoiKind, str]] = []
    while any(left.values()):
        names += [(kind, words.pop()) for kind, words in left.items() if words]
    return names


@lru_cache(maxsize=4)
def _addresses(roads: RoadMap) -> tuple[int, ...]:
    """Roads with addresses: with a name, above ground, not motorways; else any."""
    fit = [
        i
        for i, road in enumerate(roads.roads)
        if road.name and not road.in_tunnel and road.road_class not in MOTORWAYS
    ]
    return tuple(fit or range(len(roads.roads)))


def _place(roads: RoadMap, at: int, kind: PoiKind, name: str, rng: np.random.Generator) -> Destination:
    road = roads.roads[at]
    x_m, y_m = road.shape_m[len(road.shape_m) // 2]
    return Destination(name, kind, road.name or say("Unnamed road"), road.edge_id, x_m, y_m, _detail(kind, rng))


def _detail(kind: PoiKind, rng: np.random.Generator) -> str:
    if kind is PoiKind.CHARGING:
        plugs = int(rng.integers(2, 9))
        return say(
            "{power} kW, {free} of {total} free",
            power=int(rng.choice([22, 50, 150, 300])),
            free=int(rng.integers(0, plugs + 1)),
            total=plugs,
        )
    if kind is PoiKind.PARKING:
        free, zone = int(rng.integers(3, 240)), ZONES[int(rng.integers(10, 45)) % len(ZONES)]
        return say(
            "{zone}: {free} spaces free, {price} an hour",
            zone=zone,
            free=free,
            price=Quantity(f"{PRICES[zone]:.2f}"),
        )
    if kind in (PoiKind.HOME, PoiKind.WORK):
        return say("Your address")
    if kind is PoiKind.HOSPITAL:
        return say("Emergency room, day and night")
    closes = int(rng.integers(17, 24))
    if kind is PoiKind.HOTEL:
        return say("Open day and night")
    return say("Open until {time}", time=f"{closes}:00")
