"""Sends other cars the ego's other way, so that a study sees what it costs when many follow the same advice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import EGO, LibSumo

LEAST_LEFT_M = 50.0
"""A car this close to the fork of the ways, or closer, is too late to take the other one."""

Edges = tuple[str, ...]


def section(old: Sequence[str], new: Sequence[str]) -> tuple[Edges, Edges]:
    """The parts of two routes between the last edge before they part and the first one they share again.

    Both parts begin and end with an edge in common; they are empty if the routes do not part, or do not meet again.
    """
    parts = next((n for n, pair in enumerate(zip(old, new, strict=False)) if pair[0] != pair[1]), 0)
    if not parts:
        return (), ()
    rejoin = next((edge for edge in new[parts:] if edge in old[parts:]), None)
    if rejoin is None:
        return (), ()
    return tuple(_until(old, parts, rejoin)), tuple(_until(new, parts, rejoin))


def diverted(route: Sequence[str], old: Edges, new: Edges) -> Edges | None:
    """A route that takes the new section instead of whatever it has between its ends; None if it lacks them."""
    if old[0] not in route or old[-1] not in route:
        return None
    begin, end = route.index(old[0]), route.index(old[-1])
    if end <= begin or tuple(route[begin : end + 1]) == new:
        return None
    return (*route[:begin], *new, *route[end + 1 :])


def divert(running: Running, old: Edges, new: Edges, share: float, seed: int) -> tuple[tuple[str, ...], int]:
    """Sends a share of the cars that could the other way, and keeps them on it.

    Args:
        old: the section of the ego's route, as ``section`` makes it.
        share: share of the cars, 0 to 1; a greater share contains those of every smaller one.

    Returns:
        The cars that took it, and how many could have."""
    sumo, routes = running.sumo, {}
    for vehicle in sorted(set(sumo.vehicle_ids()) - {EGO}):
        ahead = tuple(sumo.route(vehicle)[sumo.route_index(vehicle) :])
        way = diverted(ahead, old, new)
        if way is not None and not _is_too_late(sumo, vehicle, old[0]):
            routes[vehicle] = way
    names = list(routes)
    np.random.default_rng(seed).shuffle(names)
    taken = []
    for vehicle in names[: round(share * len(names))]:
        try:
            sumo.keep_to(vehicle, routes[vehicle])
        except sumo.refusals:  # such as a lorry where lorries must not drive
            continue
        taken.append(vehicle)
    return tuple(sorted(taken)), len(names)


def _until(route: Sequence[str], parts: int, rejoin: str) -> Sequence[str]:
    return route[parts - 1 : parts + list(route[parts:]).index(rejoin) + 1]


def _is_too_late(sumo: LibSumo, vehicle: str, edge: str) -> bool:
    lane = sumo.lane_of(vehicle)
    if not lane or lane.startswith(":"):
        return True  # inside a junction or off the road
    if lane.rpartition("_")[0] != edge:
        return False
    return bool(sumo.lane.getLength(lane) - sumo.lane_position(vehicle) < LEAST_LEFT_M)
