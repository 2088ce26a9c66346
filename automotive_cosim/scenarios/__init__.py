"""Scenarios: SUMO's own files plus one ``scenario.toml`` beside them; also any SUMO scenario, at other places.

    sumo_scenarios/paris_centre/
        scenario.toml            what SUMO has no field for: ego trips, driver, date, weather (``formats.scenario``)
        paris_centre.sumocfg     opens in sumo-gui as it is
        ...

listing     the shipped scenarios as lists tell of them
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

from __future__ import annotations

from automotive_cosim.lazy import lazily

__getattr__, __dir__ = lazily(__name__, __file__)
