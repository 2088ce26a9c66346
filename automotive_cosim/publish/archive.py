"""A bundle as an archive: a zip of unpacked files, the same bytes for the same files, which xz packs as a whole.

Episodes repeat one another's screens and prompts, so that together they take a fifth of what they take one by one.

bundle.json                      what is in it (``contents``)
manifest.json                    the plan; versions, platform and state of the code at each start
episodes.jsonl                   one line per episode, by id
traces/ID.jsonl.gz               the steps of an episode and its result
traces/ID.judged.json.xz         the input of its verdict
"""

from __future__ import annotations

import lzma
import re
import shutil
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import opened
from automotive_cosim.formats.writing import drafted, make_folder
from automotive_cosim.publish.contents import NAME

MEMBER = re.compile(
    r"bundle\.json|manifest\.json|episodes\.jsonl|traces/[\w.-]{1,200}\.(?:jsonl\.gz|judged\.json\.xz)"
)
"""What may be in a bundle."""
MOST_BYTES, MOST_TIMES = 8 * 2**30, 1000
"""What a bundle may unpack to, and as a multiple of its size: many episodes of the same tasks pack 200-fold."""
_LONG_AGO = (1980, 1, 1, 0, 0, 0)
"""The time of every file: the earliest that a zip can store."""


def members(folder: Path) -> list[str]:
    """The paths of the files in an unpacked bundle, in their order in the archive."""
    found = [path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()]
    return sorted(found, key=lambda name: (name != NAME, name))


def pack(folder: Path, file: IO[bytes]) -> None:
    """Packs the files of a folder. Raises OSError: the archive cannot be written."""
    with tempfile.TemporaryFile() as whole, lzma.open(file, "wb") as packed:
        lay_out(folder, whole)
        whole.seek(0)
        shutil.copyfileobj(whole, packed)


def lay_out(folder: Path, file: IO[bytes]) -> None:
    """Writes the archive that is packed. Raises OSError: it cannot be written."""
    with zipfile.ZipFile(file, "w") as archive:
        for name in members(folder):
            entry = zipfile.ZipInfo(name, _LONG_AGO)
            entry.create_system, entry.external_attr = 3, 0o644 << 16
            entry.file_size = (folder / name).stat().st_size
            with archive.open(entry, "w") as target, (folder / name).open("rb") as source:
                shutil.copyfileobj(source, target)


def content(bundle: Path) -> IO[bytes]:
    """The archive that is packed in a bundle. Raises OSError: it cannot be opened; when read, it is too large."""
    return opened(bundle, most_bytes=min(MOST_BYTES, MOST_TIMES * bundle.stat().st_size))


@contextmanager
def unpacked(bundle: Path) -> Iterator[Path]:
    """A bundle's files in a folder that is removed afterwards. Raises UserError: as ``unpack``."""
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-bundle-") as name:
        unpack(bundle, Path(name))
        yield Path(name)


def unpack(bundle: Path, folder: Path) -> None:
    """Unpacks a bundle into an empty folder.

    Raises UserError: it is not a bundle, or contains a file that does not belong there."""
    make_folder(folder, "traces")
    try:
        with content(bundle) as source, tempfile.TemporaryFile() as file:
            shutil.copyfileobj(source, file)
            size = file.tell()
            with zipfile.ZipFile(file) as archive:
                _unpack(bundle, archive, size, folder)
    except (zipfile.BadZipFile, NotImplementedError, OSError, EOFError, ValueError, RuntimeError) as error:
        fault = getattr(error, "strerror", None) or error  # without the number, and the path a second time
        raise UserError(
            f"{bundle} is not a bundle: {fault}; `automotive-cosim publish bundle` makes one"
        ) from error


def _unpack(bundle: Path, archive: zipfile.ZipFile, size: int, folder: Path) -> None:
    left = min(MOST_BYTES, size)  # nothing is compressed, so together they are smaller than that
    for entry in archive.infolist():
        path = folder / entry.filename
        left -= entry.file_size
        if not MEMBER.fullmatch(entry.filename) or path.exists():
            raise UserError(
                f"{bundle} contains {entry.filename[:100]!r}, which does not belong in a bundle or is there twice"
            )
        if entry.compress_type != zipfile.ZIP_STORED or left < 0:
            raise UserError(
                f"{bundle} has a compressed file, is over {MOST_BYTES >> 30} GB or holds more than its size; "
                "a bundle does not"
            )
        with archive.open(entry) as source, drafted(path) as target:
            shutil.copyfileobj(source, target)
    if not (folder / NAME).is_file():
        raise UserError(f"{bundle} is not a bundle: it has no {NAME}; `automotive-cosim publish bundle` makes one")
