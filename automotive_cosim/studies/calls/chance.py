"""Fresh random numbers for a forked simulation: another future of the same instant.

``fresh_of`` proves at the start, in copies that may die of it, that equal new seeds (``traffic.chance``) give equal
futures and others do not; where they do not, every other car aims at a slightly different speed instead.
"""

from __future__ import annotations

from contextlib import closing
from enum import StrEnum
from weakref import WeakKeyDictionary
from zlib import crc32

from automotive_cosim.errors import SetupError, TrafficError
from automotive_cosim.traffic.chance import Generators, jitter
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import LibSumo

PROOF_S = 30.0
"""Simulated time over which the copies of the proof are compared."""
SeedTrace = tuple[tuple[float, ...], int]
"""The first number of every generator, and a fingerprint of the traffic after ``PROOF_S``."""


class Fresh(StrEnum):
    """How the futures of one decision got random numbers of their own."""

    SEED = "seed"
    """All random numbers were seeded anew."""
    SEED_UNSEEN = "seed, without a visible effect"
    """The same, but the traffic of the proof came out equal: it leaves nothing to chance, or was empty."""
    JITTER = "jitter"
    """Every other car's speed factor was changed by ``JITTER`` times a normal variate."""

    @classmethod
    def proven(cls, first: SeedTrace, again: SeedTrace, other: SeedTrace) -> Fresh:
        """What three copies prove, of which the first two had the same seed."""
        are_all_new = all(one != two for one, two in zip(first[0], other[0], strict=True))
        if first != again or not are_all_new:
            return cls.JITTER
        return cls.SEED_UNSEEN if first[1] == other[1] else cls.SEED


_PROVEN: WeakKeyDictionary[Forked, Fresh] = WeakKeyDictionary()


def fresh_of(simulation: Forked) -> Fresh:
    """How copies of warm traffic get random numbers of their own, proven at the first call."""
    if simulation not in _PROVEN:
        try:
            _PROVEN[simulation] = Fresh.proven(*(_sampled(simulation, seed) for seed in (1, 1, 2)))
        except (SetupError, TrafficError):  # the copy may have died of it
            _PROVEN[simulation] = Fresh.JITTER
    return _PROVEN[simulation]


def _sampled(simulation: Forked, seed: int) -> SeedTrace:
    with closing(simulation.copy()) as copy:
        return copy.call(prove, seed)


def prove(running: Running, seed: int) -> SeedTrace:
    """What a seed makes of this traffic, which cannot be used for anything else afterwards."""
    generators = Generators(running.sumo)
    generators.seed(seed)
    drawn = generators.draw()
    for _ in range(round(PROOF_S / running.world.step_s)):
        running.step()
    return drawn, fingerprint(running.sumo)


def renew(running: Running, fresh: Fresh, seed: int) -> None:
    """Gives everything from here on other random numbers; the same seed gives the same ones.

    Raises SetupError: the library does not export its generators; not for ``JITTER``."""
    sumo = running.sumo
    if fresh is not Fresh.JITTER:
        Generators(sumo).seed(seed)
        return
    jitter(sumo, seed)


def fingerprint(sumo: LibSumo) -> int:
    """A number for where every vehicle is and how fast; equal for equal traffic."""
    traffic = [(each, sumo.position(each), sumo.speed(each)) for each in sorted(sumo.vehicle_ids())]
    return crc32(repr(traffic).encode())
