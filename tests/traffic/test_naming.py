"""Streets of a moved network have names that do not tell where it really lies."""

from __future__ import annotations

import pytest

from automotive_cosim.scenarios import load, shipped
from automotive_cosim.traffic.naming import neutral_names
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import read_configuration


def test_a_street_is_called_by_its_highest_class() -> None:
    streets = [("A 5", "motorway"), ("", "residential"), ("Ring", "secondary"), ("Ring", "primary_link")]
    assert neutral_names([*streets, ("Am Bach", "residential"), ("Ring", "primary")]) == {
        "A 5": "Motorway 1",
        "Ring": "Main road 1",
        "Am Bach": "Street 1",
    }


@pytest.mark.parametrize("scenario", shipped())
def test_a_moved_network_keeps_its_streets_and_none_of_their_names(scenario: str) -> None:
    network = read_network(read_configuration(load(scenario).config).net)
    moved = network.at((151.2, -33.9))
    pairs = {(edge.name, moved.edges[edge_id].name) for edge_id, edge in network.edges.items()}
    own, neutral = ({pair[side] for pair in pairs} for side in (0, 1))
    assert len(pairs) == len(own) == len(neutral), "two streets were merged or one was split"
    assert own & neutral <= {""}
    assert [road.name for road in moved.map.roads] == [edge.name for edge in moved.edges.values()]
