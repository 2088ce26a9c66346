"""What ``compare`` can be told. Each field is an option."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class CompareSettings:
    """How two evaluations are compared."""

    threshold: Annotated[float, Ge(0), Le(100), Option(form="POINTS")] = 0.0
    """By how many percentage points success, or points the score of drives, may fall."""
    junit: Path | None = None
    """File for a JUnit report with one case per episode."""
    markdown: Path | None = None
    """File for a summary in Markdown."""
    mixed_versions: bool = False
    """Compare even if two minor versions of automotive-cosim ran them."""

    @property
    def allowed(self) -> float:
        """The threshold as a share."""
        return self.threshold / 100
