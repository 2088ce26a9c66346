"""What runs in a simulation's process, as seen by functions that others have called there.

``fork.RemoteTraffic.call`` and ``begin`` take a function of any module, whose first argument this is. It is sent by
name, so nothing here knows what is called.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from hashlib import sha256
from typing import Protocol, TypeVar

from automotive_cosim.contracts import RoadSnapshot
from automotive_cosim.traffic.convoy import Convoy
from automotive_cosim.traffic.ego_loop import EgoLoop
from automotive_cosim.traffic.records import make_seen
from automotive_cosim.traffic.sumo import LibSumo, load_library
from automotive_cosim.traffic.world import World


class Watcher(Protocol):
    """Something that follows the traffic from now on; a copy of the process has its own."""

    def after_step(self) -> None:
        """Called after every step, once the driver has had its turn."""
        ...


W = TypeVar("W", bound=Watcher)


class Running:
    """The traffic, and the equipped cars in it."""

    def __init__(self, world: World, beat: Callable[[], None] = lambda: None) -> None:
        """Nobody watches yet.

        Args:
            world: the traffic, warmed up.
            beat: gives a sign of life, called after every step."""
        self.world = world
        self.sumo: LibSumo = load_library()
        """SUMO's own library."""
        self.convoy = Convoy(world)
        """The equipped cars in it."""
        self.watchers: list[Watcher] = []
        self.done: tuple[float, float] | None = None
        """How much of a long call is done, and of how much, if it says so."""
        self._beat = beat

    @property
    def drive(self) -> EgoLoop | None:
        """The ego's drive; None before it has departed."""
        return self.convoy.first

    def watcher(self, kind: type[W]) -> W:
        """The watcher of that kind. Raises LookupError: nobody has begun to watch so."""
        for each in self.watchers:
            if isinstance(each, kind):
                return each
        raise LookupError(f"the traffic has no {kind.__name__}")

    def step(self) -> None:
        """One step of the traffic without its ego."""
        self.world.step()
        self.after_step()

    def after_step(self) -> None:
        for each in self.watchers:
            each.after_step()
        self._beat()


def seen(running: Running, cars: Sequence[str]) -> RoadSnapshot:
    """Those of some vehicles that are on the road now."""
    sumo, here = running.sumo, frozenset(running.sumo.vehicle_ids())
    of, found = sumo.vehicle, [car for car in cars if car in here]
    sizes = ((of.getVehicleClass(car), of.getLength(car), of.getWidth(car)) for car in found)
    return RoadSnapshot(
        sumo.time(),
        tuple(
            make_seen(car, *size, *sumo.position(car), sumo.angle(car), sumo.speed(car), of.getSignals(car))
            for car, size in zip(found, sizes, strict=True)
        ),
        (),
    )


def react_anew(running: Running, seed: int) -> None:
    """The ego's driver, who was asked for nothing so far, will react by another seed than the plan's."""
    assert running.drive is not None
    running.drive.react_anew(seed)


def fingerprint(running: Running) -> str:
    """Of all that decides how the traffic goes on, as far as SUMO tells: two drives that have been the same so far,
    and have the same one, stay the same as long as nobody asks for anything else."""
    sumo, drive = running.sumo, running.drive
    cars = [(each, sumo.position(each), sumo.speed(each)) for each in sumo.vehicle_ids()]
    lights = [(each, sumo.light_state(each)) for each in sumo.light_ids()]
    return sha256(repr((cars, lights, drive and drive.driver_state)).encode()).hexdigest()
