"""What a cockpit holds that a task can ask for by name: people, places, music."""

from __future__ import annotations

from automotive_cosim.cockpit.restrictions import ENTRIES_LIMIT
from automotive_cosim.cockpit.state import State


def content(state: State) -> dict[str, tuple[str, ...]]:
    """Names by kind, for tasks that draw one of them.

    ``contacts`` (those that the list shows even while driving), ``favourite_contacts``, ``threads`` and
    ``unread`` (senders of messages, and of unread ones), ``places``, ``favourite_places``, ``streets`` (neither
    among these nor hidden behind another in a search), ``playlists``, ``tracks``, ``podcasts``, ``fm``, ``dab``
    (stations).
    """
    entries = state.library.sources
    return {
        "contacts": tuple(contact.name for contact in state.directory.contacts[:ENTRIES_LIMIT]),
        "favourite_contacts": state.directory.favourites,
        "threads": tuple(thread.who for thread in state.directory.threads),
        "unread": state.directory.unread(state.phone),
        "places": tuple(place.name for place in state.atlas.places),
        "favourite_places": state.navigation.favourites,
        "streets": _found_streets(state),
        "playlists": tuple(playlist.name for playlist in state.library.playlists),
        "tracks": tuple(entry.title for entry in entries["BLUETOOTH"]),
        "podcasts": state.library.shows,
        "fm": tuple(entry.title for entry in entries["FM"]),
        "dab": tuple(entry.title for entry in entries["DAB"]),
    }


def _found_streets(state: State) -> tuple[str, ...]:
    """Streets that are the first search result for their name, and not among the favourites."""
    found = "\n".join(("", *(place.name for place in state.atlas.places), *state.roads.names, "")).casefold()
    return tuple(
        name
        for name in state.roads.names
        if name not in state.navigation.favourites
        and found.find(name.casefold()) == found.find(f"\n{name.casefold()}\n") + 1
    )
