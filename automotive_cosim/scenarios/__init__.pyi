"""The names that are loaded at first use, and where each is defined (``lazy``)."""

from automotive_cosim.formats.scenario import (
    LINKS,
    Ego,
    LinkAt,
    Scenario,
    Street,
    Sumo,
    Trip,
    WeatherAt,
    link_at,
    weather_at,
)
from automotive_cosim.scenarios.listing import shipped
from automotive_cosim.scenarios.opening import open_scenario
from automotive_cosim.scenarios.reader import load

__all__ = [
    "LINKS",
    "Ego",
    "LinkAt",
    "Scenario",
    "Street",
    "Sumo",
    "Trip",
    "WeatherAt",
    "link_at",
    "load",
    "open_scenario",
    "shipped",
    "weather_at",
]
