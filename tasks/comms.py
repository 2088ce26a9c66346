"""Comms: calls, messages and the phone."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.signals import CALL, MEDIA, VOICE
from automotive_cosim.tasking.checks import AllOf, AppDataHas, AppDataIs, Entered, EnteredOf, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.task import Deadline, Module
from automotive_cosim.tasking.triggers import All, Driving, Not, SignalAbove, SignalHas, Trigger
from automotive_cosim.tasks.comms_safety import PAIRS
from automotive_cosim.tasks.forms import DEVICES, PARIS, asked, hinted, linked, locked

RINGING = Trigger(All((Driving(), Not(SignalHas(CALL.RINGING, "")))), for_s=2.0, within_s=180.0)
CALLED = replace(PARIS, arrivals=tuple(Arrival("call", at_s) for at_s in (15.0, 70.0, 125.0)))
"""Repeated calls, so that one of them rings while the car moves."""
WHILE_IT_RINGS = Deadline(25.0, "a call rings for 30 s at most (ETSI TS 122 082), and has rung for 2 s already")
WRITTEN_BEFORE = 3.0
"""Number of senders with unread messages at the start."""
TOLD = {
    "I'm on my way": "On my way",
    "I've arrived": "I've arrived",
    "I'll be ten minutes late": "I'll be 10 minutes late",
    "thanks": "Thank you",
}
"""What the driver says, and the reply in the list that says it."""
DIGITS = tuple("0123456789")

EXPLICIT = (
    asked(
        "comms_call_anybody",
        Module.COMMS,
        (
            "Look {contact} up in my contacts and call.",
            "{contact} must be in the phone book: give them a ring.",
            "Find the number of {contact} and phone there.",
            "Start a call with {contact}, one of my contacts.",
        ),
        Entered("calls", param("contact")),
        Open("phone"),
        Tap("phone.tab.contacts"),
        Tap(text="{contact}"),
        Tap("contact.call"),
        parameters={"contact": FromCockpit("contacts")},
    ),
    asked(
        "comms_tell_favourite",
        Module.COMMS,
        (
            "Tell {contact}: {words}.",
            "Write to {contact}, {words}.",
            "Send {contact} a message that says {words}.",
            "Could you text {words} to {contact}?",
        ),
        Entered("messages.sent", {"to": param("contact"), "text": param("words", TOLD)}),
        Open("phone"),
        Tap(text="{contact}"),
        Tap("contact.message"),
        Tap(text=param("words", TOLD)),
        parameters={"contact": FromCockpit("favourite_contacts"), "words": tuple(TOLD)},
    ),
    asked(
        "comms_read_and_answer",
        Module.COMMS,
        (
            "Read me what {contact} wrote, answer {words}, then do not disturb.",
            "What does {contact} want? Reply {words}, and after that nobody gets through.",
            "Play {contact}'s message to me, send back {words}, switch the ringing off.",
            "Read me the new message from {contact}, reply {words}, then do not disturb, please.",
        ),
        AllOf(
            (
                AppDataHas("messages.read", param("contact")),
                Entered("messages.sent", {"to": param("contact"), "text": param("words", TOLD)}),
                AppDataIs("phone.do_not_disturb", (True,)),
            )
        ),
        Open("phone"),
        Tap("phone.tab.messages"),
        Tap(text="{contact}"),
        Tap("thread.read"),
        Tap(text=param("words", TOLD)),
        Tap("phone.do_not_disturb"),
        slips=(
            (
                Open("phone"),
                Tap("phone.tab.messages"),
                Tap(text="{contact}"),
                Tap(text=param("words", TOLD)),
                Tap("phone.do_not_disturb"),
            ),
        ),
        parameters={"contact": FromCockpit("unread"), "words": tuple(TOLD)},
    ),
    asked(
        "comms_call_without_music",
        Module.COMMS,
        (
            "Mute the music, call volume to {percent}, and ring {contact}.",
            "Get {contact} on the line; media muted, calls at {percent}.",
            "I want to hear {contact} well: {percent} for calls, the songs muted, then phone.",
            "Mute the songs, calls at {percent}, and call {contact}, please.",
        ),
        AllOf(
            (
                SignalIs(MEDIA.MUTED, (True,)),
                SignalIs(VOICE.CALL_VOLUME, (param("percent"),)),
                Entered("calls", param("contact")),
            )
        ),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.calls", param("percent")),
        Tap("sound.mute"),
        Open("phone"),
        Tap(text="{contact}"),
        Tap("contact.call"),
        start=replace(PARIS, signals={MEDIA.ACTION.path: "PLAY"}),
        parameters={"contact": FromCockpit("favourite_contacts"), "percent": (60, 65, 70, 75, 80, 85, 90)},
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "comms_answer_call",
        Module.COMMS,
        (
            "Pick up.",
            "Answer that call, please.",
            "I'll take it, put them through.",
            "Yes, I want to talk to whoever is ringing.",
        ),
        EnteredOf("calls.answered", CALL.RINGING),
        Tap("call.answer"),
        ways=((Open("phone"), Tap("phone.answer")),),
        start=CALLED,
        trigger=RINGING,
        deadline=WHILE_IT_RINGS,
    ),
    asked(
        "comms_decline_with_words",
        Module.COMMS,
        (
            "Not now. Tell them I'm driving and will call later.",
            "Turn the call down with the line about driving and calling back.",
            "Decline, and let them know by message that I ring later, I'm at the wheel.",
            "I can't talk; send whoever it is my usual 'driving, later'.",
        ),
        AllOf(
            (
                EnteredOf("calls.declined", CALL.RINGING),
                Entered("messages.sent", {"text": "I'm driving, I'll call later"}),
            )
        ),
        Tap("call.reply"),
        Tap(text="I'm driving, I'll call later"),
        start=CALLED,
        trigger=RINGING,
        deadline=WHILE_IT_RINGS,
    ),
    asked(
        "comms_drop_favourite",
        Module.COMMS,
        (
            "Take {contact} off my favourites.",
            "{contact} needn't be a favourite any more.",
            "Remove the star from {contact}.",
            "I hardly ever phone {contact}, so clear that one out of the quick list.",
        ),
        AppDataHas("phone.favourites", param("contact"), there=False),
        Open("phone"),
        Tap(text="{contact}"),
        Tap("contact.favourite"),
        parameters={"contact": FromCockpit("favourite_contacts")},
    ),
    locked(
        "comms_dial_number",
        Module.COMMS,
        (
            "Dial {one}{two} {three}{four}{five} on the keypad.",
            "Type in {one}{two} {three}{four}{five} and call.",
            "The number is {one}{two} {three}{four}{five}, ring it.",
            "Key in {one}{two} {three}{four}{five} for me and make the call.",
        ),
        Entered("calls", "{one}{two}{three}{four}{five}"),
        Open("phone"),
        Tap("phone.tab.keypad"),
        Tap("phone.key.{one}"),
        Tap("phone.key.{two}"),
        Tap("phone.key.{three}"),
        Tap("phone.key.{four}"),
        Tap("phone.key.{five}"),
        Tap("phone.call_number"),
        parameters=dict.fromkeys(("one", "two", "three", "four", "five"), DIGITS),
    ),
    locked(
        "comms_pair_device",
        Module.COMMS,
        (
            "Pair the {device} with the car.",
            "Find my {device} and link it.",
            "Connect the {device} over Bluetooth, please.",
            "I brought the {device} along today, link that one.",
            "Make my {device} known to this car.",
        ),
        linked("device"),
        Open("phone"),
        Tap("phone.devices"),
        Tap(param("device", {"second phone": "link.device.1", "tablet": "link.device.2"})),
        parameters={"device": tuple(DEVICES)},
        tags=frozenset({"two_modules"}),
    ),
)

IMPLICIT = (
    hinted(
        "comms_leave_me_alone",
        Module.COMMS,
        (
            "I don't want to hear from anybody until I'm there.",
            "No more of that beeping, whoever it is, they can wait.",
            "This hour belongs to me alone.",
            "The office had better not reach me on this drive.",
        ),
        AppDataIs("phone.do_not_disturb", (True,)),
        Open("phone"),
        Tap("phone.do_not_disturb"),
    ),
    hinted(
        "comms_what_was_that",
        Module.COMMS,
        (
            "Something just pinged. What is it about?",
            "Did anybody write to me a moment ago? I'm curious what it says.",
            "That was the courier, I bet. What's he saying?",
            "My pocket buzzed and I can't look.",
        ),
        AppDataHas("messages.read", "{number}"),
        Open("phone"),
        Tap("phone.tab.messages"),
        Tap(text="{number}"),
        Tap("thread.read"),
        ways=((Tap("status.notice"), Tap("thread.read")),),
        start=replace(PARIS, arrivals=(Arrival("message", 15.0, "{number}"),)),
        trigger=Trigger(All((Driving(), SignalAbove(CALL.UNREAD, WRITTEN_BEFORE))), for_s=1.0, within_s=120.0),
        parameters={"number": tuple(f"0155 {number:02d} {97 - number:02d}" for number in range(10, 90))},
    ),
    hinted(
        "comms_quick_no",
        Module.COMMS,
        (
            "Oh no, not him again, I really can't talk now.",
            "That ringtone! Make it go away, I'm not here.",
            "I'm not in the mood for a chat with that person.",
            "Whoever that is, I'm not taking the call.",
        ),
        EnteredOf("calls.declined", CALL.RINGING),
        Tap("call.decline"),
        ways=((Open("phone"), Tap("phone.decline")),),
        start=CALLED,
        trigger=RINGING,
        deadline=WHILE_IT_RINGS,
    ),
)

TASKS = (*EXPLICIT, *IMPLICIT, *PAIRS)
