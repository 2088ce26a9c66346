"""Dust in the air is weather of its own, not fog."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from automotive_cosim.contracts import Weather
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.weather import phenomena, typical_weather

LAMPS_IN_DUST = {
    # Rule: latitude and longitude, degrees, where it holds; its value in dust and, in the same sight, in fog.
    "ZA.rear_fog": ((-26.20, 28.05), "allowed", "allowed"),
    "BR.rear_fog": ((-23.55, -46.63), "allowed", "allowed"),
    "ES.rear_fog": ((40.42, -3.70), "required", "required"),
    "AE.rear_fog": ((25.20, 55.27), "forbidden", "allowed"),
    "AE.dipped_beam": ((25.20, 55.27), "required", "required"),
}


@pytest.mark.parametrize("code", [7, 31])
@pytest.mark.parametrize("visibility_m", [40.0, 400.0, 4000.0])
def test_it_is_dust_however_far_one_sees(code: int, visibility_m: float) -> None:
    assert phenomena(replace(typical_weather(code), visibility=visibility_m)) == {"dust"}


@pytest.mark.parametrize("rule", LAMPS_IN_DUST)
def test_laws_that_name_dust_know_it(
    rule: str, locate: Callable[..., GeoContext], weather: Callable[..., Weather]
) -> None:
    place, in_dust, in_fog = LAMPS_IN_DUST[rule]
    for code, expected in ((31, in_dust), (45, in_fog)):
        sky = weather(weather_code=code, visibility=150.0)
        found = locate(*place, weather=sky).rule(rule.partition(".")[2])
        assert found is not None
        assert (found.rule.id, found.value) == (rule, expected)
