"""What the driver brings into the car besides what is drawn: people, messages, appointments, memos, songs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import date, timedelta

import numpy as np

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.calendar import Agenda, Appointment
from automotive_cosim.cockpit.apps.media.state import Entry, Library
from automotive_cosim.cockpit.apps.memo import Memos
from automotive_cosim.cockpit.apps.phone.state import Contact, Directory, Phone, Thread
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.apps.trip import FROM_HERE, TripMeter, TripMeters
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.registry import apps_in
from automotive_cosim.cockpit.state import State
from automotive_cosim.errors import UnknownNameError, UserError


@dataclass(frozen=True, slots=True)
class Diary:
    """What the car has noted of its people in four weeks: ``EVENTS`` memos, the newest first."""

    today: str
    """The date of departure, such as ``2026-11-19``."""
    first: str
    """What was noted first, four weeks ago."""
    said: tuple[tuple[int, str], ...]
    """What the task is about, each with how many days ago it was."""
    around: tuple[str, ...]
    """What else may have come up: the events that are lacking are drawn from it, and a day for each."""

    def memos(self, rng: np.random.Generator) -> tuple[str, ...]:
        """Their texts, such as ``Tue 3 Nov: Rosa: the fan at 40, please``."""
        lacking = EVENTS - 1 - len(self.said)
        if lacking > len(self.around):
            raise UserError(
                f"a diary of {EVENTS} events lacks {lacking - len(self.around)}: give 'around' so many more"
            )
        drawn = [self.around[index] for index in rng.choice(len(self.around), lacking, replace=False)]
        days = rng.integers(1, DAYS, lacking).tolist()
        events = sorted(
            [*self.said, *zip(days, drawn, strict=True), (DAYS, self.first)], key=lambda event: event[0]
        )
        dated = [(date.fromisoformat(self.today) - timedelta(days=ago), text) for ago, text in events]
        return tuple(f"{day:%a} {day.day} {day:%b}: {text}" for day, text in dated)


DAYS, EVENTS = 28, 84
"""Four weeks, and three notes a day: a sample of VehicleMemBench (arXiv 2603.23840) has more than eighty."""


@dataclass(frozen=True, slots=True)
class Belongings:
    """Each is added to what is drawn, in front of it; an agenda replaces it."""

    contacts: tuple[Contact, ...] = ()
    """People, who are also the first favourites."""
    threads: tuple[Thread, ...] = ()
    """Messages from before the drive, the newest first."""
    agenda: tuple[Appointment, ...] = ()
    """The day's appointments by time; the calendar is then installed."""
    memos: tuple[str, ...] = ()
    """Texts of memos."""
    diary: Diary | None = None
    """Memos of four weeks, below those."""
    details: Mapping[str, str] = field(default_factory=dict)
    """What the map says about places, by name, such as ``Open until 18:00``."""
    songs: tuple[Entry, ...] = ()
    """Tracks on the driver's phone."""
    trip_b: TripMeter = FROM_HERE
    """What the second trip meter has counted before departure."""


NOTHING = Belongings()
"""Only what is drawn."""


def bring(state: State, brought: Belongings, rng: np.random.Generator) -> None:
    """Adds it to what the apps of a cockpit keep.

    Args:
        rng: draws what a diary has around what matters.

    Raises UnknownNameError: there is no place of a name."""
    people = _with_people(state.of(Directory), brought)
    memos, trip = state.of(Memos), state.of(TripMeters)
    noted = brought.diary.memos(rng) if brought.diary else ()
    state.keep(
        _with_details(state.of(Gazetteer), brought.details),
        people,
        replace(state.of(Phone), favourites=people.favourites),
        replace(memos, kept=(*brought.memos, *noted, *memos.kept)),
        replace(trip, b=brought.trip_b),
        _with_songs(state.of(Library), brought.songs),
    )
    if brought.agenda:
        offered = [app.name for app in apps_in(Where.STORE)]
        state.keep(Agenda(brought.agenda), state.of(Installed).with_app("calendar", True, offered))


def _with_people(directory: Directory, brought: Belongings) -> Directory:
    """The driver's phone with these people and messages."""
    if not (brought.contacts or brought.threads):
        return directory
    named = {contact.name for contact in brought.contacts}
    written = {thread.who for thread in brought.threads}
    contacts = (*brought.contacts, *(contact for contact in directory.contacts if contact.name not in named))
    return replace(
        directory,
        contacts=tuple(sorted(contacts, key=lambda contact: contact.name)),
        threads=(*brought.threads, *(thread for thread in directory.threads if thread.who not in written)),
        favourites=(*(contact.name for contact in brought.contacts), *directory.favourites),
    )


def _with_songs(library: Library, songs: tuple[Entry, ...]) -> Library:
    """The music with these tracks on the phone."""
    if not songs:
        return library
    sources = {**library.sources, "BLUETOOTH": (*songs, *library.of("BLUETOOTH"))}
    return replace(library, sources=sources, by_uri=library.by_uri | {song.uri: song for song in songs})


def _with_details(atlas: Gazetteer, details: Mapping[str, str]) -> Gazetteer:
    """The places with these details."""
    names = [place.name for place in atlas.places]
    for name in details:
        if name not in names:
            raise UnknownNameError("place", name, names)
    return replace(
        atlas, places=tuple(replace(place, detail=details.get(place.name, place.detail)) for place in atlas.places)
    )
