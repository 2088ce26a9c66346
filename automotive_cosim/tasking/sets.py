"""The sets that tasks and episodes belong to."""

from __future__ import annotations

from enum import StrEnum


class Suite(StrEnum):
    """A set of tasks that is chosen, run and reported by itself."""

    STANDARD = "standard"
    """The 185 tasks of the paper's size and kind, and more of them."""
    HARD = "hard"
    """Tasks of ten actions and more: values carried between apps, an order that counts, interruptions."""
    LIMITS = "limits"
    """Pairs about what a car cannot do: what is asked for is missing in one half, and the driver has to be told."""
    CLARIFY = "clarify"
    """Pairs about wishes that leave something open: only the driver knows it, or the car does too."""
    SPEED = "speed"
    """Pairs about which speed limit holds: by country, weather, hour, and what is signed ahead. They are families,
    said in the same words in many places: evidence for rows of a protocol rather than new kinds of wishes."""
    VOICE = "voice"
    """Pairs in which the cabin's sound decides, or who said it; they are run with ``--hear cabin``."""
    CAMERA = "camera"
    """Pairs in which something seen through the windshield alone decides; they are run with ``--see camera``."""
    PEOPLE = "people"
    """Pairs in which those aboard react to what they notice, or have told the car what holds over four weeks."""

    @property
    def max_steps(self) -> int:
        """Default limit of actions per episode."""
        return 40 if self.is_long else 20

    @property
    def is_long(self) -> bool:
        """Whether its tasks take more actions than others: many steps, or much to read."""
        return self in (Suite.HARD, Suite.PEOPLE)


ALL_SUITES, LIVE = "all", "live"
SUITES = (*Suite, ALL_SUITES, LIVE)
"""What can be chosen from."""


class Split(StrEnum):
    """The public sets of episodes."""

    DEV = "dev"
    TEST = "test"
