"""The table of what is heard of what drivers say, made with the extra ``voice``.

    python -m automotive_cosim.proof.heard --seeds 6 --minutes 5

says and recognises what the table does not have yet: wishes at the seeds from 0, remarks and answers, in English.
Run it again to go on; it ends early when everything is there.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.contracts.given import Language, Order
from automotive_cosim.drives.errands import every, words_about
from automotive_cosim.drives.order import ordered
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.tasking.dialogue import NEUTRAL, PARDON
from automotive_cosim.tasking.draws import Draws, Purpose
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.parameters import FromCockpit
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.voice import table

BATCH = 20
"""Pieces that are said in one go, after which the table is written."""


def wanted(seeds: int) -> Iterator[str]:
    """Everything that is said at these seeds in the tasks' own scenarios, and on drives; what is said everywhere,
    and the suite of the cabin, come first."""
    yield from (NEUTRAL, PARDON)
    for order in Order:
        for with_errands in (False, True):
            yield ordered(order, Language.ENGLISH, with_errands=with_errands)
    tasks = sorted(CATALOGUE.values(), key=lambda task: task.suite is not Suite.VOICE)
    for number in range(seeds):
        for task in tasks:
            yield from said_in(task, number)
    for errand in every():
        yield from words_about(errand, Language.ENGLISH)


def said_in(task: Task, number: int) -> Iterator[str]:
    """The wish, remarks and answers of an instance of a task."""
    for name in task.halves:
        yield from draw(task, name, number, _content(task, name, number)).spoken


def _content(task: Task, half: str, number: int) -> Mapping[str, tuple[str, ...]] | None:
    """People, places and music of the cockpit, if the task draws any."""
    if not any(isinstance(choices, FromCockpit) for choices in task.parameters.values()):
        return None
    start = draw(task, half, number).half.start
    rng = Draws(task.id, number).rng(Purpose.CONTENT)
    return Cockpit(
        _roads(start.scenario),
        rng=rng,
        aboard=start.aboard,
        signals=start.signals,
        arrivals=start.arrivals,
        lacks=start.lacks,
    ).content


@cache
def _roads(scenario: str) -> RoadNetwork:
    return network_of(open_scenario(scenario)).map


def missing(seeds: int, path: Path = table.TABLE) -> list[str]:
    """The pieces that the table has not, in the order in which they are needed."""
    known = table.read(path)
    pieces = dict.fromkeys(piece for text in wanted(seeds) for piece in table.pieces(text))
    return [piece for piece in pieces if piece not in known]


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
