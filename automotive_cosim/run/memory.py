"""Memory of this process and all its descendants, from Linux's accounting."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

PROC = Path("/proc")


def tree(pid: int | None = None) -> tuple[int, ...]:
    """This process, or another one, and its descendants; without ``/proc``, only the process itself."""
    return tuple(_descend(os.getpid() if pid is None else pid))


def rss_mb() -> float | None:
    """Resident memory of the tree in megabytes, with shared pages counted once (PSS); None except on Linux."""
    if not (PROC / "self" / "smaps_rollup").is_file():
        return None
    return sum(map(_pss_kb, tree())) / 1024


def _descend(pid: int) -> Iterator[int]:
    yield pid
    for children in (PROC / str(pid) / "task").glob("*/children"):
        try:
            listed = children.read_text()
        except OSError:  # the process has ended meanwhile
            continue
        for child in listed.split():
            yield from _descend(int(child))


def _pss_kb(pid: int) -> int:
    try:
        text = (PROC / str(pid) / "smaps_rollup").read_text()
    except OSError:  # it has ended too
        return 0
    return next((int(line.split()[1]) for line in text.splitlines() if line.startswith("Pss:")), 0)
