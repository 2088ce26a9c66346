"""An agent that plays actions from a file, one JSON object per line."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from pathlib import Path

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Action, ActionType, Observation
from automotive_cosim.errors import ActionError
from automotive_cosim.formats.files import read_text
from automotive_cosim.interface.observe import ALL


class ScriptedAgent:
    """Plays one action per step, whatever it observes, then waits until the episode is over."""

    name = "script"
    model = "none"
    channels = ALL

    def __init__(self, actions: Sequence[Action]) -> None:
        self._actions = tuple(actions)
        self._left: deque[Action] = deque()

    def reset(self, goal: str) -> None:
        self._left = deque(self._actions)

    def act(self, observation: Observation) -> Action:
        return self._left.popleft() if self._left else Action(ActionType.WAIT, seconds=1)


def read_script(path: Path) -> ScriptedAgent:
    """Reads a file of actions; empty lines are ignored.

    Raises ActionError: the file cannot be read, has no action, or a line is malformed; it names file and line."""
    actions = []
    for number, line in enumerate(read_text(path, ActionError).split("\n"), start=1):
        if line.strip():
            try:
                actions.append(parse(line))
            except ActionError as error:
                raise ActionError(f"{path}, line {number}: {error}") from error
    if not actions:
        raise ActionError(f"{path} has no actions; write one JSON object per line")
    return ScriptedAgent(actions)
