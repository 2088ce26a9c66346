"""The limits of a car: pairs in which what is asked for is missing in one half, one module per kind of want."""

from automotive_cosim.tasks.limits import broken, partly, unfitted, unknown

TASKS = tuple(task for module in (unfitted, broken, partly, unknown) for task in module.TASKS)
"""All of them."""
