"""Laws over all drive families, without SUMO."""

import json
from collections import Counter
from dataclasses import replace
from datetime import datetime
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat, seated, take_seats
from automotive_cosim.cockpit.signals import ENERGY, Signals, named
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.family import FEWEST, LAST_S, MOST, PAUSE_S, Season
from automotive_cosim.drives.script import (
    APART_S,
    LONGEST_S,
    QUIET_S,
    SHORTEST_S,
    DriveScript,
    read_script,
    script_json,
)
from automotive_cosim.drives.staging import AT_SCHOOLS, COMES_S, ONCE, SCHOOL_ZONE, STAGED, STAGINGS, Setting
from automotive_cosim.errors import UserError
from automotive_cosim.proof.world import implausible
from automotive_cosim.scenarios import load, open_scenario, shipped
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.profiles import PROFILES
from tests.drives.scenes import CLEAR, found, moment

SEEDS = range(12)
EVERY = [pytest.param(family, id=family.id) for family in FAMILIES.values()]


def scripts(family: Any) -> tuple[DriveScript, ...]:
    return tuple(family.draw(seed) for seed in SEEDS)


def test_every_scenario_has_a_drive_in_summer_and_in_winter() -> None:
    assert len(FAMILIES) >= 24
    for scenario in shipped():
        seasons = {family.season for family in FAMILIES.values() if family.scenario == scenario}
        assert seasons == set(Season), scenario


def test_every_staging_is_in_a_cast_and_every_cast_is_of_stagings() -> None:
    assert {kind for family in FAMILIES.values() for kind in family.cast} == STAGED
    for family in FAMILIES.values():
        assert len(set(family.cast)) == len(family.cast) > FEWEST


@pytest.mark.parametrize("family", EVERY)
def test_a_seed_gives_one_drive_and_another_seed_another(family: Any) -> None:
    drawn = scripts(family)
    assert drawn == scripts(family)
    assert len({script_json(script) for script in drawn}) == len(drawn)


@pytest.mark.parametrize("family", EVERY)
def test_a_plan_is_written_and_read(family: Any) -> None:
    for script in scripts(family):
        assert read_script(script_json(script)) == script


@pytest.mark.parametrize("family", EVERY)
def test_what_is_staged_lies_apart_and_leaves_a_quiet_spell(family: Any) -> None:
    for script in scripts(family):
        assert SHORTEST_S <= script.duration_s <= LONGEST_S
        times_s = [one.at_s for one in script.staged]
        assert all(later - earlier >= APART_S for earlier, later in pairwise(times_s))
        assert times_s[-1] <= script.duration_s - APART_S
        for one in script.staged:
            comes_s = 0.0 if one.is_lookalike else COMES_S.get(one.kind, 0.0)
            assert one.at_s + comes_s <= script.duration_s - LAST_S, one
        begins_s, ends_s = script.quiet_s
        assert ends_s - begins_s >= QUIET_S
        assert not any(begins_s <= at_s < ends_s for at_s in times_s)


@pytest.mark.parametrize("family", EVERY)
def test_events_and_look_alikes_come_at_equal_rates(family: Any) -> None:
    for script in scripts(family):
        events = Counter(one.kind for one in script.staged if not one.is_lookalike)
        lookalikes = Counter(one.kind for one in script.staged if one.is_lookalike)
        assert {kind: n for kind, n in events.items() if kind not in ONCE} == {
            kind: n for kind, n in lookalikes.items() if kind not in ONCE
        }
        assert FEWEST <= sum(events.values()) <= MOST


@pytest.mark.parametrize("kind", sorted(ONCE))
def test_what_is_staged_once_is_an_event_as_often_as_a_lookalike(kind: str) -> None:
    drawn = [
        one
        for family in FAMILIES.values()
        for script in scripts(family)
        for one in script.staged
        if one.kind == kind
    ]
    lookalikes = sum(one.is_lookalike for one in drawn)
    assert abs(lookalikes - len(drawn) / 2) < 2 * len(drawn) ** 0.5


def test_school_zones_are_an_event_and_a_lookalike_in_turn_and_either_comes_first() -> None:
    for family in FAMILIES.values():
        drawn = {script.at_schools for script in scripts(family)}
        assert drawn == ({AT_SCHOOLS, AT_SCHOOLS[::-1]} if SCHOOL_ZONE in family.cast else {()})


@pytest.mark.parametrize("family", EVERY)
def test_a_plan_asks_only_for_what_there_is(family: Any) -> None:
    scenario = load(family.scenario)
    for script in scripts(family):
        assert [scenario.trip(name).name for name in script.trips] == list(script.trips)
        assert {script.driver, *(mood.driver for mood in script.moods), *script.at_schools} <= PROFILES.keys()
        assert [mood.at_s for mood in script.moods] == sorted(mood.at_s for mood in script.moods)
        assert script.weather[0].at_s == 0.0
        assert all(here.at_s < there.at_s for here, there in pairwise(script.weather))
        assert all(here.weather != there.weather for here, there in pairwise(script.weather))


@pytest.mark.slow
@pytest.mark.parametrize("family", EVERY)
def test_weather_comes_on_as_it_does(family: Any) -> None:
    """Sight falls by less than two thirds in one step, and it does not stop raining for less than a minute."""
    for script in scripts(family):
        for here, there in pairwise(script.weather):
            assert there.weather.visibility > 0.35 * here.weather.visibility, (script.seed, there)
        dry = [
            there.at_s - here.at_s
            for before, here, there in zip(script.weather, script.weather[1:], script.weather[2:], strict=False)
            if not here.weather.precipitation and before.weather.precipitation and there.weather.precipitation
        ]
        assert not dry or min(dry) >= PAUSE_S


@pytest.mark.parametrize("family", EVERY)
def test_the_weather_is_of_its_place_and_season(family: Any) -> None:
    scenario = open_scenario(family.scenario, origin=family.origin)
    network = network_of(scenario).map
    x_min, y_min, x_max, y_max = network.bounds_m
    lon_deg, lat_deg = GeoReference(network).lon_lat((x_min + x_max) / 2, (y_min + y_max) / 2)
    for script in scripts(family):
        start = datetime.fromisoformat(script.start).replace(tzinfo=scenario.start.tzinfo)
        for entry in script.weather:
            driving = SimpleNamespace(lon_deg=lon_deg, lat_deg=lat_deg)
            moment: Any = SimpleNamespace(weather=entry.weather, driving=driving, local_time=start)
            assert list(implausible(moment)) == [], script.seed


def test_who_is_aboard_is_drawn_planned_and_read_back() -> None:
    company = (Occupant(Seat.REAR_LEFT, Kind.CHILD, asleep=True), Occupant(Seat.REAR_RIGHT, Kind.PET, 24.0))
    script = replace(FAMILIES["grid_june"], aboard=company).draw(0)
    assert read_script(script_json(script)).aboard == company
    assert FAMILIES["grid_june"].draw(0).aboard != company


@pytest.mark.parametrize("family", EVERY)
def test_who_is_aboard_fits_what_is_staged(family: Any) -> None:
    for script in scripts(family):
        seats = [one.seat for one in script.aboard]
        assert len(set(seats)) == len(seats)
        assert Seat.DRIVER not in seats
        parks = [one for one in script.staged if one.kind == "left_behind"]
        assert [halt.at_s for halt in script.halts] == [one.at_s for one in parks]
        if parks:
            assert sum(one.kind.needs_care for one in script.aboard) == 1
            assert not [one for one in script.aboard if one.kind.is_person and not one.kind.needs_care]


def test_every_seat_is_taken_by_everyone_who_may_sit_there() -> None:
    drawn = {
        (one.seat, one.kind) for family in FAMILIES.values() for script in scripts(family) for one in script.aboard
    }
    assert {kind for _, kind in drawn} == set(Kind)
    assert {seat for seat, _ in drawn} == {Seat.PASSENGER, Seat.REAR_LEFT, Seat.REAR_RIGHT}
    assert not {(seat, kind) for seat, kind in drawn if seat is Seat.PASSENGER and kind.needs_care}


def test_one_stays_alone_in_a_parked_car_only_as_an_event() -> None:
    """By the signals that the script sets, second by second of the halt."""
    for family in FAMILIES.values():
        for script in scripts(family):
            for one in script.staged:
                if one.kind == "left_behind":
                    assert any(_is_alone(script, second) for second in range(150)) is not one.is_lookalike, script


def _is_alone(script: DriveScript, second: int) -> bool:
    signals = Signals()
    take_seats(signals, script.aboard)
    for change in sorted((change for change in script.changes if change.once_parked), key=lambda each: each.at_s):
        if change.at_s <= second:
            signals[named(change.path)] = change.value
    return [one.kind.needs_care for one in seated(signals) if one.kind is not Kind.OBJECT] == [True]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"duration_s": 60.0}, "duration_s"),
        ({"trips": []}, "trips"),
        ({"start": "tomorrow"}, "start"),
        ({"speed": 3}, "speed"),
        ({"changes": [{"at_s": 1.0, "path": "Vehicle.Sped", "value": True}]}, "Vehicle.Speed"),
        ({"incidents": [{"kind": "meteor"}]}, "meteor"),
        ({"aboard": [{"seat": "roof", "kind": "pet"}]}, "rear_left"),
        ({"aboard": [{"seat": "passenger", "kind": "ghost"}]}, "elderly"),
        ({"aboard": [{"seat": "passenger", "kind": "adult", "weight_kg": -3}]}, "weight_kg"),
    ],
)
def test_a_wrong_plan_is_refused_in_one_line(change: dict[str, Any], told: str) -> None:
    values = json.loads(script_json(FAMILIES["grid_june"].draw(0))) | change
    with pytest.raises(UserError) as refused:
        read_script(json.dumps(values), "drive.json")
    assert told in str(refused.value)
    assert str(refused.value).startswith("drive.json")
    assert len(str(refused.value).splitlines()) == 1


@pytest.mark.parametrize("text", ["", "[1", "null", "3", '"drive"', "[]"])
def test_what_is_no_plan_is_refused(text: str) -> None:
    with pytest.raises(UserError):
        read_script(text)


@pytest.mark.parametrize("is_lookalike", [True, False])
def test_a_battery_that_runs_low_is_an_event_or_looks_like_one(is_lookalike: bool) -> None:
    setting = Setting(10.0, is_lookalike, "average", CLEAR, np.random.default_rng(0))
    (change,) = STAGINGS["range"](setting).changes
    assert isinstance(change.value, float)
    signals = {change.path: change.value, ENERGY.RANGE.path: 4_000.0 * change.value}
    drive = [moment(float(second), signals=signals, route_left_m=20_000.0) for second in range(10)]
    assert [event.lookalike for event in found(drive, "range")] == [is_lookalike]


@pytest.mark.timeout(30)
def test_a_cast_of_weather_alone_is_drawn():
    """Its halves stand as far apart as so few stagings allow."""
    staged = replace(FAMILIES["grid_january"], cast=("slippery", "wipers")).draw(0).staged
    kinds = [one.kind for one in staged]
    assert sorted(kinds) == ["slippery", "slippery", "wipers", "wipers"]
    assert all(kinds.index(kind) + 2 == 3 - kinds[::-1].index(kind) for kind in set(kinds))
