"""The checks of the law: what counts as broken, from when to when, by how much, and who can see it."""

import itertools
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim import geo
from automotive_cosim.contracts import DrivingState, GpsFix, Limit, LimitSource, OtherVehicle, Weather
from automotive_cosim.geo.breaches import Violation
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo

PARIS, BEAUCE, BERLIN, BEIJING, DUBAI, WALES = (
    (48.873, 2.285),
    (48.2, 1.8),
    (52.52, 13.4),
    (39.9, 116.4),
    (25.2, 55.3),
    (51.48, -3.18),
)
MIDNIGHT = datetime(2026, 10, 5, 23, 45, tzinfo=ZoneInfo("Europe/Paris"))
LOW = "Vehicle.Body.Lights.Beam.Low.IsOn"
HIGH = "Vehicle.Body.Lights.Beam.High.IsOn"
REAR_FOG = "Vehicle.Body.Lights.Fog.Rear.IsOn"
FRONT_FOG = "Vehicle.Body.Lights.Fog.Front.IsOn"
HAZARD = "Vehicle.Body.Lights.Hazard.IsSignaling"
HORN = "Vehicle.Body.Horn.IsActive"
DARK = {LOW: False, HIGH: False}
FILM = {"Vehicle.Cabin.Infotainment.Media.Action": "PLAY", "Vehicle.Cabin.Infotainment.Media.Played.Source": "DVD"}


def posted(kmh: float) -> dict[str, object]:
    return {"limit": Limit(kmh / 3.6, LimitSource.POSTED)}


@dataclass(frozen=True)
class State:
    time_s: float
    driving: DrivingState
    context: GeoContext
    signals: dict[str, Any] = field(default_factory=dict)


@pytest.fixture(scope="module")
def at(locate: Callable[..., GeoContext], drive: Callable[..., DrivingState]) -> Callable[..., State]:
    def make(
        time_s: float,
        kmh: float,
        place: tuple[float, float] = BEAUCE,
        signals: dict[str, Any] | None = None,
        **changes: Any,
    ) -> State:
        sky = {name: changes.pop(name) for name in ("weather", "time") if name in changes}
        changes["speed_mps"] = kmh / 3.6
        return State(time_s, drive(**changes), locate(*place, **sky, **changes), signals or {})

    return make


def found(states: Iterable[State]) -> list[tuple[str, float, float]]:
    return [(violation.rule, violation.from_s, violation.to_s) for violation in geo.violations(states)]


# --- speed ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kmh", "due_s"),
    [(81.0, None), (80 * 1.05, 6), (80 * 1.1, 5), (80 * 1.15, 5), (80 * 1.2, 4), (80 * 1.3, 3), (80 * 1.6, 3)],
)
def test_speeding_counts_after_the_time_of_the_cascade(
    at: Callable[..., State], kmh: float, due_s: int | None
) -> None:
    """6 s over 100 %, 5 s from 110 %, 4 s from 120 %, 3 s from 130 %; 1 km/h above is still equal."""
    states = [at(float(second), kmh, **posted(80)) for second in range(12)]
    first = next((end for end in range(12) if geo.violations(states[: end + 1])), None)
    assert first == due_s
    if due_s is not None:
        (violation,) = geo.violations(states)
        assert (violation.from_s, violation.to_s) == (0.0, 11.0)
        assert (violation.rule, violation.unit) == ("posted", "km/h")
        assert violation.margin == pytest.approx(kmh - 80)


def test_a_dip_below_the_limit_starts_the_clock_again(at: Callable[..., State]) -> None:
    speeds = [*[86.0] * 5, 79.0, *[86.0] * 5]
    assert found(at(float(second), kmh, **posted(80)) for second, kmh in enumerate(speeds)) == []


def test_the_cascade_asks_for_one_ratio_without_a_break(at: Callable[..., State]) -> None:
    """Two seconds over 130 % amid four at 105 %: neither 3 s at the one nor 6 s at the other."""
    speeds = [84.0, 84.0, 106.0, 106.0, 84.0]
    assert found(at(float(second), kmh, **posted(80)) for second, kmh in enumerate(speeds)) == []


def test_two_stretches_are_two_intervals(at: Callable[..., State]) -> None:
    speeds = [*[95.0] * 7, 70.0, 70.0, *[90.0] * 8]
    assert found(at(float(second), kmh, **posted(80)) for second, kmh in enumerate(speeds)) == [
        ("posted", 0.0, 6.0),
        ("posted", 9.0, 16.0),
    ]


def test_a_lower_sign_begins_an_interval_of_its_own(at: Callable[..., State]) -> None:
    states = [at(float(second), 95.0, **posted(80 if second < 8 else 50)) for second in range(16)]
    first, second = geo.violations(states)
    assert (first.from_s, first.to_s, second.from_s, second.to_s) == (0.0, 7.0, 8.0, 15.0)
    assert (first.margin, second.margin) == (pytest.approx(15), pytest.approx(45))


def test_slower_than_20_nothing_is_asked(at: Callable[..., State]) -> None:
    assert found(at(float(second), 19.0, **posted(10)) for second in range(20)) == []


def test_without_a_sign_the_law_is_the_limit_and_names_itself(at: Callable[..., State]) -> None:
    (violation,) = geo.violations([at(float(second), 95.0, built_up=False) for second in range(8)])
    assert (violation.rule, violation.law, violation.status) == (
        "FR.limit.rural",
        "Code de la route R413-2",
        "verified",
    )
    assert violation.margin == pytest.approx(15)


def test_miles_are_miles(at: Callable[..., State]) -> None:
    (violation,) = geo.violations([at(float(second), 50.0, WALES, built_up=True) for second in range(8)])
    assert violation.rule == "GB-WLS.limit.built_up"
    assert violation.margin == pytest.approx(50 - 20 * 1.609344)


@pytest.mark.parametrize(
    "changes",
    [
        {"built_up": None},
        {"place": (40.0, -30.0)},
        {"place": BERLIN, "road_class": "motorway"},
        {"limit": Limit(None, LimitSource.POSTED)},
        {"limit": Limit(50 / 3.6, LimitSource.ASSUMED), "built_up": None},
    ],
)
def test_no_certain_limit_nothing_broken(at: Callable[..., State], changes: dict[str, Any]) -> None:
    assert found(at(float(second), 220.0, **changes) for second in range(20)) == []


def test_fog_lowers_even_signs_and_rain_the_law_only(
    at: Callable[..., State], weather: Callable[..., Weather]
) -> None:
    fog, rain = weather(weather_code=45, visibility=40.0), weather(weather_code=63, precipitation=4.0)
    motorway: dict[str, Any] = {"road_class": "motorway"}

    def rules(**changes: Any) -> set[str]:
        return {rule for rule, *_ in found(at(float(s), 128.0, **motorway, **changes) for s in range(8))}

    assert rules(weather=fog, **posted(130)) == {"FR.limit.visibility"}
    assert rules(weather=rain) == {"FR.limit.motorway.rain"}
    assert rules() == set()


@given(speeds=st.lists(st.floats(0, 60), max_size=40), limit=st.sampled_from([30, 50, 80, 130]))
def test_intervals_lie_within_the_drive_apart_and_in_order(
    at: Callable[..., State], speeds: list[float], limit: int
) -> None:
    states = [at(float(second), mps * 3.6, **posted(limit)) for second, mps in enumerate(speeds)]
    intervals = geo.violations(states)
    for violation in intervals:
        inside = [state for state in states if violation.from_s <= state.time_s <= violation.to_s]
        over = [state.driving.speed_mps * 3.6 - limit for state in inside]
        assert min(over) > 1.0 - 1e-9
        assert violation.margin == pytest.approx(max(over))
        assert violation.to_s - violation.from_s >= 3
    assert all(a.to_s < b.from_s for a, b in itertools.pairwise(intervals))


# --- lamps, distance, horn, screens -------------------------------------------------------------------------


def _steady(at: Callable[..., State], **changes: Any) -> list[Violation]:
    return list(geo.violations([at(float(second), 60.0, **changes) for second in range(8)]))


def test_dark_without_dipped_beam(at: Callable[..., State]) -> None:
    for lamps, broken in ((DARK, True), ({LOW: True, HIGH: False}, False), ({LOW: False, HIGH: True}, False)):
        rules = {violation.rule for violation in _steady(at, time=MIDNIGHT, signals=lamps, built_up=False)}
        assert ("FR.dipped_beam" in rules) is broken
    assert _steady(at, signals=DARK) == []


def test_countries_differ_in_the_rear_fog_lamp(at: Callable[..., State], weather: Callable[..., Weather]) -> None:
    """300 m of fog: allowed in France, forbidden in Germany, where it takes less than 50 m."""
    lamps = {LOW: True, HIGH: False, REAR_FOG: True, FRONT_FOG: False}
    thin, dense = (weather(weather_code=45, visibility=metres) for metres in (300.0, 40.0))
    broken = {
        (name, sky.visibility): [
            v.rule for v in _steady(at, place=place, weather=sky, signals=lamps, **posted(80)) if v.kind == "lamps"
        ]
        for name, place in (("FR", PARIS), ("DE", BERLIN))
        for sky in (thin, dense)
    }
    assert broken[("DE", 300.0)] == ["DE.rear_fog"]
    assert broken[("FR", 300.0)] == broken[("FR", 40.0)] == broken[("DE", 40.0)] == []


def test_lamps_that_fog_requires_in_china(at: Callable[..., State], weather: Callable[..., Weather]) -> None:
    off = {LOW: True, HIGH: False, FRONT_FOG: False, HAZARD: False}
    sky = weather(weather_code=45, visibility=300.0)
    assert {v.rule for v in _steady(at, place=BEIJING, weather=sky, signals=off)} >= {
        "CN.front_fog",
        "CN.hazard_lights",
    }
    on = off | {FRONT_FOG: True, HAZARD: True}
    assert not [v for v in _steady(at, place=BEIJING, weather=sky, signals=on) if v.kind == "lamps"]


def test_hazard_lights_while_moving_in_dubai(at: Callable[..., State]) -> None:
    assert [v.rule for v in _steady(at, place=DUBAI, signals={HAZARD: True})] == ["AE.hazard_lights"]
    standing = [at(float(second), 0.0, DUBAI, {HAZARD: True}) for second in range(8)]
    assert found(standing) == []


def test_high_beam_at_oncoming_traffic_and_not_where_unsure(at: Callable[..., State]) -> None:
    lamps = {LOW: True, HIGH: True}
    dazzle = _steady(at, time=MIDNIGHT, signals=lamps, oncoming_m=150, lit=False, built_up=False)
    assert [v.rule for v in dazzle] == ["FR.high_beam"]
    assert _steady(at, time=MIDNIGHT, signals=lamps, lit=None, built_up=False) == []


def test_a_lamp_has_two_seconds_and_a_missing_one_breaks_nothing(at: Callable[..., State]) -> None:
    rural: dict[str, Any] = {"built_up": False}
    late = [at(float(s), 60.0, signals=DARK if s < 3 else {LOW: True}, time=MIDNIGHT, **rural) for s in range(8)]
    later = [at(float(s), 60.0, signals=DARK if s < 4 else {LOW: True}, time=MIDNIGHT, **rural) for s in range(8)]
    assert found(late) == []
    assert found(later) == [("FR.dipped_beam", 0.0, 3.0)]
    assert _steady(at, time=MIDNIGHT, signals={}) == []


@pytest.mark.parametrize(("gap_m", "kmh", "short_s"), [(20.0, 72.0, 1.0), (41.0, 72.0, None), (5.0, 18.0, None)])
def test_following_by_time_in_france(
    at: Callable[..., State], gap_m: float, kmh: float, short_s: float | None
) -> None:
    """Two seconds (R412-12): 40 m at 72 km/h."""
    intervals = geo.violations([at(float(s), kmh, leader_m=gap_m, **posted(80)) for s in range(8)])
    assert [v.rule for v in intervals] == ([] if short_s is None else ["FR.following_distance"])
    if short_s is not None:
        assert (intervals[0].margin, intervals[0].unit) == (pytest.approx(short_s), "s")
        assert intervals[0].text == "2 s or more to the vehicle ahead"


def test_following_by_metres_on_chinese_motorways(
    at: Callable[..., State], weather: Callable[..., Weather]
) -> None:
    sky = weather(weather_code=45, visibility=150.0)
    lamps = {LOW: True, HIGH: False, FRONT_FOG: True}
    intervals = _steady(
        at, place=BEIJING, weather=sky, signals=lamps, road_class="motorway", leader_m=80, **posted(80)
    )
    assert [(v.rule, v.margin, v.unit) for v in intervals] == [
        ("CN.following_distance.visibility", pytest.approx(20.0), "m")
    ]


def test_the_horn_in_town_unless_there_is_danger(
    at: Callable[..., State], drive: Callable[..., DrivingState]
) -> None:
    honk = at(3.0, 40.0, PARIS, {HORN: True}, built_up=True, **posted(50))
    assert found([honk]) == [("FR.horn", 3.0, 3.0)]
    close = OtherVehicle("child", 8.0, 0.0, 0.8)
    around = honk.driving.around
    danger = drive(speed_mps=40 / 3.6, built_up=True)
    object.__setattr__(danger, "around", type(around)(close, None, None, None, 1.0))
    assert "FR.horn" not in {rule for rule, *_ in found([State(3.0, danger, honk.context, {HORN: True})])}
    assert found([at(3.0, 40.0, BEAUCE, {HORN: True}, built_up=False, **posted(80))]) == []


def test_a_film_while_moving(at: Callable[..., State]) -> None:
    assert [rule for rule, *_ in found([at(0.0, 50.0, signals=FILM, **posted(80))])] == ["FR.screens"]
    assert found([at(0.0, 0.0, signals=FILM, **posted(80))]) == []
    radio = FILM | {"Vehicle.Cabin.Infotainment.Media.Played.Source": "FM"}
    assert found([at(0.0, 50.0, signals=radio, **posted(80))]) == []


def test_nothing_seen_nothing_broken() -> None:
    assert geo.violations([]) == ()


# --- out of sight -------------------------------------------------------------------------------------------


def test_no_line_or_answer_depends_on_what_is_broken(
    geo_: Geo, drive: Callable[..., DrivingState], weather: Callable[..., Weather]
) -> None:
    """Two cars differ in nothing but that one breaks the limit: what they read of law and place is the same."""
    fix = GpsFix(True, 1.8, 48.2, 3.0, 0.0, 90.0)
    noon = datetime(2026, 10, 5, 12, tzinfo=ZoneInfo("Europe/Paris"))
    texts = []
    for kmh in (70.0, 140.0):
        context = geo_.locate(drive(speed_mps=kmh / 3.6, **posted(80)), fix, weather(), noon)
        texts.append([line for line in context.lines if line.source != "motion"])
    assert texts[0] == texts[1]


@pytest.fixture(scope="module")
def geo_(geo: Geo) -> Geo:
    return geo


def _loaded(modules: Sequence[str]) -> str:
    code = f"import sys\nimport {', '.join(modules)}\nprint('automotive_cosim.geo.breaches' in sys.modules)"
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.strip()


@pytest.mark.slow
def test_what_an_agent_can_reach_does_not_even_load_the_checks() -> None:
    reach = ["automotive_cosim.interface.observe", "automotive_cosim.geo.sensor", "automotive_cosim.agents"]
    assert _loaded(reach) == "False"
    assert _loaded(["automotive_cosim.geo.breaches"]) == "True"


def test_no_object_an_agent_holds_leads_to_the_checks(locate: Callable[..., GeoContext]) -> None:
    context = locate(*PARIS)
    names = {name for name in dir(context) if not name.startswith("_")}
    assert not {name for name in names if "violation" in name or "breach" in name}
