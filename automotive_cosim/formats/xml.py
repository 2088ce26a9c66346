"""XML files of others, read element by element with their lines and in little memory.

What is read here is what SUMO reads: without a document type, whose entities and defaults parsers resolve
differently. A file in an encoding that not every parser knows has to be rewritten for SUMO.
"""

from __future__ import annotations

import gc
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from xml.parsers import expat

from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import is_utf8, opened
from automotive_cosim.formats.writing import drafted, write_whole

SHARED_ENCODINGS = frozenset(("utf-8", "us-ascii", "ascii", "iso-8859-1", "utf-16"))
"""Encodings that every parser knows."""

ENCODINGS = SHARED_ENCODINGS | {"latin1", "latin-1", "iso-8859-15", "windows-1252", "cp1252"}
"""Those that are read: also the usual ones of Western European editors."""

INVALID_TOKEN = expat.errors.codes[expat.errors.XML_ERROR_INVALID_TOKEN]
LATIN_1 = '<?xml version="1.0" encoding="iso-8859-1"?>'

OnStart = Callable[[str, dict[str, str]], None]
"""Takes an element's name and its attributes. The parser itself calls it: a city has a million elements."""


class FilePlace:
    """Where in a file its reader is."""

    parser: expat.XMLParserType

    @property
    def line(self) -> int:
        return self.parser.CurrentLineNumber


def scan(
    path: Path,
    start: OnStart,
    end: Callable[[str], None] | None = None,
    text: Callable[[str], None] | None = None,
    *,
    place: FilePlace | None = None,
    error: type[UserError],
    what: str = "XML",
    copy: Path | None = None,
    hashed: Callable[[bytes], object] | None = None,
    most_elements: int | None = None,
) -> str:
    """Reads a file, also packed; returns the encoding that it declares, in lower case.

    Args:
        start: called at the start of each element.
        end: called with the name at the end of each.
        text: called with each piece of text between them.
        place: is where it is, for whoever is called.
        what: what the file should be, for errors.
        copy: a file to write, with the very bytes that are read, unpacked.
        hashed: called with these bytes.
        most_elements: how many elements it may have; by default ``bounds.ELEMENTS``.

    Raises UserError: of that class: it cannot be read or is not such XML. What the callbacks raise passes
    through."""
    parser = expat.ParserCreate()
    parser.buffer_text = True
    encoding = "utf-8"
    left = bounds.ELEMENTS if most_elements is None else most_elements
    if place is not None:
        place.parser = parser

    def declared(version: str, declaration: str | None, standalone: int) -> None:
        nonlocal encoding
        encoding = (declaration or encoding).lower()
        if encoding not in ENCODINGS:
            raise error(f"{path} line 1: the encoding {encoding[:40]!r} is not read; save it as UTF-8")

    def document_type(name: str, system: str | None, public: str | None, internal: bool) -> None:
        raise error(f"{path} line {parser.CurrentLineNumber}: a document type (<!DOCTYPE>) is not read; remove it")

    parser.XmlDeclHandler = declared
    parser.StartDoctypeDeclHandler = document_type
    parser.StartElementHandler = start
    if end is not None:
        parser.EndElementHandler = end
    if text is not None:
        parser.CharacterDataHandler = text
    try:
        with ExitStack() as open_files:
            file = open_files.enter_context(opened(path))
            open_files.enter_context(without_collection())
            target = None if copy is None else open_files.enter_context(drafted(copy))
            size = 0
            while piece := file.read(bounds.CHUNK_BYTES):
                if target is not None:
                    target.write(piece)
                if hashed is not None:
                    hashed(piece)
                left -= piece.count(b"<") - piece.count(b"</")
                if left < 0:
                    raise error(f"{path} line {parser.CurrentLineNumber}: too many elements; give a part of it")
                parser.Parse(piece, False)
                size += len(piece)
                if size - parser.CurrentByteIndex > bounds.TAG_BYTES + bounds.CHUNK_BYTES:
                    raise error(f"{path} line {parser.CurrentLineNumber}: a tag is longer than anybody's")
            parser.Parse(b"", True)
    except FileNotFoundError as broken:
        raise error(f"{path} is missing") from broken
    except (expat.ExpatError, OSError, ValueError, LookupError) as broken:
        if getattr(broken, "filename", None) not in (None, path, str(path)):
            raise  # of the copy that is being written, on a full disk
        hint = ""
        if encoding == "utf-8" and getattr(broken, "code", 0) == INVALID_TOKEN and not is_utf8(path):
            hint = f"; it is not UTF-8: save it so, or let it begin with {LATIN_1}"
        raise error(f"{path} is not {what}: {broken}{hint}") from broken
    return encoding


@contextmanager
def without_collection() -> Iterator[None]:
    """Collects no garbage meanwhile: what is read stays, and looking through it again and again takes a fifth of
    the time of a large network."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def read_tree(path: Path, *, error: type[UserError]) -> ET.Element:
    """A file that is kept whole. Raises UserError: of that class, as ``scan``."""
    builder = ET.TreeBuilder()

    def start(name: str, attributes: dict[str, str]) -> None:
        builder.start(name, attributes)

    def end(name: str) -> None:
        builder.end(name)

    scan(path, start, end, builder.data, error=error, most_elements=bounds.KEPT_ELEMENTS)
    return builder.close()


class _FoundError(Exception):
    """The root has begun."""


def read_root(path: Path, *, error: type[UserError]) -> ET.Element:
    """The root element of a file, with its attributes but nothing in it.

    Raises UserError: of that class, as ``scan``."""
    root = ET.Element("")

    def start(name: str, attributes: dict[str, str]) -> None:
        root.tag, root.attrib = name, attributes
        raise _FoundError

    with suppress(_FoundError):
        scan(path, start, error=error)
    return root


def write_xml(path: Path, root: ET.Element) -> None:
    """Writes a document whole or not at all. Raises OSError: it cannot be written."""
    write_whole(path, ET.tostring(root, encoding="UTF-8", xml_declaration=True))
