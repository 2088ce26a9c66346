"""Media content, generated from a seed, what the driver chose of it, and what plays."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from automotive_cosim.cockpit.signals import MEDIA, Signal
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.contracts import Surroundings

_ADJECTIVES = """Amber Blue Broken Copper Distant Early Electric Faded First Golden Hidden Hollow Last Late Little
    Long Lost Open Paper Quiet Restless Silver Slow Velvet"""
_NOUNS = """Avenue Bridges Circles Coast Embers Fields Gravity Harbour Horizon Lanterns Letters Morning Orbit Parade
    Rivers Rooftops Seasons Signal Skyline Station Tides Weekend Windows Winter"""
_FIRST = "Ada Bruno Carla Dario Elif Femi Greta Hugo Ines Jonas Kaya Lena Milo Nora Otis Petra"
_LAST = "Adler Bianchi Costa Duval Eklund Farrow Girard Holm Ibarra Jansen Keller Lindqvist"
_STATIONS = """Antenne City Classique Coast Culture Ether Horizon Info Jazz Metro Nova Pop Swing Tempo Voyage Wave
    Rock Folk Lounge Opera Retro Soul Talk Verve"""
_PLAYLISTS = "Morning drive|Road trip|Focus|Sunday|Dance|Calm|Classics|New this week"
_SHOWS = """The Long Way Round|Night Shift|Small Engines|City Walks|Science Over Coffee|Half Time|Kitchen Radio|
    True Miles"""
_TOPICS = """Borders Bridges Bread Comets Deserts Engines Forests Gardens Harbours Islands Jungles Kites Lighthouses
    Maps Numbers Oceans Patents Quartz Rivers Storms Tunnels Umbrellas Volcanoes Winters"""
PHONE_TRACKS, USB_TRACKS, STATIONS, EPISODES = 140, 80, 20, 6
"""Stations of each kind of radio; episodes of each podcast."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A track, an episode or a station."""

    uri: str
    title: str
    by: str
    """Artist, show, or frequency."""
    length_s: float | None = None
    """None for a station."""


@dataclass(frozen=True, slots=True)
class Playlist:
    """Tracks that belong together."""

    name: str
    uris: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Library(AppData):
    """Entries by source, as VSS names sources: the phone is BLUETOOTH, podcasts come by INTERNET."""

    sources: dict[str, tuple[Entry, ...]]
    playlists: tuple[Playlist, ...]
    favourites: tuple[str, ...]
    by_uri: dict[str, Entry]

    def of(self, source: str) -> tuple[Entry, ...]:
        """The entries of a source."""
        return self.sources[source]

    def find(self, source: str, uri: str) -> Entry:
        """The entry at an address; the first of the source if it does not exist."""
        entry = self.by_uri.get(uri)
        return entry if entry is not None and source_of(uri) == source else self.sources[source][0]

    def named(self, words: str) -> tuple[Entry, ...]:
        """Entries of all sources whose title or artist contains the words."""
        wanted = words.casefold().strip()
        return tuple(
            entry
            for entry in self.by_uri.values()
            if wanted in entry.title.casefold() or wanted in entry.by.casefold()
        )

    def parts(self) -> Mapping[str, str]:
        return {"media.show": self.shows[0]}

    def names(self, state: State) -> Mapping[str, tuple[str, ...]]:
        """Playlists, tracks, podcasts and stations."""
        return {
            "playlists": tuple(playlist.name for playlist in self.playlists),
            "tracks": tuple(entry.title for entry in self.sources["BLUETOOTH"]),
            "podcasts": self.shows,
            "fm": tuple(entry.title for entry in self.sources["FM"]),
            "dab": tuple(entry.title for entry in self.sources["DAB"]),
        }

    @property
    def shows(self) -> tuple[str, ...]:
        """Names of the podcasts."""
        return tuple(dict.fromkeys(entry.by for entry in self.sources["INTERNET"]))


@dataclass(frozen=True, slots=True)
class Listening(AppData):
    """The driver's choices besides source and entry."""

    playlists: tuple[Playlist, ...]
    favourites: tuple[str, ...]
    """Addresses of favourite stations."""
    playlist: str = ""
    """The playlist that is playing; empty for the whole source."""
    played_s: float = 0.0
    """Playing time of the entry."""

    def with_favourite(self, uri: str, wanted: bool) -> Listening:
        """With or without that favourite, at the end of the list."""
        rest = tuple(known for known in self.favourites if known != uri)
        return replace(self, favourites=(*rest, uri) if wanted else rest)

    def with_track(self, playlist: str, uri: str, wanted: bool) -> Listening:
        """With or without a track in a playlist, at its end."""
        changed = []
        for known in self.playlists:
            rest = tuple(track for track in known.uris if track != uri)
            own = (*rest, uri) if wanted else rest
            changed.append(Playlist(known.name, own) if known.name == playlist else known)
        return replace(self, playlists=tuple(changed))

    def tracks(self, playlist: str) -> tuple[str, ...]:
        """Addresses in that playlist."""
        return next((known.uris for known in self.playlists if known.name == playlist), ())

    def commands(self) -> dict[str, Any]:
        return {
            "media.favourites": list(self.favourites),
            "media.playlists": {known.name: list(known.uris) for known in self.playlists},
            "media.playlist": self.playlist,
        }

    def commanded(self, state: State, signal: Signal[Any]) -> None:
        """Another source has other lists."""
        if signal is MEDIA.SOURCE:
            state.rewind("media.")

    def settled(self, state: State) -> None:
        """Another source starts with its first entry; another entry starts at its beginning."""
        signals = state.signals
        entry = state.of(Library).find(signals[MEDIA.SOURCE], signals[MEDIA.SELECTED])
        signals[MEDIA.SELECTED] = entry.uri
        if source_of(signals[MEDIA.PLAYED]) != signals[MEDIA.SOURCE] or not signals[MEDIA.PLAYED]:
            start(state, entry, "")

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """The music continues; at the end of an entry, the next one plays, or the same again."""
        signals, library = state.signals, state.of(Library)
        entry = library.by_uri[signals[MEDIA.PLAYED]]
        if signals[MEDIA.ACTION] != "PLAY" or entry.length_s is None:
            return
        played_s = self.played_s + dt_s
        if played_s >= entry.length_s:
            played_s -= entry.length_s
            uri = entry.uri if signals[MEDIA.REPEAT] else skipped(state, 1)
            start(state, library.by_uri[uri], self.playlist)
        state.keep(replace(state.of(Listening), played_s=played_s))

    def put_back(self, state: State, departed: State) -> None:
        state.keep(replace(self, played_s=departed.of(Listening).played_s))


def start(state: State, entry: Entry, playlist: str) -> None:
    """The entry plays from its beginning, of a playlist or of its whole source."""
    signals = state.signals
    state.keep(replace(state.of(Listening), playlist=playlist, played_s=0.0))
    signals[MEDIA.PLAYED], signals[MEDIA.TRACK], signals[MEDIA.ARTIST] = entry.uri, entry.title, entry.by


def skipped(state: State, by: int) -> str:
    """Address of the entry a number of places later in the queue."""
    signals = state.signals
    entries = queue(state.of(Library), state.of(Listening), signals[MEDIA.SOURCE], signals[MEDIA.SHUFFLE])
    uris = [entry.uri for entry in entries]
    now = uris.index(signals[MEDIA.PLAYED]) if signals[MEDIA.PLAYED] in uris else -by
    return uris[(now + by) % len(uris)]


def source_of(uri: str) -> str:
    """The source an address belongs to."""
    return {"track": "BLUETOOTH", "usb": "USB", "fm": "FM", "dab": "DAB"}.get(uri.partition(":")[0], "INTERNET")


def queue(library: Library, listening: Listening, source: str, shuffled: bool) -> tuple[Entry, ...]:
    """The queue. When shuffled, each entry has a fixed pseudo-random position."""
    known = listening.tracks(listening.playlist) if source in ("BLUETOOTH", "USB") else ()
    entries = tuple(library.by_uri[uri] for uri in known) or library.of(source)
    return tuple(sorted(entries, key=lambda entry: zlib.crc32(entry.uri.encode()))) if shuffled else entries


def library(rng: np.random.Generator) -> Library:
    """Draws titles, artists, stations, episodes and playlists."""
    total = PHONE_TRACKS + USB_TRACKS
    titles = _pairs(rng, _ADJECTIVES, _NOUNS, total)
    artists = _pairs(rng, _FIRST, _LAST, total // 4)
    drawn = rng.integers((0, 140), (len(artists), 330), (total, 2)).tolist()
    uris = (*(f"track:{i}" for i in range(PHONE_TRACKS)), *(f"usb:{i}" for i in range(USB_TRACKS)))
    tracks = tuple(
        Entry(uri, title, artists[by], float(length_s))
        for uri, title, (by, length_s) in zip(uris, titles, drawn, strict=True)
    )
    phone, usb = tracks[:PHONE_TRACKS], tracks[PHONE_TRACKS:]
    sources = {"BLUETOOTH": phone, "USB": usb, **_radio(rng), "INTERNET": _podcasts(rng)}
    playlists = tuple(
        Playlist(name, tuple(phone[i].uri for i in rng.permutation(len(phone))[: rng.integers(12, 21)]))
        for name in _PLAYLISTS.split("|")
    )
    by_uri = {entry.uri: entry for entries in sources.values() for entry in entries}
    liked = (phone[i].uri for i in rng.permutation(len(phone))[:8])
    return Library(sources, playlists, (*liked, sources["FM"][3].uri, sources["DAB"][5].uri), by_uri)


def _radio(rng: np.random.Generator) -> dict[str, tuple[Entry, ...]]:
    names = _STATIONS.split()
    fm = rng.choice(names, STATIONS, replace=False)
    dab = rng.choice(names, STATIONS, replace=False)
    steps = np.sort(rng.choice(np.arange(875, 1080, 3), STATIONS, replace=False))
    return {
        "FM": tuple(Entry(f"fm:{s}", f"{n} FM", f"{s / 10:.1f} MHz") for n, s in zip(fm, steps, strict=True)),
        "DAB": tuple(Entry(f"dab:{i}", f"{n} Digital", "DAB+") for i, n in enumerate(dab)),
    }


def _podcasts(rng: np.random.Generator) -> tuple[Entry, ...]:
    topics = _TOPICS.split()
    return tuple(
        Entry(
            f"podcast:{s}:{e}", f"{EPISODES - e}. {topic}", " ".join(show.split()), float(rng.integers(900, 3600))
        )
        for s, show in enumerate(_SHOWS.split("|"))
        for e, topic in enumerate(rng.choice(topics, EPISODES, replace=False))
    )


def _pairs(rng: np.random.Generator, words: str, more: str, count: int) -> list[str]:
    first, second = words.split(), more.split()
    chosen = rng.choice(len(first) * len(second), count, replace=False)
    return [f"{first[i // len(second)]} {second[i % len(second)]}" for i in chosen.tolist()]
