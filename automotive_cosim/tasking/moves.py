"""Moves: the steps of a reference solution, by public actions alone."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.contracts import Action, AlertKind, Severity


@dataclass(frozen=True, slots=True)
class Open:
    """Opens a screen by its name."""

    app: str


@dataclass(frozen=True, slots=True)
class Tap:
    """Taps an element, scrolling to it if necessary: the one of this widget's key, the first clickable one with
    this text, or the one with both."""

    key: str = ""
    times: int = 1
    text: str = ""
    """Its text, the first line of it, or its description."""


@dataclass(frozen=True, slots=True)
class TapUntil:
    """Taps an element until another one has this text, as one presses plus until the number is right."""

    key: str
    shown: str
    """Key of the widget that shows the value."""
    text: str
    at_most: int = 40


@dataclass(frozen=True, slots=True)
class Slide:
    """Taps a slider at the position of a value."""

    key: str
    value: float
    low: float = 0.0
    high: float = 100.0


@dataclass(frozen=True, slots=True)
class TypeText:
    """Types into a text field."""

    key: str
    text: str
    enter: bool = False
    """Whether to press enter afterwards."""


@dataclass(frozen=True, slots=True)
class Warn:
    """Alerts the driver through the safety call."""

    kind: AlertKind
    severity: Severity = Severity.WARNING
    speed_kmh: float | None = None


@dataclass(frozen=True, slots=True)
class Consult:
    """Asks the driver."""

    text: str


@dataclass(frozen=True, slots=True)
class Inform:
    """Tells the driver something, in an answer."""

    text: str


@dataclass(frozen=True, slots=True)
class Hear:
    """Waits until the driver has said something since the hand-over."""

    text: str
    """What it is, as a part of it."""
    at_most_s: int = 60


@dataclass(frozen=True, slots=True)
class Do:
    """Any action without an element: back, wait, a safety call."""

    action: Action


Move = Open | Tap | TapUntil | Slide | TypeText | Warn | Consult | Inform | Hear | Do
