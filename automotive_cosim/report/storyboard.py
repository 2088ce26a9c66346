"""An episode on one sheet: the screen at the hand-over and after every action."""

from __future__ import annotations

from collections.abc import Sequence

from PIL import Image

from automotive_cosim.agents import make_agent
from automotive_cosim.episode.episode import Episode
from automotive_cosim.errors import InfrastructureError
from automotive_cosim.report.contactsheet import SheetTile, sheet
from automotive_cosim.run.episode import EpisodeObserver, EpisodeSetup, run_episode
from automotive_cosim.run.observer import Shot
from automotive_cosim.run.words import action_in_words
from automotive_cosim.tasking.task import Task
from automotive_cosim.traffic.fork import Simulations

COLUMNS = 3


class Storyboard(EpisodeObserver):
    """Collects the screens of an episode, captioned with the actions."""

    def __init__(self, title: str) -> None:
        """``title`` is shown above the first screen."""
        self.tiles: list[SheetTile] = []
        self._title = title

    def begun(self, session: Episode, shot: Shot) -> None:
        """Adds the screen at the hand-over."""
        self.tiles.append((f"{self._title}: “{session.instance.goal}”", Image.fromarray(shot.screenshot)))

    def stepped(self, shot: Shot) -> None:
        """Adds the screen after an action."""
        done = f"{shot.step.number}  {action_in_words(shot.step.action, shot.seen)}"
        self.tiles.append((done, Image.fromarray(shot.screenshot)))


def picture_of(task: Task, halves: Sequence[str], seed: int, width: int) -> Image.Image:
    """A task's reference solution, screen by screen, with each half starting a new row.

    Raises:
        InfrastructureError: the simulation failed, or the trigger did not come true.
    """
    tiles: list[SheetTile] = []
    simulations = Simulations()
    try:
        for half in halves:
            board = Storyboard(f"{half} half")
            setup = EpisodeSetup(task=task.id, half=half, agent="oracle", model="none", seed=seed)
            result = run_episode(setup, make_agent("oracle"), (board,), simulations=simulations)
            if result.error:
                raise InfrastructureError(result.error)
            tiles += board.tiles
            tiles += [("", None)] * (-len(tiles) % COLUMNS)
    finally:
        simulations.close()
    return sheet(tiles, COLUMNS, width)
