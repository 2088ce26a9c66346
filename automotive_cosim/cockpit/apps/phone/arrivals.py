"""Incoming calls and messages while the car drives, at times set before departure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from automotive_cosim.errors import UserError

RINGS_S = 30.0
"""A call rings this long: the longest no-reply timer of a mobile network (ETSI TS 122 082, 5 to 30 s)."""
TEXT_LIMIT = 160
"""Characters of a message: one SMS (ETSI TS 123 040)."""


@dataclass(frozen=True, slots=True)
class Arrival:
    """One call or message from outside."""

    kind: Literal["call", "message"]
    at_s: float
    """Simulated seconds after departure. Without a mobile network a message waits, and a call does not come."""
    who: str = ""
    """Name of a contact, or a number; empty takes a contact drawn from the seed."""
    text: str = ""
    """Text of a message; empty takes one drawn from the seed."""
    after: str = ""
    """Somebody who has to be written to first: it comes ``at_s`` after the first message to them, as an answer."""


def checked(arrival: Arrival) -> Arrival:
    """The arrival, if it is possible. Raises UserError: an unknown kind, an impossible time or an invalid text."""
    if arrival.kind not in ("call", "message"):
        raise UserError(f"an arrival is a {arrival.kind!r}; it must be 'call' or 'message'")
    if not (math.isfinite(arrival.at_s) and arrival.at_s >= 0):
        raise UserError(f"a {arrival.kind} arrives at {arrival.at_s} s; give seconds after departure, 0 or more")
    if arrival.text and arrival.kind == "call":
        raise UserError(f"a call has the text {arrival.text[:40]!r}; only a message has one")
    if len(arrival.text) > TEXT_LIMIT or not arrival.text.isprintable():
        raise UserError(
            f"a message's text is {arrival.text[:40]!r}; give at most {TEXT_LIMIT} printable characters in one line"
        )
    return arrival
