"""What can be set about a check. Each field is an option of ``publish verify``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class VerifySettings:
    """Which drives of an evaluation are driven again."""

    replays: Annotated[int, Ge(0), Le(10**6), Option("replay")] = 3
    """How many drives to replay and compare bit for bit."""
    seed: Annotated[int | None, Ge(0), Le(2**31 - 1), Option("replay-seed", default="a new one each time")] = None
    """Seed that draws the drives to replay."""
