"""Ends what an agent leaves behind: processes that outlive everything that was started for it, and its folder.

A process whose parent ends becomes the child of its nearest ancestor that takes orphans. An agent's processes have
sessions of their own and can enter no other, so that whoever takes them in tells them from its own children.
"""

from __future__ import annotations

import ctypes
import os
import secrets
import signal
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress
from pathlib import Path

SWEEP_S = 5.0
"""Longest wall time to end all that an agent has started."""
REMOVE_S, LATER_S = 1.0, 600.0
"""Wall time to remove its folder before anything else goes on, and beside what goes on. What is left then stays in
the system's folder for temporary files."""
POLL_S = 0.002
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
"""Of Linux's prctl."""


def take_orphans() -> None:
    """From now on, orphans among this process's descendants become its children (on Linux)."""
    _prctl(PR_SET_CHILD_SUBREAPER, 1)


def end_with_parent() -> None:
    """From now on, this process is killed when the thread that started it ends (on Linux)."""
    _prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def how_it_ended(code: int) -> str:
    """The end of a process by its exit code, which is negative after a signal."""
    if code < 0:
        return f"its process was killed by {signal.Signals(-code).name}"
    return f"its process exited with code {code}"


def children(pid: int | str = "self") -> list[int]:
    """The children of a process, of all its threads; none where the system does not list them."""
    found: list[int] = []
    for listed in Path("/proc", str(pid), "task").glob("*/children"):
        with suppress(OSError):  # the thread or the process has ended
            found += map(int, listed.read_text(encoding="ascii").split())
    return found


def tree(pid: int) -> tuple[int, ...]:
    """A process and its descendants; without ``/proc``, only the process itself."""
    found = [pid]
    for each in found:  # which grows
        found += children(each)
    return tuple(found)


def strangers(known: Collection[int]) -> list[int]:
    """Children of this process in other sessions than its own, which were not known before."""
    found = []
    for pid in children():
        with suppress(OSError):
            if pid not in known and os.getsid(pid) != os.getsid(0):
                found.append(pid)
    return found


def end_all(find: Callable[[], Iterable[int]], grace_s: float = 0.0) -> None:
    """Kills and reaps children of this process, with all their descendants, until none is found.

    Args:
        find: the children to end; called again and again, because they may start others meanwhile.
        grace_s: wall seconds in which they may end by themselves."""
    gone: set[int] = set()
    began_s = time.monotonic()
    while (passed_s := time.monotonic() - began_s) < grace_s + SWEEP_S:
        found = [pid for pid in find() if pid not in gone]
        if not found:
            return
        for pid in (each for child in found for each in tree(child)) if passed_s >= grace_s else ():
            with suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        for pid in found:
            try:
                os.waitpid(pid, os.WNOHANG)
            except ChildProcessError:
                gone.add(pid)
        time.sleep(POLL_S)


def remove(folder: Path) -> None:
    """Removes a folder; what takes long goes on beside what this process does next.

    It may be nested deeper than Python recurses and than a path is long: each folder is moved to the top before it
    is emptied."""
    if not _is_removed(folder, REMOVE_S):
        threading.Thread(target=_is_removed, args=(folder, LATER_S), daemon=True).start()


def _is_removed(folder: Path, within_s: float) -> bool:
    """Removes a folder, and tells whether that is all that can be done."""
    end_s = time.monotonic() + within_s
    with suppress(OSError):
        if folder.is_symlink():  # the agent has put it there
            folder.unlink()
        while _thinned(folder, end_s):
            pass
        folder.rmdir()
    return time.monotonic() <= end_s


def _thinned(top: Path, end_s: float) -> bool:
    """Empties each folder in a folder, and moves the folders in it to the top; false if that removed nothing."""
    has_removed = False
    for path in _listed(top):
        if time.monotonic() > end_s:
            return False
        with suppress(OSError):
            if _is_folder(path):
                _empty(path, top)
            else:
                path.unlink()
            has_removed = True
    return has_removed


def _empty(folder: Path, top: Path) -> None:
    folder.chmod(0o700)
    for path in _listed(folder):
        if _is_folder(path):
            path.chmod(0o700)
            path.rename(top / secrets.token_hex(8))
        else:
            path.unlink()
    folder.rmdir()


def _listed(folder: Path) -> Iterator[Path]:
    with os.scandir(folder) as entries:  # one at a time: there may be millions
        for entry in entries:
            yield Path(entry.path)


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _prctl(option: int, value: int) -> None:
    """Linux's prctl; nothing elsewhere."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)
