"""What a cockpit holds that a task can ask for by name: people, places, music."""

from __future__ import annotations

from automotive_cosim.cockpit.state import State


def content(state: State) -> dict[str, tuple[str, ...]]:
    """Names by kind, for tasks that draw one of them.

    ``contacts`` (those that the list shows even while driving), ``favourite_contacts``, ``threads`` and
    ``unread`` (senders of messages, and of unread ones), ``places``, ``favourite_places``, ``streets`` (neither
    among these nor hidden behind another in a search), ``playlists``, ``tracks``, ``podcasts``, ``fm``, ``dab``
    (stations).
    """
    return {kind: names for data in state.apps for kind, names in data.names(state).items()}
