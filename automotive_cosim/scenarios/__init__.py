"""Scenarios: SUMO's own files plus one ``scenario.toml`` beside them; also any SUMO scenario, at other places.

    sumo_scenarios/paris_centre/
        scenario.toml            what SUMO has no field for: ego trips, driver, date, weather (``formats.scenario``)
        paris_centre.sumocfg     opens in sumo-gui as it is
        ...

reader      ``scenario.toml`` -> ``Scenario``
wording     an incident in words, as options have it
opening     a name, a folder, a .sumocfg or a plain network -> Scenario
foreign     SUMO's own scenarios and networks, run as they are
relocation  any network at another place on earth
routes      the ego's route by street name, edge or position, or drawn by seed
streets     the edges that are open to cars, by street
check       proves that a scenario does what it says
picture     draws it
variant     a copy with another demand
"""

from typing import TYPE_CHECKING

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
from automotive_cosim.scenarios.reader import load, shipped

if TYPE_CHECKING:
    from automotive_cosim.scenarios.opening import open_scenario

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


def __getattr__(name: str) -> object:
    if name == "open_scenario":  # loaded on first use: who only reads scenarios needs no traffic
        from automotive_cosim.scenarios.opening import open_scenario

        return open_scenario
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
