"""Weather that a place cannot have is seen, and what it can have is not."""

from datetime import datetime
from types import SimpleNamespace
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.contracts import Weather
from automotive_cosim.geo.climate import climate_norm
from automotive_cosim.geo.forecast import Climate
from automotive_cosim.geo.weather import typical_weather
from automotive_cosim.proof.world import STATION_WITHIN_KM, implausible, normal_c

PASS, PARIS, SYDNEY, OCEAN = (9.2, 46.5), (2.35, 48.85), (150.75, -33.6), (-150.0, 0.0)
ZONES = {PASS: "Europe/Zurich", PARIS: "Europe/Paris", SYDNEY: "Australia/Sydney", OCEAN: "UTC"}


def faults(place: tuple[float, float], time: str, weather: Weather) -> str:
    local = datetime.fromisoformat(time).replace(tzinfo=ZoneInfo(ZONES[place]))
    driving = SimpleNamespace(lon_deg=place[0], lat_deg=place[1])
    return "; ".join(implausible(SimpleNamespace(weather=weather, driving=driving, local_time=local)))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("place", "time", "weather", "seen"),
    [
        (PASS, "2026-12-16T08:40", typical_weather(1, 18.0), "18 degrees at 08:40 on 16 December near Zurich"),
        (PASS, "2026-06-16T12:30", typical_weather(1, 18.0), ""),
        (PARIS, "2026-06-16T12:30", typical_weather(45, 4.0, 99.0), "4 degrees"),
        (PARIS, "2026-11-17T08:15", typical_weather(45, 6.0, 99.0), ""),
        (SYDNEY, "2026-07-18T08:20", typical_weather(0, 42.0, 10.0), "42 degrees"),
        (SYDNEY, "2026-01-14T14:00", typical_weather(0, 41.0, 10.0), ""),
        (OCEAN, "2026-01-14T14:00", typical_weather(0, -40.0), ""),
        (OCEAN, "2026-01-14T14:00", typical_weather(73, 9.0, 90.0), "snow at 9 degrees"),
        (OCEAN, "2026-01-14T14:00", typical_weather(45, 9.0, 70.0), "fog in air of 70 % humidity"),
        (OCEAN, "2026-01-14T14:00", Weather(9.0, 95.0, 0.0, 63, 100.0, 5e3, 9.0), "nothing falls"),
        (OCEAN, "2026-01-14T14:00", Weather(9.0, 95.0, 2.0, 1, 30.0, 5e3, 9.0), "dry by its code"),
    ],
)
def test_weather_out_of_this_world_is_seen(place, time, weather, seen):
    told = faults(place, time, weather)
    assert bool(told) == bool(seen)
    assert seen in told


@pytest.mark.parametrize("place", [PASS, PARIS, SYDNEY])
def test_weather_drawn_from_the_climate_is_of_this_world(place):
    for seed in range(200):
        time = f"2026-{1 + seed % 12:02d}-15T{seed % 24:02d}:00"
        local = datetime.fromisoformat(time).replace(tzinfo=ZoneInfo(ZONES[place]))
        weather = Climate(seed, STATION_WITHIN_KM).report(*place, local).weather
        assert "degrees at" not in faults(place, time, weather), (time, weather)


def test_the_normal_of_the_hour_swings_about_the_months():
    norm = climate_norm(*PARIS, 7)
    assert norm is not None
    hours = [normal_c(norm, PARIS[0], datetime(2026, 7, 1, hour, tzinfo=ZoneInfo("UTC"))) for hour in range(24)]
    assert sum(hours) / 24 == pytest.approx(norm.temperature_c, abs=0.1)
    assert max(hours) == pytest.approx(norm.usual_high_c, abs=0.2)
    assert hours.index(max(hours)) in (14, 15)
