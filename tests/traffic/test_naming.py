"""Streets of a moved network have names that a place there could have, not their own."""

import itertools

import pytest

from automotive_cosim.scenarios import load, shipped
from automotive_cosim.traffic.naming import languages, local_names
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import read_configuration


def test_a_main_road_has_a_number_and_a_street_a_name() -> None:
    streets = [("A 5", "motorway"), ("", "residential"), ("Ring", "secondary"), ("Ring", "primary_link")]
    assert local_names([*streets, ("Am Bach", "residential"), ("Ring", "primary")], "fr") == {
        "A 5": "Motorway 1",
        "Ring": "Main road 1",
        "Am Bach": "Rue de la Gare",
    }


@pytest.mark.parametrize("language", [*languages(), "xx"])
def test_a_language_has_names_enough(language: str) -> None:
    """More than any shipped network has, all different, and neighbours in nothing alike."""
    names = list(local_names(((str(number), "residential") for number in range(400)), language).values())
    assert len(set(names)) == 400
    assert not any(char.isdigit() for name in names[:150] for char in name)
    assert all(name.isprintable() and name == name.strip() and len(name) <= 40 for name in names)
    assert all(one != other for one, other in itertools.pairwise(names))


def test_no_street_keeps_its_name() -> None:
    names = list(local_names(((str(number), "residential") for number in range(3)), "de").values())
    again = local_names([(name, "residential") for name in names], "de")
    assert set(again.values()).isdisjoint(names)


@pytest.mark.parametrize("scenario", shipped())
def test_a_moved_network_keeps_its_streets_and_none_of_their_names(scenario: str) -> None:
    network = read_network(read_configuration(load(scenario).config).net)
    moved = network.at((151.2, -33.9), "en")
    pairs = {(edge.name, moved.edges[edge_id].name) for edge_id, edge in network.edges.items()}
    own, neutral = ({pair[side] for pair in pairs} for side in (0, 1))
    assert len(pairs) == len(own) == len(neutral), "two streets were merged or one was split"
    assert own & neutral <= {""}
    assert [road.name for road in moved.map.roads] == [edge.name for edge in moved.edges.values()]
