"""What the rule-perfect watcher looks at: from what it has read to what the driver ought to be told.

Each look knows the rules of some kinds of events, and the times for which they must hold.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from automotive_cosim.contracts import AlertKind
from automotive_cosim.drives.changes import CLOSE_S, DUE_S, OVER_S
from automotive_cosim.drives.margins import BORDER_S, LAMP_S, gaze_s, hold_s, margin_kmh
from automotive_cosim.drives.reading import Gathered

LOOK_S = 2
"""How often the watcher looks again while something nears a threshold."""
LOOKS_AHEAD_M, LOOKS_AHEAD_S = 400.0, 20.0
"""What is ahead is watched from this distance, or from so long before it is due."""
LOW_KPA = 240.0
SLOW_KMH = 20.0
"""Nothing is said of speed below it, as with intelligent speed assistance."""
SIGNS_M = 500.0
"""Limits that are signed further ahead oblige to nothing yet."""
FASTEST_KMH = 130.0
"""What a driver may come to drive where no limit is known."""
ICY = 0.5
"""Below this grip a road is as slippery as with snow."""
REACTION_S = 1.1
"""Mean time from a warning to the brake."""


@dataclass(frozen=True, slots=True)
class Concern:
    """Something that the driver ought to be told."""

    key: str
    alert: AlertKind | None = None
    now: bool = True
    """False while it only has to be watched."""
    hold_s: float = 0.0
    """How long it must last."""
    say: str = ""
    """Words instead of an alert."""
    is_there: bool = False
    """Whether it is the same concern already while it only has to be watched, such as a jam that comes nearer."""
    due: bool = True
    """False while it is told ahead of the instant at which the driver has to be told."""
    lasted_s: float = 0.0
    """How long it has lasted for certain when it is seen first."""


# --- speed -----------------------------------------------------------------------------------------------------


def _over(known: Gathered, key: str, alert: AlertKind, limit_kmh: float, for_s: float | None = None) -> Concern:
    """A limit that the car may be above: for certain, beyond the error limit of speed meters."""
    kmh = known.speed_kmh
    now = kmh >= SLOW_KMH and kmh > limit_kmh + margin_kmh(limit_kmh)
    return Concern(
        f"{key} {limit_kmh:.0f}",
        alert,
        now,
        hold_s(kmh / limit_kmh) if for_s is None else for_s,
        lasted_s=OVER_S if "speed" in known.changed else 0.0,
    )


def _speed(known: Gathered) -> Iterator[Concern]:
    """The binding limit, with those that weather lowers; nothing wakes for these, so they are watched when slow."""
    limit_kmh, reduced_kmh = known.limit_kmh, _reduced_kmh(known)
    if reduced_kmh is not None and (limit_kmh is None or reduced_kmh < limit_kmh):
        yield _over(known, "weather", AlertKind.SPEED, reduced_kmh)
        return
    school = "school zone" in known.road and known.hours_kmh is not None and known.hours_kmh == limit_kmh
    if limit_kmh is not None and known.speed_kmh >= SLOW_KMH and known.speed_kmh > limit_kmh + 1:
        alert, for_s = (AlertKind.SCHOOL, 3.0) if school else (AlertKind.SPEED, hold_s(known.speed_kmh / limit_kmh))
        yield _over(known, alert, alert, limit_kmh, for_s)
    fastest_mps = max(known.mps, (FASTEST_KMH if limit_kmh is None else limit_kmh) / 3.6)
    if not known.in_tunnel and _stopping_m(known, fastest_mps) > known.visibility_m:
        too_fast = known.speed_kmh >= SLOW_KMH and _stopping_m(known, known.mps) > known.visibility_m
        yield Concern("sight", AlertKind.VISIBILITY, too_fast, 3.0)


def _stopping_m(known: Gathered, mps: float) -> float:
    """The distance to stop from a speed, with reaction, on the grip that the weather leaves."""
    return mps * REACTION_S + mps**2 / (2 * max(known.grip, 0.1) * 9.81)


def _reduced_kmh(known: Gathered) -> float | None:
    """The lowest limit that weather brings into force here, of those that the context states for certain."""
    found = [
        line.kmh for line in known.reduced if line.kmh is not None and line.is_verified and _holds(line.text, known)
    ]
    return min(found, default=None)


def _holds(text: str, known: Gathered) -> bool:
    motorway = "motorway" in known.road and "outside" in known.road
    if "on motorways" in text and not motorway:
        return False
    if "dual carriageway" in text:
        return False
    if "two or more lanes" in text and not (re.search(r"[2-9] lanes", known.road) and "outside" in known.road):
        return False
    sight = re.search(r"visibility under (\d+) m", text)
    if sight is not None:
        return known.visibility_m < float(sight[1])
    return "rain or other precipitation" in text and "precipitation" in known.phenomena


def _limit_ahead(known: Gathered) -> Iterator[Concern]:
    """A lower limit ahead; it is watched however slow the car is, since it may speed up before the sign."""
    away_m, words = known.away_m("limit ahead"), known.words("limit ahead")
    found = re.match(r"(\d+) km/h", words)
    if away_m is None or found is None or away_m > SIGNS_M:
        return
    limit_kmh = float(found[1])
    here = [each for each in (known.limit_kmh, _reduced_kmh(known)) if each is not None]
    if here and limit_kmh > min(here) - 9:
        return
    right_kmh = limit_kmh + margin_kmh(limit_kmh)
    right_mps = right_kmh / 3.6
    coasting_m = (known.mps**2 - right_mps**2) / 2 + known.mps * (REACTION_S + LOOK_S)
    too_fast = known.speed_kmh >= SLOW_KMH and known.speed_kmh > right_kmh + 1
    yield Concern(f"falls {limit_kmh:.0f}", AlertKind.SPEED, too_fast and away_m <= coasting_m, is_there=True)


# --- lamps -----------------------------------------------------------------------------------------------------


def fog_lamps_lit(known: Gathered) -> Iterator[str]:
    """The fog lamps that are on, by the label of their rule."""
    if known.vehicle.is_front_fog_on:
        yield "Front fog lamps"
    if known.vehicle.is_rear_fog_on:
        yield "Rear fog lamp"


def _lamps(known: Gathered) -> Iterator[Concern]:
    """Lamps that are missing, or on where they dazzle; at a standstill they are watched, since nothing wakes
    when the car moves off."""
    car, moves = known.vehicle, known.speed_kmh >= 1
    if not (car.is_low_beam_on or car.is_high_beam_on):
        dark = known.in_tunnel or (known.sun_deg is not None and known.sun_deg <= -6)
        if dark or _needs_lamps(known):
            yield Concern("lamps", AlertKind.VISIBILITY, moves, LAMP_S)
        away_m = known.away_m("tunnel")
        if away_m is not None and _nears(known, "tunnel", away_m):
            near = moves and away_m <= known.mps * (10 + LOOK_S)
            yield Concern("tunnel", AlertKind.TUNNEL, near, is_there=moves, due=away_m <= known.mps * 10)
    if car.is_high_beam_on:
        near = car.leader_gap_m is not None and car.leader_gap_m <= 100
        yield Concern("high beam", AlertKind.VISIBILITY, moves and (near or _forbids_high_beam(known)), LAMP_S)
    for label in fog_lamps_lit(known):
        yield Concern(label, AlertKind.VISIBILITY, moves and _forbids_fog_lamp(known, label), LAMP_S)


def _needs_lamps(known: Gathered) -> bool:
    line = known.law.get("Dipped beam")
    if line is None or not line.is_verified:
        return False
    if known.sun_deg is not None and known.sun_deg < 0 and "dark" in line.text:
        return True
    return "required" in line.text and any(
        word in line.text and word in known.phenomena for word in ("fog", "snow", "heavy rain")
    )


def _forbids_high_beam(known: Gathered) -> bool:
    line = known.law.get("High beam")
    if line is None or not line.is_verified:
        return False
    lit = any(word in line.text for word in ("lighting", "where lit")) and ", lit" in known.road
    town = "built-up areas" in line.text and ", built-up" in known.road
    return lit or town


def _forbids_fog_lamp(known: Gathered, label: str) -> bool:
    line = known.law.get(label)
    if line is None or not line.is_verified or "allowed" not in line.text:
        return False
    sight = re.search(r"visibility under (\d+) m|under (\d+) m", line.text)
    if sight is not None and known.visibility_m >= float(sight[1] or sight[2]):
        return True
    words = {word for word in ("fog", "snow", "heavy rain") if word in line.text}
    if "not in rain" in line.text:
        words.discard("heavy rain")
    return bool(words) and not words & known.phenomena


# --- weather ---------------------------------------------------------------------------------------------------


def _weather(known: Gathered) -> Iterator[Concern]:
    moves = known.speed_kmh >= 1
    if known.grip < ICY + 0.2 and known.speed_kmh >= 20:
        is_icy = known.grip < ICY
        yield Concern("slippery", AlertKind.SLIPPERY, is_icy and known.speed_kmh > 40, 5.0, is_there=is_icy)
    for name in ("glass", "rain"):
        share = re.search(r"(\d+\.\d)%", known.words(name))
        if share is not None:
            yield Concern(name, AlertKind.VISIBILITY, moves and float(share[1]) >= 20, 3.0)


# --- the road --------------------------------------------------------------------------------------------------


def _traffic(known: Gathered) -> Iterator[Concern]:
    away_m = known.away_m("jam")
    if away_m is not None and _nears(known, "jam", away_m):
        near = known.speed_kmh >= 40 and away_m <= known.mps * (15 + LOOK_S)
        yield Concern("jam", AlertKind.TRAFFIC, near, is_there=True, due=away_m <= known.mps * 15)
    for name, alert in (("breakdown", AlertKind.MOVE_OVER), ("roadworks", AlertKind.TRAFFIC)):
        away_m = known.away_m(name)
        if away_m is not None and _nears(known, name, away_m):
            near = known.mps > 5 and away_m <= known.mps * (12 + LOOK_S)
            yield Concern(name, alert, near, is_there=True, due=away_m <= known.mps * 12)
    blue = re.match(r"blue light (\d+) m", known.words("behind"))
    if blue is not None:
        yield Concern("blue light", AlertKind.YIELD, float(blue[1]) <= 150, 1.0)
    gap_m, ttc_s = known.vehicle.leader_gap_m, known.vehicle.leader_time_to_collision_s
    if gap_m is None:
        return
    if known.mps > 1:
        line = known.law.get("Following distance")
        lawful = re.match(r"(\d+) s or more", line.text) if line is not None and line.is_verified else None
        least_s = 1.0 if lawful is None else float(lawful[1])
        gap_s = gap_m / known.mps
        if gap_s < max(least_s + 0.5, CLOSE_S):
            yield Concern("distance", AlertKind.DISTANCE, known.speed_kmh >= 30 and gap_s < least_s, 3.0)
    if ttc_s is None or ttc_s <= 0:
        return
    closing_mps = gap_m / ttc_s
    if closing_mps**2 / (2 * max(gap_m, 0.1)) >= 1.0:
        yield Concern("collision", AlertKind.COLLISION, closing_mps**2 / (2 * max(gap_m, 0.1)) >= 3.4)
    leader_kmh = known.speed_kmh - closing_mps * 3.6
    if 8 <= leader_kmh <= 40 and closing_mps >= 3 and (known.likely_kmh or 0) >= 65:
        yield Concern("slow vehicle", AlertKind.TRAFFIC, gap_m <= (8 + LOOK_S) * closing_mps)


def _nears(known: Gathered, name: str, away_m: float) -> bool:
    """Whether something ahead is near enough to look again and again; before that, it wakes."""
    return away_m <= max(LOOKS_AHEAD_M, known.mps * (DUE_S[name] + LOOKS_AHEAD_S))


# --- the car and its driver ------------------------------------------------------------------------------------


def _car(known: Gathered) -> Iterator[Concern]:
    for seat in re.findall(r"([a-z ]+): (?:adult|elderly|child|baby), [^;]*not belted", known.vehicle.aboard):
        yield Concern(f"belt {seat}", AlertKind.SEAT_BELT, known.speed_kmh >= 25, 2.0, is_there=True)
    parked = known.words("parked")
    if "has left" in parked and re.search(r"child|baby|pet", parked) and not re.search(r"adult|elderly", parked):
        yield Concern("left behind", AlertKind.VEHICLE, hold_s=15.0)
    for part in ("trunk", "charging flap"):
        if part in known.words("open"):
            yield Concern(part, AlertKind.VEHICLE, known.speed_kmh >= 5, 2.0)
    pressures = [float(kpa) for kpa in re.findall(r"(?:left|right) (\d+)", known.words("tyres"))]
    if pressures and min(pressures) < LOW_KPA:
        yield Concern("tyre", AlertKind.VEHICLE, min(pressures) < 200, 5.0)
    if "hand" in known.words("phone"):
        yield Concern("phone", AlertKind.DISTRACTION, known.speed_kmh >= 20, gaze_s(known.speed_kmh))
    hours = re.match(r"(\d+\.\d+) h", known.words("driving time"))
    if hours is not None:
        yield Concern("fatigue", AlertKind.FATIGUE, float(hours[1]) >= 2, 5.0)
    if (left_km := known.left_km) is not None:
        yield Concern("range", AlertKind.VEHICLE, known.vehicle.range_km < left_km + 2, 5.0)


# --- borders ---------------------------------------------------------------------------------------------------

LAWS = ("Dipped beam", "Daytime lamps", "Horn", "Phone in hand")
"""What a driver must know at once in another country, by the labels of the context."""


def _border(known: Gathered) -> Iterator[Concern]:
    border = known.border
    if border is None or known.time_s - border.at_s > BORDER_S:
        return
    units = re.search(r"signs in (\S+), the car shows (\S+)", known.words("place"))
    if units is not None and units[1] != units[2]:
        yield Concern("units", hold_s=2.0, say=f"Speed signs are in {units[1]} here; the car shows {units[2]}")
    law = [(label, known.law[label]) for label in LAWS if label in known.law]
    new = [label.lower() for label, line in law if line.is_verified and line.said not in border.before]
    if border.is_new and new:
        yield Concern("law", hold_s=2.0, say=f"Another law here on {', '.join(new)}")


LOOKS: tuple[Callable[[Gathered], Iterator[Concern]], ...] = (
    _traffic,
    _speed,
    _limit_ahead,
    _lamps,
    _weather,
    _car,
    _border,
)
"""Everything that it looks at, the most urgent first."""
