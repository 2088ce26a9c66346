"""What the commands on results and screens can be told. Each field is an option of its command."""

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


@dataclass(frozen=True, slots=True)
class PlaybackSettings:
    """How a record is shown again, instead of being run again."""

    play: bool = False
    """Print the recorded steps at their pace instead; of `run` alone."""
    film: Path | None = None
    """Write the recorded screens as an animation instead, .webp or .gif; of `run` alone."""
    speed: Annotated[float, Ge(0.1), Le(1000)] = 4.0
    """How many times as fast as recorded --play and --film are."""


@dataclass(frozen=True, slots=True)
class ScreensSettings:
    """Which screens are drawn, and where to."""

    out: Path = Path("runs/screens.webp")
    """Picture to write: .webp, .png or .jpg."""
    scenario: str = "paris_centre"
    """Scenario in which the car drives."""
    language: str = "en"
    """Language of the screens: en, fr, de or ja."""
    screen: str = "1280x720"
    """Size of the screen: 1280x720, 1920x720 or 1080x1920."""
