"""Parking: the space, how long, and the tickets."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.parking.commands import OFFLINE, Pay
from automotive_cosim.cockpit.apps.parking.state import ZONES, Parking
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.layout import REST, column, panes
from automotive_cosim.cockpit.parts import choices, content, heading, note, rows, title
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Look, Row, Widget
from automotive_cosim.contracts.text import Quantity, say

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
