"""How hard each half of a task is, measured: who has won it, and what an item response model makes of that.

A task is as hard as the harder of its halves, as both have to be won. ``automotive_cosim.proof.difficulty`` renews
``difficulty.json`` beside this file.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import Json
from automotive_cosim.formats.compiled import compiled
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.tasking.catalogue import described
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE

RECORD = Path(__file__).with_name("difficulty.json")
CORE = "core"
"""The word that selects ``Difficulties.core``."""


PROGRAM, CAREFUL = "asurada, rules", "careful"
"""Contestants that the levels refer to: the rule stand-in at its ablest, and a large language model whose answers
were given by hand through the same prompts. Further such readers are called ``careful`` and a number."""
VERIFIED = "verified"
"""The word that selects the tasks of which at least ``READERS`` careful readers have won each half as it is."""
READERS = 2


class WonBy(StrEnum):
    """Who wins a half at least every other time."""

    PROGRAM = "a program wins it"
    CAREFUL = "a careful model wins it"
    OPEN = "no program wins it"
    """The careful model has not tried it."""
    FEW = "few win it"
    UNKNOWN = "not measured"


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Who has tried one half."""

    half: str
    """``fingerprint`` of the half when it was tried."""
    won: Mapping[str, tuple[int, int]]
    """By contestant, how often it won, of how many trials that ended without an error."""

    @property
    def readers(self) -> tuple[int, int]:
        """How many careful readers have won it at least every other time, and how many have tried it."""
        read = [2 * won >= tried for who, (won, tried) in self.won.items() if who.partition(" ")[0] == CAREFUL]
        return sum(read), len(read)

    @property
    def winners(self) -> int:
        """The number of contestants that won it at least every other time."""
        return sum(2 * won >= tried for won, tried in self.won.values())


@dataclass(frozen=True, slots=True)
class Difficulty:
    """How hard a half is."""

    logits: float
    """A contestant with as much ability wins it every other time; one with a logit more, 73 of 100 times."""
    error: float
    """Standard error."""
    outcomes: Outcomes

    def __str__(self) -> str:
        who = f"{self.outcomes.winners} of {len(self.outcomes.won)} contestants"
        return f"{who}; difficulty {self.logits:+.1f} ± {self.error:.1f} logits: {level(self)}"


@dataclass(frozen=True, slots=True)
class Difficulties:
    """A record."""

    halves: Mapping[str, Difficulty] = field(default_factory=dict)
    """By task and half, as in ``hvac_clammy/first``."""
    abilities: Mapping[str, float] = field(default_factory=dict)
    """Of each contestant, in logits; the mean difficulty is zero."""
    core: tuple[str, ...] = ()
    """Ids of the tasks of the core subset."""


@cache
def measured(task_id: str, half: str) -> Difficulty | None:
    """What is on record of a half as it is now; None if it has changed or is not of the shipped catalogue."""
    found = shipped().halves.get(name := f"{task_id}/{half}")
    return found if found is not None and found.outcomes.half == _now().get(name) else None


@cache
def _now() -> Mapping[str, str]:
    """``fingerprint`` of each half on record as it is now, kept: to make them all takes a fifth of a second."""
    files = (RECORD, *sorted(CATALOGUE.folder.rglob("*.toml"))) if CATALOGUE.folder else (RECORD,)
    return compiled(files, lambda: dict(_fingerprints(shipped().halves)))


def _fingerprints(names: Iterable[str]) -> Iterator[tuple[str, str]]:
    for name in names:
        task_id, half = name.split("/")
        if task_id in CATALOGUE and half in CATALOGUE[task_id].halves:
            yield name, fingerprint(CATALOGUE[task_id], half)


def hardest(task: Task) -> Difficulty | None:
    """That of the harder half of a task; None unless all its halves are on record."""
    found = [measured(task.id, half) for half in task.halves]
    known = [each for each in found if each is not None]
    return max(known, key=lambda each: each.logits) if len(known) == len(found) else None


def verified() -> tuple[str, ...]:
    """Ids of the tasks that ``VERIFIED`` selects."""
    return tuple(task.id for task in CATALOGUE.values() if min(_winning_readers(task)) >= READERS)


def _winning_readers(task: Task) -> list[int]:
    """By half, how many careful readers have won it."""
    found = [measured(task.id, half) for half in task.halves]
    return [0 if each is None else each.outcomes.readers[0] for each in found]


def level(difficulty: Difficulty | None) -> WonBy:
    """Who wins it."""
    abilities = shipped().abilities
    if difficulty is None or not abilities.keys() >= {PROGRAM, CAREFUL}:
        return WonBy.UNKNOWN
    if difficulty.logits <= abilities[PROGRAM]:
        return WonBy.PROGRAM
    if not difficulty.outcomes.readers[1]:
        return WonBy.OPEN
    return WonBy.CAREFUL if difficulty.logits <= abilities[CAREFUL] else WonBy.FEW


def rated(task: Task) -> dict[str, Any]:
    """A task as one row of plain values, with its difficulty."""
    found = hardest(task)
    logits = None if found is None else found.logits
    return described(task) | {"difficulty": str(level(found)), "difficulty_logits": logits}


@cache
def shipped() -> Difficulties:
    """The record of the shipped catalogue."""
    return read(RECORD)


def read(path: Path) -> Difficulties:
    """A record; empty if there is none."""
    if not path.is_file():
        return Difficulties()
    stored: Mapping[str, Json] = read_json(path)
    halves = {
        name: Difficulty(
            row["logits"],
            row["error"],
            Outcomes(row["half"], {who: (won, tried) for who, (won, tried) in row["won"].items()}),
        )
        for name, row in stored["halves"].items()
    }
    return Difficulties(halves, stored["abilities"], tuple(stored["core"]))


def write(path: Path, record: Difficulties) -> None:
    """Replaces a record, one line per half in the catalogue's order."""
    lines = []
    for task in CATALOGUE.values():
        for half in task.halves:
            if found := record.halves.get(name := f"{task.id}/{half}"):
                row = {
                    "half": found.outcomes.half,
                    "logits": round(found.logits, 2),
                    "error": round(found.error, 2),
                    "won": {who: list(found.outcomes.won[who]) for who in sorted(found.outcomes.won)},
                }
                lines.append(f"{json.dumps(name)}: {json.dumps(row)}")
    abilities = {name: round(record.abilities[name], 2) for name in sorted(record.abilities)}
    text = f'"abilities": {json.dumps(abilities)},\n"core": {json.dumps(list(record.core))},\n'
    write_whole(path, "{\n" + text + '"halves": {\n' + ",\n".join(lines) + "\n}}\n")
