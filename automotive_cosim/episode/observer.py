"""Watches the progress of an episode, for a live view or a record. It sees everything and changes nothing."""

from __future__ import annotations

from collections.abc import Sequence

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import RoadSnapshot
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.scenarios import Scenario


class Observer:
    """Ignores everything; override the methods of interest."""

    looks = False
    """Whether ``looked`` is to be called."""

    def loading(self, scenario: Scenario) -> None:
        """SUMO loads the scenario; its ``notes`` say what was assumed."""

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """The scenario's traffic is being warmed up, in simulated seconds."""

    def looked(self, snapshot: RoadSnapshot) -> None:
        """Every vehicle around the car, once a simulated second, before ``moved`` reports that second."""

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Another simulated second has passed: of the drive to the hand-over, of a step, or of the aftermath."""


class Observers(Observer):
    """Passes on to several; asks to look if one of them does."""

    def __init__(self, observers: Sequence[Observer]) -> None:
        """Keeps them, in the order in which they are notified."""
        self._observers = observers
        self._lookers = tuple(each for each in observers if each.looks)
        self.looks = bool(self._lookers)

    def loading(self, scenario: Scenario) -> None:
        for each in self._observers:
            each.loading(scenario)

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        for each in self._observers:
            each.warming(scenario, done_s, total_s)

    def looked(self, snapshot: RoadSnapshot) -> None:
        for each in self._lookers:
            each.looked(snapshot)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        for each in self._observers:
            each.moved(moment, cockpit)
