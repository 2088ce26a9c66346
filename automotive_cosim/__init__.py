"""Automotive-ENV coupled to live SUMO traffic: a benchmark for agents that work a car's cockpit.

Importing the package registers ``AutomotiveCosim/Cockpit-v0`` with gymnasium, and ``AutomotiveCosim/Flat-v0``,
the same for reinforcement learning.
"""

from __future__ import annotations

import gymnasium

__version__ = "0.1.0"

gymnasium.register(
    id="AutomotiveCosim/Cockpit-v0",
    entry_point="automotive_cosim.envs.cockpit:CockpitEnv",
    vector_entry_point="automotive_cosim.envs.vector:cockpits",
)
gymnasium.register(
    id="AutomotiveCosim/Flat-v0",
    entry_point="automotive_cosim.envs.flat:FlatEnv",
    vector_entry_point="automotive_cosim.envs.vector:flats",
)
