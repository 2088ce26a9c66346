import xml.etree.ElementTree as ET
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.formats.files import opened
from automotive_cosim.osm import demand, trips
from automotive_cosim.osm.demand import connected
from automotive_cosim.traffic.network import read_network


def built(*turns: str) -> Any:
    """A network of edges a, b, c, ... and the turns between them."""
    names = sorted({name for turn in turns for name in turn})
    crossings = {name: {turn[1]: None for turn in turns if turn[0] == name} for name in names}
    edges = [SimpleNamespace(edge_id=name) for name in names]
    network = SimpleNamespace(crossings=crossings)
    network.open_at_all_hours = lambda: network
    return SimpleNamespace(edges=edges, network=network)


@pytest.mark.parametrize(
    ("turns", "reached", "reaching"),
    [
        (("ab", "bc", "ca"), "abc", "abc"),
        (("ab", "bc", "cb", "cd"), "bcd", "abc"),
        (("ab", "ba", "cd", "dc", "de", "ec"), "cde", "cde"),
        (("ab", "ba", "bc", "cd", "dc", "de", "ec"), "cde", "abcde"),
    ],
)
def test_trips_run_between_roads_that_reach_each_other(turns: tuple[str, ...], reached: str, reaching: str) -> None:
    network = built(*turns)
    found = ["".join(edge.edge_id for edge in np.array(network.edges)[mask]) for mask in connected(network)]
    assert found == [reached, reaching]


@pytest.mark.parametrize(
    ("text", "slug"),
    [
        ("Lise-Meitner-Straße", "lise-meitner-straße"),
        ("Rue de l'Église", "rue-de-l-église"),
        ("新宿通り", "新宿通り"),
        ("A 5", "a-5"),
        (" - ", ""),
    ],
)
def test_names_keep_their_letters(text: str, slug: str) -> None:
    assert trips.slug(text) == slug


def test_every_trip_of_a_map_can_be_driven(imported: tuple[Any, Any], tmp_path: Any) -> None:
    """By SUMO's own router, although only a sample was routed when they were drawn."""
    folder, _ = imported
    network = read_network(net := next(folder.glob("*.net.xml.gz")))
    with opened(next(folder.glob("*.trips.xml.gz"))) as file:
        drawn = [(trip.get("from", ""), trip.get("to", "")) for trip in ET.parse(file).iter("trip")]
    ends = [(network.edges[start], network.edges[goal]) for start, goal in drawn]
    assert len(ends) > 50
    assert all(demand.fastest_ways(ends, network, net, tmp_path))
