"""What the car reads on a drive, and which changes of it end a wait.

Each reading states a quantity, its limit or nominal value where there is one, and its trend. The list is published
and says nothing of events: whatever changes wakes, also what only looks like an event, and nothing tells the two
apart. A wait's result says that something changed and not what; the readings mark it. They are of what an agent may
read; the checks of the law are not among them.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from math import ceil, floor

from automotive_cosim.cockpit.notices import LOW_KPA
from automotive_cosim.cockpit.occupants import Seat, seated_by
from automotive_cosim.cockpit.sensor_range import HORIZON_M, RADAR_M
from automotive_cosim.cockpit.signals import (
    BODY,
    CABIN,
    CALL,
    ENERGY,
    GLASS,
    HMI,
    HVAC,
    LIGHTS,
    MOTION,
    OCCUPANT,
    TYRE,
)
from automotive_cosim.contracts import KMH_PER_MPS, OtherVehicle, SightKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.margins import margin_kmh
from automotive_cosim.geo.text import KM_PER_MILE
from automotive_cosim.geo.weather import visibility_class
from automotive_cosim.geo.weather import words as weather_words
from automotive_cosim.traffic.road_weather import ICY, WORSE_THAN_WET, sight_speed_mps

LONGEST_S = 60
"""A wait without a reason to wake ends after this."""
OVER_S = 3.0
CLOSE_S = 2.0
CLOSE_STEPS_S = (CLOSE_S, 1.0)
"""Time gaps: what is advised, and less than a driver needs to react."""
EASED_S = 10.0
"""What has eased for as long may become worse again, and wakes."""
CLOSING_S = (8.0, 5.0)
"""Times to collision: time to brake gently behind a slow vehicle, and the last for a warning to be heard."""
FAR_S = 120.0
"""Who is so long from a collision does not close, as a car would say."""
STANDING_MPS = 0.1
BEFORE_S = (15.0, 2.0)
"""What lies ahead wakes this long before a warning of it is due, at the speed driven."""
DUE_S = {"tunnel": 10.0, "jam": 15.0, "breakdown": 12.0, "roadworks": 12.0, "closure": 12.0, "school zone": 8.0}
"""Seconds ahead at which a warning of it is due, at the speed driven."""
COASTING_MPS2 = 1.0
REACTION_S = 1.1
BLUE_M = 150.0
ROLLING_KMH = 5.0
QUEUE_MPS = 3.0
"""Below this, in a queue, nothing ahead wakes."""
GRIP_STEPS = (0.9, WORSE_THAN_WET, ICY, 0.3)
"""Wet, soaked, snow or slush, packed snow or ice (``traffic.road_weather``)."""
FASTEST_KMH, SIGHT_STEP_KMH = 130.0, 10.0
"""Sight for less than that speed is short, and tells at each step of it."""
FROST_C = 4.0
"""Cars warn of possible ice from this temperature."""
PASSED = "ended, no longer ahead"
MIST = 0.1
RECOMMENDED_KPA = 250.0
SOFT_KPA = 240.0
TREND_S = 10.0
"""A reading rises or falls if it does over this time."""
WEATHER_S = 18.0
"""The same for weather, which comes on in steps of up to fifteen seconds (``sky``)."""
TURN_S = 3.0
"""A reading that has turned round within this time reads as it goes now."""
WINDOWS = (
    CABIN.DRIVER_WINDOW,
    CABIN.PASSENGER_WINDOW,
    CABIN.REAR_LEFT_WINDOW,
    CABIN.REAR_RIGHT_WINDOW,
    CABIN.SUNROOF,
)
TYRES = {
    "front left": TYRE.FRONT_LEFT,
    "front right": TYRE.FRONT_RIGHT,
    "rear left": TYRE.REAR_LEFT,
    "rear right": TYRE.REAR_RIGHT,
}

Drive = Sequence[Moment]
"""The moments of a drive so far, one per second."""
WakeReader = Callable[[Moment], Hashable]
"""What wakes when it changes to something other than None."""


@dataclass(frozen=True, slots=True)
class Nearness:
    """How near something is, in steps that only go up while it is there: it wakes at each new one."""

    what: Hashable
    """Tells one thing from the next."""
    number: int
    """0 while it is there and too far to wake."""


@dataclass(frozen=True, slots=True)
class Level:
    """How bad something is, in one or several kinds of steps: it wakes when it is at a higher step in any of them,
    and is silent while it eases."""

    steps: tuple[int, ...]

    def __le__(self, other: Level) -> bool:
        return all(mine <= its for mine, its in zip(self.steps, other.steps, strict=True))


@dataclass(frozen=True, slots=True)
class Wake:
    """One thing that the car reads, and whose changes end a wait."""

    name: str
    about: str
    """When it wakes."""
    reads: WakeReader
    words: Callable[[Drive], str]
    """Quantity, limit and trend; empty while there is nothing to read."""
    hold_s: float = 0.0
    """How long the reading must have differed from what was told last."""
    ended: str = "ended"
    """What the reading says once there is nothing to read; it begins with ``ended``."""


# --- quantities ------------------------------------------------------------------------------------------------


def _limit_kmh(now: Moment) -> float | None:
    """The sign's limit, else the law's for this kind of road."""
    if now.driving.road.limit.is_posted:
        return now.driving.road.limit.kmh
    law = now.context.default_limit
    value = None if law is None else law.value
    if law is None or not isinstance(value, float):
        return None
    return value * KM_PER_MILE if law.rule.unit == "mph" else value


def _read_kmh(now: Moment) -> float | None:
    """That limit as it is read: 50 mph and 80 km/h are one."""
    kmh = _limit_kmh(now)
    return None if kmh is None else round(kmh)


def _kmh(now: Moment) -> float:
    return now.driving.speed_mps * KMH_PER_MPS


def before(drive: Drive, seconds: float = TREND_S) -> Moment:
    """The moment so long ago, or the first."""
    from_s = drive[-1].time_s - seconds
    for moment in reversed(drive):
        if moment.time_s <= from_s:
            return moment
    return drive[0]


def _trend(now: float, before: float, by: float) -> str:
    """Rising, falling or steady; a change counts from ``by`` on."""
    return "steady" if abs(now - before) < by else "rising" if now > before else "falling"


def _trend_of(drive: Drive, read: Callable[[Moment], float], by: float, over_s: float = TREND_S) -> str:
    """The trend over some seconds; that of the last three, where these go the other way as fast."""
    now = read(drive[-1])
    whole = _trend(now, read(before(drive, over_s)), by)
    if whole == "steady":
        return whole
    turned = _trend(now, read(before(drive, TURN_S)), by * TURN_S / over_s)
    return whole if turned == "steady" else turned


def _signal_trend(drive: Drive, path: str, by: float) -> str:
    return _trend_of(drive, lambda moment: float(moment.signals[path]), by)


def _share(value: float) -> str:
    """Rounded down: what is below a step must not read as if it had reached it."""
    return f"{floor(1000 * value) / 10:.1f}%"


def _step(value: float, size: float, least: float) -> Hashable:
    """The reading of a gauge in steps, from one value on."""
    return None if value < least else int(value / size)


# --- speed and traffic -----------------------------------------------------------------------------------------


def _too_fast(now: Moment) -> Hashable:
    limit = _limit_kmh(now)
    if limit is None or _kmh(now) <= limit + 1.0:
        return None
    over = _kmh(now) / limit
    return limit, sum(over >= step for step in (1.1, 1.2, 1.3))


def _limit_words(drive: Drive) -> str:
    limit, is_signed = _limit_kmh(drive[-1]), drive[-1].driving.road.limit.is_posted
    if limit is None:
        return "lifted by a sign" if is_signed else "not signed"
    return f"{limit:.0f} km/h by {'a sign' if is_signed else 'law'}"


def _speed_words(drive: Drive) -> str:
    kmh, limit = _kmh(drive[-1]), _limit_kmh(drive[-1])
    trend = _trend_of(drive, _kmh, 3.0, over_s=5.0)
    if limit is not None:
        return f"{kmh:.0f} km/h, limit {limit:.0f}, {trend}"
    lifted = drive[-1].driving.road.limit.is_posted
    return f"{kmh:.0f} km/h, {'no limit' if lifted else 'limit unknown'}, {trend}"


def in_sight(now: Moment) -> OtherVehicle | None:
    """The vehicle ahead, within the reach of the radar."""
    leader = now.driving.around.leader
    return leader if leader is not None and leader.gap_m <= RADAR_M else None


def _leader(now: Moment) -> Hashable:
    leader, mps = in_sight(now), now.driving.speed_mps
    if leader is None or mps < QUEUE_MPS:
        return None
    left_s = leader.time_to_collision_s
    closing = 0 if left_s is None else sum(left_s < step_s for step_s in CLOSING_S)
    close = sum(leader.gap_m < step_s * mps for step_s in CLOSE_STEPS_S)
    return Level((closing, close)) if closing or close else None


def _leader_words(drive: Drive) -> str:
    leader, mps = in_sight(drive[-1]), drive[-1].driving.speed_mps
    if leader is None:
        return ""
    gap_s = f"time gap {leader.gap_m / mps:.1f} s" if mps >= STANDING_MPS else "the car stands"
    ttc_s = leader.time_to_collision_s
    closing = "not closing" if ttc_s is None or ttc_s > FAR_S else f"time to collision {ttc_s:.1f} s"
    return f"{leader.gap_m:.0f} m at {leader.speed_mps * KMH_PER_MPS:.0f} km/h, {gap_s}, {closing}"


def _behind(now: Moment) -> Hashable:
    blue = now.sight(SightKind.EMERGENCY_VEHICLE)
    if blue is not None:
        return "blue light", (blue.distance_m or 0.0) <= BLUE_M
    return "vehicle" if now.sight(SightKind.VEHICLE_BEHIND) is not None else None


def _behind_words(drive: Drive) -> str:
    for kind, words in ((SightKind.EMERGENCY_VEHICLE, "blue light"), (SightKind.VEHICLE_BEHIND, "vehicle")):
        sight = drive[-1].sight(kind)
        if sight is not None:
            away_m, closing_mps = sight.distance_m or 0.0, sight.value or 0.0
            if closing_mps * KMH_PER_MPS <= 1:
                return f"{words} {away_m:.0f} m behind, not closing"
            closing = f"closing at {closing_mps * KMH_PER_MPS:.0f} km/h, {away_m / closing_mps:.1f} s away"
            return f"{words} {away_m:.0f} m behind, {closing}"
    return ""


# --- what lies ahead -------------------------------------------------------------------------------------------


def _far(away_m: float, now: Moment) -> str:
    """Rounded up: what is still ahead does not read as if it were here."""
    mps = now.driving.speed_mps
    return f"{ceil(away_m)} m" + (f", {away_m / mps:.0f} s at this speed" if mps >= QUEUE_MPS else "")


def _steps(away_m: float, due_m: float, now: Moment) -> int:
    """How many of the steps before ``due_m`` have been passed at the speed driven."""
    mps = now.driving.speed_mps
    return 0 if mps < QUEUE_MPS else sum(away_m <= due_m + seconds * mps for seconds in BEFORE_S)


def _next_limit(now: Moment) -> Hashable:
    limit, away_m = now.driving.ahead.next_limit, now.driving.ahead.next_limit_distance_m
    if limit is None or not limit.is_posted or limit.kmh is None or away_m is None or away_m > HORIZON_M:
        return None
    mps, right_mps = now.driving.speed_mps, (limit.kmh + margin_kmh(limit.kmh)) / KMH_PER_MPS
    coasting_m = max(0.0, (mps**2 - right_mps**2) / (2 * COASTING_MPS2)) + mps * REACTION_S
    return Nearness(limit.kmh, _steps(away_m, coasting_m, now))


def _next_limit_words(drive: Drive) -> str:
    ahead = drive[-1].driving.ahead
    limit, away_m = ahead.next_limit, ahead.next_limit_distance_m
    if limit is None or not limit.is_posted or away_m is None or away_m > HORIZON_M:
        return ""
    what = "no limit" if limit.kmh is None else f"{limit.kmh:.0f} km/h"
    sign = drive[-1].sight(SightKind.LIMIT)
    return f"{what} in {_far(away_m, drive[-1])}{_signed('' if sign is None else sign.hours)}"


def _signed(hours: str) -> str:
    return f", signed for {hours}" if hours else ""


def _ahead(
    name: str,
    away_m: Callable[[Moment], float | None],
    about: str,
    more: Callable[[Moment], str] = lambda now: "",
) -> Wake:
    """What the map or the traffic service reports on the route.

    Args:
        away_m: how far it is; 0 within it, None without it.
        more: what else there is to read, within it or ahead of it.
    """

    def reads(now: Moment) -> Hashable:
        far_m = away_m(now)
        if far_m is None:
            return None
        return Nearness(name, 0 if far_m <= 0 else _steps(far_m, DUE_S[name] * now.driving.speed_mps, now))

    def words(drive: Drive) -> str:
        far_m = away_m(drive[-1])
        if far_m is None:
            return ""
        return f"{'the car is in it' if far_m <= 0 else f'in {_far(far_m, drive[-1])}'}{more(drive[-1])}"

    early, late = (seconds + DUE_S[name] for seconds in BEFORE_S)
    return Wake(
        name,
        f"{about} on the route within {early:.0f} s, and {late:.0f} s, at the speed driven",
        reads,
        words,
        ended=PASSED,
    )


def _reported(kind: SightKind, about: str) -> Wake:
    def away_m(now: Moment) -> float | None:
        sight = now.sight(kind)
        return None if sight is None else sight.distance_m

    def more(now: Moment) -> str:
        sight = now.sight(kind)
        if sight is None:
            return ""
        left_m = sight.value if not sight.distance_m else None
        return _signed(sight.hours) + ("" if left_m is None else f", {left_m:.0f} m are left")

    return _ahead(kind.value.replace("_", " "), away_m, about, more)


# --- sky and road ----------------------------------------------------------------------------------------------


def _light_words(drive: Drive) -> str:
    now = drive[-1]
    return "in a tunnel" if now.driving.road.in_tunnel else str(now.context.sun and now.context.sun.darkness)


LAMPS = {
    "dipped beam": LIGHTS.LOW_BEAM,
    "high beam": LIGHTS.HIGH_BEAM,
    "front fog lamps": LIGHTS.FRONT_FOG,
    "rear fog lamp": LIGHTS.REAR_FOG,
    "hazard lights": LIGHTS.HAZARD,
}


def _lamps(now: Moment) -> tuple[str, ...]:
    return tuple(name for name, lamp in LAMPS.items() if now.signals[lamp.path])


def _lamp_words(drive: Drive) -> str:
    now = drive[-1]
    lit = [*_lamps(now), *(["daytime running lamps"] if _runs_by_day(now) else [])]
    return f"on: {', '.join(lit) or 'none'}, switch: {str(now.signals[LIGHTS.SWITCH.path]).lower()}"


def _runs_by_day(now: Moment) -> bool:
    """Whether the daytime running lamps are on, by themselves: while the car is ready to drive, and neither
    headlamps nor front fog lamps are on (UN R48, 6.19.7)."""
    others = (LIGHTS.LOW_BEAM, LIGHTS.HIGH_BEAM, LIGHTS.FRONT_FOG)
    return now.signals[MOTION.GEAR.path] != "P" and not any(now.signals[lamp.path] for lamp in others)


def _weather(now: Moment) -> Hashable:
    """Its code, the class of the visibility and frost; where the sight is short, also for which speed it is enough,
    because advice names that."""
    weather = now.weather
    enough_kmh = sight_speed_mps(weather.visibility, now.driving.road.friction) * KMH_PER_MPS
    is_short = enough_kmh < FASTEST_KMH
    return (
        weather.weather_code,
        visibility_class(weather.visibility),
        floor(enough_kmh / SIGHT_STEP_KMH) if is_short else None,
        weather.temperature_2m <= FROST_C,
    )


def _weather_words(drive: Drive) -> str:
    weather = drive[-1].weather
    trend = _trend_of(drive, lambda moment: moment.weather.visibility, 0.05 * weather.visibility, WEATHER_S)
    return f"{weather_words(weather.weather_code)}, visibility {weather.visibility:.0f} m, {trend}"


def _road(now: Moment) -> str:
    road = now.driving.road
    zone = ", school zone" if road.school_zone else ""
    hours = f", another limit {road.limit_hours}" if road.limit_hours else ""
    return f"{road.road_class.replace('_', ' ') or 'road'}{zone}{hours}"


def _grip(now: Moment) -> Hashable:
    steps = sum(now.driving.road.friction < step for step in GRIP_STEPS)
    return Level((steps,)) if steps else None


def _grip_words(drive: Drive) -> str:
    trend = _trend_of(drive, lambda moment: moment.driving.road.friction, 0.02)
    return f"{drive[-1].driving.road.friction:.2f} of 1, {trend}"


def _unwiped(now: Moment) -> float:
    """The film on the windshield while the wipers are off."""
    return 0.0 if now.signals[BODY.FRONT_WIPER.path] != "OFF" else float(now.signals[GLASS.WINDSHIELD_FILM.path])


# --- the car and who is in it ----------------------------------------------------------------------------------


def _hours(now: Moment) -> float | None:
    sight = now.sight(SightKind.DRIVING_TIME)
    return None if sight is None else sight.value


def _rolling(now: Moment, what: Hashable) -> Nearness:
    """It is there; a second step once the car sets off with it, which a queue does not take back."""
    return Nearness(what, 1 + (_kmh(now) >= ROLLING_KMH))


def _rolls(now: Moment) -> str:
    return ", and the car drives" if _kmh(now) >= ROLLING_KMH else ""


def _unbelted(now: Moment) -> tuple[tuple[str, str], ...]:
    return tuple((one.seat.words, str(one.kind)) for one in seated_by(now.signals) if not one.belted)


def _others(now: Moment) -> tuple[tuple[str, str], ...]:
    """Who or what is aboard besides the driver."""
    aboard = seated_by(now.signals)
    return tuple((one.seat.words, str(one.kind)) for one in aboard if one.seat is not Seat.DRIVER)


def _is_left(now: Moment) -> bool:
    return not now.signals[OCCUPANT.DRIVER.occupied.path]


def _who(seats: tuple[tuple[str, str], ...]) -> str:
    return ", ".join(f"{kind} on the seat {seat}" for seat, kind in seats) or "nobody"


def _parked_words(drive: Drive) -> str:
    now = drive[-1]
    if now.signals[MOTION.GEAR.path] != "P":
        return ""
    air = f", {now.signals[HVAC.FORECAST.path]:.0f} degrees inside before long" if _is_left(now) else ""
    return f"the driver {'has left' if _is_left(now) else 'is there'}, aboard: {_who(_others(now))}{air}"


def _lowest_kpa(now: Moment) -> float:
    return float(min(now.signals[tyre.path] for tyre in TYRES.values()))


def _soft_steps(kpa: float) -> int:
    """How many tens of kPa have been lost below 240 and one; 0 above."""
    return 0 if kpa > SOFT_KPA else 1 + ceil((SOFT_KPA - kpa) / 10.0 - 1e-9)


def _tyre_words(drive: Drive) -> str:
    found = []
    for name, tyre in TYRES.items():
        trend = _signal_trend(drive, tyre.path, 0.5)
        found.append(f"{name} {floor(drive[-1].signals[tyre.path])}" + (f" {trend}" if trend != "steady" else ""))
    return f"{', '.join(found)} kPa, recommended {RECOMMENDED_KPA:.0f}, too low below {LOW_KPA:.0f}"


def _spare_m(now: Moment) -> float:
    return float(now.signals[ENERGY.RANGE.path]) - now.driving.ahead.route_left_m


def _range(now: Moment) -> Hashable:
    spare_m = _spare_m(now)
    steps = sum(spare_m <= step_m for step_m in (5000.0, 2000.0))
    return steps or (now.signals[ENERGY.LEVEL.path] < 20.0 or None)


def _range_words(drive: Drive) -> str:
    now = drive[-1]
    trend = ", falling fast" if _signal_trend(drive, ENERGY.RANGE.path, 1000.0) == "falling" else ""
    left_km = now.driving.ahead.route_left_m / 1000
    return f"{now.signals[ENERGY.RANGE.path] / 1000:.1f} km{trend}, {left_km:.1f} km to go"


def _open_parts(now: Moment) -> tuple[str, ...]:
    parts = {
        "trunk": now.signals[CABIN.TRUNK.path],
        "charging flap": now.signals[ENERGY.CHARGE_FLAP.path],
        "window": any(now.signals[part.path] > 0 for part in WINDOWS),
    }
    return tuple(name for name, is_open in parts.items() if is_open)


def _phone(now: Moment) -> str:
    return str(now.signals[CALL.PHONE.path])


PHONE = {"HAND": "in the driver's hand", "CRADLE": "in use in its cradle"}


def _place_words(drive: Drive) -> str:
    now = drive[-1]
    shown = "mph" if now.signals[HMI.DISTANCE_UNIT.path] == "MILES" else "km/h"
    return f"{now.context.country}, signs in {now.context.speed_unit}, the car shows {shown}"


WAKES: tuple[Wake, ...] = (
    Wake("limit", "the speed limit changes", _read_kmh, _limit_words),
    Wake(
        "speed",
        "the car has been above the limit for three seconds, and each 10 % more",
        _too_fast,
        _speed_words,
        hold_s=OVER_S,
    ),
    Wake(
        "limit ahead",
        "another limit is signed ahead: 15 s, and 2 s, before a driver would have to lift the foot for it",
        _next_limit,
        _next_limit_words,
        ended=PASSED,
    ),
    Wake(
        "vehicle ahead",
        "a time gap of less than 2 s to the vehicle ahead, and 1 s, or less than 8 s to collision, and 5 s",
        _leader,
        _leader_words,
        1.0,
        ended=f"ended, nobody within {RADAR_M:.0f} m",
    ),
    Wake(
        "behind",
        "a vehicle comes close from behind, or a blue light, and that within 150 m",
        _behind,
        _behind_words,
        1.0,
    ),
    _ahead("tunnel", lambda now: now.driving.ahead.tunnel_distance_m, "a tunnel"),
    _reported(SightKind.JAM, "a jam"),
    _reported(SightKind.BREAKDOWN, "a broken-down vehicle"),
    _reported(SightKind.ROADWORKS, "roadworks"),
    _reported(SightKind.CLOSURE, "a closed road"),
    _reported(SightKind.SCHOOL_ZONE, "a school zone"),
    Wake(
        "road",
        "another class of road, a school zone, other hours of a limit",
        _road,
        lambda drive: _road(drive[-1]),
    ),
    Wake(
        "light",
        "day, twilight, night; into or out of a tunnel",
        lambda now: (now.context.sun and now.context.sun.darkness, now.driving.road.in_tunnel),
        _light_words,
    ),
    Wake("lamps", "a lamp goes on or off", _lamps, _lamp_words),
    Wake(
        "weather",
        "other weather, another class of visibility, sight for 10 km/h less or more, frost",
        _weather,
        _weather_words,
    ),
    Wake("grip", "the grip of the road falls below 0.9, 0.7, 0.5 and 0.3 of that of a dry one", _grip, _grip_words),
    Wake(
        "glass",
        "the windshield fogs, every tenth",
        lambda now: _step(now.signals[GLASS.WINDSHIELD_FOG.path], MIST, MIST),
        lambda drive: (
            f"windshield fogged by {_share(fog)}, {_signal_trend(drive, GLASS.WINDSHIELD_FOG.path, 0.01)}"
            if (fog := drive[-1].signals[GLASS.WINDSHIELD_FOG.path]) >= MIST / 2
            else ""
        ),
    ),
    Wake(
        "rain",
        "rain on the windshield with the wipers off, every tenth",
        lambda now: _step(_unwiped(now), MIST, MIST),
        lambda drive: (
            f"windshield covered by {_share(film)}, {_signal_trend(drive, GLASS.WINDSHIELD_FILM.path, 0.01)}, "
            "wipers off"
            if (film := _unwiped(drive[-1])) >= MIST / 2
            else ""
        ),
        ended="ended, the glass is wiped or dry",
    ),
    Wake(
        "tyres",
        "the softest tyre, below 240 kPa, every 10 kPa that it loses",
        lambda now: Nearness("tyre", _soft_steps(_lowest_kpa(now))),
        _tyre_words,
    ),
    Wake(
        "range",
        "less than 5 km more than the route, and less than 2 km; the battery below 20 %",
        _range,
        _range_words,
    ),
    Wake(
        "belt",
        "the belt of a seat that is taken is opened, or the car sets off without it",
        lambda now: _rolling(now, _unbelted(now)) if _unbelted(now) else None,
        lambda drive: f"open: {_who(_unbelted(drive[-1]))}{_rolls(drive[-1])}" if _unbelted(drive[-1]) else "",
    ),
    Wake(
        "open",
        "a door, flap or window is open, or the car sets off with it",
        lambda now: _rolling(now, _open_parts(now)) if _open_parts(now) else None,
        lambda drive: f"{', '.join(parts)}{_rolls(drive[-1])}" if (parts := _open_parts(drive[-1])) else "",
    ),
    Wake(
        "phone",
        "the driver takes a phone, in the hand or in its cradle, or sets off with it",
        lambda now: None if _phone(now) == "AWAY" else _rolling(now, _phone(now)),
        lambda drive: f"{PHONE[phone]}{_rolls(drive[-1])}" if (phone := _phone(drive[-1])) in PHONE else "",
    ),
    Wake(
        "driving time",
        "an hour of driving without a break, and every quarter more",
        lambda now: None if (hours := _hours(now)) is None else int(hours * 4),
        lambda drive: "" if (hours := _hours(drive[-1])) is None else f"{hours:.2f} h without a break",
    ),
    Wake(
        "parked",
        "the driver parks the car on the way, leaves it, or comes back",
        lambda now: (_is_left(now), _others(now)) if now.signals[MOTION.GEAR.path] == "P" else None,
        _parked_words,
    ),
    Wake("place", "another country", lambda now: now.context.country or None, _place_words),
    Wake(
        "asked",
        "somebody aboard asks for something",
        lambda now: len(now.asked) or None,
        lambda drive: f"{drive[-1].time_s - drive[-1].asked[-1].at_s:.0f} s ago" if drive[-1].asked else "",
    ),
    Wake(
        "call",
        "the phone rings",
        lambda now: now.signals[CALL.RINGING.path] or None,
        lambda drive: "ringing" if drive[-1].signals[CALL.RINGING.path] else "",
    ),
    Wake(
        "message",
        "a message arrives",
        lambda now: now.signals[CALL.UNREAD.path] or None,
        lambda drive: f"{unread:.0f} unread" if (unread := drive[-1].signals[CALL.UNREAD.path]) else "",
    ),
)
"""Everything that is read and that wakes."""
