"""The streets of a network and the ids of their edges, by which incidents, interventions and trips name a place."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.traffic.network import Edge, read_network
from automotive_cosim.traffic.options import read_configuration


@dataclass(frozen=True, slots=True)
class StreetEdges:
    """A street and its edges, in the order of the file; the edges without a name are one of an empty name."""

    name: str
    edges: tuple[Edge, ...]

    @property
    def length_m(self) -> float:
        """Of all its edges together, both directions."""
        return sum(edge.length_m for edge in self.edges)


def streets(scenario: Scenario) -> list[StreetEdges]:
    """The streets that are open to cars, the longest first, and at last the edges without a name.

    Raises ScenarioError: the network cannot be read."""
    found: dict[str, list[Edge]] = {}
    for edge in read_network(read_configuration(scenario.config).net).edges.values():
        found.setdefault(edge.name, []).append(edge)
    made = [StreetEdges(name, tuple(edges)) for name, edges in found.items()]
    return sorted(made, key=lambda street: (not street.name, -street.length_m, street.name))
