"""The owner's handbook, and the video that plays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Surroundings
from automotive_cosim.contracts.text import say

TOPICS: tuple[tuple[str, Icon, str], ...] = (
    (
        say("Windows are fogged"),
        Icon.DEFROST_FRONT,
        say(
            "Fog inside: blow dry air at the windshield with the front defroster, and switch recirculation off. "
            "Fog outside: use the wipers. The rear window has a heater of its own."
        ),
    ),
    (
        say("Fog lamps"),
        Icon.REAR_FOG,
        say(
            "Front fog lamps work with position lamps or low beam, the rear one with low beam or front fog lamps. "
            "When they may be lit is a matter of local law: the rear fog lamp dazzles those behind."
        ),
    ),
    (
        say("Tyre pressures"),
        Icon.TYRE,
        say(
            "Check them cold. The pressure falls by about a tenth of a bar for every ten degrees that it gets "
            "colder. Add air when a tyre is a fifth below the value on the door frame."
        ),
    ),
    (
        say("Cruise control"),
        Icon.CRUISE,
        say(
            "It holds the set speed and, when adaptive, the chosen gap to the car in front. The limiter lets you "
            "accelerate up to its speed but not beyond. Only one of them is active at a time."
        ),
    ),
    (
        say("Extending range"),
        Icon.BATTERY,
        say("Drive slower, use economy mode, and warm the seats rather than the air: a seat takes a tenth of it."),
    ),
    (
        say("Driving on ice"),
        Icon.SLIPPERY,
        say(
            "Snow mode softens the throttle. Keep stability control on, leave a gap several times as long as "
            "usual, and brake early and gently."
        ),
    ),
    (
        say("Child safety"),
        Icon.CHILD,
        say(
            "Child locks keep the rear doors from being opened from inside; the window lock blocks the rear "
            "switches."
        ),
    ),
    (
        say("After a crash"),
        Icon.PHONE_ALERT,
        say(
            "Switch the hazard lights on, call for help from the safety centre, which sends the position, and wait "
            "beyond the barrier."
        ),
    ),
    (
        say("Charging"),
        Icon.CHARGING,
        say("For daily driving charge to 80 %. Above that the battery takes power ever more slowly."),
    ),
    (
        say("Mirrors and seats"),
        Icon.SEAT,
        say("Set the seat first, then the mirrors. Up to three positions can be stored and recalled while parked."),
    ),
)
"""Topic, icon and text."""
FILM_S = 40.0
"""Length of a topic's video."""


@dataclass(frozen=True, slots=True)
class ManualFilm(AppData):
    """The topic whose video plays, and since when; None without."""

    topic: int | None = None
    since_s: float = 0.0

    def commands(self) -> dict[str, Any]:
        """The topic; empty without."""
        return {"apps.film": "" if self.topic is None else TOPICS[self.topic][0]}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """The video ends at its end, or when the car leaves park."""
        over = Restriction.NO_VIDEO in state.restrictions or state.time_s - self.since_s >= FILM_S
        if self.topic is not None and over:
            state.keep(ManualFilm())
