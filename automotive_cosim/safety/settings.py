"""What can be set about a search. Each field is an option of ``search``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le


@dataclass(frozen=True, slots=True)
class SearchSettings:
    """How a space is searched."""

    sampler: str = "climb"
    """How points are chosen: climb, random, sobol, lhs, grid, cma or bayes."""
    seed: Annotated[int, Ge(0), Le(2**31 - 1)] = 0
    """Seed of the sampler."""
    failures: Annotated[int, Ge(0), Le(1000)] = 5
    """How many failures are reduced to what they need."""
