"""Who chooses the routes of the advised drivers of ``study days``, overnight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

from automotive_cosim.agents.guest import FAULTS, aside, own_class, told
from automotive_cosim.errors import UserError
from automotive_cosim.studies.equilibrium.gap import NOTICED_S, DrivenTrip, EdgeTimes
from automotive_cosim.traffic.network import Network

Routes = Mapping[str, Sequence[str]]
"""Trip -> edges from its first to its last."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvisedDay:
    """What an adviser knows when a day is over."""

    number: int
    """0 for the day on which everybody drives as on an empty road."""
    trips: tuple[DrivenTrip, ...]
    """The trips of advised drivers that arrived: their edges, and when they left each."""
    memory: EdgeTimes
    """Times of edges as they are remembered, by the study's ``memory`` and ``lag``."""
    quickest: Mapping[str, tuple[str, ...]]
    """The route of each trip that is quickest by the memory; without those that have no other route."""


class Adviser(Protocol):
    """Chooses routes; one is made for every share and seed, with the seed as its only argument."""

    def advise(self, day: AdvisedDay) -> Routes:
        """Routes for the next day; a trip without one keeps its own. Not every driver follows (``compliance``)."""
        ...


class Quickest:
    """Advises the route that is quickest by the memory, if that is noticed."""

    def advise(self, day: AdvisedDay) -> Routes:
        known = day.memory
        return {
            trip.id: way
            for trip in day.trips
            if (way := day.quickest.get(trip.id))
            and known.of(trip.edges, trip.exits_s[0]) - known.of(way, trip.exits_s[0]) >= NOTICED_S
        }


class OwnAdviser:
    """A class of the user's behind this protocol; its faults are reported in a line."""

    def __init__(self, spec: str, seed: int, network: Network) -> None:
        """Makes it.

        Args:
            spec: ``package.module:Class``.
            seed: what it is made with.
            network: on which its routes have to lead from edge to edge.

        Raises:
            UserError: there is no such class, it lacks ``advise(day)``, or it raised.
        """
        self._spec, self._network = spec, network
        made = own_class(spec, "adviser")
        if not callable(getattr(made, "advise", None)):
            raise UserError(f"adviser {spec!r} lacks advise(day); an adviser is a class with it")
        try:
            with aside():
                self._adviser: Adviser = made(seed)
        except FAULTS as error:
            raise UserError(f"adviser {spec!r}: {made.__name__}(seed) raised {told(error)}") from error

    def advise(self, day: AdvisedDay) -> dict[str, tuple[str, ...]]:
        """The routes that it chose, without those that the trips have already.

        Raises:
            UserError: it raised, or a route is not one.
        """
        try:
            with aside():
                advised = self._adviser.advise(day)
            chosen = {str(name): tuple(map(str, way)) for name, way in advised.items()}
        except FAULTS as error:
            raise UserError(f"adviser {self._spec!r} raised {told(error)} in advise") from error
        trips = {trip.id: trip.edges for trip in day.trips}
        for name, way in chosen.items():
            if name not in trips:
                raise UserError(f"adviser {self._spec!r} gave a route to {name!r}, which is no trip of day.trips")
            self._check(name, trips[name], way)
        return {name: way for name, way in chosen.items() if way != trips[name]}

    def _check(self, name: str, own: Sequence[str], way: Sequence[str]) -> None:
        wrong = ""
        if not way or (way[0], way[-1]) != (own[0], own[-1]):
            wrong = f"does not lead from {own[0]!r} to {own[-1]!r}"
        for here, there in pairwise(way):
            if there not in self._network.crossings.get(here, {}):
                wrong = f"has no way from {here!r} to {there!r}"
        if wrong:
            raise UserError(f"adviser {self._spec!r}: the route of trip {name!r} {wrong}")
