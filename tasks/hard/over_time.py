"""What has to hold for a time, from an hour on, or only as long as something else does."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.signals import CALL, HMI, LIGHTS, LINK, MEDIA, SEAT, VOICE
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.history import Lasted, NotBefore, While
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Ability, Deadline, Module
from automotive_cosim.tasks.hard.forms import (
    ISLA,
    ON_THE_ROAD,
    OSKAR,
    PRIYA,
    done,
    hard,
    knowing,
    wait,
    with_papers,
    write_to,
)

PLAYING = {
    MEDIA.SOURCE.path: "DAB",
    MEDIA.ACTION.path: "PLAY",
    MEDIA.VOLUME.path: param("percent", {percent: float(percent) for percent in (20, 25, 35, 40, 45)}),
}
STOP = PLAY = (Open("media"), Tap("media.play"))
RING_ISLA = (Open("phone"), Tap("phone.tab.favourites"), Tap(text=ISLA), Tap("contact.call"))
QUIET_CALL = hard(
    "hard_radio_off_for_the_call",
    Module.COMMS,
    (
        "Ring Isla for a quick word, ten seconds and hang up. No radio as long as we're talking, but afterwards it"
        " plays on, at {percent} as now.",
        "Stop the radio, phone Isla, end it after ten seconds, then the radio again. It's on {percent}, leave"
        " that.",
        "I just want to say hello to Isla: call, ten seconds, hang up. The radio must be silent from before to"
        " after, and then be back ({percent} is fine).",
        "A short call to Isla, about ten seconds, with the station stopped the whole while; when she's gone I want"
        " it on once more, still {percent} loud.",
    ),
    done(
        with_papers(replace(ON_THE_ROAD, signals=PLAYING), contacts=knowing(ISLA)),
        AllOf(
            (
                Entered("calls", ISLA),
                While(SignalIs(CALL.PARTNER, (ISLA,)), SignalIs(MEDIA.ACTION, ("STOP",)), 8.0),
                AppDataIs("phone.on_call", ("",)),
                SignalIs(MEDIA.ACTION, ("PLAY",)),
                Lasted(SignalIs(MEDIA.ACTION, ("STOP",)), 8.0, 60.0),
            )
        ),
        (*STOP, *RING_ISLA, *wait(10), Tap("call.end"), *PLAY),
        slips=(
            (*RING_ISLA, *STOP, *wait(10), Open("phone"), Tap("call.end"), *PLAY),
            (*STOP, *RING_ISLA, *wait(10), Tap("call.end")),
            (*STOP, *RING_ISLA, Tap("call.end"), *PLAY),
        ),
        may_write=frozenset(),
        deadline=Deadline(60.0, "the reports on the traffic are read in a minute, and he wants to hear them"),
    ),
    parameters={"percent": (20, 25, 35, 40, 45)},
    ability=Ability.CHAIN,
    guess_loses="The order and the time count: silent before the call, playing after it.",
)

PRIVACY = (Open("settings"), Tap("settings.page.privacy"))
WHERE_WE_ARE = hard(
    "hard_position_for_a_minute",
    Module.SYSTEM,
    (
        "Share where we are for {seconds} seconds, so that Priya can see it, and not our driving data. First text"
        " her 'On my way'.",
        "Tell Priya 'On my way', then position sharing on for {seconds} seconds and off again. Nothing but the"
        " position.",
        "Priya gets an 'On my way' and after that our location, for {seconds} seconds only; how I drive is nobody's"
        " business.",
        "'On my way' to Priya. After that let the position out for {seconds} seconds, and then stop it again.",
    ),
    done(
        with_papers(ON_THE_ROAD, contacts=knowing(PRIYA)),
        AllOf(
            (
                Entered("messages.sent", {"to": PRIYA, "text": "On my way"}),
                Lasted(SignalIs(LINK.SHARE_POSITION, (True,)), 19.0, 45.0),
                SignalIs(LINK.SHARE_POSITION, (False,)),
            )
        ),
        (
            *write_to(PRIYA),
            Tap(text="On my way"),
            *PRIVACY,
            Tap("privacy.position"),
            *wait(30),
            Tap("privacy.position"),
        ),
        slips=(
            (*write_to(PRIYA), Tap(text="On my way"), *PRIVACY, Tap("privacy.position")),
            (*write_to(PRIYA), Tap(text="On my way"), *PRIVACY, Tap("privacy.position"), Tap("privacy.position")),
            (
                *write_to(PRIYA),
                Tap(text="On my way"),
                *PRIVACY,
                Tap("privacy.position"),
                Tap("privacy.driving"),
                *wait(30),
                Tap("privacy.position"),
            ),
        ),
        deadline=Deadline(75.0, "she looks at the map once, when the message comes"),
    ),
    parameters={"seconds": (26, 28, 30, 32, 34)},
    ability=Ability.RESTRAINT,
    guess_loses=(
        "It has to stay on for half a minute with nothing to do, and the second switch beside it stays off."
    ),
)

TEN = "22:00"
NIGHT_SETTINGS = (
    Open("settings"),
    Slide("settings.brightness", param("percent")),
    Tap("settings.page.sound"),
    Slide("sound.guidance", param("percent")),
    Open("media"),
    Slide("media.volume", param("percent")),
)
AT_TEN = hard(
    "hard_at_ten_sharp",
    Module.SYSTEM,
    (
        "At ten, not earlier, turn display, directions and music down to {percent} each. The film music runs till"
        " then.",
        "When it strikes 22:00 I want brightness, guidance voice and media on {percent}; until that time they"
        " stay.",
        "Quiet hours begin at ten: then, and only then, {percent} for screen, spoken turns and the sound.",
        "Wait until it's ten, then set three things to {percent}: screen, guidance voice and volume.",
    ),
    done(
        replace(
            ON_THE_ROAD,
            start="2026-11-17T21:59:05",
            signals={
                HMI.BRIGHTNESS.path: 60.0,
                VOICE.GUIDANCE_VOLUME.path: 70.0,
                MEDIA.VOLUME.path: 60.0,
                MEDIA.SOURCE.path: "DAB",
                MEDIA.ACTION.path: "PLAY",
            },
        ),
        AllOf(
            (
                NotBefore(SignalIs(HMI.BRIGHTNESS, (param("percent"),)), TEN),
                NotBefore(SignalIs(VOICE.GUIDANCE_VOLUME, (param("percent"),)), TEN),
                NotBefore(SignalIs(MEDIA.VOLUME, (param("percent"),)), TEN),
            )
        ),
        (*wait(56), *NIGHT_SETTINGS),
        slips=(NIGHT_SETTINGS, (*wait(30), *NIGHT_SETTINGS)),
        may_write=frozenset(),
        deadline=Deadline(110.0, "by the first minute after ten: 55 s to wait, and as long again to do it"),
    ),
    parameters={"percent": (10, 20, 30, 40, 50)},
    ability=Ability.RESTRAINT,
    guess_loses="Everything could be set at once; before ten it is wrong.",
)

WARM = (Open("climate"), Tap("hvac.driver_seat_heating", 2), Tap("hvac.passenger_seat_heating", 2))
LESS = (Tap("hvac.driver_seat_heating", 2), Tap("hvac.passenger_seat_heating", 2))
WARM_THEN_MILD = hard(
    "hard_seats_hot_then_mild",
    Module.HVAC,
    (
        "Both front seats hot for half a minute, then on the lower level, and the wheel heated all along. While you"
        " wait, tell Oskar '{words}'.",
        "Seat heating full, hers and mine, for thirty seconds, afterwards one step less. Steering wheel warm. Oskar"
        " gets a '{words}'.",
        "Warm us up: seats at the top for some thirty seconds and then half, wheel heating on; text '{words}' to"
        " Oskar.",
        "Half a minute of strong seat heat on either side, gentle after that. Heat the wheel too and write Oskar"
        " '{words}'.",
    ),
    done(
        with_papers(replace(ON_THE_ROAD, cabin={"temperature_c": 8.0}, aboard=company(2)), contacts=knowing(OSKAR)),
        AllOf(
            (
                Lasted(SignalIs(SEAT.DRIVER_HEATING, (100.0,)), 24.0, 45.0),
                Lasted(SignalIs(SEAT.PASSENGER_HEATING, (100.0,)), 24.0, 45.0),
                SignalIs(SEAT.DRIVER_HEATING, (50.0,)),
                SignalIs(SEAT.PASSENGER_HEATING, (50.0,)),
                SignalIs(SEAT.STEERING_WHEEL_HEATING, (100.0,)),
                Entered("messages.sent", {"to": OSKAR, "text": "{words}"}),
            )
        ),
        (
            *WARM,
            Tap("hvac.steering_wheel_heating"),
            *write_to(OSKAR),
            Tap(text="{words}"),
            *wait(20),
            Open("climate"),
            *LESS,
        ),
        slips=(
            (*WARM, Tap("hvac.steering_wheel_heating"), *write_to(OSKAR), Tap(text="{words}")),
            (
                *WARM,
                Tap("hvac.steering_wheel_heating"),
                *write_to(OSKAR),
                Tap(text="{words}"),
                Open("climate"),
                *LESS,
            ),
        ),
        deadline=Deadline(90.0, "at 45 degrees of the cushion skin begins to hurt after minutes (ISO 13732-1)"),
    ),
    parameters={"words": ("Yes", "No", "Thank you", "On my way", "I've arrived")},
    ability=Ability.CHAIN,
    guess_loses="The heat has to last and then to go down: neither level is right all along.",
)

BLINK = (Open("vehicle"), Tap("vehicle.tab.lights"), Tap("lights.hazard"))
MUSIC_DOWN = (Open("media"), Slide("media.volume", param("percent")))
THANK_ALL = hard(
    "hard_hazards_as_thanks",
    Module.ROAD,
    (
        "Let the lorry know we're grateful: hazards for about five seconds, then off. Music to {percent}, and Isla"
        " gets an 'On my way'.",
        "Five seconds of hazard lights as a thank-you and no more, the sound on {percent}, 'On my way' to Isla.",
        "Blink our thanks, five seconds or so, stop blinking, put the volume at {percent}; text Isla that I'm on my"
        " way.",
        "The truck let us in: warning lights on, off after some five seconds. Next the music to"
        " {percent}, and a message for Isla, 'On my way'.",
    ),
    done(
        with_papers(
            replace(
                ON_THE_ROAD,
                signals={MEDIA.VOLUME.path: 60.0, MEDIA.SOURCE.path: "DAB", MEDIA.ACTION.path: "PLAY"},
            ),
            contacts=knowing(ISLA),
        ),
        AllOf(
            (
                Lasted(SignalIs(LIGHTS.HAZARD, (True,)), 3.0, 7.5),
                SignalIs(LIGHTS.HAZARD, (False,)),
                SignalIs(MEDIA.VOLUME, (param("percent"),)),
                Entered("messages.sent", {"to": ISLA, "text": "On my way"}),
            )
        ),
        (*BLINK, *wait(4), Tap("lights.hazard"), *MUSIC_DOWN, *write_to(ISLA), Tap(text="On my way")),
        slips=(
            (*BLINK, *MUSIC_DOWN, *write_to(ISLA), Tap(text="On my way")),
            (*BLINK, *MUSIC_DOWN, *write_to(ISLA), Tap(text="On my way"), *BLINK),
        ),
        deadline=Deadline(40.0, "the lorry is behind for half a minute more: then it turns off and sees no thanks"),
    ),
    parameters={"percent": (10, 15, 20, 25, 30)},
    ability=Ability.CHAIN,
    guess_loses="They have to blink for some five seconds, in the middle of other things.",
)

TASKS = (QUIET_CALL, WHERE_WE_ARE, AT_TEN, WARM_THEN_MILD, THANK_ALL)
