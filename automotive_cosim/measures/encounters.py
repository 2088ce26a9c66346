"""Encounters of vehicles, from their positions alone: who follows, merges with, crosses or meets whom, how closely.

Vehicles are taken to go straight on at their present speed, as in SSAM. Along a bend one who follows is therefore
seen late; measures against the vehicles in front and behind along the road are in ``following``. Between the steps
nothing is known: a value is right to one step.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from itertools import combinations, pairwise
from math import acos, cos, degrees, hypot, radians, sin
from typing import Any, NamedTuple

import numpy as np

from automotive_cosim.contracts import SeenVehicle
from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.formats.csvs import csv_text
from automotive_cosim.measures.formulas import (
    crossing_drac_mps2,
    crossing_time_to_collision_s,
    delta_v_mps,
    drac_mps2,
    gap_time_s,
    headway_time_s,
    mdrac_mps2,
    required_deceleration_mps2,
    swept_pet_s,
    time_exposed,
    time_to_collision_s,
)
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS, Thresholds

ONCOMING_ABOVE_DEG = 150.0
"""Angle between headings above which vehicles meet head on; our choice, the mirror image of following."""
LONGEST_PET_S = 5.0
"""A longer time is not a conflict (SSAM's default)."""
CREEPING_MPS = 0.5
"""Minimum speed in the PET, so that passages stay finite."""
MASSES_KG = {
    "passenger": 1500.0, "taxi": 1500.0, "bus": 12000.0, "coach": 25000.0, "delivery": 5000.0, "truck": 4500.0,
    "trailer": 13000.0, "emergency": 5000.0, "motorcycle": 200.0, "moped": 80.0, "bicycle": 10.0,
    "pedestrian": 70.0, "tram": 37900.0,
}  # fmt: skip
"""Masses of SUMO's vehicle classes (defaults of SUMO 1.28); any other has that of a passenger car."""

RoadScene = tuple[float, Sequence[SeenVehicle]]
"""Simulation time, and every vehicle then."""
_Headed = tuple[SeenVehicle, float, float]
"""A vehicle and its direction: east and north of a step of 1."""


class EncounterKind(StrEnum):
    """How two vehicles meet."""

    FOLLOWING = "following"
    MERGING = "merging"
    CROSSING = "crossing"
    ONCOMING = "oncoming"


class PairOrder(StrEnum):
    """Whether a vehicle is in front or behind, or at the point of crossing first or second."""

    LEADS = "leads"
    FOLLOWS = "follows"
    MEETS = "meets"


class PairReading(NamedTuple):
    """Two vehicles at one instant. A measure that does not apply is None.

    A named tuple, as there are many and one is made in a fifth of the time of a frozen dataclass."""

    time_s: float
    vehicle: str
    other: str
    kind: EncounterKind
    order: PairOrder
    """Of ``vehicle``."""
    gap_m: float
    """From bumper to bumper; in a crossing, from the second's front to the point."""
    ttc_s: float | None
    drac_mps2: float | None
    mdrac_mps2: float | None
    required_mps2: float | None
    """Deceleration required of the one behind if the leader goes on braking as it does."""
    gap_time_s: float | None
    headway_time_s: float | None
    delta_v_mps: float
    """Of ``vehicle``, if they collided as they are."""

    def is_critical(self, thresholds: Thresholds) -> bool:
        """Whether a measure is beyond its threshold."""
        return (
            (self.ttc_s is not None and self.ttc_s <= thresholds.ttc_s)
            or (self.drac_mps2 is not None and self.drac_mps2 >= thresholds.drac_mps2)
            or (self.mdrac_mps2 is not None and self.mdrac_mps2 >= thresholds.mdrac_mps2)
        )


@dataclass(frozen=True, slots=True)
class Encounter:
    """Two vehicles from the first critical reading to the last."""

    vehicle: str
    other: str
    kind: EncounterKind
    """When the TTC was least."""
    order: PairOrder
    begins_s: float
    ends_s: float
    min_ttc_s: float | None = None
    max_drac_mps2: float | None = None
    max_mdrac_mps2: float | None = None
    max_required_mps2: float | None = None
    min_gap_time_s: float | None = None
    min_headway_time_s: float | None = None
    tet_s: float = 0.0
    tit_s2: float = 0.0
    delta_v_mps: float | None = None
    """When the TTC was least."""
    pet_s: float | None = None
    """At the point where the paths cross."""
    pet_swept_s: float | None = None
    """The same by swept area."""


def pair_readings(
    scenes: Iterable[RoadScene], ego: str | None = "ego", thresholds: Thresholds = DEFAULT_THRESHOLDS
) -> Iterator[PairReading]:
    """Every pair of vehicles in range that follow, merge, cross or meet, at every instant.

    Args:
        scenes: every instant, in order.
        ego: only pairs with this vehicle; None for all pairs.
        thresholds: range, angles and reaction time."""
    before: RoadScene | None = None
    for scene in scenes:
        time_s, vehicles = scene
        brakes = _Brakes(before, time_s)
        for mine, other in _close_pairs(vehicles, ego, thresholds.range_m):
            found = _reading(time_s, mine, other, brakes, thresholds)
            if found is not None:
                yield found
        before = scene


def encounters(
    scenes: Iterable[RoadScene], ego: str | None = "ego", thresholds: Thresholds = DEFAULT_THRESHOLDS
) -> tuple[Encounter, ...]:
    """The critical encounters, in the order in which they begin; arguments as in ``pair_readings``."""
    kept = tuple(scenes)
    series: dict[tuple[str, str], list[PairReading]] = defaultdict(list)
    for reading in pair_readings(kept, ego, thresholds):
        series[reading.vehicle, reading.other].append(reading)
    found = [each for readings in series.values() for each in _joined(readings, thresholds)]
    for crossing in _crossings(kept, ego, thresholds):
        near = next((n for n, each in enumerate(found) if _same(each, crossing)), None)
        if near is None:
            found.append(crossing)
        else:
            found[near] = replace(found[near], pet_s=crossing.pet_s, pet_swept_s=crossing.pet_swept_s)
    return tuple(sorted(found, key=lambda each: (each.begins_s, each.vehicle, each.other)))


def as_csv(
    rows: Sequence[Encounter] | Sequence[PairReading],
    kind: type[Encounter] | type[PairReading],
    trials: Sequence[str] | None = None,
) -> str:
    """The rows as a table with a column for each field; what is None is empty.

    Args:
        rows: encounters or readings.
        trials: the trial of each row, for a first column; None if they are all of one."""
    names = _names(kind)
    lines = (
        [*(trials or ())[number : number + 1], *(_plain(getattr(row, name)) for name in names)]
        for number, row in enumerate(rows)
    )
    return csv_text([*_heads(trials), *names], lines)


def _heads(trials: Sequence[str] | None) -> list[str]:
    return [] if trials is None else ["trial"]


def _names(kind: type[Encounter] | type[PairReading]) -> list[str]:
    return list(PairReading._fields) if kind is PairReading else [entry.name for entry in fields(Encounter)]


def as_frame(
    rows: Sequence[Encounter] | Sequence[PairReading],
    kind: type[Encounter] | type[PairReading],
    trials: Sequence[str] | None = None,
) -> Any:
    """The same as a pandas data frame; what is None is missing, and trials, kinds and orders are texts.

    Raises SetupError: pandas is not installed."""
    try:
        import pandas as pd
    except ImportError as missing:
        raise SetupError(f"data frames need pandas: {install_hint('reports')}") from missing
    names = _names(kind)
    texts = {"trial", "vehicle", "other", "kind", "order"}
    table = [
        [
            *(trials or ())[number : number + 1],
            *(str(value) if isinstance(value := getattr(row, name), StrEnum) else value for name in names),
        ]
        for number, row in enumerate(rows)
    ]
    columns = [*_heads(trials), *names]
    return pd.DataFrame(table, columns=columns).astype(
        {name: "str" if name in texts else "Float64" for name in columns}
    )


# --- one instant ---------------------------------------------------------------------------------------------


def _close_pairs(
    vehicles: Sequence[SeenVehicle], ego: str | None, range_m: float
) -> Iterator[tuple[_Headed, _Headed]]:
    """The pairs in range, with directions."""
    if ego is None:
        places = np.array([(each.x_m, each.y_m) for each in vehicles]).reshape(-1, 2)
        apart = places[:, None, :] - places[None, :, :]
        ones, others = np.nonzero(np.triu((apart**2).sum(axis=2) <= range_m**2, 1))
        headed = [_headed(each) for each in vehicles]
        yield from ((headed[one], headed[other]) for one, other in zip(ones.tolist(), others.tolist(), strict=True))
        return
    mine = next((each for each in vehicles if each.vehicle_id == ego), None)
    if mine is None:
        return
    x_m, y_m, most_m2, own = mine.x_m, mine.y_m, range_m**2, _headed(mine)
    for each in vehicles:
        if (each.x_m - x_m) ** 2 + (each.y_m - y_m) ** 2 <= most_m2 and each is not mine:
            yield own, _headed(each)


def _headed(vehicle: SeenVehicle) -> _Headed:
    heading = radians(vehicle.heading_deg)
    return vehicle, sin(heading), cos(heading)


class _Brakes:
    """How hard vehicles brake at an instant; looked up for the few that lead."""

    __slots__ = ("_before", "_speeds_mps", "_time_s")

    def __init__(self, before: RoadScene | None, time_s: float) -> None:
        self._before, self._time_s = before, time_s
        self._speeds_mps: dict[str, float] | None = None

    def of(self, vehicle: SeenVehicle) -> float:
        """Deceleration since the instant before, at least 0."""
        if self._before is None or self._time_s <= self._before[0]:
            return 0.0
        if self._speeds_mps is None:
            self._speeds_mps = {each.vehicle_id: each.speed_mps for each in self._before[1]}
        was_mps = self._speeds_mps.get(vehicle.vehicle_id, 0.0)
        return max(0.0, (was_mps - vehicle.speed_mps) / (self._time_s - self._before[0]))


def _reading(
    time_s: float, mine: _Headed, theirs: _Headed, brakes: _Brakes, thresholds: Thresholds
) -> PairReading | None:
    angle_deg = abs((mine[0].heading_deg - theirs[0].heading_deg + 180) % 360 - 180)
    if angle_deg < thresholds.following_below_deg:
        return _following(time_s, mine, theirs, brakes, thresholds)
    if angle_deg > ONCOMING_ABOVE_DEG:
        return _oncoming(time_s, mine, theirs, thresholds)
    kind = EncounterKind.CROSSING if angle_deg > thresholds.crossing_above_deg else EncounterKind.MERGING
    return _crossing(time_s, mine, theirs, kind)


def _following(
    time_s: float, mine: _Headed, theirs: _Headed, brakes: _Brakes, thresholds: Thresholds
) -> PairReading | None:
    vehicle, east, north = mine
    other = theirs[0]
    is_behind = (other.x_m - vehicle.x_m) * east + (other.y_m - vehicle.y_m) * north >= 0
    (back, east, north), (front, front_east, front_north) = (mine, theirs) if is_behind else (theirs, mine)
    dx_m = front.x_m - front.length_m * front_east - back.x_m
    dy_m = front.y_m - front.length_m * front_north - back.y_m
    along_m = dx_m * east + dy_m * north
    if abs(dx_m * north - dy_m * east) >= (back.width_m + front.width_m) / 2 or along_m <= -front.length_m:
        return None
    gap_m, closing_mps = max(0.0, along_m), back.speed_mps - front.speed_mps
    return PairReading(
        time_s,
        vehicle.vehicle_id,
        other.vehicle_id,
        EncounterKind.FOLLOWING,
        PairOrder.FOLLOWS if is_behind else PairOrder.LEADS,
        gap_m,
        time_to_collision_s(gap_m, closing_mps),
        drac_mps2(gap_m, closing_mps),
        mdrac_mps2(gap_m, closing_mps, thresholds.reaction_s),
        required_deceleration_mps2(gap_m, back.speed_mps, front.speed_mps, brakes.of(front)),
        gap_time_s(gap_m, back.speed_mps),
        headway_time_s(gap_m, front.length_m, back.speed_mps),
        _delta_v(mine, theirs),
    )


def _oncoming(time_s: float, mine: _Headed, theirs: _Headed, thresholds: Thresholds) -> PairReading | None:
    (vehicle, east, north), other = mine, theirs[0]
    dx_m, dy_m = other.x_m - vehicle.x_m, other.y_m - vehicle.y_m
    gap_m, aside_m = dx_m * east + dy_m * north, abs(dx_m * north - dy_m * east)
    if gap_m <= 0 or aside_m >= (vehicle.width_m + other.width_m) / 2:
        return None
    closing_mps = vehicle.speed_mps + other.speed_mps
    return PairReading(
        time_s,
        vehicle.vehicle_id,
        other.vehicle_id,
        EncounterKind.ONCOMING,
        PairOrder.MEETS,
        gap_m,
        time_to_collision_s(gap_m, closing_mps),
        drac_mps2(gap_m, closing_mps),
        mdrac_mps2(gap_m, closing_mps, thresholds.reaction_s),
        None,
        None,
        None,
        _delta_v(mine, theirs),
    )


def _crossing(time_s: float, mine: _Headed, theirs: _Headed, kind: EncounterKind) -> PairReading | None:
    """Two whose straight paths cross ahead of both, or on which one of them is already."""
    (vehicle, ax, ay), (other, bx, by) = mine, theirs
    if vehicle.speed_mps <= 0 or other.speed_mps <= 0:
        return None
    dx_m, dy_m = other.x_m - vehicle.x_m, other.y_m - vehicle.y_m
    turn = ax * by - ay * bx
    mine_m, theirs_m = (dx_m * by - dy_m * bx) / turn, (dx_m * ay - dy_m * ax) / turn
    is_first = mine_m / vehicle.speed_mps <= theirs_m / other.speed_mps
    first, second, first_m, second_m = (
        (vehicle, other, mine_m, theirs_m) if is_first else (other, vehicle, theirs_m, mine_m)
    )
    if second_m < 0 or first_m < -first.length_m:
        return None
    leaves_s = (first_m + first.length_m) / first.speed_mps
    ttc_s = crossing_time_to_collision_s((first_m, first.speed_mps), (second_m, second.speed_mps), first.length_m)
    if ttc_s is None:
        return None
    needed_mps2 = crossing_drac_mps2(second_m, second.speed_mps, leaves_s)
    return PairReading(
        time_s,
        vehicle.vehicle_id,
        other.vehicle_id,
        kind,
        PairOrder.LEADS if is_first else PairOrder.FOLLOWS,
        second_m,
        ttc_s,
        needed_mps2,
        None,
        needed_mps2,
        None,
        None,
        _delta_v(mine, theirs),
    )


def _delta_v(mine: _Headed, theirs: _Headed) -> float:
    (vehicle, ax, ay), (other, bx, by) = mine, theirs
    passenger_kg = MASSES_KG["passenger"]
    return delta_v_mps(
        MASSES_KG.get(vehicle.kind, passenger_kg),
        MASSES_KG.get(other.kind, passenger_kg),
        (vehicle.speed_mps * ax, vehicle.speed_mps * ay),
        (other.speed_mps * bx, other.speed_mps * by),
    )


# --- over time -----------------------------------------------------------------------------------------------


def _joined(readings: Sequence[PairReading], thresholds: Thresholds) -> Iterator[Encounter]:
    """The encounters of a pair: critical readings with short breaks between them."""
    critical = [reading for reading in readings if reading.is_critical(thresholds)]
    if not critical:
        return
    spans = [[critical[0].time_s, critical[0].time_s]]
    for before, now in pairwise(critical):
        if now.time_s - before.time_s < thresholds.joins_s:
            spans[-1][1] = now.time_s
        else:
            spans.append([now.time_s, now.time_s])
    for begins_s, ends_s in spans:
        yield _summed(begins_s, ends_s, readings, thresholds)


def _summed(begins_s: float, ends_s: float, readings: Sequence[PairReading], thresholds: Thresholds) -> Encounter:
    inside = [reading for reading in readings if begins_s <= reading.time_s <= ends_s]
    before = [reading for reading in readings if reading.time_s < begins_s][-1:]
    nearest = min(inside, key=lambda reading: float("inf") if reading.ttc_s is None else reading.ttc_s)
    tet_s, tit_s2 = time_exposed([(each.time_s, each.ttc_s) for each in (*before, *inside)], thresholds.ttc_s)

    def least(name: str) -> float | None:
        return min((value for each in inside if (value := getattr(each, name)) is not None), default=None)

    def most(name: str) -> float | None:
        return max((value for each in inside if (value := getattr(each, name)) is not None), default=None)

    return Encounter(
        nearest.vehicle,
        nearest.other,
        nearest.kind,
        nearest.order,
        begins_s,
        ends_s,
        min_ttc_s=least("ttc_s"),
        max_drac_mps2=most("drac_mps2"),
        max_mdrac_mps2=most("mdrac_mps2"),
        max_required_mps2=most("required_mps2"),
        min_gap_time_s=least("gap_time_s"),
        min_headway_time_s=least("headway_time_s"),
        tet_s=tet_s,
        tit_s2=tit_s2,
        delta_v_mps=nearest.delta_v_mps,
    )


@dataclass(slots=True)
class _DrivenPath:
    """The way of one vehicle's front bumper."""

    vehicle: SeenVehicle
    times_s: list[float]
    points_m: list[tuple[float, float]]
    ways_m: list[float]
    """Driven since the first point."""

    def passes_s(self, way_m: float) -> float:
        """When it has driven so far; beyond its end at its last speed."""
        index = bisect_left(self.ways_m, way_m)
        if 0 < index < len(self.ways_m):
            share = (way_m - self.ways_m[index - 1]) / (self.ways_m[index] - self.ways_m[index - 1])
            return self.times_s[index - 1] + share * (self.times_s[index] - self.times_s[index - 1])
        if index == 0:
            return self.times_s[0]
        return self.times_s[-1] + (way_m - self.ways_m[-1]) / max(CREEPING_MPS, self.vehicle.speed_mps)

    def speed_mps(self, way_m: float) -> float:
        ahead = self.passes_s(way_m + 1.0) - self.passes_s(way_m)
        return 1.0 / ahead if ahead > 0 else max(CREEPING_MPS, self.vehicle.speed_mps)


def _crossings(scenes: Sequence[RoadScene], ego: str | None, thresholds: Thresholds) -> Iterator[Encounter]:
    """The crossings of paths within the threshold of the PET."""
    tracks: dict[str, _DrivenPath] = {}
    for time_s, vehicles in scenes:
        for each in vehicles:
            track = tracks.get(each.vehicle_id)
            if track is None:
                tracks[each.vehicle_id] = _DrivenPath(each, [time_s], [(each.x_m, each.y_m)], [0.0])
                continue
            east, north = track.points_m[-1]
            step_m = hypot(each.x_m - east, each.y_m - north)
            if step_m > 0:
                track.vehicle = each
                track.times_s.append(time_s)
                track.points_m.append((each.x_m, each.y_m))
                track.ways_m.append(track.ways_m[-1] + step_m)
    if ego is None:
        pairs: Iterable[tuple[_DrivenPath, _DrivenPath]] = combinations(tracks.values(), 2)
    elif ego in tracks:
        pairs = ((tracks[ego], other) for name, other in tracks.items() if name != ego)
    else:
        return
    for mine, other in pairs:
        if len(mine.times_s) > 1 and len(other.times_s) > 1:
            yield from _crossed(mine, other, thresholds)


def _crossed(mine: _DrivenPath, other: _DrivenPath, thresholds: Thresholds) -> Iterator[Encounter]:
    for my_m, their_m, angle_deg in _meetings(mine, other, thresholds):
        my_in_s, their_in_s = mine.passes_s(my_m), other.passes_s(their_m)
        my_out_s = mine.passes_s(my_m + mine.vehicle.length_m)
        their_out_s = other.passes_s(their_m + other.vehicle.length_m)
        pet_s, leads = max((their_in_s - my_out_s, True), (my_in_s - their_out_s, False))
        if not 0 <= pet_s <= thresholds.pet_s:
            continue
        (first, first_m), (second, second_m) = ((mine, my_m), (other, their_m))[:: 1 if leads else -1]
        swept_s = swept_pet_s(
            pet_s,
            first.speed_mps(first_m),
            first.vehicle.width_m,
            second.speed_mps(second_m),
            second.vehicle.width_m,
        )
        yield Encounter(
            mine.vehicle.vehicle_id,
            other.vehicle.vehicle_id,
            EncounterKind.CROSSING if angle_deg > thresholds.crossing_above_deg else EncounterKind.MERGING,
            PairOrder.LEADS if leads else PairOrder.FOLLOWS,
            min(my_out_s, their_out_s),
            max(my_in_s, their_in_s),
            pet_s=pet_s,
            pet_swept_s=swept_s,
        )


def _meetings(
    mine: _DrivenPath, other: _DrivenPath, thresholds: Thresholds
) -> Iterator[tuple[float, float, float]]:
    """Where two paths cross at an angle, within some seconds: how far each has driven by then, and the angle."""
    for index in range(1, len(mine.times_s)):
        from_s, to_s = mine.times_s[index - 1] - LONGEST_PET_S, mine.times_s[index] + LONGEST_PET_S
        first = max(1, bisect_left(other.times_s, from_s))
        for there in range(first, len(other.times_s)):
            if other.times_s[there - 1] > to_s:
                break
            found = _cut(*mine.points_m[index - 1 : index + 1], *other.points_m[there - 1 : there + 1])
            if found is None:
                continue
            my_share, their_share, angle_deg = found
            if thresholds.following_below_deg <= angle_deg <= ONCOMING_ABOVE_DEG:
                yield (
                    mine.ways_m[index - 1] + my_share * (mine.ways_m[index] - mine.ways_m[index - 1]),
                    other.ways_m[there - 1] + their_share * (other.ways_m[there] - other.ways_m[there - 1]),
                    angle_deg,
                )


def _cut(
    a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]
) -> tuple[float, float, float] | None:
    """Shares of two segments up to the point where they cross, and the angle between them; None if they do not."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]
    turn = ux * vy - uy * vx
    if turn == 0:
        return None
    dx, dy = c[0] - a[0], c[1] - a[1]
    mine, theirs = (dx * vy - dy * vx) / turn, (dx * uy - dy * ux) / turn
    if not (0 <= mine < 1 and 0 <= theirs < 1):
        return None
    cosine = (ux * vx + uy * vy) / (hypot(ux, uy) * hypot(vx, vy))
    return mine, theirs, degrees(acos(max(-1.0, min(1.0, cosine))))


def _same(one: Encounter, crossing: Encounter) -> bool:
    """Whether a crossing belongs to an encounter of the same pair."""
    return (
        (one.vehicle, one.other) == (crossing.vehicle, crossing.other)
        and one.kind in (EncounterKind.CROSSING, EncounterKind.MERGING)
        and one.begins_s - LONGEST_PET_S <= crossing.begins_s <= one.ends_s + LONGEST_PET_S
    )


def _plain(value: object) -> object:
    return round(value, 3) if isinstance(value, float) else "" if value is None else value
