"""What the car feels outside, against figures worked out by hand or looked up."""

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import ADAS, OUTSIDE
from automotive_cosim.cockpit.sky import GRIP_ICE, GRIP_SNOW, GRIP_WET, air_grade, sun_azimuth_deg
from automotive_cosim.contracts import Surroundings, Weather

Make = Callable[..., Cockpit]
DRY = Weather(14.0, 55.0, 0.0, 1, 0.0, 20000.0, 8.0)


@pytest.mark.parametrize(
    ("lat", "lon", "time", "zone", "azimuth"),
    [
        (48.86, 2.35, datetime(2026, 3, 20, 12, 58), "Europe/Paris", 180.0),
        (48.86, 2.35, datetime(2026, 6, 21, 5, 48), "Europe/Paris", 53.0),
        (-33.87, 151.21, datetime(2026, 12, 21, 12, 53), "Australia/Sydney", 0.0),
    ],
)
def test_the_sun_stands_where_almanacs_say(
    lat: float, lon: float, time: datetime, zone: str, azimuth: float
) -> None:
    """Solar noon and sunrise as published; within 6 degrees, for the mean sun knows no equation of time."""
    found = sun_azimuth_deg(lat, lon, time.replace(tzinfo=ZoneInfo(zone)))
    assert min(abs(found - azimuth), 360 - abs(found - azimuth)) < 6


def felt(make: Make, around: Surroundings, weather: Weather = DRY, **changes: object) -> Cockpit:
    return make(surroundings=replace(around, weather=weather, **changes))  # type: ignore[arg-type]


def test_a_low_sun_ahead_dazzles_and_one_behind_or_in_clouds_does_not(make: Make, around: Surroundings) -> None:
    evening = datetime(2026, 5, 12, 20, 30, tzinfo=ZoneInfo("Europe/Paris"))
    azimuth = sun_azimuth_deg(48.86, 2.34, evening)
    cases = {
        "ahead": (azimuth, DRY, 5.0),
        "behind": (azimuth + 180, DRY, 5.0),
        "clouds": (azimuth, replace(DRY, cloud_cover=100.0), 5.0),
        "high": (azimuth, DRY, 40.0),
        "set": (azimuth, DRY, -3.0),
    }
    glare = {
        name: felt(
            make,
            around,
            weather,
            local_time=evening,
            sun_elevation_deg=elevation,
            driving=replace(around.driving, heading_deg=heading % 360),
        ).signals[OUTSIDE.GLARE]
        for name, (heading, weather, elevation) in cases.items()
    }
    assert glare.pop("ahead") == pytest.approx(80.0, abs=1)
    assert set(glare.values()) == {0.0}


@pytest.mark.parametrize(
    ("weather", "grip"),
    [
        (DRY, 1.0),
        (replace(DRY, precipitation=3.0, weather_code=63), GRIP_WET),
        (replace(DRY, temperature_2m=-2.0, weather_code=73, precipitation=1.0), GRIP_SNOW),
        (replace(DRY, temperature_2m=-1.0, relative_humidity_2m=98.0), GRIP_ICE),
        (replace(DRY, temperature_2m=0.5, weather_code=66, precipitation=1.0), GRIP_ICE),
    ],
)
def test_grip_follows_water_snow_and_ice(make: Make, around: Surroundings, weather: Weather, grip: float) -> None:
    assert felt(make, around, weather).signals[ADAS.ROAD_FRICTION] == pytest.approx(100 * grip)


def test_a_dust_storm_and_a_tunnel_spoil_the_air(make: Make, around: Surroundings) -> None:
    clean = felt(make, around).signals[OUTSIDE.FINE_DUST]
    storm = felt(make, around, replace(DRY, weather_code=31, visibility=1000.0)).signals[OUTSIDE.FINE_DUST]
    road = replace(around.driving.road, in_tunnel=True)
    tunnel = felt(make, around, driving=replace(around.driving, road=road)).signals[OUTSIDE.FINE_DUST]
    assert storm - clean == pytest.approx(0.15 * 3802)
    assert clean < tunnel < storm
    assert [air_grade(value) for value in (clean, tunnel, storm)] == ["Fair", "Poor", "Extremely poor"]


def test_light_fades_with_the_sun_and_in_a_tunnel(make: Make, around: Surroundings) -> None:
    high = felt(make, around, sun_elevation_deg=50.0).signals[OUTSIDE.LIGHT]
    low = felt(make, around, sun_elevation_deg=5.0).signals[OUTSIDE.LIGHT]
    night = felt(make, around, sun_elevation_deg=-10.0).signals[OUTSIDE.LIGHT]
    assert high == 100.0
    assert low == pytest.approx(17.4, abs=0.1)
    assert night == 0.0
