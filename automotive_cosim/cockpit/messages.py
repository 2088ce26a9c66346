"""Messages of touched widgets. A screen only defines them; ``cockpit.Cockpit`` performs them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.contracts import Alert, Answer, RoadRequest

BACKSPACE = "\b"
"""The letter that deletes one."""


@dataclass(frozen=True, slots=True)
class Show:
    """Go to a screen, optionally to one item on it."""

    screen: str
    item: str = ""


@dataclass(frozen=True, slots=True)
class Back:
    """Return to the previous screen."""


@dataclass(frozen=True, slots=True)
class Pick:
    """Show another part of a screen: select one of its choices."""

    key: str
    value: str


@dataclass(frozen=True, slots=True)
class Set:
    """Command a signal."""

    signal: Signal[Any]
    value: Any


@dataclass(frozen=True, slots=True)
class SetAll:
    """Command several signals at once."""

    values: tuple[tuple[Signal[Any], Any], ...]
    said: str


Book = Literal["draft", "navigation", "listening", "phone", "desk", "notices"]
"""Parts of the state that are app data."""


@dataclass(frozen=True, slots=True)
class Put:
    """Change app data: the new value, and the notice about it."""

    book: Book
    value: Any
    said: str


@dataclass(frozen=True, slots=True)
class WarnDriver:
    """Give an alert; without one, the prepared alert."""

    alert: Alert | None = None


@dataclass(frozen=True, slots=True)
class AskSlowDown:
    """Ask the driver to go no faster than the advised speed, or the limit sign."""


@dataclass(frozen=True, slots=True)
class AskPullOver:
    """Ask the driver to stop at the side."""


@dataclass(frozen=True, slots=True)
class Ask:
    """Make a request to the driver or the router, as a safety call does."""

    request: RoadRequest


@dataclass(frozen=True, slots=True)
class CallEmergency:
    """Call the emergency services."""


@dataclass(frozen=True, slots=True)
class AskDriver:
    """Ask the driver something, by voice."""

    text: str


@dataclass(frozen=True, slots=True)
class Guide:
    """Request a route to a place or street; empty keeps the destination and looks for a faster route."""

    place: str
    onward: str = ""
    """The next destination afterwards."""


@dataclass(frozen=True, slots=True)
class Take:
    """Request a route along these edges to the same destination."""

    edges: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Focus:
    """Focus a text field and open the keyboard; empty closes the keyboard."""

    field: str


@dataclass(frozen=True, slots=True)
class Key:
    """Enter letters into a text field by a key; a backspace deletes one."""

    field: str
    letters: str


@dataclass(frozen=True, slots=True)
class Enter:
    """Press enter in a text field."""

    then: Any
    """The message to send; None while nothing matches the typed text."""


@dataclass(frozen=True, slots=True)
class Zoom:
    """Move the map closer (negative) or away."""

    by: int


@dataclass(frozen=True, slots=True)
class Pan:
    """Pan the map by a number of logical pixels."""

    right: float
    down: float


@dataclass(frozen=True, slots=True)
class Follow:
    """Let the map follow the car, turning with it or with north up."""

    north_up: bool


@dataclass(frozen=True, slots=True)
class Skip:
    """Play another entry of the queue."""

    by: int


@dataclass(frozen=True, slots=True)
class Play:
    """Play an entry, of a playlist or of all there is."""

    uri: str
    playlist: str = ""


@dataclass(frozen=True, slots=True)
class Dial:
    """Call somebody: a contact's name or a number."""

    who: str


@dataclass(frozen=True, slots=True)
class HangUp:
    """End the call."""


@dataclass(frozen=True, slots=True)
class TakeCall:
    """Answer the ringing call."""


@dataclass(frozen=True, slots=True)
class DeclineCall:
    """Decline the ringing call."""


@dataclass(frozen=True, slots=True)
class SendReply:
    """Send somebody a message."""

    to: str
    text: str


@dataclass(frozen=True, slots=True)
class Read:
    """Have somebody's messages read out, or open them where that is allowed."""

    who: str


@dataclass(frozen=True, slots=True)
class Pay:
    """Pay for the parking space as it is set."""


@dataclass(frozen=True, slots=True)
class Drive:
    """Switch to a driver's profile."""

    profile: str


@dataclass(frozen=True, slots=True)
class Record:
    """Begin or end a spoken memo."""


@dataclass(frozen=True, slots=True)
class ResetTrip:
    """Count distance and time from here."""

    meter: Literal["a", "b"] = "a"


@dataclass(frozen=True, slots=True)
class Honk:
    """Sound the horn."""


@dataclass(frozen=True, slots=True)
class Wash:
    """Wash the windshield."""


Message = (
    Show
    | Back
    | Pick
    | Set
    | SetAll
    | Put
    | WarnDriver
    | AskSlowDown
    | AskPullOver
    | Ask
    | CallEmergency
    | AskDriver
    | Guide
    | Take
    | Focus
    | Key
    | Enter
    | Zoom
    | Pan
    | Follow
    | Skip
    | Play
    | Dial
    | HangUp
    | TakeCall
    | DeclineCall
    | SendReply
    | Read
    | Pay
    | Record
    | Drive
    | ResetTrip
    | Honk
    | Wash
)


@dataclass(frozen=True, slots=True)
class Deed:
    """A message that the car has carried out."""

    time_s: float
    """Simulation time."""
    message: Message
    aims: frozenset[str]
    """The commands (``State.commands``) that it was given for, without what the car couples to them."""
    changes: Mapping[str, Any] = field(default_factory=dict)
    """For ``Put``, the fields of the app data that it changed."""
    answers: tuple[tuple[RoadRequest, Answer], ...] = ()
    """What it asked of the road, and the replies."""
