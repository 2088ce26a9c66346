"""Events on the road: tunnel, jam, what stands ahead, blue light, the vehicle ahead."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import takewhile
from typing import ClassVar

from automotive_cosim.cockpit.sensor_range import BLUE_LIGHT_M, HORIZON_M, RADAR_M
from automotive_cosim.cockpit.signals import ADAS, LIGHTS
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    AlertKind,
    IncidentKind,
    PullOver,
    Reroute,
    SightKind,
    SlowDown,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.changes import in_sight
from automotive_cosim.drives.driver import IN_FORCE_S, SETS_OFF, STOPS
from automotive_cosim.drives.events.base import EventKind, Measured, Sighting, Wanted, on
from automotive_cosim.drives.events.law import REACTION_S, certain, may_say, speed_kmh, time_left_s
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS
from automotive_cosim.traffic.ego import EASING_MPS2

NEAR_M = 500.0
"""A tunnel is announced on the map from this distance."""
PORTAL_S = 10.0
JAM_M = 1500.0
JAM_FROM_KMH = 40.0
JAM_DUE_S = 15.0
"""A queue's tail is announced 300 to 400 m ahead at 80 km/h by warning vehicles and gantries."""
BLUE_DUE_M = 150.0
STANDS_DUE_S = 12.0
"""A warning triangle stands 100 m and more before a stopped vehicle outside towns: 4.5 s at 80 km/h; warnings on
the screen come before it."""
STANDS_FROM_MPS = 5.0
"""Slower than this nothing is due for it."""
PASS_SHARE = 0.6
"""A car passes what stands at the roadside at this share of its speed."""
CLOSE_S = 1.0
"""A time gap below this leaves no time to react (mean reaction 1.1 s)."""
GAP_HOLD_S = 3.0
"""Time to reopen a gap after another vehicle cuts in; our choice, as in the checks of law."""
GAP_FROM_KMH = 30.0
HARD_MPS2 = DEFAULT_THRESHOLDS.drac_mps2
STANDING_ALERTS = frozenset(
    {
        AlertKind.MOVE_OVER,
        AlertKind.TRAFFIC,
        AlertKind.LANE,
        AlertKind.COLLISION,
        AlertKind.DISTANCE,
        AlertKind.SPEED,
    }
)
"""Alerts of what stands ahead: each makes a driver slow down, keep back or move over, or says where."""
MINUTE_S = 60.0
EARLY_MPS2, EARLY_TTC_S = 1.0, 8.0
"""Needed deceleration from which, and time to collision below which, a warning of a collision is early and not
needless."""
TRACTOR_KMH = (8.0, 40.0)
FAST_ROAD_KMH = 65.0
TRACTOR_DUE_S = 8.0
SOON_S = 15.0
REAR_END_S = 10.0
CORRIDOR_KMH = 30.0
"""Slower than this where the law asks for a corridor, traffic may come to a halt; our choice."""


class TunnelAhead(EventKind):
    """A tunnel ahead, with the lamps off."""

    told_by = ("tunnel", "light", "lamps")
    name = "tunnel"
    about = "a tunnel comes and the lamps would stay off in it"
    lookalike = "a tunnel that is still a minute away"
    source = "10 s before the portal; deadline: the portal, less 1 s to switch"
    neutral = "a tunnel within 500 m, or within a minute"
    alerts = frozenset({AlertKind.TUNNEL, AlertKind.VISIBILITY})
    writes: ClassVar[Mapping[str, Wanted]] = {
        LIGHTS.LOW_BEAM.path: on,
        LIGHTS.SWITCH.path: lambda value: value in ("BEAM", "AUTO"),
    }

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the map along the route."""
        now = drive[-1]
        away_m, mps = now.driving.ahead.tunnel_distance_m, now.driving.speed_mps
        if away_m is None or mps < 2.0 or now.driving.road.in_tunnel:
            return
        words = f"a tunnel in {away_m:.0f} m"
        if away_m > NEAR_M:
            if away_m <= 3 * NEAR_M and self.against(drive):
                yield Sighting(words, "far", lookalike=True)
            return
        dark = not now.signals[LIGHTS.LOW_BEAM.path] and now.signals[LIGHTS.SWITCH.path] != "AUTO"
        left_s = away_m / mps
        yield Sighting(f"{words}, lamps off", due=dark and left_s <= PORTAL_S, left_s=left_s - 1.0)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No tunnel on the map's horizon, or one that is more than a minute away."""
        now = drive[-1]
        away_m = now.driving.ahead.tunnel_distance_m
        if now.driving.road.in_tunnel:
            return None if not now.signals[LIGHTS.LOW_BEAM.path] else "in the tunnel, with the dipped beam on"
        if away_m is None or away_m > HORIZON_M:
            return "no tunnel within 2 km"
        left_s = away_m / max(now.driving.speed_mps, 0.1)
        return Measured(f"the tunnel is {left_s:.0f} s away") if left_s > MINUTE_S else None


class JamTail(EventKind):
    """The tail of a queue ahead, at speed."""

    told_by = ("jam", "closure")
    name = "jam_tail"
    about = "the car approaches the tail of a jam at speed"
    lookalike = "traffic that flows slowly, but flows"
    source = "15 s before the tail; deadline: reaction 1.1 s and braking at 3.4 m/s2 (AASHTO) end there"
    neutral = "a jam or a closed road on the route within 2 km, at any speed"
    weight = 2.0
    alerts = frozenset({AlertKind.TRAFFIC, AlertKind.COLLISION, AlertKind.DISTANCE, AlertKind.SPEED})
    requests = (SlowDown,)
    writes: ClassVar[Mapping[str, Wanted]] = {LIGHTS.HAZARD.path: on}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the live traffic on the route."""
        now = drive[-1]
        tail, mps = now.sight(SightKind.JAM), now.driving.speed_mps
        away_m = None if tail is None else tail.distance_m
        if away_m is None:
            if now.driving.around.relative_speed < 0.6 and mps > 2.0:
                yield Sighting(f"traffic at {now.driving.around.relative_speed:.0%}", lookalike=True)
            return
        if 0 < away_m <= JAM_M:
            yield Sighting(
                f"a jam in {away_m:.0f} m at {speed_kmh(now):.0f} km/h",
                due=away_m <= JAM_DUE_S * mps and speed_kmh(now) >= JAM_FROM_KMH,
                severity=_urgency(away_m, mps, 0.0),
                left_s=time_left_s(away_m, mps),
            )

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No jam on the route."""
        now = drive[-1]
        if now.sight(SightKind.JAM) is not None or now.sight(SightKind.CLOSURE) is not None:
            return None
        return "no jam is reported within 2 km"


def _urgency(away_m: float, mps: float, to_mps: float) -> float:
    """How hard the car must brake by now, as a share of braking gently; 1 as long as that is enough."""
    return max(1.0, (mps**2 - to_mps**2) / (2 * max(away_m, 1.0)) / EASING_MPS2)


class RearEnd(EventKind):
    """A vehicle that comes fast from behind: hazard lights warn its driver. Nothing is ever due."""

    told_by = ("behind",)
    name = "rear_end"
    about = "hazard lights warn a vehicle behind that would soon run into the car"
    lookalike = "a vehicle behind that comes no closer, or slowly"
    source = "UN R48, 6.25: the rear-end collision alert signal; 10 s, our choice, leave its driver time to brake"
    neutral = "a vehicle behind less than 10 s away at the speed at which it closes; never due"
    is_due_ever = False
    alerts = frozenset[AlertKind]()
    writes: ClassVar[Mapping[str, Wanted]] = {LIGHTS.HAZARD.path: on}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Nothing that would have to be met."""
        return iter(())

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Nobody behind who would soon be there."""
        now = drive[-1]
        follower = now.sight(SightKind.VEHICLE_BEHIND) or now.sight(SightKind.EMERGENCY_VEHICLE)
        if follower is None or follower.distance_m is None:
            return "nobody comes close from behind"
        closing_mps = max(follower.value or 0.0, 0.1)
        left_s = follower.distance_m / closing_mps
        return None if left_s < REAR_END_S else Measured(f"the vehicle behind is {left_s:.0f} s away")


class StandsAhead(EventKind):
    """Something that stands ahead on the route and that the traffic service reports."""

    sights: ClassVar[SightKind]
    weight = 1.5
    source = (
        "12 s before it; deadline: reaction 1.1 s and braking at 3.4 m/s2 (AASHTO) to three fifths of the speed"
    )
    neutral = "one on the route within 2 km, at any speed"
    requests = (SlowDown, Reroute)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the reported incidents, on the route or elsewhere."""
        now = drive[-1]
        there, mps = now.sight(self.sights), now.driving.speed_mps
        if there is None:
            kind = IncidentKind(self.sights.value)
            if any(incident.kind is kind for incident in now.driving.ahead.incidents):
                yield Sighting(f"{kind.value.replace('_', ' ')} reported elsewhere", lookalike=True)
        elif there.distance_m:  # not within it
            yield Sighting(
                there.text[:1].lower() + there.text[1:],
                due=there.distance_m <= STANDS_DUE_S * mps and mps > STANDS_FROM_MPS,
                severity=_urgency(there.distance_m, mps, PASS_SHARE * mps),
                left_s=time_left_s(there.distance_m, mps, PASS_SHARE * mps),
            )

    def against(self, drive: Sequence[Moment]) -> str | None:
        """None of it on the route."""
        now, kind = drive[-1], IncidentKind(self.sights.value)
        if now.sight(self.sights) is not None:
            return None
        words = kind.value.replace("_", " ")
        elsewhere = any(incident.kind is kind for incident in now.driving.ahead.incidents)
        return f"{words} reported on another road" if elsewhere else f"no {words} reported within 2 km"


class BreakdownAhead(StandsAhead):
    """A broken-down vehicle ahead."""

    told_by = ("breakdown",)
    name = "breakdown"
    about = "a broken-down vehicle stands ahead on the route"
    lookalike = "one that is reported on another road or the other carriageway"
    sights = SightKind.BREAKDOWN
    alerts = STANDING_ALERTS


class RoadworksAhead(StandsAhead):
    """Roadworks ahead."""

    told_by = ("roadworks",)
    name = "roadworks"
    about = "roadworks narrow the road ahead on the route"
    lookalike = "roadworks that are reported on another road or the other carriageway"
    weight = 1.0
    sights = SightKind.ROADWORKS
    alerts = STANDING_ALERTS


class BlueLight(EventKind):
    """An emergency vehicle behind, with its blue light on."""

    told_by = ("behind",)
    name = "blue_light"
    about = "an emergency vehicle with blue light comes from behind and wants to pass"
    lookalike = "a plain van close behind"
    source = "150 m: 8 s at a closing speed of 70 km/h; deadline: 8 s"
    neutral = "a blue light behind within 300 m, also while the car stands at the side"
    weight = 2.0
    grace_s = 8.0
    alerts = frozenset({AlertKind.YIELD, AlertKind.CORRIDOR, AlertKind.MOVE_OVER})
    requests = (PullOver,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """By the radio message that such a vehicle sends, or the radar."""
        now = drive[-1]
        behind, follower = now.sight(SightKind.EMERGENCY_VEHICLE), now.sight(SightKind.VEHICLE_BEHIND)
        if behind is not None and behind.distance_m is not None:
            due = behind.distance_m <= BLUE_DUE_M and not _stands_aside(drive)
            yield Sighting(f"a blue light {behind.distance_m:.0f} m behind", due=due, hold_s=1.0)
        elif follower is not None:
            yield Sighting(f"a car {follower.distance_m or 0:.0f} m behind comes closer", lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Nobody behind with a blue light."""
        follower = drive[-1].sight(SightKind.VEHICLE_BEHIND)
        if follower is not None:
            return f"a vehicle without a blue light {follower.distance_m or 0:.0f} m behind"
        return f"no blue light within {BLUE_LIGHT_M:.0f} m"


def _stands_aside(drive: Sequence[Moment]) -> bool:
    """Whether the car stands at the side of the road, parked or as the driver was asked to, out of the way."""
    now = drive[-1]
    if now.driving.standing_s <= 0:
        return False
    since_s = now.time_s - IN_FORCE_S
    lately = takewhile(lambda moment: moment.time_s >= since_s, reversed(drive))
    stops = (event.kind for moment in lately for event in reversed(moment.events))
    return next((kind for kind in stops if kind in STOPS | SETS_OFF), None) in STOPS


class Corridor(EventKind):
    """A jam in which the law asks for a corridor before anybody needs it. Nothing is ever due."""

    told_by = ("speed", "jam")
    name = "corridor"
    about = "in a jam the law asks for a corridor, also before an emergency vehicle comes"
    lookalike = "a jam where no rule asks for one, or traffic that flows"
    source = "the law of the place, such as StVO 11(2); 30 km/h, our choice"
    neutral = "slower than 30 km/h, or a jam ahead, where a rule asks for a corridor; never due"
    is_due_ever = False
    alerts = frozenset({AlertKind.CORRIDOR})

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Nothing that would have to be met."""
        return iter(())

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No rule that asks for a corridor, or no jam."""
        now = drive[-1]
        if not may_say(now.context, "emergency_corridor", "required"):
            return "no rule here asks for a corridor"
        if speed_kmh(now) < CORRIDOR_KMH or now.sight(SightKind.JAM) is not None:
            return None
        return f"no jam, at {speed_kmh(now):.0f} km/h"


TAUGHT_S = 2.0
"""The gap that drivers are taught: closer than this, somebody may speak of it."""


class LeaderClose(EventKind):
    """Too close behind the vehicle ahead."""

    told_by = ("vehicle ahead",)
    name = "leader_close"
    about = "the gap to the vehicle ahead is shorter than the law asks, or than a driver needs to react"
    lookalike = "a gap a little longer than that"
    source = "the law of the place, else 1 s; 3 s to reopen a gap; deadline: 6 s"
    neutral = "such a gap below 30 km/h, or shorter than a rule asks that is not verified"
    grace_s = 6.0
    alerts = frozenset({AlertKind.DISTANCE, AlertKind.COLLISION})
    requests = (SlowDown,)
    writes: ClassVar[Mapping[str, Wanted]] = {
        ADAS.CRUISE_GAP.path: lambda value: isinstance(value, float) and value >= 2.0
    }

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Above 30 km/h, within the radar's reach."""
        now = drive[-1]
        leader, mps = in_sight(now), now.driving.speed_mps
        if leader is None or speed_kmh(now) < GAP_FROM_KMH:
            return
        least_s = max([CLOSE_S, *_lawful_s(now)])
        gap_s = leader.gap_m / mps
        words = f"{gap_s:.1f} s behind the vehicle ahead, {least_s:.1f} s are asked"
        if gap_s < least_s:
            yield Sighting(words, due=True, hold_s=GAP_HOLD_S, severity=least_s / max(gap_s, 0.1))
        elif gap_s < least_s + 0.5 and self.against(drive):
            yield Sighting(words, lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Nobody ahead, or a gap as long as any rule asks."""
        now = drive[-1]
        leader, mps = in_sight(now), now.driving.speed_mps
        if leader is None:
            return f"nobody within {RADAR_M:.0f} m ahead"
        if mps < 1.0:
            return "the car stands"
        least_s = max([CLOSE_S, *_lawful_s(now, verified=False)])
        gap_s = leader.gap_m / mps
        words = f"a gap of {gap_s:.1f} s, where {least_s:.1f} s are asked"
        if gap_s < least_s:
            return None
        return Measured(words) if gap_s < TAUGHT_S else words


def _lawful_s(now: Moment, *, verified: bool = True) -> Iterator[float]:
    """The time gaps that law asks for here; that which is not verified obliges nobody."""
    mps = max(now.driving.speed_mps, 1.0)
    rules = (found for found in now.context.rules if found.rule.topic == "following_distance")
    for found in certain(now.context, "following_distance") if verified else rules:
        if isinstance(found.value, float):
            yield found.value if found.rule.unit == "s" else found.value / mps


class LeaderBrakes(EventKind):
    """The vehicle ahead brakes so hard that only hard braking helps."""

    told_by = ("vehicle ahead",)
    name = "leader_brakes"
    about = "only hard braking avoids the vehicle ahead"
    lookalike = "a vehicle ahead that is slower, with room to brake gently"
    source = "ISO 15623: by needed deceleration, 3.4 m/s2 (Archer, 2005); deadline: time to collision less 1.1 s"
    neutral = "a needed deceleration of 1 m/s2 or more, or less than 8 s to collision"
    weight = 2.0
    alerts = frozenset({AlertKind.COLLISION, AlertKind.DISTANCE, AlertKind.TRAFFIC})
    requests = (SlowDown,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Sights the vehicle ahead from half a metre per second squared on."""
        leader = in_sight(drive[-1])
        if leader is None or leader.drac_mps2 is None or leader.time_to_collision_s is None:
            return
        words = f"{leader.drac_mps2:.1f} m/s2 needed, {leader.time_to_collision_s:.1f} s to the vehicle ahead"
        if leader.drac_mps2 >= HARD_MPS2:
            left_s = leader.time_to_collision_s - REACTION_S
            yield Sighting(words, due=True, left_s=left_s, severity=leader.drac_mps2 / HARD_MPS2)
        elif leader.drac_mps2 >= HARD_MPS2 / 2:
            yield Sighting(words)
        elif leader.drac_mps2 >= EARLY_MPS2 / 2 and self.against(drive):
            yield Sighting(words, lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Nobody ahead to run into, or room to brake gently."""
        leader = in_sight(drive[-1])
        if leader is None:
            return f"nobody within {RADAR_M:.0f} m ahead"
        ttc_s, needed_mps2 = leader.time_to_collision_s, leader.drac_mps2 or 0.0
        if ttc_s is None:
            return f"the vehicle ahead comes no closer, {leader.gap_m:.0f} m ahead"
        if needed_mps2 >= EARLY_MPS2 or ttc_s < EARLY_TTC_S:
            return None
        return Measured(f"{ttc_s:.0f} s to collision, and braking with {needed_mps2:.1f} m/s2 is enough")


class TractorAhead(EventKind):
    """A slow vehicle ahead on a fast road."""

    told_by = ("vehicle ahead",)
    name = "tractor"
    about = "the car comes up fast behind a slow vehicle on a fast road"
    lookalike = "a slow vehicle ahead in a town"
    source = "8 s to the vehicle ahead; deadline: reaction 1.1 s and braking at 3.4 m/s2 (AASHTO)"
    neutral = "a vehicle that the car would reach within 15 s, on any road"
    alerts = frozenset(
        {AlertKind.TRAFFIC, AlertKind.DISTANCE, AlertKind.COLLISION, AlertKind.SPEED, AlertKind.MOVE_OVER}
    )
    requests = (SlowDown,)

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the radar and the road's limit."""
        now = drive[-1]
        leader, mps = in_sight(now), now.driving.speed_mps
        limit_kmh = now.driving.road.limit.kmh
        if leader is None or limit_kmh is None:
            return
        closing_mps = mps - leader.speed_mps
        slow, fast = TRACTOR_KMH
        if not slow <= leader.speed_mps * KMH_PER_MPS <= fast or closing_mps < 3.0:
            return
        words = f"a vehicle at {leader.speed_mps * KMH_PER_MPS:.0f} km/h {leader.gap_m:.0f} m ahead"
        if limit_kmh < FAST_ROAD_KMH:
            if self.against(drive):
                yield Sighting(words, lookalike=True)
            return
        left_s = time_left_s(leader.gap_m, closing_mps)
        yield Sighting(words, due=leader.gap_m <= TRACTOR_DUE_S * closing_mps, left_s=left_s)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Nobody ahead, or nobody whom the car would reach soon."""
        leader, mps = in_sight(drive[-1]), drive[-1].driving.speed_mps
        if leader is None:
            return f"nobody within {RADAR_M:.0f} m ahead"
        closing_mps = mps - leader.speed_mps
        if closing_mps <= 1.0:
            return f"the vehicle ahead drives {leader.speed_mps * KMH_PER_MPS:.0f} km/h, as fast as the car"
        left_s = leader.gap_m / closing_mps
        return Measured(f"{left_s:.0f} s to the vehicle ahead") if left_s > SOON_S else None
