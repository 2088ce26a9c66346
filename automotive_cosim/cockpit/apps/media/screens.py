"""Media: the present entry, the controls, and tracks, playlists, stations, podcasts."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.media.commands import Play, Skip
from automotive_cosim.cockpit.apps.media.state import Entry, Library, Listening
from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.parts import choices, content, minutes, rows, search, slider
from automotive_cosim.cockpit.signals import LINK, MEDIA
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Cover, Label, Look, Row, Tile, Widget
from automotive_cosim.contracts.text import counted, say, say_in

SOURCES = (
    ("bluetooth", say("Phone"), Icon.BLUETOOTH),
    ("fm", "FM", Icon.RADIO),
    ("dab", "DAB", Icon.RADIO_TOWER),
    ("usb", "USB", Icon.USB),
    ("internet", say_in("source", "Podcasts"), Icon.PODCAST),
)
FOUND = 21


def media(state: State) -> tuple[Widget, ...]:
    """The media screen."""
    source = state.signals[MEDIA.SOURCE]
    typed = bool(state.typed.get("media.search")) or state.focus == "media.search"
    found = state.of(Library).named(state.typed.get("media.search", ""))[:FOUND] if typed else ()
    now, page = panes(content(state), 480, REST)
    sources, _, bar, _, body = column(page, 64, 12, 56, 12, REST)
    is_filtered = not typed and source != "INTERNET"
    words, _, filters = row(bar, REST, 12, 3 * 150 - 12) if is_filtered else (bar, bar, bar)
    return (
        _now(now, state),
        choices(
            sources,
            "media.source",
            [
                (key, text, icon, source == key.upper(), Set(MEDIA.SOURCE, key.upper()))
                for key, text, icon in SOURCES
            ],
        ),
        search(
            words,
            "media.search",
            say("Search music, stations and podcasts"),
            say("Search"),
            state,
            Play(found[0].uri) if found else None,
        ),
        *((_filters(filters, state),) if is_filtered else ()),
        *(_entries(body, found, state) if typed else _browse(body, source, state)),
    )


def _filters(rect: Rect, state: State) -> Widget:
    shown = state.picked["media.list"]
    tracks = state.signals[MEDIA.SOURCE] in ("BLUETOOTH", "USB")
    kinds = [("all", say("All")), ("liked", say("Liked")), *([("playlists", say("Playlists"))] if tracks else [])]
    return choices(
        rect,
        "media.list",
        [(key, text, None, shown == key, Pick("media.list", key, rewinds="media.")) for key, text in kinds],
    )


def _browse(rect: Rect, source: str, state: State) -> tuple[Widget, ...]:
    shown = state.picked["media.list"]
    if source == "INTERNET":
        return _shows(rect, state)
    if shown == "playlists" and source in ("BLUETOOTH", "USB"):
        return _playlists(rect, state)
    entries = state.of(Library).of(source)
    if shown == "liked":
        entries = tuple(entry for entry in entries if entry.uri in state.of(Listening).favourites)
    return _entries(rect, entries, state)


def _entries(rect: Rect, entries: tuple[Entry, ...], state: State) -> tuple[Widget, ...]:
    if not entries:
        return (
            Label(
                rect=rect.top(60),
                key="media.empty",
                text=say("Nothing here"),
                tone="muted",
                style=Type.LABEL,
                align="centre",
            ),
        )
    return (
        rows(
            rect,
            "media.entries",
            say("Tracks and stations"),
            state,
            len(entries),
            lambda index, cell: entry_row(
                cell, f"media.entry.{index}", entries[index], state, Play(entries[index].uri)
            ),
            height=64,
        ),
    )


def entry_row(rect: Rect, key: str, entry: Entry, state: State, on_tap: Message) -> Row:
    """A line of a list of entries."""
    liked = entry.uri in state.of(Listening).favourites
    return Row(
        rect=rect,
        key=key,
        text=entry.title,
        detail=entry.by,
        trail=minutes(entry.length_s) if entry.length_s else "",
        icon=Icon.STAR if liked else Icon.NOTE if entry.length_s else Icon.RADIO,
        selected=entry.uri == state.signals[MEDIA.PLAYED],
        on_tap=on_tap,
    )


def _playlists(rect: Rect, state: State) -> tuple[Widget, ...]:
    lists = state.of(Listening).playlists
    return (
        rows(
            rect,
            "media.playlists",
            say("Playlists"),
            state,
            len(lists),
            lambda index, cell: Row(
                rect=cell,
                key=f"media.playlist.{index}",
                text=lists[index].name,
                detail=counted("{n} track", "{n} tracks", len(lists[index].uris)),
                icon=Icon.PLAYLIST,
                selected=lists[index].name == state.of(Listening).playlist,
                on_tap=Show("playlist", lists[index].name),
            ),
            height=64,
        ),
    )


def _shows(rect: Rect, state: State) -> tuple[Widget, ...]:
    """Podcasts on the left, episodes of the chosen one on the right."""
    shows = state.of(Library).shows
    chosen = state.picked["media.show"]
    offline = "" if state.signals[LINK.ONLINE] else say("Podcasts need a connection")
    episodes = tuple(entry for entry in state.of(Library).of("INTERNET") if entry.by == chosen)
    left, _, right = row(rect, 300, 12, REST)
    return (
        rows(
            left,
            "media.shows",
            say("Podcasts"),
            state,
            len(shows),
            lambda index, cell: Row(
                rect=cell,
                key=f"media.show.{index}",
                text=shows[index],
                icon=Icon.PODCAST,
                selected=shows[index] == chosen,
                on_tap=Pick("media.show", shows[index], rewinds="media.entries"),
            ),
            height=56,
        ),
        rows(
            right,
            "media.entries",
            say("Episodes"),
            state,
            len(episodes),
            lambda index, cell: Row(
                rect=cell,
                key=f"media.entry.{index}",
                text=episodes[index].title,
                detail=minutes(episodes[index].length_s or 0.0),
                icon=Icon.PLAY,
                selected=episodes[index].uri == state.signals[MEDIA.PLAYED],
                on_tap=Play(episodes[index].uri),
                disabled=offline,
            ),
            height=60,
            gap=6,
        ),
    )


def playlist(state: State) -> tuple[Widget, ...]:
    """One playlist: its tracks, and the present one to add or remove."""
    name = state.picked.get("playlist") or state.of(Listening).playlists[0].name
    tracks = tuple(state.of(Library).by_uri[uri] for uri in state.of(Listening).tracks(name))
    playing = state.of(Library).by_uri[state.signals[MEDIA.PLAYED]]
    inside = playing in tracks
    now, page = panes(content(state), 480, REST)
    bar, _, body = column(page, 64, 12, REST)
    back, _, title, _, start, _, change = row(bar, 64, 16, 230, REST, 200, 12, 200)
    fits = playing.length_s is not None and not playing.uri.startswith("podcast")
    return (
        _now(now, state),
        Button(rect=back, key="playlist.back", description=say("All music"), icon=Icon.BACK, on_tap=Show("media")),
        Label(rect=title, key="playlist.name", text=name, style=Type.TITLE),
        Button(
            rect=start,
            key="playlist.play",
            text=say("Play all"),
            icon=Icon.PLAY,
            look=Look.ACCENT,
            on_tap=Play(tracks[0].uri if tracks else "", name),
            disabled="" if tracks else say("Nothing in this list"),
        ),
        Button(
            rect=change,
            key="playlist.change",
            text=say("Remove") if inside else say("Add to playlist"),
            description=say("{title}: remove it", title=playing.title)
            if inside
            else say("{title}: add it", title=playing.title),
            icon=Icon.PLAYLIST_REMOVE if inside else Icon.PLAYLIST_ADD,
            on_tap=Put(
                state.of(Listening).with_track(name, playing.uri, not inside),
                say("{title} is removed from {playlist}", title=playing.title, playlist=name)
                if inside
                else say("{title} is added to {playlist}", title=playing.title, playlist=name),
            ),
            disabled="" if fits else say("Only tracks go into a playlist"),
        ),
        rows(
            body,
            "playlist.tracks",
            say("Tracks"),
            state,
            len(tracks),
            lambda index, cell: entry_row(
                cell, f"playlist.track.{index}", tracks[index], state, Play(tracks[index].uri, name)
            ),
            height=64,
        ),
    )


def _now(rect: Rect, state: State) -> Widget:
    signals = state.signals
    head, _, way, _, keys, _, signs, _, volume = column(rect.inset(28, 20), 132, 20, 40, 28, 88, 20, 60, REST, 84)
    art, _, words = row(head, 132, 24, REST)
    _, title, _, by, _ = column(words, 16, 64, 4, 32, REST)
    _, previous, _, middle, _, following, _ = row(keys, REST, 72, 40, 88, 40, 72, REST)
    extras = signs.columns(4, 12)
    loud, _, mute = row(volume, REST, 16, 68)
    entry = state.of(Library).by_uri[signals[MEDIA.PLAYED]]
    playing = signals[MEDIA.ACTION] == "PLAY"
    liked = entry.uri in state.of(Listening).favourites
    return Card(
        rect=rect,
        children=(
            Cover(
                rect=art,
                key="media.cover",
                description=say("Cover"),
                name=f"{entry.title}, {entry.by}",
            ),
            Label(
                rect=title,
                key="media.title",
                text=entry.title,
                description=say("Playing") if playing else say("Paused"),
                style=Type.TITLE,
                lines=2,
            ),
            Label(rect=by, key="media.artist", text=entry.by, description=say("Artist"), tone="muted"),
            *_progress(way, state, entry.length_s),
            Button(
                rect=previous.inset(0, 8),
                key="media.previous",
                description=say("Previous"),
                icon=Icon.PREVIOUS,
                icon_size=40,
                look=Look.PLAIN,
                on_tap=Skip(-1),
            ),
            Button(
                rect=middle,
                key="media.play",
                description=say("Pause") if playing else say("Play"),
                icon=Icon.PAUSE if playing else Icon.PLAY,
                icon_size=48,
                look=Look.ACCENT,
                on_tap=Set(MEDIA.ACTION, "STOP" if playing else "PLAY"),
            ),
            Button(
                rect=following.inset(0, 8),
                key="media.next",
                description=say("Next"),
                icon=Icon.NEXT,
                icon_size=40,
                look=Look.PLAIN,
                on_tap=Skip(1),
            ),
            _sign(
                extras[0],
                "media.shuffle",
                say("Shuffle"),
                Icon.SHUFFLE,
                signals[MEDIA.SHUFFLE],
                Set(MEDIA.SHUFFLE, not signals[MEDIA.SHUFFLE]),
            ),
            _sign(
                extras[1],
                "media.repeat",
                say("Repeat"),
                Icon.REPEAT,
                signals[MEDIA.REPEAT],
                Set(MEDIA.REPEAT, not signals[MEDIA.REPEAT]),
            ),
            _sign(
                extras[2],
                "media.like",
                say("Liked"),
                Icon.STAR if liked else Icon.STAR_OUTLINE,
                liked,
                Put(
                    state.of(Listening).with_favourite(entry.uri, not liked),
                    say("{title} is no longer liked", title=entry.title)
                    if liked
                    else say("{title} is now liked", title=entry.title),
                ),
            ),
            Button(
                rect=extras[3],
                key="media.sound",
                description=say("Sound"),
                icon=Icon.EQUALIZER,
                on_tap=Show("sound"),
            ),
            slider(
                loud,
                "media.volume",
                say("Volume"),
                Icon.VOLUME,
                MEDIA.VOLUME,
                signals,
            ),
            _sign(
                mute.middle(68, 60),
                "media.mute",
                say("Mute"),
                Icon.MUTE,
                signals[MEDIA.MUTED],
                Set(MEDIA.MUTED, not signals[MEDIA.MUTED]),
            ),
        ),
    )


def _sign(rect: Rect, key: str, name: str, icon: Icon, on: bool, message: Message) -> Tile:
    """A switch that is an icon alone."""
    return Tile(rect=rect, key=key, description=name, icon=icon, checked=on, on_tap=message)


def _progress(rect: Rect, state: State, length_s: float | None) -> tuple[Widget, ...]:
    if length_s is None:
        return (Label(rect=rect, key="media.live", text=say("Live"), style=Type.LABEL, tone="accent"),)
    bar, _, times = column(rect, 8, 6, 26)
    elapsed, _, length = row(times, 100, REST, 100)
    return (
        Bar(rect=bar, share=round(state.of(Listening).played_s / length_s, 3)),
        Label(
            rect=elapsed,
            key="media.elapsed",
            text=minutes(state.of(Listening).played_s),
            style=Type.CAPTION,
            tone="muted",
        ),
        Label(
            rect=length,
            key="media.length",
            text=minutes(length_s),
            style=Type.CAPTION,
            tone="muted",
            align="right",
        ),
    )
