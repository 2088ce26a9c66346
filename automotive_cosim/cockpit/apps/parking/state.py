"""Parking spaces and what was paid for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.state import AppData
from automotive_cosim.contracts.text import say

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
