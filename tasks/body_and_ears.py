"""Body and ears: what skin, lungs, eyes and ears bear or need in a car, left to it half in passing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind
from automotive_cosim.cockpit.signals import CABIN, HVAC, LIGHTS, MEDIA, SEAT, Signal
from automotive_cosim.tasking.checks import AnyOf, SignalIs, SignalLowered, SignalWithin
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.task import Basis, Module
from automotive_cosim.tasking.triggers import All, Driving, InSchoolZone, Trigger
from automotive_cosim.tasks.aboard import (
    DOORS,
    PASSENGER,
    REAR_LEFT,
    act,
    at,
    but,
    hazard,
    on,
    wrong_or_well,
)
from automotive_cosim.tasks.forms import pair
from automotive_cosim.tasks.hvac_hints import FRESH_AIR, FRESH_AIR_WAYS
from automotive_cosim.tasks.media_safety import ANY_ENTRY, RADIO
from automotive_cosim.tasks.phenomenon_air import CALM, GALE
from automotive_cosim.tasks.road_law import FAIR, PLACE, fine
from automotive_cosim.tasks.unasked import EARS, HIDDEN, LOUD
from automotive_cosim.tasks.under_way import start

NUMB_SOURCE = "skin that touches 43 degrees for hours is burnt (ISO 13732-1), and who feels nothing is not warned"
GRIP_SOURCE = "fingers colder than 15 degrees lose their feeling and their grip (ISO 11079)"
TEARS_SOURCE = "a draught dries the eyes, and who blinks does not see: at 80 km/h the car covers 22 m in a second"
INSULIN_SOURCE = "insulin in use keeps below 30 degrees (EMA, product information); a heated seat has more than 40"
ICE_SOURCE = "dry ice gives off carbon dioxide, which stifles from 3 per cent on: carry it with fresh air (UN 1845)"
SNEEZE_SOURCE = (
    "a sneeze shuts the eyes for up to three seconds: 67 m at 80 km/h; a pollen filter stops what sets it off"
)
ASLEEP_SOURCE = "skin that touches 43 degrees for hours is burnt (ISO 13732-1), and who sleeps does not move away"
KNOCK_SOURCE = "a loose wheel knocks before it comes off (DVSA, Careless torque costs lives): who hears it can stop"
SHAKE_SOURCE = "the driver has to see the road behind by the mirrors (UN R46, 15.2); one that trembles shows a blur"
CHILD_EARS_SOURCE = "children's ears bear 75 dB for forty hours a week, adults' 80 (WHO and ITU H.870)"
CROSSING_SOURCE = (
    "where a school zone is in force, children step out of it unseen (sign R4-230): a bell or a shout warns"
)
STORM_SOURCE = (
    "strong gale, Beaufort 9, from 75 km/h fells trees (WMO-No. 8); warnings come over the radio (EN 50067)"
)
MAY = "2026-05-12T16:20:00"
MEADOWS = replace(FAIR, temperature_2m=17.0)
SOUND = (Open("media"), Tap("media.sound"))
SILENT = (SignalIs(MEDIA.MUTED, (True,)), SignalIs(MEDIA.ACTION, ("STOP",)))

IN_SNOW = start("border", "north", {LIGHTS.SWITCH: "BEAM"})
NUMB = pair(
    "hvac_legs_that_feel_nothing",
    Module.HVAC,
    (
        "I've had no feeling below the waist since the accident. Nothing that I sit on may be hot.",
        "My thighs wouldn't tell me if they burned. Look at what I'm sitting on, and act if you have to.",
        "The valet warmed the car for me, and doesn't know what I can't feel. Undo it if he warmed my seat too.",
        "Last winter I had blisters and noticed in the shower. Is that on its way again? Then stop it.",
        "Paraplegic at the wheel: what heats my backside must not be on. See to that.",
    ),
    *wrong_or_well(
        IN_SNOW,
        but(IN_SNOW, {SEAT.DRIVER_HEATING: 100.0}),
        SignalIs(SEAT.DRIVER_HEATING, (0.0,)),
        Open("climate"),
        Tap("hvac.driver_seat_heating"),
        rule=NUMB_SOURCE,
    ),
    "settings: the heater of the driver's seat is at full power, or off",
)

IN_FROST = start("nordic", "kurravaara", {LIGHTS.SWITCH: "BEAM"})
FINGERS = pair(
    "hvac_white_fingers",
    Module.HVAC,
    (
        "My fingers go white in this, and then they hold nothing. Give my grip a chance, if it hasn't one yet.",
        "Frost has got into my hands again. Whatever the rim can do against that, it ought to be doing.",
        "Raynaud's, says the doctor: cold wheel, dead fingers, no steering. Mine mustn't be a cold one.",
        "My hands go numb on this cold wheel. Shall I still feel it in ten minutes? Make sure of it.",
        "Without warmth in my palms I lose the feel of the wheel. Act, unless that's taken care of.",
    ),
    *wrong_or_well(
        but(IN_FROST, {SEAT.STEERING_WHEEL_HEATING: 100.0}),
        IN_FROST,
        SignalIs(SEAT.STEERING_WHEEL_HEATING, (100.0,)),
        Open("climate"),
        Tap("hvac.steering_wheel_heating"),
        rule=GRIP_SOURCE,
    ),
    "settings: the heater of the steering wheel is off, or on, in fourteen degrees of frost",
)

BLOWN_AT = start("sydney", "putty_road", weather=MEADOWS, start="2026-09-16T11:00:00")
LENSES = pair(
    "hvac_lenses_dry_out",
    Module.HVAC,
    (
        "My contact lenses are drying out, and I blink instead of looking. Take away what does it.",
        "Something blows into my eyes and they run. End it, please.",
        "I've lost one lens already. Find where this wind comes from before the other goes.",
        "Tears again, and it isn't grief, it's the gale in my face. Put a stop to it.",
        "Moving air burns my eyes while I drive. See where it comes from and keep it off them.",
    ),
    act(
        but(BLOWN_AT, {HVAC.FAN_SPEED: 100.0}),
        AnyOf((SignalLowered(HVAC.FAN_SPEED, 40.0), SignalIs(HVAC.AIR_DISTRIBUTION, ("UP", "DOWN")))),
        Open("climate"),
        Slide("hvac.fan", 30.0),
        rule=TEARS_SOURCE,
        may_write=frozenset({HVAC.AUTO.path}),
        ways=((Open("climate"), Tap("hvac.air.down")),),
    ),
    act(
        but(BLOWN_AT, {CABIN.DRIVER_WINDOW: 60.0}),
        SignalIs(CABIN.DRIVER_WINDOW, (0.0,)),
        *DOORS,
        Slide("window.driver", 0.0),
        rule=TEARS_SOURCE,
        ways=((*DOORS, Tap("window.close_all")),),
    ),
    "settings: the blower is at its most, at the height of the face, or the driver's window is open",
)

PENS = at("tokyo", "avenues", on(PASSENGER, Kind.OBJECT), start="2026-01-14T15:30:00")
INSULIN = hazard(
    "hvac_insulin_on_the_seat",
    Module.HVAC,
    (
        "The bag beside me is full of Dad's insulin. It mustn't cook on the way to him.",
        "What's in there spoils at thirty degrees, said the chemist. Is that place too hot for it? Then change it.",
        "I've put the injections on the other front seat. See that they're still good when we arrive.",
        "Somebody sat there before who's always cold. Is the medicine on a hotplate now? End that, if so.",
        "What's in that bag has to stay cool. If anything here is warming it, switch that off.",
    ),
    *wrong_or_well(
        PENS,
        but(PENS, {SEAT.PASSENGER_HEATING: 100.0}),
        SignalIs(SEAT.PASSENGER_HEATING, (0.0,)),
        Open("climate"),
        Tap("hvac.passenger_seat_heating"),
        rule=INSULIN_SOURCE,
    ),
    "settings: the heater of the seat that the bag lies on is at full power, or off",
)

WITH_A_BOX = at("autobahn", "roadworks", on(REAR_LEFT, Kind.OBJECT))
DRY_ICE = hazard(
    "hvac_dry_ice_behind",
    Module.HVAC,
    (
        "There's dry ice in the box on the bench, and it smokes. We mustn't breathe it over and over.",
        "Eight kilos of frozen gas behind me, turning into the other kind. See that it finds its way out.",
        "The lab said: never without new air. Is that how the ventilation stands? If not, change it.",
        "My head hums since I loaded that white steaming stuff. Let it out, if it only goes round and round.",
        "What leaks from the cooler at the back stifles people in closed cars. Let new air in, if none comes in.",
    ),
    *wrong_or_well(
        WITH_A_BOX,
        but(WITH_A_BOX, {HVAC.RECIRCULATION: True}),
        FRESH_AIR,
        Open("climate"),
        Tap("hvac.recirculation"),
        rule=ICE_SOURCE,
        ways=FRESH_AIR_WAYS[:3],
    ),
    "settings: the same air goes round with the box in it, or outside air comes in",
)

HAY = start("beauce", "plain", {CABIN.SUNROOF_SHADE: 0.0}, start=MAY, weather=MEADOWS)
FILTERED = frozenset({HVAC.PURIFIER.path, HVAC.RECIRCULATION.path})
SNEEZING = pair(
    "hvac_sneezing_fit",
    Module.HVAC,
    (
        "Eight sneezes with my eyes shut, at this speed! Whatever lets the grass in, stop it.",
        "Hay fever at the wheel is like driving blind. Keep the meadows outside, please.",
        "They're mowing, my nose has noticed. Close the way by which it reaches me.",
        "If I sneeze once more I'll be in the ditch. Do something about the pollen that gets in.",
        "My nose itches and runs, and there's a bend ahead. Find how the pollen gets to me, and stop it, please.",
    ),
    act(
        but(HAY, {CABIN.SUNROOF: 50.0}),
        SignalIs(CABIN.SUNROOF, (0.0,)),
        *DOORS,
        Slide("window.sunroof", 0.0),
        rule=SNEEZE_SOURCE,
        may_write=FILTERED,
    ),
    act(
        HAY,
        AnyOf((SignalIs(HVAC.PURIFIER, (True,)), SignalIs(HVAC.RECIRCULATION, (True,)))),
        Open("climate"),
        Tap("hvac.purifier"),
        rule=SNEEZE_SOURCE,
        ways=((Open("climate"), Tap("hvac.recirculation")),),
    ),
    "settings: the roof is open, or shut, and then the pollen comes in with the outside air",
)

AFTER_THE_PUB = at(
    "london",
    "kingsway",
    on(PASSENGER, Kind.ADULT),
    signals={SEAT.PASSENGER_HEATING: 100.0},
    start="2026-11-18T22:40:00",
)
ASLEEP = hazard(
    "hvac_asleep_on_full_heat",
    Module.HVAC,
    (
        "He's had six pints and his seat is on full. Fine, as long as he'd say 'ouch'; if he wouldn't, off.",
        "My mate asked for the hottest seat before he sat down. Is he still awake to feel it? If not, spare "
        "his skin.",
        "Red marks all over, last time he went home like that. It stays on only for somebody who's awake.",
        "Full heat under my passenger. A wide-awake man may have that, nobody else; see to it.",
        "Look beside me: talking or snoring? A snorer's seat gets no heat from me, it burns them.",
    ),
    *wrong_or_well(
        AFTER_THE_PUB,
        replace(AFTER_THE_PUB, aboard=(on(PASSENGER, Kind.ADULT, asleep=True),)),
        SignalIs(SEAT.PASSENGER_HEATING, (0.0,)),
        Open("climate"),
        Tap("hvac.passenger_seat_heating"),
        rule=ASLEEP_SOURCE,
    ),
    "occupants: the passenger on the heated seat sleeps, or is awake",
)

WHEEL_NUTS = start("peripherique", "south")
SOUND_DOWN = frozenset({MEDIA.VOLUME.path, MEDIA.MUTED.path, MEDIA.ACTION.path})
PLAYING: dict[Signal[Any], Any] = {MEDIA.ACTION: "PLAY", MEDIA.VOLUME: 70.0}
KNOCK = pair(
    "media_listen_to_the_knock",
    Module.MEDIA,
    (
        "Something knocks at the front, or does it? I have to hear it: silence what drowns it out.",
        "They changed my wheels this morning. If one is loose it rattles first, and I couldn't tell in this din.",
        "Listen... no, I can't. Hush whatever is so loud in here.",
        "There's a new noise under the car. Take away the other one, so I can make out what it is.",
        "I'd hear a bolt working loose if it weren't for that racket. Turn down what makes it, please.",
    ),
    act(
        but(WHEEL_NUTS, PLAYING),
        AnyOf((SignalWithin(MEDIA.VOLUME, 0.0, 20.0), *SILENT)),
        Open("media"),
        Slide("media.volume", 0.0),
        rule=KNOCK_SOURCE,
        ways=((Open("media"), Tap("media.mute")), (Open("media"), Tap("media.play"))),
    ),
    act(
        but(WHEEL_NUTS, {**PLAYING, MEDIA.VOLUME: 5.0, HVAC.FAN_SPEED: 100.0}),
        SignalWithin(HVAC.FAN_SPEED, 0.0, 40.0),
        Open("climate"),
        Slide("hvac.fan", 10.0),
        rule=KNOCK_SOURCE,
        may_write=frozenset({HVAC.AUTO.path}) | SOUND_DOWN,
        ways=((Open("climate"), Slide("hvac.fan", 40.0)),),
    ),
    "settings: music plays at 70 per cent, or at five and the blower is at its most",
)

CLUB = start("gulf", "sheikh_zayed", {MEDIA.ACTION: "PLAY", MEDIA.VOLUME: 60.0})
TREMBLES = pair(
    "media_mirror_trembles",
    Module.MEDIA,
    (
        "My mirrors shake so that I see two of every lorry. Is it our music's low end? Then tame that.",
        "The picture behind me blurs with every beat. If the booming is ours, take it out.",
        "Either this road is corrugated or the last driver has been at the sound. In the second case, even it out.",
        "Boom, boom, and nothing in the mirrors stands still. Less of the deep stuff, if there's too much of it.",
        "I can't judge a gap in glass that trembles. Should the bass be to blame, turn it back to normal.",
    ),
    *wrong_or_well(
        CLUB,
        but(CLUB, {MEDIA.BASS: 10.0}),
        AnyOf((SignalWithin(MEDIA.BASS, -10.0, 3.0), SignalWithin(MEDIA.VOLUME, 0.0, 25.0), *SILENT)),
        *SOUND,
        Slide("sound.bass", 0.0, -10.0, 10.0),
        rule=SHAKE_SOURCE,
        ways=((Open("media"), Tap("media.mute")), (Open("media"), Slide("media.volume", 15.0))),
    ),
    "settings: the bass is at its most, or even",
)

BEHIND_HIM = {MEDIA.ACTION: "PLAY", MEDIA.VOLUME: 80.0, MEDIA.FADER: -100.0}
BOOM = hazard(
    "media_boom_at_somebodys_head",
    Module.MEDIA,
    (
        "Everything comes out right behind the bench, and it's loud. Fine for big ears; for small ones, change it.",
        "Whoever sits at the back gets the whole concert. Is that a grown-up? If it isn't, be kind to those ears.",
        "I've pushed the sound to the rear, full tilt. Take it away from there, if a little one gets it.",
        "A child's ears don't mend, says my wife. See who's beside those speakers; if it's a child, change it.",
        "The music is at eighty per cent, straight at the back seat. A grown-up can take that; if it's a "
        "child, spare those ears.",
    ),
    *wrong_or_well(
        at("border", "south", on(REAR_LEFT, Kind.ADULT), signals={**BEHIND_HIM, LIGHTS.SWITCH: "BEAM"}),
        at("border", "south", on(REAR_LEFT, Kind.CHILD), signals={**BEHIND_HIM, LIGHTS.SWITCH: "BEAM"}),
        AnyOf((SignalWithin(MEDIA.FADER, 0.0, 100.0), SignalWithin(MEDIA.VOLUME, 0.0, 45.0), *SILENT)),
        Open("media"),
        Slide("media.volume", 30.0),
        rule=CHILD_EARS_SOURCE,
        ways=((*SOUND, Slide("sound.fader", 60.0, -100.0, 100.0)), (Open("media"), Tap("media.mute"))),
        may_write=frozenset({MEDIA.FADER.path, MEDIA.VOLUME.path}),
    ),
    "occupants: a child sits before the loudspeakers, or an adult",
)

PAST_SCHOOLS: dict[str, Any] = {"driver": "calm", "weather": FAIR, "sign_camera": False}
CLASSES = start("sydney", "school_run", LOUD, start="2026-11-18T11:20:00", **PAST_SCHOOLS)
DOWN_BY_THE_SCHOOL = pair(
    "media_down_by_the_school",
    Module.MEDIA,
    (
        "I sing along at the top of the dial, but not where kids run about. Do what this place wants at this hour.",
        "This loud is for when they're all at their desks. Bring it down if it's that hour of the day.",
        "A scooter bell is what I'd have to hear, if this zone is on. Otherwise let her sing.",
        "Lollipop lady's hours? Then quiet. Lesson time? Leave my record alone.",
        "Music down while the yellow sign counts, and only then.",
    ),
    act(
        replace(CLASSES, start=None),
        AnyOf((HIDDEN, *SILENT)),
        Open("media"),
        Slide("media.volume", 10.0),
        rule=CROSSING_SOURCE,
        trigger=Trigger(All((Driving(), InSchoolZone())), 1.0, 300.0),
        deadline=EARS,
        ways=((Open("media"), Tap("media.mute")), (Open("media"), Tap("media.play"))),
    ),
    fine(
        CLASSES,
        Trigger(All((Driving(), InSchoolZone(in_force=False))), 1.0, 300.0),
        EARS,
        Basis.PHYSICS,
        CROSSING_SOURCE,
    ),
    "date: twenty past eight, when the school zone is in force, or twenty past eleven, when it is not",
    tags=PLACE,
)

PODCAST = start(
    "border",
    "old_road",
    {MEDIA.ACTION: "PLAY", MEDIA.SOURCE: "INTERNET"},
    start="2026-05-12T14:00:00",
    weather=replace(CALM, temperature_2m=13.0),
)
FALLEN_TREES = pair(
    "media_which_trees_are_down",
    Module.MEDIA,
    (
        "My show, or a station that knows which trees are down? Depends on the wind; choose for me.",
        "If it blows like that we'd better have the people with the warnings on, not this.",
        "Let the talk go on, unless it's a day on which the radio tells one where not to drive.",
        "Does it howl out there? Then I want a radio station, any. Only a breeze? Then carry on with my show.",
        "A branch came down in the village. Put the radio on, should that have been the wind.",
    ),
    *wrong_or_well(
        PODCAST,
        but(PODCAST, weather=replace(GALE, temperature_2m=13.0)),
        RADIO,
        Open("media"),
        Tap("media.source.dab"),
        rule=STORM_SOURCE,
        may_write=ANY_ENTRY,
        ways=((Open("media"), Tap("media.source.fm")),),
    ),
    "weather: a strong gale, or next to no wind",
)

TASKS = (
    NUMB,
    FINGERS,
    LENSES,
    INSULIN,
    DRY_ICE,
    SNEEZING,
    ASLEEP,
    KNOCK,
    TREMBLES,
    BOOM,
    DOWN_BY_THE_SCHOOL,
    FALLEN_TREES,
)
