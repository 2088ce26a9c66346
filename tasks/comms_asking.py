"""Comms, wishes that do not say enough: which of two people, what to answer, which device."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.signals import CALL
from automotive_cosim.tasking.checks import Entered, EnteredOf
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Move, Open, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Deadline, Dimension, Module
from automotive_cosim.tasking.triggers import All, Driving, Not, SignalHas, Trigger
from automotive_cosim.tasks.forms import (
    AT_THE_KERB,
    DEVICES,
    ELSEWHERE,
    FRIENDS,
    PARIS,
    PARKED_WHEN_WRITTEN,
    linked,
    read_out,
    unclear,
    wrote,
)

PRACTICES = {"dentist": "Dental practice", "optician": "Eye clinic"}
TODAY, IN_MARCH = "We expect you today at {hour}.", "Your next appointment is in March."
AT_NIGHT = replace(AT_THE_KERB, start="2026-11-17T22:40:00")
PARENTS = {"mum": "Mum", "dad": "Dad"}
MILO = replace(PARIS, arrivals=tuple(Arrival("call", at_s, "{who}") for at_s in (25.0, 80.0, 135.0)))
"""Repeated calls, so that one of them rings while the car moves."""
MILO_RINGS = Trigger(All((Driving(), Not(SignalHas(CALL.RINGING, "")))), for_s=2.0, within_s=180.0)
WHILE_IT_RINGS = Deadline(25.0, "a call rings for 30 s at most (ETSI TS 122 082), and has rung for 2 s already")


def _answer(who: str, text: str) -> tuple[Move, ...]:
    return Open("phone"), Tap("phone.tab.messages"), Tap(text=who), Tap(text=text)


TASKS = (
    unclear(
        "comms_ask_which_friend",
        Module.COMMS,
        (
            "Tell {who} yes.",
            "{who} asked me something. Answer: yes.",
            "Send a yes to {who}, she's waiting for it.",
            "Yes for {who}, please.",
            "{who} wants to know, so text her: yes.",
        ),
        Topic(
            "which {who}",
            (("adler",), ("costa",)),
            param("which", {"Adler": "{who} Adler.", "Costa": "{who} Costa."}),
            ("{who}", "which"),
        ),
        "Which {who}: Adler or Costa?",
        Entered("messages.sent", {"to": "{who} {which}", "text": "Yes"}),
        *_answer("{who} {which}", "Yes"),
        untold=wrote(
            PARIS, ("{who} Adler", "Can you come on Friday?"), ("{who} Costa", "Shall I book the court for us?")
        ),
        told=wrote(
            PARIS,
            (
                "{who} Adler",
                param("which", {"Adler": "Can you come on Friday?", "Costa": "Thanks for the lovely evening!"}),
            ),
            (
                "{who} Costa",
                param("which", {"Adler": "What a match that was!", "Costa": "Shall I book the court for us?"}),
            ),
        ),
        look=read_out("{who} Adler", "{who} Costa"),
        find=(Open("phone"), Tap("phone.tab.messages")),
        difference="content: both friends have asked something, or only one of them",
        parameters={"which": ("Adler", "Costa"), "who": FRIENDS},
    ),
    unclear(
        "comms_ask_which_practice",
        Module.COMMS,
        (
            "Tell the practice I'll be ten minutes late today.",
            "I have an appointment, and I'm late. Let them know: ten minutes.",
            "Write to the doctor that it'll be ten minutes later.",
            "Message the people who expect me this morning, I'm 10 minutes behind.",
            "I won't make my appointment on time; text them ten minutes.",
        ),
        Topic(
            "which appointment",
            (("dental", "dentist", "teeth"), ("eye", "eyes", "optician", "clinic")),
            param("which", {"dentist": "The dentist.", "optician": "The eye clinic."}),
            ("appointment", "practice", "doctor", "whom", "who"),
        ),
        "Whom do you mean, the dental practice or the eye clinic?",
        Entered("messages.sent", {"to": param("which", PRACTICES), "text": "I'll be 10 minutes late"}),
        *_answer(param("which", PRACTICES), "I'll be 10 minutes late"),
        untold=wrote(
            PARIS,
            ("Dental practice", "We look forward to seeing you."),
            ("Eye clinic", "We look forward to seeing you."),
        ),
        told=wrote(
            PARIS,
            ("Dental practice", param("which", {"dentist": TODAY, "optician": IN_MARCH})),
            ("Eye clinic", param("which", {"dentist": IN_MARCH, "optician": TODAY})),
        ),
        look=read_out(*PRACTICES.values()),
        find=(Open("phone"), Tap("phone.tab.messages")),
        difference="content: neither practice writes when the appointment is, or both do, and one is today",
        parameters={"which": tuple(PRACTICES), "hour": ("8:10", "8:15", "8:20", "8:25")},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "comms_ask_yes_or_no",
        Module.COMMS,
        (
            "Solveig asks if we're coming on Sunday. Answer what {who} decided.",
            "Reply to Solveig, yes or no, as {who} has it.",
            "{who} has settled Sunday. Tell Solveig yes or no.",
            "Give Solveig our answer for Sunday; it's up to {who}.",
            "Solveig needs a yes or a no from us. Whatever {who} says.",
        ),
        Topic(
            "what to answer",
            (("yes", "coming", "are coming"), ("no", "not", "aren't")),
            param("which", {"Yes": "Say yes.", "No": "Say no."}),
            ("answer", "sunday", "{who}", "solveig"),
        ),
        "What did {who} decide for Sunday, yes or no?",
        Entered("messages.sent", {"to": "Solveig", "text": "{which}"}),
        *_answer("Solveig", "{which}"),
        untold=wrote(
            PARIS,
            ("Solveig", "Are you two coming on Sunday?"),
            ("{who}", "I've made up my mind about Sunday, we talked about it."),
        ),
        told=wrote(
            PARIS,
            ("Solveig", "Are you two coming on Sunday?"),
            (
                "{who}",
                param(
                    "which",
                    {
                        "Yes": "I've made up my mind about Sunday, let's go there.",
                        "No": "I've made up my mind about Sunday, we stay at home.",
                    },
                ),
            ),
        ),
        look=read_out("{who}"),
        find=read_out("Solveig"),
        difference="content: the friend writes that it is decided, or also what",
        parameters={"which": ("Yes", "No"), "who": FRIENDS},
    ),
    unclear(
        "comms_ask_pick_up_or_not",
        Module.COMMS,
        (
            "That's {who}. Pick up or turn it down, as {who} wishes.",
            "{who}'s ringing! Answer or decline, as {who} would like it.",
            "Take {who}'s call or decline it, whichever {who} wants.",
            "Deal with {who}'s call as she would like: answer it or not.",
            "It's {who} again; accept or reject, whichever {who} texted me to do.",
        ),
        Topic(
            "what to do with the call",
            (("pick up", "answer", "accept", "take"), ("decline", "turn", "reject", "not")),
            param("which", {"answer": "Pick up.", "decline": "Decline."}),
            ("{who}", "call"),
        ),
        "Pick up or decline?",
        EnteredOf(param("which", {"answer": "calls.answered", "decline": "calls.declined"}), CALL.RINGING),
        Open("phone"),
        Tap("phone.{which}"),
        untold=wrote(MILO, ("{who}", "Did you get my postcard from Norway?")),
        told=wrote(
            MILO,
            (
                "{who}",
                param(
                    "which",
                    {
                        "answer": "I'll ring you in a moment, please answer, I've locked myself out.",
                        "decline": "My phone dials you by itself today, please just decline.",
                    },
                ),
            ),
        ),
        look=read_out("{who}"),
        difference="content: the caller has written about something else, or what to do with a call",
        parameters={"which": ("answer", "decline"), "who": FRIENDS},
        trigger=MILO_RINGS,
        deadline=WHILE_IT_RINGS,
    ),
    unclear(
        "comms_ask_which_device",
        Module.COMMS,
        (
            "{who} has set up one of my gadgets for the car. Pair it.",
            "Connect the other device, the one that {who} prepared.",
            "Link the second phone or the tablet, whichever {who} has made ready.",
            "Bluetooth to what {who} fixed for me, please.",
            "Pair what {who} was tinkering with, the tablet or the second phone.",
        ),
        Topic(
            "which device",
            (("second phone", "phone"), ("tablet",)),
            param("which", {"second phone": "The second phone.", "tablet": "The tablet."}),
            ("device", "gadget", "{who}"),
        ),
        "Which one, the second phone or the tablet?",
        linked("which"),
        Open("phone"),
        Tap("phone.devices"),
        Tap(text=param("which", DEVICES)),
        untold=wrote(AT_THE_KERB, ("{who}", "Your gadget is ready for the car.")),
        told=wrote(AT_THE_KERB, ("{who}", "Your {which} is ready for the car.")),
        look=read_out("{who}"),
        find=(Open("phone"), Tap("phone.devices")),
        difference="content: the friend writes that it is ready, or also which one",
        parameters={"which": tuple(DEVICES), "who": FRIENDS},
        trigger=PARKED_WHEN_WRITTEN,
    ),
    unclear(
        "comms_ask_whom_to_tell",
        Module.COMMS,
        (
            "Tell my parents that I've arrived, the one who's still up.",
            "I'm here. Let Mum or Dad know, whoever isn't asleep yet.",
            "Write 'I've arrived' to Mum or Dad; don't wake the one in bed.",
            "One of my parents waits up for me. Message that one that I've arrived.",
            "Whichever of Mum and Dad is awake should read that I've arrived.",
        ),
        Topic(
            "who is awake",
            (("mum", "mother", "mom"), ("dad", "father")),
            param("which", {"mum": "Mum is.", "dad": "Dad is."}),
            ("parents", "who", "whom", "awake"),
        ),
        "Who is still up, Mum or Dad?",
        Entered("messages.sent", {"to": param("which", PARENTS), "text": "I've arrived"}),
        *_answer(param("which", PARENTS), "I've arrived"),
        untold=wrote(AT_NIGHT, ("Mum", "Drive carefully, darling!"), ("Dad", "Mind the roadworks!")),
        told=wrote(
            AT_NIGHT,
            (
                "Mum",
                param("which", {"mum": "Dad's gone to bed, I'm still up.", "dad": "Drive carefully, darling!"}),
            ),
            ("Dad", param("which", {"mum": "Mind the roadworks!", "dad": "Mum's asleep, I'm still up."})),
        ),
        look=read_out("Mum", "Dad"),
        find=(Open("phone"), Tap("phone.tab.messages")),
        difference="content: the parents have written good wishes, or one of them who is awake",
        parameters={"which": tuple(PARENTS)},
        trigger=PARKED_WHEN_WRITTEN,
        scenarios=ELSEWHERE,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
)
