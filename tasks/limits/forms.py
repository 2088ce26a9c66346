"""The forms of the suite: one half has the thing; in the other the driver has to be told that it is missing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.lacking import Lacking
from automotive_cosim.contracts import GoalStatus, Reason
from automotive_cosim.tasking.checks import Check, NothingDone
from automotive_cosim.tasking.moves import Inform, Move
from automotive_cosim.tasking.parameters import Choices
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import Driving, Trigger
from automotive_cosim.tasks.forms import AT_REST, NO_PARAMETERS
from automotive_cosim.tasks.hard.forms import Moves

ToBeTold = tuple[tuple[str, ...], ...]
"""What the driver has to be told, each by any of its words."""
ON_THE_ROAD = Start("paris_centre", "centre")
PARKED = Start("paris_centre", "centre", parked=True)
UNDER_WAY = Trigger(Driving(), for_s=3.0, within_s=60.0)
LOOKED_FOR = Deadline(
    60.0, "an errand on the screen: a passenger would have done it, or looked in vain, in a minute"
)
LOOKED_IN_VAIN = Deadline(30.0, "whoever looks where it would be sees within half a minute that it is missing")
TOWNS = ("london", "new_york", "tokyo")
"""Other scenarios for wishes about equipment, which any car has or lacks."""
NOT_THERE = (
    "no", "not", "none", "nothing", "without", "lacks", "lacking", "missing", "unavailable", "cannot", "can t",
    "isn t", "doesn t", "hasn t", "don t", "haven t", "aren t", "wasn t", "couldn t", "won t", "unable", "lack",
)  # fmt: skip
"""ToBeTold that deny, any of which says that something is not there."""
OUT_OF_ORDER = (
    "out of order", "broken", "defective", "defect", "faulty", "fault", "repaired", "repair", "not working",
    "doesn t work", "does not work", "isn t working", "malfunction", "malfunctioning", "inoperative", "failed",
    "failure", "dead",
)  # fmt: skip
"""ToBeTold that say that something is there, and does not work."""
IMPLAUSIBLE = (
    "implausible", "wrong", "cannot be", "can t be", "faulty", "fault", "defective", "broken", "malfunction",
    "malfunctioning", "impossible", "not plausible", "isn t plausible", "not right", "isn t right", "unreliable",
    "incorrect", "error", "unrealistic", "not believable", "unbelievable", "not credible",
)  # fmt: skip
"""ToBeTold that say that a reading is not to be believed."""


def lacking(start: Start, *lacks: Lacking) -> Start:
    """The start in a car that lacks these."""
    return replace(start, lacks=lacks)


def done(
    start: Start,
    goal: Check,
    moves: Moves,
    *,
    tells: ToBeTold = (),
    slips: tuple[Moves, ...] = (),
    may_write: frozenset[str] = frozenset(),
    deadline: Deadline = LOOKED_FOR,
) -> Half:
    """A half in which the car can do what is asked for."""
    trigger = AT_REST if start.parked else UNDER_WAY
    return Half(start, trigger, goal, moves, deadline, Basis.WISH, tells=tells, slips=slips, may_write=may_write)


def told(
    start: Start,
    look: Moves,
    answer: Any,
    tells: ToBeTold,
    *,
    slips: tuple[Moves, ...] = (),
    may_write: frozenset[str] = frozenset(),
    deadline: Deadline = LOOKED_FOR,
) -> Half:
    """A half in which something has to be read and told, and nothing done."""
    return done(
        start,
        NothingDone(),
        (*look, Inform(answer)),
        tells=tells,
        slips=slips,
        may_write=may_write,
        deadline=deadline,
    )


def in_vain(
    start: Start,
    look: Moves,
    answer: Any,
    tells: ToBeTold,
    *,
    slips: tuple[Moves, ...] = (),
    may_write: frozenset[str] = frozenset(),
    deadline: Deadline = LOOKED_IN_VAIN,
) -> Half:
    """A half in which it cannot be done: the right act is to look, to say what is missing, and to leave it all.

    Args:
        start: where the thing is missing.
        look: where it would be.
        answer: the reference solution's words, at most 120 characters.
        tells: what they have to say.
        slips: what is done instead by who does not say so; each must fail.
        may_write: what looking commands, such as the reading of a message.
        deadline: by when, and why.
    """
    half = told(start, look, answer, tells, slips=slips, may_write=may_write, deadline=deadline)
    return replace(half, declares=GoalStatus.INFEASIBLE, reasons=frozenset({Reason.NOT_POSSIBLE}))


def limit(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    first: Half,
    second: Half,
    difference: str,
    *,
    parameters: Mapping[str, Choices] = NO_PARAMETERS,
    scenarios: tuple[str, ...] = (),
) -> Task:
    """A task of the suite."""
    return Task(
        task_id,
        module,
        Dimension.EXPLICIT_CONTROL,
        says,
        first,
        second,
        difference,
        parameters,
        frozenset({"limit"}),
        scenarios,
        Suite.LIMITS,
    )


def unequipped(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    goal: Check,
    *moves: Move,
    lacks: Lacking,
    look: Moves,
    answer: Any,
    tells: ToBeTold,
    instead: tuple[Moves, ...],
    start: Start = ON_THE_ROAD,
    may_write: frozenset[str] = frozenset(),
    parameters: Mapping[str, Choices] = NO_PARAMETERS,
    scenarios: tuple[str, ...] = TOWNS,
) -> Task:
    """A wish for something that the car has and that works, or not.

    Args:
        task_id: ``limits_`` first.
        module: where it belongs.
        says: the phrasings, four at least; the last is held out.
        goal: what must hold where the car has it.
        moves: what brings it about there.
        lacks: what the other car lacks.
        look: where it would be.
        answer: what is said then, at most 120 characters.
        tells: what has to be said.
        instead: what is near, and done in place of it; each must fail in both halves.
        start: where it begins.
        may_write: keys of ``Moment.commands`` that may change besides the goal's own.
        parameters: what is drawn.
        scenarios: where else it can run.
    """
    how = "works, or is out of order" if lacks.is_broken else "is there, or is not"
    return limit(
        task_id,
        module,
        says,
        done(start, goal, moves, slips=instead, may_write=may_write),
        in_vain(lacking(start, lacks), look, answer, tells, slips=instead),
        f"equipment: {lacks.what} {how}",
        parameters=parameters,
        scenarios=scenarios,
    )
