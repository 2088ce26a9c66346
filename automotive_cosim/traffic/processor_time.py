"""Processor time of other processes, by which one can tell a busy machine from a program that hangs."""

from __future__ import annotations

import os
from pathlib import Path

PROC = Path("/proc")
"""Where Linux reports processor time."""


def processor_s(pid: int) -> float | None:
    """Seconds of processor time that a process has used; None if it has ended or the system does not tell."""
    try:
        stat = (PROC / str(pid) / "stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    fields = stat.rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
