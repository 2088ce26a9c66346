"""Automotive-ENV coupled to live SUMO traffic: a benchmark for agents that work a car's cockpit.

Importing the package registers four environments with gymnasium: ``AutomotiveCosim/Cockpit-v0`` for tasks,
``AutomotiveCosim/Drive-v0`` for drives, and for reinforcement learning ``AutomotiveCosim/Flat-v0`` on tasks and
``AutomotiveCosim/FlatDrive-v0`` on drives. The names in ``__all__`` are what most programs need; each is loaded
when it is first used. ``docs/reference/api.md`` lists everything that is public.
"""

from __future__ import annotations

from importlib import import_module

import gymnasium

__version__ = "0.2.0"

_HOMES = {
    "automotive_cosim.agents": ("Agent", "make_agent"),
    "automotive_cosim.contracts": ("Action", "ActionType", "Element", "GoalStatus", "Observation", "Reason"),
    "automotive_cosim.envs.cockpit": ("CockpitEnv",),
    "automotive_cosim.envs.drive": ("DriveEnv",),
    "automotive_cosim.envs.flat": ("FlatEnv",),
    "automotive_cosim.envs.flat_drive": ("FlatDriveEnv",),
    "automotive_cosim.errors": ("CosimError", "InfrastructureError", "UserError"),
    "automotive_cosim.interface.observe": ("Channel",),
    "automotive_cosim.report.results": ("load_results",),
    "automotive_cosim.run.batch": ("run_plan",),
    "automotive_cosim.run.episode": ("EpisodeSetup",),
    "automotive_cosim.run.episode_row": ("EpisodeRow",),
    "automotive_cosim.run.plan": ("Plan", "make_plan"),
    "automotive_cosim.run.trial": ("run_trial",),
}
"""Where the public names are defined; ``__init__.pyi`` tells type checkers the same."""

__all__ = sorted(name for names in _HOMES.values() for name in names)  # pyright: ignore[reportUnsupportedDunderAll]

gymnasium.register(
    id="AutomotiveCosim/Cockpit-v0",
    entry_point="automotive_cosim.envs.cockpit:CockpitEnv",
    vector_entry_point="automotive_cosim.envs.vector:cockpits",
)
gymnasium.register(id="AutomotiveCosim/Drive-v0", entry_point="automotive_cosim.envs.drive:DriveEnv")
gymnasium.register(id="AutomotiveCosim/FlatDrive-v0", entry_point="automotive_cosim.envs.flat_drive:FlatDriveEnv")
gymnasium.register(
    id="AutomotiveCosim/Flat-v0",
    entry_point="automotive_cosim.envs.flat:FlatEnv",
    vector_entry_point="automotive_cosim.envs.vector:flats",
)


def __getattr__(name: str) -> object:
    for module, names in _HOMES.items():
        if name in names:
            return getattr(import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
