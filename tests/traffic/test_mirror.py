"""The mirror image of a network drives as the network does, on the other side."""

from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import DrivingState
from automotive_cosim.scenarios import Scenario, load, shipped
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.mirror import mirrored, write_mirrored
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import read_configuration
from tests.laws import over

DRIVEN_S = 30.0


@over(shipped())
def test_the_image_of_the_file_is_the_image_of_the_network(
    name: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    net = read_configuration(load(name).config).net
    folder = tmp_path_factory.mktemp(name)
    original, once, twice = read_network(net), folder / "once.net.xml", folder / "twice.net.xml"
    write_mirrored(net, once, mirrored(original).map)
    image = read_network(once)
    assert image.map.left_hand != original.map.left_hand
    expected = mirrored(original)
    assert image.edges == expected.edges
    assert image.crossings == original.crossings
    assert (image.map.bounds_m, image.map.roads) == (expected.map.bounds_m, expected.map.roads)
    assert mirrored(expected) == original
    write_mirrored(once, twice, original.map)
    assert read_network(twice) == original


def test_what_lies_to_the_right_lies_to_the_left(tmp_path: Path) -> None:
    net = tmp_path / "a.net.xml"
    net.write_text(
        '<net version="1.20"><location netOffset="0,0" convBoundary="0,0,100,40" projParameter="!"/>'
        '<edge id="a" from="j" to="k">'
        '<lane id="a_0" index="0" speed="10" length="100" shape="0,38.4,5 100,38.4,5"/></edge>'
        '<junction id="k" type="right_before_left" x="100" y="40" shape="100,36.8 100,40"/>'
        '<connection from="a" to="a" fromLane="0" toLane="0" dir="r"/></net>'
    )
    write_mirrored(net, tmp_path / "b.net.xml", mirrored(read_network(net)).map)
    text = (tmp_path / "b.net.xml").read_text()
    assert 'lefthand="true"' in text
    assert 'shape="0,1.60,5 100,1.60,5"' in text
    assert 'type="left_before_right"' in text
    assert 'y="0.00" shape="100,3.20 100,0.00"' in text
    assert 'dir="l"' in text


def _drive(simulations: Simulations, scenario: Scenario) -> tuple[list[DrivingState], bool]:
    traffic = simulations.warm(scenario, 5).depart(EgoPlan(scenario.ego.trips[0], seed=5))
    states = [traffic.state]
    while states[-1].end is None and states[-1].time_s < states[0].time_s + DRIVEN_S:
        traffic.advance(1.0)
        states.append(traffic.state)
    traffic.close()
    return states, traffic.network.left_hand


@pytest.mark.parametrize("name", ["autobahn", "sydney"])
def test_the_same_drive_on_the_other_side(simulations: Simulations, name: str) -> None:
    """Speeds, lanes, distances and the car ahead are equal to the digit."""
    home = scenarios.load(name)
    home = replace(home, sumo=replace(home.sumo, warm_up_s=60.0))
    (here, left), (there, other_left) = (
        _drive(simulations, scenario) for scenario in (home, replace(home, mirrored=True))
    )
    assert left != other_left
    _, south_m, _, north_m = read_network(read_configuration(home.config).net).map.bounds_m
    assert len(here) == len(there)
    for one, image in zip(here, there, strict=True):
        assert (one.speed_mps, one.distance_m, one.road) == (image.speed_mps, image.distance_m, image.road)
        assert (one.ahead, one.around.leader) == (image.ahead, image.around.leader)
        assert one.vehicle_count == image.vehicle_count
        assert (one.x_m, one.y_m) == pytest.approx((image.x_m, south_m + north_m - image.y_m), abs=1e-6)
        assert (one.heading_deg + image.heading_deg) % 360 == pytest.approx(180.0, abs=1e-6)
