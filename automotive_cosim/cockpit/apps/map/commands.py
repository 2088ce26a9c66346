"""Commands and messages of the map: where to, by which way, and how it is looked at."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

from automotive_cosim.cockpit.apps.map.scene import panned
from automotive_cosim.cockpit.apps.map.state import Navigation, Viewpoint
from automotive_cosim.cockpit.map import ZOOMS_M_PER_PX
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.road import Ask
from automotive_cosim.cockpit.state import Command, CommandRecord, Message, State
from automotive_cosim.contracts import Feedback, Reroute
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class Guide(Command):
    """Request a route to a place or street; empty keeps the destination and looks for a faster route."""

    place: str
    onward: str = ""
    """The next destination afterwards."""

    def aims(self, state: State) -> frozenset[str]:
        """The destinations, or the request as such."""
        named = (("navigation.destination", self.place), ("navigation.onward", self.onward))
        return frozenset(key for key, name in named if name) or frozenset({"requests"})

    def perform(self, state: State) -> Feedback:
        """The request, and the destination after it."""
        place, onward = self.place, self.onward
        known = state.of(Gazetteer).find(place)
        feedback = Ask(Reroute(known.edge_id if known else place)).perform(state)
        if place and onward and onward != place:
            state.keep(replace(state.of(Navigation), onward=onward))
        return feedback

    def repeat(self, state: State, record: CommandRecord, keys: Collection[str]) -> None:
        """Only if both destinations are among the keys, so that none is slipped in."""
        if record.aims <= frozenset(keys):
            state.perform(self)


@dataclass(frozen=True, slots=True)
class Take(Command):
    """Request a route along these edges to the same destination."""

    edges: tuple[str, ...]

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"requests"})

    def perform(self, state: State) -> Feedback:
        return Ask(Reroute(edges=self.edges)).perform(state)


@dataclass(frozen=True, slots=True)
class Zoom(Message):
    """Move the map closer (negative) or away."""

    by: int

    def perform(self, state: State) -> Feedback:
        """The next scale, up to the last."""
        view = state.of(Viewpoint)
        zoom = min(len(ZOOMS_M_PER_PX) - 1, max(0, view.zoom + self.by))
        return state.change(replace(view, zoom=zoom), say("The map is zoomed"))


@dataclass(frozen=True, slots=True)
class Pan(Message):
    """Pan the map by a number of logical pixels."""

    right: float
    down: float

    def perform(self, state: State) -> Feedback:
        point = panned(state, self.right, self.down)
        return state.change(replace(state.of(Viewpoint), panned=point), say("The map is moved"))


@dataclass(frozen=True, slots=True)
class Follow(Message):
    """Let the map follow the car, turning with it or with north up."""

    north_up: bool

    def perform(self, state: State) -> Feedback:
        """The car in the middle again; once it is there, the way up."""
        view = state.of(Viewpoint)
        if view.panned is not None:
            return state.change(replace(view, panned=None), say("Map follows the car"))
        said = say("North up") if self.north_up else say("Heading up")
        return state.change(replace(view, north_up=self.north_up), said)
