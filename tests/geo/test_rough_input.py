"""Whatever position, time, road, weather or rule file comes: an answer, or one line that says what is wrong."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from automotive_cosim.contracts import DrivingState, GpsFix, Limit, LimitSource, Weather
from automotive_cosim.errors import UserError
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.place import Atlas
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
