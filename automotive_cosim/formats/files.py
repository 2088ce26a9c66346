"""Files that users give: texts written by hand, and data that may be packed."""

from __future__ import annotations

import bz2
import codecs
import errno
import gzip
import hashlib
import io
import json
import lzma
import os
import stat
import zlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import IO, Any

from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds


def read_text(path: Path, error: type[UserError] = UserError) -> str:
    """The text, with line ends as they are on Unix and without a byte order mark.

    Raises UserError: of that class: it cannot be opened, is too large, or is not UTF-8."""
    try:
        with open_file(path) as file:
            data = file.read(bounds.TEXT_BYTES + 1)
        text = data.decode("utf-8-sig")
    except OSError as broken:
        raise error(f"cannot read {path}: {broken.strerror or broken}; give a file that is there") from broken
    except UnicodeDecodeError as broken:
        raise error(f"cannot read {path}: it is not UTF-8 text; save it as UTF-8") from broken
    if len(data) > bounds.TEXT_BYTES:
        most = f"{bounds.TEXT_BYTES / 2**20:g} MB"
        raise error(f"cannot read {path}: it is larger than {most}; give a file written by hand")
    return text.replace("\r\n", "\n")


def read_bytes(path: Path) -> bytes:
    """The content of a file, at most ``bounds.WHOLE_BYTES``. Raises OSError: it cannot be read, or is larger."""
    with open_file(path) as file:
        data = file.read(bounds.WHOLE_BYTES + 1)
    if len(data) > bounds.WHOLE_BYTES:
        raise OSError(f"{path} is larger than {bounds.WHOLE_BYTES / 2**20:g} MB")
    return data


def read_json(path: Path, most_values: int | None = None) -> Any:
    """What a JSON file holds, also packed.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not JSON, or holds more values."""
    return parse_json(read_unpacked(path), most_values)


def read_unpacked(path: Path) -> bytes:
    """The content of a file, also packed, at most ``bounds.UNPACKED_BYTES``.

    Raises:
        OSError: it cannot be read.
        ValueError: it is larger."""
    data = bytearray()  # grows with the file: reading a gigabyte at once would reserve it
    with opened(path) as file:
        while chunk := file.read(bounds.CHUNK_BYTES):
            data += chunk
            if len(data) > bounds.UNPACKED_BYTES:
                raise ValueError("it is larger than 1 GB")
    return bytes(data)


def read_json_lines(path: Path) -> list[Any]:
    """What the lines of a file of JSON hold, also packed.

    Raises:
        OSError: it cannot be read.
        ValueError: a line is not JSON or too long, or all together hold too many values."""
    with opened(path) as file:
        return list(json_lines(file))


def read_whole_lines(path: Path) -> list[Any]:
    """The same of a file that may still grow: a last line that is cut short is ignored.

    Raises:
        OSError: it cannot be read.
        ValueError: as ``read_json_lines``."""
    with opened(path, growing=True) as file:
        return list(json_lines(file, growing=True))


def json_lines(file: IO[bytes], most_values: int | None = None, *, growing: bool = False) -> Iterator[Any]:
    """What each line of an open file of JSON holds.

    Args:
        most_values: of all lines together; by default ``bounds.VALUES``.
        growing: whether to ignore a last line that is cut short.

    Raises:
        OSError: it cannot be read.
        ValueError: a line is not JSON or too long, or all together hold too many values."""
    left = bounds.VALUES if most_values is None else most_values
    while line := file.readline(bounds.LINE_BYTES + 1):
        if len(line) > bounds.LINE_BYTES:
            raise ValueError(f"a line is longer than {bounds.LINE_BYTES >> 20} MB")
        if not growing or line.endswith(b"\n"):
            yield parse_json(line, left)
            left -= _values(line)
        elif line[:1] not in (b"{", b"["):
            raise ValueError("it holds no lines of JSON")


def parse_json(text: str | bytes, most_values: int | None = None) -> Any:
    """What a text of JSON holds.

    Raises ValueError: it is not JSON, nested deeper than Python reads, or holds more values."""
    most = bounds.VALUES if most_values is None else most_values
    if len(text) > most and _values(text) > most:
        raise ValueError("it holds too many values")
    try:
        return json.loads(text)
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error


def is_whole(line: bytes) -> bool:
    """Whether a last line without its end is no line cut short: an object ends with its last brace, and an editor
    may leave it at that."""
    try:
        return isinstance(parse_json(line), dict)
    except ValueError:
        return False


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


def file_sha256(path: Path) -> str:
    """The hash of a file's content, in hexadecimal. Raises OSError: it cannot be read."""
    found = hashlib.sha256()
    with open_file(path) as file:
        while piece := file.read(bounds.CHUNK_BYTES):
            found.update(piece)
    return found.hexdigest()


def open_file(path: Path) -> IO[bytes]:
    """Opens a regular file to read it. Anything else is refused unopened: a pipe would wait for a writer, and
    opening a device may already do something.

    Raises OSError: it cannot be opened, or is not a regular file."""
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
    Raises OSError: it is not a regular file."""
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise OSError(f"{path} is not a regular file")


def opened(path: Path, *, growing: bool = False, most_bytes: int | None = None) -> IO[bytes]:
    """The bytes of a file, unpacked if they are gzip's, bzip2's or xz's, whatever it is called.

    Args:
        growing: whether an archive that is cut short ends there, since somebody still writes it.
        most_bytes: that it may unpack to; by default, as ``bounds.TIMES_UNPACKED`` says.

    Raises OSError: it cannot be opened or is not a regular file. Reading raises it too, where an archive is damaged
    or unpacks to too much."""
    file = open_file(path)
    try:
        head = file.read(6)
        file.seek(0)
        unpack = next((unpack for magic, unpack in _PACKED.items() if head.startswith(magic)), None)
        if unpack is not None:
            return io.BufferedReader(_Unpacked(unpack(file), path, file, growing, most_bytes), bounds.CHUNK_BYTES)
    except BaseException:
        file.close()
        raise
    return file


_PACKED: Mapping[bytes, Callable[[IO[bytes]], gzip.GzipFile | bz2.BZ2File | lzma.LZMAFile]] = {
    b"\x1f\x8b": lambda file: gzip.GzipFile(fileobj=file),
    b"BZh": bz2.BZ2File,
    b"\xfd7zXZ\x00": lzma.LZMAFile,
}
"""How archives begin."""


class _Unpacked(io.RawIOBase):
    """An archive's content, up to a size."""

    def __init__(
        self,
        content: gzip.GzipFile | bz2.BZ2File | lzma.LZMAFile,
        path: Path,
        packed: IO[bytes],
        growing: bool,
        most_bytes: int | None,
    ) -> None:
        self._content = content
        self._growing = growing
        self._path = path
        self._packed = packed
        self._size = 0
        packed_bytes = path.stat().st_size
        most = min(bounds.UNPACKED_BYTES, bounds.TIMES_UNPACKED * packed_bytes)
        self._limit = max(bounds.FREELY_UNPACKED_BYTES, most if most_bytes is None else most_bytes)

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: bytearray | memoryview) -> int:  # type: ignore[override]
        try:
            # ``read`` would lose what comes before the end of an archive that is cut.
            data = self._content.read1(len(buffer))
        except (EOFError, zlib.error, lzma.LZMAError) as error:
            if self._growing and isinstance(error, EOFError):
                return 0
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
    """Whether the text of a file, packed or not, is in UTF-8. Raises OSError: it cannot be read."""
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        with opened(path) as file:
            while piece := file.read(2**20):
                decoder.decode(piece)
    except UnicodeDecodeError:
        return False
    return True
