"""The catalogue of tasks: one file for each suite and module of the cockpit; ``common.toml`` is what they share."""

from __future__ import annotations

if __name__ != "automotive_cosim.tasks":
    raise ImportError(f"import this package as automotive_cosim.tasks, not as {__name__}")

from pathlib import Path

from automotive_cosim.tasking.catalogue import Catalogue

__all__ = ["CATALOGUE"]

CATALOGUE = Catalogue(Path(__file__).parent)
"""Every task by its id; the files are read when the first one is asked for."""
