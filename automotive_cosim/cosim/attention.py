"""The driver's attention: what screen, words, calls and hours take of it, and how it comes back.

Awareness is SUMO's: 1 is an attentive driver, who judges gaps and closing speeds as they are, and 0.1 its least. It
is a product of three shares:

* eyes: a store of two seconds that empties while the eyes are on the screen, second by second, and fills again
  while they are on the road (AttenD: Kircher and Ahlström, 2009). Two seconds are also the longest glance of
  NHTSA's guidelines; what takes longer is read in several, each once the store is full.
* mind: 1 - ``MIND`` x load, with the load on the scale of Strayer and others (2013, AAA Foundation) less one:
  driving alone is 0, a memory task 4. After words it fades within 27 s.
* hours: from two hours without a break on.

``docs/reference/attention.md`` has every source, the curves beside their data, and what is a choice of ours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import takewhile

from automotive_cosim.cockpit.signals import CALL, DRIVER
from automotive_cosim.cockpit.state import State

GLANCE_S, TASK_S = 2.0, 12.0
"""The longest glance, and all glances of a task together (NHTSA, Visual-Manual Driver Distraction Guidelines, 78 FR
24817, 2013). Drivers leave what would take longer."""
WORDS_PER_S = 238 / 60
"""Silent reading speed of adults (Brysbaert 2019, J. Mem. Lang. 109)."""
LEAST = 0.1
"""The least awareness that SUMO knows."""
HEARD, CALLED, HELD = 0.75, 1.27, 1.45
"""Load of listening to words (an audio book), of a conversation by a hands-free phone, and with the phone in hand:
1.75, 2.27 and 2.45 (Strayer and others, 2013). To talk with a language model while driving loads as much as a
hands-free call (Monk and others, 2026, arXiv 2601.15034)."""
MIND = 0.22 / CALLED
"""Share of awareness that a unit of load takes: with SUMO 1.28, at 0.78 drivers begin to brake 0.13 s later than at
1, as much as people on the phone do (Horrey and Wickens, 2006, a meta-analysis)."""
FADES_S = 27.0 / 3
"""Time constant with which load fades: its rest is below a twentieth, and counts no more, after 27 s, as long as
Strayer and others (2015, AAA Foundation) found some."""
LEAST_LOAD = 0.05 * CALLED
ROAD = 0.5
"""By how much more the same words load where the road does, too: in the dark, in sight below a kilometre, or less
than two seconds behind another vehicle. Our choice."""
SIGHT_M, BEHIND_S = 1000.0, 2.0
FRESH_H, SPENT_H, SPENT = 2.0, 9.0, 0.62
"""From two hours without a break on awareness falls, to this after nine, the longest day at the wheel (Regulation
(EC) 561/2006). At 0.62 SUMO's driver brakes 0.39 s later: half of the 777 ms of an attentive one (Strayer, Drews
and Crouch, 2006), since Williamson and Feyer (2000) found reactions up to half as slow again after 17 to 19 hours
awake. The line between is our choice."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What something that was done asked of the driver."""

    time_s: float
    """Simulation time."""
    look_s: float = 0.0
    """For how long the screen wants to be looked at."""
    hear_s: float = 0.0
    """For how long somebody speaks to the driver, who has to listen."""
    talk_s: float = 0.0
    """For how long the driver talks with somebody, question and answer."""


@dataclass(slots=True)
class Attention:
    """The attention of one driver."""

    asked: tuple[Asked, ...] = ()
    """What agents asked of it so far."""
    eyes_s: float = GLANCE_S
    """What is left of the store."""
    look_s: float = 0.0
    """For how long the screen still wants to be looked at."""
    is_away: bool = False
    """Whether the eyes are on the screen."""
    hear_s: float = 0.0
    talk_s: float = 0.0
    load: float = 0.0
    hours: float = 0.0
    """At the wheel without a break."""
    told: float = 1.0
    """The awareness that the road was told last."""
    read: tuple[float, str] = (0.0, "")
    """Time and text of the newest line of the status bar that was seen."""

    def copy(self) -> Attention:
        return replace(self)

    def ask(self, what: Asked) -> None:
        """Something that was done asks for attention from now on."""
        self.asked += (what,)
        self.hear_s += what.hear_s
        self.talk_s += what.talk_s
        self._look(what.look_s)

    def new_text_s(self, state: State) -> float:
        """How long it takes to read what has come to the status bar since this was last asked."""
        read_s = 0.0
        for notice in takewhile(lambda each: (each.at_s, each.text) != self.read, reversed(state.notices)):
            if not notice.seen and notice.at_s >= state.departed_s:
                read_s += len(notice.text.split()) / WORDS_PER_S
        if state.notices:
            self.read = state.notices[-1].at_s, state.notices[-1].text
        return read_s

    def glanced(self, dt_s: float) -> None:
        """Lets time pass for the eyes."""
        if self.is_away:
            self.eyes_s, self.look_s = max(0.0, self.eyes_s - dt_s), max(0.0, self.look_s - dt_s)
            self.is_away = self.eyes_s > 0.0 and self.look_s > 0.0
        else:
            self.eyes_s = min(GLANCE_S, self.eyes_s + dt_s)
        self._look(0.0)

    def passed(self, state: State, dt_s: float) -> None:
        """Lets time pass that ends now."""
        self.glanced(dt_s)
        self.load *= math.exp(-dt_s / FADES_S)
        talked_s = min(dt_s, self.talk_s)
        self.talk_s -= talked_s
        self.hear_s = max(0.0, self.hear_s - (dt_s - talked_s))
        if state.signals[CALL.PHONE] == "HAND":
            self.look_s = max(self.look_s, GLANCE_S)
        self.hours = (state.driven_s + state.time_s - state.departed_s) / 3600
        self._look(self.new_text_s(state))
        state.signals[DRIVER.DISTRACTION] = round(100 * (1 - self.eyes_s / GLANCE_S), 1)
        state.signals[DRIVER.FATIGUE] = round(100 * self._tired, 1)

    def think(self, state: State) -> None:
        """What is on the driver's mind from now on."""
        load = CALLED if self.talk_s > 0 or state.signals[CALL.PARTNER] else HEARD if self.hear_s > 0 else 0.0
        if state.signals[CALL.PHONE] == "HAND":
            load = HELD
        if load and _is_demanding(state):
            load *= 1 + ROAD
        self.load = max(load, self.load)
        if self.load < LEAST_LOAD:
            self.load = 0.0

    @property
    def awareness(self) -> float:
        """In the coming second, 0.1 to 1."""
        half_s = -0.5 if self.is_away else 0.5
        eyes = min(1.0, max(0.0, (self.eyes_s + half_s) / GLANCE_S))
        return max(LEAST, round(eyes * (1 - MIND * self.load) * (1 - (1 - SPENT) * self._tired), 3))

    @property
    def _tired(self) -> float:
        return min(1.0, max(0.0, (self.hours - FRESH_H) / (SPENT_H - FRESH_H)))

    def _look(self, for_s: float) -> None:
        """Drivers look away once they have seen enough of the road, and leave what takes too long."""
        self.look_s = min(TASK_S, self.look_s + for_s)
        self.is_away = self.is_away or (self.look_s > 0.0 and self.eyes_s >= GLANCE_S - 1e-9)


def _is_demanding(state: State) -> bool:
    """Whether the road loads the driver by itself."""
    outside = state.outside
    assert outside is not None
    driving, leader = outside.driving, outside.driving.around.leader
    is_dark = outside.sun_elevation_deg is not None and outside.sun_elevation_deg < 0
    is_near = leader is not None and leader.gap_m < BEHIND_S * driving.speed_mps
    return is_dark or outside.weather.visibility < SIGHT_M or is_near
