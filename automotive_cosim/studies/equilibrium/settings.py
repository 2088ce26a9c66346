"""What can be set about the search for an equilibrium and an optimum. Each field is an option of its command."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class EquilibriumSettings:
    """How to look for an equilibrium."""

    gap: Annotated[float, Ge(0), Le(1), Option(form="GAP")] = 0.02
    """Relative gap at which to stop."""
    steps: Annotated[int, Ge(1), Le(100)] = 12
    """Maximum number of steps."""
    minutes: Annotated[int, Ge(5), Le(1440), Option(form="M")] = 60
    """Minutes of departures after the warm-up."""
    seed: int = 0
    """Seed of the traffic and of the drivers who change routes."""
    warm_up_s: Annotated[float | None, Ge(0), Le(86_400), Option(default="scenario's", form="SECONDS")] = None
    """Traffic before the departures that count."""

    @property
    def observe_s(self) -> float:
        """How long after the warm-up departures count; later ones are left out of the new demand."""
        return 60.0 * self.minutes


@dataclass(frozen=True, slots=True)
class OptimumSettings:
    """Where the new scenarios go, and whether the equilibrium is compared with the system optimum."""

    out: Annotated[Path | None, Option(default="FOLDER_equilibrium")] = None
    """Folder to create."""
    system_optimum: bool = False
    """Then search for routes with a lower total travel time, and compare."""
    seeds: Annotated[tuple[int, ...] | None, Option(default="1-10")] = None
    """Seeds with which both states are driven, as in 1-10."""
