"""What observes a trial while it runs, e.g. to show or record it; it sees everything and changes nothing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from automotive_cosim.agents import Stage, StageName
from automotive_cosim.contracts import Element
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Session
from automotive_cosim.interface.trace import Step


@dataclass(frozen=True)
class Shot:
    """One step as observers see it."""

    session: Session
    step: Step
    seen: tuple[Element, ...] = ()
    """The elements the agent saw when it acted."""
    stages: tuple[Stage, ...] = ()
    """The stages of the agent's reasoning, for agents that report them."""

    @cached_property
    def thought(self) -> str:
        """The agent's own reason for the action, or what was wrong with its answer; empty if it gives none."""
        said = {stage.name: stage.text for stage in self.stages}
        return said.get(StageName.INTERPRET, said.get(StageName.ACT, ""))

    @cached_property
    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The cockpit after the step, (height, width, 3); drawn when an observer first asks for it, which must be
        before the next step."""
        return self.session.screenshot()


class TrialObserver(Observer):
    """Observes trials: their sessions and what comes of them."""

    def begun(self, session: Any, shot: Shot) -> None:
        """The agent takes over: at the hand-over of a task, or when a drive departs."""

    def stepped(self, shot: Shot) -> None:
        """The agent has acted."""

    def finished(self, row: Any, told: Any) -> None:
        """The trial is over, or was broken off: its row, and what else its trace tells (``TrialSetup.told``)."""
