"""The car's link, from where it drives and from what the network offers at the time."""

from __future__ import annotations

from copy import copy

from automotive_cosim.contracts import Connectivity, DrivingState
from automotive_cosim.formats.scenario import LINKS, LinkAt, link_at

OFFLINE = Connectivity(online=False, kind="none", signal_bars=0)
IN_TOWN = Connectivity(online=True, kind="5g", signal_bars=4)
ELSEWHERE = Connectivity(online=True, kind="4g", signal_bars=3)

ATTACH_S = 3.0
"""Time for a modem to find its network again; our choice."""


class Modem:
    """One modem on one drive: offline in tunnels, back a few seconds after; 5G where the network says built-up.

    Args:
        timeline: the best available link, by seconds since departure."""

    def __init__(self, timeline: tuple[LinkAt, ...] = ()) -> None:
        self._timeline = timeline
        self._reachable_s = ATTACH_S

    def read(self, driving: DrivingState, dt_s: float, since_departure_s: float = 0.0) -> Connectivity:
        """The link now.

        Args:
            dt_s: seconds since the previous reading.
            since_departure_s: the present time on the timeline."""
        best = link_at(self._timeline, since_departure_s)
        self._reachable_s = 0.0 if driving.road.in_tunnel or best == LINKS[0] else self._reachable_s + dt_s
        if self._reachable_s < ATTACH_S:
            return OFFLINE
        return IN_TOWN if driving.road.built_up and best == IN_TOWN.kind else ELSEWHERE

    def copy(self) -> Modem:
        """A modem that continues exactly as this one would."""
        return copy(self)
