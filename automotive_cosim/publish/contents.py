"""``bundle.json``: what a bundle holds, with a hash of every file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Literal

from annotated_types import Ge

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import Form
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.run.coverage import Coverage

NAME = "bundle.json"
FORMAT: Literal[1] = 1

Sha256 = Annotated[str, Form("^[0-9a-f]{64}$", "64 hexadecimal digits")]


@dataclass(frozen=True, slots=True)
class BundleCounts:
    """How many of the planned episodes were judged, ended in an error or were not run."""

    planned: Annotated[int, Ge(0)]
    """Episodes in the plan."""
    judged: Annotated[int, Ge(0)]
    """Episodes with a verdict."""
    successes: Annotated[int, Ge(0)]
    """Episodes judged a success."""
    errors: Annotated[int, Ge(0)]
    """Episodes that ended in an infrastructure error."""
    not_run: Annotated[int, Ge(0)]
    """Episodes that were planned but not run."""


@dataclass(frozen=True, slots=True)
class Contents:
    """The file ``bundle.json``, the first in a bundle."""

    format: Literal[1]
    """Format of the bundle; any other is refused."""
    suite: str
    """Version of automotive-cosim that ran the evaluation."""
    counts: BundleCounts
    """Counts of the planned episodes."""
    files: Mapping[str, Sha256]
    """SHA-256 of every other file, by its path in the bundle."""

    def text(self) -> str:
        """The only valid form of the file."""
        return json.dumps(asdict(self), indent=1, sort_keys=True) + "\n"

    @property
    def sha256(self) -> str:
        """Hash of the file, and with it of the whole bundle: publish it where the bundle cannot be changed."""
        return hashlib.sha256(self.text().encode()).hexdigest()


def counts(found: Coverage, successes: int) -> BundleCounts:
    """The counts of an evaluation.

    Args:
        found: how much of its plan has been run."""
    return BundleCounts(found.planned, found.judged, successes, found.errors, len(found.not_run))


def read_contents(folder: Path) -> Contents:
    """The file of an unpacked bundle.

    Raises UserError: it cannot be read, is of another format or does not fit its schema."""
    path = folder / NAME
    try:
        values: Json = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise UserError(f"cannot read {NAME}: {error}") from error
    found = values.get("format") if isinstance(values, dict) else None
    if found != FORMAT:
        raise UserError(
            f"{NAME} has format {found!r}, and this version reads {FORMAT}; read it with the version that wrote it"
        )
    return checked(Contents, values, lambda steps: (NAME, dotted(steps)))
