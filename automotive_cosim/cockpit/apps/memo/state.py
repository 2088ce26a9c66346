"""Spoken memos."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.state import AppData


@dataclass(frozen=True, slots=True)
class Memos(AppData):
    """The memos, and the one that is being recorded."""

    kept: tuple[str, ...] = ()
    recording_since_s: float | None = None

    def commands(self) -> dict[str, Any]:
        """The memos, and whether one is being recorded."""
        return {"apps.memos": list(self.kept), "apps.recording": self.recording_since_s is not None}
