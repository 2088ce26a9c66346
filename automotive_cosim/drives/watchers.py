"""Watchers: the rule-perfect one, which shows what an agent could do, and trivial ones, which must fail."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from automotive_cosim.contracts import Action, ActionType, AlertKind, Observation
from automotive_cosim.drives.reading import Gathered, read
from automotive_cosim.interface.observe import Channel

READS = frozenset({Channel.VEHICLE, Channel.CONTEXT})
LOOK_S = 2
"""How often it looks again while something nears a threshold."""
GONE_S = 31.0
"""A concern that was away for longer is another one."""


@dataclass(frozen=True, slots=True)
class Concern:
    """Something that the driver ought to be told."""

    key: str
    alert: AlertKind
    now: bool = True
    """False while it only has to be watched."""
    is_there: bool = False
    """Whether it is the same concern already while it only has to be watched, such as a jam that comes nearer."""


class RulePerfect:
    """Knows the rules of every kind of event, and reads only what an agent may observe."""

    name = "rule-perfect"
    model = "none"
    channels: frozenset[Channel] = READS

    def __init__(self, delay_s: float = 0.0) -> None:
        """A watcher that tells each concern that many seconds after it has seen it."""
        self._delay_s = delay_s
        self.reset("")

    def reset(self, goal: str) -> None:
        """Forgets the previous drive."""
        self._changes: dict[str, tuple[float, str]] = {}
        self._seen: dict[str, float] = {}
        self._since: dict[str, float] = {}
        self._told: set[str] = set()

    def act(self, observation: Observation) -> Action:
        """An alert of what has not been told yet, else a wait."""
        known = read(observation, self._changes)
        if known is None:
            return Action(ActionType.WAIT)
        concerns = [concern for look in LOOKS for concern in look(known)]
        for concern in concerns:
            if concern.now or concern.is_there:
                self._note(concern, known.time_s)
            if concern.now and self._is_time(concern, known.time_s):
                self._told.add(concern.key)
                return Action(ActionType.SHOW_ALERT, kind=concern.alert)
        return Action(ActionType.WAIT, seconds=LOOK_S) if concerns else Action(ActionType.WAIT)

    def _note(self, concern: Concern, now_s: float) -> None:
        """One that was away for long is another concern."""
        key = concern.key
        if now_s - self._seen.get(key, -GONE_S) >= GONE_S:
            self._told.discard(key)
            self._since.pop(key, None)
        self._seen[key] = now_s
        if concern.now:
            self._since.setdefault(key, now_s)

    def _is_time(self, concern: Concern, now_s: float) -> bool:
        return concern.key not in self._told and now_s - self._since[concern.key] >= self._delay_s


# --- what it looks at ---------------------------------------------------------------------------------------

MARGIN_KMH, MARGIN_SHARE = 3.0, 0.03


def _above(limit_kmh: float) -> float:
    """The speed from which a limit is exceeded for certain."""
    return limit_kmh + max(MARGIN_KMH, MARGIN_SHARE * limit_kmh)


def _speed(known: Gathered) -> Iterator[Concern]:
    """The binding limit, with those that weather lowers."""
    limit_kmh, reduced_kmh = known.limit_kmh, _reduced_kmh(known)
    if known.speed_kmh < 20:
        return
    if reduced_kmh is not None and (limit_kmh is None or reduced_kmh < limit_kmh):
        if known.speed_kmh > reduced_kmh + 1:
            yield Concern(f"weather {reduced_kmh:.0f}", AlertKind.SPEED, known.speed_kmh > _above(reduced_kmh))
        return
    school = "school zone" in known.road and known.hours_kmh is not None and known.hours_kmh == limit_kmh
    if limit_kmh is not None and known.speed_kmh > limit_kmh + 1:
        alert = AlertKind.SCHOOL if school else AlertKind.SPEED
        yield Concern(f"{alert} {limit_kmh:.0f}", alert, known.speed_kmh > _above(limit_kmh))
    stopping_m = known.mps * 1.1 + known.mps**2 / (2 * _grip(known) * 9.81)
    if not known.in_tunnel and stopping_m > known.visibility_m:
        yield Concern("sight", AlertKind.VISIBILITY)


GRIPS = (("freezing", 0.15), ("rime", 0.15), ("heavy snow", 0.25), ("snow", 0.35), ("heavy rain", 0.7))
"""Friction by the words of the weather (Wallman and Astrom, VTI 911A, 2001), the worst first."""


def _grip(known: Gathered) -> float:
    """The friction that this weather leaves."""
    found = next((grip for words, grip in GRIPS if words in known.weather), None)
    if found is not None:
        return found
    return 0.75 if known.phenomena & {"precipitation"} else 1.0


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
    away_m, words = known.away_m("limit ahead"), known.changes.get("limit ahead", (0.0, ""))[1]
    found = re.match(r"(\d+) km/h", words)
    if away_m is None or found is None or known.speed_kmh < 20 or away_m < 0:
        return
    limit_kmh = float(found[1])
    here = [each for each in (known.limit_kmh, _reduced_kmh(known)) if each is not None]
    if here and limit_kmh > min(here) - 9:
        return
    if known.speed_kmh > _above(limit_kmh) + 1:
        right_mps = _above(limit_kmh) / 3.6
        coasting_m = (known.mps**2 - right_mps**2) / 2 + known.mps * (1.1 + LOOK_S)
        yield Concern(f"falls {limit_kmh:.0f}", AlertKind.SPEED, away_m <= coasting_m, is_there=True)


def _lamps(known: Gathered) -> Iterator[Concern]:
    car = known.vehicle
    if known.speed_kmh < 1:
        return
    if not (car.is_low_beam_on or car.is_high_beam_on):
        dark = known.in_tunnel or (known.sun_deg is not None and known.sun_deg <= -6)
        if dark or _needs_lamps(known):
            yield Concern("lamps", AlertKind.VISIBILITY)
        away_m = known.away_m("tunnel")
        if away_m is not None and away_m > 0:
            yield Concern("tunnel", AlertKind.TUNNEL, away_m <= known.mps * (10 + LOOK_S), is_there=True)
    if car.is_high_beam_on:
        near = car.leader_gap_m is not None and car.leader_gap_m <= 100
        yield Concern("high beam", AlertKind.VISIBILITY, near or _forbids_high_beam(known))
    for lit, label in ((car.is_front_fog_on, "Front fog lamps"), (car.is_rear_fog_on, "Rear fog lamp")):
        if lit:
            yield Concern(label, AlertKind.VISIBILITY, _forbids_fog_lamp(known, label))


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


def _weather(known: Gathered) -> Iterator[Concern]:
    if known.is_icy:
        yield Concern("slippery", AlertKind.SLIPPERY, known.speed_kmh > 40, is_there=True)
    share = re.search(r"(\d+\.\d)%", known.changes.get("glass", (0.0, ""))[1])
    if share is not None and known.speed_kmh >= 1:
        yield Concern("glass", AlertKind.VISIBILITY, float(share[1]) >= 20)
    share = re.search(r"(\d+\.\d)%", known.changes.get("rain", (0.0, ""))[1])
    if share is not None and known.speed_kmh >= 1:
        yield Concern("rain", AlertKind.VISIBILITY, float(share[1]) >= 20)


def _traffic(known: Gathered) -> Iterator[Concern]:
    away_m = known.away_m("jam")
    if away_m is not None and away_m > 0 and known.speed_kmh >= 40:
        yield Concern("jam", AlertKind.TRAFFIC, away_m <= known.mps * (15 + LOOK_S), is_there=True)
    for name, alert in (("breakdown", AlertKind.MOVE_OVER), ("roadworks", AlertKind.TRAFFIC)):
        away_m = known.away_m(name)
        if away_m is not None and away_m > 0 and known.mps > 5:
            yield Concern(name, alert, away_m <= known.mps * (12 + LOOK_S), is_there=True)
    if "blue light" in known.changes.get("behind", (0.0, ""))[1]:
        yield Concern("blue light", AlertKind.YIELD)
    gap_m, ttc_s = known.vehicle.leader_gap_m, known.vehicle.leader_time_to_collision_s
    if gap_m is None:
        return
    if known.speed_kmh >= 30:
        line = known.law.get("Following distance")
        lawful = re.match(r"(\d+) s or more", line.text) if line is not None and line.is_verified else None
        least_s = 1.0 if lawful is None else float(lawful[1])
        if gap_m / known.mps < least_s + 0.5:
            yield Concern("distance", AlertKind.DISTANCE, gap_m / known.mps < least_s)
    if ttc_s is None or ttc_s <= 0:
        return
    closing_mps = gap_m / ttc_s
    if closing_mps**2 / (2 * max(gap_m, 0.1)) >= 1.0:
        yield Concern("collision", AlertKind.COLLISION, closing_mps**2 / (2 * max(gap_m, 0.1)) >= 3.4)
    leader_kmh = known.speed_kmh - closing_mps * 3.6
    if 8 <= leader_kmh <= 40 and closing_mps >= 3 and (known.limit_kmh or 0) >= 65:
        yield Concern("slow vehicle", AlertKind.TRAFFIC, gap_m <= (8 + LOOK_S) * closing_mps)


def _car(known: Gathered) -> Iterator[Concern]:
    if "belt" in known.changes:
        yield Concern("belt", AlertKind.SEAT_BELT, known.speed_kmh >= 25, is_there=True)
    words = known.changes.get("open", (0.0, ""))[1]
    for part in ("trunk", "charging flap"):
        if part in words:
            yield Concern(part, AlertKind.VEHICLE, known.speed_kmh >= 5)
    pressure = re.search(r"(\d+) kPa", known.changes.get("tyre", (0.0, ""))[1])
    if pressure is not None:
        yield Concern("tyre", AlertKind.VEHICLE, float(pressure[1]) < 200)
    hours = re.match(r"(\d+\.\d+) h", known.changes.get("driving time", (0.0, ""))[1])
    if hours is not None:
        yield Concern("fatigue", AlertKind.FATIGUE, float(hours[1]) >= 2)
    left = re.search(r"(\d+) km, (\d+\.\d) km to go", known.changes.get("range", (0.0, ""))[1])
    if left is not None:
        yield Concern("range", AlertKind.VEHICLE, known.vehicle.range_km < float(left[2]) + 2)


LOOKS: tuple[Callable[[Gathered], Iterator[Concern]], ...] = (
    _traffic,
    _speed,
    _limit_ahead,
    _lamps,
    _weather,
    _car,
)
"""Everything that it looks at, the most urgent first."""


# --- watchers that must fail -----------------------------------------------------------------------------------


class Silent:
    """Waits, and does nothing."""

    name = "silent"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def reset(self, goal: str) -> None:
        """Does nothing."""

    def act(self, observation: Observation) -> Action:
        """Waits as long as it may."""
        return Action(ActionType.WAIT)


class AlertAll:
    """Gives every kind of alert in turn, one each ten seconds, whatever happens."""

    name = "alert-all"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self) -> None:
        self.reset("")

    def reset(self, goal: str) -> None:
        """Begins with the first kind."""
        self._turn = 0

    def act(self, observation: Observation) -> Action:
        """An alert, then a wait."""
        self._turn += 1
        if self._turn % 2:
            kinds = tuple(AlertKind)
            return Action(ActionType.SHOW_ALERT, kind=kinds[self._turn // 2 % len(kinds)])
        return Action(ActionType.WAIT, seconds=9)


class AlertOnWake:
    """Gives one kind of alert whenever something wakes it."""

    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self, kind: AlertKind = AlertKind.SPEED) -> None:
        """Of that kind: speed is the most frequent that is right."""
        self.name = "alert-on-wake"
        self._kind = kind
        self.reset("")

    def reset(self, goal: str) -> None:
        """Forgets the previous drive."""
        self._waited = False

    def act(self, observation: Observation) -> Action:
        """An alert if the wait was ended by something, else a wait."""
        woken = self._waited and "; " in observation.feedback.text
        self._waited = not woken
        return Action(ActionType.SHOW_ALERT, kind=self._kind) if woken else Action(ActionType.WAIT)


class AlertOften:
    """Gives the most frequent kind of alert twice a minute, whatever happens."""

    name = "alert-often"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self, kind: AlertKind = AlertKind.SPEED, every_s: float = 30.0) -> None:
        """Of that kind, that often."""
        self._kind, self._every_s = kind, every_s
        self.reset("")

    def reset(self, goal: str) -> None:
        """Begins with an alert."""
        self._next_s = 0.0

    def act(self, observation: Observation) -> Action:
        """The alert once it is time, else a short wait."""
        if observation.time_s >= self._next_s:
            self._next_s = observation.time_s + self._every_s
            return Action(ActionType.SHOW_ALERT, kind=self._kind)
        return Action(ActionType.WAIT, seconds=10)
