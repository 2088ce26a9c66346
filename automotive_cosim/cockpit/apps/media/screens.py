"""Media: the present entry, the controls, and tracks, playlists, stations, podcasts."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.media.commands import Play, Skip
from automotive_cosim.cockpit.apps.media.state import Entry, Library, Listening, Playlist
from automotive_cosim.cockpit.cards import choice, choices, content, note, rows, search, slider, switch
from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.controls import CONTROLS
from automotive_cosim.cockpit.flow import Block, BlockPart, at, card, fill, grid, line, panels, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.signals import LINK, MEDIA, Signal
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import minutes
from automotive_cosim.cockpit.widgets import Bar, Button, Cover, Label, Look, Row, Tile, Widget
from automotive_cosim.contracts.text import counted, say

FOUND = 21


def media(state: State) -> tuple[Widget, ...]:
    """The media screen."""
    source, typed = state.signals[MEDIA.SOURCE], state.typed.get("media.search", "")
    searching = bool(typed) or state.focus == "media.search"
    found = state.of(Library).named(typed)[:FOUND] if searching else ()
    field = search(
        "media.search",
        say("Search music, stations and podcasts"),
        say("Search"),
        state,
        Play(found[0].uri) if found else None,
    )
    plain = searching or source == "INTERNET"
    page = stack(
        (64, choice(MEDIA.SOURCE, state)),
        12,
        (56, field if plain else line(field, 12, (3 * 150 - 12, _filters(state)))),
        12,
        (REST, _entries(found, state) if searching else _browse(source, state)),
    )
    return fill(content(state), panels((480, _now(state)), page))


def _filters(state: State) -> Block:
    shown = state.picked["media.list"]
    tracks = state.signals[MEDIA.SOURCE] in ("BLUETOOTH", "USB")
    kinds = [("all", say("All")), ("liked", say("Liked")), *([("playlists", say("Playlists"))] if tracks else [])]
    return choices(
        "media.list",
        [(key, text, None, shown == key, Pick("media.list", key, rewinds="media.")) for key, text in kinds],
    )


def _browse(source: str, state: State) -> BlockPart:
    shown = state.picked["media.list"]
    if source == "INTERNET":
        return _shows(state)
    if shown == "playlists" and source in ("BLUETOOTH", "USB"):
        return _playlists(state)
    entries = state.of(Library).of(source)
    if shown == "liked":
        entries = tuple(entry for entry in entries if entry.uri in state.of(Listening).favourites)
    return _entries(entries, state)


def _entries(entries: tuple[Entry, ...], state: State) -> BlockPart:
    return (
        rows(
            "media.entries",
            say("Tracks and stations"),
            state,
            entries,
            lambda index, entry: _entry(f"media.entry.{index}", entry, state, Play(entry.uri)),
        )
        if entries
        else note("media.empty", say("Nothing here"))
    )


def _entry(key: str, entry: Entry, state: State, on_tap: Message) -> Row:
    """A line of a list of entries."""
    liked = entry.uri in state.of(Listening).favourites
    return Row(
        key=key,
        text=entry.title,
        detail=entry.by,
        trail=minutes(entry.length_s) if entry.length_s else "",
        icon=Icon.STAR if liked else Icon.NOTE if entry.length_s else Icon.RADIO,
        selected=entry.uri == state.signals[MEDIA.PLAYED],
        on_tap=on_tap,
    )


def _playlists(state: State) -> BlockPart:
    now = state.of(Listening)

    def entry(index: int, each: Playlist) -> Row:
        return Row(
            key=f"media.playlist.{index}",
            text=each.name,
            detail=counted("{n} track", "{n} tracks", len(each.uris)),
            icon=Icon.PLAYLIST,
            selected=each.name == now.playlist,
            on_tap=Show("playlist", each.name),
        )

    return rows("media.playlists", say("Playlists"), state, now.playlists, entry)


def _shows(state: State) -> Block:
    """Podcasts on the left, episodes of the chosen one on the right."""
    chosen = state.picked["media.show"]
    offline = "" if state.signals[LINK.ONLINE] else say("Podcasts need a connection")
    episodes = tuple(entry for entry in state.of(Library).of("INTERNET") if entry.by == chosen)

    def show(index: int, name: str) -> Row:
        return Row(
            key=f"media.show.{index}",
            text=name,
            icon=Icon.PODCAST,
            selected=name == chosen,
            on_tap=Pick("media.show", name, rewinds="media.entries"),
        )

    def episode(index: int, entry: Entry) -> Row:
        return Row(
            key=f"media.entry.{index}",
            text=entry.title,
            detail=minutes(entry.length_s or 0.0),
            icon=Icon.PLAY,
            selected=entry.uri == state.signals[MEDIA.PLAYED],
            on_tap=Play(entry.uri),
            disabled=offline,
        )

    shows = rows("media.shows", say("Podcasts"), state, state.of(Library).shows, show, height=56)
    return line(
        (300, shows), 12, rows("media.entries", say("Episodes"), state, episodes, episode, height=60, gap=6)
    )


def playlist(state: State) -> tuple[Widget, ...]:
    """One playlist: its tracks, and the present one to add or remove."""
    listening, known = state.of(Listening), state.of(Library).by_uri
    name = state.picked.get("playlist") or listening.playlists[0].name
    tracks = tuple(known[uri] for uri in listening.tracks(name))
    playing = known[state.signals[MEDIA.PLAYED]]
    inside = playing in tracks
    fits = playing.length_s is not None and not playing.uri.startswith("podcast")
    back = Button(key="playlist.back", description=say("All music"), icon=Icon.BACK, on_tap=Show("media"))
    start = Button(
        key="playlist.play",
        text=say("Play all"),
        icon=Icon.PLAY,
        look=Look.ACCENT,
        on_tap=Play(tracks[0].uri if tracks else "", name),
        disabled="" if tracks else say("Nothing in this list"),
    )
    change = Button(
        key="playlist.change",
        text=say("Remove") if inside else say("Add to playlist"),
        description=say("{title}: remove it", title=playing.title)
        if inside
        else say("{title}: add it", title=playing.title),
        icon=Icon.PLAYLIST_REMOVE if inside else Icon.PLAYLIST_ADD,
        on_tap=Put(
            listening.with_track(name, playing.uri, not inside),
            say("{title} is removed from {playlist}", title=playing.title, playlist=name)
            if inside
            else say("{title} is added to {playlist}", title=playing.title, playlist=name),
        ),
        disabled="" if fits else say("Only tracks go into a playlist"),
    )
    title = Label(key="playlist.name", text=name, style=Type.TITLE)
    bar = line((64, back), 16, (230, title), REST, (200, start), 12, (200, change))
    listed = rows(
        "playlist.tracks",
        say("Tracks"),
        state,
        tracks,
        lambda index, entry: _entry(f"playlist.track.{index}", entry, state, Play(entry.uri, name)),
    )
    return fill(content(state), panels((480, _now(state)), stack((64, bar), 12, listed)))


def _now(state: State) -> Block:
    signals, listening = state.signals, state.of(Listening)
    entry = state.of(Library).by_uri[signals[MEDIA.PLAYED]]
    playing = signals[MEDIA.ACTION] == "PLAY"
    liked = entry.uri in listening.favourites
    title = Label(
        key="media.title",
        text=entry.title,
        description=say("Playing") if playing else say("Paused"),
        style=Type.TITLE,
        lines=2,
    )
    by = Label(key="media.artist", text=entry.by, description=say("Artist"), tone="muted")
    cover = Cover(key="media.cover", description=say("Cover"), name=f"{entry.title}, {entry.by}")
    play = Button(
        key="media.play",
        description=say("Pause") if playing else say("Play"),
        icon=Icon.PAUSE if playing else Icon.PLAY,
        icon_size=48,
        look=Look.ACCENT,
        on_tap=Set(MEDIA.ACTION, "STOP" if playing else "PLAY"),
    )

    def skip(key: str, words: str, icon: Icon, by: int) -> Block:
        button = Button(key=key, description=words, icon=icon, icon_size=40, look=Look.PLAIN, on_tap=Skip(by))
        return at(lambda box: box.inset(0, 8), button)

    like = Tile(
        key="media.like",
        description=say("Liked"),
        icon=Icon.STAR if liked else Icon.STAR_OUTLINE,
        checked=liked,
        on_tap=Put(
            listening.with_favourite(entry.uri, not liked),
            say("{title} is no longer liked", title=entry.title)
            if liked
            else say("{title} is now liked", title=entry.title),
        ),
    )
    equaliser = Button(key="media.sound", description=say("Sound"), icon=Icon.EQUALIZER, on_tap=Show("sound"))
    signs = grid(4, 12, _sign(MEDIA.SHUFFLE, state), _sign(MEDIA.REPEAT, state), like, equaliser)
    mute = at(lambda box: box.middle(68, 60), _sign(MEDIA.MUTED, state, "media.mute", say("Mute")))
    volume = slider(MEDIA.VOLUME, state, key="media.volume", name=say("Volume"), icon=Icon.VOLUME)
    keys = line(
        REST,
        (72, skip("media.previous", say("Previous"), Icon.PREVIOUS, -1)),
        40,
        (88, play),
        40,
        (72, skip("media.next", say("Next"), Icon.NEXT, 1)),
        REST,
    )
    return card(
        (132, line((132, cover), 24, stack(16, (64, title), 4, (32, by), REST))),
        20,
        (40, _progress(state, entry.length_s)),
        28,
        (88, keys),
        20,
        (60, signs),
        REST,
        (84, line(volume, 16, (68, mute))),
        padding=(28, 20),
    )


def _sign(signal: Signal[bool], state: State, key: str = "", name: str = "") -> Tile:
    """A switch that is an icon alone."""
    return replace(switch(signal, state, key=key, name=""), description=name or CONTROLS[signal].name)


def _progress(state: State, length_s: float | None) -> BlockPart:
    if length_s is None:
        return Label(key="media.live", text=say("Live"), style=Type.LABEL, tone="accent")
    played_s = state.of(Listening).played_s
    elapsed = Label(key="media.elapsed", text=minutes(played_s), style=Type.CAPTION, tone="muted")
    length = Label(key="media.length", text=minutes(length_s), style=Type.CAPTION, tone="muted", align="right")
    return stack((8, Bar(share=round(played_s / length_s, 3))), 6, (26, line((100, elapsed), REST, (100, length))))
