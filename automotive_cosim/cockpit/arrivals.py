"""Incoming calls and messages while the car drives, at times set before departure."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from automotive_cosim.cockpit.people import SAID, Directory
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


def timeline(arrivals: Iterable[Arrival], directory: Directory, rng: np.random.Generator) -> tuple[Arrival, ...]:
    """The arrivals in chronological order, with all callers and texts filled in.

    Args:
        arrivals: in any order.
        directory: the driver's contacts.
        rng: draws missing callers and texts, in the given order.

    Raises:
        UserError: an arrival has an unknown kind, an impossible time or an invalid text.
    """
    filled = []
    for given in arrivals:
        _check(given)
        who = given.who or directory.contacts[int(rng.integers(len(directory.contacts)))].name
        text = given.text
        if given.kind == "message" and not text:
            text = SAID[int(rng.integers(len(SAID)))]
        filled.append(replace(given, who=who, text=text))
    return tuple(sorted(filled, key=lambda arrival: arrival.at_s))


def _check(arrival: Arrival) -> None:
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
