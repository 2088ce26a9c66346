"""Functions of parking."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from automotive_cosim.cockpit.apps.parking.commands import Pay
from automotive_cosim.cockpit.apps.parking.screens import STAYS
from automotive_cosim.cockpit.apps.parking.state import ZONES, Parking
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.state import State
from automotive_cosim.formats.annotations import OneOf


@offered
def set_parking_zone(state: State, zone: Annotated[str, OneOf(ZONES), "The zone."]) -> CallMade:
    """Set the zone of the parking space, before it is paid for."""
    return Put(replace(state.of(Parking), zone=zone), "")


@offered
def set_parking_time(state: State, minutes: Annotated[int, OneOf(map(str, STAYS)), "How long."]) -> CallMade:
    """Set how long the parking space is paid for."""
    return Put(replace(state.of(Parking), minutes=minutes), "")


@offered
def pay_parking(state: State) -> CallMade:
    """Pay for the parking space as it is set. It cannot be taken back."""
    return Pay()


FUNCTIONS = (set_parking_zone, set_parking_time, pay_parking)
