"""The novelty law: no task is another one filled in anew, and no form is used up.

Two tasks are held against each other by four things, each as the share of features that only one of them has
(Jaccard's distance, 0 to 1): what is checked (``checked``), the situation that it is checked in (``situated``),
what the driver says (``said``), and what has to be done (``gone``). The distance of two tasks is the mean of the
four.

``NEAREST`` is that of a template filled in anew: goal and solution are the same (0 and 0), and half of the
situation and half of the words have changed (0.5 and 0.5), which makes a quarter. What is nearer asks for nothing
new. ``KIN`` is where two tasks share their form: goal and solution are the same, and all but a fifth of the
situation and of the words is new. A form may be used ``USES`` times. Of all pairs of tasks, one
in four thousand is that near.
"""

import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.moves import Consult, Hear
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Basis, Start, Task
from automotive_cosim.tasks import CATALOGUE

NEAREST, KIN, USES = 0.25, 0.4, 3
COMMON = re.compile(
    r"\b(a|an|and|any|are|as|at|be|been|by|can|could|do|does|don't|else|for|from|get|give|go|had|has|have|he|her|here"
    r"|him|his|how|i|i'd|i'll|i'm|if|in|is|isn't|it|it's|its|just|keep|let|like|make|me|my|need|no|not|now|of|off|on"
    r"|one|or|our|out|over|please|put|right|see|set|she|should|so|some|something|switch|take|tell|than|that|that's|the"
    r"|their|them|then|there|they|this|to|too|turn|up|us|want|was|we|what|when|where|whether|which|while|who|will|with"
    r"|would|you|your)\b(?!')"
)
"""Words that tell nothing of what a wish is about."""


def leaves(value: Any, at: str = "") -> Iterator[str]:
    """Every value in a tree of dataclasses, with the names of the fields that lead to it."""
    if is_dataclass(value) and not isinstance(value, type):
        yield f"{at}={type(value).__name__}"
        for field in fields(value):
            yield from leaves(getattr(value, field.name), f"{type(value).__name__}.{field.name}")
    elif isinstance(value, tuple | list | frozenset):
        for one in value:
            yield from leaves(one, at)
    elif isinstance(value, dict):
        for key, one in value.items():
            yield f"{at}={key}"
            yield from leaves(one, f"{at}.{key}")
    else:
        yield f"{at}={value}"


def checked(task: Task) -> Iterator[str]:
    """What holds in the end, in either half, and what is declared."""
    for half in _halves(task):
        yield from leaves(half.goal)
        yield f"declares {half.declares}"


def situated(task: Task) -> Iterator[str]:
    """Where, when, with whom, in what weather and under which law it happens, and what sets it off."""
    usual = Start("", "")
    for half in _halves(task):
        for field in fields(Start):
            value = getattr(half.start, field.name)
            if isinstance(value, Weather):
                value = (
                    f"code {value.weather_code}",
                    f"{value.temperature_2m // 5:g}",
                    f"sight {value.visibility:g}",
                )
            if value != getattr(usual, field.name):
                yield from leaves(value, field.name)
        yield from leaves(half.trigger.condition)
        yield from half.rule.split(", ") if half.basis is Basis.LAW else (half.rule,)
        yield from leaves(half.says)
    yield from (f"differs in {kind}" for kind in task.differs)


def said(task: Task) -> Iterator[str]:
    """The words of all phrasings but the commonest, by their first five letters."""
    for word in re.findall(r"[a-z']+", " ".join(task.templates).lower()):
        if not COMMON.fullmatch(word):
            yield word[:5]


def gone(task: Task) -> Iterator[str]:
    """The reference solutions of either half; what is asked and heard, by its kind."""
    for half in _halves(task):
        for move in itertools.chain(half.moves, *half.ways):
            yield type(move).__name__ if isinstance(move, Consult | Hear) else repr(move)
        if not half.moves:
            yield f"declares {half.declares}"


def _halves(task: Task) -> list[Any]:
    return [task.half(name) for name in task.halves]


FACETS = (checked, situated, said, gone)


def distances(tasks: Sequence[Task]) -> np.ndarray:
    """Of each of n tasks to each, n by n: from 0, the same, to 1, nothing in common."""
    near = np.zeros((len(tasks), len(tasks)))
    for facet in FACETS:
        number: dict[str, int] = {}
        found = [{number.setdefault(each, len(number)) for each in facet(task)} for task in tasks]
        has = np.zeros((len(tasks), len(number)), np.float32)
        for row, features in zip(has, found, strict=True):
            row[list(features)] = 1
        both = has @ has.T
        either = has.sum(1)[:, None] + has.sum(1)[None, :] - both
        near += both / either
    return 1 - near / len(FACETS)


def too_near(tasks: Sequence[Task], apart: np.ndarray) -> list[str]:
    """Pairs of tasks nearer to each other than the law allows."""
    return [
        f"{tasks[one].id} and {tasks[other].id}: {apart[one, other]:.2f}"
        for one, other in np.argwhere(np.triu(apart < NEAREST, 1))
    ]


TASKS = tuple(task for task in CATALOGUE.values() if task.suite not in (Suite.SPEED, Suite.VOICE))
"""Without the suites of families, which ask one thing in many countries, as a protocol does, or in many noises."""


@pytest.fixture(scope="module")
def apart() -> np.ndarray:
    return distances(TASKS)


def test_no_task_is_another_filled_in_anew(apart: np.ndarray):
    assert too_near(TASKS, apart) == []


def test_no_form_is_used_more_than_three_times(apart: np.ndarray):
    assert [TASKS[row].id for row in np.flatnonzero((apart < KIN).sum(1) > USES)] == []


def test_a_template_filled_in_anew_is_found():
    """The law can fail: the same wish in half of the words, at another place."""
    task = CATALOGUE["system_lock_up"]
    again = replace(
        task,
        id="again",
        templates=(*task.templates[:3], "Bolt everything", "Close up for the night"),
        first=replace(task.first, start=replace(task.first.start, scenario="london", trip="strand")),
    )
    assert len(too_near((task, again), distances((task, again)))) == 1
