"""Fresh random numbers for a forked simulation: another future of the same instant.

libsumo has no call for it, so all of SUMO's generators are seeded anew through symbols that the library exports:
the global one, those of the lanes (speeds, lane changes), of the reading of demand (speeds of cars to come) and of
equipment (who reroutes). The arrivals of flows by probability keep their own. ``fresh_of`` proves at the start,
in copies that may die of it, that equal seeds give equal futures and others do not; where they do not, every other
car aims at a slightly different speed instead.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import closing
from enum import StrEnum
from weakref import WeakKeyDictionary
from zlib import crc32

import numpy as np

from automotive_cosim.errors import SetupError, TrafficError
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import EGO, LibSumo

JITTER = 0.001
"""Standard deviation of the factor on every other car's speed where SUMO cannot be seeded anew."""

PROOF_S = 30.0
"""Simulated time over which the copies of the proof are compared."""

SEED_RANGE = 2**31 - 1
_SEED = "_ZN10RandHelper8initRandEP7SumoRNGbi"
_DRAW = "_ZN10RandHelper4randEP7SumoRNG"
_LANES = "_ZN6MSLane6myRNGsE"
_SINGLE = ("_ZN16SUMORouteHandler12myParsingRNGE", "_ZN8MSDevice14myEquipmentRNGE")


class Fresh(StrEnum):
    """How the futures of one decision got random numbers of their own."""

    SEED = "seed"
    """All random numbers were seeded anew."""
    SEED_UNSEEN = "seed, without a visible effect"
    """The same, but the traffic of the proof came out equal: it leaves nothing to chance, or was empty."""
    JITTER = "jitter"
    """Every other car's speed factor was changed by ``JITTER`` times a normal variate."""

    @classmethod
    def proven(cls, first: Trial, again: Trial, other: Trial) -> Fresh:
        """What three copies prove, of which the first two had the same seed.

        Each has the first number of every generator and a fingerprint of the traffic after ``PROOF_S``.
        """
        are_all_new = all(one != two for one, two in zip(first[0], other[0], strict=True))
        if first != again or not are_all_new:
            return cls.JITTER
        return cls.SEED_UNSEEN if first[1] == other[1] else cls.SEED


Trial = tuple[tuple[float, ...], int]

_PROVEN: WeakKeyDictionary[Forked, Fresh] = WeakKeyDictionary()


class Generators:
    """SUMO's random number generators in this process."""

    def __init__(self, sumo: LibSumo) -> None:
        """Finds them.

        Raises:
            SetupError: the library does not export them as expected.
        """
        try:
            library = ctypes.CDLL(sumo.library_file)
            self._seed, self._draw = getattr(library, _SEED), getattr(library, _DRAW)
            self._single = [_address(library, name) for name in _SINGLE]
            lanes = (ctypes.c_size_t * 2).in_dll(library, _LANES)  # a std::vector: where it begins and ends
        except (OSError, AttributeError, ValueError) as error:
            raise SetupError(f"libsumo does not export its random number generators: {error}") from error
        self._seed.argtypes, self._seed.restype = (ctypes.c_void_p, ctypes.c_bool, ctypes.c_int), None
        self._draw.argtypes, self._draw.restype = (ctypes.c_void_p,), ctypes.c_double
        begin, end = lanes
        count = int(sumo.option("thread-rngs"))
        if count < 1 or end <= begin or (end - begin) % count:
            raise SetupError(f"libsumo does not have the {count} generators for lanes that it should have")
        self._lanes = range(begin, end, (end - begin) // count)

    def __iter__(self) -> Iterator[int | None]:
        """Their addresses; None is the global one."""
        yield None
        yield from self._single
        yield from self._lanes

    def seed(self, seed: int) -> None:
        """Seeds them all anew, each with a seed of its own."""
        seeds = np.random.default_rng(seed).integers(SEED_RANGE, size=len(self._single) + len(self._lanes) + 1)
        for generator, own in zip(self, seeds, strict=True):
            self._seed(generator, False, int(own))

    def draw(self) -> tuple[float, ...]:
        """The next number of each, 0 to 1."""
        return tuple(float(self._draw(generator)) for generator in self)


def fresh_of(simulation: Forked) -> Fresh:
    """How copies of warm traffic get random numbers of their own, proven at the first call."""
    if simulation not in _PROVEN:
        try:
            _PROVEN[simulation] = Fresh.proven(*(_sampled(simulation, seed) for seed in (1, 1, 2)))
        except (SetupError, TrafficError):  # the copy may have died of it
            _PROVEN[simulation] = Fresh.JITTER
    return _PROVEN[simulation]


def _sampled(simulation: Forked, seed: int) -> Trial:
    with closing(simulation.copy()) as copy:
        return copy.call(prove, seed)


def prove(running: Running, seed: int) -> Trial:
    """What a seed makes of this traffic, which cannot be used for anything else afterwards."""
    generators = Generators(running.sumo)
    generators.seed(seed)
    drawn = generators.draw()
    for _ in range(round(PROOF_S / running.world.step_s)):
        running.step()
    return drawn, fingerprint(running.sumo)


def renew(running: Running, fresh: Fresh, seed: int) -> None:
    """Gives everything from here on other random numbers; the same seed gives the same ones.

    Raises:
        SetupError: the library does not export its generators; not for ``JITTER``.
    """
    sumo = running.sumo
    if fresh is not Fresh.JITTER:
        Generators(sumo).seed(seed)
        return
    rng = np.random.default_rng(seed)
    for vehicle in sorted(set(sumo.vehicle_ids()) - {EGO}):
        factor = sumo.vehicle.getSpeedFactor(vehicle) * (1 + JITTER * float(rng.normal()))
        sumo.set_speed_factor(vehicle, factor)


def fingerprint(sumo: LibSumo) -> int:
    """A number for where every vehicle is and how fast; equal for equal traffic."""
    traffic = [(each, sumo.position(each), sumo.speed(each)) for each in sorted(sumo.vehicle_ids())]
    return crc32(repr(traffic).encode())


def _address(library: ctypes.CDLL, name: str) -> int:
    return ctypes.addressof(ctypes.c_char.in_dll(library, name))
