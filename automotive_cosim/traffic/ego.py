"""The driver: how a profile drives, and how it reacts to the cockpit's requests.

Pure logic over a few ``Pedals``, the same in SUMO and on a scripted road. Speed is controlled by a factor on the
road's limit and an upper bound; both change smoothly, because SUMO's own model would brake hard as soon as either
falls.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace

import numpy as np

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    MPH_PER_MPS,
    Alert,
    AlertKind,
    Answer,
    Aware,
    Cruise,
    DrivingState,
    EgoEnd,
    Hazards,
    PullOver,
    Redraw,
    Reroute,
    RoadHere,
    RoadRequest,
    Severity,
    SlowDown,
)
from automotive_cosim.contracts.text import say
from automotive_cosim.traffic.base import EgoPlan, Event, HaltAt
from automotive_cosim.traffic.instant import Instant
from automotive_cosim.traffic.pedals import Pedals, RefusedError
from automotive_cosim.traffic.profiles import DriverProfile, profile
from automotive_cosim.traffic.reasons import AdviceReason, RoadView, reason_for
from automotive_cosim.traffic.road_weather import DRY, Forecast, RoadCondition

REACTION_SPREAD = 0.25
"""Standard deviation of the logarithm of a reaction time: brake reactions are log-normal (Taoka, 1989)."""

EASING_MPS2 = 1.5
"""Deceleration of a driver who slows down gently: accelerator released, then a touch of brake."""

BRAKING_MPS2 = 3.0
"""The same after a critical alert; AASHTO's Green Book takes 3.4 m/s2 as comfortable for most drivers."""

SAFE_HEADWAY_S = 2.0
"""The gap that a driver opens after an alert about the distance (R412-12 and the common two-second rule)."""

ATTENTIVE = 0.3
"""Imperfection of a driver who has been woken up."""

SPEED_KINDS = frozenset(
    {
        AlertKind.SPEED,
        AlertKind.COLLISION,
        AlertKind.VISIBILITY,
        AlertKind.SLIPPERY,
        AlertKind.WEATHER,
        AlertKind.TRAFFIC,
        AlertKind.SCHOOL,
        AlertKind.TUNNEL,
    }
)
"""Alerts after which a driver goes no faster than the limit, or the advised speed."""

GAP_KINDS = frozenset({AlertKind.DISTANCE, AlertKind.COLLISION, AlertKind.VISIBILITY, AlertKind.SLIPPERY})
"""Alerts after which a driver keeps further back."""

ROOM_KINDS = frozenset({AlertKind.CORRIDOR, AlertKind.YIELD, AlertKind.MOVE_OVER})
"""Alerts after which a driver makes room for others."""

VIEW_KINDS = frozenset({AlertKind.VISIBILITY, AlertKind.WEATHER, AlertKind.TUNNEL})
"""Alerts after which a driver on a drive sees to wipers, defroster and lamps."""

BELT_KINDS = frozenset({AlertKind.SEAT_BELT})
"""Alerts after which a driver on a drive has everybody buckle up."""

WAKING_KINDS = frozenset({AlertKind.FATIGUE, AlertKind.DISTRACTION})

GIVE_WAY_M = 500.0
"""A driver gives way by stopping no farther on, half a minute at 60 km/h; not beyond a long tunnel."""
GIVE_WAY_S = 12.0
"""How long a driver waits at the side, or keeps to the kerb lane, to let an emergency vehicle pass."""

CORRIDOR_S = 90.0
"""How long a driver keeps a corridor open."""

MOVE_OVER_S = 30.0
MOVE_OVER_MPS = 20 / MPH_PER_MPS
SLOWEST_MOVE_OVER_MPS = 5 / MPH_PER_MPS
"""A driver who cannot change lanes passes at 20 mph below the limit, or at 5 mph if that is 20 or less (Florida
statute 316.126)."""
PASS_SHARE = 0.6
"""On a drive it is no less than three fifths of the limit: our choice, since nobody creeps past a car in a town."""
BESIDE_M = 15.0
"""From so far before a place the driver is as slow as advised for it."""
LONGEST_ADVICE_S = 360.0
"""A driver keeps to advice no longer, whatever its reason."""

FASTEST_MPS = 130 / KMH_PER_MPS
"""A request for this speed holds nobody back where there is no limit."""
SLOWEST_REQUEST_KMH = 5.0
FAST_ROADS = frozenset({"motorway", "trunk"})
MOTORWAYS = frozenset({"motorway", "motorway_link"})
SLOW_TRAFFIC = 0.5
"""Relative speed of traffic below which driving slowly on a fast road hinders nobody."""


_ENDS = {
    EgoEnd.ARRIVED: say("arrived"),
    EgoEnd.COLLIDED: say("collided"),
    EgoEnd.TELEPORTED: say("teleported"),
    EgoEnd.REMOVED: say("removed"),
}
FOR_GOOD_S = 86_400.0
SEARCH_S = 60.0
"""How long a driver who was asked to stop looks for a place."""
RELEASED = "driver_released"
GOES_ON = "driver_goes_on"
DRIVES_ON = "driver_drives_on"
WAKES_UP = "driver_wakes"
CLEARS_VIEW = "driver_clears_view"
BUCKLES = "driver_buckles"
"""Kinds of the events after which hands do something in the car (``cosim.car``)."""
PARKS = "driver_parks"
SETS_OFF = "driver_sets_off"
"""Kinds of the events of a planned halt."""


@dataclass(slots=True)
class _Intent:
    """Something that the driver will do after the reaction time."""

    due_s: float
    asked_s: float
    request: Alert | SlowDown | PullOver
    complies: bool


@dataclass(slots=True)
class _Bounds:
    """Speed limits that the driver keeps, in m/s; infinite without a request."""

    asked: float = math.inf
    asked_under: float | None = None
    """The limit at which that was asked; in a drive it ends with it."""
    cruise: float = math.inf
    advised: float = math.inf
    advised_under: float | None = None
    """The limit at which the advice was given, and with which it ends."""
    advised_until_s: float = math.inf
    passing: float = math.inf
    """From a place ahead on, and slowed down to gently before it."""
    to_place_m: float = 0.0
    """How far that is."""

    @property
    def approach_mps(self) -> float:
        """How fast the driver goes towards that place."""
        if self.passing == math.inf:
            return math.inf
        return math.sqrt(self.passing**2 + 2 * EASING_MPS2 * max(0.0, self.to_place_m - BESIDE_M))

    def advice_is_over(self, now: Instant) -> bool:
        """Whether a speed was advised until now: its time is over, or the limit is another."""
        is_over = now.limit_mps != self.advised_under or now.time_s >= self.advised_until_s
        return self.advised < math.inf and is_over


@dataclass(slots=True)
class Driver:
    """Drives by the profile of a plan and reacts to requests. ``tick`` is called once per step."""

    plan: EgoPlan
    pedals: Pedals
    step_s: float
    own: DriverProfile | None = None
    """How the driver of a car that drives anyway does so; None drives by the plan's profiles."""
    hazard_lights: bool = False
    _profile: DriverProfile = field(init=False)
    _draws: np.random.Generator = field(init=False)
    _intents: list[_Intent] = field(default_factory=list)
    _bounds: _Bounds = field(default_factory=_Bounds)
    _law_abiding: bool = False
    _easing_mps2: float = EASING_MPS2
    _factor: float = math.nan
    _top_mps: float = math.nan
    _headway_s: float = field(init=False)
    """Time gap on a dry road."""
    _own_ratio: float = field(init=False)
    """Factor on the limit that the driver chooses in this weather."""
    _own_top_mps: float = field(init=False)
    _corridor_until_s: float = math.inf
    _condition: RoadCondition = DRY
    _forecast: Forecast | None = None
    _departed_s: float = math.nan
    _moods: int = 0
    """How many changes of the plan's have come."""
    _mood: str = field(init=False)
    """Name of the profile outside school zones."""
    _schools: int = 0
    """How many school zones it has entered at their hours."""
    _in_school_zone: bool = False
    _halts: int = 0
    """How many halts of the plan's have ended."""
    _halting: bool = False
    """Whether the place of a halt is chosen."""
    _sets_off_s: float = math.inf
    _advised_until_s: float = math.inf
    """When the driver no longer keeps to what was asked or advised."""
    _longest_until_s: float = math.inf
    """When not even for its reason."""
    _reason: AdviceReason | None = None
    """What the last advice on a drive is for, beyond the road here."""
    _search_until_s: float = -math.inf
    """Until when the driver looks for a place to stop, as asked."""
    _stop: str = ""
    """Whether a stop that was asked for is ``chosen`` or ``made``; empty without one."""

    def __post_init__(self) -> None:
        self._mood = self.plan.driver
        self._profile = self.own or profile(self._mood)
        self.react_anew(self.plan.seed)
        self._headway_s = self._profile.headway_s
        self._choose_speed()
        self._choose_braking()

    @property
    def state(self) -> tuple[object, ...]:
        """All that decides how the driver goes on, beside the road and the plan."""
        mind = (getattr(self, each.name) for each in fields(self) if each.name not in ("plan", "pedals", "_draws"))
        return *mind, self._draws.bit_generator.state

    def react_anew(self, seed: int) -> None:
        """Reacts by a seed, as if the plan had it; until something is asked for, it makes no difference."""
        self.plan = replace(self.plan, seed=seed)
        self._draws = np.random.default_rng([seed, 0])

    def request(self, request: RoadRequest, state: DrivingState) -> Answer:
        """Receives a request. What does not depend on the driver happens now, the rest after the reaction time."""
        if state.end is not None:
            return Answer(False, say("the drive has ended: {end}", end=_ENDS[state.end]))
        match request:
            case Alert():
                return self._hear(request, state, say("announced to the driver"))
            case SlowDown(speed_kmh):
                why_not = _too_slow(speed_kmh, state)
                if why_not:
                    return Answer(False, why_not)
                return self._hear(request, state, say("the driver is asked to slow down"))
            case PullOver():
                if state.road.in_tunnel:
                    return Answer(False, say("stopping in a tunnel is dangerous; ask again after it"))
                return self._hear(request, state, say("the driver is asked to pull over"))
            case Cruise(speed_kmh):
                return self._cruise(speed_kmh, state)
            case Redraw(int(seed)):
                self._draws = np.random.default_rng([self.plan.seed, 0, seed])
                self.pedals.renew(seed)
                return Answer(True, "")
            case Redraw():
                self._drawn()
                return Answer(True, "")
            case Aware(awareness):
                self.pedals.set_awareness(awareness)
                return Answer(True, "")
            case Hazards(on):
                self.hazard_lights = on
                self.pedals.set_hazards(on)
                return Answer(True, say("hazard lights on") if on else say("hazard lights off"))
            case Reroute():
                try:
                    return Answer(True, self.pedals.reroute(request, state))
                except RefusedError as refusal:
                    return Answer(False, refusal.why)

    def tick(self, now: Instant) -> tuple[Event, ...]:
        """Does what is due and controls the speed; it takes effect from the next step."""
        events: tuple[Event, ...] = ()
        if self._forecast is None:
            self._forecast = Forecast(self.plan.weather, now.time_s, self.plan.settles_s)
            self._departed_s = now.time_s
        before = self._profile
        if self._moods < len(self.plan.moods):
            self._change_mood(now.time_s - self._departed_s)
        if self.plan.at_schools:
            self._pass_school(now.state.road)
        if self._profile is not before and self._advised_until_s < math.inf and self._reason is None:
            events = (self._release(now.time_s, "what was advised has ended"),)
        if self._halts < len(self.plan.halts):
            events += tuple(self._halt(self.plan.halts[self._halts], now))
        if now.time_s >= self._forecast.until_s:
            self._meet(self._forecast.read(now.time_s))
        if self._intents:
            due = [intent for intent in self._intents if intent.due_s <= now.time_s + 1e-9]
            if due:
                self._intents = [intent for intent in self._intents if intent not in due]
                events += tuple(event for intent in due for event in self._act(intent, now.state))
        if self.plan.advice_ends:
            events += tuple(self._end_advice(now))
        if now.time_s >= self._corridor_until_s:
            self._corridor_until_s = math.inf
            self.pedals.leave_corridor(False)
        self._hold_speed(now)
        return events

    def _hear(self, request: Alert | SlowDown | PullOver, state: DrivingState, reason: str) -> Answer:
        """Draws once per request of any kind, so that the driver's randomness depends only on their number."""
        reaction_s, complies = self._drawn()
        self._intents.append(_Intent(state.time_s + reaction_s, state.time_s, request, complies))
        return Answer(True, reason)

    def _drawn(self) -> tuple[float, bool]:
        """A reaction time, and whether the driver complies."""
        reaction_s = self._profile.reaction_s * math.exp(REACTION_SPREAD * float(self._draws.standard_normal()))
        return reaction_s, float(self._draws.random()) < self._profile.compliance

    def _cruise(self, speed_kmh: float | None, state: DrivingState) -> Answer:
        if speed_kmh is None:
            self._bounds.cruise = math.inf
            return Answer(True, say("The car no longer holds a speed"))
        why_not = _too_slow(speed_kmh, state)
        if why_not:
            return Answer(False, why_not)
        self._bounds.cruise = speed_kmh / KMH_PER_MPS
        return Answer(True, say("The car will go no faster than {speed} km/h", speed=f"{speed_kmh:.0f}"))

    def _act(self, intent: _Intent, state: DrivingState) -> tuple[Event, ...]:
        request, after = intent.request, f"{state.time_s - intent.asked_s:.1f} s after"
        if not intent.complies:
            what = f"the {request.kind} alert" if isinstance(request, Alert) else "the request"
            return (Event(state.time_s, "driver_ignores", f"driver hears {what} but does not react"),)
        match request:
            case Alert():
                return tuple(self._heed(request, state, f"{after} the alert"))
            case SlowDown(speed_kmh):
                limit_mps = state.road.limit.mps
                if self.plan.advice_ends and takes_back(speed_kmh, state):
                    return (self._release(state.time_s, f"advice taken back, {after} the request"),)
                self._keep_to(None, state)
                if self._reason is not None:
                    return (self._name(speed_kmh / KMH_PER_MPS, state, f"{after} the request"),)
                self._bounds.asked, self._bounds.asked_under = speed_kmh / KMH_PER_MPS, limit_mps
                return (self._slows(state, f"{after} the request"),)
            case PullOver() if self.plan.advice_ends:
                self._search_until_s = state.time_s + SEARCH_S
                return (Event(state.time_s, "driver_pulls_over", f"driver looks for a place to stop, {after} it"),)
            case PullOver():
                try:
                    where = self.pedals.pull_over(state, FOR_GOOD_S)
                except RefusedError as refusal:
                    return (Event(state.time_s, "driver_cannot_stop", f"driver cannot stop: {refusal}"),)
                return (
                    Event(state.time_s, "driver_pulls_over", f"driver pulls over {where}, {after} the request"),
                )

    def _heed(self, alert: Alert, state: DrivingState, after: str) -> list[Event]:
        events = []
        self._keep_to(alert.kind, state)
        if self._is_told_to_stop(alert):
            self._search_until_s = state.time_s + SEARCH_S
            events.append(Event(state.time_s, "driver_pulls_over", f"driver looks for a place to stop, {after}"))
        if alert.kind in SPEED_KINDS:
            self._law_abiding = True
            self._easing_mps2 = BRAKING_MPS2 if alert.severity is Severity.CRITICAL else EASING_MPS2
            if alert.speed_kmh is not None:
                events.append(self._name(alert.speed_kmh / KMH_PER_MPS, state, after))
            else:
                events.append(self._slows(state, after))
        if alert.kind in GAP_KINDS:
            self._headway_s = max(SAFE_HEADWAY_S, self._profile.headway_s)
            self.pedals.set_headway(self._headway_s * self._adapted(self._condition.headway_ratio))
            events.append(
                Event(state.time_s, "driver_opens_gap", f"driver keeps {SAFE_HEADWAY_S:g} s behind, {after}")
            )
        if alert.kind in WAKING_KINDS:
            self.pedals.set_imperfection(min(ATTENTIVE, self._profile.imperfection))
            events.append(Event(state.time_s, WAKES_UP, f"driver pays attention, {after}"))
        if self.plan.advice_ends and alert.kind in VIEW_KINDS:
            events.append(Event(state.time_s, CLEARS_VIEW, f"driver sees to glass and lamps, {after}"))
        if self.plan.advice_ends and alert.kind in BELT_KINDS:
            events.append(Event(state.time_s, BUCKLES, f"driver has everybody buckle up, {after}"))
        if alert.kind in ROOM_KINDS:
            events.append(self._make_room(alert, state, after))
        return events or [
            Event(state.time_s, "driver_notes", f"driver takes note of the {alert.kind} alert, {after}")
        ]

    def _is_told_to_stop(self, alert: Alert) -> bool:
        """By the red warning of the car itself: a leaking tyre, an open tailgate."""
        is_red = alert.kind is AlertKind.VEHICLE and alert.severity is Severity.CRITICAL
        return is_red and self.plan.advice_ends

    def _end_advice(self, now: Instant) -> Iterator[Event]:
        """Stops where asked to, and drives as before once what was asked or advised has ended."""
        if now.time_s < self._search_until_s and not self._stop:
            with suppress(RefusedError):  # further on there may be a place
                where = self.pedals.pull_over(now.state, self.plan.advice_s)
                self._stop = "chosen"
                yield Event(now.time_s, "driver_pulls_over", f"driver pulls over {where}")
        elif self._stop and self.pedals.is_parked() is not (self._stop == "made"):
            if self._stop == "made":
                self._stop, self._search_until_s = "", -math.inf
                yield Event(now.time_s, DRIVES_ON, "driver drives on")
            else:
                self._stop = "made"
        elif not self._stop and -math.inf < self._search_until_s <= now.time_s:
            self._search_until_s = -math.inf
            yield Event(now.time_s, "driver_cannot_stop", "driver has found no place to stop")
        bounds = self._bounds
        if self._reason is not None:
            yield from self._keep_to_reason(self._reason, now)
            return
        if bounds.asked < math.inf and now.limit_mps != bounds.asked_under:
            self._advised_until_s = now.time_s
        if now.time_s >= self._advised_until_s:
            yield self._release(now.time_s, "what was advised has ended")
        elif bounds.advice_is_over(now):
            bounds.advised = math.inf
            kind, goes = ("driver_holds", "no faster than the limit") if self._law_abiding else (GOES_ON, "on")
            yield Event(now.time_s, kind, f"driver goes {goes}; the advised speed has ended")

    def _keep_to_reason(self, reason: AdviceReason, now: Instant) -> Iterator[Event]:
        """Keeps to advice as long as what it is for is there."""
        bounds = self._bounds
        if now.time_s >= self._longest_until_s:
            yield self._release(now.time_s, "what was advised has ended")
        elif not reason.lasts(self._view(now.state)):
            yield self._release(now.time_s, "what it was advised for is passed")
        else:
            bounds.to_place_m, bounds.advised_under = reason.to_place_m, now.limit_mps

    def _keep_to(self, kind: AlertKind | None, state: DrivingState) -> None:
        """Keeps to advice from now on: two minutes, or on a drive as long as its reason is there."""
        self._advised_until_s = state.time_s + self.plan.advice_s
        if self.plan.advice_ends:
            self._reason = reason_for(kind, self._view(state)) or self._reason
            self._longest_until_s = state.time_s + LONGEST_ADVICE_S

    def _name(self, speed_mps: float, state: DrivingState, after: str) -> Event:
        """Keeps to a speed that was named: from the place on that it is for, or at once."""
        bounds, kmh = self._bounds, speed_mps * KMH_PER_MPS
        if self._reason is None or self._reason.to_place_m <= 0.0:
            self._advise(speed_mps, state)
            return self._slows(state, after)
        bounds.passing, bounds.to_place_m = speed_mps, self._reason.to_place_m
        words = f"driver will go {kmh:.0f} km/h from {bounds.to_place_m:.0f} m ahead on, {after}"
        return Event(state.time_s, "driver_slows", words)

    def _view(self, state: DrivingState) -> RoadView:
        ahead = state.ahead
        return RoadView(
            state.speed_mps,
            state.road.limit.mps,
            None if ahead.next_limit is None else ahead.next_limit.mps,
            ahead.next_limit_distance_m,
            self.pedals.standing_ahead_m(),
            ahead.jam_distance_m,
            state.road.friction,
            self._condition.sight_mps,
        )

    def _release(self, now_s: float, why: str) -> Event:
        """Drives as without any advice."""
        self._advised_until_s = self._longest_until_s = math.inf
        self._reason = None
        self._bounds.asked = self._bounds.advised = self._bounds.passing = math.inf
        self._drive_as(self._profile.name)
        return Event(now_s, RELEASED, f"driver drives as before; {why}")

    def _make_room(self, alert: Alert, state: DrivingState, after: str) -> Event:
        """Gives way to an emergency vehicle behind, in a jam by a corridor, or to a stopped vehicle at the kerb."""
        pedals = self.pedals
        if alert.kind is AlertKind.CORRIDOR:
            self._corridor_until_s = state.time_s + CORRIDOR_S
            return Event(state.time_s, "driver_makes_corridor", f"driver {pedals.leave_corridor(True)}, {after}")
        if alert.kind is AlertKind.MOVE_OVER:
            if pedals.change_lane(1, MOVE_OVER_S):
                return Event(state.time_s, "driver_moves_over", f"driver goes one lane away from the kerb, {after}")
            limit_mps = state.road.limit.mps or state.speed_mps
            slowest_mps = PASS_SHARE * limit_mps if self.plan.advice_ends else SLOWEST_MOVE_OVER_MPS
            speed_mps = max(slowest_mps, limit_mps - MOVE_OVER_MPS)
            if alert.speed_kmh is not None:
                speed_mps = alert.speed_kmh / KMH_PER_MPS
            if self._reason is not None:
                return self._name(speed_mps, state, after)
            self._advise(speed_mps, state, MOVE_OVER_S)
            return self._slows(state, after)
        if state.road.lane_count > 1 and not state.road.in_tunnel:
            pedals.change_lane(-state.road.lane_index, GIVE_WAY_S)
            return Event(state.time_s, "driver_gives_way", f"driver keeps to the lane at the kerb, {after}")
        try:
            where = pedals.pull_over(state, GIVE_WAY_S, GIVE_WAY_M)
        except RefusedError as refusal:
            return Event(state.time_s, "driver_cannot_stop", f"driver cannot give way: {refusal}")
        return Event(state.time_s, "driver_gives_way", f"driver stops at the side {where}, {after}")

    def _advise(self, speed_mps: float, state: DrivingState, for_s: float = math.inf) -> None:
        self._bounds.advised = speed_mps
        self._bounds.advised_under = state.road.limit.mps
        self._bounds.advised_until_s = state.time_s + for_s

    def _slows(self, state: DrivingState, after: str) -> Event:
        wanted_kmh = self._wanted_mps(state) * KMH_PER_MPS
        if wanted_kmh < state.speed_mps * KMH_PER_MPS:
            return Event(state.time_s, "driver_slows", f"driver slows to {wanted_kmh:.0f} km/h, {after}")
        is_named = self._bound_mps() <= self._wanted_mps(state) < self._own_top_mps
        bound = f"{wanted_kmh:.0f} km/h" if is_named else "the limit"
        return Event(state.time_s, "driver_holds", f"driver goes no faster than {bound}, {after}")

    def _change_mood(self, since_s: float) -> None:
        """Drives in another way once that is due, but in a school zone only after it."""
        mood = self.plan.moods[self._moods]
        if since_s < mood.at_s - 1e-9:
            return
        self._moods += 1
        self._mood = mood.driver
        if not self._in_school_zone:
            self._drive_as(mood.driver)

    def _pass_school(self, road: RoadHere) -> None:
        """Drives in another way from where a school zone begins at its hours to where it ends."""
        in_zone = road.school_zone and road.limit_by_clock
        if in_zone is self._in_school_zone:
            return
        self._in_school_zone = in_zone
        if in_zone:
            self._drive_as(self.plan.at_schools[self._schools % len(self.plan.at_schools)])
            self._schools += 1
        else:
            self._drive_as(self._mood)

    def _drive_as(self, name: str) -> None:
        """Drives by another profile; what an alert had brought about is forgotten, unless its reason is there."""
        self._profile = self.own or profile(name)
        if self._reason is None:
            self._law_abiding, self._easing_mps2 = False, EASING_MPS2
            self._headway_s = self._profile.headway_s
        self._choose_speed()
        self.pedals.set_headway(self._headway_s * self._adapted(self._condition.headway_ratio))
        self.pedals.set_imperfection(self._profile.imperfection)
        self.pedals.set_overtaking(self._profile.overtaking)
        self._choose_braking()

    def _halt(self, halt: HaltAt, now: Instant) -> Iterator[Event]:
        """Looks for a place to park once it is time, parks there, and drives on."""
        if now.time_s >= self._sets_off_s:
            self._halts, self._halting, self._sets_off_s = self._halts + 1, False, math.inf
            yield Event(now.time_s, SETS_OFF, "driver drives on")
        elif self._sets_off_s < math.inf or now.time_s - self._departed_s < halt.at_s - 1e-9:
            return
        elif self._halting:
            if self.pedals.is_parked():
                self._sets_off_s = now.time_s + halt.for_s
                yield Event(now.time_s, PARKS, f"driver parks for {halt.for_s:.0f} s")
        elif now.state.road.road_class not in MOTORWAYS:
            with suppress(RefusedError):  # further on there may be a place
                self.pedals.pull_over(now.state, halt.for_s)
                self._halting = True

    # --- weather ------------------------------------------------------------------------------------------

    def _meet(self, condition: RoadCondition) -> None:
        """Adapts to other weather as far as the driver is cautious; grip changes regardless."""
        if condition != self._condition:
            self._condition = condition
            self._choose_speed()
            self.pedals.set_grip(condition.friction)
            if self.plan.advice_ends:
                self.pedals.set_traction(condition.friction)
            self.pedals.set_headway(self._headway_s * self._adapted(condition.headway_ratio))

    def _choose_speed(self) -> None:
        adapted = self._adapted(self._condition.speed_ratio)
        self._own_ratio = self._profile.speed_ratio * adapted
        self._own_top_mps = self._profile.top_speed_kmh / KMH_PER_MPS * adapted
        if self._profile.caution:
            self._own_top_mps = min(self._own_top_mps, self._condition.sight_mps)

    def _choose_braking(self) -> None:
        if self.plan.brakes_early:
            self.pedals.set_braking(self._profile.early_mps2)
            self.pedals.set_grip(self._condition.friction)

    def _adapted(self, ratio: float) -> float:
        return 1.0 + self._profile.caution * (ratio - 1.0)

    # --- speed --------------------------------------------------------------------------------------------

    def _chosen_factor(self, limit_mps: float | None) -> float:
        """Factor on the limit on a clear road, before any request."""
        if limit_mps is None:
            return 1.0
        chosen = self._own_ratio
        if chosen > 1.0:
            chosen = min(chosen, 1.0 + self._profile.over_limit_max_kmh / KMH_PER_MPS / limit_mps)
        return min(chosen, 1.0) if self._law_abiding else chosen

    def _bound_mps(self) -> float:
        bounds = self._bounds
        return min(self._own_top_mps, bounds.asked, bounds.cruise, bounds.advised, bounds.approach_mps)

    def _wanted_mps(self, state: DrivingState) -> float:
        limit_mps = state.road.limit.mps
        bound_mps = self._bound_mps()
        return bound_mps if limit_mps is None else min(bound_mps, self._chosen_factor(limit_mps) * limit_mps)

    def _hold_speed(self, now: Instant) -> None:
        """Sets factor and upper bound; from a higher speed both decrease at ``_easing_mps2``."""
        limit_mps = now.limit_mps
        bounds = self._bounds
        if bounds.advice_is_over(now):
            bounds.advised = math.inf
        factor, top_mps = self._chosen_factor(limit_mps), self._bound_mps()
        wanted_mps = top_mps if limit_mps is None else min(top_mps, factor * limit_mps)
        if now.speed_mps > wanted_mps + 0.1:
            top_mps = max(wanted_mps, now.speed_mps - self._easing_mps2 * self.step_s)
            if limit_mps is not None:
                factor = max(factor, top_mps / limit_mps)
        if factor != self._factor:
            self._factor = factor
            self.pedals.set_speed_factor(factor)
        if top_mps != self._top_mps:
            self._top_mps = top_mps
            self.pedals.set_top_speed(top_mps)


def takes_back(speed_kmh: float, state: DrivingState) -> bool:
    """Whether a request for a speed asks for nothing but to drive as before: for the limit's or more, and no slower
    than the car."""
    mps = speed_kmh / KMH_PER_MPS
    return mps >= (state.road.limit.mps or FASTEST_MPS) - 0.1 and mps >= state.speed_mps - 0.3


def _too_slow(speed_kmh: float, state: DrivingState) -> str:
    """Why that speed would be dangerous or pointless; empty if it is not."""
    if not speed_kmh >= SLOWEST_REQUEST_KMH:
        return say("{speed} km/h is not a valid speed; to stop, ask to pull over", speed=f"{speed_kmh:g}")
    limit_mps = state.road.limit.mps
    fast_kmh = (limit_mps or 130 / KMH_PER_MPS) * KMH_PER_MPS
    is_crawling = state.road.road_class in FAST_ROADS and speed_kmh < fast_kmh / 2
    if is_crawling and state.around.relative_speed > SLOW_TRAFFIC:
        return say(
            "{speed} km/h is dangerous where traffic drives {others}",
            speed=f"{speed_kmh:g}",
            others=f"{fast_kmh:.0f}",
        )
    return ""
