"""Scenarios: SUMO's own files plus one ``scenario.toml`` beside them.

    sumo_scenarios/paris_centre/
        scenario.toml            what SUMO has no field for: ego trips, driver, date, weather (``reader``)
        paris_centre.sumocfg     opens in sumo-gui as it is
        ...

model      the form of a scenario
incidents  the incidents that it may stage on its roads
reader     ``scenario.toml`` -> ``Scenario``
"""

from automotive_cosim.scenarios.model import (
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
from automotive_cosim.scenarios.reader import load, shipped

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
    "shipped",
    "weather_at",
]
