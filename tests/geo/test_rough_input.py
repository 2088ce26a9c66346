"""Whatever position, time, road, weather or rule file comes: an answer, or one line that says what is wrong."""

import json
import re
import tomllib
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from importlib.resources import files
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from automotive_cosim.contracts import DrivingState, GpsFix, Limit, LimitSource, Weather
from automotive_cosim.errors import UserError
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.place import Atlas
from automotive_cosim.geo.rulefile import read_jurisdiction
from automotive_cosim.geo.rules import TOPICS
from automotive_cosim.geo.text import BUDGET_TOKENS

ZONES = ("UTC", "Europe/Paris", "America/St_Johns", "Asia/Kathmandu", "Pacific/Apia", "Antarctica/Troll")
lons = st.floats(-180, 180) | st.sampled_from([-180.0, 180.0, 0.0, -6.36, 7.81])
lats = st.floats(-90, 90) | st.sampled_from([-90.0, 90.0, 0.0, 54.1118, 48.575])
times = st.datetimes(datetime(1900, 1, 2), datetime(2199, 12, 30), timezones=st.sampled_from(ZONES).map(ZoneInfo))
roads = st.fixed_dictionaries(
    {
        "road_class": st.sampled_from(["motorway", "trunk", "residential", "", "raceway", "busway"])
        | st.text(max_size=9),
        "name": st.text(max_size=30),
        "lane_count": st.integers(0, 9),
        "limit": st.builds(Limit, st.none() | st.floats(0, 120), st.sampled_from(LimitSource)),
        "in_tunnel": st.booleans(),
        "lit": st.none() | st.booleans(),
        "built_up": st.none() | st.booleans(),
        "centre_line": st.none() | st.booleans(),
        "speed_mps": st.floats(0, 120),
        "heading_deg": st.floats(0, 360, exclude_max=True),
    }
)
weathers = st.none() | st.builds(
    Weather,
    temperature_2m=st.floats(-60, 60),
    relative_humidity_2m=st.floats(0, 100),
    precipitation=st.floats(0, 200),
    weather_code=st.integers(-1, 120),
    cloud_cover=st.floats(0, 100),
    visibility=st.floats(0, 100_000),
    wind_speed_10m=st.floats(0, 300),
)


@pytest.mark.slow
@settings(max_examples=120)
@given(lon=lons, lat=lats, time=times, road=roads, weather=weathers)
def test_there_is_a_context_everywhere_and_always(
    geo: Geo,
    drive: Callable[..., DrivingState],
    lon: float,
    lat: float,
    time: datetime,
    road: dict[str, object],
    weather: Weather | None,
) -> None:
    found = geo.locate(drive(**road), GpsFix(True, lon, lat, 3.0, 0.0, 90.0), weather, time)
    text = found.text()
    assert text.startswith("Place: ")
    assert len(text) <= 4 * BUDGET_TOKENS
    assert all(line.text.strip() for line in found.lines)
    assert found.place.layers or not found.default_limits
    if found.road.limit.source is LimitSource.POSTED and found.posted_limit_kmh is not None:
        assert "(posted on " in text
    codes = {layer.code for layer in found.place.layers}
    assert {limit.jurisdiction for limit in (*found.default_limits, *found.reduced_limits)} <= codes


@given(lon=st.floats(allow_nan=True, allow_infinity=True), lat=st.floats(allow_nan=True, allow_infinity=True))
def test_a_position_is_on_earth_or_refused(lon: float, lat: float) -> None:
    on_earth = -180 <= lon <= 180 and -90 <= lat <= 90
    try:
        assert Atlas().place(lon, lat).time_zone
        assert on_earth
    except UserError as error:
        assert not on_earth
        assert "\n" not in str(error)


@settings(max_examples=60)
@given(lat=st.floats(-89, 89))
def test_both_sides_of_the_date_line_are_one_place(lat: float) -> None:
    east, west = Atlas().place(180.0, lat), Atlas().place(-180.0, lat)
    assert east == west


@pytest.mark.slow
@pytest.mark.parametrize("zone", ["Europe/Paris", "America/New_York", "Australia/Lord_Howe", "Pacific/Apia"])
def test_no_instant_of_a_year_lacks_a_context(locate: Callable[..., GeoContext], zone: str) -> None:
    """Hour by hour through 2011, when Apia skipped a day, and summer time's gaps and folds everywhere."""
    start = datetime(2011, 1, 1, tzinfo=UTC)
    for hour in range(0, 365 * 24, 7):
        local = (start + timedelta(hours=hour)).astimezone(ZoneInfo(zone))
        assert f"Time: {local:%Y-%m-%d %H:%M}" in locate(48.87, 2.3, time=local).text()


def test_a_time_in_a_gap_is_taken_as_it_is(locate: Callable[..., GeoContext]) -> None:
    """02:30 does not exist on that night in Paris; the sun and the rules get an instant all the same."""
    gap = datetime(2026, 3, 29, 2, 30, tzinfo=ZoneInfo("Europe/Paris"))
    instant = gap.astimezone(UTC)
    sun = locate(48.87, 2.3, time=gap).sun
    assert sun == locate(48.87, 2.3, time=instant).sun


def test_the_two_half_past_twos_of_autumn_differ_by_an_hour_of_sun(locate: Callable[..., GeoContext]) -> None:
    first = datetime(2026, 10, 25, 2, 30, tzinfo=ZoneInfo("Europe/Paris"))
    suns = [locate(48.87, 2.3, time=first.replace(fold=fold)).sun for fold in (0, 1)]
    assert all(suns)
    assert suns[0] != suns[1]


# --- rule files ---------------------------------------------------------------------------------------------

SHIPPED = sorted(Path(str(files("automotive_cosim.geo.data"))).glob("*.toml"))


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_damaged_file_is_refused_with_one_line_or_still_well_formed(tmp_path: Path, data: st.DataObject) -> None:
    """A line lost, doubled or overwritten in a shipped file."""
    source = data.draw(st.sampled_from(SHIPPED))
    lines = source.read_text(encoding="utf-8").splitlines()
    index = data.draw(st.integers(0, len(lines) - 1))
    junk = data.draw(
        st.sampled_from(["", lines[index], "value = []", "when = 3", "cases = 7", "rules = 1", "x = nan"])
    )
    lines[index : index + 1] = [junk, junk] if junk == lines[index] else [junk]
    path = tmp_path / source.name
    path.write_text("\n".join(lines), encoding="utf-8")
    try:
        read_jurisdiction(path)
    except UserError as error:
        assert all(line.startswith(str(path)) for line in str(error).splitlines())


FIELDS = ("id", "topic", "text", "value", "unit", "when", "law", "as_of", "status", "cases", "binds", "caps")
_words = st.text(st.characters(codec="ascii"), max_size=6)
_toml = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 99) | st.floats() | _words,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_words, inner, max_size=3),
    max_leaves=6,
)


@settings(max_examples=300, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(field=st.sampled_from(FIELDS), value=_toml)
@pytest.mark.slow
def test_any_value_in_any_field_of_a_rule_is_read_or_refused(tmp_path: Path, field: str, value: object) -> None:
    rule = {
        "id": '"XX.limit"',
        "topic": '"limit"',
        "text": '"everywhere"',
        "value": "30",
        "unit": '"mph"',
        "law": '"Act 1"',
        "as_of": "2026-01-01",
        "status": '"verified"',
    } | {field: _inline(value)}
    head = (
        '[jurisdiction]\ncode = "XX"\nname = "Nowhere"\nstatus = "knowledge"\ndriving_side = "left"\n'
        'speed_unit = "mph"\ntemperature_unit = "C"\nemergency = ["1"]\n\n[[rules]]\n'
    )
    text = head + "\n".join(f"{name} = {entry}" for name, entry in rule.items())
    tomllib.loads(text)
    path = tmp_path / "XX.toml"
    path.write_text(text, encoding="utf-8")
    try:
        (rule_read,) = read_jurisdiction(path).rules
        assert rule_read.topic in TOPICS
        assert rule_read.text.isprintable()
        assert rule_read.cases
    except UserError as error:
        line = rf"{re.escape(str(path))}( line \d+ \[\[rules\]\]|: and \d+ more$)"
        assert all(re.match(line, problem) for problem in str(error).splitlines())


def _inline(value: object) -> str:
    match value:
        case None:
            return "1979-05-27T07:32:00"
        case bool() | int():
            return json.dumps(value)
        case float():
            return {"Infinity": "inf", "-Infinity": "-inf", "NaN": "nan"}.get(json.dumps(value), f"{value:.6f}")
        case str():
            return json.dumps(value).replace("\x7f", "?")
        case list():
            return f"[{', '.join(map(_inline, value))}]"
        case dict():
            return f"{{{', '.join(f'{_inline(str(name))} = {_inline(entry)}' for name, entry in value.items())}}}"
    raise TypeError
