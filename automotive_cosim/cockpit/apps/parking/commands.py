"""The command of parking."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import timedelta

from automotive_cosim.cockpit.apps.parking.state import Parking, Ticket
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import Quantity, say

OFFLINE = say("Paying needs a connection")


@dataclass(frozen=True, slots=True)
class Pay(Command):
    """Pay for the parking space as it is set."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"payments"})

    def perform(self, state: State) -> Feedback:
        """The ticket, if the car is online."""
        if not state.signals[LINK.ONLINE] or state.outside is None:
            return state.refused(OFFLINE)
        now = state.of(Parking)
        until = state.clock_at(state.outside.local_time + timedelta(minutes=now.minutes))
        ticket = Ticket(now.zone, now.minutes, now.price, until)
        state.keep(replace(now, tickets=(*now.tickets, ticket)))
        price = Quantity(f"{ticket.price:.2f}")
        return state.said(
            say("Paid {price}: {zone} until {time}", price=price, zone=now.zone, time=until), Icon.TICKET
        )
