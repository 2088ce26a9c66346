"""Contacts, calls and messages, generated from a seed, the driver's use of them, and what arrives."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import Any

import numpy as np

from automotive_cosim.cockpit.apps.phone.arrivals import RINGS_S, Arrival, checked
from automotive_cosim.cockpit.language import said
from automotive_cosim.cockpit.photos import Photo
from automotive_cosim.cockpit.restrictions import ENTRIES_LIMIT, STRING_LIMIT
from automotive_cosim.cockpit.signals import CALL, LINK
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import counted, joined, say

CONTACTS = 60
TEMPLATES = (
    say("On my way"),
    say("I'm driving, I'll call later"),
    say("I'll be 10 minutes late"),
    say("Yes"),
    say("No"),
    say("Thank you"),
    say("Where are you?"),
    say("I've arrived"),
)
"""Replies that one tap sends."""
OWN = "own"
"""Sentence of a draft in own words."""


def in_own_words(text: str, language: str) -> str:
    """A message as it is sent: a line of ``STRING_LIMIT`` characters, or the reply that differs by signs alone."""
    line = " ".join(text.split())[:STRING_LIMIT]
    return next((reply for reply in TEMPLATES if _letters(said(reply, language)) == _letters(line)), line)


def _letters(text: str) -> str:
    return "".join(letter for letter in text.casefold() if letter.isalnum())


_FIRST = """Ada Bruno Carla Dario Elif Femi Greta Hugo Ines Jonas Kaya Lena Milo Nora Otis Petra Quinn Rosa Samir
    Tilda"""
_LAST = "Adler Bianchi Costa Duval Eklund Farrow Girard Holm Ibarra Jansen Keller Lindqvist Moreau Novak"
SAID = (
    "Are we still on for tonight?",
    "Can you bring bread and milk?",
    "The meeting starts half an hour earlier.",
    "I'm at the station, take your time.",
    "Call me when you have a minute.",
    "The parcel is with the neighbours.",
    "Happy birthday! See you on Sunday.",
    "Practice ends at six today.",
    "Could you pick me up on the way?",
    "The doctor moved the appointment to Thursday.",
    "I left the keys under the mat.",
    "Dinner is at eight, don't be late!",
)
"""Texts of messages."""


@dataclass(frozen=True, slots=True)
class Contact:
    """Somebody in the phone book."""

    name: str
    number: str


@dataclass(frozen=True, slots=True)
class PastCall:
    """One line of the call list."""

    who: str
    """Name, or the number of somebody unknown."""
    when: str
    way: str
    """``"in"``, ``"out"`` or ``"missed"``."""


EARLIER = ""
"""The time of a message that came a little before departure, until the clock is known."""
_EARLIER = timedelta(minutes=20)


@dataclass(frozen=True, slots=True)
class Thread:
    """Somebody's last message."""

    who: str
    when: str
    """Time of the last one."""
    lines: tuple[str, ...]
    unread: bool
    photo: Photo | None = None
    """A photo that came with it."""
    times: tuple[str, ...] = ()
    """Time of each line, where they did not come at once."""

    def aloud(self) -> str:
        """The lines as they are read out: each time before what came then."""
        if not self.times:
            return joined(" ", map(_sentence, self.lines))
        return joined(
            " ",
            (
                _sentence(line) if time == before else say("{name}: {value}", name=time, value=_sentence(line))
                for line, time, before in zip(self.lines, self.times, ("", *self.times), strict=False)
            ),
        )


def _sentence(text: str) -> str:
    """A message as it is read out before another: with its stop."""
    return text if text.endswith((".", "!", "?", "…", ":", "。", "！", "？", "：")) else f"{text}."


@dataclass(frozen=True, slots=True)
class Directory(AppData):
    """Data of the linked phone."""

    contacts: tuple[Contact, ...]
    """Sorted by name."""
    calls: tuple[PastCall, ...]
    """Past calls, the newest first."""
    threads: tuple[Thread, ...]
    favourites: tuple[str, ...]

    def names(self, state: State) -> Mapping[str, tuple[str, ...]]:
        """Contacts that the list shows even while driving, favourites, and senders of messages."""
        return {
            "contacts": tuple(contact.name for contact in self.contacts[:ENTRIES_LIMIT]),
            "favourite_contacts": self.favourites,
            "threads": tuple(thread.who for thread in self.threads),
            "unread": self.unread(state.of(Phone)),
        }

    def timeline(self, arrivals: Iterable[Arrival], rng: np.random.Generator) -> tuple[Arrival, ...]:
        """Arrivals in chronological order, with all callers and texts filled in.

        Args:
            arrivals: in any order.
            rng: draws missing callers and texts, in the given order.

        Raises UserError: an arrival has an unknown kind, an impossible time or an invalid text."""
        filled = []
        for given in arrivals:
            who = checked(given).who or self.contacts[int(rng.integers(len(self.contacts)))].name
            text = given.text
            if given.kind == "message" and not text:
                text = SAID[int(rng.integers(len(SAID)))]
            filled.append(replace(given, who=who, text=text))
        return tuple(sorted(filled, key=lambda arrival: arrival.at_s))

    def number(self, who: str) -> str:
        """Number of a contact; anything else is a number itself."""
        return next((contact.number for contact in self.contacts if contact.name == who), who)

    def written(self, phone: Phone) -> tuple[Thread, ...]:
        """All messages, including those of this drive, the newest first."""
        before = {thread.who: thread for thread in self.threads}
        new: dict[str, Thread] = {}
        for received in phone.inbox:
            thread = new.pop(received.who, None) or before.get(received.who)
            known = thread or Thread(received.who, received.when, (), unread=True)
            times = (*(known.times or (known.when,) * len(known.lines)), received.when)
            new[received.who] = replace(
                known, when=received.when, lines=(*known.lines, received.text), unread=True, times=times
            )
        return (*reversed(new.values()), *(thread for thread in self.threads if thread.who not in new))

    def thread(self, who: str, phone: Phone) -> Thread | None:
        """The messages of a contact."""
        return next((thread for thread in self.written(phone) if thread.who == who), None)

    @property
    def is_undated(self) -> bool:
        """Whether messages that came a little before departure have no time yet."""
        return any(thread.when == EARLIER for thread in self.threads)

    def dated(self, clock: str) -> Directory:
        """With that time for these messages."""
        dated = (replace(thread, when=clock) if thread.when == EARLIER else thread for thread in self.threads)
        return replace(self, threads=tuple(dated))

    def unread(self, phone: Phone) -> tuple[str, ...]:
        """Senders of unread messages."""
        return tuple(thread.who for thread in self.written(phone) if thread.unread and thread.who not in phone.read)


@dataclass(frozen=True, slots=True)
class OnCall:
    """The present call."""

    who: str
    since_s: float
    muted: bool = False


@dataclass(frozen=True, slots=True)
class Ringing:
    """The ringing call."""

    who: str
    since_s: float


@dataclass(frozen=True, slots=True)
class Received:
    """A message that came in on this drive."""

    who: str
    when: str
    text: str


@dataclass(frozen=True, slots=True)
class Sent:
    """A sent message, which cannot be undone."""

    to: str
    text: str
    time_s: float = 0.0
    """When it was sent."""
    own: bool = False
    """Whether it is in own words."""


@dataclass(frozen=True, slots=True)
class FigureDraft:
    """A message with a figure, or in own words, that is not sent yet."""

    sentence: str
    """Key of its sentence; or ``OWN``."""
    value: float | None = None
    """Its figure; None until it is set."""


@dataclass(frozen=True, slots=True)
class Phone(AppData):
    """The driver's use of the phone."""

    favourites: tuple[str, ...]
    do_not_disturb: bool = False
    read: tuple[str, ...] = ()
    """Senders whose messages were opened or read out."""
    sent: tuple[Sent, ...] = ()
    made: tuple[PastCall, ...] = ()
    """Calls of this drive, newest first."""
    on_call: OnCall | None = None
    ringing: Ringing | None = None
    taken: tuple[str, ...] = ()
    """Callers whose calls were answered."""
    declined: tuple[str, ...] = ()
    """Callers whose calls were declined."""
    inbox: tuple[Received, ...] = ()
    """Messages that came in on this drive."""
    draft: FigureDraft | None = None
    """The message with a figure that is being put together; it outlives calls and other screens."""
    called: tuple[str, ...] = ()
    """Whom the car has called on this drive, ``"emergency"`` for the emergency services."""
    expected: tuple[Arrival, ...] = ()
    """Calls and messages still to come."""

    def dialled(self, who: str, when: str, time_s: float) -> Phone:
        """A copy with an outgoing call."""
        logged = self.logged(PastCall(who, when, "out"))
        return replace(logged, on_call=OnCall(who, time_s), called=(*self.called, who))

    def logged(self, call: PastCall) -> Phone:
        """A copy with one more line in the call list."""
        return replace(self, made=(call, *self.made))

    def received_from(self, message: Received) -> Phone:
        """A copy with another message, which makes its sender's thread unread."""
        read = tuple(who for who in self.read if who != message.who)
        return replace(self, inbox=(*self.inbox, message), read=read)

    def replied(self, message: Sent) -> Phone:
        """With a sent message; what they wrote stays unread until it is opened."""
        return replace(self, sent=(*self.sent, message))

    def opened(self, who: str) -> Phone:
        """A copy with a contact's messages read."""
        return self if who in self.read else replace(self, read=(*self.read, who))

    def with_favourite(self, who: str, wanted: bool) -> Phone:
        """With or without that favourite, at the end of the list."""
        rest = tuple(known for known in self.favourites if known != who)
        return replace(self, favourites=(*rest, who) if wanted else rest)

    def commands(self) -> dict[str, Any]:
        return {
            "calls": list(self.called),
            "phone.favourites": list(self.favourites),
            "phone.do_not_disturb": self.do_not_disturb,
            "phone.on_call": "" if self.on_call is None else self.on_call.who,
            "phone.muted": self.on_call is not None and self.on_call.muted,
            "calls.answered": list(self.taken),
            "calls.declined": list(self.declined),
            "messages.read": sorted(self.read),
            "messages.sent": [{"to": sent.to, "text": sent.text} for sent in self.sent],
        }

    def received(self, state: State) -> None:
        """Handles arrivals, and ends the ringing of a call whose time is over or whose phone is unlinked."""
        linked = state.signals[LINK.BLUETOOTH]
        if state.outside is not None and state.of(Directory).is_undated:
            state.keep(state.of(Directory).dated(_earlier(state, state.outside.local_time)))
        if self.ringing is not None and (state.time_s - self.ringing.since_s >= RINGS_S or not linked):
            state.keep(replace(self, ringing=None))
            _missed(state, self.ringing.who)
        waiting = []
        for arrival in self.expected:
            if self._due_s(arrival, state.departed_s) > state.time_s:
                waiting.append(arrival)
            elif arrival.kind == "call":
                _ring(state, arrival, linked)
            elif linked and _covered(state):
                _take_in(state, arrival)
            else:
                waiting.append(arrival)
        if len(waiting) < len(self.expected):
            state.keep(replace(state.of(Phone), expected=tuple(waiting)))
        tell(state)

    def _due_s(self, arrival: Arrival, departed_s: float) -> float:
        """When it comes; never as long as it answers a message that has not been sent."""
        if not arrival.after:
            return departed_s + arrival.at_s
        sent_s = (sent.time_s for sent in self.sent if sent.to == arrival.after)
        return next(sent_s, math.inf) + arrival.at_s

    def put_back(self, state: State, departed: State) -> None:
        """Calls of the way are forgotten, messages have come just now."""
        received = tuple(replace(message, when=state.clock) for message in self.inbox)
        state.keep(replace(self, made=departed.of(Phone).made, inbox=received))


def tell(state: State) -> None:
    """The phone's state as signals."""
    phone, signals = state.of(Phone), state.signals
    signals[CALL.RINGING] = "" if phone.ringing is None else phone.ringing.who
    signals[CALL.PARTNER] = "" if phone.on_call is None else phone.on_call.who
    signals[CALL.UNREAD] = float(len(state.of(Directory).unread(phone)))


def _earlier(state: State, now: datetime) -> str:
    """A little before now; what came before midnight, yesterday."""
    then = now - _EARLIER
    clock = state.clock_at(then)
    return clock if then.date() == now.date() else say("Yesterday {time}", time=clock)


def _covered(state: State) -> bool:
    return state.outside is not None and state.outside.connectivity.online


def _ring(state: State, arrival: Arrival, linked: bool) -> None:
    """Rings, except under do not disturb or during a call. Without coverage or phone, no call comes."""
    if not (linked and _covered(state)):
        return
    phone = state.of(Phone)
    present = {each.who for each in (phone.ringing, phone.on_call) if each is not None}
    if arrival.who in present:
        return
    if phone.do_not_disturb or present:
        _missed(state, arrival.who)
    else:
        state.keep(replace(phone, ringing=Ringing(arrival.who, state.time_s)))


def _missed(state: State, who: str) -> None:
    phone = state.of(Phone).logged(PastCall(who, state.clock, "missed"))
    state.keep(phone)
    state.notify(
        say("Missed call from {who}", who=who), Icon.CALL_MISSED, seen=phone.do_not_disturb, opens=("contact", who)
    )


def _take_in(state: State, arrival: Arrival) -> None:
    phone = state.of(Phone).received_from(Received(arrival.who, state.clock, arrival.text))
    state.keep(phone)
    state.notify(
        say("New message from {who}", who=arrival.who),
        Icon.MESSAGE,
        seen=phone.do_not_disturb,
        opens=("thread", arrival.who),
    )


def directory(rng: np.random.Generator) -> Directory:
    """Draws names, numbers, calls and messages."""
    first, last = _FIRST.split(), _LAST.split()
    chosen = rng.choice(len(first) * len(last), CONTACTS, replace=False)
    names = sorted(f"{first[int(i) // len(last)]} {last[int(i) % len(last)]}" for i in chosen)
    numbers = rng.choice(10_000, CONTACTS, replace=False)
    contacts = tuple(
        Contact(name, f"555 {n // 100:02d} {n % 100:02d}") for name, n in zip(names, numbers, strict=True)
    )
    order = [names[int(i)] for i in rng.permutation(CONTACTS)]
    calls = tuple(
        PastCall(who, when, str(rng.choice(["in", "out", "missed"])))
        for who, when in zip(order[:12], _days(rng, 12), strict=True)
    )
    drawn = rng.permutation(len(SAID))
    threads = tuple(
        Thread(who, when, tuple(SAID[int(i)] for i in drawn[n::8][: 1 + n % 2]), bool(n < 3))
        for n, (who, when) in enumerate(zip(order[12:20], _days(rng, 8), strict=True))
    )
    return Directory(contacts, calls, threads, tuple(order[20:26]))


def _days(rng: np.random.Generator, count: int) -> list[str]:
    """Times of day, going back day by day."""
    times = [f"{rng.integers(8, 22):02d}:{rng.integers(60):02d}" for _ in range(count)]
    return [
        say("Yesterday {time}", time=time)
        if back < 2
        else counted("{n} day ago {time}", "{n} days ago {time}", back, time=time)
        for back, time in enumerate(times)
    ]
