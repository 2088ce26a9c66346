"""Hints of several modules: what the driver feels, hears or cannot reach."""

from __future__ import annotations

from automotive_cosim.cockpit.signals import CABIN, HMI, MEDIA, SEAT, VOICE
from automotive_cosim.tasking.checks import AnyOf, SignalIs, SignalLowered, SignalRaised, SignalWithin
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.task import Module, Start
from automotive_cosim.tasks.aboard import DOORS, SEATS
from automotive_cosim.tasks.forms import AT_REST, hinted, in_company
from automotive_cosim.tasks.system_doors_aboard import SUNNY
from automotive_cosim.tasks.under_way import INSIDE

PLAYING = {MEDIA.ACTION.path: "PLAY", MEDIA.VOLUME.path: 75.0}

TASKS = tuple(
    map(
        in_company,
        (
            hinted(
                "comms_can_hardly_understand",
                Module.COMMS,
                (
                    "Whenever somebody rings, all I get is a whisper.",
                    "On the phone everybody sounds a mile away in this car.",
                    "I have to ask people three times what they said down the line.",
                    "Why does my mother mumble so when I ring her from in here?",
                    "The plumber sounds so faint on the phone, I can hardly make out a word.",
                ),
                SignalRaised(VOICE.CALL_VOLUME, 15.0),
                Open("media"),
                Tap("media.sound"),
                Slide("sound.calls", 50.0),
                ways=((Open("settings"), Tap("settings.page.sound"), Slide("sound.calls", 70.0)),),
                start=Start("paris_centre", "centre", signals={VOICE.CALL_VOLUME.path: 10.0}),
                scenarios=(),
            ),
            hinted(
                "media_heads_are_turning",
                Module.MEDIA,
                (
                    "People on the pavement turn their heads at us.",
                    "They can sing along in the next car, I believe.",
                    "That policeman has just put a hand to his ear and pointed at me.",
                    "I can't hear my own thoughts over this song.",
                    "A man at the lights has just put a finger in each ear and looked at us.",
                ),
                AnyOf(
                    (
                        SignalLowered(MEDIA.VOLUME, 15.0),
                        SignalIs(MEDIA.MUTED, (True,)),
                        SignalIs(MEDIA.ACTION, ("STOP",)),
                    )
                ),
                Open("media"),
                Slide("media.volume", 30.0),
                ways=((Open("media"), Tap("media.mute")), (Open("media"), Tap("media.play"))),
                start=Start("paris_centre", "centre", signals=PLAYING),
                scenarios=(),
            ),
            hinted(
                "media_it_hisses",
                Module.MEDIA,
                (
                    "Every S goes right through my skull.",
                    "The cymbals are like needles today.",
                    "It hisses like a snake, somebody must have turned something.",
                    "So shrill! The violins want to kill me.",
                    "My ears ring from all those high notes.",
                ),
                SignalLowered(MEDIA.TREBLE, 3.0),
                Open("media"),
                Tap("media.sound"),
                Slide("sound.treble", 0.0, -10.0, 10.0),
                ways=((Open("media"), Tap("media.sound"), Tap("sound.flat")),),
                start=Start("paris_centre", "centre", signals={MEDIA.ACTION.path: "PLAY", MEDIA.TREBLE.path: 9.0}),
                scenarios=(),
            ),
            hinted(
                "system_knees_at_the_wheel",
                Module.SYSTEM,
                (
                    "My knees touch the wheel; a dwarf must have driven before me.",
                    "I sit here like a frog. Who was at the pedals last?",
                    "There's no room for my legs at all.",
                    "I can't get my long bones behind this steering wheel.",
                    "Ouch, my knees! My wife drove last and I'm a head taller; I need more room for my legs.",
                ),
                SignalRaised(SEAT.DRIVER_POSITION, 30.0),
                *SEATS,
                Tap("seat.driver.position.increase", times=3),
                ways=((*SEATS, Tap("seat.driver.position.increase", times=8)),),
                start=Start("grid", "avenue", parked=True, signals={SEAT.DRIVER_POSITION.path: 40.0}),
                trigger=AT_REST,
                scenarios=(),
            ),
            hinted(
                "system_over_the_bonnet",
                Module.SYSTEM,
                (
                    "I can hardly look over the bonnet from down here.",
                    "I feel like a child behind this dashboard.",
                    "All I see is the sky and the rim of the wheel.",
                    "Somebody could bring me a cushion to sit on.",
                    "I can't see where the bonnet ends; I look through the steering wheel, not over it.",
                ),
                SignalRaised(SEAT.DRIVER_HEIGHT, 15.0),
                *SEATS,
                Tap("seat.driver.height.increase", times=3),
                ways=((*SEATS, Tap("seat.driver.height.increase", times=8)),),
                start=Start("grid", "avenue", parked=True, signals={SEAT.DRIVER_HEIGHT.path: 5.0}),
                trigger=AT_REST,
                scenarios=(),
            ),
            hinted(
                "system_bald_and_scorched",
                Module.SYSTEM,
                (
                    "I'm bald, and it burns straight down on me.",
                    "My scalp is well done under this glass.",
                    "Must I put on a hat in my own car? It's like a magnifying glass above me.",
                    "The sun stands right over us, and there's nothing but glass in between.",
                    "I ought to have put sun cream on my bald head before we left.",
                ),
                SignalWithin(CABIN.SUNROOF_SHADE, 90.0, 100.0),
                *DOORS,
                Slide("window.shade", 100.0),
                start=Start(
                    "sydney",
                    "richmond",
                    start="2026-01-14T12:30:00",
                    weather=SUNNY,
                    signals={CABIN.SUNROOF_SHADE.path: 0.0},
                ),
                scenarios=(),
            ),
            hinted(
                "system_sixteen_what",
                Module.SYSTEM,
                (
                    "Sixteen something, it says up there. Is that before supper or after? I never know.",
                    "My grandchildren read that clock at a glance; I have to take away twelve each afternoon.",
                    "At home no clock counts further than twelve.",
                    "I've just been an hour early again, because I can't subtract.",
                    "Who on earth calls seven in the evening nineteen o'clock!",
                ),
                SignalIs(HMI.TIME_FORMAT, ("HR_12",)),
                Open("settings"),
                Tap("settings.page.language"),
                Tap("language.time.12"),
                start=Start("london", "strand"),
                scenarios=(),
            ),
            hinted(
                "system_like_in_a_fridge",
                Module.SYSTEM,
                (
                    "This glow makes me feel like a yoghurt in a fridge.",
                    "It's as cosy in here as in an operating theatre.",
                    "The dash looks like moonlight on ice; I'd rather have a fireplace.",
                    "A bit of candlelight round us would be nice on a night like this.",
                    "The colour of that light along the doors makes me shiver. Something warmer, please.",
                ),
                SignalIs(CABIN.AMBIENT_COLOUR, ("#FFE3B0", "#FF5C5C")),
                *INSIDE,
                Tap("light.colour.warm"),
                ways=((*INSIDE, Tap("light.colour.red")),),
                start=Start("new_york", "madison", start="2026-10-14T20:05:00"),
                scenarios=(),
            ),
        ),
    )
)
