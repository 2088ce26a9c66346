"""What a drive can stage: each kind of event with its bait, which looks like it and asks for nothing.

A stunt only sets causes: a switch, a driver's mood, weather, a vehicle. Whether an event comes of it is found on
the drive itself, where the same causes may also lie in the road.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from automotive_cosim.cockpit.changes import Change
from automotive_cosim.cockpit.signals import CABIN, SEAT, TYRE, Signal
from automotive_cosim.contracts import Weather
from automotive_cosim.scenarios.incidents import AnyIncident, BrakingLeader, EmergencyVehicle
from automotive_cosim.traffic.base import DriverAt


@dataclass(frozen=True, slots=True)
class Spell:
    """Other weather for a while."""

    from_s: float
    to_s: float
    weather: Weather


@dataclass(frozen=True, slots=True)
class Props:
    """What one stunt adds to a plan."""

    moods: tuple[DriverAt, ...] = ()
    changes: tuple[Change, ...] = ()
    incidents: tuple[AnyIncident, ...] = ()
    spells: tuple[Spell, ...] = ()


@dataclass(frozen=True, slots=True)
class Cue:
    """When and where a stunt is staged."""

    at_s: float
    """Seconds after departure."""
    is_bait: bool
    driver: str
    """The profile that the driver returns to."""
    weather: Weather
    """What the weather is otherwise."""
    rng: np.random.Generator


Stunt = Callable[[Cue], Props]

MOOD_S = 40.0
"""How long a driver keeps a mood: an overtaking, a hurry, a phone call that annoys."""


def _mood(of_event: str, of_bait: str, for_s: float = MOOD_S) -> Stunt:
    def stage(cue: Cue) -> Props:
        mood = of_bait if cue.is_bait else of_event
        return Props(moods=(DriverAt(cue.at_s, mood), DriverAt(cue.at_s + for_s, cue.driver)))

    return stage


def _turned(signal: Signal[bool], cue: Cue, value: bool, for_s: float) -> tuple[Change, ...]:
    return (Change(cue.at_s, signal.path, value), Change(cue.at_s + for_s, signal.path, not value))


def _belt(cue: Cue) -> Props:
    """The driver opens the belt; as a bait, only pulls it straight."""
    return Props(changes=_turned(SEAT.DRIVER_BELT, cue, False, 2.0 if cue.is_bait else 90.0))


def _door(cue: Cue) -> Props:
    """The tailgate springs open; as a bait, somebody opens a window."""
    if cue.is_bait:
        return Props(changes=(Change(cue.at_s, CABIN.REAR_LEFT_WINDOW.path, 30.0),))
    return Props(changes=_turned(CABIN.TRUNK, cue, True, 180.0))


def _tyre(cue: Cue) -> Props:
    """A tyre loses a third of its air in four minutes; as a bait, a twentieth."""
    tyre = (TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT)[int(cue.rng.integers(4))]
    return Props(changes=(Change(cue.at_s, tyre.path, 237.0 if cue.is_bait else 165.0, 240.0),))


def _blue_light(cue: Cue) -> Props:
    """An ambulance comes up from behind; as a bait, a van as fast."""
    return Props(incidents=(EmergencyVehicle(from_s=cue.at_s, blue_light=not cue.is_bait),))


def _leader_brakes(cue: Cue) -> Props:
    """The vehicle ahead brakes hard; as a bait, it slows down gently."""
    if cue.is_bait:
        return Props(incidents=(BrakingLeader(from_s=cue.at_s, deceleration_mps2=0.8, to_kmh=25.0),))
    return Props(incidents=(BrakingLeader(from_s=cue.at_s, to_kmh=10.0),))


STUNTS: Mapping[str, Stunt] = {
    "over_limit": _mood("hurried", "brisk"),
    "leader_close": _mood("pressing", "calm"),
    "fatigue": _mood("drowsy", "calm", 120.0),
    "belt": _belt,
    "door": _door,
    "tyre": _tyre,
    "blue_light": _blue_light,
    "leader_brakes": _leader_brakes,
}
"""The stunts by the kind of event that they stage."""
