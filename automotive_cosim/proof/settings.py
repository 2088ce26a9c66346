"""What can be set about proofs. Each field is an option of ``tasks validate``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import Option
from automotive_cosim.tasking.sets import Suite


@dataclass(frozen=True, slots=True)
class PartOf:
    """One of several parts, as in ``3/10``."""

    number: int
    of: int

    @classmethod
    def read(cls, text: str) -> PartOf:
        """The part that a text names. Raises UserError: it names none."""
        found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text)
        part = cls(int(found[1]), int(found[2])) if found else cls(0, 0)
        if not 1 <= part.number <= part.of:
            raise UserError(f"--part: {text!r} is not a part such as 3/10")
        return part

    def taken(self, all_of_them: tuple[str, ...]) -> tuple[str, ...]:
        """Every Nth item, so that all parts together have every item."""
        return all_of_them[self.number - 1 :: self.of]


@dataclass(frozen=True, slots=True)
class ProofSettings:
    """What is proved."""

    tasks: tuple[str, ...] = ("all",)
    """Ids, patterns, tags, modules, dimensions, subsets, abilities, core, general, safety, all; separated by
    commas."""
    suite: str = str(Suite.STANDARD)
    """Suite: standard, hard, limits, clarify, speed, voice, camera, people, live or all. An id selects a task in
    any, and core sixty."""
    part: Annotated[PartOf | None, Option(form="K/N", read=PartOf.read)] = None
    """Prove only part K of N, as in 3/10; together, the parts are all tasks."""
    seeds: tuple[int, ...] = (0, 1, 2)
    """Seeds, as in 0-4 or 0,3,7."""
    gates: tuple[str, ...] = ("all",)
    """Gates to try, separated by commas, by their names in the table; or all."""
    workers: Annotated[int, Ge(1), Le(256)] = 1
    """Number of processes."""
    out: Path | None = None
    """Folder for the proofs; an existing one is resumed. Without it, nothing is kept."""
    against: Path | None = None
    """Earlier output of --json: the reference solutions must still give the same traces."""
