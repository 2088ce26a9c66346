"""Keeps a process of SUMO from writing outside its folders and from the network, where the kernel can (Landlock).

Vetting leaves nothing that would write; this holds for what vetting might overlook. The rules apply to the process
and everything it starts, and cannot be taken back. No privileges are needed.

    python confinement.py FOLDER PROGRAM [ARGUMENT]...

confines itself to the folder and then becomes the program. The system calls are those of the kernel's documentation
(``userspace-api/landlock``); the numbers of these newer calls are the same on every processor but Alpha.
"""

from __future__ import annotations

import ctypes
import os
import platform
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
"""Numbers of the system calls."""

PR_SET_NO_NEW_PRIVS = 38
VERSION_ONLY = 1
PATH_BENEATH = 1

WRITE_FILE = 1 << 1
CHANGES = WRITE_FILE | sum(1 << bit for bit in range(4, 13))
"""Writing a file, removing files and folders, making anything that a folder can hold."""

MOVE, TRUNCATE = 1 << 13, 1 << 14
"""Rights since versions 2 and 3."""

BIND_AND_CONNECT = 3
"""Rights to TCP, since version 4."""


class _Ruleset(ctypes.Structure):
    _fields_ = (("files", ctypes.c_uint64), ("network", ctypes.c_uint64))


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32))


@cache
def version() -> int:
    """The version of Landlock that the kernel offers; 0 if it offers none."""
    if sys.platform != "linux" or platform.machine() == "alpha":
        return 0
    return max(0, _call(CREATE_RULESET, None, 0, VERSION_ONLY))


def confine(folders: Iterable[Path]) -> bool:
    """Lets this thread, and what it starts, write only below some folders and open no connection.

    Returns:
        Whether the kernel does so."""
    offered = version()
    if not offered:
        return False
    rights = CHANGES | (MOVE if offered >= 2 else 0) | (TRUNCATE if offered >= 3 else 0)
    rules = _Ruleset(rights, BIND_AND_CONNECT)
    size = ctypes.sizeof(_Ruleset) if offered >= 4 else ctypes.sizeof(ctypes.c_uint64)
    ruleset = _call(CREATE_RULESET, ctypes.byref(rules), size, 0)
    if ruleset < 0:
        return False
    try:
        allowed = [(folder, rights) for folder in folders]
        allowed.append((Path(os.devnull), WRITE_FILE | (TRUNCATE if offered >= 3 else 0)))
        if not all(_allow(ruleset, path, beneath) for path, beneath in allowed):
            return False
        libc = ctypes.CDLL(None, use_errno=True)
        libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
        return _call(RESTRICT_SELF, ruleset, 0) == 0
    finally:
        os.close(ruleset)


def confined(folder: Path, command: list[str]) -> list[str]:
    """The command line that runs a program confined to a folder; the program's own where that cannot be."""
    if not version():
        return command
    return [sys.executable, "-I", "-S", __file__, str(folder), *command]


def _allow(ruleset: int, path: Path, rights: int) -> bool:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        return _call(ADD_RULE, ruleset, PATH_BENEATH, ctypes.byref(_Beneath(rights, descriptor)), 0) == 0
    finally:
        os.close(descriptor)


def _call(number: int, *arguments: object) -> int:
    return int(ctypes.CDLL(None, use_errno=True).syscall(number, *arguments))


if __name__ == "__main__":
    confine([Path(sys.argv[1])])
    os.execv(sys.argv[2], sys.argv[2:])
