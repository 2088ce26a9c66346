"""Changes of the car that no finger makes, at times set before departure: a belt is opened, a tyre leaks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Ge

from automotive_cosim.cockpit.signals import CATALOGUE, named
from automotive_cosim.errors import SignalError, UserError
from automotive_cosim.formats.annotations import OneOf


@dataclass(frozen=True, slots=True)
class CarChange:
    """One change of a signal. A switch can be turned back afterwards, and what is measured goes on from there."""

    at_s: Annotated[float, Ge(0)]
    """Simulated seconds after departure, or after the car has been parked."""
    path: Annotated[str, OneOf(CATALOGUE, "signal")]
    """VSS path. A tyre's pressure is the one that it has when cold (``tyres.COLD_C``)."""
    value: bool | float | str
    over_s: Annotated[float, Ge(0)] = 0.0
    """How long a number takes to get there, evenly; 0 is at once."""
    once_standing: bool = False
    """Whether it waits from then on until the car stands, as what somebody does who has to get out."""
    once_parked: bool = False
    """Whether ``at_s`` counts from when the driver parks on the way, and not from departure."""


def schedule(changes: Iterable[CarChange]) -> tuple[CarChange, ...]:
    """The changes in chronological order. Raises UserError: a change is impossible."""
    return tuple(sorted(map(_checked, changes), key=lambda change: change.at_s))


def step(change: CarChange, now: Any, since_s: float, dt_s: float) -> Any:
    """The value after ``dt_s`` more seconds of a change that has begun, ``since_s`` seconds after its begin."""
    left_s = change.over_s - since_s
    if left_s <= 1e-9 or not isinstance(now, float):
        return change.value
    return now + (float(change.value) - now) * dt_s / (left_s + dt_s)


def _checked(change: CarChange) -> CarChange:
    if not all(math.isfinite(time_s) and time_s >= 0 for time_s in (change.at_s, change.over_s)):
        raise UserError(
            f"{change.path} changes at {change.at_s} s over {change.over_s} s; give seconds after departure, 0 or "
            "more"
        )
    value = named(change.path).check(change.value)
    if change.over_s and not isinstance(value, float):
        raise SignalError(f"{change.path} is to become {value!r} over {change.over_s:g} s; only a number can")
    return change
