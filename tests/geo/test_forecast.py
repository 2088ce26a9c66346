"""Weather from the climate and from Open-Meteo: a server on this machine stands in for it."""

import itertools
import json
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlparse
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim import scenarios
from automotive_cosim.contracts import DrivingState
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.geo.climate import climate_norm
from automotive_cosim.geo.forecast import FIELDS, Climate, OpenMeteo, draw, drawn_weather
from automotive_cosim.geo.weather import WMO_WORDS, phenomena

PARIS, OSLO, DUBAI, SEA = (2.34, 48.82), (10.75, 59.91), (55.36, 25.25), (-30.0, 40.0)
NOON = datetime(2026, 1, 20, 12, 30, tzinfo=ZoneInfo("Europe/Paris"))


# --- the climate ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("place", "month"), [(PARIS, 1), (PARIS, 7), (OSLO, 1), (DUBAI, 7), ((139.7, 35.7), 9)])
def test_many_draws_come_out_at_the_normals(place: tuple[float, float], month: int) -> None:
    norm = climate_norm(*place, month)
    assert norm is not None
    rng = np.random.default_rng(4)
    start = datetime(2026, month, 1, tzinfo=UTC)
    drawn = [draw(norm, start + timedelta(hours=hour % 672), rng) for hour in range(672 * 8)]
    assert np.mean([w.temperature_2m for w in drawn]) == pytest.approx(norm.temperature_c, abs=0.2)
    hours = 24 * (31 if month in (1, 7) else 30)
    assert np.mean([w.precipitation for w in drawn]) * hours == pytest.approx(
        norm.precipitation_mm, rel=0.25, abs=1.5
    )
    assert np.mean([w.relative_humidity_2m for w in drawn]) == pytest.approx(norm.humidity_pct, abs=3.0)


@given(
    seed=st.integers(0, 2**31),
    place=st.sampled_from([PARIS, OSLO, DUBAI]),
    hour=st.datetimes(datetime(1970, 1, 1), datetime(2100, 1, 1)),
)
def test_every_draw_is_weather_that_agrees_with_itself(
    seed: int, place: tuple[float, float], hour: datetime
) -> None:
    weather = Climate(seed).report(*place, hour.replace(tzinfo=UTC)).weather
    found = phenomena(weather)
    assert weather.weather_code in WMO_WORDS
    assert ("precipitation" in found) == (weather.precipitation > 0)
    assert ("fog" in found) == (weather.weather_code in (45, 48))
    assert "snow" not in found or weather.temperature_2m < 1
    assert ("heavy_rain" in found) <= (weather.precipitation >= 7.6)
    assert 0 <= weather.relative_humidity_2m <= 100
    assert weather.visibility > 0


OPEN_METEO_CODES = {
    *(0, 1, 2, 3, 45, 48, 51, 53, 55, 56, 57, 61, 63, 65, 66, 67),
    *(71, 73, 75, 77, 80, 81, 82, 85, 86, 95, 96, 99),
}


DUST_CODES = {7, 31}
"""WMO 4677 has them, Open-Meteo does not."""


def test_the_codes_are_open_meteos_and_stand_for_its_rates() -> None:
    """Drizzle from 0.01, 0.5 and 1.0 mm/h, rain from 1.3, 2.5 and 7.6 mm/h, snow from 0.01, 0.2 and 0.8 cm/h."""
    assert set(WMO_WORDS) == OPEN_METEO_CODES | DUST_CODES
    rain = {51: (0.01, 0.5), 53: (0.5, 1.0), 55: (1.0, 1.3), 61: (1.3, 2.5), 63: (2.5, 7.6), 65: (7.6, 500)}
    snow = {71: (0.01, 0.2), 73: (0.2, 0.8), 75: (0.8, 500)}
    seen = set()
    for seed, place, month in itertools.product(range(700), (PARIS, OSLO, (77.2, 28.6)), (1, 8)):
        weather = Climate(seed).report(*place, NOON.replace(month=month)).weather
        code, rate = weather.weather_code, weather.precipitation
        low, high = rain.get(code, snow.get(code, (0.0, 500.0)))
        amount = rate * 0.7 if code in snow else rate
        assert low - 0.06 <= amount <= high + 0.06, weather
        seen.add(code)
    assert seen >= {51, 53, 55, 61, 63, 65, 71, 73}


def test_a_seed_is_one_weather_an_hour_and_seeds_differ() -> None:
    assert Climate(3).report(*PARIS, NOON) == Climate(3).report(*PARIS, NOON.astimezone(UTC))
    assert Climate(3).report(*PARIS, NOON) == Climate(3).report(*PARIS, NOON + timedelta(minutes=20))
    assert Climate(3).report(*PARIS, NOON) != Climate(3).report(*PARIS, NOON + timedelta(hours=1))
    assert len({Climate(seed).report(*PARIS, NOON).weather for seed in range(20)}) == 20


def test_place_and_month_show() -> None:
    def codes(place: tuple[float, float], month: int, hour: int = 12) -> Counter[int]:
        time = NOON.replace(month=month, hour=hour)
        return Counter(Climate(seed).report(*place, time).weather.weather_code for seed in range(600))

    assert not set(codes(DUBAI, 7)) & {71, 73, 75}
    assert set(codes(OSLO, 1)) & {71, 73}
    assert set(codes(PARIS, 11, hour=5)) & {45, 48}
    assert sum(codes(DUBAI, 6)[code] for code in (0, 1, 2)) > sum(codes(PARIS, 12)[code] for code in (0, 1, 2))


def test_where_no_climate_is_known_nothing_is_made_up() -> None:
    with pytest.raises(UserError, match="no climate is known within"):
        Climate(1).report(*SEA, NOON)


# --- Open-Meteo -------------------------------------------------------------------------------------------


@dataclass
class Service:
    """A stand-in for Open-Meteo that answers as told."""

    url: str = ""
    status: int = 200
    body: bytes = b""
    wait_s: float = 0.0
    break_off: bool = False
    queries: list[dict[str, list[str]]] = field(default_factory=list)


@pytest.fixture
def service(monkeypatch: pytest.MonkeyPatch) -> Iterator[Service]:
    monkeypatch.setenv("no_proxy", "*")
    told = Service()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            told.queries.append(parse_qs(urlparse(self.path).query))
            time.sleep(told.wait_s)
            if told.break_off:
                self.connection.close()
                return
            self.send_response(told.status)
            self.send_header("Content-Length", str(len(told.body)))
            self.end_headers()
            self.wfile.write(told.body)

        def log_message(self, *args: object) -> None:
            pass

    class Quiet(ThreadingHTTPServer):
        daemon_threads = True

        def handle_error(self, *args: object) -> None:
            """Clients that hang up are part of the tests."""

    server = Quiet(("127.0.0.1", 0), Handler)
    told.url = f"http://127.0.0.1:{server.server_port}/v1/forecast"
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    yield told
    server.shutdown()
    server.server_close()
    thread.join()


def good() -> dict[str, Any]:
    """An answer for the 20th of January 2026 in the shape that Open-Meteo documents; 11:00 UTC is foggy."""
    hours = [f"2026-01-20T{hour:02d}:00" for hour in range(24)]
    columns: dict[str, list[Any]] = {name: [5.0] * 24 for name in FIELDS} | {"weather_code": [3] * 24}
    columns["weather_code"][11], columns["visibility"][11], columns["temperature_2m"][11] = 45, 80.0, -1.5
    return {"latitude": 48.8, "longitude": 2.3, "utc_offset_seconds": 0, "hourly": {"time": hours, **columns}}


def test_it_asks_for_the_hour_and_reads_it(service: Service) -> None:
    service.body = json.dumps(good()).encode()
    report = OpenMeteo(Climate(1), service.url).report(*PARIS, NOON)
    assert (report.source, report.note) == ("Open-Meteo", "")
    weather = report.weather
    assert (weather.weather_code, weather.visibility, weather.temperature_2m) == (45, 80.0, -1.5)
    (query,) = service.queries
    assert query["latitude"] == ["48.8200"]
    assert query["longitude"] == ["2.3400"]
    assert (query["start_date"], query["end_date"], query["timezone"]) == (["2026-01-20"], ["2026-01-20"], ["UTC"])
    assert set(query["hourly"][0].split(",")) == set(FIELDS)


def _spoilt(**columns: Any) -> bytes:
    answer = good()
    answer["hourly"].update(columns)
    return json.dumps(answer).encode()


def _lacking(name: str) -> bytes:
    answer = good()
    del answer["hourly"][name]
    return json.dumps(answer).encode()


@pytest.mark.parametrize(
    ("told", "why"),
    [
        ({"status": 429, "body": b'{"error":true,"reason":"Minutely API request limit exceeded."}'}, "rate limit"),
        ({"status": 500}, "answers 500"),
        ({"status": 400, "body": b'{"error":true,"reason":"date out of range"}'}, "answers 400"),
        ({"body": b"<html>"}, "not JSON"),
        ({"body": b""}, "not JSON"),
        ({"body": json.dumps(good()).encode()[:-40]}, "not JSON"),
        ({"body": b"\xff\xfe\x00"}, "not JSON"),
        ({"body": b"[" * 100_000}, "not JSON"),
        ({"body": b"[]"}, "has no hour"),
        ({"body": b'{"hourly": null}'}, "has no hour"),
        ({"body": b'{"hourly": {"time": []}}'}, "has no hour 2026-01-20T11:00Z"),
        *(({"body": _lacking(name)}, f"lacks {name}") for name in FIELDS),
        ({"body": _spoilt(visibility=[None] * 24)}, "lacks visibility"),
        ({"body": _spoilt(visibility=[1.0])}, "lacks visibility"),
        ({"body": _spoilt(visibility=["far"] * 24)}, "lacks visibility"),
        ({"body": _spoilt(visibility=[-1.0] * 24)}, "has visibility = -1.0"),
        ({"body": _spoilt(temperature_2m=[float("nan")] * 24)}, "has temperature_2m = nan"),
        ({"body": _spoilt(precipitation=[float("inf")] * 24)}, "has precipitation = inf"),
        ({"body": _spoilt(relative_humidity_2m=[120] * 24)}, "has relative_humidity_2m = 120"),
        ({"body": _spoilt(weather_code=[4] * 24)}, "unknown weather code 4"),
        ({"break_off": True}, "breaks off"),
    ],
    ids=lambda part: part if isinstance(part, str) else "",
)
def test_whatever_goes_wrong_the_climate_answers_and_it_says_so(
    service: Service, told: dict[str, Any], why: str
) -> None:
    for name, value in told.items():
        setattr(service, name, value)
    report = OpenMeteo(Climate(1), service.url).report(*PARIS, NOON)
    instead = Climate(1).report(*PARIS, NOON)
    assert (report.weather, report.source) == (instead.weather, instead.source)
    assert why in report.note
    assert report.note.endswith("drawn from the climate of Paris (Montsouris) (seed 1) instead")
    assert "\n" not in report.note


def test_a_slow_service_is_not_waited_for(service: Service) -> None:
    service.wait_s = 0.6
    assert "does not answer within 0.1 s" in OpenMeteo(Climate(1), service.url, 0.1).report(*PARIS, NOON).note


def test_no_service_at_all(service: Service) -> None:
    nobody = service.url.replace("/v1", "").rsplit(":", 1)[0] + ":9/"
    assert "cannot be reached" in OpenMeteo(Climate(1), nobody, 1.0).report(*PARIS, NOON).note


def test_offline_and_without_a_climate_it_is_the_users_error(service: Service) -> None:
    service.status = 503
    with pytest.raises(UserError, match="no climate is known"):
        OpenMeteo(Climate(1), service.url).report(*SEA, NOON)


def test_nothing_goes_online_by_itself(monkeypatch: pytest.MonkeyPatch, locate: Callable[..., Any]) -> None:
    def refuse(*args: object, **kwargs: object) -> None:
        raise AssertionError("went online")

    monkeypatch.setattr("socket.socket.connect", refuse)
    locate(48.82, 2.34)
    Climate(1).report(*PARIS, NOON)


# --- where it is used -------------------------------------------------------------------------------------


def test_a_scenario_may_leave_its_weather_to_the_climate(
    tmp_path: Path, drive: Callable[..., DrivingState]
) -> None:
    shipped = scenarios.load("paris_centre").folder
    text = (shipped / "scenario.toml").read_text(encoding="utf-8")
    head = text[: text.index("[[weather]]")]
    (tmp_path / "scenario.toml").write_text(f'weather = "climate"\n{head}', encoding="utf-8")
    (tmp_path / "paris_centre.sumocfg").write_text("<configuration/>", encoding="utf-8")
    scenario = scenarios.load(tmp_path)
    assert scenario.weather == ()
    first, again, other = (drawn_weather(drive(), scenario.start, seed) for seed in (1, 1, 2))
    assert first == again != other
    assert first[0].at_s == 0.0
    with pytest.raises(ScenarioError, match="projection"):
        drawn_weather(drive(lon_deg=None, lat_deg=None), scenario.start, 1)
    (tmp_path / "scenario.toml").write_text(f'weather = "fine"\n{head}', encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"it must be a list of \[\[weather\]\] entries or 'climate'"):
        scenarios.load(tmp_path)
