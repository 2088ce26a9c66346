"""What can be set about the pages. Each field is an option of ``serve``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from automotive_cosim.doors.settings import read_address
from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class ServeSettings:
    """Where the pages are, and what people may do there."""

    http: Annotated[
        tuple[str, int], Option(form="HOST:PORT", default="127.0.0.1 and a free port", read=read_address)
    ] = ("127.0.0.1", 0)
    """Address to listen at; by default, only this machine can connect."""
    play: bool = False
    """Let one person at a time operate the cockpit, judged as agents are."""
    study: Annotated[Path | None, Option(form="FILE")] = None
    """TOML file of a study: deals its episodes to several people, each on their own page."""
