"""Comms, with who is aboard: who must not be woken."""

from __future__ import annotations

from automotive_cosim.cockpit.aboard import Kind
from automotive_cosim.tasking.checks import AppDataIs
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.aboard import REAR_LEFT, act, at, meant, on, rest

NO_RINGING = meant(
    "comms_no_ringing_for_sleepers",
    Module.COMMS,
    (
        "If the little one sleeps, nobody must ring through.",
        "Is she off to dreamland? Keep the phone from ringing then, please.",
        "No calls while the baby naps, if that's what she's doing.",
        "Peace and quiet from the phone, should our smallest be asleep.",
        "Do not disturb, please, but only if the child is asleep.",
    ),
    act(
        at("grid", "avenue", on(REAR_LEFT, Kind.BABY, asleep=True)),
        AppDataIs("phone.do_not_disturb", (True,)),
        Open("phone"),
        Tap("phone.do_not_disturb"),
    ),
    rest(at("grid", "avenue", on(REAR_LEFT, Kind.BABY))),
    "occupants: the baby is asleep, or awake",
)

TASKS = (NO_RINGING,)
