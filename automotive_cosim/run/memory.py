"""Memory of this process and all its descendants, from Linux's accounting."""

from __future__ import annotations

import os
from pathlib import Path

from automotive_cosim.agents.leftovers import tree

PROC = Path("/proc")


def rss_mb() -> float | None:
    """Resident memory of the tree in megabytes, with shared pages counted once (PSS); None except on Linux."""
    if not (PROC / "self" / "smaps_rollup").is_file():
        return None
    return sum(map(_pss_kb, tree(os.getpid()))) / 1024


def _pss_kb(pid: int) -> int:
    try:
        text = (PROC / str(pid) / "smaps_rollup").read_text()
    except OSError:  # it has ended too
        return 0
    return next((int(line.split()[1]) for line in text.splitlines() if line.startswith("Pss:")), 0)
