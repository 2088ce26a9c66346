"""The equipped cars of one traffic: they take every step together, and each reads the road for itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from automotive_cosim.errors import TrafficError
from automotive_cosim.traffic.base import EgoPlan, Event
from automotive_cosim.traffic.ego_loop import EgoLoop
from automotive_cosim.traffic.instant import Instant
from automotive_cosim.traffic.sumo import EGO
from automotive_cosim.traffic.world import World


class Convoy:
    """After a step every equipped car is read before any driver has his turn, so what a car sees depends on the
    road alone."""

    def __init__(self, world: World) -> None:
        """Begins without a car."""
        self._world = world
        self._drives: dict[str, EgoLoop] = {}
        self.chooses: Callable[[str], EgoPlan | None] | None = None
        """Whether a vehicle that sets out gets a cockpit, and how its driver reacts then; None equips none."""

    def drive(self, car: str = EGO) -> EgoLoop:
        """The drive of a car.

        Raises TrafficError: it has not entered the traffic, or its cockpit is no longer used."""
        if car not in self._drives:
            raise TrafficError(f"no equipped car {car!r} is in the traffic")
        return self._drives[car]

    @property
    def first(self) -> EgoLoop | None:
        """The drive of the car that departed first; None before."""
        return self._drives.get(EGO)

    def depart(self, plan: EgoPlan, beat: Callable[[], None]) -> EgoLoop:
        """See ``World.depart``: the first car, with whose departure its clock and its weather begin."""
        drive = self._drives[EGO] = self._world.depart(plan, beat)
        return drive

    def send(self, car: str, plan: EgoPlan) -> None:
        self._world.send(car, plan)

    def equip(self, car: str, plan: EgoPlan) -> EgoLoop:
        drive = self._drives[car] = self._world.equip(car, plan)
        return drive

    def forget(self, car: str) -> None:
        self._drives.pop(car, None)
        self._world.forget(car)

    def advance(
        self, duration_s: float, of: Iterable[str], beat: Callable[[], None]
    ) -> tuple[dict[str, tuple[list[Instant], list[Event]]], list[str]]:
        """Lets the traffic run, as long as an equipped car drives in it or waits for a gap; if no car's states are
        wanted, until one enters.

        Args:
            duration_s: for how long.
            of: cars whose states and events are wanted.
            beat: called after every step.

        Returns:
            What passed for each of those cars, and the cars that have entered the traffic.
        """
        told: dict[str, tuple[list[Instant], list[Event]]] = {car: ([], []) for car in of}
        entered: list[str] = []
        world, roads = self._world, self._world.roads
        for _ in range(round(duration_s / world.step_s)):
            going = [(car, drive) for car, drive in self._drives.items() if not drive.has_ended]
            if not (going or world.are_coming or self.chooses):
                break
            for car, _ in going:
                roads[car].apply()
            sampled = world.step()
            seen = [roads[car].read(sampled, hazard_lights=drive.hazard_lights) for car, drive in going]
            for (car, drive), (now, passed) in zip(going, seen, strict=True):
                passed = drive.proceed(now, passed)
                if car in told:
                    told[car][0].append(now)
                    told[car][1].extend(passed)
            new = world.entered() | self._chosen()
            self._drives |= new
            entered += new
            beat()
            if new and not told:
                break
        return told, entered

    def _chosen(self) -> dict[str, EgoLoop]:
        """The drives of the cars that have set out in the last step and get a cockpit."""
        if self.chooses is None:
            return {}
        plans = ((car, self.chooses(car)) for car in self._world.set_out())
        return {car: self._world.equip(car, plan) for car, plan in plans if plan is not None}
