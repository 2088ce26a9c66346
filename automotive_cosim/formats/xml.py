"""XML files of others, read element by element with their lines and in little memory.

What is read here is what SUMO reads: without a document type, whose entities and defaults parsers resolve
differently. A file in an encoding that not every parser knows has to be rewritten for SUMO.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import IO
from xml.parsers import expat

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import is_utf8, opened, without_collection

SHARED_ENCODINGS = frozenset(("utf-8", "us-ascii", "ascii", "iso-8859-1", "utf-16"))
"""Encodings that every parser knows."""

ENCODINGS = SHARED_ENCODINGS | {"latin1", "latin-1", "iso-8859-15", "windows-1252", "cp1252"}
"""Those that are read: also the usual ones of Western European editors."""

INVALID_TOKEN = expat.errors.codes[expat.errors.XML_ERROR_INVALID_TOKEN]
LATIN_1 = '<?xml version="1.0" encoding="iso-8859-1"?>'

OnStart = Callable[[str, dict[str, str], int], None]
"""Takes an element's name, its attributes and its line."""


def scan(
    path: Path,
    start: OnStart,
    end: Callable[[str], None] | None = None,
    text: Callable[[str, int], None] | None = None,
    *,
    error: type[UserError],
    what: str = "XML",
    copy: Path | None = None,
) -> str:
    """Reads a file, also packed; returns the encoding that it declares, in lower case.

    Args:
        path: the file.
        start: called at the start of each element.
        end: called with the name at the end of each.
        text: called with each piece of text between them, and its line.
        error: the class of errors.
        what: what the file should be, for errors.
        copy: a file to write, with the very bytes that are read, unpacked.

    Raises:
        UserError: of that class: it cannot be read or is not such XML. What the callbacks raise passes through.
    """
    parser = expat.ParserCreate()
    parser.buffer_text = True
    encoding = "utf-8"

    def declared(version: str, declaration: str | None, standalone: int) -> None:
        nonlocal encoding
        encoding = (declaration or encoding).lower()
        if encoding not in ENCODINGS:
            raise error(f"{path} line 1: the encoding {encoding[:40]!r} is not read; save it as UTF-8")

    def document_type(name: str, system: str | None, public: str | None, internal: bool) -> None:
        raise error(f"{path} line {parser.CurrentLineNumber}: a document type (<!DOCTYPE>) is not read; remove it")

    parser.XmlDeclHandler = declared
    parser.StartDoctypeDeclHandler = document_type
    parser.StartElementHandler = lambda name, attributes: start(name, attributes, parser.CurrentLineNumber)
    if end is not None:
        parser.EndElementHandler = end
    if text is not None:
        taken = text
        parser.CharacterDataHandler = lambda piece: taken(piece, parser.CurrentLineNumber)
    try:
        with ExitStack() as open_files:
            file = open_files.enter_context(opened(path))
            open_files.enter_context(without_collection())
            parser.ParseFile(file if copy is None else _Tee(file, open_files.enter_context(copy.open("wb"))))
    except FileNotFoundError as broken:
        raise error(f"{path} is missing") from broken
    except (expat.ExpatError, OSError, ValueError, LookupError) as broken:
        hint = ""
        if encoding == "utf-8" and getattr(broken, "code", 0) == INVALID_TOKEN and not is_utf8(path):
            hint = f"; it is not UTF-8: save it so, or let it begin with {LATIN_1}"
        raise error(f"{path} is not {what}: {broken}{hint}") from broken
    return encoding


class _Tee:
    """Writes what is read from a file into another."""

    def __init__(self, source: IO[bytes], copy: IO[bytes]) -> None:
        self._source = source
        self._copy = copy

    def read(self, size: int = -1, /) -> bytes:
        """The next bytes."""
        data = self._source.read(size)
        self._copy.write(data)
        return data
