"""Wishes that the driver changes half-way in one half, and keeps in the other."""

from __future__ import annotations

from automotive_cosim.cockpit.signals import HVAC, MEDIA
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Check, SignalIs
from automotive_cosim.tasking.dialogue import Says
from automotive_cosim.tasking.moves import Hear, Move, Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import Choices, param
from automotive_cosim.tasking.task import Basis, Dimension, Half, Module, Task
from automotive_cosim.tasking.triggers import SignalAbove
from automotive_cosim.tasks.forms import ON_THE_WAY, PARIS, TALK
from automotive_cosim.tasks.maps import SETS_OUT

OTHER = {"City": "Modern", "Science": "Maritime", "Modern": "City", "Maritime": "Science"}
DEGREES = {22: 21.9, 23: 22.9, 24: 23.9}
"""What the driver asks for first, and the setting above which he has got it."""
SHUFFLED = Tap("media.shuffle")


def _changed(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    remark: Says,
    *,
    changed: tuple[Check, tuple[Move, ...]],
    kept: tuple[Check, tuple[Move, ...]],
    parameters: dict[str, Choices],
    ways: tuple[tuple[Move, ...], ...] = (),
    may_write: frozenset[str] = frozenset(),
) -> Task:
    """A pair: the goal and the moves if the driver says ``remark``, and if he does not."""
    first, second = (
        Half(PARIS, ON_THE_WAY, goal, moves, TALK, Basis.WISH, says=said, ways=others, may_write=may_write)
        for (goal, moves), said, others in ((changed, (remark,), ways), (kept, (), ()))
    )
    return Task(
        task_id,
        module,
        Dimension.EXPLICIT_CONTROL,
        says,
        first,
        second,
        "events: the driver changes his mind half-way, or keeps to what he said",
        parameters,
        frozenset({"second_thoughts"}),
    )


def _to_museum(name: str) -> tuple[Move, ...]:
    return Open("map"), Tap("map.list.explore"), Tap("explore.kind.museum"), Tap(text=f"{name} Museum"), SETS_OUT


def _warmth(way: str, shown: str) -> TapUntil:
    return TapUntil(f"hvac.driver_temperature.{way}", "hvac.driver_temperature", f"{shown}.0 °C")


TASKS = (
    _changed(
        "maps_another_museum",
        Module.MAPS,
        (
            "Take me to the {museum} Museum.",
            "Guide us to the museum called {museum}.",
            "{museum} Museum, please, start the navigation.",
            "We're off to see some art: the {museum} Museum.",
            "Today it's the {museum} Museum, set the route.",
        ),
        Says(
            param(
                "museum", {name: f"No, the other one. I mean the {other} Museum." for name, other in OTHER.items()}
            ),
            changed=frozenset({"navigation.destination"}),
        ),
        changed=(
            AppDataIs("navigation.destination", (param("museum", {n: f"{o} Museum" for n, o in OTHER.items()}),)),
            (
                *_to_museum("{museum}"),
                Hear("the other one"),
                Open("map"),
                Tap("map.list.explore"),
                Tap("explore.kind.museum"),
                Tap(text=param("museum", {name: f"{other} Museum" for name, other in OTHER.items()})),
                SETS_OUT,
            ),
        ),
        kept=(AppDataIs("navigation.destination", ("{museum} Museum",)), _to_museum("{museum}")),
        parameters={"museum": tuple(OTHER)},
    ),
    _changed(
        "hvac_not_that_warm",
        Module.HVAC,
        (
            "Make it {degrees} degrees on my side.",
            "I'd like {degrees} degrees here where I sit.",
            "Driver's side, {degrees}, please.",
            "Warm me up to {degrees}.",
            "Only my side, please: {degrees} degrees.",
            "Turn the driver's side up to {degrees}.",
            "My half of the car should have {degrees} degrees.",
        ),
        Says(
            "No, sorry, I meant 20.",
            when=SignalAbove(HVAC.DRIVER_TEMPERATURE, param("degrees", DEGREES)),
        ),
        changed=(
            SignalIs(HVAC.DRIVER_TEMPERATURE, (20.0,)),
            (Open("climate"), _warmth("increase", "{degrees}"), Hear("I meant 20"), _warmth("decrease", "20")),
        ),
        kept=(
            SignalIs(HVAC.DRIVER_TEMPERATURE, (param("degrees"),)),
            (Open("climate"), _warmth("increase", "{degrees}")),
        ),
        parameters={"degrees": tuple(DEGREES)},
        may_write=frozenset({HVAC.SYNC.path}),
    ),
    _changed(
        "media_leave_the_order",
        Module.MEDIA,
        (
            "Volume {percent} and shuffle on.",
            "Shuffle the songs, and {percent} percent loud.",
            "I want a mix, at a volume of {percent}.",
            "{percent} on the volume, and play things in random order.",
            "Sound to {percent}, then mix up what's playing.",
        ),
        Says("Leave the order as it is, after all. Only the volume.", changed=frozenset({MEDIA.VOLUME.path})),
        changed=(
            AllOf((SignalIs(MEDIA.VOLUME, (param("percent"),)), SignalIs(MEDIA.SHUFFLE, (False,)))),
            (Open("media"), Slide("media.volume", param("percent")), Hear("Only the volume")),
        ),
        ways=(
            (
                Open("media"),
                SHUFFLED,
                Slide("media.volume", param("percent")),
                Hear("Only the volume"),
                SHUFFLED,
            ),
        ),
        kept=(
            AllOf((SignalIs(MEDIA.VOLUME, (param("percent"),)), SignalIs(MEDIA.SHUFFLE, (True,)))),
            (Open("media"), Slide("media.volume", param("percent")), SHUFFLED),
        ),
        parameters={"percent": (10, 15, 20, 40, 45, 50)},
    ),
)
