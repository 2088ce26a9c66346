"""Stores a judge's input, so that later checks can judge the episode again.

traces/<id>.judged.json.xz holds the moments of the agent's drive and of its baseline run from the hand-over to the
end, what the counterfactual commands then, the drawn parameters and the declaration. The geo-context is not stored:
it is computed from the rest by the current rules. The values come back as they were, including their types, so a
check sees no difference.

A value is a number, a truth value, a text, null, or a list whose first entry says what it is:

    [7, …]        dataclass number 7 of ``classes``, its fields in the order given there
    ["#", 3]      entry 3 of ``pool``, which holds each dataclass and each long tuple once
    ["t", …]      tuple; "l" list, "f" frozenset, "d" mapping, "e" member of an enumeration, "at" date and time
"""

from __future__ import annotations

import importlib
import json
import lzma
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from datetime import datetime
from enum import Enum
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self, TypeVar
from zoneinfo import ZoneInfo

from automotive_cosim.contracts import GoalStatus, Json, Reason
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.layout import TRACES
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.geo.locate import Geo

PACKAGE = "automotive_cosim."
"""Only classes of this package are created when a file is read."""
LONG = 3
"""Tuples with more entries go into the pool."""
PRESET = 2
"""xz preset: four times as fast as the default, for files that are a tenth larger."""


class JudgeInput:
    """What the judge of a trial has read: of a task's half the drive, of a drive its events and acts."""

    __slots__ = ()

    def packed(self) -> Self:
        """The same without what follows from the rest, as a file holds it."""
        return self

    def unpacked(self) -> Self:
        """The reverse of ``packed``."""
        return self


J = TypeVar("J", bound=JudgeInput)


@dataclass(frozen=True, slots=True)
class Judged(JudgeInput):
    """The input of a verdict, except the task."""

    goal: str
    parameters: Mapping[str, Any]
    declared: GoalStatus | None
    reason: Reason | None
    trace: tuple[Moment, ...]
    """Moments from the hand-over to the end."""
    baseline: tuple[Moment, ...]
    """Moments of the baseline run over the same time."""
    counterfactual: Mapping[str, Any]
    """What would be commanded at the end if the agent had given only the commands that belong to the goal."""
    allowed_writes: frozenset[str] = frozenset()
    """The commands that belonged to it (``Half.allowed_writes``)."""
    said: tuple[str, ...] = ()
    """What the agent told the driver."""

    def packed(self) -> Judged:
        """Without geo-contexts, and with what changed from moment to moment alone."""
        beside: Any = _changes(self.trace[-1].commands, self.counterfactual)
        return replace(self, trace=_bare(self.trace), baseline=_bare(self.baseline), counterfactual=beside)

    def unpacked(self) -> Judged:
        """Each moment with its geo-context by the current rules."""
        geo = Geo()
        judged = replace(self, trace=_placed(self.trace, geo), baseline=_placed(self.baseline, geo))
        beside: Any = self.counterfactual
        return replace(judged, counterfactual=_changed(judged.trace[-1].commands, *beside))


def judged_file(folder: Path, trial: str) -> Path:
    """Path of a trial's file."""
    return folder / TRACES / f"{trial}.judged.json.xz"


def write_judged(folder: Path, trial: str, judged: JudgeInput) -> None:
    """Writes it, whole or not at all; the same input gives the same bytes.

    Raises OSError: the file cannot be written."""
    writer, path = _Writer(), judged_file(folder, trial)
    value = writer.value(judged.packed())
    whole = {"classes": writer.classes, "pool": writer.pool, "value": value}
    text = json.dumps(whole, ensure_ascii=False, separators=(",", ":"))
    write_whole(path, lzma.compress(text.encode(), preset=PRESET))


def read_judged(folder: Path, trial: str, kind: type[J]) -> J:
    """Reads it back.

    Raises UserError: there is no such file, it is damaged or holds something else, or a version with other fields
    wrote it."""
    path = judged_file(folder, trial)
    try:
        whole: Json = read_json(path)
        value = _Reader(whole["classes"], whole["pool"]).value(whole["value"])
    except FileNotFoundError as error:
        raise UserError(f"{path} does not exist; only judged episodes have one") from error
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError, ImportError) as error:
        raise UserError(f"cannot read {path}: {error}; judge it with the version that wrote it") from error
    if not isinstance(value, kind):
        raise UserError(f"{path} has no moments" if kind is Judged else f"{path} holds no {kind.__name__}")
    return value.unpacked()


def in_its_fields(folder: Path, trial: str, judged: J) -> J:
    """A trial's input of a verdict as the version that wrote its file would have read it back: a field that came
    later has its default.

    Raises UserError: there is no such file, or it is damaged."""
    path = judged_file(folder, trial)
    try:
        written = read_json(path)["classes"]
        writer = _Writer(dict(written))
        value = writer.value(judged.packed())
        again: J = _Reader(writer.classes, writer.pool).value(value).unpacked()
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        raise UserError(f"cannot read {path}: {error}; judge it with the version that wrote it") from error
    return again


def _bare(moments: Sequence[Moment]) -> tuple[Any, ...]:
    """A moment without what follows from the rest: the context, and unchanged signals and commands."""
    bare: list[Any] = []
    signals: Mapping[str, Any] = {}
    commands: Mapping[str, Any] = {}
    for each in moments:
        before, signals = signals, dict(each.signals)
        told: Any = {
            "context": None,
            "signals": _changes(before, signals),
            "commands": _changes(commands, each.commands),
        }
        bare.append(replace(each, **told))
        commands = each.commands
    return tuple(bare)


def _placed(moments: Sequence[Any], geo: Geo) -> tuple[Moment, ...]:
    """The reverse of ``_packed``."""
    placed: list[Moment] = []
    signals: Mapping[str, Any] = {}
    commands: Mapping[str, Any] = {}
    for each in moments:
        signals, commands = _changed(signals, *each.signals), _changed(commands, *each.commands)
        context = geo.locate(each.driving, each.gps, each.weather, each.local_time)
        placed.append(replace(each, signals=signals, commands=commands, context=context))
    return tuple(placed)


def _changes(before: Mapping[str, Any], now: Mapping[str, Any]) -> tuple[dict[str, Any], tuple[str, ...]]:
    """What is new or different, and what is gone. 1 and True count as different."""
    new = {
        key: value
        for key, value in now.items()
        if key not in before or type(before[key]) is not type(value) or before[key] != value
    }
    return new, tuple(key for key in before if key not in now)


def _changed(before: Mapping[str, Any], new: Mapping[str, Any], gone: Sequence[str]) -> dict[str, Any]:
    return {key: value for key, value in before.items() if key not in gone} | dict(new)


PLAIN = frozenset((type(None), bool, int, float, str))


class _Writer:
    """Turns values into JSON and fills the pool."""

    def __init__(self, written: Mapping[str, Sequence[str]] = MappingProxyType({})) -> None:
        """Writes the fields of ``written`` alone of a class that it names."""
        self._written = written
        self.classes: list[tuple[str, tuple[str, ...]]] = []
        self.pool: list[Any] = []
        self._numbers: dict[type, int] = {}
        self._places: dict[str, int] = {}
        self._known: dict[int, tuple[object, Any]] = {}
        """Of tuples and dataclasses, by identity: two drives share most of their states, and all states a route."""

    def value(self, value: Any) -> Any:
        kind = type(value)
        if kind in PLAIN:
            return value
        if kind is tuple or is_dataclass(kind):
            known = self._known.get(id(value))
            if known is None:
                known = self._known[id(value)] = value, self._made(value)
            return known[1]
        match value:
            case Enum():
                return ["e", self._class(kind), value.value]
            case str():
                return str(value)
            case datetime():
                zone = value.tzinfo.key if isinstance(value.tzinfo, ZoneInfo) else ""
                return ["at", value.isoformat(), zone]
            case Mapping():
                return ["d", *([self.value(key), self.value(each)] for key, each in value.items())]
            case tuple():
                return self.value(tuple(value))
            case list():
                return ["l", *map(self.value, value)]
            case frozenset() | set():
                return ["f", *sorted(map(self.value, value), key=repr)]
            case bool() | int() | float():
                return value
        raise TypeError(f"cannot store a {kind.__name__}")

    def _made(self, value: Any) -> Any:
        kind = type(value)
        if kind is tuple:
            made = ["t", *map(self.value, value)]
            return self._once(made) if len(value) > LONG else made
        names = self.classes[self._class(kind)][1]
        return self._once([self._numbers[kind], *(self.value(getattr(value, name)) for name in names)])

    def _class(self, kind: type) -> int:
        if kind not in self._numbers:
            self._numbers[kind] = len(self.classes)
            name = f"{kind.__module__}:{kind.__qualname__}"
            known = [each.name for each in fields(kind)] if is_dataclass(kind) else []
            names = tuple(each for each in self._written.get(name, known) if each in known)
            self.classes.append((name, names))
        return self._numbers[kind]

    def _once(self, made: list[Any]) -> list[Any]:
        key = repr(made)
        if key not in self._places:
            self._places[key] = len(self.pool)
            self.pool.append(made)
        return ["#", self._places[key]]


class _Reader:
    """Turns JSON back into values; an entry of the pool is created once."""

    def __init__(self, classes: Sequence[Sequence[Any]], pool: Sequence[Any]) -> None:
        self._classes = [(_find(name), tuple(names)) for name, names in classes]
        self._pool: list[Any] = []
        for made in pool:  # an entry refers only to earlier ones
            self._pool.append(self.value(made))

    def value(self, made: Any) -> Any:
        if not isinstance(made, list):
            return made
        kind, *entries = made
        match kind:
            case int():
                return self._object(kind, entries)
            case "#":
                return self._pool[entries[0]]
            case "t":
                return tuple(map(self.value, entries))
            case "l":
                return list(map(self.value, entries))
            case "f":
                return frozenset(map(self.value, entries))
            case "d":
                return {self.value(name): self.value(each) for name, each in entries}
            case "e":
                return self._classes[entries[0]][0](entries[1])
            case "at":
                at = datetime.fromisoformat(entries[0])
                return at.replace(tzinfo=ZoneInfo(entries[1])) if entries[1] else at
        raise ValueError(f"unknown kind {kind!r}")

    def _object(self, number: int, entries: Sequence[Any]) -> Any:
        """A dataclass; a field that was removed since is ignored, one that was added takes its default."""
        kind, names = self._classes[number]
        known = {each.name for each in fields(kind)}
        return kind(**{name: self.value(each) for name, each in zip(names, entries, strict=True) if name in known})


def _find(name: str) -> Any:
    module, _, kind = name.partition(":")
    found = getattr(importlib.import_module(module), kind) if module.startswith(PACKAGE) else None
    if not (is_dataclass(found) or (isinstance(found, type) and issubclass(found, Enum))):
        raise ValueError(f"{name} is not a class that can be stored")
    return found
