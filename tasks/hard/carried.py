"""A value is read in one place and used in another: a corrected number, another unit, a sum, a place in a list."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.apps.trip import TripMeter
from automotive_cosim.cockpit.signals import ADAS, ENERGY, MEDIA, MIRROR
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Counted, Entered, Filed, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import AppDataAt, SaysFigure, SeatAsStored
from automotive_cosim.tasking.task import Ability, Deadline, Half, Module, Start
from automotive_cosim.tasks.hard.forms import (
    BEA,
    BEFORE_LEAVING,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    PARKED,
    PRIYA,
    READ,
    THE_OTHER_WAITS,
    THEO,
    WANDA,
    Moves,
    done,
    figure,
    hard,
    knowing,
    letter,
    with_letter,
    with_papers,
    write_to,
)

PAIRS_OF_DIGITS = ("47", "83", "26", "91", "58", "35")
TURNED = {digits: digits[::-1] for digits in PAIRS_OF_DIGITS}
NEW_NUMBER = {digits: f"My new number: 404 1{digits[::-1]}" for digits in PAIRS_OF_DIGITS}
CORRECTION = {digits: f"Sorry, it ends in {digits}, not {digits[::-1]}" for digits in PAIRS_OF_DIGITS}


def _keys(ending: str) -> tuple[Tap, ...]:
    """Keys 4 0 4 1 and the last two digits, of this pair or turned round."""
    means = [
        {digits: f"phone.key.{(digits if ending == 'right' else digits[::-1])[at]}" for digits in TURNED}
        for at in (0, 1)
    ]
    return (*(Tap(f"phone.key.{digit}") for digit in "4041"), *(Tap(param("digits", each)) for each in means))


KEYPAD = (Open("phone"), Tap("phone.tab.keypad"))
CORRECTED_NUMBER = hard(
    "hard_corrected_number",
    Module.COMMS,
    (
        "Malik has sent me his new number; ring him on that one.",
        "Call Malik, but dial what he wrote: the contact is out of date.",
        "There's a message from Malik with a number in it. Key it in and call.",
        "I need Malik on the line. Don't take the old entry, he texted where he can be reached now.",
    ),
    done(
        with_letter(PARKED, MALIK, param("digits", NEW_NUMBER), param("digits", CORRECTION)),
        Entered("calls", param("digits", {digits: f"4041{digits}" for digits in TURNED})),
        (*letter(MALIK), *KEYPAD, *_keys("right"), Tap("phone.call_number")),
        slips=(
            (*letter(MALIK), *KEYPAD, *_keys("turned"), Tap("phone.call_number")),
            (Open("phone"), Tap(text=MALIK), Tap("contact.call")),
        ),
        deadline=THE_OTHER_WAITS,
    ),
    done(
        with_letter(PARKED, MALIK, "Lost my phone!", param("digits", NEW_NUMBER)),
        Entered("calls", param("digits", {digits: f"4041{digits[::-1]}" for digits in TURNED})),
        (*letter(MALIK), *KEYPAD, *_keys("turned"), Tap("phone.call_number")),
        slips=((Open("phone"), Tap(text=MALIK), Tap("contact.call")),),
        deadline=THE_OTHER_WAITS,
    ),
    "content: his second line corrects the last two digits, or there is no correction",
    parameters={"digits": PAIRS_OF_DIGITS},
    ability=Ability.CONTENT,
    guess_loses=(
        "The first line has a number too, and the phone book another; only his second line tells which digits are"
        " right."
    ),
)

SEATS = (Open("vehicle"), Tap("vehicle.tab.seats"))
PHYSIO = {40: "60", 50: "50", 60: "70", 70: "80", 80: "90"}
"""Lumbar support in the memo, and the seat's position in millimetres."""
PHYSIO_MEMO = {lumbar: f"Physio: {mm} mm, height 40, back 18, lumbar {lumbar}" for lumbar, mm in PHYSIO.items()}


def _physio(before: Moves, after: Moves) -> Moves:
    return (
        Open("memo"),
        *SEATS,
        *before,
        TapUntil(
            "seat.driver.position.decrease",
            "seat.driver.position.value",
            param("lumbar", {k: f"{v} mm" for k, v in PHYSIO.items()}),
        ),
        TapUntil("seat.driver.height.increase", "seat.driver.height.value", "40 mm"),
        TapUntil("seat.driver.recline.decrease", "seat.driver.recline.value", "18°"),
        TapUntil("seat.driver.lumbar.increase", "seat.driver.lumbar.value", "{lumbar} %"),
        *after,
    )


SEAT_FROM_MEMO = hard(
    "hard_seat_from_memo",
    Module.SYSTEM,
    (
        "The physio's values are in my memos. Store them as seat place 2, then give me place 1 back.",
        "Put the seat the way the memo says, keep that under 2, and return me to what's saved under 1.",
        "I want memory 2 to hold what the physio wrote down; afterwards I'd like to sit as in 1 again.",
        "Please set and save the physio position from my notes in slot two, and finish with slot one recalled.",
    ),
    done(
        with_papers(PARKED, memos=(param("lumbar", PHYSIO_MEMO),)),
        AllOf(
            (
                AppDataAt(
                    "seat.memory",
                    1,
                    param(
                        "lumbar",
                        {k: (float(v), 40.0, 18.0, float(k), 0.0, 0.0, 0.0, 0.0) for k, v in PHYSIO.items()},
                    ),
                ),
                SeatAsStored(1),
            )
        ),
        _physio((), (Tap("seat.store.2"), Tap("seat.memory.1"))),
        slips=(
            _physio((Tap("seat.store.2"),), (Tap("seat.memory.1"),)),
            _physio((), (Tap("seat.store.1"), Tap("seat.memory.1"))),
            _physio((), (Tap("seat.store.2"),)),
        ),
        may_write=frozenset(),
    ),
    parameters={"lumbar": tuple(PHYSIO)},
    ability=Ability.CHAIN,
    guess_loses=(
        "Storing before the seat stands right, or under 1, spoils the place that has to be recalled at the end."
    ),
)

TRAILER = {30: 45, 40: 60, 55: 85, 60: 95, 65: 100}
"""Miles an hour, and the highest step of 5 km/h that is no faster."""
ASSISTANCE = (Open("vehicle"), Tap("vehicle.tab.assistance"))


def _limiter(kmh: Any) -> Moves:
    return (
        *letter(THEO),
        *ASSISTANCE,
        TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", kmh),
        Tap("adas.limiter"),
    )


BORROWED = replace(PARKED, signals={ADAS.LIMITER_SPEED.path: 140.0})
TRAILER_LIMIT = hard(
    "hard_trailer_limit",
    Module.ROAD,
    (
        "Theo wrote how fast his trailer may go. Set the limiter to the highest step that isn't above it, and on.",
        "I've hitched Theo's trailer: limiter on, as close to what he allows as it goes without exceeding it.",
        "Read what top speed Theo gives for his trailer and have the limiter keep me just below that.",
        "That trailer belongs to Theo, and he texted how fast it may go. Limiter on at that speed,"
        " rounded down to a step.",
    ),
    done(
        with_letter(
            BORROWED, THEO, "Enjoy!", param("mph", {mph: f"Never tow it above {mph} mph" for mph in TRAILER})
        ),
        AllOf(
            (
                SignalIs(ADAS.LIMITER_SPEED, (param("mph", {mph: float(kmh) for mph, kmh in TRAILER.items()}),)),
                SignalIs(ADAS.LIMITER_ACTIVE, (True,)),
            )
        ),
        _limiter(param("mph", {mph: f"{kmh} km/h" for mph, kmh in TRAILER.items()})),
        slips=(
            _limiter("{mph} km/h"),
            _limiter(param("mph", {mph: f"{kmh + 5} km/h" for mph, kmh in TRAILER.items()})),
        ),
        may_write=READ,
    ),
    done(
        with_letter(
            BORROWED, THEO, "Enjoy!", param("mph", {mph: f"Never tow it above {mph} km/h" for mph in TRAILER})
        ),
        AllOf(
            (
                SignalIs(ADAS.LIMITER_SPEED, (param("mph", {mph: float(mph) for mph in TRAILER}),)),
                SignalIs(ADAS.LIMITER_ACTIVE, (True,)),
            )
        ),
        _limiter("{mph} km/h"),
        slips=(_limiter(param("mph", {mph: f"{kmh} km/h" for mph, kmh in TRAILER.items()})),),
        may_write=READ,
    ),
    "content: the message gives the speed in miles or in kilometres an hour",
    parameters={"mph": tuple(TRAILER)},
    ability=Ability.CONTENT,
    guess_loses="The figure fits either unit; who does not read it sets a limit that is 60 % off.",
)

LAKE = {90: 65, 100: 70, 110: 75, 130: 85, 150: 95}
"""Kilometres one way, and the limit: there and back at 388 km per charge (30 % are 116 km) and 15 %, up to 5."""
BOTH_WAYS = {90: (150, 55), 100: (190, 65), 110: (210, 70), 130: (250, 80), 150: (270, 85)}
"""Kilometres in all, and the limit."""
FERRY = ("10:00", "10:30", "09:30", "11:00")
HOUR_BEFORE = {"10:00": "09:00", "10:30": "09:30", "09:30": "08:30", "11:00": "10:00"}


BEFORE_THE_FERRY = param("ferry", HOUR_BEFORE)


def _charge(limit: Any, by: Any = BEFORE_THE_FERRY) -> Moves:
    return (
        Open("memo"),
        Open("calendar"),
        Open("charging"),
        Slide("charging.limit", limit, 50.0, 100.0),
        TapUntil("charging.schedule.later", "charging.schedule.time", by),
        Tap("charging.schedule"),
    )


def _lake(memo: Any) -> Start:
    agenda = (
        Appointment(param("ferry"), "Ferry to the lake", "Bridge Car Park"),
        Appointment("19:00", "Dinner", "Home"),
    )
    early = replace(PARKED, start="2026-11-18T05:10:00", signals={ENERGY.LEVEL.path: 30.0})
    return with_papers(early, memos=("Bread, milk, batteries", memo), agenda=agenda)


def _charged(limit: Any) -> AllOf:
    return AllOf(
        (SignalIs(ENERGY.CHARGE_LIMIT, (limit,)), AppDataIs("charging.schedule", (param("ferry", HOUR_BEFORE),)))
    )


CHARGE_FOR_THE_LAKE = hard(
    "hard_charge_for_the_lake",
    Module.APPS,
    (
        "My memo has the way to the lake. Charge for there and back with 15 percent left over, next full five, and"
        " be ready an hour before the ferry.",
        "Set the charge limit so that the lake trip in my notes, return included, leaves me 15 percent, rounded"
        " up to fives; done one hour ahead of the ferry in the calendar.",
        "We're off to the lake and home again, distance in the memos: I want 15 percent in hand at the end. Limit"
        " to the five above. It has to be full an hour earlier than the ferry.",
        "Work out what the lake trip takes of the battery both ways, with 15 percent of it left at the end, round"
        " up to a multiple of five and make that the charge limit. It has to be done an hour before the ferry.",
    ),
    done(
        _lake(param("km", {km: f"The lake is {km} km away" for km in LAKE})),
        _charged(param("km", {km: float(limit) for km, limit in LAKE.items()})),
        _charge(param("km", LAKE)),
        slips=(
            _charge(100),
            _charge(55),
            _charge(param("km", LAKE), param("ferry")),
        ),
        may_write=frozenset(),
    ),
    done(
        _lake(param("km", {km: f"The lake and back: {all_km} km" for km, (all_km, _) in BOTH_WAYS.items()})),
        _charged(param("km", {km: float(limit) for km, (_, limit) in BOTH_WAYS.items()})),
        _charge(param("km", {km: limit for km, (_, limit) in BOTH_WAYS.items()})),
        slips=(_charge(100),),
        may_write=frozenset(),
    ),
    "content: the memo has the distance one way, or there and back",
    parameters={"km": tuple(LAKE), "ferry": FERRY},
    ability=Ability.PLANNING,
    guess_loses=(
        "The limit follows from a distance, from whether it is one way, and from what a charge goes; 100 or the"
        " present limit is wrong."
    ),
)

SINCE_FERRY = {
    18.3: (212.0, 38.8),
    17.6: (148.0, 26.0),
    19.4: (96.0, 18.6),
    16.2: (180.0, 29.2),
    21.5: (120.0, 25.8),
}
"""kWh per 100 km, and kilometres and kWh on trip B."""


def _use(words: dict[float, int], tenths: dict[float, int]) -> Moves:
    return figure(ISLA, "used", Tap("figure.more", param("use", words)), Tap("figure.up", param("use", tenths)))


USE_SINCE_THE_FERRY = hard(
    "hard_use_since_the_ferry",
    Module.COMMS,
    (
        "Isla wants my consumption since the ferry. Trip B has been running from there; send her kWh per 100, one"
        " decimal.",
        "Text Isla how much I've used per hundred kilometres since I left the boat: that's meter B, to a tenth.",
        "Work out from trip B what the car takes per 100 km and message it to Isla, rounded to one place.",
        "What have we burnt since the ferry, on B? Please let Isla have it in kWh/100 km, to the tenth.",
    ),
    done(
        with_papers(
            PARKED,
            contacts=knowing(ISLA),
            trip_b=param("use", {use: TripMeter(km * 1000, 9000.0, kwh) for use, (km, kwh) in SINCE_FERRY.items()}),
        ),
        SaysFigure(ISLA, "kWh per 100 km", param("use"), 0.1),
        (
            Open("trip"),
            Tap("trip.other"),
            *_use({use: int(use) - 15 for use in SINCE_FERRY}, {use: round(10 * (use % 1)) for use in SINCE_FERRY}),
        ),
        slips=(
            (Open("trip"), *figure(ISLA, "used")),
            (
                Open("trip"),
                Tap("trip.other"),
                *figure(
                    ISLA, "used", Tap("figure.more", param("use", {use: int(use) - 14 for use in SINCE_FERRY}))
                ),
            ),
        ),
        deadline=THE_OTHER_WAITS,
    ),
    parameters={"use": tuple(SINCE_FERRY)},
    ability=Ability.CONTENT,
    guess_loses="The meter that is shown first counts another way; only trip B ran from the ferry.",
)

LISTS = ("Road trip", "Sunday", "Dance", "Calm", "Classics")


def _file(last: str) -> Moves:
    return (
        *letter(BEA),
        Open("media"),
        Tap("media.list.playlists"),
        Tap(text="{playlist}"),
        Tap(last),
        Slide("media.volume", param("percent")),
    )


SONG_FOR_BEA = hard(
    "hard_song_for_bea",
    Module.MEDIA,
    (
        "Bea wrote which list this song should go on and how loud it may be. Do both, and let it play on.",
        "Put what's playing on the playlist that Bea asks for, at her volume; don't stop the song.",
        "See what Bea wants done with this track, list and loudness. It keeps running meanwhile.",
        "This one goes on a list, Bea's message says which and how loud it may be; keep playing from the USB"
        " stick.",
    ),
    done(
        with_letter(
            replace(
                ON_THE_ROAD,
                signals={
                    MEDIA.SOURCE.path: "USB",
                    MEDIA.SELECTED.path: "usb:{heard}",
                    MEDIA.ACTION.path: "PLAY",
                    MEDIA.VOLUME.path: 70.0,
                },
            ),
            BEA,
            "Great song! Add it to {playlist}",
            "And please, {percent} % at most, my ears",
        ),
        AllOf(
            (
                Filed("media.playlists", param("playlist"), "usb:{heard}"),
                SignalIs(MEDIA.VOLUME, (param("percent"),)),
                SignalIs(MEDIA.ACTION, ("PLAY",)),
                SignalIs(MEDIA.SELECTED, ("usb:{heard}",)),
            )
        ),
        _file("playlist.change"),
        slips=(_file("playlist.play"), (*_file("playlist.change"), Tap("playlist.play"))),
        may_write=READ,
        deadline=Deadline(75.0, "the song has little more than a minute left, and then it is another one"),
    ),
    parameters={"playlist": LISTS, "percent": (15, 20, 25, 30, 35), "heard": tuple(range(40))},
    tags=frozenset({"two_modules"}),
    ability=Ability.CONTENT,
    guess_loses="List and volume are in her message alone; five lists are there to be taken for hers.",
)

MOVED_TO = {"16:00": 2, "16:15": 3, "16:45": 5, "17:00": 6, "16:30": 4}
"""When the fitting is to be, and the quarters of an hour from 15:30."""
FITTINGS = (
    Appointment("11:30", "Kitchen fitting", "Home"),
    Appointment("15:30", "Dress fitting", "Work"),
    Appointment("18:00", "Choir", "Home"),
)


def _fitting(entry: int, quarters: dict[str, int], then: Moves) -> Moves:
    return (
        *letter(WANDA),
        Open("calendar"),
        Tap(f"calendar.{entry}"),
        *((Tap("appointment.hour_later", 4),) if entry == 0 else ()),
        Tap("appointment.later", param("time", quarters)),
        *then,
    )


SAYS_YES = (*write_to(WANDA), Tap(text="Yes"))
FITTING_MOVED = hard(
    "hard_fitting_moved",
    Module.APPS,
    (
        "Wanda has another time for the fitting. Put my calendar right and tell her yes.",
        "Change the appointment with Wanda to what she proposes in her message, then answer Yes.",
        "Wanda's asking to move something; correct the entry that she means and confirm with a yes.",
        "Read Wanda's text, move our appointment in the diary accordingly and reply that it's fine: Yes.",
    ),
    done(
        with_letter(PARKED, WANDA, "About the dress:", "can we make it {time} today?", agenda=FITTINGS),
        AllOf(
            (
                AppDataAt("calendar.entries", 1, param("time", {time: {"at": time} for time in MOVED_TO})),
                Entered("messages.sent", {"to": WANDA, "text": "Yes"}),
            )
        ),
        _fitting(1, MOVED_TO, SAYS_YES),
        slips=(
            _fitting(0, MOVED_TO, SAYS_YES),
            _fitting(1, MOVED_TO, ()),
        ),
    ),
    done(
        with_letter(PARKED, WANDA, "About the kitchen:", "can we make it {time} today?", agenda=FITTINGS),
        AllOf(
            (
                AppDataAt("calendar.entries", 0, param("time", {time: {"at": time} for time in MOVED_TO})),
                Entered("messages.sent", {"to": WANDA, "text": "Yes"}),
            )
        ),
        _fitting(0, MOVED_TO, SAYS_YES),
        slips=(_fitting(1, MOVED_TO, SAYS_YES),),
    ),
    "content: she writes about the dress or about the kitchen, and both have a fitting in the calendar",
    parameters={"time": tuple(MOVED_TO)},
    ability=Ability.CONTENT,
    guess_loses="Two appointments are fittings; her message alone tells which of them she means.",
)

STAYS = {"half an hour": 30, "an hour": 60, "two hours": 120, "four hours": 240}
MINUTES = param("stay", STAYS)


def _park(zone: str, then: Moves = ()) -> Moves:
    return (
        *letter(ISLA),
        Open("parking"),
        Tap(f"parking.zone.{zone}"),
        Tap(param("stay", {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()})),
        Tap("parking.pay"),
        *then,
    )


THANKS = (*write_to(ISLA), Tap(text="Thank you"))
ZONE_FROM_ISLA = hard(
    "hard_zone_from_isla",
    Module.APPS,
    (
        "Isla knows the zone here and how long we'll be. Pay as she says and text her 'Thank you'; 'No' if the car"
        " can't pay there.",
        "Get the parking ticket that Isla describes, nothing else will do, then send her a thank you. Not among the"
        " zones? Then she gets a plain No.",
        "Zone and time are in Isla's message: pay for exactly that and write 'Thank you' back, or 'No' should that"
        " zone be missing.",
        "Please buy what Isla wrote; once it's paid she gets our thank you. If it can't be bought in this car, tell"
        " her no.",
    ),
    done(
        with_letter(PARKED, ISLA, "You're in zone {zone}.", "We'll need {stay}"),
        AllOf(
            (
                Entered("payments", {"zone": "Zone {zone}", "minutes": MINUTES}),
                AppDataIs("parking.zone", ("Zone {zone}",)),
                AppDataIs("parking.minutes", (MINUTES,)),
                Entered("messages.sent", {"to": ISLA, "text": "Thank you"}),
            )
        ),
        (
            *letter(ISLA),
            Open("parking"),
            Tap(text="Zone {zone}"),
            Tap(param("stay", {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()})),
            Tap("parking.pay"),
            *THANKS,
        ),
        slips=(_park("a"),),
    ),
    done(
        with_letter(PARKED, ISLA, "You're in zone {elsewhere}.", "We'll need {stay}"),
        Entered("messages.sent", {"to": ISLA, "text": "No"}),
        (*letter(ISLA), Open("parking"), *write_to(ISLA), Tap(text="No")),
        slips=(_park("a", THANKS), _park("b", THANKS), _park("c", THANKS), (*letter(ISLA), *THANKS)),
    ),
    "content: a zone that the car can pay for, or one that is not among its three",
    parameters={"stay": tuple(STAYS), "zone": ("B", "C"), "elsewhere": ("F", "K", "R")},
    ability=Ability.CONTENT,
    guess_loses="The zone is in her message, and may be one that the car cannot pay for.",
)

LEFT_PAN = (30, -20, 40, -30, 20)
"""Per cent; the other three values of the memo are the same in all."""
MIRRORS = (Open("vehicle"), Tap("vehicle.tab.mirrors"))
MOVED_MIRRORS = {
    MIRROR.DRIVER_PAN.path: 0.0,
    MIRROR.DRIVER_TILT.path: 50.0,
    MIRROR.PASSENGER_PAN.path: 60.0,
    MIRROR.PASSENGER_TILT.path: 0.0,
}
MIRROR_MEMO = {pan: f"Mirrors: mine {pan}/20, other 30/-20" for pan in LEFT_PAN}
SIGNED = {pan: f"{pan:+d}" for pan in LEFT_PAN}
MINE = {pan: f"mirror.driver.pan.{'increase' if pan > 0 else 'decrease'}" for pan in LEFT_PAN}
OTHER_WAY = {pan: f"mirror.passenger.pan.{'increase' if pan > 60 else 'decrease'}" for pan in LEFT_PAN}


FOLD = (Tap("mirror.driver.fold"), Tap("mirror.passenger.fold"))
FOLDED = AllOf((SignalIs(MIRROR.DRIVER_FOLDED, (True,)), SignalIs(MIRROR.PASSENGER_FOLDED, (True,))))
AS_NOTED = {
    MIRROR.DRIVER_PAN: param("pan", {pan: float(pan) for pan in LEFT_PAN}),
    MIRROR.DRIVER_TILT: 20.0,
    MIRROR.PASSENGER_PAN: 30.0,
    MIRROR.PASSENGER_TILT: -20.0,
}
PUT_BACK = (
    Open("memo"),
    *MIRRORS,
    TapUntil(param("pan", MINE), "mirror.driver.pan.value", param("pan", SIGNED)),
    TapUntil("mirror.driver.tilt.decrease", "mirror.driver.tilt.value", "+20"),
    TapUntil("mirror.passenger.pan.decrease", "mirror.passenger.pan.value", "+30"),
    TapUntil("mirror.passenger.tilt.decrease", "mirror.passenger.tilt.value", "-20"),
)
CROSSED = (
    Open("memo"),
    *MIRRORS,
    TapUntil(param("pan", OTHER_WAY), "mirror.passenger.pan.value", param("pan", SIGNED)),
    TapUntil("mirror.passenger.tilt.increase", "mirror.passenger.tilt.value", "+20"),
    TapUntil("mirror.driver.pan.increase", "mirror.driver.pan.value", "+30"),
    TapUntil("mirror.driver.tilt.decrease", "mirror.driver.tilt.value", "-20"),
)
MIRRORS_FROM_MEMO = hard(
    "hard_mirrors_from_memo",
    Module.SYSTEM,
    (
        "The garage has turned my mirrors. The right values, sideways then up, are in the memos: put them back, and"
        " fold both for the night.",
        "Set both outside mirrors as my note has them (pan, then tilt), someone has fiddled with them; fold them in"
        " afterwards.",
        "I wrote down my mirror positions, first across, then height. The car wash has moved them: restore "
        "those, then fold the two in.",
        "My mirrors are off! Look up what I noted, pan before tilt, for mine and the other one,"
        " adjust them to that and fold them.",
    ),
    done(
        with_papers(replace(PARKED, signals=MOVED_MIRRORS), memos=(param("pan", MIRROR_MEMO), "Dentist on Friday")),
        AllOf((*(SignalIs(signal, (value,)) for signal, value in AS_NOTED.items()), FOLDED)),
        (*PUT_BACK, *FOLD),
        slips=((*CROSSED, *FOLD), (*MIRRORS, *FOLD), PUT_BACK),
        may_write=frozenset(),
        deadline=Deadline(
            120.0, "at 2.5 s a tap (Card, Moran and Newell 1983) forty taps take 100 s; he locks up then"
        ),
    ),
    parameters={"pan": LEFT_PAN},
    ability=Ability.CONTENT,
    guess_loses="Four values, two of them negative, stand in a memo and nowhere else.",
)

DRIVEN = (34, 52, 43, 61, 25)


def _client(reset: Moves) -> Moves:
    return (
        Open("memo"),
        Open("trip"),
        Tap("trip.other"),
        *figure(
            PRIYA,
            "driven",
            Tap("figure.more", param("km", {km: km // 10 for km in DRIVEN})),
            Tap("figure.up", param("km", {km: km % 10 for km in DRIVEN})),
        ),
        Open("trip"),
        *reset,
    )


RESET_A, RESET_B = (Tap("trip.reset"),), (Tap("trip.other"), Tap("trip_b.reset"))


def _metered(memo: str, resets: str, moves: Moves, *slips: Moves) -> Half:
    start = with_papers(
        PARKED,
        contacts=knowing(PRIYA),
        memos=(memo,),
        trip_b=param("km", {km: TripMeter(km * 1000.0, 3600.0, km / 6) for km in DRIVEN}),
    )
    goal = AllOf((SaysFigure(PRIYA, "driven", param("km"), 0.5), Counted(resets)))
    return done(start, goal, moves, slips=slips, deadline=BEFORE_LEAVING)


CLIENTS_METER = hard(
    "hard_clients_meter",
    Module.APPS,
    (
        "Next client. Text Priya the kilometres on trip B first, then zero the client's meter; my memo says which"
        " one that is.",
        "Send Priya what B has counted in km, afterwards reset the meter I keep for clients, see my notes. The"
        " other is for the tax.",
        "Before we start: B's distance goes to Priya by message. Then clear the clients' trip meter, A or B as"
        " noted, and never the tax one.",
        "Priya needs the km of meter B. When she has them, restart the one for clients; look in the memos for it.",
    ),
    _metered(
        "Trip A: tax. Trip B: clients",
        "trip.resets_b",
        _client(RESET_B),
        _client(RESET_A),
        _client((*RESET_A, *RESET_B)),
    ),
    _metered(
        "Trip A: clients. Trip B: tax",
        "trip.resets",
        _client(RESET_A),
        _client(RESET_B),
        _client((*RESET_A, *RESET_B)),
    ),
    "content: the memo names trip B as the clients' meter, or trip A",
    parameters={"km": DRIVEN},
    ability=Ability.CONTENT,
    guess_loses="Which meter is to be zeroed is in a memo, and the figure is gone once it is.",
)

TASKS = (
    CORRECTED_NUMBER,
    SEAT_FROM_MEMO,
    TRAILER_LIMIT,
    CHARGE_FOR_THE_LAKE,
    USE_SINCE_THE_FERRY,
    SONG_FOR_BEA,
    FITTING_MOVED,
    ZONE_FROM_ISLA,
    MIRRORS_FROM_MEMO,
    CLIENTS_METER,
)
