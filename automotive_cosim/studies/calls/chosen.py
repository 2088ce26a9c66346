"""Days on which what is asked of each driver is known before, as where routes are learned from day to day.

A day is a copy of the traffic and one message, so it takes little more than SUMO itself needs.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING

from automotive_cosim.contracts import KMH_PER_MPS, Reroute, SlowDown
from automotive_cosim.errors import UserError

if TYPE_CHECKING:  # every copy of the traffic would have to import it
    from automotive_cosim.traffic.fork import Forked
    from automotive_cosim.traffic.running import Running


@dataclass(frozen=True, slots=True)
class DayTrip:
    """A car's trip; simulation times in seconds."""

    planned_s: float
    """When it wanted to set out."""
    until_s: float
    """When it arrived, or the end of the day."""
    has_arrived: bool


def prepare(running: Running) -> None:
    """To be called in the warm traffic once, which makes its days faster: nobody asks what is around a car."""
    running.world.look_away()


def day(warm: Forked, asked: Mapping[str, Reroute | SlowDown], seconds: float) -> dict[str, DayTrip]:
    """Drives a day in a copy of the warm traffic.

    Args:
        warm: the traffic at the beginning of the day.
        asked: by SUMO's id, what a driver does from setting out on: go by ``Reroute.edges``, from the first edge of
            the trip to its last, or never drive faster than a ``SlowDown`` says.
        seconds: how long at most; a day ends with its last trip.

    Returns:
        The trips of the cars that set out, by SUMO's id.

    Raises:
        UserError: a route does not lead from edge to edge, or is not given.
        TrafficError: the simulation failed."""
    with closing(warm.copy()) as copy:
        trips, wrong = copy.call(_drive, dict(asked), seconds)
    if wrong:
        raise UserError(wrong)
    found: dict[str, DayTrip] = trips
    return found


def _drive(
    running: Running, asked: Mapping[str, Reroute | SlowDown], seconds: float
) -> tuple[dict[str, DayTrip], str]:
    """The day in the copy's process; what was asked for in vain stops it."""
    sumo, step = running.sumo, running.step
    vehicle, trips, out = sumo.vehicle, {}, set[str]()
    end_s = sumo.time() + seconds
    while sumo.time() < end_s - running.world.step_s / 2 and (out or sumo.simulation.getMinExpectedNumber()):
        step()
        now_s = sumo.time()
        for car in sumo.departed() if sumo.departed_count() else ():
            trips[car] = DayTrip(now_s - vehicle.getDepartDelay(car), end_s, has_arrived=False)
            out.add(car)
            match asked.get(car):
                case Reroute(edges=edges):
                    try:
                        sumo.set_route(car, edges or ())
                    except sumo.refusals as error:
                        return trips, f"car {car!r} cannot take the route {' '.join(edges or ())!r}: {error}"
                case SlowDown(speed_kmh=speed_kmh):
                    sumo.set_max_speed(car, max(0.1, speed_kmh / KMH_PER_MPS))
        for car in sumo.arrived() if sumo.arrived_count() else ():
            if car in out:
                out.remove(car)
                trips[car] = DayTrip(trips[car].planned_s, now_s, has_arrived=True)
    return trips, ""
