"""What a drive can stage: each kind of event with its look-alike, which looks like it and asks for nothing.

A staging only sets causes: a switch, a driver's mood, weather, a vehicle. Whether an event comes of it is found on
the drive itself, where the same causes may also lie in the road.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.occupants import SIGNALS, Occupant, Seat
from automotive_cosim.cockpit.sensor_range import RADAR_M
from automotive_cosim.cockpit.signals import BODY, CABIN, CALL, ENERGY, HVAC, LIGHTS, TYRE, Signal
from automotive_cosim.contracts import Weather
from automotive_cosim.drives.sky import (
    DENSE_FROM_S,
    DENSE_UNTIL_S,
    FOG_S,
    SHOWER_S,
    drizzle,
    fog_bank,
    rain,
    shower,
    sleet,
    snow,
)
from automotive_cosim.formats.incidents import (
    AheadIncident,
    AnyIncident,
    BrakingLeader,
    CutIn,
    CutOut,
    EmergencyVehicle,
)
from automotive_cosim.traffic.base import DriverAt, HaltAt

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True, slots=True)
class WeatherSpan:
    """Other weather for a while."""

    from_s: float
    to_s: float
    weather: Weather


@dataclass(frozen=True, slots=True)
class Causes:
    """What one staging adds to a drive."""

    moods: tuple[DriverAt, ...] = ()
    halts: tuple[HaltAt, ...] = ()
    changes: tuple[CarChange, ...] = ()
    incidents: tuple[AnyIncident, ...] = ()
    weather: tuple[WeatherSpan, ...] = ()
    driven_s: float = 0.0
    """How long the driver had been driving before departure."""


@dataclass(frozen=True, slots=True)
class Setting:
    """When and in what something is staged."""

    at_s: float
    """Seconds after departure."""
    is_lookalike: bool
    driver: str
    """The profile that the driver returns to."""
    weather: Weather
    """What the weather is otherwise."""
    rng: np.random.Generator
    aboard: tuple[Occupant, ...] = ()
    """Who is in the car besides the driver."""
    ahead_m: float | None = None
    """How far ahead of the car, or behind it, other vehicles and incidents are; None for what is usual."""

    def metres(self, usual_m: float) -> float:
        return usual_m if self.ahead_m is None else self.ahead_m


Staging = Callable[[Setting], Causes]

MOOD_S = 40.0
"""How long a driver keeps a mood."""
LEADER_WITHIN_S = 40.0
"""A leader that has not been found by then does not brake, lest it do so during the next staging."""
LATE_M = 135.0
"""How far ahead it brakes: just within the reach of the radar."""
OPEN_S = 60.0
"""How long a tailgate is open at least."""
PHONE_S = 40.0
"""How long a driver uses the phone."""
AHEAD_S = 420.0
"""How long an incident on the road lasts."""
BEHIND_M = 250.0
"""How far behind an ambulance appears, out of sight."""
SIGN_M = 500.0
"""How far ahead a sign is put up: the navigation announces it from there on."""
AHEAD_M = 1400.0
"""How far ahead it is staged: news that is a minute old is heard in time at 80 km/h."""
ALIGHT_S, AWAY_S = 10.0, 120.0
"""How long after parking the driver gets out, and for how long: beyond the deadline of 90 s."""
BREAK_AFTER_S = 2 * 3600.0
"""The Highway Code, rule 91: a break of at least 15 minutes after every two hours of driving."""


# --- the driver ---------------------------------------------------------------------------------------------


def _mood(of_event: str, of_lookalike: str) -> Staging:
    def stage(setting: Setting) -> Causes:
        mood = of_lookalike if setting.is_lookalike else of_event
        return Causes(moods=(DriverAt(setting.at_s, mood), DriverAt(setting.at_s + MOOD_S, setting.driver)))

    return stage


def _leader_close(setting: Setting) -> Causes:
    """The driver presses, behind somebody who eases off; as a look-alike, keeps two seconds."""
    until_s = setting.at_s + MOOD_S
    eases = BrakingLeader(
        from_s=setting.at_s,
        to_s=until_s,
        ahead_m=setting.metres(40.0),
        deceleration_mps2=0.2,
        to_kmh=40.0,
        keeps_lane=True,
    )
    return replace(_mood("pressing", "calm")(setting), incidents=(eases,))


def _fatigue(setting: Setting) -> Causes:
    """Two hours without a break are full at that time; as a look-alike, one and a half."""
    full_s = 0.75 * BREAK_AFTER_S if setting.is_lookalike else BREAK_AFTER_S
    return Causes(driven_s=full_s - setting.at_s)


def _belt(setting: Setting) -> Causes:
    """Somebody aboard opens the belt; as a look-alike, only pulls it straight."""
    people = [Seat.DRIVER, *(one.seat for one in setting.aboard if one.kind.is_person and one.belted)]
    belt = SIGNALS[people[int(setting.rng.integers(len(people)))]].belted
    return Causes(changes=_turned(belt, setting, False, 2.0 if setting.is_lookalike else 90.0))


def _left_behind(setting: Setting) -> Causes:
    """The driver parks and goes away, and who needs care stays; as a look-alike, the driver takes them along."""
    gone = [(SIGNALS[Seat.DRIVER], ALIGHT_S, ALIGHT_S + AWAY_S)]
    if setting.is_lookalike:  # out before the driver goes, and in after the driver has come
        gone += [
            (SIGNALS[one.seat], ALIGHT_S - 2.0, ALIGHT_S + AWAY_S + 2.0)
            for one in setting.aboard
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
    return Causes(halts=(HaltAt(setting.at_s, AWAY_S + 2 * ALIGHT_S),), changes=tuple(changes))


def _phone(setting: Setting) -> Causes:
    """The driver takes the phone in the hand; as a look-alike, uses it in its cradle."""
    where = "CRADLE" if setting.is_lookalike else "HAND"
    taken = CarChange(setting.at_s, CALL.PHONE.path, where)
    return Causes(changes=(taken, CarChange(setting.at_s + PHONE_S, CALL.PHONE.path, "AWAY")))


# --- the car ------------------------------------------------------------------------------------------------


def _turned(signal: Signal[bool], setting: Setting, value: bool, for_s: float) -> tuple[CarChange, ...]:
    return (CarChange(setting.at_s, signal.path, value), CarChange(setting.at_s + for_s, signal.path, not value))


def _set(setting: Setting, *values: tuple[Signal[bool] | Signal[str], bool | str]) -> tuple[CarChange, ...]:
    return tuple(CarChange(setting.at_s, signal.path, value) for signal, value in values)


def _door(setting: Setting) -> Causes:
    """The tailgate springs open, and the driver shuts it where the car stands; as a look-alike, somebody opens a
    window."""
    if setting.is_lookalike:
        return Causes(changes=(CarChange(setting.at_s, CABIN.REAR_LEFT_WINDOW.path, 15.0),))
    shut = CarChange(setting.at_s + OPEN_S, CABIN.TRUNK.path, False, once_standing=True)
    return Causes(changes=(CarChange(setting.at_s, CABIN.TRUNK.path, True), shut))


def _tyre(setting: Setting) -> Causes:
    """A tyre loses a third of its air in two minutes; as a look-alike, a twentieth."""
    tyre = (TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT)[int(setting.rng.integers(4))]
    return Causes(changes=(CarChange(setting.at_s, tyre.path, 237.0 if setting.is_lookalike else 165.0, 120.0),))


def _range(setting: Setting) -> Causes:
    """A cell fails and ten kilometres are left; as a look-alike, eighty: low, but enough."""
    return Causes(
        changes=(CarChange(setting.at_s, ENERGY.LEVEL.path, 18.0 if setting.is_lookalike else 2.5, 20.0),)
    )


def _lamps(setting: Setting) -> Causes:
    """The driver switches the lamps off; as a look-alike, to dipped beam by hand."""
    return Causes(changes=_set(setting, (LIGHTS.SWITCH, "BEAM" if setting.is_lookalike else "OFF")))


def _high_beam(setting: Setting) -> Causes:
    """The driver leaves high beam on; as a look-alike, flashes once."""
    to_beam = _set(setting, (LIGHTS.SWITCH, "BEAM"))
    return Causes(
        changes=(*to_beam, *_turned(LIGHTS.HIGH_BEAM, setting, True, 1.0 if setting.is_lookalike else 90.0))
    )


def _fog_lamps(setting: Setting) -> Causes:
    """The rear fog lamp in clear air; as a look-alike, in fog as thick as it is for."""
    from_s, to_s = (DENSE_FROM_S + 2.0, DENSE_UNTIL_S - 2.0) if setting.is_lookalike else (0.0, 100.0)
    on = CarChange(setting.at_s + from_s, LIGHTS.REAR_FOG.path, True)
    off = CarChange(setting.at_s + to_s, LIGHTS.REAR_FOG.path, False)
    weather = _bank(setting, 40.0) if setting.is_lookalike else ()
    return Causes(changes=(*_set(setting, (LIGHTS.SWITCH, "BEAM")), on, off), weather=weather)


def _glass_fog(setting: Setting) -> Causes:
    """The air is recirculated, with the fan low, for good; as a look-alike, for half a minute."""
    closed = (
        _turned(HVAC.RECIRCULATION, setting, True, 30.0)
        if setting.is_lookalike
        else _set(setting, (HVAC.RECIRCULATION, True))
    )
    weak = (CarChange(setting.at_s, HVAC.FAN_SPEED.path, 10.0),) if not setting.is_lookalike else ()
    return Causes(changes=(CarChange(setting.at_s, HVAC.AIR_CONDITIONING.path, False), *weak, *closed))


# --- the sky ------------------------------------------------------------------------------------------------


def _wipers(setting: Setting) -> Causes:
    """Rain sets in, and the wipers are off; as a look-alike, the sensor drives them."""
    mode = "RAIN_SENSOR" if setting.is_lookalike else "OFF"
    return Causes(
        changes=_set(setting, (BODY.FRONT_WIPER, mode)),
        weather=_shower(setting, rain(setting.weather), 5.0),
    )


def _bank(setting: Setting, visibility_m: float) -> tuple[WeatherSpan, ...]:
    """A bank of fog that comes over minutes."""
    return _spans(setting.at_s, fog_bank(setting.weather, visibility_m), FOG_S)


def _shower(setting: Setting, full: Weather, after_s: float = 0.0) -> tuple[WeatherSpan, ...]:
    return _spans(setting.at_s + after_s, shower(setting.weather, full), SHOWER_S)


def _spans(begun_s: float, parts: Iterable[tuple[float, Weather]], length_s: float) -> tuple[WeatherSpan, ...]:
    """Weather that comes and goes in steps."""
    steps = [(begun_s + after_s, weather) for after_s, weather in parts]
    ends_s = [*(at_s for at_s, _ in steps[1:]), begun_s + length_s]
    spans = zip(steps, ends_s, strict=True)
    return tuple(WeatherSpan(at_s, end_s, weather) for (at_s, weather), end_s in spans)


def _weather_speed(setting: Setting) -> Causes:
    """A bank of dense fog that the driver takes no notice of; as a look-alike, mist."""
    until_s = setting.at_s + FOG_S
    careless = (DriverAt(setting.at_s, "careless"), DriverAt(until_s, setting.driver))
    visibility_m = (
        1600.0 if setting.is_lookalike else float(round(setting.rng.uniform(14, 24)))
    )  # too little for 50 km/h
    return Causes(moods=careless, weather=_bank(setting, visibility_m))


def _slippery(setting: Setting) -> Causes:
    """Freezing rain or snow that the driver takes no notice of; as a look-alike, a trace of drizzle."""
    careless = (DriverAt(setting.at_s, "careless"), DriverAt(setting.at_s + SHOWER_S, setting.driver))
    fallen = drizzle(setting.weather) if setting.is_lookalike else sleet(setting.weather)
    return Causes(moods=careless, weather=_shower(setting, fallen))


# --- the road -----------------------------------------------------------------------------------------------


def _blue_light(setting: Setting) -> Causes:
    """An ambulance comes up from behind; as a look-alike, a van as fast."""
    comes = EmergencyVehicle(
        from_s=setting.at_s, blue_light=not setting.is_lookalike, behind_m=setting.metres(BEHIND_M)
    )
    return Causes(incidents=(comes,))


def _leader_brakes(setting: Setting) -> Causes:
    """Far ahead a car brakes to a halt, and a driver who presses reacts late; or it slows down gently.

    Only hard braking helps once 3.4 m/s2 are needed, and from 90 km/h on there are more than two seconds left then.
    """
    until_s = setting.at_s + LEADER_WITHIN_S
    if setting.is_lookalike:
        slows = BrakingLeader(
            from_s=setting.at_s, to_s=until_s, ahead_m=setting.metres(50.0), deceleration_mps2=0.8, to_kmh=25.0
        )
        return Causes(incidents=(slows,))
    brakes = BrakingLeader(
        from_s=setting.at_s,
        to_s=until_s,
        within_m=RADAR_M,
        beyond_m=LATE_M - 20.0,
        from_kmh=90.0,
        ahead_m=LATE_M,
        deceleration_mps2=9.0,
        to_kmh=0.0,
        keeps_lane=True,
    )
    return replace(_mood("pressing", "pressing")(setting), incidents=(brakes,))


def _ahead(what: Literal["breakdown", "roadworks", "left_sign", "jam", "tractor"]) -> Staging:
    """On the way; as a look-alike, on the other carriageway."""

    def stage(setting: Setting) -> Causes:
        until_s = setting.at_s + AHEAD_S
        incident = AheadIncident(
            what=what,
            from_s=setting.at_s,
            to_s=until_s,
            ahead_m=setting.metres(AHEAD_M),
            other_way=setting.is_lookalike,
        )
        return Causes(incidents=(incident,))

    return stage


def _cut_in(setting: Setting) -> Causes:
    """A slower vehicle moves over close in front; as a look-alike, far ahead and as fast as the car."""
    usual_m, slower_kmh = (60.0, 0.0) if setting.is_lookalike else (15.0, 20.0)
    cuts = CutIn(
        from_s=setting.at_s, to_s=setting.at_s + AHEAD_S, gap_m=setting.metres(usual_m), slower_kmh=slower_kmh
    )
    return Causes(incidents=(cuts,))


def _cut_out(setting: Setting) -> Causes:
    """The vehicle ahead moves over before one that stands."""
    cuts = CutOut(from_s=setting.at_s, to_s=setting.at_s + AHEAD_S, reveal_m=setting.metres(40.0))
    return Causes(incidents=() if setting.is_lookalike else (cuts,))


def _leader_stops(setting: Setting) -> Causes:
    """The vehicle ahead, if none is near a car that pulls out, brakes to a halt as hard as a car can."""
    hard = BrakingLeader(
        from_s=setting.at_s,
        to_s=setting.at_s + AHEAD_S,
        within_m=60.0,
        from_kmh=30.0,
        ahead_m=setting.metres(20.0),
        deceleration_mps2=1.0 if setting.is_lookalike else 6.0,
        to_kmh=30.0 if setting.is_lookalike else 0.0,
        keeps_lane=True,
    )
    return Causes(incidents=(hard,))


def _sign(
    plate: str = "",
    *,
    by_lane: bool = False,
    weather: Callable[[Weather], Weather] | None = None,
    mood: str | None = "hurried",
) -> Staging:
    """A driver in a hurry comes to a sign of a lower limit, with a plate or a variable one; as a look-alike, it is
    on the other carriageway. What it holds in falls as long as it stands. Without a mood, nobody hurries."""

    def stage(setting: Setting) -> Causes:
        until_s = setting.at_s + AHEAD_S
        sign = AheadIncident(
            what="sign",
            from_s=setting.at_s,
            to_s=until_s,
            ahead_m=setting.metres(SIGN_M),
            plate=plate,
            shows="by lane" if by_lane else "over all lanes",
            other_way=setting.is_lookalike,
        )
        moods = () if mood is None else (DriverAt(setting.at_s, mood), DriverAt(until_s, setting.driver))
        falls = () if weather is None else (WeatherSpan(setting.at_s, until_s, weather(setting.weather)),)
        return Causes(moods=moods, incidents=(sign,), weather=falls)

    return stage


STAGINGS: Mapping[str, Staging] = {
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
"""The stagings by the kind of event that they stage at a time."""
ON_REQUEST: Mapping[str, Staging] = {
    **STAGINGS,
    "cut_in": _cut_in,
    "cut_out": _cut_out,
    "leader_stops": _leader_stops,
    "left_sign": _ahead("left_sign"),
    "wet_sign": _sign("wet", weather=rain),
    "snow_sign": _sign("snow", weather=snow),
    "hours_sign": _sign("06:00-22:00"),
    "variable_sign": _sign(),
    "lane_sign": _sign(by_lane=True),
    "lorry_sign": _sign("hgv", mood=None),
    "arrow_sign": _sign("arrow", mood=None),
    "lane_arrow_sign": _sign("lane arrow", by_lane=True, mood=None),
}
"""What the settings of a drive can stage; families draw from ``STAGINGS`` alone."""
NOT_BINDING = ("lorry_sign", "arrow_sign", "lane_arrow_sign")
"""Signs for others, which a careful agent leaves alone: nothing comes due of them."""
BRINGS: Mapping[str, tuple[str, ...]] = {
    "cut_in": ("leader_close", "leader_brakes"),
    "cut_out": ("breakdown", "leader_brakes"),
    "leader_stops": ("leader_brakes", "leader_close"),
    **dict.fromkeys(
        ("left_sign", "wet_sign", "snow_sign", "hours_sign", "variable_sign", "lane_sign"),
        ("limit_falls", "over_limit"),
    ),
    **dict.fromkeys(NOT_BINDING, ("over_limit",)),
}
"""The kinds of events that those stagings bring about which have no kind's name."""
SCHOOL_ZONE = "school_zone"
"""The kind that is staged by place: where a school zone begins at its hours."""
AT_SCHOOLS = ("hurried", "brisk")
"""Driver profiles in school zones: as an event and as its look-alike."""
STAGED = STAGINGS.keys() | {SCHOOL_ZONE}
"""Every kind that a cast may hold."""

ONCE = frozenset({"fatigue", "range", "left_behind"})
"""Kinds that a drive stages as an event or as a look-alike, not both: a battery does not fill up again, and
one halt is enough."""
OF_WEATHER = frozenset({"wipers", "weather_speed", "slippery"})
"""Kinds whose stagings change the weather, as an event and as a look-alike."""
TAKES_S: Mapping[str, float] = {"left_behind": 2 * ALIGHT_S + AWAY_S + 40.0}
"""How long a staging takes that leaves no room for the next until then: with 40 s for finding a place to park."""
COMES_S: Mapping[str, float] = {
    "glass_fog": 180.0,
    "slippery": 120.0,
    "tyre": 120.0,
    "weather_speed": DENSE_UNTIL_S,
    **dict.fromkeys(("breakdown", "roadworks", "jam_tail", "tractor"), 200.0),
}
"""How long an event may take until it obliges, where others take less: fog closes in, a tyre loses its air, the car
drives to what is 1.4 km ahead, at 25 km/h."""
