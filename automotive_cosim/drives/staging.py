"""What a drive can stage: each kind of event with its bait, which looks like it and asks for nothing.

A stunt only sets causes: a switch, a driver's mood, weather, a vehicle. Whether an event comes of it is found on
the drive itself, where the same causes may also lie in the road.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from automotive_cosim.cockpit.aboard import SIGNALS, Occupant, Seat
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.reach import RADAR_M
from automotive_cosim.cockpit.signals import BODY, CABIN, CALL, ENERGY, HVAC, LIGHTS, TYRE, Signal
from automotive_cosim.contracts import Weather
from automotive_cosim.drives.sky import drizzle, fog, rain, sleet
from automotive_cosim.scenarios.incidents import AheadIncident, AnyIncident, BrakingLeader, EmergencyVehicle
from automotive_cosim.traffic.base import DriverAt, HaltAt


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
    halts: tuple[HaltAt, ...] = ()
    changes: tuple[CarChange, ...] = ()
    incidents: tuple[AnyIncident, ...] = ()
    spells: tuple[Spell, ...] = ()
    driven_s: float = 0.0
    """How long the driver had been driving before departure."""


@dataclass(frozen=True, slots=True)
class Cue:
    """When and in what a stunt is staged."""

    at_s: float
    """Seconds after departure."""
    is_bait: bool
    driver: str
    """The profile that the driver returns to."""
    weather: Weather
    """What the weather is otherwise."""
    rng: np.random.Generator
    aboard: tuple[Occupant, ...] = ()
    """Who is in the car besides the driver."""


Stunt = Callable[[Cue], Props]

MOOD_S = 40.0
"""How long a driver keeps a mood."""
LEADER_WITHIN_S = 40.0
"""A leader that has not been found by then does not brake, lest it do so during the next stunt."""
LATE_M = 135.0
"""How far ahead it brakes: just within the reach of the radar."""
SPELL_S = 120.0
"""Length of a bank of fog or a shower."""
PHONE_S = 40.0
"""How long a driver uses the phone."""
AHEAD_S = 420.0
"""How long an incident on the road lasts."""
AHEAD_M = 1400.0
"""How far ahead it is staged: news that is a minute old is heard in time at 80 km/h."""
ALIGHT_S, AWAY_S = 10.0, 120.0
"""How long after parking the driver gets out, and for how long: beyond the deadline of 90 s."""
BREAK_AFTER_S = 2 * 3600.0
"""The Highway Code, rule 91: a break of at least 15 minutes after every two hours of driving."""


# --- the driver ---------------------------------------------------------------------------------------------


def _mood(of_event: str, of_bait: str) -> Stunt:
    def stage(cue: Cue) -> Props:
        mood = of_bait if cue.is_bait else of_event
        return Props(moods=(DriverAt(cue.at_s, mood), DriverAt(cue.at_s + MOOD_S, cue.driver)))

    return stage


def _leader_close(cue: Cue) -> Props:
    """The driver presses, behind somebody who eases off; as a bait, keeps two seconds."""
    until_s = cue.at_s + MOOD_S
    eases = BrakingLeader(
        from_s=cue.at_s, to_s=until_s, ahead_m=40.0, deceleration_mps2=0.2, to_kmh=40.0, keeps_lane=True
    )
    return replace(_mood("pressing", "calm")(cue), incidents=(eases,))


def _fatigue(cue: Cue) -> Props:
    """Two hours without a break are full at that time; as a bait, one and a half."""
    full_s = 0.75 * BREAK_AFTER_S if cue.is_bait else BREAK_AFTER_S
    return Props(driven_s=full_s - cue.at_s)


def _belt(cue: Cue) -> Props:
    """Somebody aboard opens the belt; as a bait, only pulls it straight."""
    people = [Seat.DRIVER, *(one.seat for one in cue.aboard if one.kind.is_person and one.belted)]
    belt = SIGNALS[people[int(cue.rng.integers(len(people)))]].belted
    return Props(changes=_turned(belt, cue, False, 2.0 if cue.is_bait else 90.0))


def _left_behind(cue: Cue) -> Props:
    """The driver parks and goes away, and who needs care stays; as a bait, the driver takes them along."""
    gone = [(SIGNALS[Seat.DRIVER], ALIGHT_S, ALIGHT_S + AWAY_S)]
    if cue.is_bait:  # out before the driver goes, and in after the driver has come
        gone += [
            (SIGNALS[one.seat], ALIGHT_S - 2.0, ALIGHT_S + AWAY_S + 2.0)
            for one in cue.aboard
            if one.kind.needs_care
        ]
    changes = [
        CarChange(at_s, signal.path, value, once_parked=True)
        for seat, out_s, in_s in gone
        for at_s, signal, value in (
            (out_s - 4.0, seat.belted, False),
            (out_s, seat.occupied, False),
            (in_s, seat.occupied, True),
            (in_s + 4.0, seat.belted, True),
        )
    ]
    return Props(halts=(HaltAt(cue.at_s, AWAY_S + 2 * ALIGHT_S),), changes=tuple(changes))


def _phone(cue: Cue) -> Props:
    """The driver takes the phone in the hand; as a bait, uses it in its cradle."""
    where = "CRADLE" if cue.is_bait else "HAND"
    taken = CarChange(cue.at_s, CALL.PHONE.path, where)
    return Props(changes=(taken, CarChange(cue.at_s + PHONE_S, CALL.PHONE.path, "AWAY")))


# --- the car ------------------------------------------------------------------------------------------------


def _turned(signal: Signal[bool], cue: Cue, value: bool, for_s: float) -> tuple[CarChange, ...]:
    return (CarChange(cue.at_s, signal.path, value), CarChange(cue.at_s + for_s, signal.path, not value))


def _set(cue: Cue, *values: tuple[Signal[bool] | Signal[str], bool | str]) -> tuple[CarChange, ...]:
    return tuple(CarChange(cue.at_s, signal.path, value) for signal, value in values)


def _door(cue: Cue) -> Props:
    """The tailgate springs open; as a bait, somebody opens a window."""
    if cue.is_bait:
        return Props(changes=(CarChange(cue.at_s, CABIN.REAR_LEFT_WINDOW.path, 30.0),))
    return Props(changes=_turned(CABIN.TRUNK, cue, True, 180.0))


def _tyre(cue: Cue) -> Props:
    """A tyre loses a third of its air in two minutes; as a bait, a twentieth."""
    tyre = (TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT)[int(cue.rng.integers(4))]
    return Props(changes=(CarChange(cue.at_s, tyre.path, 237.0 if cue.is_bait else 165.0, 120.0),))


def _range(cue: Cue) -> Props:
    """A cell fails and ten kilometres are left; as a bait, eighty: low, but enough."""
    return Props(changes=(CarChange(cue.at_s, ENERGY.LEVEL.path, 18.0 if cue.is_bait else 2.5, 20.0),))


def _lamps(cue: Cue) -> Props:
    """The driver switches the lamps off; as a bait, to dipped beam by hand."""
    return Props(changes=_set(cue, (LIGHTS.SWITCH, "BEAM" if cue.is_bait else "OFF")))


def _high_beam(cue: Cue) -> Props:
    """The driver leaves high beam on; as a bait, flashes once."""
    to_beam = _set(cue, (LIGHTS.SWITCH, "BEAM"))
    return Props(changes=(*to_beam, *_turned(LIGHTS.HIGH_BEAM, cue, True, 1.0 if cue.is_bait else 90.0)))


def _fog_lamps(cue: Cue) -> Props:
    """The rear fog lamp in clear air; as a bait, in fog as thick as it is for."""
    on = CarChange(cue.at_s + (20.0 if cue.is_bait else 0.0), LIGHTS.REAR_FOG.path, True)
    off = CarChange(cue.at_s + 100.0, LIGHTS.REAR_FOG.path, False)
    spells = (Spell(cue.at_s, cue.at_s + SPELL_S, fog(cue.weather, 40.0)),) if cue.is_bait else ()
    return Props(changes=(*_set(cue, (LIGHTS.SWITCH, "BEAM")), on, off), spells=spells)


def _glass_fog(cue: Cue) -> Props:
    """The air is recirculated, with the fan low, for good; as a bait, for half a minute."""
    closed = _turned(HVAC.RECIRCULATION, cue, True, 30.0) if cue.is_bait else _set(cue, (HVAC.RECIRCULATION, True))
    weak = (CarChange(cue.at_s, HVAC.FAN_SPEED.path, 10.0),) if not cue.is_bait else ()
    return Props(changes=(CarChange(cue.at_s, HVAC.AIR_CONDITIONING.path, False), *weak, *closed))


# --- the sky ------------------------------------------------------------------------------------------------


def _wipers(cue: Cue) -> Props:
    """Rain sets in, and the wipers are off; as a bait, the sensor drives them."""
    mode = "RAIN_SENSOR" if cue.is_bait else "OFF"
    return Props(
        changes=_set(cue, (BODY.FRONT_WIPER, mode)),
        spells=(Spell(cue.at_s + 5.0, cue.at_s + 5.0 + SPELL_S, rain(cue.weather)),),
    )


def _weather_speed(cue: Cue) -> Props:
    """A bank of dense fog that the driver takes no notice of; as a bait, mist."""
    until_s = cue.at_s + SPELL_S
    careless = (DriverAt(cue.at_s, "careless"), DriverAt(until_s, cue.driver))
    visibility_m = 1600.0 if cue.is_bait else float(round(cue.rng.uniform(14, 24)))  # too little for 50 km/h
    return Props(moods=careless, spells=(Spell(cue.at_s, until_s, fog(cue.weather, visibility_m)),))


def _slippery(cue: Cue) -> Props:
    """Freezing rain or snow that the driver takes no notice of; as a bait, a trace of drizzle."""
    until_s = cue.at_s + SPELL_S
    careless = (DriverAt(cue.at_s, "careless"), DriverAt(until_s, cue.driver))
    fallen = drizzle(cue.weather) if cue.is_bait else sleet(cue.weather)
    return Props(moods=careless, spells=(Spell(cue.at_s, until_s, fallen),))


# --- the road -----------------------------------------------------------------------------------------------


def _blue_light(cue: Cue) -> Props:
    """An ambulance comes up from behind; as a bait, a van as fast."""
    return Props(incidents=(EmergencyVehicle(from_s=cue.at_s, blue_light=not cue.is_bait),))


def _leader_brakes(cue: Cue) -> Props:
    """Far ahead a car brakes to a halt, and a driver who presses reacts late; as a bait, it slows down gently.

    Only hard braking helps once 3.4 m/s2 are needed, and from 90 km/h on there are more than two seconds left then.
    """
    until_s = cue.at_s + LEADER_WITHIN_S
    if cue.is_bait:
        slows = BrakingLeader(from_s=cue.at_s, to_s=until_s, ahead_m=50.0, deceleration_mps2=0.8, to_kmh=25.0)
        return Props(incidents=(slows,))
    brakes = BrakingLeader(
        from_s=cue.at_s,
        to_s=until_s,
        within_m=RADAR_M,
        beyond_m=LATE_M - 20.0,
        from_kmh=90.0,
        ahead_m=LATE_M,
        deceleration_mps2=9.0,
        to_kmh=0.0,
        keeps_lane=True,
    )
    return replace(_mood("pressing", "pressing")(cue), incidents=(brakes,))


def _ahead(what: Literal["breakdown", "roadworks", "jam", "tractor"]) -> Stunt:
    """On the way; as a bait, on the other carriageway."""

    def stage(cue: Cue) -> Props:
        until_s = cue.at_s + AHEAD_S
        incident = AheadIncident(what=what, from_s=cue.at_s, to_s=until_s, ahead_m=AHEAD_M, other_way=cue.is_bait)
        return Props(incidents=(incident,))

    return stage


STUNTS: Mapping[str, Stunt] = {
    "over_limit": _mood("hurried", "brisk"),
    "leader_close": _leader_close,
    "fatigue": _fatigue,
    "belt": _belt,
    "phone": _phone,
    "left_behind": _left_behind,
    "door": _door,
    "tyre": _tyre,
    "range": _range,
    "lamps": _lamps,
    "high_beam": _high_beam,
    "fog_lamps": _fog_lamps,
    "glass_fog": _glass_fog,
    "wipers": _wipers,
    "weather_speed": _weather_speed,
    "slippery": _slippery,
    "blue_light": _blue_light,
    "leader_brakes": _leader_brakes,
    "breakdown": _ahead("breakdown"),
    "roadworks": _ahead("roadworks"),
    "jam_tail": _ahead("jam"),
    "tractor": _ahead("tractor"),
}
"""The stunts by the kind of event that they stage at a time."""
SCHOOL_ZONE = "school_zone"
"""The kind that is staged by place: where a school zone begins at its hours."""
AT_SCHOOLS = ("hurried", "brisk")
"""Driver profiles in school zones: as an event and as its bait."""
STAGED = STUNTS.keys() | {SCHOOL_ZONE}
"""Every kind that a cast may hold."""

ONCE = frozenset({"fatigue", "range", "left_behind"})
"""Kinds that a drive stages as an event or as a bait, not both: a battery does not fill up again, and one halt is
enough."""
TAKES_S: Mapping[str, float] = {"left_behind": 2 * ALIGHT_S + AWAY_S + 40.0}
"""How long a stunt takes that leaves no room for the next until then: with 40 s for finding a place to park."""
