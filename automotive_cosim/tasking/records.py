"""Checks of records in the apps' data: several messages, a message with a figure, one place of a list."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.apps.vehicle.state import REMEMBERED
from automotive_cosim.cosim.moment import Moment

NUMBER = re.compile(r"(\d+):(\d\d)|\d+(?:\.\d+)?")
"""A time of day or a number."""


@dataclass(frozen=True, slots=True)
class EnteredAll:
    """Exactly these entries were added to a list (messages sent, calls, saved places), in this order or in any."""

    key: str
    entries: tuple[Any, ...]
    in_order: bool = False

    @property
    def writes(self) -> frozenset[str]:
        """The list's key."""
        return frozenset({self.key})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether exactly these were added since the start."""
        added = list(now.commands[self.key][len(start.commands[self.key]) :])
        if self.in_order or len(added) != len(self.entries):
            return added == list(self.entries)
        return all(added.count(entry) == self.entries.count(entry) for entry in self.entries)

    def __str__(self) -> str:
        return f"added to {self.key}{', in this order' if self.in_order else ''}: {self.entries!r}"


@dataclass(frozen=True, slots=True)
class AppDataIncludes:
    """A list of the apps' data (messages read) contains all of these entries, whatever else it contains."""

    key: str
    entries: tuple[Any, ...]

    @property
    def writes(self) -> frozenset[str]:
        """The list's key."""
        return frozenset({self.key})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return all(entry in now.commands[self.key] for entry in self.entries)

    def __str__(self) -> str:
        return f"{' and '.join(map(repr, self.entries))} among {self.key}"


@dataclass(frozen=True, slots=True)
class SaysFigure:
    """Exactly one message was sent, to that person, with these words and one figure, to a tolerance."""

    to: str
    words: str
    """What the message has to contain besides, such as a unit."""
    figure: float
    """A number; for a time of day the minutes since midnight."""
    tolerance: float

    @property
    def writes(self) -> frozenset[str]:
        """The key of the messages."""
        return frozenset({"messages.sent"})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether that message is the only one since the start."""
        key = "messages.sent"
        added = now.commands[key][len(start.commands[key]) :]
        if len(added) != 1 or added[0]["to"] != self.to or self.words not in added[0]["text"]:
            return False
        said = NUMBER.search(added[0]["text"])
        return said is not None and abs(_value(said) - self.figure) <= self.tolerance + 1e-9

    def __str__(self) -> str:
        return f"a message to {self.to} with {self.figure} (to {self.tolerance:g}) and {self.words!r}"


@dataclass(frozen=True, slots=True)
class AppDataAt:
    """One place of a list in the apps' data has a value; the others are unchanged."""

    key: str
    place: int
    value: Any

    @property
    def writes(self) -> frozenset[str]:
        """The list's key."""
        return frozenset({self.key})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether that place, and no other, is as wanted."""
        wanted = list(start.commands[self.key])
        value = list(self.value) if isinstance(self.value, tuple) else self.value
        wanted[self.place] = {**wanted[self.place], **value} if isinstance(value, Mapping) else value
        return bool(now.commands[self.key] == wanted)

    def __str__(self) -> str:
        return f"entry {self.place + 1} of {self.key} is {self.value!r}"


@dataclass(frozen=True, slots=True)
class AppDataWithout:
    """One place of a list in the apps' data is gone; the others are unchanged."""

    key: str
    place: int

    @property
    def writes(self) -> frozenset[str]:
        """The list's key."""
        return frozenset({self.key})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether that place, and no other, is gone."""
        wanted = list(start.commands[self.key])
        del wanted[self.place]
        return bool(now.commands[self.key] == wanted)

    def __str__(self) -> str:
        return f"entry {self.place + 1} of {self.key} is gone"


@dataclass(frozen=True, slots=True)
class SeatAsStored:
    """Seat and mirrors stand as a memory place has them since the start."""

    slot: int
    """The place, from 1."""

    @property
    def writes(self) -> frozenset[str]:
        """The paths of seat and mirrors."""
        return frozenset(signal.path for signal in REMEMBERED)

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether every one of them stands there."""
        stored = start.commands["seat.memory"][self.slot - 1]
        return all(now.signals[signal.path] == value for signal, value in zip(REMEMBERED, stored, strict=True))

    def __str__(self) -> str:
        return f"seat and mirrors as stored in place {self.slot}"


def _value(said: re.Match[str]) -> float:
    hours, minutes = said.groups()
    return float(said[0]) if hours is None else 60.0 * int(hours) + int(minutes)
