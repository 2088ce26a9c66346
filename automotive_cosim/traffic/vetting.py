"""SUMO's files, checked element by element before SUMO reads them; what would write is changed in a copy.

The copy goes to a scratch folder; a file that needs no change is left where it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO
from xml.sax.saxutils import escape, quoteattr

from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.formats.files import is_file
from automotive_cosim.formats.xml import scan
from automotive_cosim.traffic.vocabulary import ELEMENTS, INPUTS, OUTPUTS, WRITING_LIGHT, parameter

NOWHERE = "NUL"
"""SUMO's name for no file, on every platform."""

LISTS = ("edgeData", "laneData")
"""Elements whose input is a list of edges and not XML."""


def vet(path: Path, scratch: Path | None = None) -> Path:
    """The file, or a copy of it in ``scratch`` that writes nothing if it would.

    Args:
        path: a network, a route file or an additional file, also gzipped.
        scratch: a folder for changed files; None only checks.

    Raises:
        ScenarioError: it is not such a file, has an element or a device's parameter that is not known to write
            nothing, or names a file that is missing; with its line.
    """
    return _vet(path, scratch, ())


def _vet(path: Path, scratch: Path | None, through: tuple[Path, ...]) -> Path:
    if path.resolve() in through:
        raise ScenarioError(f"{path} includes itself")
    reader = _Reader(path, scratch, (*through, path.resolve()))
    scan(path, reader.start, reader.end, error=ScenarioError, what="a SUMO file")
    if not reader.writes or scratch is None:
        return path
    copy = scratch / f"{len(list(scratch.iterdir()))}-{path.name.removesuffix('.gz')}"
    with copy.open("w", encoding="utf-8") as file:
        writer = _Writer(file, reader.changed)
        scan(path, writer.start, writer.end, writer.text, error=ScenarioError)
    return copy


@dataclass(slots=True)
class _Reader:
    """Checks the elements of a file and collects what a copy of it changes."""

    path: Path
    scratch: Path | None
    through: tuple[Path, ...]
    """This file, and those that include it."""
    writes: bool = False
    """Whether SUMO would write, so that it needs a copy."""
    changed: dict[int, dict[str, str] | None] = field(default_factory=dict)
    """Number of an element, in the order of the file -> its attributes in a copy; None leaves it out."""
    count: int = 0
    within: list[str] = field(default_factory=list)

    def start(self, name: str, attributes: dict[str, str], line: int) -> None:
        """Checks an element."""
        if name not in ELEMENTS and self.within and "metadata" not in self.within:
            unknown = UnknownNameError("element of SUMO", name[:80], ELEMENTS, "docs/scenarios.md")
            raise ScenarioError(f"{self.path} line {line}: {unknown}")
        if name == "param":
            self._take_parameter(attributes, line)
        elif name in OUTPUTS or name in INPUTS or "imgFile" in attributes:
            self._take_files(name, attributes, line)
        self.within.append(name)
        self.count += 1

    def end(self, name: str) -> None:
        """Leaves an element."""
        self.within.pop()

    def _take_parameter(self, attributes: dict[str, str], line: int) -> None:
        key = attributes.get("key", "")
        if key == WRITING_LIGHT:  # of a traffic light, in whatever element of it this stands
            self._change(attributes | {"value": NOWHERE})
            return
        try:
            taken = parameter(key)
        except KeyError:
            raise ScenarioError(
                f"{self.path} line {line}: no device here has a parameter {key[:80]!r}; remove it"
            ) from None
        if not taken:
            self._change(None)

    def _take_files(self, name: str, attributes: dict[str, str], line: int) -> None:
        new = dict(attributes)
        if new.get("imgFile"):
            new["imgFile"] = str((self.path.parent / new["imgFile"]).absolute())
        is_changed = bool(new.get(OUTPUTS.get(name, "")))
        if is_changed:
            new[OUTPUTS[name]] = NOWHERE
        if read := new.get(INPUTS.get(name, "")):
            file = (self.path.parent / read).absolute()
            if "${" in read or not is_file(file):  # SUMO may put a variable's value there
                missing = f"<{name}> names {read[:200]!r}, which is missing in {self.path.parent}"
                raise ScenarioError(f"{self.path} line {line}: {missing}")
            vetted = file if name in LISTS else _vet(file, self.scratch, self.through)
            new[INPUTS[name]] = str(vetted)
            is_changed |= vetted != file
        self.changed[self.count] = new
        self.writes |= is_changed

    def _change(self, attributes: dict[str, str] | None) -> None:
        self.changed[self.count] = attributes
        self.writes = True


@dataclass(slots=True)
class _Writer:
    """Writes a file's elements with the changes."""

    file: TextIO
    changed: Mapping[int, Mapping[str, str] | None]
    count: int = 0
    left_out: int = 0
    """Depth within an element that is left out."""

    def start(self, name: str, attributes: dict[str, str], line: int) -> None:
        """Writes the start of an element."""
        new = self.changed.get(self.count, attributes)
        self.count += 1
        if new is None or self.left_out:
            self.left_out += 1
        else:
            self.file.write(f"<{name}{''.join(f' {key}={quoteattr(value)}' for key, value in new.items())}>")

    def end(self, name: str) -> None:
        """Writes its end."""
        if self.left_out:
            self.left_out -= 1
        else:
            self.file.write(f"</{name}>")

    def text(self, piece: str, line: int) -> None:
        """Writes the text between elements."""
        if not self.left_out:
            self.file.write(escape(piece))
