"""Roads and turns that are open to cars at certain hours only: closed and opened in SUMO as the clock tells."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime
from itertools import pairwise

from automotive_cosim.traffic.detours import Detours, EdgePair
from automotive_cosim.traffic.network import CARS, Network
from automotive_cosim.traffic.posted_limits import TimedAccess, is_open
from automotive_cosim.traffic.sumo import LibSumo


class Closures:
    """Closes roads and turns to cars. A car that is on such a road leaves it; one whose route leads over it gets
    another (``Detours``)."""

    def __init__(self, sumo: LibSumo, network: Network, detours: Detours) -> None:
        self._sumo = sumo
        self._detours = detours
        edges = network.edges.values()
        self._roads = {edge.edge_id: edge.timed_access for edge in edges if edge.timed_access}
        self._turns = {(edge.edge_id, goal): access for edge in edges for goal, access in edge.timed_turns}
        self._lanes = {edge_id: network.edges[edge_id].lane_ids for edge_id in self._roads}
        self._shut: frozenset[str] = frozenset()
        self._barred: frozenset[EdgePair] = frozenset()
        self._allowed: dict[str, Sequence[str]] = {}
        """Of each closed lane, the classes that may use it otherwise; none stands for all."""
        self._seen: tuple[datetime, str] | None = None

    @property
    def follow_the_clock(self) -> bool:
        """Whether any road or turn is open at certain hours only."""
        return bool(self._roads or self._turns)

    def follow(self, local_time: datetime, weather: str = "") -> bool:
        """Closes and opens what is to be at this time, in this weather (``posted.WEATHERS``); true if anything was
        closed, so that routes may have changed."""
        seen = local_time.replace(second=0, microsecond=0), weather
        if not self.follow_the_clock or seen == self._seen:
            return False
        self._seen = seen

        def is_shut(access: Sequence[TimedAccess]) -> bool:
            return not is_open(access, local_time, weather)

        shut = frozenset(edge_id for edge_id, access in self._roads.items() if is_shut(access))
        barred = frozenset(turn for turn, access in self._turns.items() if is_shut(access))
        for lane in self._of(self._shut - shut, self._barred - barred):
            self._sumo.lane.setAllowed(lane, self._allowed.pop(lane))
        closed = shut - self._shut, barred - self._barred
        for lane in self._of(*closed):
            self._allowed[lane] = self._sumo.lane.getAllowed(lane)
            self._sumo.lane.setDisallowed(lane, [*self._sumo.lane.getDisallowed(lane), CARS])
        self._shut, self._barred = shut, barred
        self._detours.follow(shut, barred)
        if any(closed):
            self._divert()
        return any(closed)

    def _of(self, edges: Iterable[str], turns: Iterable[EdgePair]) -> list[str]:
        """The lanes of edges, and those of turns across their junctions."""
        lanes = [lane for edge_id in sorted(edges) for lane in self._lanes[edge_id]]
        for start, goal in sorted(turns):
            count = self._sumo.edge.getLaneNumber(start)
            links = (link for index in range(count) for link in self._sumo.lane.getLinks(f"{start}_{index}"))
            lanes += (str(link[4]) for link in links if link[4] and link[0].rpartition("_")[0] == goal)
        return lanes

    def _divert(self) -> None:
        sumo = self._sumo
        for vehicle in sumo.vehicle_ids():
            rest = sumo.route(vehicle)[max(0, sumo.route_index(vehicle)) :]
            if not self._shut.isdisjoint(rest[1:]) or not self._barred.isdisjoint(pairwise(rest)):
                self._detours.send_round(vehicle)
