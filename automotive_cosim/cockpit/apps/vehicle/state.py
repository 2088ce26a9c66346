"""What the driver did at the car, by horn and washer, and the seat positions that it remembers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from automotive_cosim.cockpit.commands import SimpleCommand
from automotive_cosim.cockpit.signals import BODY, DRIVE, MIRROR, SEAT, Signal, Signals
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say

SLOTS = 3
"""Number of seat memories."""
REMEMBERED: tuple[Signal[float], ...] = (
    SEAT.DRIVER_POSITION,
    SEAT.DRIVER_HEIGHT,
    SEAT.DRIVER_RECLINE,
    SEAT.DRIVER_LUMBAR,
    MIRROR.DRIVER_PAN,
    MIRROR.DRIVER_TILT,
    MIRROR.PASSENGER_PAN,
    MIRROR.PASSENGER_TILT,
)
"""Signals stored in a seat memory."""


@dataclass(frozen=True, slots=True)
class CarMemory(AppData):
    """Seat memories, and what cannot be taken back."""

    memory: tuple[tuple[float, ...], ...]
    """Values of ``REMEMBERED`` by memory slot."""
    horns: int = 0
    washes: int = 0

    def with_memory(self, slot: int, signals: Signals) -> CarMemory:
        """With the present seat position stored in a memory slot."""
        values = tuple(signals[signal] for signal in REMEMBERED)
        return replace(self, memory=(*self.memory[:slot], values, *self.memory[slot + 1 :]))

    def commands(self) -> dict[str, Any]:
        return {"seat.memory": [list(values) for values in self.memory], "horn": self.horns, "washer": self.washes}


def car(rng: np.random.Generator) -> CarMemory:
    """Draws the seat positions stored earlier."""
    return CarMemory(tuple(_seat(rng) for _ in range(SLOTS)))


DRIVEN: Mapping[Signal[float], tuple[float, float]] = {SEAT.DRIVER_RECLINE: (20, 28)}
"""Where people have a signal as they drive, least and most, unless that is the middle half of its range."""


def _seat(rng: np.random.Generator) -> tuple[float, ...]:
    def drawn(signal: Signal[float]) -> float:
        steps = round((signal.high - signal.low) / signal.step)
        low = signal.low + steps // 4 * signal.step
        low, high = DRIVEN.get(signal, (low, low + steps // 2 * signal.step))
        return low + int(rng.integers(round((high - low) / signal.step) + 1)) * signal.step

    return tuple(drawn(signal) for signal in REMEMBERED)


WASH_PCT = 2.0
"""Share of the washer's tank used per wash."""


def _honk(state: State) -> Feedback:
    """Sound the horn."""
    car = state.of(CarMemory)
    state.keep(replace(car, horns=car.horns + 1))
    state.signals[DRIVE.HORN] = True
    return Feedback(FeedbackCode.OK, say("the horn sounds"))


HONK = SimpleCommand(_honk, ("horn",))


def _wash(state: State) -> Feedback:
    """Wash the windshield."""
    left, car = state.signals[BODY.WASHER_FLUID], state.of(CarMemory)
    if left < WASH_PCT:
        return state.refused(say("The washer's tank is empty"))
    state.signals[BODY.WASHER_FLUID] = left - WASH_PCT
    state.keep(replace(car, washes=car.washes + 1))
    return state.said(say("The windshield is washed"), Icon.WASHER)


WASH = SimpleCommand(_wash, ("washer",))
