"""How often the situation of each half comes about, measured on seeds that no task was written with.

    python -m automotive_cosim.proof.frequency --first-seed 100 --seeds 20

drives up to every hand-over and renews ``frequency.json`` beside this file, for ``automotive-cosim tasks show``.
Run again, it measures only what is missing and halves whose situation has changed since.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource
from automotive_cosim.errors import TriggerNotReachedError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.proof.hand_over import SEEING
from automotive_cosim.run.choosing import choose
from automotive_cosim.tasking.fingerprint import situation
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

RECORD = Path(__file__).with_name("frequency.json")
WARM = 2
"""Simulations kept warm: halves are tried scenario by scenario."""


@dataclass(frozen=True, slots=True)
class Reach:
    """The seeds that one half was tried with; a seed counts with its own traffic, without an evaluation's spare."""

    situation: str
    """``fingerprint.situation`` of the half when it was measured."""
    reached: tuple[int, ...]
    missed: tuple[int, ...] = ()

    @property
    def seeds(self) -> tuple[int, ...]:
        """All of them, in order."""
        return tuple(sorted((*self.reached, *self.missed)))

    def __str__(self) -> str:
        tried = self.seeds
        missed = f"; not with {', '.join(map(str, self.missed))}" if self.missed else ""
        return f"{len(self.reached)} of {len(tried)} seeds ({tried[0]} to {tried[-1]}){missed}"


def measured(task_id: str, half: str) -> Reach | None:
    """What is on record of a half as it is now; None if it has changed or is not of the shipped catalogue."""
    reach = _shipped().get(f"{task_id}/{half}")
    known = reach is not None and reach.situation == situation(CATALOGUE[task_id].half(half))
    return reach if known else None


@cache
def _shipped() -> Mapping[str, Reach]:
    return read(RECORD)


def read(path: Path) -> Mapping[str, Reach]:
    """A record by task and half; empty if there is none."""
    if not path.is_file():
        return {}
    rows: Mapping[str, Json] = read_json(path)
    return {
        name: Reach(row["situation"], tuple(row["reached"]), tuple(row.get("missed", ())))
        for name, row in rows.items()
    }


def write(path: Path, record: Mapping[str, Reach]) -> None:
    """Replaces a record, one line per half in the catalogue's order."""
    lines = []
    for task in CATALOGUE.values():
        for half in task.halves:
            if reach := record.get(f"{task.id}/{half}"):
                row = {"situation": reach.situation, "reached": sorted(reach.reached)}
                row |= {"missed": sorted(reach.missed)} if reach.missed else {}
                lines.append(f"{json.dumps(f'{task.id}/{half}')}: {json.dumps(row)}")
    write_whole(path, "{\n" + ",\n".join(lines) + "\n}\n")


def measure(
    tasks: Sequence[str], seeds: Sequence[int], path: Path = RECORD, suite: str = Suite.STANDARD
) -> Iterator[tuple[str, int, bool]]:
    """Tries every half with every seed that is not on record; yields each half, seed and whether it was reached.

    The record is written after each scenario with a seed, so that a killed run loses little.

    Args:
        tasks: ids of the catalogue, or anything else that ``run.choosing.choose`` accepts.
        seeds: the seeds.
        suite: the suite that the tasks are chosen from, or ``all``."""
    record = dict(read(path))
    halves = [(task_id, half) for task_id in choose(tasks, suite) for half in CATALOGUE[task_id].halves]
    halves.sort(key=_traffic)
    with closing(Simulations(count_limit=WARM)) as simulations:
        for seed in seeds:
            last: str | None = None
            for task_id, half in halves:
                name, now = f"{task_id}/{half}", situation(CATALOGUE[task_id].half(half))
                known = record.get(name)
                if known is None or known.situation != now:
                    known = Reach(now, ())
                if seed in known.seeds:
                    continue
                traffic = _traffic((task_id, half))
                if last not in (None, traffic):
                    write(path, record)
                last = traffic
                reached = _is_reached(task_id, half, seed, simulations)
                record[name] = Reach(
                    now,
                    (*known.reached, seed) if reached else known.reached,
                    known.missed if reached else (*known.missed, seed),
                )
                yield name, seed, reached
            write(path, record)


def _traffic(entry: tuple[str, str]) -> str:
    task_id, half = entry
    start = CATALOGUE[task_id].half(half).start
    return f"{start.scenario} {start.origin}"


def _is_reached(task_id: str, half: str, seed: int, simulations: Simulations) -> bool:
    finder = SituationFinder(EpisodeSpec(task_id, half, seed=seed, conditions=SEEING), simulations)
    try:
        finder.find(SeedSource(seed).next()).world.close()
    except TriggerNotReachedError:
        return False
    return True


def main() -> None:
    """Measures, and says what is not reached."""
    parser = argparse.ArgumentParser(description="Measure how often the situation of each half comes about.")
    parser.add_argument("--tasks", default="all", help="as for `automotive-cosim tasks validate`")
    parser.add_argument("--suite", default="standard", help=f"{', '.join(Suite)}, live or all")
    parser.add_argument("--first-seed", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--out", type=Path, default=RECORD, help="the record, by default the shipped one")
    given = parser.parse_args()
    seeds = range(given.first_seed, given.first_seed + given.seeds)
    missed = 0
    for name, seed, reached in measure(given.tasks.split(","), seeds, given.out, given.suite):
        if not reached:
            missed += 1
            print(f"{name}, seed {seed}: not reached", flush=True)
    everything = read(given.out).values()
    tried, lost = sum(len(each.seeds) for each in everything), sum(len(each.missed) for each in everything)
    print(f"on record: {tried - lost:,} of {tried:,} reached")


if __name__ == "__main__":
    main()
