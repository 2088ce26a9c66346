"""What can be set about the pages. Each field is an option of ``serve``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class ServeSettings:
    """Where the pages are, and what people may do there."""

    host: str = "127.0.0.1"
    """Address to listen on; by default, only this machine can connect."""
    port: Annotated[int, Ge(0), Le(65535)] = 0
    """Port to listen on; 0 picks a free one."""
    play: bool = False
    """Let one person at a time operate the cockpit, judged as agents are."""
    study: Annotated[Path | None, Option(form="FILE")] = None
    """TOML file of a study: deals its episodes to several people, each on their own page."""
