"""Studies of traffic, a wing of its own: the package knows nothing of it (``run.extensions``).

reroute      how much rerouting gains, from futures forked from identical traffic
congestion   the delay of a network before and after an intervention
days         advice from day to day until traffic settles
equilibrium  routes on which nobody would do better alone, and routes with a lower total travel time
calibration  a demand that carries counts
calls        what they call in the process of a simulation
commands     their commands
extension    what the package is told of them

settings     what can be set about a study
content      what every study's folder holds, and the report of a whole network
intervals    means with bootstrap intervals over seeds
gridlock     whether the traffic still flows, or is excluded as gridlocked
versions     compares two runs of one study
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from automotive_cosim.studies.content import load_study

__all__ = ["load_study"]


def __getattr__(name: str) -> object:
    if name == "load_study":  # loaded on first use: the command line reads the settings alone
        from automotive_cosim.studies.content import load_study

        return load_study
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
