"""The baseline run: the same drive from the hand-over, with nobody at the cockpit."""

from __future__ import annotations

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.episode.specification import ROUNDING_S


class Baseline:
    """The baseline run, driven along with the episode and only as far; the episode's branches share it."""

    def __init__(self, world: CoSimulation) -> None:
        """Takes over a shadow of the hand-over's world."""
        self._world = world
        self._moments: list[Moment] = [world.moment]

    def start(self, time_s: float) -> None:
        """Starts to run its traffic to a simulation time while the caller does something else."""
        if self._is_before(time_s):
            self._world.traffic.start(TICK_S)

    def until(self, time_s: float) -> tuple[Moment, ...]:
        """Its moments from the hand-over to the first whole tick at or after that time, or to the end of its drive.

        Raises:
            TrafficError: the traffic simulation failed.
        """
        self.follow(time_s)
        last = next(
            (i for i, moment in enumerate(self._moments) if moment.time_s >= time_s - ROUNDING_S),
            len(self._moments) - 1,
        )
        return tuple(self._moments[: last + 1])

    def follow(self, time_s: float) -> None:
        """Drives to that simulation time.

        Raises:
            TrafficError: the traffic simulation failed.
        """
        while self._is_before(time_s):
            self._moments += self._world.advance(TICK_S)

    def close(self) -> None:
        """Ends its drive; may be called again."""
        self._world.close()

    def _is_before(self, time_s: float) -> bool:
        last = self._moments[-1]
        return last.time_s < time_s - ROUNDING_S and last.driving.end is None
