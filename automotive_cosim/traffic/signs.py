"""Present speed limits in SUMO: the network's, limits by the clock, and temporary limits of incidents."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from datetime import datetime

from automotive_cosim.contracts import LimitSource
from automotive_cosim.traffic.network import DERESTRICTED_MPS, Edge, Network
from automotive_cosim.traffic.posted import TimedLimit, in_force
from automotive_cosim.traffic.sumo import LibSumo

BEND_MPS = 0.1
"""A lane across a junction that is slower than its road by more has a speed for a bend."""


class Signs:
    """Sets and removes limits. The lowest limit of the incidents applies, else the network's. A sign counts up to
    the far side of the junction at the end of its road, as the ego's limit does; lanes across it have it too."""

    def __init__(self, sumo: LibSumo, network: Network) -> None:
        self._sumo = sumo
        self._edges = network.edges
        self._as_built: dict[str, tuple[Edge, tuple[float, ...]]] = {}
        """Edges whose limit was ever changed, with the original speeds of their lanes."""
        self._across: dict[str, dict[str, float]] = {}
        """The lanes across the junction at the end of each of them, with theirs; some are slower, for a bend."""
        self._over: dict[str, list[float]] = {}
        self._timed = {edge.edge_id for edge in network.edges.values() if edge.timed_limits}
        self._seen: tuple[datetime, str] | None = None
        self.changed = False
        """Whether a limit has changed since this was last set to False."""

    @property
    def follow_the_clock(self) -> bool:
        """Whether any limit depends on the hour."""
        return bool(self._timed)

    def put_up(self, edge_id: str, limit_mps: float) -> None:
        """Adds a temporary sign."""
        self._over.setdefault(edge_id, []).append(limit_mps)
        self._show(edge_id)

    def take_down(self, edge_id: str, limit_mps: float) -> None:
        """Removes a temporary sign."""
        self._over[edge_id].remove(limit_mps)
        self._show(edge_id)

    def put_up_zone(self, edge_ids: Iterable[str], limit: TimedLimit) -> None:
        """Adds a school zone with its hours, where the limit is not as low anyway."""
        for edge_id in edge_ids:
            edge = self._edges[edge_id]
            if limit.limit_mps is not None and edge.speed_mps > limit.limit_mps:
                self._keep(edge_id)
                self._post(edge_id, (*edge.timed_limits, limit), school_zone=True)

    def take_down_zone(self, edge_ids: Iterable[str], limit: TimedLimit) -> None:
        """Removes a school zone."""
        for edge_id in edge_ids:
            if edge_id in self._as_built and limit in self._edges[edge_id].timed_limits:
                others = tuple(each for each in self._edges[edge_id].timed_limits if each is not limit)
                self._post(edge_id, others, school_zone=self._as_built[edge_id][0].school_zone)

    def follow(self, local_time: datetime, weather: str = "") -> None:
        """Applies the limits of this time, and of this weather (``posted.WEATHERS``)."""
        seen = local_time.replace(second=0, microsecond=0), weather
        if seen == self._seen:
            return
        self._seen = seen
        for edge_id in sorted(self._timed):
            edge = self._edges[edge_id]
            limit = in_force(edge.timed_limits, local_time, weather)
            if limit is not edge.timed_limit:
                self._keep(edge_id)
                self._edges[edge_id] = replace(edge, timed_limit=limit)
                self._show(edge_id)

    def _post(self, edge_id: str, limits: tuple[TimedLimit, ...], *, school_zone: bool) -> None:
        edge = replace(self._edges[edge_id], timed_limits=limits, school_zone=school_zone)
        self._edges[edge_id] = edge
        self._timed.add(edge_id)
        self._seen = None
        self.changed = True

    def _keep(self, edge_id: str) -> None:
        if edge_id not in self._as_built:
            edge = self._edges[edge_id]
            self._as_built[edge_id] = edge, tuple(self._sumo.lane_speed(lane) for lane in edge.lane_ids)
            inner = (lane for own in edge.lane_ids for lane in self._inner_lanes(own))
            self._across[edge_id] = {lane: self._sumo.lane_speed(lane) for lane in inner}

    def _inner_lanes(self, lane: str) -> Iterator[str]:
        """The lanes that lead from one across the junction; some wait in its middle, so they are two."""
        for link in self._sumo.lane.getLinks(lane):
            inner = str(link[4])
            if inner:
                yield inner
                yield from self._inner_lanes(inner)

    def _show(self, edge_id: str) -> None:
        self._keep(edge_id)
        built, speeds_mps = self._as_built[edge_id]
        now = self._edges[edge_id]
        limit_mps, source = built.limit_mps, built.limit_source
        over = self._over.get(edge_id)
        if over or now.timed_limit:
            limit_mps = min(over) if over else None if now.timed_limit is None else now.timed_limit.limit_mps
            speeds_mps = (DERESTRICTED_MPS if limit_mps is None else limit_mps,) * len(speeds_mps)
            source = LimitSource.POSTED
        for lane, speed_mps in zip(built.lane_ids, speeds_mps, strict=True):
            self._sumo.lane.setMaxSpeed(lane, speed_mps)
        limited, changed = max(speeds_mps), max(speeds_mps) != built.speed_mps
        for lane, built_mps in self._across[edge_id].items():
            is_bend = built_mps < built.speed_mps - BEND_MPS
            self._sumo.lane.setMaxSpeed(lane, limited if changed and not is_bend else min(built_mps, limited))
        self._edges[edge_id] = replace(now, speed_mps=max(speeds_mps), limit_mps=limit_mps, limit_source=source)
        self.changed = True
