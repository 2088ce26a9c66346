"""Files that users give, texts written by hand and data that may be packed; and files that are written whole."""

from __future__ import annotations

import bz2
import codecs
import errno
import gc
import gzip
import io
import json
import lzma
import os
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from automotive_cosim.errors import UserError
from automotive_cosim.formats.plain import plain

MOST_BYTES = 2**20
"""Nobody writes more by hand, and a wrong path may be a device that never ends."""

MOST_UNPACKED_BYTES = 2**30
FREELY_UNPACKED_BYTES = 2**26
MOST_TIMES = 100
"""An archive may unpack to 64 MB, or to a hundred times its size, at most to 1 GB. SUMO's and OpenStreetMap's XML
packs ten to thirty times; a bomb, a thousand times."""
CHUNK_BYTES = 2**16
MOST_VALUES = 5_000_000
"""JSON may hold that many values, which take at most half a gigabyte: 60 MB of empty lists would take thirty times
their size. Half an hour of a drive has a million."""


def read_text(path: Path, error: type[UserError] = UserError) -> str:
    """The text, with line ends as they are on Unix and without a byte order mark.

    Raises:
        UserError: of that class: it cannot be opened, is too large, or is not UTF-8.
    """
    try:
        with open_file(path) as file:
            data = file.read(MOST_BYTES + 1)
        text = data.decode("utf-8-sig")
    except OSError as broken:
        raise error(f"cannot read {path}: {broken.strerror or broken}; give a file that is there") from broken
    except UnicodeDecodeError as broken:
        raise error(f"cannot read {path}: it is not UTF-8 text; save it as UTF-8") from broken
    if len(data) > MOST_BYTES:
        raise error(f"cannot read {path}: it is larger than {MOST_BYTES // 2**20} MB; give a file written by hand")
    return text.replace("\r\n", "\n")


def read_json(path: Path, most_values: int = MOST_VALUES) -> Any:
    """What a JSON file holds, also packed.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not JSON, or holds more values.
    """
    data = bytearray()  # grows with the file: reading a gigabyte at once would reserve it
    with opened(path) as file:
        while chunk := file.read(CHUNK_BYTES):
            data += chunk
            if len(data) > MOST_UNPACKED_BYTES:
                raise ValueError("it is larger than 1 GB")
    return parse_json(bytes(data), most_values)


def read_json_lines(path: Path) -> list[Any]:
    """What the lines of a file of JSON hold, also packed.

    Raises:
        OSError: it cannot be read.
        ValueError: a line is not JSON, or all together hold too many values.
    """
    found, left = [], MOST_VALUES
    with opened(path) as file:
        for line in file:
            found.append(parse_json(line, left))
            left -= _values(line)
    return found


def read_whole_lines(path: Path) -> list[Any]:
    """What the lines of a file of JSON hold that may still grow: a last line that is cut short is ignored.

    Raises:
        OSError: it cannot be read.
        ValueError: a line is not JSON, or holds too many values.
    """
    with open_file(path) as file:
        *lines, _cut = file.read().split(b"\n")
    return [parse_json(line) for line in lines]


def parse_json(text: str | bytes, most_values: int = MOST_VALUES) -> Any:
    """What a text of JSON holds.

    Raises:
        ValueError: it is not JSON, nested deeper than Python reads, or holds more values.
    """
    if len(text) > most_values and _values(text) > most_values:
        raise ValueError("it holds too many values")
    try:
        return json.loads(text)
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error


def _values(text: str | bytes) -> int:
    """How many values a text of JSON can hold at most: commas and brackets in its texts are counted too."""
    if isinstance(text, str):
        return sum(map(text.count, "[{,")) + 1
    return sum(map(text.count, (b"[", b"{", b","))) + 1


def is_file(path: Path) -> bool:
    """Whether there is a regular file of that name, which may be any text."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # longer than names can be, or with a zero
        return False


def open_file(path: Path) -> IO[bytes]:
    """Opens a regular file to read it. Anything else is refused unopened: a pipe would wait for a writer, and
    opening a device may already do something.

    Raises:
        OSError: it cannot be opened, or is not a regular file.
    """
    _refuse_special(path, path.stat().st_mode)
    # What has taken its place since does not block either.
    file = os.fdopen(os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NONBLOCK", 0)), "rb")
    try:
        _refuse_special(path, os.fstat(file.fileno()).st_mode)
    except BaseException:
        file.close()
        raise
    return file


def _refuse_special(path: Path, mode: int) -> None:
    """
    Raises:
        OSError: it is not a regular file.
    """
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise OSError(f"{path} is not a regular file")


def opened(path: Path) -> IO[bytes]:
    """The bytes of a file, unpacked if they are gzip's, bzip2's or xz's, whatever it is called.

    Raises:
        OSError: it cannot be opened or is not a regular file. Reading raises it too, where an archive is damaged or
            unpacks to too much.
    """
    file = open_file(path)
    try:
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


def is_utf8(path: Path) -> bool:
    """Whether the text of a file, packed or not, is in UTF-8.

    Raises:
        OSError: it cannot be read.
    """
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        with opened(path) as file:
            while piece := file.read(2**20):
                decoder.decode(piece)
    except UnicodeDecodeError:
        return False
    return True


@contextmanager
def drafted(path: Path) -> Iterator[Path]:
    """A draft beside a file, which takes its place at the end, so that the file is there completely or not at all.

    Raises:
        OSError: it cannot be written; the error names the file, and not its draft.
    """
    draft = path.with_name(f".{path.name}.part")
    try:
        yield draft
        draft.replace(path)
    except OSError as error:
        draft.unlink(missing_ok=True)
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


@contextmanager
def without_collection() -> Iterator[None]:
    """Collects no garbage meanwhile: what is read stays, and looking through it again and again takes a fifth of
    the time of a large file."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def write_whole(path: Path, content: str | bytes) -> None:
    """Writes a file, a text as plain text, as ``drafted`` does."""
    with drafted(path) as draft:
        draft.write_bytes(content if isinstance(content, bytes) else plain(content).encode())
