"""Ways of other vehicles round what is closed: for those on the road, and for those that set out later."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from itertools import pairwise

from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.sumo import AVERAGED, NOW, LibSumo

EdgePair = tuple[str, str]
"""From edge, to edge."""

SEARCH = "simulation.findRoute"
"""SUMO's name of the vehicle for which it searches a route; it counts as loaded."""


class Detours:
    """Sends other vehicles round what is closed.

    Each takes the way that SUMO's rerouting device would take (``sumo.reroute``). If there is none, or its
    destination is closed, its trip ends on the road before the closed one that it reaches soonest. SUMO leaves out
    who would set out on a closed road; both are counted."""

    def __init__(self, sumo: LibSumo, network: Network) -> None:
        self._sumo = sumo
        self._network = network
        self._closed: list[str] = []
        self._narrowed: list[str] = []
        self._by_the_clock: tuple[frozenset[str], frozenset[EdgePair]] = frozenset(), frozenset()
        self._kept_in: set[str] = set()
        self.cut_short = 0
        """Vehicles whose trip ended before a closed road."""

    @property
    def are_needed(self) -> bool:
        """Whether anything is closed."""
        return bool(self._closed or self._narrowed or any(self._by_the_clock))

    @property
    def kept_in(self) -> int:
        """Vehicles that would have set out on a road that an incident has closed."""
        return len(self._kept_in)

    def close(self, edge: str, *, lanes_only: bool = False) -> None:
        """An incident closes a road, or some of its lanes and the turns from them."""
        if lanes_only:
            self._narrowed.append(edge)
            return
        self._closed.append(edge)
        running = set(self._sumo.vehicle_ids())
        self._keep_in(each for each in self._sumo.vehicle.getLoadedIDList() if each not in running)

    def open(self, edge: str, *, lanes_only: bool = False) -> None:
        """The incident is over."""
        (self._narrowed if lanes_only else self._closed).remove(edge)

    def follow(self, roads: frozenset[str], turns: frozenset[EdgePair]) -> None:
        """The roads and turns that are closed at this hour."""
        self._by_the_clock = roads, turns

    def after_step(self) -> None:
        """Takes note of who is to set out; called after every step while anything is closed."""
        if self._closed:
            self._keep_in(self._sumo.simulation.getLoadedIDList())

    def check(self, vehicle: str) -> None:
        """Sends a vehicle on the road round whose route is closed."""
        self._kept_in.discard(vehicle)
        if not self._sumo.vehicle.isRouteValid(vehicle):
            self.send_round(vehicle)

    def send_round(self, vehicle: str) -> None:
        """Gives a vehicle another route, if there is one, or ends its trip before what is closed."""
        sumo = self._sumo
        with suppress(*sumo.refusals):
            sumo.reroute(vehicle)
        if sumo.vehicle.isRouteValid(vehicle):
            return
        route = sumo.route(vehicle)[max(0, sumo.route_index(vehicle)) :]
        beyond = next((there for here, there in pairwise(route) if self._is_cut(here, there)), None)
        if beyond is None:
            return  # it is on the closed road, and drives on
        kind = sumo.type_of(vehicle)
        before = (here for here, ways in self._network.crossings.items() if beyond in ways)
        found = []
        with suppress(*sumo.refusals):  # it is on a road that the hour has closed, from which SUMO finds no way
            found = [way for each in before if (way := sumo.find_route(route[0], each, kind, NOW, AVERAGED)).edges]
        if found:
            with suppress(*sumo.refusals):  # such as a stop beyond: it waits, and SUMO moves it on in the end
                sumo.set_route(vehicle, min(found, key=lambda way: way.travelTime).edges)
                self.cut_short += 1

    def _is_cut(self, here: str, there: str) -> bool:
        roads, turns = self._by_the_clock
        return (
            there in self._closed
            or there in roads
            or here in self._narrowed
            or (here, there) in turns
            or there not in self._network.crossings.get(here, {})
        )

    def _keep_in(self, vehicles: Iterable[str]) -> None:
        for each in vehicles:
            try:
                if self._sumo.route(each)[0] in self._closed:
                    self._kept_in.add(each)
            except self._sumo.refusals:  # one of a flow that SUMO has left out in this step
                if each != SEARCH:
                    self._kept_in.add(each)
