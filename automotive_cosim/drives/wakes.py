"""What wakes an agent that waits on a drive: changes that the car itself notices.

The list is published and says nothing of events: whatever changes wakes, also what only looks like an event, and
nothing tells the two apart. It reads what an agent may read; the checks of the law are not among it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from math import floor

from automotive_cosim.cockpit.aboard import Seat, seated_by
from automotive_cosim.cockpit.signals import BODY, CABIN, CALL, ENERGY, GLASS, HMI, LIGHTS, MOTION, OCCUPANT, TYRE
from automotive_cosim.contracts import KMH_PER_MPS, Sight, SightKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.text import KM_PER_MILE
from automotive_cosim.geo.weather import visibility_class
from automotive_cosim.geo.weather import words as weather_words

LONGEST_S = 60
"""A wait without a reason to wake ends after this."""
OVER_S = 3.0
CLOSE_S = 2.0
CLOSING_S = (8.0, 5.0)
"""Times to collision: time to brake gently behind a slow vehicle, and the last for a warning to be heard."""
TUNNEL_M = 500.0
REPORT_M = 1500.0
BLUE_M = 150.0
ROLLING_KMH = 5.0
MIST = 0.1
WINDOWS = (
    CABIN.DRIVER_WINDOW,
    CABIN.PASSENGER_WINDOW,
    CABIN.REAR_LEFT_WINDOW,
    CABIN.REAR_RIGHT_WINDOW,
    CABIN.SUNROOF,
)
TYRES = (TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT)

WakeReading = Callable[[Moment], Hashable]
"""A reading; None while there is nothing to report."""


@dataclass(frozen=True, slots=True)
class Wake:
    """One thing that wakes when it changes to something other than nothing."""

    name: str
    about: str
    reads: WakeReading
    words: Callable[[Moment], str]
    hold_s: float = 0.0
    """How long the reading must have differed from what was told last."""


def _limit_kmh(now: Moment) -> float | None:
    """The sign's limit, else the law's for this kind of road."""
    if now.driving.road.limit.is_posted:
        return now.driving.road.limit.kmh
    law = now.context.default_limit
    value = None if law is None else law.value
    if law is None or not isinstance(value, float):
        return None
    return value * KM_PER_MILE if law.rule.unit == "mph" else value


def _kmh(now: Moment) -> float:
    return now.driving.speed_mps * KMH_PER_MPS


def _too_fast(now: Moment) -> Hashable:
    limit = _limit_kmh(now)
    if limit is None or _kmh(now) <= limit + 1.0:
        return None
    over = _kmh(now) / limit
    return limit, sum(over >= step for step in (1.1, 1.2, 1.3))


def _leader(now: Moment) -> Hashable:
    leader, mps = now.driving.around.leader, now.driving.speed_mps
    if leader is None or mps < 5.0:
        return None
    left_s = leader.time_to_collision_s
    closing = left_s is not None and sum(left_s < step_s for step_s in CLOSING_S)
    return closing or ("close" if leader.gap_m < CLOSE_S * mps else None)


def _leader_words(now: Moment) -> str:
    leader = now.driving.around.leader
    if leader is None:
        return "nobody ahead"
    gap_s = leader.gap_m / max(now.driving.speed_mps, 0.1)
    return f"vehicle {leader.gap_m:.0f} m ahead, {gap_s:.1f} s"


def _seen(now: Moment, kind: SightKind) -> Sight | None:
    return next((sight for sight in now.sights if sight.kind is kind), None)


def _behind(now: Moment) -> Hashable:
    blue = _seen(now, SightKind.EMERGENCY_VEHICLE)
    if blue is not None:
        return "blue light", _ahead_m(blue.distance_m, BLUE_M)
    return "vehicle" if _seen(now, SightKind.VEHICLE_BEHIND) is not None else None


def _behind_words(now: Moment) -> str:
    blue = _seen(now, SightKind.EMERGENCY_VEHICLE)
    if blue is not None:
        return f"blue light {blue.distance_m or 0:.0f} m behind"
    other = _seen(now, SightKind.VEHICLE_BEHIND)
    return f"a vehicle {0 if other is None else other.distance_m or 0:.0f} m behind comes closer"


def _reported(kind: SightKind, about: str) -> Wake:
    """What the traffic service or the map reports on the route."""

    def away_m(now: Moment) -> float | None:
        sight = _seen(now, kind)
        return None if sight is None else sight.distance_m

    return Wake(
        kind.value.replace("_", " "),
        f"{about} on the route within 1500, 750 and 400 m",
        lambda now: _ahead_m(away_m(now), REPORT_M, REPORT_M / 2, 400.0),
        lambda now: f"in {away_m(now) or 0:.0f} m",
    )


def _hours(now: Moment) -> float | None:
    sight = _seen(now, SightKind.DRIVING_TIME)
    return None if sight is None else sight.value


def _road(now: Moment) -> Hashable:
    road = now.driving.road
    return (road.road_class, road.school_zone, road.limit_hours) if road.road_class else None


def _lamps(now: Moment) -> tuple[bool, ...]:
    return tuple(
        bool(now.signals[lamp.path])
        for lamp in (LIGHTS.LOW_BEAM, LIGHTS.HIGH_BEAM, LIGHTS.FRONT_FOG, LIGHTS.REAR_FOG, LIGHTS.HAZARD)
    )


def _lamp_words(now: Moment) -> str:
    return "dipped beam " + ("on" if _lamps(now)[0] else "off")


def _step(value: float, size: float, least: float) -> Hashable:
    """The reading of a gauge in steps, from one value on."""
    return None if value < least else int(value / size)


def _place_words(now: Moment) -> str:
    shown = "mph" if now.signals[HMI.DISTANCE_UNIT.path] == "MILES" else "km/h"
    return f"{now.context.country}, signs in {now.context.speed_unit}, the car shows {shown}"


def _share(value: float) -> str:
    """Rounded down: what is below a step must not read as if it had reached it."""
    return f"{floor(1000 * value) / 10:.1f}%"


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


def _lowest_kpa(now: Moment) -> float:
    return float(min(now.signals[tyre.path] for tyre in TYRES))


def _range_words(now: Moment) -> str:
    left_m = now.driving.ahead.route_left_m
    return f"{now.signals[ENERGY.RANGE.path] / 1000:.0f} km, {left_m / 1000:.1f} km to go"


def _open_parts(now: Moment) -> tuple[str, ...]:
    parts = {
        "trunk": now.signals[CABIN.TRUNK.path],
        "charging flap": now.signals[ENERGY.CHARGE_FLAP.path],
        "window": any(now.signals[part.path] > 0 for part in WINDOWS),
    }
    return tuple(name for name, is_open in parts.items() if is_open)


def _unwiped(now: Moment) -> float:
    """The film on the windshield while the wipers are off."""
    return 0.0 if now.signals[BODY.FRONT_WIPER.path] != "OFF" else float(now.signals[GLASS.WINDSHIELD_FILM.path])


def _ahead_m(away_m: float | None, *steps_m: float) -> Hashable:
    if away_m is None:
        return None
    return sum(away_m <= step for step in steps_m) or None


def _next_limit(now: Moment) -> Hashable:
    ahead = now.driving.ahead
    if ahead.next_limit is None or not ahead.next_limit.is_posted or ahead.next_limit.kmh is None:
        return None
    near = _ahead_m(ahead.next_limit_distance_m, TUNNEL_M, TUNNEL_M / 2)
    return None if near is None else (ahead.next_limit.kmh, near)


def _next_limit_words(now: Moment) -> str:
    ahead = now.driving.ahead
    kmh = None if ahead.next_limit is None else ahead.next_limit.kmh
    return f"{kmh or 0:.0f} km/h in {ahead.next_limit_distance_m or 0:.0f} m"


WAKES: tuple[Wake, ...] = (
    Wake(
        "limit",
        "the speed limit changes",
        _limit_kmh,
        lambda now: f"{_limit_kmh(now) or 0:.0f} km/h, the car drives {_kmh(now):.0f}",
    ),
    Wake("limit ahead", "another limit is posted within 500 m, and 250 m", _next_limit, _next_limit_words),
    Wake(
        "speed",
        "the car has been above the limit for three seconds, and each 10 % more",
        _too_fast,
        lambda now: f"{_kmh(now):.0f} km/h where {_limit_kmh(now) or 0:.0f} apply",
        hold_s=OVER_S,
    ),
    Wake(
        "vehicle ahead",
        "less than 2 s to the vehicle ahead, or under 8 s to collision, and 5 s",
        _leader,
        _leader_words,
        1.0,
    ),
    Wake(
        "behind",
        "a vehicle comes close from behind, or a blue light, and that within 150 m",
        _behind,
        _behind_words,
        1.0,
    ),
    Wake(
        "light",
        "day, twilight, night; into or out of a tunnel",
        lambda now: (now.context.sun and now.context.sun.darkness, now.driving.road.in_tunnel),
        lambda now: (
            "in a tunnel" if now.driving.road.in_tunnel else str(now.context.sun and now.context.sun.darkness)
        ),
    ),
    Wake("lamps", "a lamp goes on or off", _lamps, _lamp_words),
    Wake(
        "weather",
        "other weather, another class of visibility, frost",
        lambda now: (
            now.weather.weather_code,
            visibility_class(now.weather.visibility),
            now.weather.temperature_2m <= 4.0,
        ),
        lambda now: f"{weather_words(now.weather.weather_code)}, visibility {now.weather.visibility:.0f} m",
    ),
    Wake(
        "road",
        "another class of road, or a school zone",
        _road,
        lambda now: (
            (now.driving.road.road_class.replace("_", " ") or "road")
            + (", school zone" if now.driving.road.school_zone else "")
        ),
        hold_s=1.0,
    ),
    Wake(
        "tunnel",
        "a tunnel within 500 m, and 250 m",
        lambda now: _ahead_m(now.driving.ahead.tunnel_distance_m, TUNNEL_M, TUNNEL_M / 2),
        lambda now: f"in {now.driving.ahead.tunnel_distance_m or 0:.0f} m",
    ),
    _reported(SightKind.JAM, "a jam"),
    _reported(SightKind.BREAKDOWN, "a broken-down vehicle"),
    _reported(SightKind.ROADWORKS, "roadworks"),
    _reported(SightKind.CLOSURE, "a closed road"),
    _reported(SightKind.SCHOOL_ZONE, "a school zone"),
    Wake(
        "driving time",
        "an hour of driving without a break, and every quarter more",
        lambda now: None if (hours := _hours(now)) is None else int(hours * 4),
        lambda now: f"{_hours(now) or 0:.2f} h without a break",
    ),
    Wake(
        "belt",
        "the belt of a seat that is taken is opened, or the car sets off without it",
        lambda now: (_unbelted(now), _kmh(now) >= ROLLING_KMH) if _unbelted(now) else None,
        lambda now: f"open at {_kmh(now):.0f} km/h: {_who(_unbelted(now))}",
    ),
    Wake(
        "parked",
        "the driver parks the car on the way, leaves it, or comes back",
        lambda now: (_is_left(now), _others(now)) if now.signals[MOTION.GEAR.path] == "P" else None,
        lambda now: f"the driver {'has left' if _is_left(now) else 'is there'}, aboard: {_who(_others(now))}",
    ),
    Wake(
        "open",
        "a door, flap or window is open, or the car sets off with it",
        lambda now: (_open_parts(now), _kmh(now) >= ROLLING_KMH) if _open_parts(now) else None,
        lambda now: f"{', '.join(_open_parts(now))} at {_kmh(now):.0f} km/h",
    ),
    Wake(
        "tyre",
        "the lowest tyre, below 230 kPa, every 10 kPa",
        lambda now: _step(-_lowest_kpa(now), 10.0, -230.0),
        lambda now: f"lowest {floor(_lowest_kpa(now))} kPa",
    ),
    Wake(
        "range",
        "less than 5 km more than the route, and less than 2 km; the battery below 20 %",
        lambda now: (
            _ahead_m(now.signals[ENERGY.RANGE.path] - now.driving.ahead.route_left_m, 5000.0, 2000.0)
            or (now.signals[ENERGY.LEVEL.path] < 20.0 or None)
        ),
        _range_words,
    ),
    Wake(
        "glass",
        "the windshield fogs, every tenth",
        lambda now: _step(now.signals[GLASS.WINDSHIELD_FOG.path], MIST, MIST),
        lambda now: f"windshield fogged by {_share(now.signals[GLASS.WINDSHIELD_FOG.path])}",
    ),
    Wake(
        "rain",
        "rain on the windshield with the wipers off, every tenth",
        lambda now: _step(_unwiped(now), MIST, MIST),
        lambda now: f"windshield covered by {_share(_unwiped(now))}, wipers off",
    ),
    Wake(
        "phone",
        "the driver takes a phone, in the hand or in its cradle, or sets off with it",
        lambda now: (
            None if (where := now.signals[CALL.PHONE.path]) == "AWAY" else (where, _kmh(now) >= ROLLING_KMH)
        ),
        lambda now: (
            f"in the {'hand' if now.signals[CALL.PHONE.path] == 'HAND' else 'cradle'} at {_kmh(now):.0f} km/h"
        ),
    ),
    Wake("place", "another country", lambda now: now.context.country or None, _place_words),
    Wake("call", "the phone rings", lambda now: now.signals[CALL.RINGING.path] or None, lambda now: "ringing"),
    Wake(
        "message",
        "a message arrives",
        lambda now: now.signals[CALL.UNREAD.path] or None,
        lambda now: f"{now.signals[CALL.UNREAD.path]:.0f} unread",
    ),
)
"""Everything that wakes."""


@dataclass(frozen=True, slots=True)
class Noticed:
    """One change that an agent is told of."""

    words: str
    wakes: bool
    """Whether it ends a wait; what is over is only told with the next observation."""


@dataclass(slots=True)
class _Told:
    reading: Hashable = None
    differs_since_s: float | None = None
    """Since when the reading has been another; None while it is this one."""


@dataclass(slots=True)
class Alarm:
    """Watches one drive for what wakes."""

    wakes: tuple[Wake, ...] = WAKES
    _told: dict[str, _Told] = field(default_factory=dict)

    def see(self, now: Moment) -> tuple[Noticed, ...]:
        """What has changed at the newest moment. At the first, whatever there is to report."""
        found = []
        for wake in self.wakes:
            reading = wake.reads(now)
            told = self._told.setdefault(wake.name, _Told())
            if reading == told.reading:
                told.differs_since_s = None
                continue
            if told.differs_since_s is None:
                told.differs_since_s = now.time_s
            if now.time_s - told.differs_since_s >= wake.hold_s:
                told.reading, told.differs_since_s = reading, None
                found.append(
                    Noticed(f"{wake.name}: over", wakes=False)
                    if reading is None
                    else Noticed(f"{wake.name}: {wake.words(now)}", wakes=True)
                )
        return tuple(found)
