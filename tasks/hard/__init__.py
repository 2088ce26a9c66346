"""The hard suite: tasks of ten actions and more that are hard for good reasons, one module per reason."""

from automotive_cosim.tasks.hard import (
    aboard,
    carried,
    decided,
    dialogue,
    errands,
    interrupted,
    ordered,
    over_time,
    pictured,
    prepared,
    remembered,
    ruled,
    sensed,
    several,
    side_effects,
    watched,
)

_MODULES = (
    carried,
    prepared,
    interrupted,
    side_effects,
    over_time,
    several,
    dialogue,
    errands,
    aboard,
    pictured,
    decided,
    ruled,
    remembered,
    ordered,
    sensed,
    watched,
)
TASKS = tuple(task for module in _MODULES for task in module.TASKS)
"""All of them."""
