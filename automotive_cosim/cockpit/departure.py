"""Puts back what a drive uses up, warms or plays, as if the car had just departed where it is now.

How far the car had to go to a task's situation says nothing about the task. So that it does not show either, both
halves of a pair are handed over with the clock, the battery, the trip computer, the music, the air and the tyres of
their departure. Calls that were missed on the way are forgotten, messages have come just now.
"""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from typing import Any

from automotive_cosim.cockpit.notices import TYRES
from automotive_cosim.cockpit.sensing import sense
from automotive_cosim.cockpit.signals import ENERGY, MEDIA, SEAT, Signal
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Surroundings

USED: tuple[Signal[Any], ...] = (ENERGY.LEVEL, ENERGY.RANGE, MEDIA.PLAYED, MEDIA.TRACK, MEDIA.ARTIST)
BODIES: tuple[Signal[Any], ...] = (*TYRES, SEAT.DRIVER_TEMPERATURE, SEAT.PASSENGER_TEMPERATURE)


def put_back(state: State, departed: State, surroundings: Surroundings, way: timedelta, *, with_air: bool) -> None:
    """Puts a state back and senses the surroundings anew.

    Args:
        state: changed in place.
        departed: the same cockpit's at departure.
        surroundings: the present ones, at the departure's time of day.
        way: how much earlier that is.
        with_air: whether air, glass, seats and tyres are put back too.
    """
    for signal in (*USED, *(BODIES if with_air else ())):
        state.signals[signal] = departed.signals[signal]
    if with_air:
        state.cabin, state.tyres = departed.cabin, departed.tyres
    departed_s, state.outside = state.departed_s, None  # the trip computer starts anew
    if state.heard is not None:
        state.heard = replace(state.heard, local_time=state.heard.local_time - way)
    sense(state, surroundings, 0.0)
    state.departed_s = departed_s  # what is still to arrive arrives when it would have
    for data in state.apps:
        data.put_back(state, departed)
    state.notices = tuple(
        replace(notice, clock=state.clock) for notice in state.notices if notice.icon is not Icon.CALL_MISSED
    )
