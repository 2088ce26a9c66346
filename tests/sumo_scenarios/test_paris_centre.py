"""Paris as drawn against Paris as it is known."""

from collections.abc import Callable
from typing import Any

import pytest

Net = Callable[[str], Any]
Metres = Callable[[tuple[float, float], tuple[float, float]], float]

CENTRES = {
    # Places with a ring of junctions: the Arc de Triomphe, the obelisk, the two squares of the 16th.
    "etoile": (2.2950, 48.8738),
    "concorde": (2.3211, 48.8655),
    "trocadero": (2.2872, 48.8630),
    "victor_hugo": (2.2858, 48.8698),
}


@pytest.mark.parametrize("place", CENTRES)
def test_places_lie_where_paris_has_them(place: str, net: Net, metres: Metres) -> None:
    paris = net("paris_centre")
    (ring,) = [r for r in paris.getRoundabouts() if all(n.startswith(f"{place}_") for n in r.getNodes())]
    corners = [paris.convertXY2LonLat(*paris.getNode(node).getCoord()) for node in ring.getNodes()]
    centre = (sum(c[0] for c in corners) / len(corners), sum(c[1] for c in corners) / len(corners))
    assert metres(CENTRES[place], centre) < 150


def test_the_size_of_it(net: Net) -> None:
    junctions = [
        node for node in net("paris_centre").getNodes() if len(node.getIncoming()) + len(node.getOutgoing()) > 2
    ]
    assert len(junctions) >= 100
    assert sum(node.getType() == "traffic_light" for node in junctions) >= 60
    assert len({edge.getName() for edge in net("paris_centre").getEdges()}) >= 100


def test_twelve_avenues_leave_the_etoile(net: Net) -> None:
    nodes = {f"etoile_{i}" for i in (
        "wagram", "hoche", "friedland", "champs_elysees", "marceau", "iena", "kleber", "victor_hugo", "foch",
        "grande_armee", "carnot", "mac_mahon",
    )}  # fmt: skip
    names = {e.getName() for node in nodes for e in net("paris_centre").getNode(node).getOutgoing()}
    assert len(names - {"Place Charles-de-Gaulle"}) == 12


def test_tunnels_both_ways_under_the_alma(net: Net) -> None:
    tunnels = [edge for edge in net("paris_centre").getEdges() if edge.getParam("tunnel") == "yes"]
    assert {"Tunnel de l'Alma", "Tunnel des Invalides"} <= {edge.getName() for edge in tunnels}
    alma = [edge for edge in tunnels if edge.getName() == "Tunnel de l'Alma"]
    assert len(alma) == 2
    assert all(150 < edge.getLength() < 300 for edge in alma)


@pytest.mark.parametrize("edges", [["foch.0"], [f"periph_ext.{i}" for i in range(9)], ["pompidou_ouest.1"]])
def test_axes_without_a_signal(edges: list[str], net: Net) -> None:
    pieces = [net("paris_centre").getEdge(edge) for edge in edges]
    assert sum(edge.getLength() for edge in pieces) >= 600
    assert all(edge.getToNode().getType() != "traffic_light" for edge in pieces[:-1])
    assert all(edge.getParam("maxspeed") == "50" for edge in pieces)


def test_a_hurried_driver_holds_80_on_the_avenue_foch(held_s: Callable[..., float]) -> None:
    """In other traffic than ``tasks validate`` has, which finds 80 in a 50 there with its seeds."""
    drive = dict(factor=1.6, speed_kmh=78.0, limit_kmh=50.0, within_s=240.0)
    assert held_s("paris_centre", "foch", seed=159, **drive) >= 15


@pytest.mark.parametrize("seed", [3, 14, 159])
def test_an_average_driver_holds_80_on_the_plain_of_beauce(seed: int, held_s: Callable[..., float]) -> None:
    drive = dict(factor=1.0, speed_kmh=76.0, limit_kmh=80.0, within_s=240.0)
    assert held_s("beauce", "plain", seed=seed, **drive) >= 60


@pytest.mark.parametrize("street", ["Quai du Louvre", "Rue de Rivoli"])
def test_the_quays_and_rivoli_jam_while_foch_runs(street: str, net: Net, hour: Callable[[str], Any]) -> None:
    paris, speed = net("paris_centre"), hour("paris_centre").speed_mps

    def slowest(name: str) -> float:
        edges = [e for e in paris.getEdges() if e.getName() == name and e.getID() in speed]
        return min(speed[e.getID()] / e.getSpeed() for e in edges)

    assert slowest(street) < 0.4
    assert slowest("Boulevard Périphérique Extérieur") > 0.7
