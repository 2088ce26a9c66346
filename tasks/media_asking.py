"""Media, wishes that do not say enough: which list, which source, which of two voices."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import MEDIA, VOICE
from automotive_cosim.tasking.checks import AllOf, AppDataIs, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    FRIENDS,
    ON_THE_WAY,
    PARIS,
    only,
    read_out,
    unclear,
    wrote,
)
from automotive_cosim.tasks.media import PLAYS

PLAYING = {MEDIA.ACTION.path: "PLAY"}
MUSIC = replace(PARIS, signals=PLAYING)
LISTS = ("Dance", "Classics", "Sunday")
TONES = {"bass": MEDIA.BASS, "treble": MEDIA.TREBLE}
SOURCES = {"the USB stick": "USB", "digital radio": "DAB"}
SOUND = (Open("media"), Tap("media.sound"))

TASKS = (
    unclear(
        "media_ask_which_list",
        Module.MEDIA,
        (
            "Put on the playlist for tonight, {who} knows which.",
            "Play tonight's list, the one that {who} has in mind.",
            "Start the music for {who}'s party: Dance, Classics or Sunday.",
            "{who}'s list for the evening, please.",
            "I want to hear what we'll play at {who}'s tonight.",
        ),
        Topic(
            "which playlist", tuple((name.lower(),) for name in LISTS), "{which}.", ("playlist", "list", "{who}")
        ),
        "Which playlist: Dance, Classics or Sunday?",
        AllOf((PLAYS, AppDataIs("media.playlist", ("{which}",)))),
        Open("media"),
        Tap("media.list.playlists"),
        Tap(text="{which}"),
        Tap("playlist.play"),
        untold=wrote(PARIS, ("{who}", "Dance, Classics or Sunday, as you like!")),
        told=wrote(PARIS, ("{who}", "Not all three lists. We'll play {which}!")),
        look=read_out("{who}"),
        find=read_out("{who}"),
        difference="content: the host leaves the choice among three lists to the driver, or names one",
        parameters={"which": LISTS, "who": FRIENDS},
        tags=frozenset({"preference"}),
        may_write=frozenset({MEDIA.SELECTED.path}),  # a list may begin with any of its tracks
    ),
    unclear(
        "media_ask_what_to_turn_down",
        Module.MEDIA,
        (
            "Only one of them is too loud, turn it down to {percent}.",
            "One of them is too loud! {percent} percent is enough for that.",
            "Make just that one quieter, {percent} will do.",
            "One of them shouts at me. Set that to {percent}.",
            "Volume {percent} for the one that's too loud, please.",
        ),
        Topic(
            "what is too loud",
            (("music", "media", "song", "radio"), ("guidance", "navigation", "voice", "directions")),
            param("which", {"music": "The music.", "guidance": "The voice of the navigation."}),
            ("loud", "volume", "what"),
        ),
        "What is too loud, the music or the guidance?",
        SignalIs(param("which", {"music": MEDIA.VOLUME, "guidance": VOICE.GUIDANCE_VOLUME}), (param("percent"),)),
        *SOUND,
        Slide(param("which", {"music": "sound.media", "guidance": "sound.guidance"}), param("percent")),
        untold=replace(MUSIC, signals={**PLAYING, MEDIA.VOLUME.path: 70.0, VOICE.GUIDANCE_VOLUME.path: 70.0}),
        told=replace(
            MUSIC,
            signals={
                **PLAYING,
                **only({"music": MEDIA.VOLUME, "guidance": VOICE.GUIDANCE_VOLUME}, 70.0, 5.0),
            },
        ),
        look=SOUND,
        find=SOUND,
        difference="settings: music and guidance are at 70 percent, or one of them and the other at 5",
        parameters={"which": ("music", "guidance"), "percent": (10, 15, 20)},
        trigger=ON_THE_WAY,
    ),
    unclear(
        "media_ask_which_tone",
        Module.MEDIA,
        (
            "Somebody has played with the tone. Put that one back to zero.",
            "One of the tone controls is wrong, set it to the middle.",
            "The sound is odd. I turned one tone up by mistake, just that back to zero.",
            "Bass or treble, one has to go back to neutral.",
            "I moved one slider of the equaliser by mistake, undo just that.",
        ),
        Topic(
            "which tone control",
            (("bass", "low", "lows"), ("treble", "high", "highs")),
            param(
                "which", {"bass": "The bass. The treble is how I like it.", "treble": "The treble, not the bass."}
            ),
            ("tone", "equaliser", "slider", "control"),
        ),
        "Which one goes back to zero, the bass or the treble?",
        SignalIs(param("which", TONES), (0.0,)),
        *SOUND,
        Slide("sound.{which}", 0.0, -10.0, 10.0),
        untold=replace(PARIS, signals={tone.path: param("level") for tone in TONES.values()}),
        told=replace(PARIS, signals=only(TONES, 6.0, 0.0)),
        look=SOUND,
        find=SOUND,
        difference="settings: bass and treble are both turned up, or only one of them",
        parameters={"which": tuple(TONES), "level": (5.0, 6.0)},
        trigger=ON_THE_WAY,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "media_ask_which_source",
        Module.MEDIA,
        (
            "Switch to what {who} wants us to hear: it's on the USB stick or on digital radio.",
            "{who}'s tip, please. Stick or digital radio, {who} knows which.",
            "Go over to the stick or the digital radio, wherever {who}'s tip is.",
            "{who} recommended something; put the right source on, USB or DAB.",
            "Let's hear {who}'s thing, from the stick or from the digital radio.",
        ),
        Topic(
            "which source",
            (("usb", "stick"), ("digital", "dab", "radio")),
            param("which", {"the USB stick": "It's on the stick.", "digital radio": "On the digital radio."}),
            ("source", "{who}"),
        ),
        "Is it on the USB stick or on digital radio?",
        AllOf((PLAYS, SignalIs(MEDIA.SOURCE, (param("which", SOURCES),)))),
        Open("media"),
        Tap(param("which", {"the USB stick": "media.source.usb", "digital radio": "media.source.dab"})),
        untold=wrote(MUSIC, ("{who}", "You really must hear this!")),
        told=wrote(MUSIC, ("{who}", "You really must hear this, it's on {which}!")),
        look=read_out("{who}"),
        difference="content: the friend recommends it, or also says where it is",
        parameters={"which": tuple(SOURCES), "who": FRIENDS},
    ),
    unclear(
        "media_ask_which_side",
        Module.MEDIA,
        (
            "We fetch the twins. Move the sound away from the one with the earache, {who} knows where he sits.",
            "One of the twins has an earache, and {who} says who sits where. All the sound to the other side.",
            "Away with the music from where the sick twin will sit, as {who} has it.",
            "Balance all the way to the healthy twin's side, {who} has settled the seats.",
            "{who} wants quiet for the twin with the earache: shift everything across before they get in.",
        ),
        Topic(
            "who has an earache",
            (("left",), ("right",)),
            param("which", {"left": "The sound has to go to the left.", "right": "It has to go to the right."}),
            ("side", "earache", "twin", "twins", "sick"),
        ),
        "Should the sound go to the left or to the right?",
        SignalIs(MEDIA.BALANCE, (param("which", {"left": -100.0, "right": 100.0}),)),
        *SOUND,
        Slide("sound.balance", param("which", {"left": -100.0, "right": 100.0}), -100.0, 100.0),
        untold=wrote(MUSIC, ("{who}", "One of the twins has an earache, poor thing. See you soon!")),
        told=wrote(
            MUSIC,
            (
                "{who}",
                param(
                    "which",
                    {
                        "left": "The twin with the earache gets the seat on the right. See you soon!",
                        "right": "The twin with the earache gets the seat on the left. See you soon!",
                    },
                ),
            ),
        ),
        look=read_out("{who}"),
        find=SOUND,
        difference="content: the friend writes that a child has an earache, or on which side it will sit",
        parameters={"which": ("left", "right"), "who": FRIENDS},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
)
