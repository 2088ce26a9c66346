"""Present speed limits in SUMO: the network's, limits by the clock, and temporary limits of incidents.

A scenario may change limits too: by variable speed signs, and by calibrators. SUMO then writes the speed of a lane
anew at each of their steps, whatever else has been written there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import datetime

from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.errors import ScenarioError
from automotive_cosim.traffic.network import DERESTRICTED_MPS, SLOWEST_MPS, Edge, Network
from automotive_cosim.traffic.posted_limits import TimedLimit, in_force
from automotive_cosim.traffic.sumo import LibSumo

MORE_MPS = 20 / KMH_PER_MPS
"""By how much a variable sign that shows a limit for each lane shows more than over the lane at the kerb."""
BEND_MPS = 0.1
"""A lane across a junction that is slower than its road by more has a speed for a bend."""


@dataclass(slots=True)
class _Kept:
    """A road whose limit was ever changed."""

    built: Edge
    built_mps: tuple[float, ...]
    """The speeds of its lanes as SUMO loaded them."""
    sumo_mps: tuple[float, ...]
    """What SUMO says without any limit of ours."""
    across_mps: dict[str, float]
    """The lanes across the junction at its end; some are slower, for a bend."""
    written_mps: tuple[float, ...]
    """What was written to its lanes last, or read from them."""
    ours: bool = False
    """Whether a limit of ours is in force."""


class Signs:
    """Sets and removes limits. The lowest limit of the incidents applies, else the network's; where a sign of the
    scenario shows another speed than the road was built with, the lower of both. A sign over some lanes holds in
    them, and one over all of them is known from afar. A sign counts up to the far side of the junction at the end
    of its road, as the ego's limit does; lanes across it have it too."""

    def __init__(self, sumo: LibSumo, network: Network, variable: Iterable[str]) -> None:
        """Keeps watch on the edges on which SUMO itself changes the limit."""
        self._sumo = sumo
        self._edges = network.edges
        self._kept: dict[str, _Kept] = {}
        self._over: dict[str, list[float]] = {}
        self._timed = {edge.edge_id for edge in network.edges.values() if edge.timed_limits}
        self._variable = sorted(variable)
        for edge_id in self._variable:
            self._keep(edge_id)
        self._seen: tuple[datetime, str] | None = None
        self.changed = False
        """Whether a limit has changed since this was last set to False."""

    @property
    def follow_the_clock(self) -> bool:
        """Whether any limit depends on the hour, or is changed by SUMO."""
        return bool(self._timed or self._variable)

    @property
    def slowed(self) -> dict[str, float]:
        """Edges with a limit of ours, and that limit as a share of what it would be without."""
        found = {}
        for edge_id, kept in self._kept.items():
            without_mps, now_mps = self._for_cars(kept, kept.sumo_mps)[0], self._edges[edge_id].lane_mps[0]
            if kept.ours and now_mps != without_mps:
                found[edge_id] = now_mps / without_mps
        return found

    def refuse_if_fixed(self, edge_id: str) -> None:
        """Refuses to put up a sign where it would be for nothing: SUMO's limits for a class overrule it.

        Raises ScenarioError: the road's type has a limit for cars."""
        if self._edges[edge_id].cars_mps is not None:
            raise ScenarioError(
                f"edge {edge_id!r} has a limit for cars in its type, which SUMO keeps whatever a sign says; "
                "take the <restriction> out of the network, or name another edge"
            )

    def put_up(self, edge_id: str, limit_mps: float) -> None:
        """Adds a temporary sign."""
        self._over.setdefault(edge_id, []).append(limit_mps)
        self._show(edge_id)

    def take_down(self, edge_id: str, limit_mps: float) -> None:
        """Removes a temporary sign."""
        self._over[edge_id].remove(limit_mps)
        self._show(edge_id)

    def light(self, edge_ids: Iterable[str], limit_mps: float | None, *, by_lane: bool) -> None:
        """Lets a variable sign show a limit, as SUMO's own would, by lane a higher one over all but the lane at the
        kerb; without a limit it is dark again."""
        for edge_id in edge_ids:
            kept = self._keep(edge_id)
            kept.sumo_mps = kept.built_mps
            if limit_mps is not None:
                more = (by_lane * bool(lane) * MORE_MPS for lane in range(len(kept.built_mps)))
                kept.sumo_mps = tuple(
                    min(mps, limit_mps + each) for mps, each in zip(kept.built_mps, more, strict=True)
                )
            self._write(kept, kept.sumo_mps, is_variable=False)
            self._show(edge_id)

    def has_variable(self, edge_id: str) -> bool:
        """Whether SUMO changes the limit there."""
        return edge_id in self._variable

    def put_up_timed(self, edge_ids: Iterable[str], limit: TimedLimit, *, school: bool) -> None:
        """Adds a limit with its hours or weather, perhaps of a school zone, where it is not as low anyway."""
        for edge_id in edge_ids:
            edge = self._edges[edge_id]
            if limit.limit_mps is not None and edge.speed_mps > limit.limit_mps:
                self._keep(edge_id)
                self._post(edge_id, (*edge.timed_limits, limit), school_zone=school or edge.school_zone)

    def take_down_timed(self, edge_ids: Iterable[str], limit: TimedLimit) -> None:
        """Removes such a limit."""
        for edge_id in edge_ids:
            if edge_id in self._kept and limit in self._edges[edge_id].timed_limits:
                others = tuple(each for each in self._edges[edge_id].timed_limits if each is not limit)
                self._post(edge_id, others, school_zone=self._kept[edge_id].built.school_zone)

    def follow(self, local_time: datetime, weather: str = "") -> None:
        """Applies the limits of this time, and of this weather (``posted.WEATHERS``), and what SUMO has changed."""
        for edge_id in self._variable:
            kept = self._kept[edge_id]
            now_mps = self._read(kept)
            if now_mps != kept.written_mps:
                each = zip(now_mps, kept.written_mps, kept.sumo_mps, strict=True)
                kept.sumo_mps = tuple(now if now != written else before for now, written, before in each)
                kept.written_mps = now_mps
                self._show(edge_id)
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

    def _keep(self, edge_id: str) -> _Kept:
        if edge_id not in self._kept:
            edge = self._edges[edge_id]
            lanes_mps = tuple(self._sumo.lane_speed(lane) for lane in edge.lane_ids)
            inner = (lane for own in edge.lane_ids for lane in inner_lanes(self._sumo, own))
            across_mps = {lane: self._sumo.lane_speed(lane) for lane in inner}
            self._kept[edge_id] = _Kept(edge, lanes_mps, lanes_mps, across_mps, lanes_mps)
        return self._kept[edge_id]

    def _read(self, kept: _Kept) -> tuple[float, ...]:
        return tuple(self._sumo.lane_speed(lane) for lane in kept.built.lane_ids)

    def _show(self, edge_id: str) -> None:
        kept = self._keep(edge_id)
        built, now, lanes_mps = kept.built, self._edges[edge_id], kept.sumo_mps
        limit_mps, source = built.limit_mps, built.limit_source
        each = zip(built.lane_ids, lanes_mps, kept.built_mps, strict=True)
        lit = frozenset(lane for lane, shown_mps, built_mps in each if shown_mps != built_mps)
        if len(lit) == len(built.lane_ids):
            limit_mps, source = max(self._for_cars(kept, lanes_mps)), LimitSource.VARIABLE
        over = self._over.get(edge_id)
        ours = bool(over or now.timed_limit) and built.cars_mps is None
        if ours:
            limit_mps = min(over) if over else None if now.timed_limit is None else now.timed_limit.limit_mps
            mps = DERESTRICTED_MPS if limit_mps is None else limit_mps
            shown = zip(lanes_mps, kept.built_mps, strict=True)
            lanes_mps = tuple(mps if sumo_mps == built_mps else min(mps, sumo_mps) for sumo_mps, built_mps in shown)
            limit_mps = limit_mps and max(lanes_mps)
            source = LimitSource.POSTED
        if ours or kept.ours:
            self._write(kept, lanes_mps, is_variable=edge_id in self._variable)
        kept.ours = ours
        cars_mps = self._for_cars(kept, lanes_mps)
        self._edges[edge_id] = replace(
            now,
            speed_mps=max(cars_mps),
            lane_mps=cars_mps,
            limit_mps=limit_mps,
            limit_source=source,
            variable_lanes=frozenset() if ours else lit,
        )
        self.changed = True

    def _for_cars(self, kept: _Kept, lanes_mps: tuple[float, ...]) -> tuple[float, ...]:
        """What holds for cars: a limit of the road's type, or a lower one that SUMO's own sign shows."""
        cars_mps = kept.built.cars_mps
        if cars_mps is None:
            return lanes_mps
        each = zip(lanes_mps, kept.built_mps, strict=True)
        return tuple(cars_mps if now == built else min(cars_mps, max(SLOWEST_MPS, now)) for now, built in each)

    def _write(self, kept: _Kept, lanes_mps: tuple[float, ...], *, is_variable: bool) -> None:
        """Writes speeds, next to which a sign of SUMO's that shows the same can be told."""
        built = kept.built
        kept.written_mps = tuple(math.nextafter(mps, math.inf) if is_variable else mps for mps in lanes_mps)
        for lane, mps in zip(built.lane_ids, kept.written_mps, strict=True):
            self._sumo.lane.setMaxSpeed(lane, mps)
        limited, changed = max(lanes_mps), max(lanes_mps) != built.speed_mps
        for lane, built_mps in kept.across_mps.items():
            is_bend = built_mps < built.speed_mps - BEND_MPS
            self._sumo.lane.setMaxSpeed(lane, limited if changed and not is_bend else min(built_mps, limited))


def inner_lanes(sumo: LibSumo, lane: str) -> Iterator[str]:
    """The lanes that lead from one across the junction; some wait in its middle, so they are two."""
    for link in sumo.lane.getLinks(lane):
        inner = str(link[4])
        if inner:
            yield inner
            yield from inner_lanes(sumo, inner)


def variable_edges(sumo: LibSumo, network: Network) -> frozenset[str]:
    """The edges with lanes whose speed SUMO changes."""
    signs, calibrators = sumo.variable_signs, sumo.calibrators
    edges = {lane.rpartition("_")[0] for sign in signs.getIDList() for lane in signs.getLanes(sign)}
    edges |= {calibrators.getEdgeID(each) for each in calibrators.getIDList()}
    return frozenset(edges & network.edges.keys())
