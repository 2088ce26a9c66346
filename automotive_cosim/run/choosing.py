"""Which tasks words mean: ids, patterns, tags and subsets."""

from __future__ import annotations

from collections.abc import Iterable

from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.words import matches
from automotive_cosim.run import difficulty
from automotive_cosim.tasking.sets import ALL_SUITES, LIVE, SUITES, Suite
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE


def choose(asked: Iterable[str], suite: str = Suite.STANDARD) -> tuple[str, ...]:
    """Ids of the tasks that any of the words selects, in the catalogue's order.

    Args:
        asked: ids, patterns, tags and so on.
        suite: the suite that patterns and tags select from, ``all``, or ``live`` for the pairs that hurry; an id
            that selects nothing there names its task in any, ``core`` those of the core subset, and ``verified``
            those that careful readers have won.

    Raises UnknownNameError: there is no such suite, or a word selects none of its tasks."""
    if suite not in SUITES:
        raise UnknownNameError("suite", suite, SUITES)
    there = tuple(CATALOGUE.values()) if suite in (ALL_SUITES, LIVE) else CATALOGUE.of(Suite(suite))
    if suite == LIVE:
        there = tuple(task for task in there if task.hurries is not None)
    drawn = {difficulty.CORE: lambda: difficulty.shipped().core, difficulty.VERIFIED: difficulty.verified}
    chosen: set[str] = set()
    for word in asked:
        named = {task.id for task in there if matches(task.id, word) or word in _words(task)}
        if word in drawn or not named:  # to look beyond the suite is to read all files
            named |= {word, *(drawn[word]() if word in drawn else ())} & set(CATALOGUE)
        if not named:
            known = {*drawn, *CATALOGUE}.union(*map(_words, there))
            raise UnknownNameError("task, pattern or tag", word, known, "automotive-cosim tasks list")
        chosen |= named
    order = [task.id for task in there]
    return tuple(task_id for task_id in (order if chosen <= set(order) else CATALOGUE) if task_id in chosen)


def _words(task: Task) -> frozenset[str]:
    kind = "safety" if task.dimension.is_safety else "general"
    ability = () if task.ability is None else (str(task.ability),)
    return task.tags | {*ability, "all", kind, str(task.module), str(task.dimension), str(task.subset)}
