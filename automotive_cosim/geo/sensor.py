"""The virtual sensor: answers an agent's questions with facts.

    reply = ask("rear fog lamp rules?", moments)     # QueryReply(ok=True, text="Rear fog lamp: ...", cost_s=1.0)

It knows the lines of the geo-context, the road ahead, and the position by dead reckoning while GPS is out. It
states facts; it never says whether a rule is broken nor what to do. Law, customs and position are on board;
weather, traffic and hazards come over the air and require the link.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from automotive_cosim.contracts import Connectivity, DrivingState, IncidentKind, Sight
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.reckoning import Reckonable, Roads, reckon
from automotive_cosim.geo.rules import ASKED, TOPICS
from automotive_cosim.geo.text import amount_of_speed, position
from automotive_cosim.geo.weather import visibility_class

ON_BOARD_S = 1.0
"""Cost of an answer from the car's own data; our choice, as are the next two."""
OVER_THE_AIR_S = {"5g": 2.0, "4g": 3.0}
"""Cost by kind of link."""
NO_LINK_S = 1.0
"""Time until the car stops trying without a link."""

ANSWER_BYTES = 1000
"""Length limit of an answer; the observation space allows a little more."""

CUSTOMS = ("heat", "cold")
INCIDENT_WORDS = {
    IncidentKind.BREAKDOWN: "a broken-down vehicle",
    IncidentKind.ROADWORKS: "roadworks",
    IncidentKind.CLOSURE: "a closed road",
}
"""Incidents in words, besides jams, which have a line of their own, and schools, which the map knows."""


class Known(Reckonable, Protocol):
    """One instant as the sensor knows it; ``cosim.Moment`` is one."""

    @property
    def connectivity(self) -> Connectivity:
        """The car's link."""
        ...

    @property
    def context(self) -> GeoContext:
        """Place and law at that time."""
        ...

    @property
    def sights(self) -> tuple[Sight, ...]:
        """What the car notices by itself."""
        ...


@dataclass(frozen=True, slots=True)
class QueryReply:
    """The result of a query."""

    ok: bool
    """False if no part of it could be answered."""
    text: str
    cost_s: float
    """Simulated seconds that it took, on top of those of the action."""


def ask(text: str, drive: Sequence[Known], *, with_position: bool = True, roads: Roads | None = None) -> QueryReply:
    """Answers a query at the last instant of ``drive``.

    Args:
        drive: the drive so far in chronological order, back to the last fix; at least one instant.
        with_position: whether it may say where the car is.
        roads: the map for dead reckoning, if the car has one."""
    asked = frozenset(re.findall(r"[a-z]+", text.casefold()))
    if "blue" in asked:  # the light of an emergency vehicle is no lamp
        asked -= {"light", "lights"}
    offered = [subject for subject in _SUBJECTS if with_position or subject.answer is not _position]
    topics, subjects = _matched(asked - _WEAK_WORDS, offered)
    if not subjects:
        topics, subjects = _matched(asked, offered)
    if not subjects:
        names = ", ".join(subject.name for subject in offered)
        return QueryReply(False, f"nothing is known of that; there are: {names}", ON_BOARD_S)
    link = drive[-1].connectivity
    lines: list[str] = []
    for subject in subjects:
        if subject.on_board or link.online:
            is_place = subject.answer is _position
            lines += _position(drive, topics, roads) if is_place else subject.answer(drive, topics)
    out_of_reach = [subject.name for subject in subjects if not (subject.on_board or link.online)]
    if out_of_reach:
        lines.append(f"No connection: {', '.join(out_of_reach)} unknown")
    over_the_air = link.online and any(not subject.on_board for subject in subjects)
    cost_s = OVER_THE_AIR_S[link.kind] if over_the_air else ON_BOARD_S
    text = _within(list(dict.fromkeys(lines)))
    return QueryReply(len(out_of_reach) < len(subjects), text, NO_LINK_S if out_of_reach else cost_s)


def _matched(words: frozenset[str], offered: Sequence[_Subject]) -> tuple[frozenset[str], list[_Subject]]:
    """The topics of rules and the subjects that some words ask for."""
    topics = _topics(words)
    if words & _LAMP_WORDS:
        words -= frozenset().union(*_LAMPS.values())
    return topics, [each for each in offered if words & each.words or (each.by_topic and topics)]


def _within(lines: Sequence[str]) -> str:
    """Whole lines, as many as an answer allows, and how many are left."""
    kept: list[str] = []
    left = ANSWER_BYTES - 60
    for line in lines:
        left -= len(line.encode()) + 1
        if left < 0:
            break
        kept.append(line)
    more = len(lines) - len(kept)
    return "\n".join([*kept, f"{more} more; they come when asked for by topic"] if more else kept)


# --- what can be asked ------------------------------------------------------------------------------------

Answering = Callable[[Sequence[Known], frozenset[str]], Iterator[str]]


@dataclass(frozen=True, slots=True)
class _Subject:
    name: str
    words: frozenset[str]
    answer: Answering
    on_board: bool
    by_topic: bool = False
    """Also matched by the word of a rule's topic."""


def _weather(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    return (line.text for line in drive[-1].context.lines if line.source in ("weather", "sky", "climate"))


def _rules(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    """The rules of the topics asked for; all if none is named."""
    context = drive[-1].context
    if not context.place.law:
        yield "Rules: none known here"
    of_rule = {rule.id: rule.topic for layer in context.place.layers for rule in layer.rules}
    found: set[str] = set()
    for line in context.lines:
        topic = of_rule.get(line.source, "limit" if line.source == "road" else "")
        if topic in topics or (topic and not topics and topic not in CUSTOMS):
            found.add(topic)
            yield line.text
    if topics and not found:
        yield f"No rule known here on: {', '.join(TOPICS[topic].casefold() for topic in sorted(topics))}"


def _norms(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    context = drive[-1].context
    customs = {found.rule.id for found in context.rules if found.rule.topic in CUSTOMS}
    lines = [line.text for line in context.lines if line.source == "climate" or line.source in customs]
    yield from lines or ["Customs: none known here"]


def _traffic(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    driving = drive[-1].driving
    ahead = driving.ahead
    yield f"Traffic here: {driving.around.relative_speed:.0%} of the free speed"
    late = f"{ahead.delay_min} min of it delay" if ahead.delay_min else "no delay"
    yield (
        f"Route left: {ahead.route_left_m / 1000:.1f} km, {ahead.eta_s / 60:.0f} min, {late}, "
        f"{ahead.relative_speed:.0%} of the free speed"
    )
    slow = "; the delay is slow traffic that keeps moving" if ahead.delay_min else ""
    yield _jam(driving) or f"Jam on the route: none{slow}"
    yield from _vehicles(driving)
    yield from _incidents(driving)


def _vehicles(driving: DrivingState) -> Iterator[str]:
    around = driving.around
    for name, vehicle in (("Vehicle ahead", around.leader), ("Oncoming vehicle", around.oncoming)):
        yield f"{name}: none in reach" if vehicle is None else f"{name}: {vehicle.gap_m:.0f} m ahead"


def _around(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    return _vehicles(drive[-1].driving)


def _hazards(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    known = drive[-1]
    driving, ahead, context = known.driving, known.driving.ahead, known.context
    blue = driving.around.emergency_behind
    found = [_jam(driving), *_incidents(driving)]
    found.append("Blue light: none in reach" if blue is None else f"Blue light: {blue.gap_m:.0f} m behind")
    found += [sight.text for sight in known.sights if sight.kind.value in INCIDENT_WORDS]
    if context.weather is not None:
        seen = visibility_class(context.weather.visibility).replace("_", " ")
        found.append(f"Visibility: {context.weather.visibility:.0f} m ({seen})")
    if driving.road.in_tunnel:
        found.append("Tunnel: here")
    if ahead.tunnel_distance_m is not None:
        found.append(f"Tunnel: in {ahead.tunnel_distance_m:.0f} m")
    elif not driving.road.in_tunnel:
        found.append("Tunnel: none on the route")
    following, away_m = ahead.next_limit, ahead.next_limit_distance_m
    if following is not None and following.kmh is not None and away_m is not None:
        limit = amount_of_speed(following.kmh, context.speed_unit)
        source = "" if following.is_posted else ", which the map assumes"
        found.append(f"Limit on the route: {limit} in {away_m:.0f} m{source}")
    if driving.road.friction < 1.0:
        found.append(f"Road surface: friction {driving.road.friction:.2f}, dry is 1")
    if context.sun is not None and context.sun.glares(context.heading_deg):
        found.append(f"Sun: {context.sun.elevation_deg:.0f}° above the horizon, ahead")
    yield from filter(None, found)


def _jam(driving: DrivingState) -> str:
    ahead = driving.ahead
    if ahead.jam_distance_m is None:
        return ""
    return f"Jam on the route: in {ahead.jam_distance_m:.0f} m, {ahead.jam_length_m:.0f} m long"


def _incidents(driving: DrivingState) -> Iterator[str]:
    """What live traffic reports on the route, besides jams, and whether on the road that the car is on."""
    road, route = driving.road, frozenset(driving.ahead.route_edges)
    found = dict.fromkeys(
        (one.edge_id == road.edge_id, INCIDENT_WORDS[one.kind], one.position_m - road.lane_position_m)
        for one in driving.ahead.incidents
        if one.edge_id in route | {road.edge_id} and one.kind in INCIDENT_WORDS
    )
    for is_here, words, away_m in found:
        where = f"this road, in {away_m:.0f} m" if away_m > 0 else "this road, here"
        yield f"Reported on {where}: {words}" if is_here else f"Reported further on the route: {words}"
    if not found:
        yield "Reported on the route: nothing" + (" besides the jam" if _jam(driving) else "")


def _units(drive: Sequence[Known], topics: frozenset[str]) -> Iterator[str]:
    unit = drive[-1].context.speed_unit
    yield f"Units on signs here: {unit}, {'miles and yards' if unit == 'mph' else 'kilometres and metres'}"


def _position(drive: Sequence[Known], topics: frozenset[str], roads: Roads | None = None) -> Iterator[str]:
    gps = drive[-1].gps
    if gps is None or gps.has_fix:
        yield next(line.text for line in drive[-1].context.lines if line.source == "gps")
        return
    estimate = reckon(drive, roads)
    assert estimate is not None
    yield (
        f"Position by dead reckoning: {position(estimate.lon_deg, estimate.lat_deg)}, within "
        f"{estimate.accuracy_m:.0f} m ({estimate.driven_m:.0f} m and {estimate.age_s:.0f} s since the last fix)"
    )


def _set(words: str) -> frozenset[str]:
    return frozenset(words.split())


_SUBJECTS = (
    _Subject(
        "hazards",
        _set(
            "hazard hazards danger dangers ahead tunnel blue siren sirens ambulance emergency police roadworks "
            "roadwork works construction closure closed broken breakdown incident incidents accident"
        ),
        _hazards,
        on_board=False,
    ),
    _Subject(
        "vehicles around",
        _set("oncoming vehicle vehicles leader ahead dazzle dazzled dazzling"),
        _around,
        on_board=True,
    ),
    _Subject(
        "traffic",
        _set("traffic jam jams congestion congested queue delay eta route arrival"),
        _traffic,
        on_board=False,
    ),
    _Subject(
        "weather",
        _set("weather temperature rain raining snow snowing fog foggy wind visibility sky sun dark"),
        _weather,
        on_board=False,
    ),
    _Subject(
        "rules",
        _set("rule rules law laws legal regulation regulations allowed forbidden required"),
        _rules,
        on_board=True,
        by_topic=True,
    ),
    _Subject(
        "norms",
        _set("norm norms custom customs customary usual usually habit habits climate people"),
        _norms,
        on_board=True,
    ),
    _Subject(
        "units",
        _set("unit units mph kmh km mile miles kilometre kilometres kilometer kilometers"),
        _units,
        on_board=True,
    ),
    _Subject(
        "position", _set("position where location gps coordinates latitude longitude"), _position, on_board=True
    ),
)
"""What is of the moment is told first: an answer is cut off at its end."""
_WEAK_WORDS = _set("where distance")
"""Words of questions about anything; they name a subject only where no other word does."""

_LAMP_WORDS = _set("lamp lamps light lights headlight headlights beam beams")
_LAMPS = {
    "dipped_beam": _set("dipped low wipers"),
    "daytime_lamps": _set("daytime running"),
    "high_beam": _set("high"),
    "front_fog": _set("front fog"),
    "rear_fog": _set("rear fog"),
    "hazard_lights": _set("hazard"),
}
"""The words that match a rule's topic; those of ``_LAMPS`` count only together with a word for a lamp."""


def _topics(asked: frozenset[str]) -> frozenset[str]:
    found = {topic for topic, words in ASKED.items() if asked & words}
    if asked & _LAMP_WORDS:
        # "rear fog lamp" shares two words with the rear fog lamp's, one with the front one's.
        shared = {topic: len(asked & words) for topic, words in _LAMPS.items()}
        found |= {topic for topic, count in shared.items() if count == max(shared.values())}
    return frozenset(found)
