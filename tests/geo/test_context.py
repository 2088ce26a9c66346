"""The context: from the receiver's place and the road's facts to lines that state and never judge."""

import itertools
import pickle
import random
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from types import SimpleNamespace
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from automotive_cosim.contracts import DrivingState, GpsFix, Limit, LimitSource, Weather
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.rules import TOPICS
from automotive_cosim.geo.text import Line

Locate = Callable[..., GeoContext]
POSTED = {"limit": Limit(50 / 3.6, LimitSource.POSTED)}
PARIS, SEA, TBILISI, NEW_YORK, CARDIFF = (
    (48.873, 2.285),
    (40.0, -30.0),
    (41.72, 44.79),
    (40.75, -73.98),
    (51.48, -3.18),
)
EVERYWHERE = [
    *(PARIS, SEA, TBILISI, NEW_YORK, CARDIFF, (52.52, 13.4), (35.68, 139.76), (-33.87, 151.21), (41.9, 12.5)),
    *((40.42, -3.7), (47.37, 8.54), (59.33, 18.06), (59.91, 10.75), (28.6, 77.2), (39.9, 116.4), (-23.55, -46.63)),
    *((25.2, 55.3), (-26.2, 28.05), (50.85, 4.35), (48.2, 16.37), (52.37, 4.9), (37.57, 126.98), (49.61, 6.13)),
    *((38.72, -9.14), (55.68, 12.57), (52.23, 21.01), (50.09, 14.42), (53.35, -6.26), (45.5, -73.57), (90.0, 0.0)),
]
ROADS = [
    {"road_class": "motorway", "lanes": 3},
    {"road_class": "residential"},
    {"road_class": "trunk", "lane_count": 2, "in_tunnel": True},
    {"road_class": "", "lit": True, "centre_line": False},
]


def _roads() -> list[dict[str, object]]:
    return [{"lane_count" if name == "lanes" else name: value for name, value in road.items()} for road in ROADS]


def test_the_posted_limit_reads_in_the_countrys_unit(locate: Locate) -> None:
    assert "Speed limit here: 50 km/h (posted on Avenue Foch)" in locate(*PARIS, **POSTED).text()
    mph = {"limit": Limit(20 * 0.44704, LimitSource.POSTED), "name": ""}
    assert "Speed limit here: 20 mph (posted on this road)" in locate(*CARDIFF, **mph).text()


def test_an_assumed_limit_is_not_called_posted(locate: Locate) -> None:
    context = locate(*PARIS, limit=Limit(50 / 3.6, LimitSource.ASSUMED))
    assert context.posted_limit_kmh is None
    assert not re.search(r"Speed limit here: \d", context.text())


def test_the_default_limit_names_its_law(locate: Locate) -> None:
    text = locate(48.2, 1.8, built_up=True).text()
    assert "Default limit: 50 km/h in built-up areas (FR Code de la route R413-3, verified 2026-03-31)" in text


def test_where_no_law_is_known_the_text_says_so_and_keeps_the_sign(locate: Locate) -> None:
    for place in (MCMURDO, SEA):
        context = locate(*place, **POSTED)
        assert context.default_limits == context.rules == ()
        assert "Speed limit here: 50 km/h (posted" in context.text()
        assert "Default limit: unknown" in context.text()


def test_without_gps_the_place_is_unknown(
    geo: Geo, drive: Callable[..., DrivingState], weather: Callable[..., Weather]
) -> None:
    context = geo.locate(drive(**POSTED), None, weather(), datetime(2026, 5, 5, 12, tzinfo=UTC))
    assert (context.country, context.sun, context.climate) == ("", None, None)
    assert context.text().startswith("Place: unknown\nPosition: unknown\n")
    assert "Speed limit here: 50 km/h (posted on Avenue Foch)" in context.text()


def test_the_place_is_the_receivers_not_the_truth(
    geo: Geo, drive: Callable[..., DrivingState], weather: Callable[..., Weather]
) -> None:
    in_berlin = GpsFix(False, 13.4, 52.52, 3.0, 12.0, 90.0)
    context = geo.locate(
        drive(lon_deg=2.285, lat_deg=48.873), in_berlin, weather(), datetime(2026, 5, 5, tzinfo=UTC)
    )
    assert context.country == "DE"
    assert "Position: no fix, 12 s ago 52.5200°N 13.4000°E" in context.text()


def test_limit_units_and_lamps_change_at_the_border(locate: Locate) -> None:
    france, germany = locate(48.573, 7.795, built_up=True), locate(48.575, 7.81, built_up=True)
    fog_rules = [context.rule("rear_fog") for context in (france, germany)]
    assert [rule.rule.id for rule in fog_rules if rule] == ["FR.rear_fog", "DE.rear_fog"]
    ireland, ulster = locate(54.95, -7.75, built_up=True), locate(54.997, -7.32, built_up=True)
    assert (ireland.speed_unit, ulster.speed_unit) == ("km/h", "mph")


@pytest.mark.parametrize(
    ("road_class", "network", "expected"),
    [
        ("primary", True, (True, "network")),
        ("residential", False, (False, "network")),
        ("motorway", None, (False, "road class")),
        ("residential", None, (True, "road class")),
    ],
)
def test_built_up_is_the_networks_word_first(
    locate: Locate, road_class: str, network: bool | None, expected: tuple[bool, str]
) -> None:
    context = locate(*PARIS, road_class=road_class, built_up=network)
    assert (context.built_up, context.built_up_source) == expected


def test_built_up_by_place_or_unknown(locate: Locate) -> None:
    assert locate(*PARIS).built_up_source == "place"
    assert locate(48.2, 1.8).built_up is None
    assert "built-up or not: unknown" in locate(48.2, 1.8).text()


def test_reduced_limits_stand_whether_or_not_they_hold(locate: Locate, weather: Callable[..., Weather]) -> None:
    dry = locate(48.2, 1.8, road_class="motorway")
    wet = locate(48.2, 1.8, weather(weather_code=63, precipitation=4.0), road_class="motorway")
    assert [line for line in dry.lines if line.source.startswith("FR.")] == [
        line for line in wet.lines if line.source.startswith("FR.")
    ]
    assert "Reduced limit: 110 km/h on motorways in rain" in dry.text()
    assert [limit.value for limit in dry.reduced_limits] == [None, None]
    assert [limit.value for limit in wet.reduced_limits] == [None, 110]


def test_a_reduced_limit_no_lower_than_the_sign_is_left_out(locate: Locate) -> None:
    assert "Reduced limit" not in locate(*PARIS, **POSTED).text()
    assert "Reduced limit: 50 km/h" in locate(*PARIS, limit=Limit(70 / 3.6, LimitSource.POSTED)).text()


def test_the_sign_ahead_is_named(locate: Locate, drive: Callable[..., DrivingState]) -> None:
    for sign, away_m, line in (
        ("stop", 120.4, "Sign ahead: stop in 120 m"),
        ("give_way", 30.0, "Sign ahead: give way in 30 m"),
        ("stop", 301.0, ""),
        ("", None, ""),
    ):
        ahead = replace(drive().ahead, next_sign=sign, sign_distance_m=away_m)
        text = locate(*PARIS, ahead=ahead).text()
        assert (line in text) if line else "Sign ahead" not in text


@pytest.mark.parametrize("place", EVERYWHERE)
def test_lines_state_and_never_judge(
    locate: Locate, weather: Callable[..., Weather], place: tuple[float, float]
) -> None:
    judging = re.compile(
        r"\b(you|your|should|must|violat\w*|break\w*|broken|too (fast|close|slow)|exceed\w*|over the limit"
        r"|illegal\w*|unlawful\w*|speeding|warn the|slow down|alert\w*|please|now)\b",
        re.IGNORECASE,
    )
    fog = weather(weather_code=45, visibility=40.0)
    for road, speed in itertools.product(_roads(), (0.0, 60.0)):
        for line in locate(*place, fog, speed_mps=speed, **road, **POSTED).lines:
            assert not judging.search(line.text), line
            assert "\n" not in line.text


@pytest.mark.parametrize("place", EVERYWHERE)
def test_every_line_of_law_traces_to_its_rule(geo: Geo, locate: Locate, place: tuple[float, float]) -> None:
    for road in _roads():
        context = locate(*place, **road)
        rules = {rule.id: rule for layer in context.place.layers for rule in layer.rules}
        for line in context.lines:
            if line.source in ("place", "gps", "road", "motion", "sky", "weather", "climate"):
                continue
            rule = rules[line.source]
            assert rule.binds == "car"
            assert rule.law in line.text
            assert f"{rule.status} {rule.as_of}" in line.text


def test_the_law_of_a_place_does_not_follow_the_weather_light_or_speed(
    locate: Locate, weather: Callable[..., Weather]
) -> None:
    night = datetime(2026, 10, 5, 23, tzinfo=ZoneInfo("Europe/Paris"))
    calm = locate(*PARIS, **POSTED)
    wild = locate(*PARIS, weather(weather_code=45, visibility=30.0), night, speed_mps=40.0, leader_m=3.0, **POSTED)
    law = [[line for line in context.lines if "." in line.source] for context in (calm, wild)]
    assert law[0] == law[1]
    assert calm.text() != wild.text()


MCMURDO = (-77.85, 166.67)
"""In Antarctica."""


def _sources(lines: Sequence[Line]) -> set[str]:
    return {line.source for line in lines}


@pytest.mark.parametrize("place", EVERYWHERE)
def test_what_cannot_matter_here_and_now_is_left_to_queries(
    locate: Locate, weather: Callable[..., Weather], place: tuple[float, float]
) -> None:
    for road, sky in itertools.product(_roads(), (weather(), weather(weather_code=45, visibility=60.0))):
        context = locate(*place, sky, **road)
        named = [line.text for line in context.shown if line.text.startswith("Further rules, by query: ")]
        told = [found.rule for found in context.rules if not found.rule.on_request]
        left = [rule for rule in told if rule.id not in _sources(context.shown)]
        assert len(named) == bool(left)
        assert all(TOPICS[rule.topic].casefold() in named[0] for rule in left)
        assert all(line in context.lines for line in context.shown if line.text not in named)


DARMSTADT = (49.87, 8.65)


def test_fog_lamps_are_a_matter_of_fog_and_high_beam_of_the_dark(
    locate: Locate, weather: Callable[..., Weather]
) -> None:
    night = datetime(2026, 10, 5, 23, tzinfo=ZoneInfo("Europe/Berlin"))
    clear = locate(*DARMSTADT, **POSTED)
    fog, dark = (
        locate(*DARMSTADT, weather(weather_code=45, visibility=60.0), **POSTED),
        locate(*DARMSTADT, time=night),
    )
    assert "DE.rear_fog" in _sources(fog.shown) - _sources(clear.shown)
    assert "DE.high_beam" in _sources(dark.shown) - _sources(clear.shown)


def test_the_text_fits_its_budget_and_drops_from_the_end(locate: Locate) -> None:
    context = locate(*PARIS, **POSTED)
    whole = context.text()
    assert whole == "\n".join(line.text for line in context.shown)
    for budget in (0, 50, 120, 400):
        part = context.text(budget)
        assert len(part) <= 4 * budget
        assert whole.startswith(part)


def test_the_default_budget_takes_every_line_there_is(locate: Locate) -> None:
    for place, road in itertools.product(EVERYWHERE, _roads()):
        context = locate(*place, **road)
        assert context.text().count("\n") + 1 == len(context.shown)


def test_same_input_same_text(geo: Geo, locate: Locate) -> None:
    first = locate(*PARIS, **POSTED)
    locate(*NEW_YORK)
    again = locate(*PARIS, **POSTED)
    assert again == first
    assert _parts(again) == _parts(first)


def _parts(context: GeoContext, order: Sequence[str] = ()) -> dict[str, object]:
    """All that a context says, asked for in an order."""
    names = sorted(name for name in dir(GeoContext) if not name.startswith("_") and name not in ("rule", "text"))
    return {name: getattr(context, name) for name in (*order, *names)} | {"text": context.text()}


def test_a_context_says_the_same_in_whatever_order_it_is_asked_and_after_a_copy(locate: Locate) -> None:
    draw = random.Random(3)
    for place, road in itertools.product((PARIS, CARDIFF, NEW_YORK), _roads()):
        whole = _parts(locate(*place, **road))
        order = draw.sample(sorted(whole.keys() - {"text"}), 6)
        asked = locate(*place, **road)
        assert _parts(asked, order) == whole
        assert _parts(pickle.loads(pickle.dumps(asked))) == whole
        assert _parts(replace(asked)) == whole


def test_a_context_that_nobody_asks_looks_nothing_up(
    drive: Callable[..., DrivingState], weather: Callable[..., Weather], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("nobody asked for that")

    geo, noon = Geo(), datetime(2026, 5, 5, 12, tzinfo=UTC)
    for name in ("automotive_cosim.geo.context.sun_at", "automotive_cosim.geo.context.climate_norm"):
        monkeypatch.setattr(name, refuse)
    monkeypatch.setattr(geo, "atlas", SimpleNamespace(place=refuse))
    context = geo.locate(drive(**POSTED), GpsFix(True, 2.3, 48.9, 3.0, 0.0, 90.0), weather(), noon)
    assert context.posted_limit_kmh == pytest.approx(50.0)
    with pytest.raises(AssertionError, match="nobody asked"):
        context.text()


def test_answers_follow_weather_and_traffic(locate: Locate, weather: Callable[..., Weather]) -> None:
    fog = weather(weather_code=45, visibility=300.0)
    values = {
        place: [found.value for topic in ("front_fog", "rear_fog") if (found := locate(*place, fog).rule(topic))]
        for place in (PARIS, (52.52, 13.4))
    }
    assert values == {PARIS: ["allowed", "allowed"], (52.52, 13.4): ["allowed", "forbidden"]}


def test_fahrenheit_where_it_is_used(locate: Locate) -> None:
    assert "54 °F" in locate(*NEW_YORK).text()
    assert "12 °C" in locate(*PARIS).text()


def test_a_noisy_drive_through_a_street_keeps_its_law(
    geo: Geo, drive: Callable[..., DrivingState], weather: Callable[..., Weather]
) -> None:
    gps = Gps(np.random.default_rng(2))
    noon = datetime(2026, 5, 5, 12, tzinfo=UTC)
    seen = {
        geo.locate(state, gps.read(state, 0.5), weather(), noon).default_limits
        for state in (drive(lon_deg=2.285 + index * 1e-5) for index in range(200))
    }
    assert len(seen) == 1
