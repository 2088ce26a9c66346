"""Problems that a check finds: which file, which field, and why."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from automotive_cosim.episode.conditions import TABLE, Conditions
from automotive_cosim.formats.toml import dotted
from automotive_cosim.formats.words import shown
from automotive_cosim.run.rows import TrialRow

ROWS = "episodes.jsonl"


@dataclass(frozen=True, slots=True)
class Problem:
    """Something that is inconsistent with the rest."""

    file: str
    """Path in the bundle or folder."""
    field: str
    """Where in the file; empty for the whole file."""
    why: str

    def __str__(self) -> str:
        return f"{self.file}{', ' if self.field else ''}{self.field}: {self.why}"


def attempt_problems(row: TrialRow) -> Iterator[Problem]:
    """What is wrong with the attempts and the times of a row."""
    tried = len(row.failed_attempts) + (row.error is None)
    if row.attempts != tried:
        yield Problem(ROWS, f"{row.id} attempts", f"is {row.attempts}, but {tried} by failed_attempts")
    if row.wall_seconds < 0 or row.model_seconds < 0:
        yield Problem(ROWS, f"{row.id} wall_seconds, model_seconds", "are below zero")


def differences(
    file: str, where: str, found: Mapping[str, Any], expected: Mapping[str, Any], names: Iterable[str], source: str
) -> Iterator[Problem]:
    """A problem for each named field that differs.

    Args:
        where: place of the object in it.
        found: the object, as JSON.
        expected: what it should be, as JSON.
        source: where the expected values come from."""
    found = _of_today(found)
    for name in names:
        steps = _first(found.get(name), expected.get(name), (name,))
        if steps is not None:
            told = shown(_at(found, steps)), shown(_at(expected, steps))
            yield Problem(file, f"{where} {dotted(steps)}".strip(), f"is {told[0]}, but {told[1]} by {source}")


def _of_today(found: Mapping[str, Any]) -> Mapping[str, Any]:
    """A plan or a row with every condition: what was run before there was one was run at its default."""
    if isinstance(row := found.get("conditions"), dict):
        return {**found, "conditions": Conditions().as_json() | row}
    return {each.name: [each.default] for each in TABLE} | dict(found)


def _first(one: Any, other: Any, steps: tuple[str | int, ...]) -> tuple[str | int, ...] | None:
    """The path to the first value that differs; None if all are the same. 1 and true differ, 1 and 1.0 do not."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        inner = ((one[key], other[key], (*steps, key)) for key in one)
    elif isinstance(one, list | tuple) and isinstance(other, list | tuple) and len(one) == len(other):
        inner = (
            (first, second, (*steps, number)) for number, (first, second) in enumerate(zip(one, other, strict=True))
        )
    else:
        same = one == other and isinstance(one, bool) == isinstance(other, bool)
        return None if same else steps
    return next((found for each in inner if (found := _first(*each)) is not None), None)


def _at(value: Any, steps: Iterable[str | int]) -> Any:
    """The value at a path; None if its last field is missing."""
    for step in steps:
        if isinstance(value, Mapping) and step not in value:
            return None
        value = value[step]
    return value
