"""The table of what is heard of what drivers say, made with the extra ``voice``.

    python -m automotive_cosim.proof.heard --seeds 3 --minutes 5

says and recognises what the table does not have yet: wishes at the seeds from 0, remarks and answers, in English.
Run it again to go on; it ends early when everything is there.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from automotive_cosim.contracts.given import Language, Order
from automotive_cosim.drives.order import ordered
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.tasking.dialogue import NEUTRAL, PARDON
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.voice import table

BATCH = 20
"""Pieces that are said in one go, after which the table is written."""


def wanted(seeds: int) -> Iterator[str]:
    """Everything that is said at these seeds, apart from wishes with content of the cockpit; what is said
    everywhere, and the suite of the cabin, come first."""
    yield from (NEUTRAL, PARDON)
    for order in Order:
        for with_errands in (False, True):
            yield ordered(order, Language.ENGLISH, with_errands=with_errands)
    tasks = sorted(CATALOGUE.values(), key=lambda task: task.suite is not Suite.VOICE)
    for number in range(seeds):
        for task in tasks:
            yield from said_in(task, number)


def said_in(task: Task, number: int) -> Iterator[str]:
    """The wish, remarks and answers of an instance of a task."""
    for name in task.halves:
        with suppress(UnknownNameError):
            instance = draw(task, name, number)
            half = instance.half
            yield from (instance.goal, *(each.text for each in half.says), *(each.reply for each in half.topics))


def missing(seeds: int, path: Path = table.TABLE) -> list[str]:
    """The pieces that the table has not, in the order in which they are needed."""
    known = table.read(path)
    every = dict.fromkeys(piece for text in wanted(seeds) for piece in table.pieces(text))
    return [piece for piece in every if piece not in known and "<" not in piece]


def main() -> None:
    """Makes what is missing, and says what still is."""
    parser = argparse.ArgumentParser(description="Say and recognise what drivers say.")
    parser.add_argument("--seeds", type=int, default=1, help="seeds from 0 whose wishes are said")
    parser.add_argument("--minutes", type=float, default=5.0, help="stop after this long; run again to go on")
    parser.add_argument("--out", type=Path, default=table.TABLE, help="the table, by default the shipped one")
    given = parser.parse_args()
    ends_s = time.monotonic() + 60 * given.minutes
    left = missing(given.seeds, given.out)
    while left and time.monotonic() < ends_s:
        now, left = left[:BATCH], left[BATCH:]
        table.write(dict(table.read(given.out)) | dict(table.recognise(now)), given.out)
    print(f"{len(table.read(given.out)):,} pieces are in the table, {len(left):,} are missing")


if __name__ == "__main__":
    main()
