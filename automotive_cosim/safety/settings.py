"""What can be set about a search. Each field is an option of ``search``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class SearchSettings:
    """How a space is searched."""

    sampler: str = "climb"
    """How combinations are chosen: climb, random, sobol, lhs, grid, cma or bayes."""
    seed: Annotated[int, Ge(0), Le(2**31 - 1)] = 0
    """Seed of the sampler."""
    failures: Annotated[int, Ge(0), Le(1000)] = 5
    """How many failures are reduced to what they need."""


@dataclass(frozen=True, slots=True)
class SearchOrder:
    """What is searched, how long, and what comes of it."""

    space: str
    """TOML file with the factors and their values, or a space of the library, such as cut-in."""
    budget: Annotated[str, Option(form="N")]
    """What to use in all, with earlier starts: combinations to try (64), wall time (2h, 90min), money for the model
    (5usd), or several with commas, of which the first that is spent ends it. A failure that is reduced takes some
    thirty runs more."""
    out: Annotated[Path | None, Option(default="runs/search-<space>-<agent>")] = None
    """Folder; an existing one is resumed."""
    save: Path | None = None
    """File for a plan with every minimal failure and its passing neighbour, for `eval --plan`."""
    at_most: Annotated[int | None, Ge(0)] = None
    """Exit with code 1 if more runs fail, or the nominal one does, or nothing was due in any."""
    dry_run: bool = False
    """Say how long it will take, what is missing and, by driving without an agent, what cannot come about and how
    to mend it; then exit."""
