"""Automotive-ENV coupled to live SUMO traffic: a benchmark for agents that work a car's cockpit.

It registers five environments with gymnasium, as soon as both are imported: ``AutomotiveCosim/Cockpit-v0`` for
tasks, ``AutomotiveCosim/Drive-v0`` for drives, and for reinforcement learning ``AutomotiveCosim/Flat-v0`` on tasks
and ``AutomotiveCosim/FlatDrive-v0`` on drives; ``AutomotiveCosim/Fleet-v0`` has several cars in one traffic. The
names in ``__all__`` are what most programs need; each is loaded when it is first used. ``docs/reference/api.md``
lists everything that is public.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType

from automotive_cosim.lazy import lazily

__version__ = "0.2.0"

_ENVIRONMENTS = {
    "Cockpit": ("cockpit:CockpitEnv", "vector:cockpits"),
    "Drive": ("drive:DriveEnv", None),
    "Fleet": (None, "fleet:FleetVectorEnv"),
    "FlatDrive": ("flat_drive:FlatDriveEnv", None),
    "Flat": ("flat:FlatEnv", "vector:flats"),
}
"""Where each is, and several of it at once."""


def _register(gymnasium: ModuleType) -> None:
    home = f"{__name__}.envs."
    for name, (one, several) in _ENVIRONMENTS.items():
        entry, vector = one and home + one, several and home + several
        gymnasium.register(f"AutomotiveCosim/{name}-v0", entry_point=entry, vector_entry_point=vector)


class _Registers:
    """Registers once somebody imports gymnasium, which takes longer than most commands and a simulation's start."""

    @classmethod
    def find_spec(cls, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if name != "gymnasium" or cls not in sys.meta_path:
            return None
        sys.meta_path.remove(cls)
        spec = find_spec(name)
        if spec is not None and spec.loader is not None:
            load: Callable[[ModuleType], None] = spec.loader.exec_module

            def exec_module(module: ModuleType) -> None:
                load(module)
                _register(module)

            setattr(spec.loader, "exec_module", exec_module)  # noqa: B010, a type checker knows it as a method
        return spec


if "gymnasium" in sys.modules:
    _register(sys.modules["gymnasium"])
else:
    sys.meta_path.insert(0, _Registers)


__getattr__, __dir__ = lazily(__name__, __file__)
