"""Places at the edges of the map, the sun at the poles, weather words and climate."""

import itertools
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
import pytest
import shapely
import tzfpy

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import UserError
from automotive_cosim.geo.climate import climate_norm
from automotive_cosim.geo.place import Atlas, is_near
from automotive_cosim.geo.sun import Darkness, Sun, elevation_deg, sun_at
from automotive_cosim.geo.weather import (
    PHENOMENA,
    WMO_WORDS,
    VisibilityClass,
    phenomena,
    typical_weather,
    visibility_class,
)
from automotive_cosim.scenarios import WeatherAt, weather_at
from tests.laws import over


@pytest.fixture(scope="module")
def atlas() -> Atlas:
    return Atlas()


@pytest.mark.parametrize(
    ("lat", "lon", "country", "region", "city"),
    [
        (48.853, 2.35, "FR", "", "Paris"),
        (48.892, 2.237, "FR", "", ""),
        (51.507, -0.128, "GB", "", "London"),
        (51.48, -3.18, "GB", "Wales", ""),
        (53.19, -2.89, "GB", "", ""),
        (55.95, -3.19, "GB", "Scotland", ""),
        (54.60, -5.93, "GB", "Northern Ireland", ""),
        (55.31, -5.64, "GB", "Scotland", ""),
        (55.2, -6.24, "GB", "Northern Ireland", ""),
        (54.89, -2.94, "GB", "", ""),
        (50.846, 4.352, "BE", "", "Brussels"),
        (51.22, 4.40, "BE", "Flanders", ""),
        (50.88, 4.70, "BE", "Flanders", ""),
        (50.63, 5.57, "BE", "Wallonia", ""),
        (40.75, -73.98, "US", "New York", "New York City"),
        (40.735, -74.17, "US", "New Jersey", ""),
        (42.88, -78.88, "US", "New York", ""),
        (34.05, -118.24, "US", "California", ""),
        (36.17, -115.14, "US", "Nevada", ""),
        (42.36, -71.06, "US", "Massachusetts", ""),
        (31.76, -106.48, "US", "Texas", ""),
        (25.76, -80.19, "US", "Florida", ""),
        (-12.46, 130.84, "AU", "Northern Territory", ""),
        (-31.95, 115.86, "AU", "Western Australia", ""),
        (-33.87, 151.21, "AU", "", "Sydney"),
        (35.68, 139.76, "JP", "", "Tokyo"),
        (52.52, 13.40, "DE", "", "Berlin"),
        (59.33, 18.06, "SE", "", "Stockholm"),
        (59.91, 10.75, "NO", "", "Oslo"),
        (41.72, 44.79, "GE", "", ""),
    ],
)
def test_known_places(atlas: Atlas, lat: float, lon: float, country: str, region: str, city: str) -> None:
    place = atlas.place(lon, lat)
    assert (place.country, place.region, place.city) == (country, region, city)


STATES = """
AL 32.38 -86.3   AK 58.3 -134.42   AZ 33.45 -112.07   AR 34.75 -92.29   CA 38.58 -121.49
CO 39.74 -104.98   CT 41.76 -72.68   DE 39.16 -75.52   DC 38.9 -77.03   FL 30.44 -84.28
GA 33.75 -84.39   HI 21.31 -157.86   ID 43.62 -116.2   IL 39.8 -89.65   IN 39.77 -86.16
IA 41.59 -93.6   KS 39.05 -95.68   KY 38.19 -84.87   LA 30.46 -91.19   ME 44.31 -69.78
MD 38.98 -76.49   MA 42.36 -71.06   MI 42.73 -84.56   MN 44.95 -93.1   MS 32.3 -90.18
MO 38.58 -92.17   MT 46.59 -112.02   NE 40.81 -96.7   NV 39.16 -119.77   NH 43.21 -71.54
NJ 40.22 -74.77   NM 35.68 -105.94   NY 42.65 -73.75   NC 35.78 -78.64   ND 46.82 -100.78
OH 39.96 -83.0   OK 35.49 -97.5   OR 44.94 -123.03   PA 40.26 -76.88   RI 41.83 -71.41
SC 34.0 -81.03   SD 44.37 -100.35   TN 36.17 -86.78   TX 30.27 -97.74   UT 40.78 -111.89
VT 44.26 -72.58   VA 37.54 -77.43   WA 47.04 -122.9   WV 38.34 -81.61   WI 43.07 -89.38
WY 41.14 -104.82
"""
"""The capitals of the states and the District of Columbia: code, latitude, longitude."""
TWINS = """
MO 39.1 -94.58   KS 39.11 -94.65   MO 38.63 -90.2   IL 38.62 -90.13   TN 35.14 -90.04
AR 35.15 -90.18   OH 39.1 -84.51   KY 39.08 -84.51   IN 38.3 -85.74   KY 38.25 -85.76
OR 45.52 -122.68   WA 45.64 -122.66   NE 41.26 -95.94   IA 41.26 -95.85   PA 39.95 -75.16
NJ 39.94 -75.11   VA 38.88 -77.1   VA 38.8 -77.05   MD 38.99 -77.1   MN 46.78 -92.1
WI 46.7 -92.1   IL 41.51 -90.51   IA 41.53 -90.58   MN 46.87 -96.76   ND 46.88 -96.8
GA 32.47 -84.98   AL 32.47 -85.01   GA 33.47 -81.97   SC 33.5 -81.95   NC 35.23 -80.84
TN 36.59 -82.19   VA 36.61 -82.18   ID 46.41 -117.0   WA 46.42 -117.06   NJ 40.72 -74.04
IL 41.7 -87.54   IN 41.62 -87.5   OH 41.65 -83.54   MS 34.99 -90.0   WV 38.41 -82.44
OH 38.44 -82.46   OH 38.53 -82.68   KY 38.47 -82.64
"""
"""Towns that face each other across the border of two states."""


def _rows(table: str) -> list[tuple[str, float, float]]:
    words = table.split()
    rows = zip(words[::3], words[1::3], words[2::3], strict=True)
    return [(code, float(lat), float(lon)) for code, lat, lon in rows]


@over(_rows(f"{STATES}{TWINS}"))
def test_each_state_has_its_law(code: str, lat: float, lon: float, atlas: Atlas) -> None:
    layers = atlas.place(lon, lat).layers
    assert [layer.code for layer in layers if layer.kind == "region"] == [f"US-{code}"]


def test_no_two_states_overlap(atlas: Atlas) -> None:
    areas = [entry.area for entry in atlas.country("US") if entry.kind == "region" and entry.area is not None]
    assert len(areas) == 51, "50 states and the District of Columbia"
    assert all(one.intersection(other).area < 1e-9 for one, other in itertools.combinations(areas, 2))


def test_the_border_is_flagged_on_both_sides_and_not_inland(atlas: Atlas) -> None:
    strasbourg, kehl = atlas.place(7.795, 48.573), atlas.place(7.81, 48.575)
    assert (strasbourg.country, strasbourg.near_border_to) == ("FR", ("DE",))
    assert (kehl.country, kehl.near_border_to) == ("DE", ("FR",))
    assert atlas.place(1.8, 48.2).near_border_to == ()


@pytest.mark.parametrize(
    ("lat", "lon", "country", "near"),
    [
        (51.4436, 4.9296, "NL", ("BE",)),
        (51.4474, 4.9316, "NL", ("BE",)),
        (51.40, 4.95, "BE", ("NL",)),
        (43.735, 7.418, "MC", ("FR",)),
        (41.903, 12.453, "VA", ("IT",)),
        (41.92, 12.46, "IT", ("VA",)),
        (47.697, 8.689, "DE", ("CH",)),
    ],
)
def test_an_enclave_is_near_however_small(
    atlas: Atlas, lat: float, lon: float, country: str, near: tuple[str, ...]
) -> None:
    """Among them Baarle-Nassau, whose Belgian parcels begin 140 m away, the Vatican and Büsingen."""
    place = atlas.place(lon, lat)
    assert (place.country, place.near_border_to) == (country, near)


def test_the_border_is_near_all_along(atlas: Atlas) -> None:
    """On both sides of corners of Luxembourg's polygon, a kilometre off."""
    outline = shapely.from_geojson(tzfpy.get_tz_polygon_geojson("Europe/Luxembourg"))
    corners = shapely.get_coordinates(outline)
    seen = set()
    for lon, lat in corners[:: len(corners) // 25]:
        for east in (-0.012, 0.012):
            place = atlas.place(lon + east, lat)
            seen.add(place.country)
            assert place.country == "LU" or "LU" in place.near_border_to
            assert place.country != "LU" or place.near_border_to
    assert {"LU", "DE"} <= seen


@pytest.mark.parametrize(
    ("lat", "lon", "code"), [(-21.1, 55.5, "RE"), (16.2, -61.6, "GP"), (4.9, -52.4, "GF"), (46.78, -56.18, "PM")]
)
def test_overseas_france_has_the_law_of_france(atlas: Atlas, lat: float, lon: float, code: str) -> None:
    place = atlas.place(lon, lat)
    assert (place.country, [layer.code for layer in place.layers]) == (code, ["FR"])
    assert place.country_name not in ("", "France")
    assert place.law is not None


def test_the_border_of_a_region_is_flagged(atlas: Atlas) -> None:
    assert "GB-WLS" in atlas.place(-2.91, 53.18).near_border_to


@pytest.mark.parametrize(("lon", "lat"), [(2.35, 48.86), (-2.9, 52.0), (-3.0, 55.0), (-0.1, 51.5), (11.5, 48.1)])
def test_the_layers_are_those_whose_areas_hold_the_place(atlas: Atlas, lon: float, lat: float) -> None:
    """Whether they were looked up for its cell or for itself, and likewise the regions that are near."""
    for east, north in np.random.default_rng(0).uniform(-0.3, 0.3, (60, 2)):
        place, here = atlas.place(lon + east, lat + north), shapely.Point(lon + east, lat + north)
        entries = atlas.country(place.country)
        assert place.layers == tuple(each for each in entries if each.area is None or each.area.contains(here))
        regions = [each for each in entries if each.kind == "region" and each not in place.layers]
        near = {each.code for each in regions if each.area and is_near(each.area, here.x, here.y)}
        assert {code for code in place.near_border_to if "-" in code} == near


def test_at_sea_there_is_a_zone_but_no_country(atlas: Atlas) -> None:
    place = atlas.place(-30.0, 40.0)
    assert (place.country, place.layers) == ("", ())
    assert ZoneInfo(place.time_zone)


def test_every_place_on_earth_has_a_zone(atlas: Atlas) -> None:
    for lon, lat in itertools.product(range(-180, 181, 12), range(-90, 91, 9)):
        assert ZoneInfo(atlas.place(float(lon), float(lat)).time_zone)


def test_the_date_line_is_one_place_by_two_names(atlas: Atlas) -> None:
    assert atlas.place(180.0, -16.8) == atlas.place(-180.0, -16.8)
    assert atlas.place(180.0, -16.8).country == "FJ"


@pytest.mark.parametrize(
    ("lat", "lon"), [(90.01, 0.0), (-91.0, 0.0), (0.0, 180.5), (0.0, -181.0), (float("nan"), 0.0)]
)
def test_off_the_earth_is_refused(atlas: Atlas, lat: float, lon: float) -> None:
    with pytest.raises(UserError, match="not on earth"):
        atlas.place(lon, lat)


@pytest.mark.parametrize("lat", [90.0, 78.22, -77.85, -90.0])
@pytest.mark.parametrize("month", [6, 12])
def test_the_polar_sun_neither_sets_nor_rises(lat: float, month: int) -> None:
    dark = (lat > 0) == (month == 12)
    for hour in range(24):
        sun = sun_at(15.0, lat, datetime(2026, month, 21, hour, tzinfo=UTC))
        assert sun.is_set is dark


def test_the_sun_of_an_equinox() -> None:
    noon = sun_at(0.0, 0.0, datetime(2026, 3, 20, 12, 7, tzinfo=UTC))
    assert noon.elevation_deg == pytest.approx(90.0, abs=1.0)
    assert elevation_deg(0.0, 0.0, datetime(2026, 3, 20, 6, 7, tzinfo=UTC)) == pytest.approx(0.0, abs=1.0)


def test_the_sun_does_not_mind_the_zone_nor_the_year() -> None:
    utc = datetime(1931, 7, 1, 10, tzinfo=UTC)
    assert sun_at(2.3, 48.9, utc) == sun_at(2.3, 48.9, utc.astimezone(ZoneInfo("Asia/Tokyo")))


@pytest.mark.parametrize(
    ("elevation", "darkness", "is_set"),
    [
        (0.1, Darkness.DAY, False),
        (-0.5, Darkness.CIVIL_TWILIGHT, False),
        (-5.9, Darkness.CIVIL_TWILIGHT, True),
        (-6.1, Darkness.NAUTICAL_TWILIGHT, True),
        (-12.1, Darkness.ASTRONOMICAL_TWILIGHT, True),
        (-18.1, Darkness.NIGHT, True),
    ],
)
def test_darkness_classes(elevation: float, darkness: Darkness, is_set: bool) -> None:
    sun = Sun(elevation, 180.0)
    assert (sun.darkness, sun.is_set) == (darkness, is_set)


def test_glare_is_a_low_sun_ahead() -> None:
    sun = Sun(8.0, 350.0)
    assert sun.off_heading_deg(10.0) == pytest.approx(-20.0)
    assert sun.glares(10.0)
    assert not sun.glares(170.0)
    assert not Sun(40.0, 350.0).glares(10.0)
    assert not Sun(-3.0, 350.0).glares(10.0)


@pytest.mark.parametrize(
    ("metres", "expected"),
    [
        (0.0, VisibilityClass.DENSE),
        (49.9, VisibilityClass.DENSE),
        (50.0, VisibilityClass.VERY_POOR),
        (100.0, VisibilityClass.POOR),
        (200.0, VisibilityClass.REDUCED),
        (1000.0, VisibilityClass.GOOD),
    ],
)
def test_visibility_classes(metres: float, expected: VisibilityClass) -> None:
    assert visibility_class(metres) is expected


@pytest.mark.parametrize("code", WMO_WORDS)
def test_every_code_is_weather_of_known_phenomena(code: int) -> None:
    found = phenomena(typical_weather(code))
    assert found <= PHENOMENA
    assert ("precipitation" in found) == (typical_weather(code).precipitation > 0)
    assert ("fog" in found) == ("fog" in WMO_WORDS[code])
    assert ("snow" in found) == ("snow" in WMO_WORDS[code])
    assert ("heavy_rain" in found) <= ("rain" in found)


def test_measured_values_count_beside_the_code(weather: Callable[..., Weather]) -> None:
    assert phenomena(weather(weather_code=3, visibility=400.0)) == {"fog"}
    assert "fog" not in phenomena(weather(weather_code=73, visibility=400.0))
    assert "heavy_rain" in phenomena(weather(weather_code=61, precipitation=8.0))


def test_an_unknown_code_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UserError, match=r"weather code 4 is not one of 0, 1"):
        typical_weather(4)


def test_the_timeline_holds_each_entry_until_the_next(weather: Callable[..., Weather]) -> None:
    dry, wet = weather(), weather(weather_code=63)
    timeline = (WeatherAt(0.0, dry), WeatherAt(60.0, wet))
    assert [weather_at(timeline, second) for second in (-1.0, 0.0, 59.9, 60.0, 1e6)] == [dry, dry, dry, wet, wet]


def test_climate_is_the_nearest_stations_or_none() -> None:
    july, january = climate_norm(2.35, 48.85, 7), climate_norm(2.35, 48.85, 1)
    assert july is not None
    assert january is not None
    assert july.station.startswith("Paris")
    assert july.temperature_c > january.temperature_c + 10
    assert climate_norm(-30.0, 40.0, 7) is None


@pytest.mark.parametrize(("lon", "lat", "hemisphere"), [(151.2, -33.87, "south"), (13.4, 52.52, "north")])
def test_summer_is_where_it_should_be(lon: float, lat: float, hemisphere: str) -> None:
    means = [norm.temperature_c for month in range(1, 13) if (norm := climate_norm(lon, lat, month))]
    assert (means.index(max(means)) + 1 in (12, 1, 2)) == (hemisphere == "south")


def test_a_day_of_sun_turns_once() -> None:
    start = datetime(2026, 5, 5, tzinfo=UTC)
    azimuths = [sun_at(2.3, 48.9, start + timedelta(minutes=10 * step)).azimuth_deg for step in range(144)]
    turned = [(b - a) % 360 for a, b in itertools.pairwise(azimuths)]
    assert all(step < 180 for step in turned)
    assert sum(turned) == pytest.approx(360, abs=5)
