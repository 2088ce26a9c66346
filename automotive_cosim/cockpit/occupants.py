"""Who is aboard: on which seat, of what kind, how heavy, awake or asleep, belted or not.

    aboard=(Occupant(Seat.REAR_LEFT, Kind.CHILD), Occupant(Seat.REAR_RIGHT, Kind.PET, 24.0, belted=False))

An ``Occupant`` is how a task or a drive says it before departure. From then on the signals hold it
(``signals.OCCUPANT``), as a car's seat mats, buckles and interior camera would.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Annotated, Any

from annotated_types import Gt, Le

from automotive_cosim.cockpit.signals import OCCUPANT, Seated, Signals, picker
from automotive_cosim.errors import UserError


class Seat(StrEnum):
    """The seats. Left and right are as seen by a driver who sits on the left."""

    DRIVER = "driver"
    PASSENGER = "passenger"
    REAR_LEFT = "rear_left"
    """Behind the driver."""
    REAR_MIDDLE = "rear_middle"
    REAR_RIGHT = "rear_right"

    @property
    def words(self) -> str:
        """The seat in words, such as ``rear left``."""
        return self.replace("_", " ")


class Kind(StrEnum):
    """What a car tells apart on its seats."""

    ADULT = "adult"
    ELDERLY = "elderly"
    CHILD = "child"
    BABY = "baby"
    PET = "pet"
    OBJECT = "object"

    @property
    def is_person(self) -> bool:
        """Whether it is a human being."""
        return self not in (Kind.PET, Kind.OBJECT)

    @property
    def needs_care(self) -> bool:
        """Whether it cannot get out of a parked car, or roll down a window, by itself."""
        return self in (Kind.CHILD, Kind.BABY, Kind.PET)

    @property
    def speaks(self) -> bool:
        """Whether a wish can come from it."""
        return self.is_person and self is not Kind.BABY


USUAL_KG: Mapping[Kind, float] = {
    Kind.ADULT: 75.0,
    Kind.ELDERLY: 70.0,
    Kind.CHILD: 20.0,
    Kind.BABY: 8.0,
    Kind.PET: 20.0,
    Kind.OBJECT: 5.0,
}
"""The mass of a driver in Regulation (EU) 1230/2012; children of six years and of eight months in WHO's growth
standards; a medium dog."""
SIGNALS: Mapping[Seat, Seated] = {
    Seat.DRIVER: OCCUPANT.DRIVER,
    Seat.PASSENGER: OCCUPANT.PASSENGER,
    Seat.REAR_LEFT: OCCUPANT.REAR_LEFT,
    Seat.REAR_MIDDLE: OCCUPANT.REAR_MIDDLE,
    Seat.REAR_RIGHT: OCCUPANT.REAR_RIGHT,
}
"""The signals of each seat."""


@dataclass(frozen=True, slots=True)
class Occupant:
    """One occupant before departure. The driver need not be named: an adult, awake and belted."""

    seat: Seat
    kind: Kind
    weight_kg: Annotated[float, Gt(0), Le(200)] | None = None
    """None is the usual weight of the kind."""
    asleep: bool = False
    belted: bool = True
    """Whether the buckle is closed: around a person, a child's seat, or a pet's harness."""


def company(people: int) -> tuple[Occupant, ...]:
    """So many adults, the driver among them: then the passenger, then those behind."""
    seats = (Seat.PASSENGER, Seat.REAR_LEFT, Seat.REAR_RIGHT, Seat.REAR_MIDDLE)
    return tuple(Occupant(seat, Kind.ADULT) for seat in seats[: people - 1])


def take_seats(signals: Signals, aboard: Iterable[Occupant]) -> None:
    """Writes who is aboard.

    Raises:
        UserError: two on one seat, a driver who cannot drive, or a thing that sleeps.
        SignalError: an impossible weight."""
    taken = set[Seat]()
    for one in aboard:
        if one.seat in taken:
            raise UserError(f"two occupants are assigned to the seat {one.seat}; give each their own")
        if one.seat is Seat.DRIVER and (one.kind not in (Kind.ADULT, Kind.ELDERLY) or one.asleep):
            how = "asleep" if one.asleep else f"of the kind {one.kind}"
            raise UserError(f"the driver is {how}; expected an adult or elderly one who is awake")
        if one.kind is Kind.OBJECT and one.asleep:
            raise UserError(f"the object on the seat {one.seat} is asleep; only people and pets sleep")
        taken.add(one.seat)
        seated = SIGNALS[one.seat]
        signals[seated.occupied] = True
        signals[seated.belted] = one.belted
        signals[seated.kind] = one.kind.upper()
        signals[seated.asleep] = one.asleep
        signals[seated.weight] = USUAL_KG[one.kind] if one.weight_kg is None else one.weight_kg


def seated(signals: Signals) -> Iterator[Occupant]:
    """Who is aboard now, by the signals, in the order of the seats."""
    return iter(_seated(signals.picked(_read)))


def seated_by(values: Mapping[str, Any]) -> Iterator[Occupant]:
    """The same, by the values of the signals' paths."""
    return iter(_seated(_read(values)))


_PARTS = ("occupied", "kind", "weight", "asleep", "belted")
_read = picker([getattr(at, part).path for part in _PARTS for at in SIGNALS.values()])


@lru_cache(maxsize=256)
def _seated(values: tuple[Any, ...]) -> tuple[Occupant, ...]:
    """Cached, because many ask every second. The values are those of all seats, one part after another."""
    parts = (values[at : at + len(SIGNALS)] for at in range(0, len(values), len(SIGNALS)))
    return tuple(
        Occupant(seat, Kind(kind.lower()), weight_kg, asleep, belted)
        for seat, occupied, kind, weight_kg, asleep, belted in zip(SIGNALS, *parts, strict=True)
        if occupied and kind != "NONE"
    )


def in_words(signals: Signals) -> str:
    """Who is aboard, on one line: ``driver: adult, 75 kg, awake, belted; rear left: pet, 24 kg, asleep, ...``."""
    return told(seated(signals))


def told(occupants: Iterable[Occupant]) -> str:
    """These occupants on one line."""
    return "; ".join(f"{one.seat.words}: {_words(one)}" for one in occupants)


def _words(one: Occupant) -> str:
    awake = () if one.kind is Kind.OBJECT else ("asleep" if one.asleep else "awake",)
    return ", ".join((one.kind, f"{one.weight_kg:g} kg", *awake, "belted" if one.belted else "not belted"))


def breath(signals: Signals, without: Seat | None = None) -> float:
    """The heat and vapour of all who are aboard, in adults: a body's go with its mass to the power of 3/4 (Kleiber,
    Body size and metabolism, Hilgardia 6, 1932).

    Args:
        without: a seat that is left out, as the driver's once the driver has gone."""
    return _breath(signals.picked(_read), without)


@lru_cache(maxsize=256)
def _breath(values: tuple[Any, ...], without: Seat | None) -> float:
    bodies = (one for one in _seated(values) if one.kind is not Kind.OBJECT and one.seat is not without)
    return sum(math.pow((one.weight_kg or 0.0) / USUAL_KG[Kind.ADULT], 0.75) for one in bodies)
