"""XML files of others, read element by element with their lines and in little memory.

What is read here is what SUMO reads: without a document type, whose entities and defaults parsers resolve
differently, and in an encoding that every parser knows.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.parsers import expat

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import opened

ENCODINGS = frozenset(("utf-8", "us-ascii", "ascii", "iso-8859-1", "latin1", "utf-16"))

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
) -> None:
    """Reads a file, also packed.

    Args:
        path: the file.
        start: called at the start of each element.
        end: called with the name at the end of each.
        text: called with each piece of text between them, and its line.
        error: the class of errors.
        what: what the file should be, for errors.

    Raises:
        UserError: of that class: it cannot be read or is not such XML. What the callbacks raise passes through.
    """
    parser = expat.ParserCreate()
    parser.buffer_text = True

    def declared(version: str, encoding: str | None, standalone: int) -> None:
        if encoding is not None and encoding.lower() not in ENCODINGS:
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
        with opened(path) as file:
            parser.ParseFile(file)
    except FileNotFoundError as broken:
        raise error(f"{path} is missing") from broken
    except (expat.ExpatError, OSError, ValueError, LookupError) as broken:
        raise error(f"{path} is not {what}: {broken}") from broken
