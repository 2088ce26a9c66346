"""Proves that a scenario does what it says.

Each check gives an ``Item``: what was checked, whether it passes, and the figures or the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime
from functools import partial

from automotive_cosim.contracts import EgoEnd, Json, LimitSource, Tell
from automotive_cosim.errors import ScenarioError, TrafficError
from automotive_cosim.formats import incidents
from automotive_cosim.formats.incidents import Incident
from automotive_cosim.formats.scenario import Scenario, Street, Trip
from automotive_cosim.geo.place import Atlas, Place
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.scenarios.relocation import zone_of
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.georeference import GeoReference, middle
from automotive_cosim.traffic.network import Edge, Network
from automotive_cosim.traffic.posted_limits import in_force, sign_mps
from automotive_cosim.traffic.stability import measure
from automotive_cosim.traffic.ways import way_through

UNPOSTED = "unposted"

SIGN_TOLERANCE_MPS = 0.05
"""Tolerance of speeds, which networks give to two digits."""

LONGEST_DRIVE_S = 7200.0
"""A trip that takes longer counts as not arriving."""

PIECE_S = 30.0
"""Length of the pieces in which the drive is run."""


@dataclass(frozen=True, slots=True)
class Item:
    """The result of one check."""

    name: str
    ok: bool
    detail: str


@dataclass(frozen=True, slots=True)
class ScenarioProof:
    """The results of all checks of one scenario."""

    scenario: str
    items: tuple[Item, ...]

    @property
    def ok(self) -> bool:
        return all(item.ok for item in self.items)

    def as_json(self) -> Json:
        """The results as a JSON object."""
        return {
            "scenario": self.scenario,
            "ok": self.ok,
            "checks": [{"name": item.name, "ok": item.ok, "detail": item.detail} for item in self.items],
        }


@dataclass(frozen=True, slots=True)
class Ride:
    """The result of one of the ego's trips."""

    way: tuple[str, ...]
    driven_m: float
    took_s: float


def check(scenario: Scenario, *, quick: bool = False, tell: Tell = lambda what, share: None) -> ScenarioProof:
    """Checks everything that a scenario declares.

    Args:
        quick: whether to skip the hour of traffic.

    Raises SetupError: libsumo is missing, or eclipse-sumo unless ``quick``."""
    return ScenarioProof(scenario.name, tuple(_items(scenario, quick, tell)))


def _items(scenario: Scenario, quick: bool, tell: Tell) -> Iterator[Item]:
    tell("loading", None)
    try:
        network = network_of(scenario)
        simulation = Forked(
            scenario, progress=lambda done_s, total_s: tell("warming up", done_s / max(total_s, 1.0))
        )
    except (ScenarioError, TrafficError) as error:
        yield Item("loads", False, str(error))
        return
    with closing(simulation):
        count = f"{len(network.edges)} edges, {_km(network.edges.values()):.1f} km of road"
        yield Item("loads", True, f"{count}, {scenario.sumo.warm_up_s:g} s of warm-up")
        yield _place(scenario, network)
        yield _roads(network, scenario.start)
        yield from (_street(street, network) for street in scenario.streets)
        rides: dict[str, Ride] = {}
        for trip in scenario.ego.trips:
            tell(f"driving the trip {trip.name}", None)
            yield _ride(scenario, simulation, trip, rides)
    yield from (_situation(incident, network, rides) for incident in scenario.incidents)
    if not quick:
        yield _hour(scenario, tell)


def _place(scenario: Scenario, network: Network) -> Item:
    if network.unplaced:
        return Item("place", True, f"none: the network {network.unplaced}, and the scenario runs without GPS")
    atlas, reference = Atlas(), GeoReference(network.map)
    ends = {edge for trip in scenario.ego.trips for edge in (trip.from_edge, trip.to_edge)} & network.edges.keys()
    places = [atlas.place(*reference.lon_lat(*network.edges[edge].shape_m[0])) for edge in sorted(ends)]
    some = sorted(network.edges)[:: 1 + len(network.edges) // SAMPLED]
    around = [atlas.place(*reference.lon_lat(*network.edges[edge].shape_m[0])) for edge in some]
    side = "left" if network.map.left_hand else "right"
    others = {place.country for place in (*places, *around) if place.law and place.law.driving_side != side}
    countries = sorted({place.country for place in places})
    lon_deg, lat_deg = middle(network.map)
    where = f"{lat_deg:.4f}, {lon_deg:.4f}, {' and '.join(filter(None, countries)) or 'no country'}"
    if scenario.country not in countries:
        return Item("place", False, f"{where}, but the scenario says {scenario.country}")
    if others:
        lands = " and ".join(sorted(others))
        return Item("place", False, f"{where}, but traffic keeps {side} in the network, not in {lands}: crop it")
    if not any(_same_clock(scenario, place) for place in places):
        zones = ", ".join(sorted({place.time_zone for place in places}))
        return Item(
            "place", False, f"{where} has the time of {zones}, the scenario that of {scenario.start.tzinfo}"
        )
    return Item("place", True, f"{where}, {scenario.start.tzinfo}")


SAMPLED = 200
"""Edges of which the place is looked up."""


def _same_clock(scenario: Scenario, place: Place) -> bool:
    there = scenario.start.astimezone(zone_of(place))
    return there.utcoffset() == scenario.start.utcoffset()


def _roads(network: Network, start: datetime) -> Item:
    edges = tuple(network.edges.values())
    whole = _km(edges)
    named = _km(edge for edge in edges if edge.name) / whole
    posted = _km(edge for edge in edges if edge.limit_source is LimitSource.POSTED) / whole
    tunnels = _km(edge for edge in edges if edge.in_tunnel)
    names = len({edge.name for edge in edges if edge.name})
    length = f"{named:.0%} of their length named, limits posted on {posted:.0%}"
    return Item("roads", True, f"{names} streets, {length}, {tunnels:.1f} km of tunnel{by_clock(edges, start)}")


def by_clock(edges: Sequence[Edge], start: datetime) -> str:
    """Where signs have hours, which SUMO's network file does not know: it has the limit of the other hours."""
    timed = [edge for edge in edges if edge.timed_limits]
    if not timed:
        return ""
    now = [edge for edge in timed if in_force(edge.timed_limits, start)]
    return (
        f", limits by the clock on {_km(timed):.1f} km: at {start:%H:%M} {_km(now):.1f} km of it have another limit"
        " than in the network's file"
    )


def _street(street: Street, network: Network) -> Item:
    """Checks that the street has every declared sign, and no other."""
    name = f"street {street.name}"
    edges = [edge for edge in network.edges.values() if edge.name == street.name]
    if not edges:
        return Item(name, False, "is not in the network")
    if not street.maxspeed:
        return Item(name, True, f"{_km(edges):.1f} km")
    declared = [(sign, _sign_mps(sign)) for sign in street.maxspeed]
    missing = [sign for sign, speed in declared if not any(_bears(edge, sign, speed) for edge in edges)]
    surplus = [edge for edge in edges if not any(_bears(edge, sign, speed) for sign, speed in declared)]
    if missing:
        return Item(name, False, f"there is no sign for {', '.join(missing)}")
    if surplus:
        return Item(name, False, f"edge {surplus[0].edge_id!r} has another limit than {', '.join(street.maxspeed)}")
    return Item(name, True, f"{_km(edges):.1f} km at {', '.join(street.maxspeed)}")


def _bears(edge: Edge, sign: str, speed_mps: float | None) -> bool:
    if sign == UNPOSTED or edge.limit_source is not LimitSource.POSTED:
        return sign == UNPOSTED and edge.limit_source is not LimitSource.POSTED
    if speed_mps is None or edge.limit_mps is None:
        return speed_mps is edge.limit_mps
    return abs(edge.limit_mps - speed_mps) < SIGN_TOLERANCE_MPS


def _sign_mps(sign: str) -> float | None:
    """The speed of a sign; None for ``none`` and ``unposted``. Raises ScenarioError: it is not a ``maxspeed``."""
    if sign == UNPOSTED:
        return None
    try:
        return sign_mps(sign)
    except ValueError as error:
        raise ScenarioError(f'[[streets]]: {error}, or "{UNPOSTED}" where there is no sign') from None


def _ride(scenario: Scenario, simulation: Forked, trip: Trip, rides: dict[str, Ride]) -> Item:
    name = f"trip {trip.name}"
    plan = EgoPlan(trip, scenario.ego.driver, weather=scenario.weather, start=scenario.start)
    try:
        with closing(simulation.depart(plan)) as traffic:
            first = state = traffic.state
            while state.end is None and state.time_s - first.time_s < LONGEST_DRIVE_S:
                traffic.advance(PIECE_S)
                state = traffic.state
    except (ScenarioError, TrafficError) as error:
        return Item(name, False, str(error))
    ride = rides[trip.name] = Ride(first.ahead.route_edges, state.distance_m, state.time_s - first.time_s)
    drive = f"{ride.driven_m / 1000:.1f} km in {ride.took_s / 60:.1f} min"
    if state.end is EgoEnd.ARRIVED:
        return Item(name, True, drive)
    why = "is still on its way" if state.end is None else f"ends {state.end}"
    return Item(name, False, f"{why} after {drive}, on {state.road.name or state.road.edge_id}")


def _situation(incident: Incident, network: Network, rides: dict[str, Ride]) -> Item:
    """Checks that the ego passes while the incident lasts; loading has already proven that it can be staged."""
    name = f"situation {incident.kind}"
    driven = [ride for trip, ride in rides.items() if incident.trip in ("", trip)]
    driven = [ride for ride in driven if ride.took_s > incident.from_s]
    if isinstance(incident, incidents.EgoIncident):
        met = [ride for ride in driven if ride.driven_m > incident.at_m]
    else:
        edges = _edges_of(incident, network)
        met = [ride for ride in driven if not edges or edges & frozenset(ride.way)]
    if not met:
        trips = f"on the trip {incident.trip}" if incident.trip else "on any trip"
        return Item(name, False, f"the ego does not pass it {trips}")
    return Item(name, True, f"met on {len(met)} of {len(rides)} trips")


def _edges_of(incident: Incident, network: Network) -> frozenset[str]:
    """Edges where it happens; empty if everywhere."""
    match incident:
        case incidents.Breakdown() | incidents.Roadworks() | incidents.Closure():
            return frozenset((incident.edge,))
        case incidents.Jam() | incidents.SchoolZone():
            return frozenset(incident.edges)
        case incidents.Tractor():
            return frozenset(way_through(network, (incident.from_edge, incident.to_edge)))
        case incidents.Pedestrians():
            return frozenset((incident.from_edge, incident.to_edge))
    return frozenset()


def _hour(scenario: Scenario, tell: Tell) -> Item:
    step_s = scenario.sumo.step_length_s
    try:
        found = measure(scenario, step_length_s=step_s, on_progress=partial(tell, "an hour of traffic"))
    except ScenarioError as error:
        return Item("an hour of traffic", False, str(error))
    figures = (
        f"{found.vehicles_mean:.0f} vehicles at a time, {found.halted_share_mean:.0%} halted on average and "
        f"{found.halted_share_max:.0%} in the worst minute, {found.arrived} arrived"
    )
    return Item("an hour of traffic", found.stable, "; ".join((*found.problems, figures)))


def _km(edges: Iterable[Edge]) -> float:
    return sum(edge.length_m for edge in edges) / 1000
