"""The person who plays, as the agent of an episode, and the immediate preview of the person's acts."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit.actions import perform
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Action, ActionType, Observation
from automotive_cosim.errors import AgentError, UserError
from automotive_cosim.interface.observe import ALL
from automotive_cosim.run.trial import HUMAN, NO_MODEL

TICK_S = 1.0
"""Time that an act takes."""
SPEEDS = (1.0, 0.5, 0.25)
"""Simulated seconds per second, in practice."""
WAITING = 4
"""Acts that may wait for their second; more are refused."""


class PersonLeftError(KeyboardInterrupt):
    """The person has left an episode that does not count."""


class Person:
    """The agent: the person who gives the actions."""

    name = HUMAN
    channels = ALL

    def __init__(
        self, model: str = NO_MODEL, *, counts: bool = False, clock: Callable[[], float] = time.monotonic
    ) -> None:
        """Starts without a person.

        Args:
            model: the code name, which replaces the model.
            counts: whether leaving counts as a failure of the agent.
            clock: wall seconds."""
        self.model = model
        self.counts = counts
        self.has_left = False
        self._clock = clock
        self._given: queue.Queue[Action | None] = queue.Queue()
        self._due_s = 0.0
        """Wall time at which the present second is over."""
        self._tick_s = TICK_S
        """Wall seconds in a simulated one."""
        self._goes = threading.Event()
        self._goes.set()
        self._told: Callable[[Observation], None] | None = None

    def give(self, action: Action) -> None:
        """Hands in an action. Raises UserError: too many are already waiting, or the clock is stopped."""
        if not self._goes.is_set():
            raise UserError("the clock is stopped; resume it first")
        if self._given.qsize() >= WAITING:
            raise UserError("each action takes a second; wait until the previous ones have finished")
        self._given.put(action)

    @property
    def has_acts(self) -> bool:
        """Whether an act waits for its second."""
        return not self._given.empty()

    def pace(self, speed: float, *, paused: bool) -> None:
        """Sets how many simulated seconds pass in a second; while paused, none after the current one."""
        self._tick_s = TICK_S / speed
        (self._goes.clear if paused else self._goes.set)()

    def stop(self) -> None:
        """Ends the episode of a person who leaves."""
        self.has_left = True
        self._goes.set()
        self._given.put(None)

    def listen(self, told: Callable[[Observation], None]) -> None:
        """Sets the recipient of what the person is told, and starts the clock."""
        self._told = told
        self._due_s = self._clock() + self._tick_s

    def reset(self, goal: str) -> None:
        """Does nothing: the page shows the driver's words."""

    def act(self, observation: Observation) -> Action:
        """The action given within the current second, else a wait.

        Raises:
            AgentError: the person has left an episode that counts.
            PersonLeftError: the person has left another one."""
        if self._told is not None:
            self._told(observation)
        tick_s = self._tick_s
        ahead_s = self._due_s - self._clock() - tick_s
        if ahead_s > 0:  # an act has moved simulated time ahead of the clock
            time.sleep(ahead_s)
        self._goes.wait()
        now_s = self._clock()
        self._due_s = max(self._due_s, now_s)
        try:
            action = self._given.get(timeout=max(0.0, self._due_s - now_s))
        except queue.Empty:
            action = Action(ActionType.WAIT, seconds=1)
        if action is None:
            raise AgentError("the person has left") if self.counts else PersonLeftError
        self._due_s += tick_s * (action.seconds or 1 if action.action_type is ActionType.WAIT else 1)
        return action


class Preview:
    """The screen as the waiting acts will leave it, drawn before their seconds have passed on the road.

    Acts are performed on a copy of the cockpit that nothing else uses."""

    def __init__(self) -> None:
        self._cockpit: Cockpit | None = None
        """A copy of the real one, ahead of it only by the waiting acts."""

    def follow(self, cockpit: Cockpit) -> None:
        """Starts again from the real cockpit."""
        self._cockpit = cockpit.copy()

    def after(self, action: Action) -> npt.NDArray[np.uint8]:
        """The screen after another act, (height, width, 3)."""
        assert self._cockpit is not None, "there is no cockpit yet"
        perform(action, self._cockpit, ())
        return self._cockpit.screenshot()
