"""What the driver brings into the car besides what is drawn: people, messages, appointments, memos, places."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from automotive_cosim.cockpit.desk import FROM_HERE, Appointment, Desk, TripMeter
from automotive_cosim.cockpit.people import Contact, Directory, Thread
from automotive_cosim.cockpit.places import Gazetteer
from automotive_cosim.errors import UnknownNameError


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
    details: Mapping[str, str] = field(default_factory=dict)
    """What the map says about places, by name, such as ``Open until 18:00``."""
    trip_b: TripMeter = FROM_HERE
    """What the second trip meter has counted before departure."""


NOTHING = Belongings()
"""Only what is drawn."""


def with_people(directory: Directory, brought: Belongings) -> Directory:
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


def with_papers(desk: Desk, brought: Belongings) -> Desk:
    """The smaller apps with these appointments and memos, and the second trip meter as it stands."""
    desk = replace(desk, memos=(*brought.memos, *desk.memos), trip_b=brought.trip_b)
    if not brought.agenda:
        return desk
    return replace(desk.with_app("calendar", True), agenda=brought.agenda)


def with_details(atlas: Gazetteer, brought: Belongings) -> Gazetteer:
    """The places with these details.

    Raises:
        UnknownNameError: there is no place of a name.
    """
    if not brought.details:
        return atlas
    names = [place.name for place in atlas.places]
    for name in brought.details:
        if name not in names:
            raise UnknownNameError("place", name, names)
    detailed = (replace(place, detail=brought.details.get(place.name, place.detail)) for place in atlas.places)
    return replace(atlas, places=tuple(detailed))
