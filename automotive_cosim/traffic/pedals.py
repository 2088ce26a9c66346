"""What a driver can do with the car, in SUMO and on a scripted road."""

from __future__ import annotations

import math
from typing import Protocol

from automotive_cosim.contracts import DrivingState, Reroute


class RefusedError(Exception):
    """The car cannot do it now."""

    def __init__(self, why: str) -> None:
        """With the reason, as a text of the screens."""
        super().__init__(why)
        self.why = why


class Pedals(Protocol):
    """The driver's controls of the car."""

    def set_speed_factor(self, factor: float) -> None:
        """Desired speed on every road, as a factor on its limit."""
        ...

    def set_top_speed(self, speed_mps: float) -> None:
        """Upper bound of the speed."""
        ...

    def set_headway(self, headway_s: float) -> None:
        """Time gap to the leader."""
        ...

    def set_imperfection(self, imperfection: float) -> None:
        """How unevenly the speed is kept, 0 to 1."""
        ...

    def set_awareness(self, awareness: float) -> None:
        """How much of the driver's attention is on the road, 0.1 to 1."""
        ...

    def set_overtaking(self, readiness: float) -> None:
        """How readily lanes are changed to go faster; 0 is never."""
        ...

    def set_grip(self, friction: float) -> None:
        """Limits braking to ``friction * g``."""
        ...

    def set_traction(self, friction: float) -> None:
        """Limits acceleration to what the wheels of one axle, which carry half the car, bring on the road."""
        ...

    def set_braking(self, deceleration_mps2: float) -> None:
        """How hard the driver brakes for what can be seen coming."""
        ...

    def set_hazards(self, on: bool) -> None: ...

    def pull_over(self, state: DrivingState, for_s: float, within_m: float = math.inf) -> str:
        """Stops at the side as soon as possible, for a time, and no farther on than that; returns where.

        Raises RefusedError: there is no place for it."""
        ...

    def is_parked(self) -> bool:
        """Whether the car stands beside the road."""
        ...

    def change_lane(self, lanes_from_kerb: int, for_s: float) -> bool:
        """Moves a number of lanes away from the kerb, or towards it if negative, and stays there for a time.

        False if there is no such lane here."""
        ...

    def standing_ahead_m(self) -> float | None:
        """Distance on the route to the next breakdown or roadworks that is reported; None without one."""
        ...

    def leave_corridor(self, leave: bool) -> str:
        """Drives at the edge of its lane to open a corridor, or in the middle again; returns where."""
        ...

    def renew(self, seed: int) -> None:
        """Gives the traffic other random numbers from here on (``traffic.chance``)."""
        ...

    def reroute(self, request: Reroute, state: DrivingState) -> str:
        """Takes another route; returns a description of it.

        Raises RefusedError: there is none, or it is too late to take it."""
        ...
