"""Lanes that part the lanes for cars are opened where cars would be trapped, and nowhere else."""

import xml.etree.ElementTree as ET

import pytest

from automotive_cosim.osm.links import read_links
from automotive_cosim.osm.repair import SHORT_M, open_traps

BUS, CAR = 'allow="bus taxi"', 'disallow="tram rail"'


def net(length_m: float, *, sorted_before: bool = False, lanes: tuple[str, ...] = (CAR, BUS, CAR)) -> str:
    """One lane leads into an edge whose lanes lead straight and right; with ``sorted_before``, into both sides."""
    rows = "".join(
        f'<lane id="mid_{index}" index="{index}" {kind} speed="13.89" length="{length_m}" shape="0,0 1,0"/>'
        for index, kind in enumerate(lanes)
    )
    last = len(lanes) - 1
    both = f'<connection from="in" to="mid" fromLane="0" toLane="{last}" via=":a_1_0" dir="s" state="M"/>'
    inner = 'speed="9" length="2" shape="0,0 1,0"'
    return f"""<net version="1.20">
    <edge id=":a_0" function="internal"><lane id=":a_0_0" index="0" {inner}/></edge>
    <edge id=":b_1" function="internal"><lane id=":b_1_0" index="0" {BUS} {inner}/></edge>
    <edge id="in" from="x" to="a"><lane id="in_0" index="0" speed="13.89" length="90" shape="0,0 1,0"/></edge>
    <edge id="mid" from="a" to="b">{rows}</edge>
    <edge id="right" from="b" to="y"><lane id="right_0" index="0" speed="13.89" length="90" shape="0,0 1,0"/></edge>
    <edge id="straight" from="b" to="z">
        <lane id="straight_0" index="0" {BUS} speed="13.89" length="90" shape="0,0 1,0"/>
        <lane id="straight_1" index="1" speed="13.89" length="90" shape="0,0 1,0"/></edge>
    <connection from="in" to="mid" fromLane="0" toLane="0" via=":a_0_0" dir="s" state="M"/>
    {both if sorted_before else ""}
    <connection from="mid" to="right" fromLane="0" toLane="0" dir="r" state="M"/>
    <connection from="mid" to="straight" fromLane="1" toLane="0" via=":b_1_0" dir="s" state="M"/>
    <connection from="mid" to="straight" fromLane="{last}" toLane="1" dir="s" state="M"/>
</net>"""


def allowed(text: str) -> dict[str, str | None]:
    return {lane.attrib["id"]: lane.get("allow") for lane in ET.fromstring(text).iter("lane")}


@pytest.mark.parametrize("length_m", [6.0, SHORT_M - 1, 200.0])
def test_a_car_that_comes_in_on_one_side_only_is_let_across(length_m: float) -> None:
    text, opened = open_traps(net(length_m), read_links(net(length_m)))
    assert opened == ("mid",)
    assert allowed(text)["mid_1"] == "bus taxi passenger"
    assert allowed(text)[":b_1_0"] == "bus taxi", "it leads into a lane of the buses"
    assert allowed(text)["straight_0"] == "bus taxi", "the lane beside the others stays the buses'"


def test_a_long_edge_whose_sides_are_chosen_before_keeps_its_bus_lane() -> None:
    text = net(200.0, sorted_before=True)
    assert open_traps(text, read_links(text)) == (text, ())


@pytest.mark.parametrize("lanes", [(BUS, CAR, CAR), (CAR, CAR, BUS), (CAR, CAR)])
def test_a_lane_at_the_side_parts_nothing(lanes: tuple[str, ...]) -> None:
    text = net(6.0, lanes=lanes)
    assert open_traps(text, read_links(text)) == (text, ())
