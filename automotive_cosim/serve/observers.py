"""Tells running programs that somebody observes them, by a lock that the system releases with this process."""

from __future__ import annotations

import threading
from contextlib import suppress
from pathlib import Path
from typing import IO

from automotive_cosim.formats.writing import mark_as_written

PATIENCE_S = 10.0
"""An observer that has not asked for this long has left."""


class StudyObservers:
    """Locks the files of what is observed; nothing is written into them."""

    def __init__(self, patience_s: float = PATIENCE_S) -> None:
        self._patience_s = patience_s
        self._marked: dict[Path, tuple[IO[bytes], threading.Timer]] = {}
        self._lock = threading.Lock()

    def observe(self, path: Path) -> None:
        """Locks a file for some seconds, unless another program has already locked it.

        Raises OSError: it cannot be read."""
        with self._lock:
            file, timer = self._marked.get(path, (None, None))
            if timer is not None:
                timer.cancel()
            file = file or path.open("rb")
            mark_as_written(file)
            timer = threading.Timer(self._patience_s, self._leave, (path,))
            timer.daemon = True
            timer.start()
            self._marked[path] = file, timer

    def close(self) -> None:
        for path in list(self._marked):
            self._leave(path)

    def _leave(self, path: Path) -> None:
        with self._lock, suppress(KeyError):
            file, timer = self._marked.pop(path)
            timer.cancel()
            file.close()
