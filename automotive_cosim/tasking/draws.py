"""What is random in an episode: each purpose of each task draws from a stream of its own.

    Draws("road_horn_abroad", 3).rng(Purpose.CONTENT)

A stream depends on the task's id, the number and the purpose alone: not on other tasks, other purposes or the order
in which anything is drawn. Nothing depends on the half, so that both halves of a pair share every draw.
"""

from __future__ import annotations

import hmac
from dataclasses import dataclass
from enum import StrEnum
from hashlib import blake2b
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

SEED_LIMIT = 2**31
"""SUMO takes seeds below this."""


class Purpose(StrEnum):
    """What is drawn. The names are part of every seed's result."""

    PHRASING = "phrasing"
    """The order in which instances take the phrasings."""
    PARAMETERS = "parameters"
    """The order in which instances take the values of the parameters."""
    CONTENT = "content"
    """Media, places, people and the driver's data in the cockpit."""
    DRIVER = "driver"
    """The driver's reactions and speed."""
    SKY = "sky"
    """Weather that comes from the climate."""
    RECEIVER = "receiver"
    """Errors of the GPS receiver."""
    TRIPS = "trips"
    """The order in which trips are tried."""
    DRIVE = "drive"
    """The plan of a drive."""


@dataclass(frozen=True, slots=True)
class Draws:
    """The streams of one instance of a task."""

    task_id: str
    number: int
    """Which instance, from 0: see ``tasking.instance.draw``."""
    redrawn: int = 0
    """Which content of the same instance, from 0; nothing else is drawn anew."""

    def rng(self, purpose: Purpose) -> np.random.Generator:
        """The purpose's stream from its beginning."""
        import numpy as np  # takes longer than to list what could be drawn

        return np.random.default_rng(self._entropy(purpose))

    def seed(self, purpose: Purpose) -> int:
        """A seed for what makes streams of its own, below ``SEED_LIMIT``."""
        return int(self._entropy(purpose).generate_state(1)[0]) % SEED_LIMIT

    def _entropy(self, purpose: Purpose) -> np.random.SeedSequence:
        import numpy as np

        anew = (self.redrawn,) if self.redrawn and purpose is Purpose.CONTENT else ()
        return np.random.SeedSequence(self.number, spawn_key=(_key(self.task_id), _key(purpose), *anew))


def keyed(key: bytes, *names: str) -> int:
    """A number below ``SEED_LIMIT`` that nobody can tell without the key."""
    return int.from_bytes(hmac.digest(key, "\0".join(names).encode(), "sha256")) % SEED_LIMIT


def _key(name: str) -> int:
    """A number for the name; ``hash`` would give another one in each process."""
    return int.from_bytes(blake2b(name.encode(), digest_size=8).digest())
