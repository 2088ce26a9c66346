"""What an app is: its screens, where it is opened, and what it keeps.

An app is a file in ``apps/`` that has an ``APP``, or a folder whose ``app.py`` has it; ``registry`` finds it there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np

from automotive_cosim.cockpit.functions import CarFunction
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.widgets import Widget


class Where(Enum):
    """Where an app is opened; every app is also in the launcher, and opens by its name."""

    DOCK = "in the dock"
    STATUS = "on the status bar"
    LAUNCHER = "in the launcher"
    STORE = "in the launcher, while it is installed"


class AppPage(NamedTuple):
    """A screen."""

    made: Callable[[State], tuple[Widget, ...]]
    room: Room = Room.TWO
    """What it needs."""
    sided: bool = False
    """Whether what is on its left is on the left of the car, so that no make mirrors it."""


def nothing(state: State, rng: np.random.Generator) -> Iterable[AppData]:
    """What an app without data keeps."""
    return ()


@dataclass(frozen=True, slots=True, kw_only=True)
class App:
    """One app of the cockpit."""

    name: str
    title: str
    icon: Icon
    order: int
    """Its place among the apps."""
    pages: Mapping[str, AppPage]
    """Its screens by name; the one with the app's name is shown when it is opened."""
    where: Where = Where.LAUNCHER
    short: str = ""
    """Its name in the dock, where languages have little room, if it is another one."""
    about: str = ""
    """What the store says of it."""
    preinstalled: bool = True
    aliases: Mapping[str, str] = field(default_factory=dict)
    """Other names by which it opens, and the part of its screen that is then shown; empty for the app as it is."""
    picked: Mapping[str, str] = field(default_factory=dict)
    """The initial parts of its screens."""
    starts: Callable[[State, np.random.Generator], Iterable[AppData]] = nothing
    """What it keeps before the first ``sense``."""
    functions: tuple[CarFunction, ...] = ()
    """Its commands as functions, besides those of the actuators."""
    turn: int = 0
    """Apps start in this order. What they draw comes from one generator, so that an app that draws takes a turn
    after all others: what these draw stays the same."""
