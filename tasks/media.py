"""Media: entries, sources and volume."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.signals import MEDIA, VOICE
from automotive_cosim.tasking.checks import (
    AllOf,
    AnyOf,
    AppDataHas,
    AppDataIs,
    Filed,
    SignalChanged,
    SignalIs,
    SignalLowered,
    SignalWithin,
)
from automotive_cosim.tasking.moves import Open, Slide, Tap, TypeText
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.forms import COMFORT, DEVICES, PARIS, asked, hinted, linked, locked
from automotive_cosim.tasks.media_safety import PAIRS

PLAYS = SignalIs(MEDIA.ACTION, ("PLAY",))
PLAYING = replace(PARIS, signals={MEDIA.ACTION.path: "PLAY"})
FROM_STICK = replace(
    PARIS,
    signals={MEDIA.SOURCE.path: "USB", MEDIA.SELECTED.path: "usb:{heard}", MEDIA.ACTION.path: "PLAY"},
)
"""A track that is not a favourite yet, and on no playlist."""
ANY_ENTRY = frozenset({MEDIA.SOURCE.path, MEDIA.SELECTED.path})
HEARD = tuple(range(80))
"""Numbers of the tracks on the stick."""

EXPLICIT = (
    asked(
        "media_volume_percent",
        Module.MEDIA,
        (
            "Set the music volume to {percent} percent.",
            "Volume {percent}.",
            "Put the sound at {percent} for me.",
            "I want the stereo on exactly {percent}, please.",
            "Turn the music to {percent}, would you?",
        ),
        SignalIs(MEDIA.VOLUME, (param("percent"),)),
        Open("media"),
        Slide("media.volume", param("percent")),
        start=PLAYING,
        deadline=COMFORT,
        parameters={"percent": (5, 10, 15, 20, 40, 45, 50, 55, 60, 65, 70, 75, 80)},
    ),
    asked(
        "media_fm_station",
        Module.MEDIA,
        (
            "Put on {station}.",
            "Radio please: {station}.",
            "Tune in to {station}, will you?",
            "Can we listen to {station} now?",
            "I'd like to hear what's on {station}.",
        ),
        AllOf((PLAYS, SignalIs(MEDIA.TRACK, (param("station"),)))),
        Open("media"),
        Tap("media.source.fm"),
        Tap(text="{station}"),
        parameters={"station": FromCockpit("fm")},
        may_write=ANY_ENTRY,
    ),
    asked(
        "media_dab_station_at_volume",
        Module.MEDIA,
        (
            "{station} at volume {percent}, please.",
            "Digital radio: put {station} on and make it {percent} loud.",
            "Switch to {station} and turn the knob to {percent}.",
            "I'm in the mood for {station}; {percent} percent will do.",
        ),
        AllOf((PLAYS, SignalIs(MEDIA.TRACK, (param("station"),)), SignalIs(MEDIA.VOLUME, (param("percent"),)))),
        Open("media"),
        Tap("media.source.dab"),
        Slide("media.volume", param("percent")),
        Tap(text="{station}"),
        ways=(
            (
                Open("media"),
                Tap("media.source.dab"),
                Tap(text="{station}"),
                Slide("media.volume", param("percent")),
            ),
        ),
        parameters={"station": FromCockpit("dab"), "percent": (15, 20, 25, 40, 45, 50, 55, 60)},
        may_write=ANY_ENTRY,
    ),
    asked(
        "media_playlist_shuffled",
        Module.MEDIA,
        (
            "Play my {playlist} list, shuffled, volume {percent}.",
            "Shuffle {playlist} at {percent}.",
            "I want the songs of {playlist} in random order and {percent} percent loud.",
            "Start the playlist called {playlist}, mix it up, and put the sound on {percent}.",
            "I'd like {playlist} in random order; volume at {percent}.",
        ),
        AllOf(
            (
                PLAYS,
                AppDataIs("media.playlist", (param("playlist"),)),
                SignalIs(MEDIA.SHUFFLE, (True,)),
                SignalIs(MEDIA.VOLUME, (param("percent"),)),
            )
        ),
        Open("media"),
        Tap("media.list.playlists"),
        Tap(text="{playlist}"),
        Tap("playlist.play"),
        Tap("media.shuffle"),
        Slide("media.volume", param("percent")),
        ways=(
            (
                Open("media"),
                Slide("media.volume", param("percent")),
                Tap("media.shuffle"),
                Tap("media.list.playlists"),
                Tap(text="{playlist}"),
                Tap("playlist.play"),
            ),
        ),
        parameters={"playlist": FromCockpit("playlists"), "percent": (10, 15, 20, 40, 45, 50, 55, 60, 65)},
        may_write=ANY_ENTRY,
    ),
    asked(
        "media_like_current",
        Module.MEDIA,
        (
            "I love this song, mark it as liked.",
            "Star what's on right now.",
            "Save this track to my likes.",
            "Keep that one among the liked songs, please.",
        ),
        AppDataHas("media.favourites", "usb:{heard}"),
        Open("media"),
        Tap("media.like"),
        start=FROM_STICK,
        deadline=COMFORT,
        parameters={"heard": HEARD},
    ),
    asked(
        "media_add_to_playlist",
        Module.MEDIA,
        (
            "Star this song, add it to {playlist} and play that list.",
            "What we're hearing is great: like it, put it on my {playlist} playlist, go on with those.",
            "Like the track, add it to {playlist}, then play {playlist}.",
            "Put this one on {playlist}, star it too, and carry on playing {playlist}.",
        ),
        AllOf(
            (
                PLAYS,
                AppDataHas("media.favourites", "usb:{heard}"),
                Filed("media.playlists", param("playlist"), "usb:{heard}"),
                AppDataIs("media.playlist", (param("playlist"),)),
            )
        ),
        Open("media"),
        Tap("media.like"),
        Tap("media.list.playlists"),
        Tap(text="{playlist}"),
        Tap("playlist.change"),
        Tap("playlist.play"),
        start=FROM_STICK,
        parameters={"playlist": FromCockpit("playlists"), "heard": HEARD},
    ),
    asked(
        "media_newest_episode",
        Module.MEDIA,
        (
            "Play the newest episode of {show}.",
            "Is there a new {show}? Put the latest on.",
            "{show}, most recent one, go.",
            "I'd like today's podcast from {show}.",
        ),
        AllOf(
            (
                PLAYS,
                SignalIs(MEDIA.ARTIST, (param("show"),)),
                SignalIs(MEDIA.SELECTED, tuple(f"podcast:{number}:0" for number in range(8))),
            )
        ),
        Open("media"),
        Tap("media.source.internet"),
        Tap(text="{show}"),
        Tap("media.entry.0"),
        parameters={"show": FromCockpit("podcasts")},
    ),
    asked(
        "media_stick_on_repeat",
        Module.MEDIA,
        (
            "Play from the USB stick and keep repeating the song.",
            "Music off the stick, on repeat, thanks.",
            "Switch over to USB, start it, loop it.",
            "Play the USB stick, the same track over and over.",
        ),
        AllOf((PLAYS, SignalIs(MEDIA.SOURCE, ("USB",)), SignalIs(MEDIA.REPEAT, (True,)))),
        Open("media"),
        Tap("media.source.usb"),
        Tap("media.repeat"),
        Tap("media.play"),
        ways=((Open("media"), Tap("media.repeat"), Tap("media.source.usb"), Tap("media.play")),),
        may_write=ANY_ENTRY,
    ),
    asked(
        "media_bass_and_treble",
        Module.MEDIA,
        (
            "Bass at plus {bass}, treble at minus {treble}.",
            "Equaliser: {bass} up on the bass, {treble} down on the treble.",
            "I want a bass of {bass} decibels and {treble} less treble.",
            "Raise the low end to {bass} and cut the highs by {treble}.",
        ),
        AllOf(
            (
                SignalIs(MEDIA.BASS, (param("bass"),)),
                SignalIs(MEDIA.TREBLE, (param("treble", {value: -value for value in range(1, 10)}),)),
            )
        ),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.bass", param("bass"), -10.0, 10.0),
        Slide("sound.treble", param("treble", {value: -value for value in range(1, 10)}), -10.0, 10.0),
        start=PLAYING,
        parameters={"bass": tuple(range(1, 10)), "treble": tuple(range(1, 10))},
    ),
    asked(
        "media_sound_to_one_corner",
        Module.MEDIA,
        (
            "Move the sound all the way to the {side} and the {end}.",
            "Only the speakers at the {end} {side} should play.",
            "Balance fully {side}, fader fully {end}.",
            "Send all the sound to the {side} {end} corner of the car.",
        ),
        AllOf(
            (
                SignalIs(MEDIA.BALANCE, (param("side", {"left": -100.0, "right": 100.0}),)),
                SignalIs(MEDIA.FADER, (param("end", {"rear": -100.0, "front": 100.0}),)),
            )
        ),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.balance", param("side", {"left": -100.0, "right": 100.0}), -100.0, 100.0),
        Slide("sound.fader", param("end", {"rear": -100.0, "front": 100.0}), -100.0, 100.0),
        start=PLAYING,
        parameters={"side": ("left", "right"), "end": ("rear", "front")},
    ),
    asked(
        "media_equaliser_even",
        Module.MEDIA,
        (
            "Reset the equaliser.",
            "All the tone controls back to zero, please.",
            "Somebody fiddled with bass and treble, make it even again.",
            "Neutral sound settings, nothing boosted.",
        ),
        AllOf(tuple(SignalIs(band, (0.0,)) for band in (MEDIA.BASS, MEDIA.MIDDLE, MEDIA.TREBLE, MEDIA.FADER))),
        Open("media"),
        Tap("media.sound"),
        Tap("sound.flat"),
        start=replace(PARIS, signals={MEDIA.BASS.path: 8.0, MEDIA.TREBLE.path: -6.0, MEDIA.ACTION.path: "PLAY"}),
    ),
    asked(
        "media_mute_for_guidance",
        Module.MEDIA,
        (
            "Mute the music and put the guidance voice at {percent}.",
            "No music now, and directions at {percent} percent.",
            "Silence the songs; let the navigation talk at {percent}.",
            "I need to hear where to turn: speech volume {percent}, media muted.",
        ),
        AllOf((SignalIs(MEDIA.MUTED, (True,)), SignalIs(VOICE.GUIDANCE_VOLUME, (param("percent"),)))),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.guidance", param("percent")),
        Tap("sound.mute"),
        ways=((Open("media"), Tap("media.mute"), Tap("media.sound"), Slide("sound.guidance", param("percent"))),),
        start=PLAYING,
        parameters={"percent": (60, 65, 70, 75, 80, 85, 90)},
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "media_station_and_alerts",
        Module.MEDIA,
        (
            "{station} at {percent}, and the navigation should only speak for alerts.",
            "Put {station} on, volume {percent}; no turn directions, just warnings.",
            "I know the road: radio {station}, {percent} percent, guidance for alerts only.",
            "Tune to {station}, make it {percent} loud, and limit the map's voice to alerts.",
        ),
        AllOf(
            (
                PLAYS,
                SignalIs(MEDIA.TRACK, (param("station"),)),
                SignalIs(MEDIA.VOLUME, (param("percent"),)),
                SignalIs(VOICE.GUIDANCE, ("ALERT_ONLY",)),
            )
        ),
        Open("media"),
        Tap("media.source.fm"),
        Tap(text="{station}"),
        Slide("media.volume", param("percent")),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap("route.voice.alerts"),
        parameters={"station": FromCockpit("fm"), "percent": (10, 15, 20, 40, 45, 50, 55, 60)},
        may_write=ANY_ENTRY,
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "media_skip_two",
        Module.MEDIA,
        (
            "Skip two songs.",
            "Jump ahead by two tracks.",
            "Next, and then next again.",
            "Not this one and not the following one either.",
        ),
        AllOf((PLAYS, SignalIs(MEDIA.SELECTED, (param("heard", {n: f"track:{n + 2}" for n in range(120)}),)))),
        Open("media"),
        Tap("media.next", times=2),
        ways=((Tap("home.media.next", times=2),),),
        start=replace(PARIS, signals={MEDIA.SELECTED.path: "track:{heard}", MEDIA.ACTION.path: "PLAY"}),
        deadline=COMFORT,
        parameters={"heard": tuple(range(120))},
    ),
    locked(
        "media_type_search",
        Module.MEDIA,
        (
            "Type {track} into the music search and play the hit.",
            "Use the search field for {track}, then start it.",
            "Key in {track} up there and put on what you find.",
            "Spell out {track} in the media search, I want to hear that.",
        ),
        AllOf((PLAYS, SignalIs(MEDIA.TRACK, (param("track"),)))),
        Open("media"),
        TypeText("media.search", "{track}", enter=True),
        parameters={"track": FromCockpit("tracks")},
        may_write=ANY_ENTRY,
    ),
    locked(
        "media_from_other_device",
        Module.MEDIA,
        (
            "Link the {device} and play music from it, shuffled.",
            "Connect my {device}, then start its songs in random order.",
            "Bluetooth over to the {device}, let it play and mix the tracks.",
            "Shuffle what's on the {device} instead of this phone.",
        ),
        AllOf(
            (
                PLAYS,
                SignalIs(MEDIA.SHUFFLE, (True,)),
                linked("device"),
            )
        ),
        Open("settings"),
        Tap("settings.page.connections"),
        Tap(param("device", {"second phone": "link.device.1", "tablet": "link.device.2"})),
        Open("media"),
        Tap("media.shuffle"),
        Tap("media.play"),
        parameters={"device": tuple(DEVICES)},
        tags=frozenset({"two_modules"}),
    ),
)

IMPLICIT = (
    hinted(
        "media_lonely",
        Module.MEDIA,
        (
            "Feels a bit lonely driving in silence.",
            "It's awfully quiet in here.",
            "A little company would be nice on this drive.",
            "All I can hear is the tyres.",
            "So dull without any sound in the car.",
        ),
        PLAYS,
        Tap("home.media.play"),
        ways=((Open("media"), Tap("media.source.dab"), Tap("media.entry.1")),),
        may_write=ANY_ENTRY,
    ),
    hinted(
        "media_not_again",
        Module.MEDIA,
        (
            "Ugh, not this one again.",
            "I can't stand that tune any more.",
            "Who put this awful thing in my collection?",
            "Anything but what's on at the moment.",
        ),
        AllOf((PLAYS, SignalChanged(MEDIA.SELECTED))),
        Tap("home.media.next"),
        ways=((Tap("home.media.previous"),), (Open("media"), Tap("media.source.fm"))),
        start=replace(PARIS, signals={MEDIA.SELECTED.path: "track:{heard}", MEDIA.ACTION.path: "PLAY"}),
        parameters={"heard": tuple(range(1, 120))},
        may_write=ANY_ENTRY,
    ),
    hinted(
        "media_baby_and_the_match",
        Module.MEDIA,
        (
            "The baby dozed off in the back, but I want to follow the match.",
            "Don't wake the little one behind me; I'm still listening to the game though.",
            "She's asleep on the rear seat. I must hear who scores, mind you.",
            "Careful, sleeping child back there, and yet I need my football.",
        ),
        AllOf(
            (
                PLAYS,
                SignalIs(MEDIA.MUTED, (False,)),
                SignalIs(MEDIA.SOURCE, ("FM",)),
                AnyOf((SignalWithin(MEDIA.FADER, 20.0, 100.0), SignalWithin(MEDIA.VOLUME, 5.0, 40.0))),
            )
        ),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.fader", 80.0, -100.0, 100.0),
        ways=((Open("media"), Slide("media.volume", 15.0)),),
        start=replace(
            PARIS,
            aboard=(Occupant(Seat.REAR_RIGHT, Kind.BABY, asleep=True),),
            signals={MEDIA.SOURCE.path: "FM", MEDIA.VOLUME.path: 60.0, MEDIA.ACTION.path: "PLAY"},
        ),
        tags=frozenset({"conflict"}),
    ),
    hinted(
        "media_chat_and_news",
        Module.MEDIA,
        (
            "We'd like to chat up here, but I mustn't miss the traffic bulletin.",
            "I have to shout to be understood! Keep the news on in the background, though.",
            "Let us talk, will you? Half an ear on the announcements is enough.",
            "My friend has a soft voice, and yet the reports on jams matter to me.",
        ),
        AllOf(
            (
                PLAYS,
                SignalIs(MEDIA.MUTED, (False,)),
                SignalIs(MEDIA.SOURCE, ("DAB",)),
                SignalWithin(MEDIA.VOLUME, 5.0, 25.0),
            )
        ),
        Open("media"),
        Slide("media.volume", 15.0),
        start=replace(
            PARIS,
            aboard=company(2),
            signals={MEDIA.SOURCE.path: "DAB", MEDIA.VOLUME.path: 70.0, MEDIA.ACTION.path: "PLAY"},
        ),
        tags=frozenset({"conflict"}),
    ),
    hinted(
        "media_booming",
        Module.MEDIA,
        (
            "Everything booms, my chest is vibrating.",
            "That thumping gives me a headache, the melody itself is fine.",
            "It sounds as if we sat inside a drum.",
            "Too much rumble down low for my taste.",
        ),
        SignalLowered(MEDIA.BASS, 4.0),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.bass", 0.0, -10.0, 10.0),
        ways=((Open("media"), Tap("media.sound"), Tap("sound.flat")),),
        start=replace(PARIS, signals={MEDIA.BASS.path: 9.0, MEDIA.ACTION.path: "PLAY"}),
    ),
    hinted(
        "media_forever",
        Module.MEDIA,
        (
            "I could listen to this one song until we get there.",
            "Don't let this track ever end.",
            "Nothing else today, just that melody.",
            "Again and again, this is exactly what I need.",
        ),
        SignalIs(MEDIA.REPEAT, (True,)),
        Open("media"),
        Tap("media.repeat"),
        start=FROM_STICK,
        parameters={"heard": HEARD},
    ),
    hinted(
        "media_no_voices",
        Module.MEDIA,
        (
            "No chatter for me in the morning, no hosts, no news; but silence I can't bear either.",
            "I hate people talking at me before noon. Don't leave me without any sound though.",
            "Enough of that babble! It mustn't be dead quiet, mind.",
            "You know I never listen to anybody speak on the way to work, only tunes.",
        ),
        AllOf((PLAYS, SignalIs(MEDIA.MUTED, (False,)), SignalIs(MEDIA.SOURCE, ("BLUETOOTH", "USB")))),
        Open("media"),
        Tap("media.source.usb"),
        ways=((Open("media"), Tap("media.source.bluetooth")),),
        start=replace(PARIS, signals={MEDIA.SOURCE.path: "INTERNET", MEDIA.ACTION.path: "PLAY"}),
        tags=frozenset({"conflict", "preference"}),
    ),
)

TASKS = (*EXPLICIT, *IMPLICIT, *PAIRS)
