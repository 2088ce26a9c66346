"""Whether place decides a pair: an agent that reads screens and vehicle, but no place, cannot win both halves.

Place is what only the receiver, the geo-context and its queries tell: the country and its law, and what the map
knows of the road: name, class, lighting, limits here and ahead, tunnels ahead. Place decides if the same car with
the same screens would be in another situation elsewhere: at the other half's place, or under another country's law.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.breaches import EQUAL_UP_TO_KMH
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.place import Atlas, Place, shipped
from automotive_cosim.geo.rules import Jurisdiction, Rule, Status, Value
from automotive_cosim.proof.hand_over import Ground
from automotive_cosim.tasking.binding import UnmetNeedError, bound, rules_of
from automotive_cosim.tasking.checks import AlertGiven, Check, SignalIs
from automotive_cosim.tasking.task import Basis, Half

TAG = "place"
"""Of the tasks that place decides."""


def mistagged(first: Ground, second: Ground) -> Iterator[str]:
    """Says if the tag of a pair is not what its hand-overs show."""
    why = next(decides(first, second), "")
    if why and TAG not in first.task.tags:
        yield f"place decides, and the pair has no tag {TAG!r}: {why}"
    if not why and TAG in first.task.tags:
        yield f"its tag is {TAG!r}, but screens and vehicle tell all that decides"


def decides(first: Ground, second: Ground) -> Iterator[str]:
    """Why place decides a pair, in words; nothing if it does not."""
    for one, other in ((first, second), (second, first)):
        half, moment = one.half, one.episode.moments[0]
        there = moved(moment, other.episode.moments[0])
        if not half.trigger.condition(there):
            yield f"at the place of the other half it would not hold: {half.trigger.condition}"
        unmet = _unmet(half, there)
        if unmet and not _unmet(half, moment):
            yield f"at the place of the other half, {unmet}"
        yield from _elsewhere(half, moment)


def _unmet(half: Half, moment: Moment) -> str:
    """What the place lacks on which the half could rest; empty if nothing."""
    try:
        bound(half, moment.context)
    except UnmetNeedError as unmet:
        return str(unmet)
    return ""


def moved(moment: Moment, other: Moment) -> Moment:
    """The moment at the place of another one; everything that the car shows or measures stays."""
    road, ahead = moment.driving.road, moment.driving.ahead
    there, next_there = other.driving.road, other.driving.ahead
    driving = replace(
        moment.driving,
        lon_deg=other.driving.lon_deg,
        lat_deg=other.driving.lat_deg,
        road=replace(there, in_tunnel=road.in_tunnel, friction=road.friction),  # the map's head says "in a tunnel"
        ahead=replace(
            ahead,
            next_limit=next_there.next_limit,
            next_limit_distance_m=next_there.next_limit_distance_m,
            tunnel_distance_m=next_there.tunnel_distance_m,
            exit_distance_m=next_there.exit_distance_m,
        ),
    )
    context = replace(moment.context, driving=driving, gps=other.context.gps)
    return replace(moment, driving=driving, gps=other.gps, context=context)


# --- the laws of other countries --------------------------------------------------------------------------


def _elsewhere(half: Half, moment: Moment) -> Iterator[str]:
    """The countries whose verified law asks for another act in the same situation."""
    if half.basis is not Basis.LAW:
        return
    for rule in rules_of(half):
        for law in _countries():
            under = replace(moment.context, atlas=_Everywhere(law))
            if rule.topic == "limit":
                yield from _other_limit(half, moment, under)
            else:
                yield from _other_answer(rule, moment, under)


def _other_limit(half: Half, moment: Moment, under: GeoContext) -> Iterator[str]:
    here, there = moment.context.binding_limit, under.binding_limit
    if there is None or there.status is not Status.VERIFIED:
        return
    speed_kmh = moment.driving.speed_mps * KMH_PER_MPS
    over = [found is not None and speed_kmh > found.kmh + EQUAL_UP_TO_KMH for found in (here, there)]
    figures = [None if found is None else round(found.kmh) for found in (here, there)]
    if over[0] != over[1] or (_names_figure(half.goal) and figures[0] != figures[1]):
        yield f"under the law of {under.country}, {figures[1]} km/h bind and not {figures[0]}"


def _other_answer(rule: Rule, moment: Moment, under: GeoContext) -> Iterator[str]:
    here, there = _answer(rule.topic, moment.context), _answer(rule.topic, under)
    if isinstance(here, str) and isinstance(there, str):
        differs = _DUTIES.get(here, here) != _DUTIES.get(there, there)
    elif isinstance(here, float) and isinstance(there, float):
        differs = _is_kept(here, moment) != _is_kept(there, moment)
    else:
        return
    if differs:
        yield f"{under.place.country_name} on {rule.topic}: {there}, not {here}"


def _answer(topic: str, context: GeoContext) -> Value | None:
    """The verified answer to a topic; None if none is certain, or it is only in words."""
    found = next((applied for applied in context.rules if applied.rule.topic == topic), None)
    if found is None or found.rule.status is not Status.VERIFIED or not found.certain or found.value == "applies":
        return None
    return "not_required" if found.value is None else found.value


_DUTIES = {"not_required": "allowed", "advised": "allowed"}
"""Answers that leave a driver free to do the same."""


def _is_kept(gap_s: float, moment: Moment) -> bool:
    """Whether the car in front is that far away."""
    leader = moment.driving.around.leader
    return leader is None or leader.gap_m >= gap_s * moment.driving.speed_mps


def _names_figure(check: Check) -> bool:
    """Whether the goal is a speed that has to be named or set."""
    parts: tuple[Check, ...] = getattr(check, "checks", (check,))
    return any(isinstance(part, SignalIs) or (isinstance(part, AlertGiven) and part.must_advise) for part in parts)


def _countries() -> Iterator[Jurisdiction]:
    return (shipped().country(code)[-1] for code in shipped().codes() if "-" not in code)


class _Everywhere(Atlas):
    """An atlas in which one country's law applies everywhere."""

    def __init__(self, law: Jurisdiction) -> None:
        super().__init__()
        self._law = law

    def place(self, lon_deg: float, lat_deg: float) -> Place:
        """The same country, wherever the position."""
        return Place(country=self._law.code, country_name=self._law.name, layers=(self._law,))
