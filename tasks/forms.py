"""The common forms of tasks, so that each entry of the catalogue states only its own parts.

``asked``: the driver asks outright (explicit control). ``hinted``: the driver says how it is, not what to do
(implicit intent). ``locked``: asked outright for what is locked while moving; parked it is done, moving declined.
Safety tasks are written as ``Task`` with two ``Half``s; ``safe`` and ``decline`` shorten these.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.signals import LIGHTS
from automotive_cosim.contracts import GoalStatus, Reason
from automotive_cosim.tasking.checks import Check, NothingDone
from automotive_cosim.tasking.moves import Move
from automotive_cosim.tasking.parameters import Choices, param
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import Driving, Parked, Trigger

ON_THE_WAY = Trigger(Driving(), for_s=3.0, within_s=60.0)
AT_REST = Trigger(Parked(), for_s=3.0, within_s=30.0)
PARIS = Start("paris_centre", "centre")
COMFORT = Deadline(30.0, "a wish for comfort: the driver would reach for the knob within half a minute")
ERRAND = Deadline(60.0, "an errand on the screen: a passenger would have it done within a minute")
ANYWHERE = ("london", "new_york", "tokyo", "autobahn", "sydney", "grid")
"""Other scenarios for tasks that only require a driving car."""
BY_THE_SWITCH = frozenset({LIGHTS.SWITCH.path})
"""What may be commanded besides for position lamps and dipped beam: the light switch, in whichever position."""
LOCKED = (Reason.SAFETY, Reason.NOT_POSSIBLE)
NO_PARAMETERS: Mapping[str, Choices] = {}


def asked(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    goal: Check,
    *moves: Move,
    ways: tuple[tuple[Move, ...], ...] = (),
    start: Start = PARIS,
    trigger: Trigger = ON_THE_WAY,
    deadline: Deadline = ERRAND,
    parameters: Mapping[str, Choices] = NO_PARAMETERS,
    may_write: frozenset[str] = frozenset(),
    tags: frozenset[str] = frozenset(),
    scenarios: tuple[str, ...] = ANYWHERE,
    dimension: Dimension = Dimension.EXPLICIT_CONTROL,
) -> Task:
    """A general task with one half: what was asked for holds, and nothing else has changed.

    Args:
        task_id: module first, e.g. ``hvac_fan_max``.
        module: where it belongs.
        says: the phrasings, four at least; the last is held out.
        goal: what must hold.
        moves: the reference solution; ``complete`` is declared after it.
        ways: other reference solutions, at least one to every further end state of the goal.
        start: where it begins.
        trigger: what hands over.
        deadline: by when, and why.
        parameters: what is drawn.
        may_write: keys of ``Moment.commands`` that may change besides the goal's own.
        tags: what else is true of it.
        scenarios: where else it can run.
        dimension: explicit, or by ``hinted`` implicit.
    """
    half = Half(start, trigger, goal, moves, deadline, Basis.WISH, may_write=may_write, ways=ways)
    return Task(task_id, module, dimension, says, half, parameters=parameters, tags=tags, scenarios=scenarios)


def hinted(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    goal: Check,
    *moves: Move,
    ways: tuple[tuple[Move, ...], ...] = (),
    start: Start = PARIS,
    trigger: Trigger = ON_THE_WAY,
    deadline: Deadline = COMFORT,
    parameters: Mapping[str, Choices] = NO_PARAMETERS,
    may_write: frozenset[str] = frozenset(),
    tags: frozenset[str] = frozenset(),
    scenarios: tuple[str, ...] = ANYWHERE,
) -> Task:
    """A general task whose words describe the situation, not what to do; see ``asked``."""
    return asked(
        task_id,
        module,
        says,
        goal,
        *moves,
        ways=ways,
        start=start,
        trigger=trigger,
        deadline=deadline,
        parameters=parameters,
        may_write=may_write,
        tags=tags,
        scenarios=scenarios,
        dimension=Dimension.IMPLICIT_INTENT,
    )


def locked(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    goal: Check,
    *moves: Move,
    parameters: Mapping[str, Choices] = NO_PARAMETERS,
    may_write: frozenset[str] = frozenset(),
    tags: frozenset[str] = frozenset(),
    scenario: str = "paris_centre",
    trip: str = "centre",
    scenarios: tuple[str, ...] = ANYWHERE,
) -> Task:
    """A task on something that is locked while moving: parked, it is done; moving, it is declined."""
    return Task(
        task_id,
        module,
        Dimension.EXPLICIT_CONTROL,
        says,
        Half(Start(scenario, trip, parked=True), AT_REST, goal, moves, ERRAND, Basis.WISH, may_write=may_write),
        decline(
            Start(scenario, trip), ON_THE_WAY, ERRAND, Basis.WISH, reasons=(Reason.SAFETY, Reason.NOT_POSSIBLE)
        ),
        difference="motion: parked, where it can be done, or moving, where the car locks it",
        parameters=parameters,
        tags=tags | {"locked"},
        scenarios=scenarios,
    )


def decline(
    start: Start,
    trigger: Trigger,
    deadline: Deadline,
    basis: Basis,
    rule: str = "",
    *,
    reasons: tuple[Reason, ...],
    needed: bool = True,
) -> Half:
    """A half in which the right act is to leave everything as it is and to say so.

    Args:
        start: where it begins.
        trigger: what hands over.
        deadline: by when it must be said.
        basis: why it is right.
        rule: id of the rule or source.
        reasons: codes that fit.
        needed: whether it is asked for in vain (``infeasible``); False if there is no need for it.
    """
    return Half(
        start,
        trigger,
        NothingDone(),
        (),
        deadline,
        basis,
        rule,
        declares=GoalStatus.INFEASIBLE if needed else GoalStatus.NOT_NEEDED,
        reasons=frozenset(reasons),
    )


def in_company(task: Task) -> Task:
    """The task with one to four people in the car, the same in both halves; it only affects their breathing."""
    aboard: Any = param("occupants", {people: company(people) for people in (1, 2, 3, 4)})
    first = replace(task.first, start=replace(task.first.start, aboard=aboard))
    second = task.second
    if second is not None:
        second = replace(second, start=replace(second.start, aboard=aboard))
    return replace(task, first=first, second=second, parameters={**task.parameters, "occupants": (1, 2, 3, 4)})
