"""Scenarios beyond a folder's ``scenario.toml``: any SUMO scenario, other places and routes, checks and pictures.

opening     a name, a folder, a .sumocfg or a plain network -> Scenario
foreign     SUMO's own scenarios and networks, run as they are
relocation  any network at another place on earth
routes      the ego's route by street name, edge or position, or drawn by seed
check       proves that a scenario does what it says
picture     draws it
"""

from automotive_cosim.scenery.opening import open_scenario

__all__ = ["open_scenario"]
