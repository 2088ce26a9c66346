"""What people aboard ask an agent for on a drive."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from annotated_types import Ge


class ErrandKind(StrEnum):
    """What an errand is about."""

    CLIMATE = "climate"
    """A temperature of a front seat."""
    MESSAGE = "message"
    """The reply to a message that has just come."""
    CALL = "call"
    """A call that rings, to be declined."""
    PLACE = "place"
    """Another destination."""


@dataclass(frozen=True, slots=True)
class Errand:
    """Something that somebody aboard asks for."""

    kind: ErrandKind
    at_s: Annotated[float, Ge(0)]
    """When it is said: in a script in seconds after departure, in a moment in simulation time."""
    about: str
    """The seat (``driver`` or ``passenger``), the person that wrote or calls, or the place."""
    wanted: str = ""
    """The temperature in degrees Celsius, or the text of the reply."""
    is_declined: bool = False
    """Whether the driver says no to it at once: then nothing is to be done."""
