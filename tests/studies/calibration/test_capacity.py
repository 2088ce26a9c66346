"""What roads and signals carry, by hand."""

from pathlib import Path

import pytest

from automotive_cosim.studies.calibration.capacity import LANE_PER_H, YIELDING_PER_H, read_capacity

NET = """<net>
  <edge id=":j_0" function="internal"><lane id=":j_0_0" index="0"/></edge>
  <edge id="in"><lane id="in_0" index="0"/><lane id="in_1" index="1"/></edge>
  <edge id="side"><lane id="side_0" index="0"/></edge>
  <edge id="out"><lane id="out_0" index="0"/></edge>
  <edge id="left"><lane id="left_0" index="0"/></edge>
  <tlLogic id="j" type="static" programID="0" offset="0">
    <phase duration="30" state="Gr"/><phase duration="6" state="yr"/><phase duration="54" state="rg"/>
  </tlLogic>
  <connection from="in" to="out" fromLane="0" toLane="0" tl="j" linkIndex="0" state="O"/>
  <connection from="in" to="left" fromLane="1" toLane="0" tl="j" linkIndex="1" state="o"/>
  <connection from="side" to="out" fromLane="0" toLane="0" state="m"/>
  <connection from=":j_0" to="out" fromLane="0" toLane="0" state="M"/>
</net>"""


def test_a_signal_serves_its_green_share_and_who_yields_less(tmp_path: Path) -> None:
    path = tmp_path / "a.net.xml"
    path.write_text(NET)
    found = read_capacity(path)
    assert found.turns["in", "out"] == pytest.approx(LANE_PER_H * 30 / 90)
    assert found.turns["in", "left"] == pytest.approx(YIELDING_PER_H * 54 / 90)
    assert found.turns["side", "out"] == YIELDING_PER_H
    assert found.edges["in"] == pytest.approx(LANE_PER_H / 3 + YIELDING_PER_H * 0.6)
    assert found.edges["out"] == LANE_PER_H, "it ends at the border"
    assert ":j_0" not in found.edges
    assert len(found.turns) == 3


def test_a_program_of_an_additional_file_replaces_the_networks(tmp_path: Path) -> None:
    path, other = tmp_path / "a.net.xml", tmp_path / "b.add.xml"
    path.write_text(NET)
    other.write_text(
        '<additional><tlLogic id="j" type="static" programID="1"><phase duration="60" state="GG"/></tlLogic>'
        "</additional>"
    )
    assert read_capacity(path, [other]).turns["in", "out"] == LANE_PER_H
    other.write_text(
        '<additional><tlLogic id="j" type="actuated" programID="1"><phase duration="5" state="rr"/></tlLogic>'
        "</additional>"
    )
    assert read_capacity(path, [other]).turns["in", "out"] == LANE_PER_H, "its green time is not fixed"
