"""Parking: the space, how long, and the tickets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import timedelta
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import choices, content, heading, note, rows, title
from automotive_cosim.cockpit.commands import Put, SimpleCommand
from automotive_cosim.cockpit.flow import card, fill, panels, stack
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.pois import PRICES, ZONES
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Label, Look, Row, Widget
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import Quantity, say
from automotive_cosim.formats.annotations import OneOf


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

    zone: str = ""
    """Empty until it is chosen, as the car does not know it."""
    minutes: int = 0
    """0 until it is chosen."""
    tickets: tuple[Ticket, ...] = ()

    @property
    def unset(self) -> str:
        """What is still to be chosen; empty if nothing is."""
        if not self.zone:
            return say("Choose a zone first")
        return "" if self.minutes else say("Choose a duration first")

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


def _pay(state: State) -> Feedback:
    """Pay for the parking space as it is set."""
    now = state.of(Parking)
    if not state.signals[LINK.ONLINE] or state.outside is None:
        return state.refused(OFFLINE)
    if now.unset:
        return state.refused(now.unset)
    until = state.clock_at(state.outside.local_time + timedelta(minutes=now.minutes))
    ticket = Ticket(now.zone, now.minutes, now.price, until)
    state.keep(replace(now, tickets=(*now.tickets, ticket)))
    price = Quantity(f"{ticket.price:.2f}")
    return state.said(say("Paid {price}: {zone} until {time}", price=price, zone=now.zone, time=until), Icon.TICKET)


PAY = SimpleCommand(_pay, ("payments",))


STAYS = (30, 60, 120, 240)
"""Parking times that can be paid for, in minutes."""


def parking(state: State) -> tuple[Widget, ...]:
    """Pays for a parking space."""
    now = state.of(Parking)
    zones = [
        (
            zone[-1].lower(),
            zone,
            None,
            zone == now.zone,
            Put(replace(now, zone=zone), say("{zone} is set", zone=zone)),
        )
        for zone in ZONES
    ]
    stays = [
        (
            str(stay),
            f"{stay} min" if stay < 60 else f"{stay // 60} h",
            None,
            stay == now.minutes,
            Put(replace(now, minutes=stay), say("{minutes} minutes are set", minutes=stay)),
        )
        for stay in STAYS
    ]
    price = now.unset or say("Price {price}", price=Quantity(f"{now.price:.2f}"))
    if now.zone and not now.minutes:
        price = say("{price} an hour", price=Quantity(f"{PRICES[now.zone]:.2f}"))
    pay = Button(
        key="parking.pay",
        text=say("Pay now"),
        icon=Icon.TICKET,
        icon_size=34,
        style=Type.TITLE,
        look=Look.ACCENT,
        on_tap=PAY,
        disabled=now.unset if state.signals[LINK.ONLINE] else OFFLINE,
    )
    order = card(
        title(Icon.TICKET, say("Pay for parking")),
        24,
        heading(say("Zone")),
        8,
        (72, choices("parking.zone", zones)),
        24,
        heading(say("Duration")),
        8,
        (72, choices("parking.time", stays)),
        24,
        (56, Label(key="parking.price", text=price, style=Type.HEADLINE)),
        REST,
        (88, pay),
        padding=(28, 20),
    )

    def ticket(index: int, each: Ticket) -> Row:
        return Row(
            key=f"parking.ticket.{index}",
            text=say("{zone} until {time}", zone=each.zone, time=each.until),
            detail=say("Paid {price}", price=Quantity(f"{each.price:.2f}")),
            icon=Icon.TICKET,
        )

    paid = rows("parking.tickets", say("Tickets"), state, now.tickets[::-1], ticket, height=68)
    listed = paid if now.tickets else note("parking.tickets.empty", say("No tickets yet"))
    return fill(content(state), panels((700, order), stack((32, heading(say("Tickets"))), 12, (REST, listed))))


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
    return PAY


APP = App(
    name="parking",
    title=say("Parking"),
    icon=Icon.TICKET,
    order=12,
    where=Where.STORE,
    about=say("Pay for a parking space from the car"),
    functions=(set_parking_zone, set_parking_time, pay_parking),
    pages={"parking": AppPage(parking)},
    starts=lambda state, rng: (Parking(),),
)
