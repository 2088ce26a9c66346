"""Tasks for tests, as a user would write them in Python."""

from typing import Any

from automotive_cosim.tasking.checks import Check
from automotive_cosim.tasking.moves import Move
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import Trigger, driving

ON_THE_WAY = Trigger(driving(), for_s=3.0, within_s=60.0)
COMFORT = Deadline(30.0, "a wish for comfort: the driver would reach for the knob within half a minute")
ERRAND = Deadline(60.0, "an errand on the screen: a passenger would have it done within a minute")


def asked(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    goal: Check,
    *moves: Move,
    start: Start = Start("paris_centre", "centre"),  # noqa: B008, it is frozen
    deadline: Deadline = ERRAND,
    **others: Any,
) -> Task:
    """What was asked for outright holds, and nothing else has changed."""
    half = Half(start, ON_THE_WAY, goal, moves, deadline, Basis.WISH)
    return Task(task_id, module, Dimension.EXPLICIT_CONTROL, says, half, **others)
