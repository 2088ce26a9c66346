"""Scenarios beyond a folder's ``scenario.toml``: any SUMO scenario, other places and routes, checks and pictures.

opening     a name, a folder, a .sumocfg or a plain network -> Scenario
foreign     SUMO's own scenarios and networks, run as they are
relocation  any network at another place on earth
routes      the ego's route by street name, edge or position, or drawn by seed
check       proves that a scenario does what it says
picture     draws it
settings    what can be set about the search for an equilibrium
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from automotive_cosim.scenery.opening import open_scenario

__all__ = ["open_scenario"]


def __getattr__(name: str) -> object:
    if name == "open_scenario":  # loaded on first use: the command line needs the settings alone
        from automotive_cosim.scenery.opening import open_scenario

        return open_scenario
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
