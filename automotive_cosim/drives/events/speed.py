"""Events of speed: over the limit, a limit that falls, a school zone, weather that lowers what is lawful."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from automotive_cosim.cockpit.sensor_range import HORIZON_M
from automotive_cosim.cockpit.signals import ADAS
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    MPH_PER_MPS,
    AlertKind,
    Cruise,
    LimitSource,
    PullOver,
    SightKind,
    SlowDown,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import DriveAct, EventKind, Measured, Sighting
from automotive_cosim.drives.events.law import (
    REACTION_S,
    SLOW_KMH,
    is_reduced,
    limit_here,
    speed_kmh,
    time_left_s,
)
from automotive_cosim.drives.margins import hold_s, margin_kmh
from automotive_cosim.geo.binding import SIGN
from automotive_cosim.geo.weather import phenomena
from automotive_cosim.traffic.posted_limits import OF_OTHERS

FOG_M = 1000.0
"""Sight below which there is fog (WMO No. 8)."""
AHEAD_M = 500.0
"""How far ahead the navigation announces a limit: the horizon that ADASIS-based map systems send at least."""
COASTING_MPS2 = 1.0
"""Deceleration of a car that coasts in gear: a driver who lifts the foot now just arrives at the new limit."""
CRAWL_SHARE = 0.6
"""A request for a smaller share of the right speed asks for crawling, not for keeping it; our choice."""
KEEPERS = frozenset({ADAS.CRUISE_SPEED.path, ADAS.LIMITER_SPEED.path})
SWITCHES = frozenset({ADAS.CRUISE_ACTIVE.path, ADAS.LIMITER_ACTIVE.path})


class SpeedKind(EventKind):
    """An event that a lower speed settles; its value is the highest right speed in km/h."""

    def settles(self, act: DriveAct, value: float | None) -> bool:
        """An alert that advises no more than the right speed, a request for it, or a limiter set to it."""
        most_kmh = 1000.0 if value is None else value + 1.0
        if act.alert is not None:
            return act.alert in self.alerts and (act.speed_kmh is None or act.speed_kmh <= most_kmh)
        for request in act.requests:
            if isinstance(request, PullOver):
                return False
            if isinstance(request, SlowDown | Cruise) and request.speed_kmh is not None:
                return CRAWL_SHARE * (value or 0.0) <= request.speed_kmh <= most_kmh
        return any(
            (path in KEEPERS and isinstance(written, float) and written <= most_kmh)
            or (path in SWITCHES and written is True)
            for path, written in act.writes
        )

    def concerns(self, act: DriveAct) -> bool:
        """Whether it touches what keeps the speed."""
        return any(path in KEEPERS | SWITCHES for path, _ in act.writes)


class OverLimit(SpeedKind):
    """Faster than the sign or the law of the road allows."""

    told_by = ("speed", "limit")
    name = "over_limit"
    about = "the car is faster than the sign or the law of the road allows"
    lookalike = (
        "a little above the limit, within the error limit of speed meters: 52 in a 50; or above one that a plate "
        "keeps for others"
    )
    source = "Regulation (EU) 2021/1958, annex I: the tone after 3 to 6 s by ratio; deadline: the tone's 5 s twice"
    neutral = "below 20 km/h, by a rule that is not verified, or where no limit is known"
    grace_s = 10.0
    alerts = frozenset({AlertKind.SPEED})

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Sights a speed from 1 km/h above the limit."""
        now = drive[-1]
        limit, kmh = limit_here(now), speed_kmh(now)
        yield from _of_others(now)
        if limit is None or kmh < SLOW_KMH or is_school_time(now) or is_reduced(now.context, limit):
            return
        why = f" {limit.text}" if limit.limit.source in (LimitSource.LAW, LimitSource.VARIABLE) else ""
        road = now.driving.road
        why = " posted over this lane" if road.lane_alone else why
        why += f", by a plate: {road.limit_hours}" if road.limit_by_clock and limit.rule == SIGN else ""
        yield from _over(kmh, limit.kmh, f"{kmh:.0f} km/h where {limit.kmh:.0f} apply{why}")

    def against(self, drive: Sequence[Moment]) -> str | None:
        """A limit, by whatever rule, that the car keeps."""
        now = drive[-1]
        limit, kmh = now.context.binding_limit, speed_kmh(now)
        if limit is None:
            is_lifted = now.driving.road.limit.is_posted
            return f"{kmh:.0f} km/h where no limit applies" if is_lifted else None
        return None if kmh > limit.kmh + margin_kmh(limit.kmh) else _kept(kmh, limit.kmh)


_PLATE = re.compile(rf"([\d.]+) (km/h|mph) ({'|'.join(OF_OTHERS.values())})")


def _of_others(now: Moment) -> Iterator[Sighting]:
    """The look-alikes of lower limits whose plates are not for the car."""
    kmh = speed_kmh(now)
    for figure, unit, whom in _PLATE.findall(now.driving.road.limit_hours):
        value = float(figure) * KMH_PER_MPS / (MPH_PER_MPS if unit == "mph" else KMH_PER_MPS)
        if kmh > value + margin_kmh(value):
            yield Sighting(f"{kmh:.0f} km/h where {figure} {unit} apply {whom}", whom, lookalike=True, value=value)


SAME_KMH, HAZE_M = 5.0, 2000.0
"""As fast as a lower limit ahead, and the sight in haze: nearer than these, a careful driver may speak of it."""


def _kept(kmh: float, limit_kmh: float) -> str:
    words = f"{kmh:.0f} km/h where {limit_kmh:.0f} apply, within {margin_kmh(limit_kmh):.0f} km/h"
    return Measured(words) if kmh > limit_kmh else words


def _over(kmh: float, limit_kmh: float, words: str) -> Iterator[Sighting]:
    """The sighting of a speed above a limit: a look-alike within the margin, due above it."""
    excess_kmh = kmh - limit_kmh
    if excess_kmh <= 1.0:
        return
    subject = f"{limit_kmh:.0f}"
    if excess_kmh <= margin_kmh(limit_kmh):
        yield Sighting(words, subject, lookalike=True, value=limit_kmh)
        return
    hold = hold_s(kmh / limit_kmh)
    severity = max(1.0, excess_kmh / 10)
    yield Sighting(words, subject, due=True, hold_s=hold, severity=severity, value=limit_kmh)


class LimitFalls(SpeedKind):
    """A lower limit ahead that the car approaches too fast to coast down to."""

    told_by = ("limit ahead", "speed")
    name = "limit_falls"
    about = "the limit falls ahead, and the car no longer gets down to it by coasting"
    lookalike = "a lower limit ahead that the car already keeps"
    source = "coasting 1 m/s2; deadline: reaction 1.1 s and braking at 3.4 m/s2 (AASHTO) end at the sign"
    neutral = "a lower limit within 2 km, which the car does not keep yet"
    weight = 0.5
    eases = True
    alerts = frozenset({AlertKind.SPEED, AlertKind.SCHOOL})

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Sights posted limits within the map's horizon, and the sign that the car has just passed."""
        now = drive[-1]
        yield from _kept_at_the_sign(drive)
        ahead, here, kmh = now.driving.ahead, limit_here(now), speed_kmh(now)
        following, away_m = ahead.next_limit, ahead.next_limit_distance_m
        if following is None or away_m is None or away_m > AHEAD_M or kmh < SLOW_KMH:
            return
        if not following.is_posted or following.kmh is None or following.mps is None:
            return
        if here is not None and following.kmh > here.kmh - 9.0:
            return
        words, subject = f"{following.kmh:.0f} km/h in {away_m:.0f} m at {kmh:.0f} km/h", f"{following.kmh:.0f}"
        if following.source is LimitSource.VARIABLE:
            words += ", by a variable sign"
        right_mps = following.mps + margin_kmh(following.kmh) / 3.6
        mps = now.driving.speed_mps
        if mps <= right_mps:
            yield Sighting(words, subject, lookalike=True, value=following.kmh)
            return
        coasting_m = (mps**2 - right_mps**2) / (2 * COASTING_MPS2) + mps * REACTION_S
        left_s = time_left_s(away_m, mps, right_mps)
        yield Sighting(words, subject, due=away_m <= coasting_m, left_s=left_s, value=following.kmh)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No lower limit on the map's horizon, or one that the car keeps already."""
        now = drive[-1]
        ahead, kmh = now.driving.ahead, speed_kmh(now)
        following, away_m = ahead.next_limit, ahead.next_limit_distance_m
        if following is None or away_m is None or away_m > HORIZON_M or not following.is_posted:
            return "no other limit is signed within 2 km"
        if following.kmh is None:
            return f"the limit ends in {away_m:.0f} m"
        if kmh > following.kmh + margin_kmh(following.kmh):
            return None
        words = f"{kmh:.0f} km/h, and {following.kmh:.0f} apply in {away_m:.0f} m"
        return Measured(words) if kmh > following.kmh - SAME_KMH else words


def _kept_at_the_sign(drive: Sequence[Moment]) -> Iterator[Sighting]:
    """The look-alike of a lower limit that the car keeps at the first moment at which it binds."""
    if len(drive) < 2:
        return
    here, mps = drive[-1].driving.road.limit, drive[-1].driving.speed_mps
    ahead, old = drive[-2].driving.ahead.next_limit, limit_here(drive[-2])
    if ahead is None or ahead.kmh is None or here != ahead or (old is not None and ahead.kmh > old.kmh - 9.0):
        return
    if mps <= (ahead.kmh + margin_kmh(ahead.kmh)) / KMH_PER_MPS:
        kmh = mps * KMH_PER_MPS
        yield Sighting(f"{kmh:.0f} km/h at the sign", f"{ahead.kmh:.0f}", lookalike=True, value=ahead.kmh)


def is_school_time(moment: Moment) -> bool:
    """Whether the car is in a school zone whose hours are on."""
    road = moment.driving.road
    return road.school_zone and road.limit_by_clock and road.limit.posted_mps is not None


class SchoolHours(SpeedKind):
    """Too fast in a school zone at its hours."""

    told_by = ("road", "school zone", "speed")
    name = "school_zone"
    about = "the car is in a school zone at its hours, faster than its sign"
    lookalike = "a school zone outside its hours, or a little above its sign"
    source = "Regulation (EU) 2021/1958, annex I, the tone after 3 s; deadline: 8 s, 100 m at 50 km/h"
    neutral = "a zone ahead on the route"
    weight = 2.0
    grace_s = 8.0
    alerts = frozenset({AlertKind.SCHOOL, AlertKind.SPEED})

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Sights a moving car in a school zone."""
        now = drive[-1]
        road, kmh = now.driving.road, speed_kmh(now)
        if not road.school_zone or kmh < SLOW_KMH:
            return
        limit_kmh = road.limit.kmh
        if not is_school_time(now) or limit_kmh is None:
            if road.limit_hours:
                yield Sighting("a school zone outside its hours", road.name, lookalike=True, value=limit_kmh)
            return
        if 1.0 < kmh - limit_kmh <= margin_kmh(limit_kmh):
            yield Sighting(
                f"{kmh:.0f} km/h in a school zone of {limit_kmh:.0f}", road.name, lookalike=True, value=limit_kmh
            )
            return
        over_kmh = kmh - limit_kmh - margin_kmh(limit_kmh)
        yield Sighting(
            f"{kmh:.0f} km/h in a school zone of {limit_kmh:.0f}",
            road.name,
            due=over_kmh > 0,
            hold_s=3.0,
            severity=max(1.0, over_kmh / 10),
            value=limit_kmh,
        )

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No zone, a zone outside its hours, or one whose sign the car keeps."""
        now = drive[-1]
        road, kmh = now.driving.road, speed_kmh(now)
        if not road.school_zone:
            return None if now.sight(SightKind.SCHOOL_ZONE) is not None else "no school zone within 2 km"
        if not is_school_time(now) or road.limit.kmh is None:
            return f"the zone's limit applies at other hours: {road.limit_hours}" if road.limit_hours else None
        over = kmh > road.limit.kmh + margin_kmh(road.limit.kmh)
        return None if over else _kept(kmh, road.limit.kmh)


class WeatherSpeed(SpeedKind):
    """Faster than weather or sight allows."""

    told_by = ("weather", "grip", "speed")
    name = "weather_speed"
    about = "rain, fog or snow lowers the limit by law, or the car cannot stop within what its driver sees"
    lookalike = "a road whose limit is lower in rain or fog, in dry clear weather"
    source = "the law of the place; Vienna Convention, art. 13; times as over the limit"
    neutral = "fog, of less than a kilometre of sight; a lower limit in this weather by a rule that is not verified"
    weight = 1.5
    grace_s = 10.0
    alerts = frozenset({AlertKind.SPEED, AlertKind.VISIBILITY, AlertKind.WEATHER, AlertKind.SLIPPERY})

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Asks the law first, then the stopping distance."""
        now = drive[-1]
        context, kmh, limit = now.context, speed_kmh(now), limit_here(now)
        if kmh < SLOW_KMH:
            return
        if limit is not None and is_reduced(context, limit):
            words = f"{kmh:.0f} km/h where {limit.kmh:.0f} apply {limit.text}"
            words += ", as it snows" if "snow" in phenomena(now.weather) else ""
            over = [sighting for sighting in _over(kmh, limit.kmh, words) if not sighting.lookalike]
            if over:  # else one may still see too little to stop
                yield from over
                return
        stopping_m = _stopping_m(now)
        if not now.driving.road.in_tunnel and stopping_m > now.weather.visibility:
            words = f"needs {stopping_m:.0f} m to stop and sees {now.weather.visibility:.0f} m"
            yield Sighting(words, "sight", due=True, hold_s=3.0, severity=FOG_M / now.weather.visibility)
            return
        for reduced in context.reduced_limits:
            value = reduced.rule.cases[0].value
            if reduced.value is None and isinstance(value, float) and kmh > value + margin_kmh(value):
                yield Sighting(f"{reduced.rule.text}, which it is not", lookalike=True, value=value)
                return

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Sight enough to stop, and no lower limit in this weather that the car exceeds."""
        now = drive[-1]
        kmh, sight_m = speed_kmh(now), now.weather.visibility
        for reduced in now.context.reduced_limits:
            value = reduced.rule.cases[0].value
            applies = reduced.value is not None or now.weather.precipitation > 0
            if applies and isinstance(value, float) and kmh > value + margin_kmh(value):
                return None
        if sight_m < FOG_M and not now.driving.road.in_tunnel:
            return None
        words = f"the car stops within {_stopping_m(now):.0f} m, and its driver sees {sight_m:.0f} m"
        return Measured(words) if sight_m < HAZE_M or now.weather.precipitation > 0 else words


def _stopping_m(now: Moment) -> float:
    """The distance to stop, with the driver's reaction."""
    mps, friction = now.driving.speed_mps, max(now.driving.road.friction, 0.1)
    return mps * REACTION_S + mps**2 / (2 * friction * 9.81)
