"""Parking: the space, how long, and the tickets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import timedelta
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.layout import REST, column, panes
from automotive_cosim.cockpit.parts import choices, content, heading, note, rows, title
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import AppData, Command, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Look, Row, Widget
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import Quantity, say
from automotive_cosim.formats.annotations import OneOf

ZONES = (say("Zone A"), say("Zone B"), say("Zone C"))
PRICES = {"Zone A": 4.0, "Zone B": 2.5, "Zone C": 1.2}
"""Price per hour."""


@dataclass(frozen=True, slots=True)
class Ticket:
    """A paid parking space; payments cannot be undone."""

    zone: str
    minutes: int
    price: float
    until: str


@dataclass(frozen=True, slots=True)
class Parking(AppData):
    """The space as it is set, and the tickets."""

    zone: str = ZONES[0]
    minutes: int = 60
    tickets: tuple[Ticket, ...] = ()

    @property
    def price(self) -> float:
        """Price of the space as it is set."""
        return round(PRICES[self.zone] * self.minutes / 60, 2)

    def commands(self) -> dict[str, Any]:
        """What is set, and what was paid."""
        return {
            "parking.zone": self.zone,
            "parking.minutes": self.minutes,
            "payments": [{"zone": t.zone, "minutes": t.minutes, "price": t.price} for t in self.tickets],
        }


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


STAYS = (30, 60, 120, 240)
"""Parking times that can be paid for, in minutes."""


def parking(state: State) -> tuple[Widget, ...]:
    """Pays for a parking space."""
    left, right = panes(content(state), 700, REST)
    head, _, zone_name, _, zones, _, stay_name, _, stays, _, total, _, pay = column(
        left.inset(28, 20), 40, 24, 28, 8, 72, 24, 28, 8, 72, 24, 56, REST, 88
    )
    now = state.of(Parking)
    tickets = tuple(reversed(now.tickets))
    return (
        Card(
            rect=left,
            children=(
                title(head, Icon.TICKET, say("Pay for parking")),
                heading(zone_name, say("Zone")),
                choices(
                    zones,
                    "parking.zone",
                    [
                        (
                            zone[-1].lower(),
                            zone,
                            None,
                            zone == now.zone,
                            Put(replace(now, zone=zone), say("{zone} is set", zone=zone)),
                        )
                        for zone in ZONES
                    ],
                ),
                heading(stay_name, say("Duration")),
                choices(
                    stays,
                    "parking.time",
                    [
                        (
                            str(stay),
                            f"{stay} min" if stay < 60 else f"{stay // 60} h",
                            None,
                            stay == now.minutes,
                            Put(replace(now, minutes=stay), say("{minutes} minutes are set", minutes=stay)),
                        )
                        for stay in STAYS
                    ],
                ),
                Label(
                    rect=total,
                    key="parking.price",
                    text=say("Price {price}", price=Quantity(f"{now.price:.2f}")),
                    style=Type.HEADLINE,
                ),
                Button(
                    rect=pay,
                    key="parking.pay",
                    text=say("Pay now"),
                    icon=Icon.TICKET,
                    icon_size=34,
                    style=Type.TITLE,
                    look=Look.ACCENT,
                    on_tap=Pay(),
                    disabled="" if state.signals[LINK.ONLINE] else OFFLINE,
                ),
            ),
        ),
        heading(right.top(32), say("Tickets")),
        rows(
            right.below(44),
            "parking.tickets",
            say("Tickets"),
            state,
            len(tickets),
            lambda index, cell: Row(
                rect=cell,
                key=f"parking.ticket.{index}",
                text=say("{zone} until {time}", zone=tickets[index].zone, time=tickets[index].until),
                detail=say("Paid {price}", price=Quantity(f"{tickets[index].price:.2f}")),
                icon=Icon.TICKET,
            ),
            height=68,
        )
        if tickets
        else note(right.below(44), "parking.tickets.empty", say("No tickets yet")),
    )


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


APP = App(
    name="parking",
    title=say("Parking"),
    icon=Icon.TICKET,
    order=12,
    where=Where.STORE,
    about=say("Pay for a parking space from the car"),
    functions=FUNCTIONS,
    pages={"parking": AppPage(parking)},
    starts=lambda state, rng: (Parking(),),
)
