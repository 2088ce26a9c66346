"""Automotive-ENV coupled to live SUMO traffic: a benchmark for agents that work a car's cockpit.

Importing the package registers ``AutomotiveCosim/Cockpit-v0`` with gymnasium, and ``AutomotiveCosim/Flat-v0``,
the same for reinforcement learning.
"""

from __future__ import annotations

import signal
import sys
from pathlib import Path

if Path(sys.argv[0]).stem == "automotive-cosim" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    # Ctrl-C while the command line still loads ends it in silence; once it has loaded it takes the signal back.
    signal.signal(signal.SIGINT, signal.SIG_DFL)

import gymnasium

__version__ = "0.1.0"

gymnasium.register(id="AutomotiveCosim/Cockpit-v0", entry_point="automotive_cosim.envs.cockpit:CockpitEnv")
gymnasium.register(id="AutomotiveCosim/Flat-v0", entry_point="automotive_cosim.envs.flat:FlatEnv")
