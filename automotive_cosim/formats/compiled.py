"""What is made of shipped files, kept beside them as Python keeps bytecode: where it may write, for one program.

To read all tasks takes most of a second, and an eighth of it once they are kept.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from importlib.util import cache_from_source
from pathlib import Path
from typing import TypeVar

from automotive_cosim.formats.writing import make_folder, write_whole

T = TypeVar("T")
PACKAGE = Path(__file__).parents[1]


def compiled(files: Sequence[Path], make: Callable[[], T]) -> T:
    """What is made of shipped files and of nothing else, from the cache of the first if all are as they were."""
    kept = Path(cache_from_source(str(files[0]))).with_suffix(".pickle")
    seen = blake2b(program() + b"".join(file.read_bytes() for file in files), digest_size=16).digest()
    with suppress(OSError):
        stored = kept.read_bytes()
        if stored.startswith(seen):
            found: T = pickle.loads(stored[len(seen) :])
            return found
    made = make()
    if not sys.dont_write_bytecode:
        with suppress(OSError):
            write_whole(make_folder(kept.parent) / kept.name, seen + pickle.dumps(made))
    return made


@cache
def program() -> bytes:
    """Tells this program's code and tables and its Python from others, by the sizes and times of the files."""
    return blake2b(repr((sys.version, *_code(str(PACKAGE)))).encode()).digest()


def _code(folder: str) -> Iterator[tuple[str, int, int]]:
    for each in sorted(os.scandir(folder), key=lambda each: each.name):
        if each.is_dir() and each.name != "__pycache__":
            yield from _code(each.path)
        elif each.name.endswith((".py", ".toml")):
            yield each.path, (about := each.stat()).st_size, about.st_mtime_ns
