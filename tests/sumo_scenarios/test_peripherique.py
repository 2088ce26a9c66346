"""The périphérique as drawn against the périphérique as it is known."""

from collections.abc import Callable
from typing import Any

import pytest

from automotive_cosim.geo.place import Atlas

Net = Callable[[str], Any]
Rides = Callable[[str], Any]


def peripherique(net: Net) -> list[Any]:
    return [e for e in net("peripherique").getEdges() if e.getName().startswith("Boulevard Périphérique")]


def test_all_of_it_lies_in_paris_and_its_low_emission_zone(net: Net) -> None:
    atlas, drawn = Atlas(), net("peripherique")
    for edge in peripherique(net):
        rules = [rule.id for rule in atlas.place(*drawn.convertXY2LonLat(*edge.getShape()[0])).layers[0].rules]
        assert "FR-paris.low_emission" in rules, edge.getID()


def test_each_carriageway_has_both_tunnels_and_four_gates(net: Net) -> None:
    for name in ("Boulevard Périphérique Extérieur", "Boulevard Périphérique Intérieur"):
        edges = [edge for edge in peripherique(net) if edge.getName() == name]
        tunnels = sorted(edge.getLength() for edge in edges if edge.getParam("tunnel") == "yes")
        assert tunnels == pytest.approx([290, 580], abs=15)
        beside = {e.getName() for edge in edges for e in (*edge.getIncoming(), *edge.getOutgoing())}
        assert sum(n.startswith("Accès") for n in beside) == sum(n.startswith("Sortie") for n in beside) == 4


def test_thirty_is_the_limit_of_the_streets_beside_it(net: Net) -> None:
    names = {e.getName() for e in net("peripherique").getEdges() if e.getParam("maxspeed") == "30"}
    assert len(names) >= 20


@pytest.mark.parametrize(("trip", "carriageway"), [("south", "periph_ext"), ("north", "periph_int")])
def test_the_ego_drives_kilometres_at_50_through_both_tunnels(
    trip: str, carriageway: str, net: Net, rides: Rides
) -> None:
    ride = rides("peripherique")[trip]
    tunnels = {e.getID() for e in peripherique(net) if e.getParam("tunnel") == "yes"}
    assert len(tunnels & set(ride.edges)) == 2
    on_it = [v for e, v in zip(ride.edges, ride.speed_mps, strict=True) if e.startswith(carriageway)]
    assert sum(on_it) > 3500
    assert sum(on_it) / len(on_it) > 40 / 3.6


def test_the_ego_enters_twice(rides: Rides) -> None:
    ride = rides("peripherique")["off_and_on"]
    assert ride.seconds_on("auteuil_ext_in.0") > 0 < ride.seconds_on("saint_cloud_ext_in.0")
