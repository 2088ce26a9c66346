"""A family of drives: one place, season and cast of what is staged, and any number of drives by seed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import reduce
from typing import TYPE_CHECKING

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat
from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.contracts import Weather
from automotive_cosim.drives.script import APART_S, LONGEST_S, QUIET_S, SHORTEST_S, DriveScript, Staged
from automotive_cosim.drives.sky import together
from automotive_cosim.drives.staging import (
    AT_SCHOOLS,
    COMES_S,
    OF_WEATHER,
    ONCE,
    SCHOOL_ZONE,
    STAGINGS,
    TAKES_S,
    Setting,
    WeatherSpan,
)
from automotive_cosim.scenarios import WeatherAt
from automotive_cosim.tasking.draws import Draws, Purpose

if TYPE_CHECKING:
    import numpy as np

FIRST_S = 60.0
"""Nothing is staged before: the car is on its way and its glass, lamps and tyres have settled."""
LAST_S = 60.0
"""Nothing comes later than this before the end, so that each deadline lies in the drive."""
SPREAD_S = 25.0
"""How far the time between two stagings is drawn above its minimum."""
PAUSE_S = 60.0
"""It does not stop raining for a shorter time."""
FAN_PCT = 60.0
"""With it and the air conditioning on, the cabin keeps the temperature that is set, in the Gulf and in Kiruna."""
PLACES_APART = 4
"""Stagings from weather to the other half of its kind: three minutes or more, as long as weather stays dense."""
FEWEST, MOST = 4, 8
"""Events that a drive stages, and as many look-alikes."""
IN_FRONT = (Kind.ADULT, Kind.ADULT, Kind.ELDERLY, Kind.OBJECT)
BEHIND = (Kind.ADULT, Kind.ELDERLY, Kind.CHILD, Kind.BABY, Kind.PET, Kind.OBJECT)
"""Who may ride on a front seat and behind, drawn evenly."""
DISTRACTORS = 3
"""Most calls and messages."""


class Season(StrEnum):
    """When in the year, north and south."""

    SUMMER = "summer"
    WINTER = "winter"


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """Draws scripts. Each kind of its cast that is drawn is staged twice, as an event and as a look-alike, in any
    order. What cannot be undone (``staging.ONCE``) comes in addition, in half the drives, and is either at equal
    rates.
    School zones at their hours are events and look-alikes in turn, and the first one is either."""

    id: str
    """Name by which commands refer to it."""
    about: str
    """For human readers, a sentence."""
    season: Season
    scenario: str
    trips: tuple[str, ...]
    """Trips of the scenario, driven in turn; a drive begins with any of them."""
    starts: tuple[str, ...]
    """Local dates and times at departure, one of which is drawn."""
    weather: Weather
    """The usual weather; the drawn one differs by a degree or two."""
    cast: tuple[str, ...]
    """Kinds of events that may be staged (``staging.STAGED``)."""
    driver: str = "average"
    origin: tuple[float, float] | None = None
    """Longitude and latitude that the network is moved to."""
    aboard: tuple[Occupant, ...] | None = None
    """Who is in the car besides the driver; None draws them."""

    def draw(self, seed: int) -> DriveScript:
        rng = Draws(self.id, seed).rng(Purpose.DRIVE)
        kinds = [kind for kind in self.cast if kind in STAGINGS and kind not in ONCE]
        drawn = rng.permutation(len(kinds))[: int(rng.integers(FEWEST, MOST))]
        roles = [(kinds[index], is_lookalike) for index in drawn for is_lookalike in (False, True)]
        once = [kind for kind in self.cast if kind in ONCE]
        if once and rng.random() < 0.5:
            roles.append((once[int(rng.integers(len(once)))], bool(rng.random() < 0.5)))
        order = _order(roles, rng)
        comes_s = [0.0 if is_lookalike else COMES_S.get(kind, 0.0) for kind, is_lookalike in order]
        times_s, quiet_s, end_s = _times_s([TAKES_S.get(kind, 0.0) for kind, _ in order], comes_s, rng)
        is_family = any(kind == "left_behind" for kind, _ in order)
        company = (_in_care if is_family else _company)(rng) if self.aboard is None else self.aboard
        staged = tuple(
            Staged(kind, at_s, lookalike) for (kind, lookalike), at_s in zip(order, times_s, strict=True)
        )
        warmer = round(float(rng.uniform(-1.5, 1.5)), 1)
        weather = replace(self.weather, temperature_2m=round(self.weather.temperature_2m + warmer, 1))
        settings = [Setting(one.at_s, one.is_lookalike, self.driver, weather, rng, company) for one in staged]
        causes = [STAGINGS[one.kind](setting) for one, setting in zip(staged, settings, strict=True)]
        turned = int(rng.integers(len(self.trips)))
        start = self.starts[int(rng.integers(len(self.starts)))]
        arrivals = _arrivals(rng, end_s)
        at_schools = [AT_SCHOOLS[index] for index in rng.permutation(len(AT_SCHOOLS))]
        return DriveScript(
            family=self.id,
            seed=seed,
            scenario=self.scenario,
            trips=self.trips[turned:] + self.trips[:turned],
            duration_s=end_s,
            start=start,
            weather=timeline(weather, [span for each in causes for span in each.weather]),
            origin=self.origin,
            driver=self.driver,
            aboard=company,
            moods=tuple(sorted((mood for each in causes for mood in each.moods), key=lambda mood: mood.at_s)),
            at_schools=tuple(at_schools) if SCHOOL_ZONE in self.cast else (),
            signals={HVAC.AIR_CONDITIONING.path: True, HVAC.FAN_SPEED.path: FAN_PCT},
            halts=tuple(halt for each in causes for halt in each.halts),
            changes=tuple(change for each in causes for change in each.changes),
            arrivals=arrivals,
            incidents=tuple(incident for each in causes for incident in each.incidents),
            driven_s=max(each.driven_s for each in causes),
            staged=staged,
            quiet_s=quiet_s,
        )


def _order(roles: Sequence[tuple[str, bool]], rng: np.random.Generator) -> list[tuple[str, bool]]:
    """Any order in which weather has passed before it is staged as the other half of the same kind.

    There is one for any roles: first one half of each kind, then the other halves in the same order.
    """
    apart = min(PLACES_APART, len(roles) // 2)
    while True:
        order = [roles[index] for index in rng.permutation(len(roles))]
        places = {(kind, half): place for place, (kind, half) in enumerate(order) if kind in OF_WEATHER}
        if all(abs(place - places[kind, not half]) >= apart for (kind, half), place in places.items()):
            return order


def _times_s(
    takes_s: Sequence[float], comes_s: Sequence[float], rng: np.random.Generator
) -> tuple[list[float], tuple[float, float], float]:
    """The times of the stagings, the quiet time among them, and the end.

    Args:
        takes_s: by how much longer than others each staging takes before the next one.
        comes_s: how long each takes until it obliges.
    """
    quiet_before = int(rng.integers(1, len(takes_s)))
    length_s = QUIET_S + float(round(rng.uniform(0, 60)))
    times_s: list[float] = []
    now_s, quiet_s = FIRST_S, (0.0, 0.0)
    for index, longer_s in enumerate(takes_s):
        if index == quiet_before:
            quiet_s = (now_s, now_s + length_s)
            now_s += length_s
        times_s.append(now_s)
        now_s += longer_s + APART_S + float(round(rng.uniform(0, SPREAD_S)))
    came_s = (at_s + after_s for at_s, after_s in zip(times_s, comes_s, strict=True))
    end_s = max(SHORTEST_S, now_s + LAST_S, max(came_s) + LAST_S)
    assert end_s <= LONGEST_S, end_s
    return times_s, quiet_s, end_s


def _company(rng: np.random.Generator) -> tuple[Occupant, ...]:
    """Who rides along: mostly one or two of any kind, all belted but for things."""
    seats = [Seat.PASSENGER, Seat.REAR_LEFT, Seat.REAR_RIGHT]
    drawn = [seats[index] for index in rng.permutation(len(seats))[: int(rng.integers(len(seats) + 1))]]
    return tuple(_occupant(seat, IN_FRONT if seat is Seat.PASSENGER else BEHIND, rng) for seat in sorted(drawn))


def _in_care(rng: np.random.Generator) -> tuple[Occupant, ...]:
    """A child or a pet behind; half of the time something lies beside it."""
    first, second = [(Seat.REAR_LEFT, Seat.REAR_RIGHT)[index] for index in rng.permutation(2)]
    in_care = _occupant(first, tuple(kind for kind in Kind if kind.needs_care), rng)
    thing = (_occupant(second, (Kind.OBJECT,), rng),) if rng.random() < 0.5 else ()
    return (in_care, *thing)


def _occupant(seat: Seat, kinds: Sequence[Kind], rng: np.random.Generator) -> Occupant:
    kind = kinds[int(rng.integers(len(kinds)))]
    asleep = kind is not Kind.OBJECT and seat is not Seat.PASSENGER and bool(rng.random() < 0.3)
    return Occupant(seat, kind, asleep=asleep, belted=kind is not Kind.OBJECT)


def _arrivals(rng: np.random.Generator, end_s: float) -> tuple[Arrival, ...]:
    """Calls and messages that ask nothing of an agent."""
    times_s = sorted(
        float(round(rng.uniform(FIRST_S, end_s - LAST_S))) for _ in range(int(rng.integers(1, DISTRACTORS + 1)))
    )
    return tuple(Arrival("message" if rng.random() < 0.7 else "call", at_s) for at_s in times_s)


def timeline(usual: Weather, weather: Sequence[WeatherSpan]) -> tuple[WeatherAt, ...]:
    """The usual weather and the weather in it; where two overlap, both are there."""
    spans = [_lasting(span, weather) for span in weather]
    edges_s = sorted({0.0, *(span.from_s for span in spans), *(span.to_s for span in spans)})

    def at(time_s: float) -> Weather:
        on = [span.weather for span in spans if span.from_s <= time_s < span.to_s]
        return reduce(together, on) if on else usual

    entries = [WeatherAt(time_s, at(time_s)) for time_s in edges_s]
    return tuple(_changing(entries))


def _lasting(span: WeatherSpan, weather: Sequence[WeatherSpan]) -> WeatherSpan:
    """Rain or snow does not stop for less than a minute: it lasts until it falls again."""
    falls = [other for other in weather if other.weather.precipitation > 0]
    if span not in falls or any(other.from_s <= span.to_s < other.to_s for other in falls):
        return span
    gaps_s = [other.from_s - span.to_s for other in falls]
    return replace(span, to_s=span.to_s + min((gap_s for gap_s in gaps_s if 0 < gap_s < PAUSE_S), default=0.0))


def _changing(entries: Iterable[WeatherAt]) -> Iterable[WeatherAt]:
    before: Weather | None = None
    for entry in entries:
        if entry.weather != before:
            yield entry
        before = entry.weather
