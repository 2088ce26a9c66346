"""Files that users give: texts written by hand, and data that may be packed."""

from __future__ import annotations

import bz2
import gzip
import io
import json
import lzma
import stat
import zlib
from pathlib import Path
from typing import IO, Any

from automotive_cosim.errors import UserError

MOST_BYTES = 2**20
"""Nobody writes more by hand, and a wrong path may be a device that never ends."""

MOST_UNPACKED_BYTES = 2**30
FREELY_UNPACKED_BYTES = 2**26
MOST_TIMES = 100
"""An archive may unpack to 64 MB, or to a hundred times its size, at most to 1 GB. SUMO's and OpenStreetMap's XML
packs ten to thirty times; a bomb, a thousand times."""
CHUNK_BYTES = 2**16


def read_text(path: Path, error: type[UserError] = UserError) -> str:
    """The text, with line ends as they are on Unix and without a byte order mark.

    Raises:
        UserError: of that class: it cannot be opened, is too large, or is not UTF-8.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
        text = data.decode("utf-8-sig")
    except OSError as broken:
        raise error(f"cannot read {path}: {broken.strerror or broken}; give a file that is there") from broken
    except UnicodeDecodeError as broken:
        raise error(f"cannot read {path}: it is not UTF-8 text; save it as UTF-8") from broken
    if len(data) > MOST_BYTES:
        raise error(f"cannot read {path}: it is larger than {MOST_BYTES // 2**20} MB; give a file written by hand")
    return text.replace("\r\n", "\n")


def read_json(path: Path) -> Any:
    """What a JSON file holds, also packed.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not JSON.
    """
    with opened(path) as file:
        data = file.read(MOST_UNPACKED_BYTES + 1)
    if len(data) > MOST_UNPACKED_BYTES:
        raise ValueError("it is larger than 1 GB")
    return parse_json(data)


def parse_json(text: str | bytes) -> Any:
    """What a text of JSON holds.

    Raises:
        ValueError: it is not JSON, or nested deeper than Python reads.
    """
    try:
        return json.loads(text)
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error


def is_file(path: Path) -> bool:
    """Whether there is a regular file of that name, which may be any text."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # longer than names can be, or with a zero
        return False


def opened(path: Path) -> IO[bytes]:
    """The bytes of a file, unpacked if they are gzip's, bzip2's or xz's, whatever it is called.

    Raises:
        OSError: it cannot be opened or is not a regular file. Reading raises it too, where an archive is damaged or
            unpacks to too much.
    """
    file = path.open("rb")
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise OSError(f"{path} is not a regular file")
        head = file.read(6)
        file.seek(0)
        if head.startswith(b"\x1f\x8b"):
            return io.BufferedReader(_Unpacked(gzip.GzipFile(fileobj=file), path, file), CHUNK_BYTES)
        if head.startswith(b"BZh"):
            return io.BufferedReader(_Unpacked(bz2.BZ2File(file), path, file), CHUNK_BYTES)
        if head == b"\xfd7zXZ\x00":
            return io.BufferedReader(_Unpacked(lzma.LZMAFile(file), path, file), CHUNK_BYTES)
    except BaseException:
        file.close()
        raise
    return file


class _Unpacked(io.RawIOBase):
    """An archive's content, up to a size."""

    def __init__(self, content: gzip.GzipFile | bz2.BZ2File | lzma.LZMAFile, path: Path, packed: IO[bytes]) -> None:
        self._content = content
        self._path = path
        self._packed = packed
        self._size = 0
        packed_bytes = path.stat().st_size
        self._limit = max(FREELY_UNPACKED_BYTES, min(MOST_UNPACKED_BYTES, MOST_TIMES * packed_bytes))

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: bytearray | memoryview) -> int:  # type: ignore[override]
        try:
            data = self._content.read(len(buffer))
        except (EOFError, zlib.error, lzma.LZMAError) as error:
            raise OSError(f"the archive is damaged: {error}") from error
        self._size += len(data)
        if self._size > self._limit:
            raise OSError(f"it unpacks to over {self._limit / 1e6:.0f} MB; if you trust it, unpack it yourself")
        buffer[: len(data)] = data
        return len(data)

    def close(self) -> None:
        if not self.closed:
            self._content.close()
            self._packed.close()
        super().close()
