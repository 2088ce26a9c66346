"""Fresh random numbers for a running simulation: another future of the same instant.

libsumo has no call for it, so all of SUMO's generators are seeded anew through symbols that the library exports:
the global one, those of the lanes (speeds, lane changes), of the reading of demand (speeds of cars to come) and of
equipment (who reroutes). The arrivals of flows by probability keep their own.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator

import numpy as np

from automotive_cosim.errors import SetupError
from automotive_cosim.traffic.sumo import EGO, LibSumo

JITTER = 0.001
"""Standard deviation of the factor on every other car's speed where SUMO cannot be seeded anew."""
SEED_RANGE = 2**31 - 1
_SEED = "_ZN10RandHelper8initRandEP7SumoRNGbi"
_DRAW = "_ZN10RandHelper4randEP7SumoRNG"
_LANES = "_ZN6MSLane6myRNGsE"
_SINGLE = ("_ZN16SUMORouteHandler12myParsingRNGE", "_ZN8MSDevice14myEquipmentRNGE")


class Generators:
    """SUMO's random number generators in this process."""

    def __init__(self, sumo: LibSumo) -> None:
        """Finds them. Raises SetupError: the library does not export them as expected."""
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


def renew(sumo: LibSumo, seed: int) -> None:
    """Gives the traffic from here on other random numbers; the same seed gives the same ones."""
    try:
        Generators(sumo).seed(seed)
    except SetupError:
        jitter(sumo, seed)


def jitter(sumo: LibSumo, seed: int) -> None:
    """Lets every other car aim at a slightly different speed."""
    rng = np.random.default_rng(seed)
    for vehicle in sorted(set(sumo.vehicle_ids()) - {EGO}):
        factor = sumo.vehicle.getSpeedFactor(vehicle) * (1 + JITTER * float(rng.normal()))
        sumo.set_speed_factor(vehicle, factor)


def _address(library: ctypes.CDLL, name: str) -> int:
    return ctypes.addressof(ctypes.c_char.in_dll(library, name))
