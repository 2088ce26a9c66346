"""Reads TOML files that users write; errors name line, table and field."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

from automotive_cosim.errors import UserError
from automotive_cosim.formats.checked import Steps, checked
from automotive_cosim.formats.files import read_text

T = TypeVar("T")

_DEEP = re.compile(r"""(?<![\w.-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){100}""")
"""A key of more parts than anybody writes: ``tomllib`` takes the square of their number in memory."""

LONGEST = 600
"""Characters of a reason that are told; it may quote what came."""
LABELS = {"id": " {}", "kind": " of kind '{}'", "name": " '{}'"}
"""Keys that identify an entry of a list of tables, and how an error names it."""


@dataclass(frozen=True, slots=True)
class Document:
    """A TOML file with the lines of its entries."""

    path: Path
    table: dict[str, Any]
    error: type[UserError]
    """The class of errors."""
    text: str = field(repr=False)

    def read(self, kind: type[T]) -> T:
        """The whole file as an instance of a type.

        Raises UserError: of the document's class: it does not fit; one line for each problem."""
        return checked(kind, self.table, self.place, self.error)

    def refused(self, steps: Steps, why: str) -> UserError:
        """The error to raise about a value."""
        where, name = self.place(steps)
        why = why if len(why) <= LONGEST else f"{why[:LONGEST]}…"
        return self.error(f"{where}: {name} {why}" if name else f"{where}: {why}")

    def place(self, steps: Steps) -> tuple[str, str]:
        """File, line and table of a value, and its name in that table."""
        lines, tables = _lines(self.text)
        line = next((lines[steps[:end]] for end in range(len(steps), 0, -1) if steps[:end] in lines), None)
        table = next(steps[:end] for end in range(len(steps), -1, -1) if steps[:end] in tables)
        where = f"{self.path} line {line}" if line else str(self.path)
        return where + self._header(table), dotted(steps[len(table) :])

    def _header(self, table: Steps) -> str:
        """A table's name as written in the file, with what identifies it among others of that name."""
        if not table:
            return ""
        name = ".".join(_shown(step) for step in table if isinstance(step, str))
        if isinstance(table[-1], str):
            return f" [{name}]"
        entry: Any = self.table
        for step in table:
            entry = entry[step]
        told = next((form.format(entry[key]) for key, form in LABELS.items() if _is_word(entry.get(key))), "")
        return f" [[{name}]]{told}"


def read_toml(path: Path, error: type[UserError] = UserError) -> Document:
    """Reads a file. Raises UserError: of that class: it cannot be read, or is not TOML."""
    return parse(read_text(path, error), path, error)


def parse(text: str, path: Path, error: type[UserError] = UserError) -> Document:
    """A document from the text of a file. Raises UserError: of that class: it is not TOML."""
    try:
        if _DEEP.search(text):
            raise RecursionError
        return Document(path, tomllib.loads(text), error, text)
    except (ValueError, RecursionError) as broken:
        why = "it is nested too deeply" if isinstance(broken, RecursionError) else str(broken)
        raise error(f"{path} is not TOML: {why}") from broken


# --- the lines of entries -------------------------------------------------------------------------------------

_OPAQUE = re.compile(
    r'#[^\n]*|"""(?:\\.|[^\\])*?"""(?:"{0,2})|\'\'\'.*?\'\'\'(?:\'{0,2})|"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'',
    re.DOTALL,
)
"""Comments and texts of a well-formed file, in which brackets, equal signs and line ends mean nothing."""


def dotted(steps: Steps) -> str:
    """``cases[1].when.lit``."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{_shown(step)}" for step in steps).removeprefix(".")


def _shown(step: object) -> str:
    """A key as it is told: short, and without controls of a terminal."""
    told = str(step)
    return told if told.isprintable() and len(told) <= 80 else repr(told[:80])


def _is_word(value: object) -> bool:
    return isinstance(value, str) and re.fullmatch(r"[\w. -]{1,60}", value) is not None


@lru_cache(maxsize=1)
def _lines(text: str) -> tuple[Mapping[Steps, int], frozenset[Steps]]:
    """The line of each table and key of a well-formed file, and which of them are tables with a header."""
    plain = _OPAQUE.sub(lambda found: (" " if found[0][0] == "#" else "_") * len(found[0]), text)
    lines: dict[Steps, int] = {}
    tables: set[Steps] = {()}
    last: dict[Steps, int] = {}
    table: Steps = ()
    depth, begin, number = 0, 0, 1
    for line in plain.split("\n"):
        header = _HEADER.match(line)
        key, equals, rest = line.partition("=")
        if depth == 0 and header is not None:
            table = _entry(_keys(text[begin + header.start(2) : begin + header.end(2)]), header[1] == "[[", last)
            tables.add(table)
            found = table
        elif depth == 0 and equals:
            found = (*table, *_keys(text[begin : begin + len(key)]))
            depth = _depth(rest)
        else:
            found = ()
            depth += _depth(line)
        for end in range(1, len(found) + 1):  # a key such as a.b makes the table a
            lines.setdefault(found[:end], number)
        number += 1 + text.count("\n", begin, begin + len(line))
        begin += len(line) + 1
    return lines, frozenset(tables)


_HEADER = re.compile(r"\s*(\[\[?)([^\]]+)\]")


def _depth(line: str) -> int:
    return sum(line.count(bracket) for bracket in "[{") - sum(line.count(bracket) for bracket in "]}")


def _keys(written: str) -> tuple[str, ...]:
    """The keys of ``a."b c".d``, parsed like the file."""
    inner: Any = tomllib.loads(f"{written} = 0")
    keys = []
    while isinstance(inner, dict):
        ((key, inner),) = inner.items()
        keys.append(key)
    return tuple(keys)


def _entry(keys: tuple[str, ...], is_list: bool, last: dict[Steps, int]) -> Steps:
    """The steps to a header's table; ``last`` has the newest index of each list of tables."""
    steps: Steps = ()
    for index, key in enumerate(keys, start=1):
        steps = (*steps, key)
        if is_list and index == len(keys):
            last[steps] = last.get(steps, -1) + 1
        if steps in last:
            steps = (*steps, last[steps])
    return steps
