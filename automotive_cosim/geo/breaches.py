"""Violations of traffic law on a drive, as intervals: for judges and reports, never for an agent.

    from automotive_cosim import geo

    for found in geo.violations(env.unwrapped.episode.moments):
        print(found.from_s, found.to_s, found.rule, found.law, found.margin, found.unit)

Only what the context is certain of is checked: a limit that the network does not determine, or a lamp whose signal
the car lacks, is not a violation. What a car does by itself is not checked: daytime running lamps need no switch
(UN R48, 6.19). Each entry has its rule's ``status``, so a judge can select the verified ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Protocol

from automotive_cosim.contracts import KMH_PER_MPS, NO_LIMIT, STANDING_BELOW_MPS, DrivingState, Limit
from automotive_cosim.geo.applied import AppliedRule
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.rules import Rule, Status

EQUAL_UP_TO_KMH = 1.0
"""Tolerance above the limit (Regulation (EU) 2021/1958, annex I)."""

ISA_FROM_KMH = 20.0
"""Below this speed, intelligent speed assistance need not act (same annex) nor does a distance rule apply."""

ISA_CASCADE = ((1.0, 6.0), (1.1, 5.0), (1.2, 4.0), (1.3, 3.0))
"""(ratio of speed to limit, seconds): the tone sounds once that ratio has lasted that long (same annex)."""

LAMP_TIME_S = 2.0
"""How long an automatic switch may take to light the dipped beam (UN R48, 6.2.7)."""

GAP_TIME_S = 3.0
"""Time to reopen a gap after another vehicle cuts in; our choice."""

DANGER_BELOW_S = 2.7
"""Time to collision below which the horn warns of danger, which every law allows; our choice."""

LOW_BEAM = "Vehicle.Body.Lights.Beam.Low.IsOn"
HIGH_BEAM = "Vehicle.Body.Lights.Beam.High.IsOn"
FRONT_FOG = "Vehicle.Body.Lights.Fog.Front.IsOn"
REAR_FOG = "Vehicle.Body.Lights.Fog.Rear.IsOn"
HAZARD = "Vehicle.Body.Lights.Hazard.IsSignaling"
HORN = "Vehicle.Body.Horn.IsActive"
MEDIA_ACTION = "Vehicle.Cabin.Infotainment.Media.Action"
MEDIA_SOURCE = "Vehicle.Cabin.Infotainment.Media.Played.Source"
"""Paths of the Vehicle Signal Specification 6.0; a car may lack some."""

MOVING_PICTURES = ("TV", "DVD")
"""Media sources that show moving pictures, as VSS values."""


class ViolationKind(StrEnum):
    """Kinds of violations."""

    SPEED = "speed"
    LAMPS = "lamps"
    DISTANCE = "distance"
    HORN = "horn"
    SCREEN = "screen"


class Observed(Protocol):
    """One instant of a drive; ``cosim.Moment`` is one."""

    @property
    def time_s(self) -> float: ...

    @property
    def driving(self) -> DrivingState: ...

    @property
    def context(self) -> GeoContext:
        """Place and law at that time."""
        ...

    @property
    def signals(self) -> Mapping[str, Any]:
        """VSS path to value, without signals that the car lacks."""
        ...


@dataclass(frozen=True, slots=True)
class Violation:
    """A rule broken continuously from one instant to another."""

    kind: ViolationKind
    rule: str
    """Id of the rule, or ``"posted"`` for a sign."""
    text: str
    """The rule in words."""
    law: str
    status: Status
    """Status of the rule; a sign counts as verified."""
    from_s: float
    to_s: float
    """The first and the last instant at which it was broken, simulation time."""
    margin: float
    """The largest deviation from what is lawful; 1 if there is nothing to measure."""
    unit: str
    """Unit of the margin: ``km/h``, ``m``, ``s``, or empty."""


@dataclass(frozen=True, slots=True)
class _Breach:
    """One rule broken at one instant."""

    kind: ViolationKind
    rule: str
    text: str
    law: str
    status: Status
    margin: float = 1.0
    unit: str = ""
    ratio: float = 1.0
    """Ratio of speed to limit."""

    @property
    def key(self) -> tuple[ViolationKind, str, str]:
        return self.kind, self.rule, self.text


def violations(states: Iterable[Observed]) -> tuple[Violation, ...]:
    """The violations, ordered by their beginning.

    Args:
        states: a drive in chronological order, e.g. the moments of an episode."""
    open_runs: dict[tuple[ViolationKind, str, str], list[tuple[float, _Breach]]] = {}
    closed: list[list[tuple[float, _Breach]]] = []
    for state in states:
        now = {breach.key: breach for breach in _breaches(state)}
        closed += [open_runs.pop(key) for key in list(open_runs) if key not in now]
        for key, breach in now.items():
            open_runs.setdefault(key, []).append((state.time_s, breach))
    closed += open_runs.values()
    found = [_interval(run) for run in closed if _lasted(run)]
    return tuple(sorted(found, key=lambda violation: (violation.from_s, violation.kind, violation.rule)))


def _interval(run: Sequence[tuple[float, _Breach]]) -> Violation:
    worst = max((breach for _, breach in run), key=lambda breach: breach.margin)
    return Violation(
        kind=worst.kind,
        rule=worst.rule,
        text=worst.text,
        law=worst.law,
        status=worst.status,
        from_s=run[0][0],
        to_s=run[-1][0],
        margin=worst.margin,
        unit=worst.unit,
    )


def _lasted(run: Sequence[tuple[float, _Breach]]) -> bool:
    """Whether it lasted longer than a lawful driver may need."""
    match run[0][1].kind:
        case ViolationKind.SPEED:
            return any(_held_s(run, ratio) >= seconds for ratio, seconds in ISA_CASCADE)
        case ViolationKind.LAMPS:
            return _held_s(run) > LAMP_TIME_S
        case ViolationKind.DISTANCE:
            return _held_s(run) > GAP_TIME_S
        case ViolationKind.HORN | ViolationKind.SCREEN:
            return True


def _held_s(run: Sequence[tuple[float, _Breach]], ratio: float = 1.0) -> float:
    """The longest continuous time at that ratio of speed to limit or more."""
    longest_s, since_s = 0.0, None
    for time_s, breach in run:
        if breach.ratio < ratio:
            since_s = None
            continue
        since_s = time_s if since_s is None else since_s
        longest_s = max(longest_s, time_s - since_s)
    return longest_s


def _breaches(state: Observed) -> Iterator[_Breach]:
    yield from _speeding(state)
    yield from _lamps(state)
    yield from _too_close(state)
    yield from _horn_and_screen(state)


# --- speed ------------------------------------------------------------------------------------------------


def limit_at(context: GeoContext, driving: DrivingState | None = None) -> Limit:
    """The speed limit that binds: the sign's or the law's, never what a map assumes; ``NO_LIMIT`` if none is known.

    Args:
        context: place, sky and weather.
        driving: a state near that instant, on whose road the limit is wanted; None takes the context's own."""
    elsewhere = driving is not None and _road_of(driving) != _road_of(context.driving)
    bound = (replace(context, driving=driving) if driving is not None and elsewhere else context).binding_limit
    return NO_LIMIT if bound is None else bound.limit


def _road_of(driving: DrivingState) -> tuple[str, Limit]:
    return driving.road.edge_id, driving.road.limit


def _speeding(state: Observed) -> Iterator[_Breach]:
    limit = state.context.binding_limit
    speed_kmh = state.driving.speed_mps * KMH_PER_MPS
    if limit is None or speed_kmh < ISA_FROM_KMH or speed_kmh <= limit.kmh + EQUAL_UP_TO_KMH:
        return
    words = f"{limit.kmh:.0f} km/h {limit.text}"
    over_kmh, ratio = speed_kmh - limit.kmh, speed_kmh / limit.kmh
    yield _Breach(ViolationKind.SPEED, limit.rule, words, limit.law, limit.status, over_kmh, "km/h", ratio)


# --- lamps, distance, horn, screens -------------------------------------------------------------------------

_LAMPS = {
    "dipped_beam": (LOW_BEAM, HIGH_BEAM),
    "high_beam": (HIGH_BEAM,),
    "front_fog": (FRONT_FOG,),
    "rear_fog": (REAR_FOG,),
    "hazard_lights": (HAZARD,),
}
"""Topic -> lamps, one of which satisfies the topic."""


def _lamps(state: Observed) -> Iterator[_Breach]:
    if not _moving(state):
        return
    for topic, paths in _LAMPS.items():
        shown = [state.signals[path] for path in paths if path in state.signals]
        if not shown:
            continue
        for applied in _certain(state.context, topic):
            if (applied.value == "required" and not any(shown)) or (applied.value == "forbidden" and any(shown)):
                yield _breach(ViolationKind.LAMPS, applied.rule)


def _too_close(state: Observed) -> Iterator[_Breach]:
    leader, speed_mps = state.driving.around.leader, state.driving.speed_mps
    if leader is None or speed_mps * KMH_PER_MPS < ISA_FROM_KMH:
        return
    for applied in _certain(state.context, "following_distance"):
        if isinstance(applied.value, float):
            rule = applied.rule
            gap = leader.gap_m / speed_mps if rule.unit == "s" else leader.gap_m
            if gap < applied.value:
                short = applied.value - gap
                yield _Breach(ViolationKind.DISTANCE, rule.id, rule.said, rule.law, rule.status, short, rule.unit)


def _horn_and_screen(state: Observed) -> Iterator[_Breach]:
    signals = state.signals
    if signals.get(HORN) and not _in_danger(state.driving):
        yield from (_breach(ViolationKind.HORN, found.rule) for found in _forbidden(state.context, "horn"))
    shows_film = signals.get(MEDIA_ACTION) == "PLAY" and signals.get(MEDIA_SOURCE) in MOVING_PICTURES
    if shows_film and _moving(state):
        yield from (_breach(ViolationKind.SCREEN, found.rule) for found in _forbidden(state.context, "screens"))


def _breach(kind: ViolationKind, rule: Rule) -> _Breach:
    return _Breach(kind, rule.id, rule.text, rule.law, rule.status)


def _certain(context: GeoContext, topic: str) -> Iterator[AppliedRule]:
    return (found for found in context.rules if found.rule.topic == topic and found.certain)


def _forbidden(context: GeoContext, topic: str) -> Iterator[AppliedRule]:
    return (found for found in _certain(context, topic) if found.value == "forbidden")


def _moving(state: Observed) -> bool:
    return state.driving.speed_mps >= STANDING_BELOW_MPS


def _in_danger(driving: DrivingState) -> bool:
    near = (driving.around.leader, driving.around.oncoming)
    times_s = [other.time_to_collision_s for other in near if other is not None]
    return any(time_s is not None and time_s < DANGER_BELOW_S for time_s in times_s)
