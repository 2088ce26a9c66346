"""The hard suite: tasks of ten actions and more that are hard for good reasons, one module per reason."""

from automotive_cosim.tasks.hard import carried, interrupted, over_time, several, side_effects

TASKS = (*carried.TASKS, *interrupted.TASKS, *side_effects.TASKS, *over_time.TASKS, *several.TASKS)
"""All of them."""
