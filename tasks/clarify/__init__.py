"""Wishes that have to be made clear: by the driver in one half, by what the car knows in the other."""

from automotive_cosim.tasks.clarify import calendar, preferences, road

TASKS = (*preferences.TASKS, *calendar.TASKS, *road.TASKS)
"""All of them, one module per place where the answer stands."""
