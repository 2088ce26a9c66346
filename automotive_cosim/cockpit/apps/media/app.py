"""Media: what plays, the controls, and tracks, playlists, stations, podcasts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

import numpy as np

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.media.commands import Play, Skip
from automotive_cosim.cockpit.apps.media.screens import media, playlist
from automotive_cosim.cockpit.apps.media.state import Entry, Library, Listening, library
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, disabled, named, offered, unknown
from automotive_cosim.cockpit.restrictions import REASONS, Restriction
from automotive_cosim.cockpit.signals import LINK, MEDIA
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say
from automotive_cosim.formats.annotations import OneOf


@offered
def play_media(
    state: State,
    title: Annotated[
        str, "Title of a track, station or episode, or its address (URI); empty for the first of the playlist."
    ] = "",
    playlist: Annotated[str, "The playlist that it is played from; empty for none."] = "",
    by: Annotated[str, "Artist or podcast, where several have the title; empty for any."] = "",
) -> CallMade:
    """Play a track, a station, an episode of a podcast, or a playlist."""
    library, listening = state.of(Library), state.of(Listening)
    lists = [known.name for known in listening.playlists]
    chosen = named(playlist, lists) if playlist else ""
    if chosen is None:
        return unknown("playlist", playlist, lists)
    tracks = listening.tracks(chosen)
    if not title:
        if not chosen:
            return unknown("title", title, ())
        return Play(tracks[0], chosen) if tracks else disabled(say("Nothing in this list"))
    entry = _entry(library, title, by, tracks if chosen else (), state.signals[MEDIA.SOURCE])
    if entry is None:
        return unknown("title", title, (each.title for each in library.by_uri.values()))
    if entry.uri.startswith("podcast") and not state.signals[LINK.ONLINE]:
        return disabled(say("Podcasts need a connection"))
    if not _is_listed(state, entry):
        return Feedback(FeedbackCode.RESTRICTED, REASONS[Restriction.LIMIT_CONTENT])
    return Play(entry.uri, chosen)


@offered
def skip_track(
    state: State, to: Annotated[str, OneOf(("next", "previous")), "Which entry of the queue."]
) -> CallMade:
    """Play the next or the previous track, station or episode."""
    return Skip(1 if to == "next" else -1)


@offered
def like_playing(state: State, on: Annotated[bool, "Whether it is liked from now on."]) -> CallMade:
    """Put what plays among the liked tracks and stations, or take it out."""
    return Put(state.of(Listening).with_favourite(state.signals[MEDIA.PLAYED], on), "")


@offered
def change_playlist(
    state: State,
    playlist: Annotated[str, "Name of the playlist."],
    on: Annotated[bool, "True adds what plays, false removes it."],
) -> CallMade:
    """Add the track that plays to a playlist, or remove it from there."""
    listening, playing = state.of(Listening), state.signals[MEDIA.PLAYED]
    lists = [known.name for known in listening.playlists]
    chosen = named(playlist, lists)
    if chosen is None:
        return unknown("playlist", playlist, lists)
    if state.of(Library).by_uri[playing].length_s is None or playing.startswith("podcast"):
        return disabled(say("Only tracks go into a playlist"))
    return Put(listening.with_track(chosen, playing, on), "")


def _entry(library: Library, title: str, by: str, within: tuple[str, ...], source: str) -> Entry | None:
    """The entry of that title or address: in the playlist, then of the present source, then of any."""
    every = [library.by_uri[uri] for uri in within] or [*library.of(source), *library.by_uri.values()]
    wanted, who = title.casefold().strip(), by.casefold().strip()
    fitting = (each for each in every if wanted in (each.title.casefold(), each.uri.casefold()))
    return next((each for each in fitting if not who or each.by.casefold() == who), None)


def _is_listed(state: State, entry: Entry) -> bool:
    """Whether a list on the screen shows it: all do at a stop, and their first entries while driving."""
    limit = state.entries_limit
    if limit is None:
        return True
    library, listening = state.of(Library), state.of(Listening)
    shown = {uri for known in listening.playlists for uri in known.uris[:limit]}
    for entries in library.sources.values():
        shown |= {each.uri for each in entries[:limit]}
        shown |= {each.uri for each in [each for each in entries if each.uri in listening.favourites][:limit]}
    return entry.uri in shown or entry.uri.startswith("podcast")


FUNCTIONS = (play_media, skip_track, like_playing, change_playlist)


def starts(state: State, rng: np.random.Generator) -> Iterable[AppData]:
    """Draws what there is to hear."""
    there = library(rng)
    return there, Listening(there.playlists, there.favourites)


APP = App(
    name="media",
    title=say("Media"),
    icon=Icon.MEDIA,
    order=7,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={"media": AppPage(media), "playlist": AppPage(playlist)},
    aliases={"music": "", "radio": ""},
    picked={"media.list": "all"},
    starts=starts,
    turn=1,
)
