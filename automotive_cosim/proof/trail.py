"""What is on record of a task: gates that it passed, how often it comes about, who won it, and what changed.

    python -m automotive_cosim.proof.trail FOLDER...

takes the proofs of ``tasks validate --out FOLDER`` into ``passed.json`` beside this file.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.proof import frequency
from automotive_cosim.proof.prover import GATES, Proof
from automotive_cosim.run import difficulty
from automotive_cosim.run.store import read_rows
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE

RECORD = Path(__file__).with_name("passed.json")
UNKNOWN = "not on record for what it is now"


@dataclass(frozen=True, slots=True)
class GatesPassed:
    """The gates that one task has passed."""

    halves: tuple[str, ...]
    """``fingerprint`` of each half when it was proved."""
    gates: Mapping[str, tuple[str, ...]]
    """By the last day, as in 2026-11-29, on which they were passed with every seed that was tried."""


def of_task(task: Task) -> Iterator[tuple[str, str]]:
    """What is on record of a task as a whole, as labels and words."""
    found = _shipped().get(task.id)
    days = found.gates if found is not None and found.halves == _halves(task) else {}
    for day in sorted(days, reverse=True):
        yield "proved", f"{day}, by {counted(len(days[day]), 'gate')}: {', '.join(days[day])}"
    if not days:
        yield "proved", UNKNOWN
    for change in task.changed:
        yield "changed", change


def of_half(task: Task, half: str) -> Iterator[tuple[str, str]]:
    """What is on record of one half, as labels and words."""
    yield "reached", str(frequency.measured(task.id, half) or UNKNOWN)
    tried = difficulty.measured(task.id, half)
    yield "won by", str(tried or UNKNOWN)
    won, readers = tried.outcomes.readers if tried else (0, 0)
    yield "readers", f"{won} of {counted(readers, 'careful reader')} won it" if readers else UNKNOWN
    yield "digest", fingerprint(task, half)


def merged(record: Mapping[str, GatesPassed], proofs: Iterable[Proof], day: str) -> dict[str, GatesPassed]:
    """A record with what was passed on a day, in the catalogue's order and without tasks that changed since."""
    now: dict[str, set[str]] = {}
    for proof in proofs:
        if not proof.error:
            gates = {gate for gate, wrong in proof.wrong.items() if not wrong}
            now[proof.task] = now.get(proof.task, gates) & gates
    found = {}
    for task in CATALOGUE.values():
        halves, new = _halves(task), now.get(task.id, set())
        known = record.get(task.id)
        days = dict(known.gates) if known is not None and known.halves == halves else {}
        new |= set(days.get(day, ()))
        days = {then: tuple(gate for gate in gates if gate not in new) for then, gates in days.items()}
        days[day] = tuple(gate for gate in GATES if gate in new)
        if any(days.values()):
            found[task.id] = GatesPassed(halves, {then: gates for then, gates in days.items() if gates})
    return found


def _halves(task: Task) -> tuple[str, ...]:
    return tuple(fingerprint(task, half) for half in task.halves)


@cache
def _shipped() -> Mapping[str, GatesPassed]:
    return read(RECORD)


def read(path: Path) -> dict[str, GatesPassed]:
    """A record; empty if there is none."""
    stored: Mapping[str, Json] = read_json(path) if path.is_file() else {}
    return {
        task_id: GatesPassed(
            tuple(row["halves"]), {day: tuple(gates.split()) for day, gates in row["gates"].items()}
        )
        for task_id, row in stored.items()
    }


def write(path: Path, record: Mapping[str, GatesPassed]) -> None:
    """Replaces a record, one line per task."""
    rows = {
        task_id: {"halves": list(each.halves), "gates": {day: " ".join(gates) for day, gates in each.gates.items()}}
        for task_id, each in record.items()
    }
    lines = ",\n".join(f"{json.dumps(task_id)}: {json.dumps(row)}" for task_id, row in rows.items())
    write_whole(path, f"{{\n{lines}\n}}\n")


def main() -> None:
    """Takes proofs in, and says how many tasks are proved as they are now."""
    parser = argparse.ArgumentParser(description="Record which gates tasks have passed today.")
    parser.add_argument("folders", type=Path, nargs="+", help="folders of `automotive-cosim tasks validate --out`")
    given = parser.parse_args()
    proofs = [proof for folder in given.folders for proof in read_rows(folder, Proof).values()]
    record = merged(read(RECORD), proofs, f"{datetime.now(UTC):%F}")
    write(RECORD, record)
    print(f"{len(record)} of {counted(len(CATALOGUE), 'task')} proved as they are now")


if __name__ == "__main__":
    main()
