"""The form of the suite: whoever asks what can be known loses, as does whoever acts on a guess or asks too late."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.tasking.checks import Check
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Consult, Move
from automotive_cosim.tasking.parameters import Choices
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Dimension, Module, Start, Task
from automotive_cosim.tasks.forms import AT_REST, ON_THE_WAY, unclear


def clarify(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    topic: Topic,
    question: str,
    goal: Check,
    *moves: Move,
    untold: Start,
    told: Start,
    look: tuple[Move, ...],
    difference: str,
    parameters: Mapping[str, Choices],
    find: tuple[Move, ...] = (),
    dimension: Dimension = Dimension.EXPLICIT_CONTROL,
    may_write: frozenset[str] = frozenset(),
) -> Task:
    """A task of the suite.

    Args:
        task_id: ``clarify_`` first.
        module: where it belongs.
        says: the phrasings, four at least; the last is held out. None tells what is meant.
        topic: what the driver can be asked about.
        question: the reference solution's, which names every choice.
        goal: what must hold besides.
        moves: what brings it about.
        untold: start of the first half, in which only the driver knows.
        told: start of the second half, in which the car does.
        look: where it stands then.
        difference: what the second half changes, as in ``Task.difference``.
        parameters: what is drawn: ``which``, what is meant, among it.
        find: where the choices are to be seen, unless every phrasing names them.
        dimension: explicit, or implicit if the words do not say what to do.
        may_write: what else may change, in both halves.
    """
    task = unclear(
        task_id,
        module,
        says,
        topic,
        question,
        goal,
        *moves,
        untold=untold,
        told=told,
        look=look,
        difference=difference,
        parameters=parameters,
        find=find,
        trigger=AT_REST if told.parked else ON_THE_WAY,
        dimension=dimension,
    )
    assert task.second is not None
    ask = Consult(question)
    first, second = task.first, task.second
    guessed = replace(first, slips=(moves, (*moves, ask)), may_write=first.may_write | may_write)
    asked = replace(second, slips=((ask, *moves),), may_write=second.may_write | may_write)
    return replace(task, first=guessed, second=asked, suite=Suite.CLARIFY)


def noted(start: Start, *memos: Any) -> Start:
    """The start with these memos of the driver's."""
    return replace(start, belongings=Belongings(memos=memos))


def planned(start: Start, *entries: Appointment, **papers: Any) -> Start:
    """The start with these appointments on its day."""
    return replace(start, belongings=Belongings(agenda=entries, **papers))


def entry(at: Any, title: Any, place: Any = "") -> Appointment:
    """An appointment, any part of which may be a parameter."""
    return Appointment(at, title, place)
