"""A car where one drives on the left: the driver sits on the right."""

from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.map.state import turns
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.map import road_map
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Element, Road, RoadNetwork, Surroundings
from tests.cockpit.fingers import find


@pytest.fixture
def british(network: RoadNetwork, around: Surroundings) -> Cockpit:
    cockpit = Cockpit(replace(network, left_hand=True), rng=np.random.default_rng(1))
    cockpit.sense(around, 0.0)
    return cockpit


def box(cockpit: Cockpit, key: str) -> tuple[int, int]:
    found = find(cockpit, key).bbox_pixels
    return found.x_min, found.x_max


@pytest.mark.parametrize(("screen", "app"), [("dock", "home"), ("hvac", "climate")])
def test_what_is_the_drivers_lies_on_the_drivers_side(
    cockpit: Cockpit, british: Cockpit, screen: str, app: str
) -> None:
    for car in (cockpit, british):
        car.visit(app)
    mine, hers = (f"{screen}.{who}_temperature.increase" for who in ("driver", "passenger"))
    assert box(cockpit, mine) < box(cockpit, hers)
    assert box(british, mine) > box(british, hers)
    assert box(british, mine) == box(cockpit, hers)


def test_the_elements_are_the_same_in_the_same_order(cockpit: Cockpit, british: Cockpit) -> None:
    def names(elements: tuple[Element, ...]) -> list[str]:
        return [element.resource_id for element in elements if element.resource_id]

    assert names(british.elements()) == names(cockpit.elements())


def test_one_turns_round_towards_the_middle_of_the_road(network: RoadNetwork) -> None:
    there = next(road for road in network.roads if road.edge_id == "e0_0")
    back: Road = replace(there, edge_id="back", shape_m=there.shape_m[::-1], name="Back")
    for left_hand, icon in ((False, Icon.TURN_BACK), (True, Icon.TURN_BACK_RIGHT)):
        roads = road_map(replace(network, roads=(there, back), left_hand=left_hand))
        assert turns(roads, ("e0_0", "back"))[0].icon is icon
