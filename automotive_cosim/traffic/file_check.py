"""SUMO's files, copied element by element under names of ours: what is checked is what SUMO reads.

A copy says the same but for what would write, and what it names is a copy too. No name of the scenario's reaches
SUMO, which would put values for variables in it (``${HOME}``) and take a comma for the end of a name.
"""

from __future__ import annotations

import itertools
import re
import shutil
from codecs import StreamWriter, getwriter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Protocol
from xml.sax.saxutils import escape, quoteattr

from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import is_file, opened
from automotive_cosim.formats.writing import drafted
from automotive_cosim.formats.xml import SHARED_ENCODINGS, FilePlace, scan
from automotive_cosim.traffic.georeference import in_full
from automotive_cosim.traffic.sumo import EGO
from automotive_cosim.traffic.vocabulary import ELEMENTS, INPUTS, OUTPUTS, WRITING_LIGHT, parameter

NOWHERE = "NUL"
"""SUMO's name for no file, on every platform."""

LISTS = ("edgeData", "laneData")
"""Elements whose input is a list of edges and not XML."""

PICTURE = "imgFile"
"""An attribute that names a picture, which only sumo-gui shows."""

OTHER_EGO = f"{EGO}.scenario"
"""What a vehicle of the scenario that is called like the cockpit's car runs as."""

VEHICLES = frozenset(("vehicle", "trip"))
NAMES_OF_VEHICLES = ("lines", "join", "split")
"""Attributes that name vehicles: of rides, and of stops."""

TRAVELLERS = VEHICLES | {"flow", "person", "personFlow", "container", "containerFlow"}
NOT_IN_IDS = re.compile(r"[ \t\n\r|\\;,']")
"""What no id of theirs contains (SUMO's ``routeTypes.xsd``): SUMO would stop when it comes to it."""

FREE = "metadata"
"""The element within which anything may be."""

NAMING = TRAVELLERS.union(INPUTS, OUTPUTS, ("ride", "transport", "stop"))
"""Elements of which an attribute may have to change."""

PLAIN = frozenset(ELEMENTS) - NAMING - {"param", "location", FREE}
"""Elements that stay as they are but for a picture."""

NO_DEPTH = 2**31
"""Deeper than any element."""


class ElementHandler(Protocol):
    """Reads a file while it is checked."""

    def start(self, name: str, attributes: dict[str, str], depth: int) -> None:
        """Takes the start of an element, the root at 0."""
        ...


def vet(path: Path, also: ElementHandler | None = None, what: str = "a SUMO file") -> bytes:
    """Checks a network, a route file or an additional file, also packed, and the files that it names.

    Args:
        also: reads the file, too.
        what: what the file should be, for errors.

    Returns:
        The SHA-256 of what SUMO may read as it is, unpacked, for ``copy_vetted``; empty if a copy differs, or names
        files.

    Raises:
        ScenarioError: it is not such a file, has an element or a device's parameter that is not known to write
            nothing, or names a file that is missing; with its line."""
    reader, seen = _Reader(path, None, "", (path.resolve(),), also), sha256()
    encoding = _scanned(reader, what, hashed=seen.update)
    return b"" if reader.changed or reader.found or encoding not in SHARED_ENCODINGS else seen.digest()


def files_in(path: Path) -> tuple[Path, ...]:
    """The files that a network, a route file or an additional file names, and those that they name.

    Raises ScenarioError: see ``vet``."""
    found: list[Path] = []
    _vet(path, None, "", (), found=found)
    return tuple(found)


def copy_vetted(
    path: Path,
    folder: Path,
    name: str,
    also: ElementHandler | None = None,
    what: str = "a SUMO file",
    known: bytes = b"",
) -> str:
    """Checks like ``vet`` and writes what SUMO may read, unpacked, into a folder.

    Args:
        path: a network, a route file or an additional file, also packed.
        folder: the folder of the copies, in which SUMO must run.
        name: what the copy is called, without an ending; copies of files that it names begin with it.
        also: reads the file, too.
        what: what the file should be, for errors.
        known: what ``vet`` returned; while that is the content, it is copied unread.

    Returns:
        The copy's name in the folder.

    Raises:
        see ``vet``."""
    if known and _copied(path, folder / f"{name}.xml") == known:
        return f"{name}.xml"
    return _vet(path, folder, name, (), what, also)


def _copied(path: Path, copy: Path) -> bytes:
    """Copies a file, unpacked; returns the SHA-256 of that, or nothing if it cannot be read."""
    seen = sha256()
    with suppress(OSError), opened(path) as given, drafted(copy) as file:
        while piece := given.read(bounds.CHUNK_BYTES):
            seen.update(piece)
            file.write(piece)
        return seen.digest()
    return b""


def refuse_variables(name: str, where: str) -> None:
    """Refuses a file's name in which SUMO would replace a variable. Raises ScenarioError: it is one."""
    if "$" in name:
        raise ScenarioError(f"{where} names {name[:200]!r}: variables ($) are not replaced here; write it out")


def _vet(
    path: Path,
    folder: Path | None,
    name: str,
    through: tuple[Path, ...],
    what: str = "a SUMO file",
    also: ElementHandler | None = None,
    found: list[Path] | None = None,
    above: int = 0,
) -> str:
    if path.resolve() in through:
        raise ScenarioError(f"{path} includes itself")
    reader = _Reader(
        path, folder, name, (*through, path.resolve()), also, [] if found is None else found, above=above
    )
    copy = None if folder is None else folder / f"{name}.xml"
    encoding = _scanned(reader, what, copy=copy)
    if copy is not None and (reader.changed or encoding not in SHARED_ENCODINGS):
        with drafted(copy) as file:
            writer = _Writer(getwriter("utf-8")(file), reader.changed)
            scan(copy, writer.start, writer.end, writer.text, error=ScenarioError)
    return f"{name}.xml"


def _scanned(
    reader: _Reader, what: str, *, copy: Path | None = None, hashed: Callable[[bytes], object] | None = None
) -> str:
    """Checks a file; returns its encoding."""
    return scan(
        reader.path,
        reader.start,
        reader.ended.append,
        place=reader.place,
        error=ScenarioError,
        what=what,
        copy=copy,
        hashed=hashed,
    )


@dataclass(slots=True)
class _Reader:
    """Checks the elements of a file and collects what a copy of it changes."""

    path: Path
    folder: Path | None
    """The folder of the copies, if there are any."""
    name: str
    """The copy's name, without an ending."""
    through: tuple[Path, ...]
    """This file, and those that include it."""
    also: ElementHandler | None = None
    """Reads it too, and what it includes."""
    found: list[Path] = field(default_factory=list)
    """Takes the files that it names, and those that they name."""
    changed: dict[int, dict[str, str] | None] = field(default_factory=dict)
    """Number of an element, in the order of the file -> its attributes in a copy; None leaves it out."""
    count: int = 0
    inner: Iterator[int] = field(default_factory=itertools.count)
    """Numbers the files that it names."""
    above: int = 0
    """How deep the element stands that includes this file, and 1 more."""
    ended: list[str] = field(default_factory=list)
    """Names of the elements that have ended: to have them listed takes none of a million calls of Python's."""
    free: int = NO_DEPTH
    """How deep the element stands within which anything may be."""
    place: FilePlace = field(default_factory=FilePlace)

    @property
    def where(self) -> str:
        """The element that is read, for errors."""
        return f"{self.path} line {self.place.line}"

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Takes the start of an element."""
        depth = self.count - len(self.ended)
        if self.also is not None:
            self.also.start(name, attributes, self.above + depth)
        if name not in PLAIN or self.free < NO_DEPTH or PICTURE in attributes:
            self._take(name, attributes, depth)
        self.count += 1

    def _take(self, name: str, attributes: dict[str, str], depth: int) -> None:
        """Takes one that may be none of SUMO's, or may have to change."""
        if depth <= self.free:
            self.free = depth if name == FREE else NO_DEPTH
        if name not in ELEMENTS and 0 < depth <= self.free:
            unknown = UnknownNameError("element of SUMO", name[:80], ELEMENTS, "docs/reference/scenarios.md")
            raise ScenarioError(f"{self.where}: {unknown}")
        if name == "param":
            self._take_parameter(attributes)
        elif name == "location":
            new = attributes | {"projParameter": in_full(attributes)}
            if new != attributes:
                self.changed[self.count] = new
        elif name in NAMING or PICTURE in attributes:
            new = dict(attributes)
            self._take_files(name, new)
            self._rename(name, new)
            if new != attributes:
                self.changed[self.count] = new

    def _take_parameter(self, attributes: dict[str, str]) -> None:
        key = attributes.get("key", "")
        if key == WRITING_LIGHT:  # of a traffic light, in whatever element of it this stands
            self.changed[self.count] = attributes | {"value": NOWHERE}
            return
        try:
            taken = parameter(key)
        except KeyError:
            raise ScenarioError(f"{self.where}: no device here has a parameter {key[:80]!r}; remove it") from None
        if not taken:
            self.changed[self.count] = None

    def _take_files(self, element: str, attributes: dict[str, str]) -> None:
        attributes.pop(PICTURE, None)
        if attributes.get(OUTPUTS.get(element, "")):
            attributes[OUTPUTS[element]] = NOWHERE
        if read := attributes.get(INPUTS.get(element, "")):
            attributes[INPUTS[element]] = self._taken_file(element, read, self.where)

    def _taken_file(self, element: str, read: str, where: str) -> str:
        """Checks a file that an element names, and copies it; returns the copy's name."""
        refuse_variables(read, f"{where}: <{element}>")
        file = (self.path.parent / read).absolute()
        if not is_file(file):
            missing = f"<{element}> names {read[:200]!r}, which is missing in {self.path.parent}"
            raise ScenarioError(f"{where}: {missing}")
        name = f"{self.name}-{next(self.inner)}"
        self.found.append(file)
        if element not in LISTS:
            also = self.also if element == "include" else None
            above = self.above + self.count - len(self.ended) + 1
            return _vet(file, self.folder, name, self.through, also=also, found=self.found, above=above)
        if self.folder is not None:
            with opened(file) as given, drafted(self.folder / name) as copy:
                shutil.copyfileobj(given, copy)
        return name

    def _rename(self, element: str, attributes: dict[str, str]) -> None:
        """Keeps the name of the cockpit's car free."""
        if element in TRAVELLERS and NOT_IN_IDS.search(attributes.get("id", "")):
            raise ScenarioError(
                f"{self.where}: SUMO takes no {element} with the id {attributes['id'][:80]!r}; rename "
                "it, without spaces and | \\ ; , '"
            )
        if element in VEHICLES and attributes.get("id") == EGO:
            attributes["id"] = OTHER_EGO
        for key in NAMES_OF_VEHICLES:
            if EGO in attributes.get(key, ""):
                names = attributes[key].split()
                attributes[key] = " ".join(OTHER_EGO if name == EGO else name for name in names)


@dataclass(slots=True)
class _Writer:
    """Writes a file's elements with the changes."""

    file: StreamWriter
    changed: Mapping[int, Mapping[str, str] | None]
    count: int = 0
    left_out: int = 0
    """Depth within an element that is left out."""

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Writes the start of an element."""
        new = self.changed.get(self.count, attributes)
        self.count += 1
        if new is None or self.left_out:
            self.left_out += 1
        else:
            self.file.write(f"<{name}{''.join(f' {key}={quoteattr(value)}' for key, value in new.items())}>")

    def end(self, name: str) -> None:
        if self.left_out:
            self.left_out -= 1
        else:
            self.file.write(f"</{name}>")

    def text(self, piece: str) -> None:
        """Writes the text between elements."""
        if not self.left_out:
            self.file.write(escape(piece))
