"""Word from others: what somebody has written, or the driver once noted, decides what the car has to be told."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind
from automotive_cosim.cockpit.apps.phone.state import Contact
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.cockpit.places import PlaceKind
from automotive_cosim.cockpit.signals import ADAS, CABIN, ENERGY, HMI, HVAC, LIGHTS, MEDIA, SEAT, Signal
from automotive_cosim.contracts import AlertKind
from automotive_cosim.tasking.checks import AlertGiven, AnyOf, AppDataIs, Check, Entered, SignalIs, SignalWithin
from automotive_cosim.tasking.moves import Move, Open, Slide, Tap, TapUntil, Warn
from automotive_cosim.tasking.task import Deadline, Half, Module, Start
from automotive_cosim.tasks.aboard import CABIN_SCREEN, DOORS, REAR_LEFT, REAR_RIGHT, act, at, hazard, on
from automotive_cosim.tasks.forms import (
    FRIENDS,
    LOOKS,
    PARKED_WHEN_WRITTEN,
    TALK,
    WHEN_WRITTEN,
    read_out,
    wrote,
)
from automotive_cosim.tasks.maps import SETS_OUT, named
from automotive_cosim.tasks.phenomenon_air import FRICTION
from automotive_cosim.tasks.road_law import FAIR
from automotive_cosim.tasks.under_way import ASSIST, start

GARAGES = ("Linden Garage", "Crown Garage", "Eagle Garage", "Bridge Garage")
RECALL_SOURCE = "makers warn of parts that are a serious risk until mended (Regulation (EU) 2018/858, article 14)"
FIRE_SOURCE = "a recalled battery is kept below a level until it is mended (as in NHTSA recall 20V-701)"
FEVER_SOURCE = "what a doctor advises for a patient aboard goes before the usual 21 degrees"
CLIMBING_SOURCE = "child locks and window locks are for children who open what they should not (FMVSS 206; UN R21)"
HELP_SOURCE = "who needs help has to be reached in the way that does not endanger her (emergency services' advice)"
SPILT_SOURCE = f"{FRICTION}; spilt diesel has as little grip as snow"
QUEUE_SOURCE = "at 80 km/h a car takes some 90 m to stop (reaction 2 s, 5 m/s2): who knows of a queue can"
SMOKE_SOURCE = "smoke fills a tunnel within minutes (Directive 2004/54/EC); a quay that is closed leads nowhere"
FLICKER_SOURCE = (
    "flickering pictures may cause fits, and a healing ear bears no loud sound: the doctor's word counts"
)
UNREAD_SOURCE = "a warning warns only who understands it (ISO 15005, on dialogues with drivers)"
BY_PRESSES = Deadline(
    75.0, "a message is heard in ten seconds, and a dozen presses take 2.5 s each (Card and others)"
)


def heard(
    begin: Start,
    line: str,
    goal: Check,
    *moves: Move,
    rule: str,
    ways: tuple[tuple[Move, ...], ...] = (),
    may_write: frozenset[str] = frozenset(),
    deadline: Deadline = TALK,
    who: str = "{who}",
) -> Half:
    """A half in which somebody (``who``) has written ``line``, and the rest follows from it."""
    look = read_out(who)
    return act(
        wrote(begin, (who, line)),
        goal,
        *look,
        *moves,
        rule=rule,
        ways=tuple((*look, *way) for way in ways),
        may_write=may_write | LOOKS,
        deadline=deadline,
        trigger=PARKED_WHEN_WRITTEN if begin.parked else WHEN_WRITTEN,
    )


CRUISING = start("beauce", "plain", {ADAS.CRUISE_ACTIVE: True, ADAS.CRUISE_SPEED: 80.0, LIGHTS.SWITCH: "BEAM"})
RECALL = hazard(
    "road_recall_letter",
    Module.ROAD,
    (
        "{who} has just sent me something about a recall. Until they've mended it, drive her as it says.",
        "There's a fault in this model, and {who} knows which. Do without that part from now on.",
        "Ping! {who}, and they never write for nothing. See that we come to no harm by what's broken.",
        "I can't read the letter from {who} at the wheel. Obey it for me, before the thing acts up.",
        "What did {who} find in my car? Whatever it is that I shouldn't use, stop using it.",
    ),
    heard(
        CRUISING,
        "Recall of your car: cruise control may speed up by itself. Please drive without it until the update.",
        SignalIs(ADAS.CRUISE_ACTIVE, (False,)),
        *ASSIST,
        Tap("adas.cruise"),
        rule=RECALL_SOURCE,
    ),
    heard(
        CRUISING,
        "Recall of your car: lane keeping may pull to one side. Please drive without it until the update.",
        SignalIs(ADAS.LANE_KEEPING, (False,)),
        *ASSIST,
        Tap("adas.lane_keeping"),
        rule=RECALL_SOURCE,
    ),
    "content: the garage recalls the cruise control, or the lane keeping",
    who=GARAGES,
)

AT_HOME = start("london", "bloomsbury", parked=True)
BATTERY = hazard(
    "apps_recall_of_the_battery",
    Module.APPS,
    (
        "{who} writes about the battery. I'll plug in tonight; have the charging set so that nothing happens.",
        "Is my car one of those in the news? {who} should know by now. Charge her as they say.",
        "Before I put the cable in: heed what {who} sent me about these cells.",
        "{who} has written about my battery, and my garage is of wood. Set the charging as they say.",
        "See how far {who} lets me fill the battery, and charge no further.",
    ),
    heard(
        AT_HOME,
        "Your battery is recalled: above 60 per cent a cell may catch fire. No further until we've seen it.",
        SignalWithin(ENERGY.CHARGE_LIMIT, 50.0, 60.0),
        Open("charging"),
        Slide("charging.limit", 60.0, 50.0, 100.0),
        rule=FIRE_SOURCE,
        ways=((Open("charging"), Slide("charging.limit", 50.0, 50.0, 100.0)),),
    ),
    heard(
        AT_HOME,
        "Your battery is fine, but its meter drifts and may strand you: charge it to 100 per cent once.",
        SignalIs(ENERGY.CHARGE_LIMIT, (100.0,)),
        Open("charging"),
        Slide("charging.limit", 100.0, 50.0, 100.0),
        rule=FIRE_SOURCE,
    ),
    "content: the garage forbids more than 60 per cent, or wants the battery full once",
    who=GARAGES,
)

MIDWIVES = ("Midwife Aylin", "Midwife Chloe", "Midwife Ingrid", "Midwife Yasmin")
MIDWIFE = hazard(
    "maps_the_midwife_writes",
    Module.MAPS,
    (
        "{who} has written, and my hands shake. Get me to where I'm needed.",
        "It's starting, or it isn't. {who} says where they are; go there.",
        "News from {who}! Don't ask me, just set the way.",
        "I can't look now. Wherever {who} wants me to be, that's where we're going.",
        "It's begun, I think. {who} knows where I should be; take me there.",
    ),
    heard(
        start("london", "euston"),
        "Contractions every four minutes: the ambulance has taken her to hospital. Come straight there.",
        AppDataIs("navigation.destination", named(PlaceKind.HOSPITAL)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.hospital"),
        Tap("explore.place.0"),
        SETS_OUT,
        rule=HELP_SOURCE,
    ),
    heard(
        start("london", "euston"),
        "Contractions every four minutes, too late for the ambulance: it'll be born here at home. Come home!",
        AppDataIs("navigation.destination", ("Home",)),
        Open("map"),
        Tap(text="Home"),
        SETS_OUT,
        rule=HELP_SOURCE,
    ),
    "content: the ambulance has taken her to hospital, or the child will be born at home",
    who=MIDWIVES,
)

AHEAD = start("beauce", "villages", weather=replace(FAIR, temperature_2m=9.0), start="2026-11-17T12:30:00")
FRIEND_AHEAD = hazard(
    "maps_she_drives_ahead",
    Module.MAPS,
    (
        "{who} is ten minutes ahead of us and has just written. Alert me to what she has met.",
        "Ping, from {who} in the other car. Something on the road? Then warn me of just that.",
        "I keep my eyes on the road, you look at what {who} writes; sound off with what lies ahead.",
        "{who} wouldn't text at the wheel for fun, she must have stopped. Give me the warning that fits.",
        "See what {who} saw on this road, and put up the right alert for me.",
    ),
    heard(
        AHEAD,
        "Diesel all over the road in the bend behind the next village, I slid right across it. I'm fine!",
        AlertGiven(AlertKind.SLIPPERY),
        Warn(AlertKind.SLIPPERY),
        rule=SPILT_SOURCE,
    ),
    heard(
        AHEAD,
        "A beet lorry has tipped over behind the next village. Nobody hurt, but everybody stands there.",
        AlertGiven(AlertKind.TRAFFIC),
        Warn(AlertKind.TRAFFIC),
        rule=QUEUE_SOURCE,
    ),
    "content: she has met spilt diesel, or a queue",
    who=FRIENDS,
)

MUM = Belongings(contacts=(Contact("Mum", "555 84 26"),))
OUT_OF_TOWN = start("nordic", "jukkasjarvi", {LIGHTS.SWITCH: "BEAM"}, belongings=MUM)
MOTHER = hazard(
    "comms_mother_alone_at_home",
    Module.COMMS,
    (
        "Mum never writes, she's eighty. We're on our way to her; get in touch as she wants it.",
        "A message from my mother, at this hour? Answer it in the way that's right for her.",
        "That was Mum. If she's in trouble, let her know that I'm coming, however that's best done.",
        "She's all alone out there. See what Mum needs of us, and reach her the way she says.",
        "Do what Mum asks in her message, and mind how.",
    ),
    heard(
        OUT_OF_TOWN,
        "I've fallen in the kitchen, my hip won't move and I can hardly see to write. Please ring me!",
        Entered("calls", "Mum"),
        Open("phone"),
        Tap("phone.tab.favourites"),
        Tap(text="Mum"),
        Tap("contact.call"),
        rule=HELP_SOURCE,
        who="Mum",
    ),
    heard(
        OUT_OF_TOWN,
        "Somebody's in the house! I'm in the wardrobe, the police know. Don't ring, he'd hear. Are you coming?",
        AnyOf(
            (
                Entered("messages.sent", {"to": "Mum", "text": "On my way"}),
                Entered("messages.sent", {"to": "Mum", "text": "Yes"}),
            )
        ),
        Tap(text="On my way"),
        rule=HELP_SOURCE,
        ways=((Tap(text="Yes"),),),
        who="Mum",
    ),
    "content: she has fallen and wants to be rung, or hides and must not be",
)

FETCHED = at("new_york", "madison", on(REAR_RIGHT, Kind.CHILD))
SITTERS = ("Nanny Aylin", "Nanny Chloe", "Nanny Ingrid", "Nanny Yasmin")
NANNY = hazard(
    "system_what_he_has_learnt",
    Module.SYSTEM,
    (
        "{who} tells me what he's learnt today. Is it something that I should fear in this car? Then prevent it.",
        "He's grinning so oddly back there. {who} has written; make what he can do now impossible in here.",
        "A proud message from {who}, and I have a feeling. See that his new trick doesn't work on my rear seat.",
        "My son is two and an engineer. Read what {who} says, and lock what he mustn't get open.",
        "{who} warns me of something he can do since this morning. Stop him from doing it while we drive.",
    ),
    heard(
        FETCHED,
        "Look out: today he found out how to open a car's door from inside. He's very proud of it!",
        SignalIs(CABIN.RIGHT_CHILD_LOCK, (True,)),
        *DOORS,
        Tap("door.child_right"),
        rule=CLIMBING_SOURCE,
        may_write=frozenset({CABIN.LEFT_CHILD_LOCK.path}),
    ),
    heard(
        FETCHED,
        "Look out: today he found the button of the car's window, and out went his head. He's very proud of it!",
        SignalIs(CABIN.WINDOW_LOCK, (True,)),
        *DOORS,
        Tap("window.lock"),
        rule=CLIMBING_SOURCE,
    ),
    "content: the child has learnt to open doors, or windows",
    who=SITTERS,
)

FILM_AND_SONG: dict[Signal[Any], Any] = {HMI.REAR_SCREEN: 60.0, MEDIA.ACTION: "PLAY", MEDIA.VOLUME: 60.0}
MEMOS = {
    "flicker": "Noah, from the clinic: no films for him, flicker may bring on a fit",
    "ear": "Noah, from the clinic: ear just operated on, no music above 30 per cent",
}


def noted(memo: str, goal: Check, *moves: Move, ways: tuple[tuple[Move, ...], ...]) -> Half:
    """A half in which that memo has been kept."""
    begin = at("peripherique", "streets", on(REAR_LEFT, Kind.CHILD), signals=FILM_AND_SONG)
    papers = Belongings(memos=("Bread, milk, batteries", MEMOS[memo]))
    return act(
        replace(begin, belongings=papers),
        goal,
        Open("memo"),
        *moves,
        rule=FLICKER_SOURCE,
        ways=tuple((Open("memo"), *way) for way in ways),
        deadline=TALK,
    )


NOAH = hazard(
    "apps_memo_about_noah",
    Module.APPS,
    (
        "I noted something about Noah when we left the clinic. See that nothing on his side goes against it.",
        "Noah's with us for the first time since the hospital. There was one thing he mustn't have; end that.",
        "What did the doctor forbid my boy? I kept it in a memo, and it may be on right now.",
        "Film, music, the usual for the back row. But check my note on Noah, and take away what harms him.",
        "Go by what I wrote down about Noah: something in here isn't good for him.",
    ),
    noted(
        "flicker",
        SignalIs(HMI.REAR_SCREEN, (0.0,)),
        CABIN_SCREEN,
        Slide("cabin.rear_screen", 0.0),
        ways=(),
    ),
    noted(
        "ear",
        AnyOf(
            (
                SignalWithin(MEDIA.VOLUME, 0.0, 30.0),
                SignalIs(MEDIA.MUTED, (True,)),
                SignalIs(MEDIA.ACTION, ("STOP",)),
            )
        ),
        Open("media"),
        Slide("media.volume", 20.0),
        ways=((Open("media"), Tap("media.mute")),),
    ),
    "content: a memo of the clinic's forbids films, or loud sound",
)

AGENCIES = ("Renata's agency", "Carla's agency", "Lea's agency", "Marie's agency")
WARNINGS = hazard(
    "system_warnings_she_can_read",
    Module.SYSTEM,
    (
        "She's to drive alone, and must understand when the car warns her. See what {who} writes about that.",
        "My relief has no English. {who} has written what she reads; don't let an alarm be Greek to her.",
        "If this thing shouts 'brake', it has to be in her language. Ask the message from {who} which one.",
        "She takes over from here. Make the car speak so that she gets it, as {who} says.",
        "The next driver sent by {who} couldn't read a single warning in here. Change that for her.",
    ),
    heard(
        start("autobahn", "rest", parked=True),
        "She'll be with you in five minutes. An excellent driver, but please note that she reads German only.",
        SignalIs(HMI.LANGUAGE, ("de",)),
        Open("settings"),
        Tap("settings.page.language"),
        Tap("language.de"),
        rule=UNREAD_SOURCE,
    ),
    heard(
        start("autobahn", "rest", parked=True),
        "She'll be with you in five minutes. An excellent driver, but please note that she reads French only.",
        SignalIs(HMI.LANGUAGE, ("fr",)),
        Open("settings"),
        Tap("settings.page.language"),
        Tap("language.fr"),
        rule=UNREAD_SOURCE,
    ),
    "content: the driver who takes over reads German only, or French only",
    who=AGENCIES,
)

PATIENT = at(
    "paris_centre",
    "foch",
    on(REAR_LEFT, Kind.CHILD),
    signals={HVAC.DRIVER_TEMPERATURE: 23.0, HVAC.PASSENGER_TEMPERATURE: 23.0},
    cabin={"temperature_c": 23.0},
)
BOTH_SIDES = frozenset(
    {HVAC.PASSENGER_TEMPERATURE.path, HVAC.SYNC.path, HVAC.AUTO.path, SEAT.REAR_LEFT_HEATING.path}
)
DOCTORS = ("Dr. Aylin", "Dr. Chloe", "Dr. Ingrid", "Dr. Yasmin")
PATIENT_BEHIND = hazard(
    "hvac_the_doctor_about_his_temperature",
    Module.HVAC,
    (
        "I sent {who} his temperature, and there's the answer. Give him the air that he needs until we're there.",
        "{who} has looked at the figure. Is it wrong in here for him? Then as the doctor says, please.",
        "He's so quiet behind me. Do with the heating what {who} writes.",
        "Another ten minutes to the practice. What does {who} want us to do in here for him? Do it.",
        "Set the climate by what {who} says about my boy, not by what I like.",
    ),
    heard(
        PATIENT,
        "39.8 is too much for him. Keep it cool in the car, no more than 20 degrees, and bring him in.",
        SignalWithin(HVAC.DRIVER_TEMPERATURE, 16.0, 20.0),
        Open("climate"),
        TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "20.0 °C"),
        rule=FEVER_SOURCE,
        may_write=BOTH_SIDES,
        deadline=BY_PRESSES,
        ways=(
            (Open("climate"), TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "19.0 °C")),
        ),
    ),
    heard(
        PATIENT,
        "34.9, he has been in that water too long. Keep it warm in the car, 26 degrees at least, and bring him in.",
        SignalWithin(HVAC.DRIVER_TEMPERATURE, 26.0, 28.0),
        Open("climate"),
        TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "26.0 °C"),
        rule=FEVER_SOURCE,
        may_write=BOTH_SIDES,
        deadline=BY_PRESSES,
        ways=(
            (Open("climate"), TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "27.0 °C")),
        ),
    ),
    "content: the doctor wants him cool, or warm",
    who=DOCTORS,
)

OPTIONS = (Open("map"), Tap("map.route"), Tap("route.tab.options"))
SHUT = hazard(
    "maps_what_has_happened_on_the_way",
    Module.MAPS,
    (
        "{who} lives down there and has just written. Keep our route out of whatever has happened.",
        "There's smoke over the valley, and {who} knows why. Plan so that we don't run into it.",
        "A message from {who}: something has gone wrong on the way. Leave out that kind of thing for today.",
        "I won't drive into it if I'm told in time. See what {who} says, and set the route options by it.",
        "Let {who}'s news decide which sort of road we do without on this trip.",
    ),
    heard(
        start("sydney", "richmond"),
        "A truck is on fire in the tunnel, they've all run out. Don't go into any of them today!",
        AppDataIs("navigation.avoid", (["tunnels"],)),
        *OPTIONS,
        Tap("route.avoid.tunnels"),
        rule=SMOKE_SOURCE,
    ),
    heard(
        start("sydney", "richmond"),
        "The ferry is on fire at the landing, they've all jumped off. Don't take any of them today!",
        AppDataIs("navigation.avoid", (["ferries"],)),
        *OPTIONS,
        Tap("route.avoid.ferries"),
        rule=SMOKE_SOURCE,
    ),
    "content: a tunnel is on fire, or a ferry",
    who=FRIENDS,
)

TASKS = (
    RECALL,
    BATTERY,
    MIDWIFE,
    FRIEND_AHEAD,
    MOTHER,
    NANNY,
    NOAH,
    WARNINGS,
    PATIENT_BEHIND,
    SHUT,
)
