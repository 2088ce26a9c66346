"""What can be set about the search for an equilibrium. Each field is an option of its command."""

from __future__ import annotations

from dataclasses import dataclass
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
