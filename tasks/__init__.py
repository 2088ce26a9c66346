"""The catalogue of tasks, one file per module of the cockpit; the hard suite has a folder of its own."""

from __future__ import annotations

if __name__ != "automotive_cosim.tasks":
    raise ImportError(f"import this package as automotive_cosim.tasks, not as {__name__}")

import os
from pathlib import Path

from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasks import (
    apps,
    comms,
    folder,
    hard,
    hvac,
    hvac_hints,
    hvac_safety,
    maps,
    maps_hints,
    maps_safety,
    media,
    phenomenon,
    road,
    system,
)

__all__ = ["CATALOGUE"]

CATALOGUE = Catalogue()
"""Every task by its id."""

for _module in (
    maps,
    maps_hints,
    maps_safety,
    hvac,
    hvac_hints,
    hvac_safety,
    road,
    phenomenon,
    media,
    apps,
    system,
    comms,
    hard,
):
    CATALOGUE.add(*_module.TASKS)

if os.environ.get(folder.VARIABLE):
    folder.add_folder(CATALOGUE, Path(os.environ[folder.VARIABLE]))
