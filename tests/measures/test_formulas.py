"""Surrogate measures of safety by plans whose outcome is known, and beside SUMO's SSM device."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from automotive_cosim.measures.formulas import (
    crossing_time_to_collision_s,
    drac_mps2,
    mdrac_mps2,
    time_exposed,
    time_to_collision_s,
)
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.sumo import load_library, start


@pytest.mark.parametrize(
    ("gap_m", "ttc_s", "drac", "mdrac"), [(99.0, 9.9, 0.505, 0.562), (39.0, 3.9, 1.282, 1.724)]
)
def test_twenty_behind_ten_metres_per_second(gap_m: float, ttc_s: float, drac: float, mdrac: float) -> None:
    """The figures are those of SUMO's SSM device."""
    assert time_to_collision_s(gap_m, 10.0) == pytest.approx(ttc_s)
    assert drac_mps2(gap_m, 10.0) == pytest.approx(drac, abs=5e-4)
    assert mdrac_mps2(gap_m, 10.0) == pytest.approx(mdrac, abs=5e-4)


@pytest.mark.sumo
def test_following_is_measured_as_by_the_ssm_device(tmp_path: Path) -> None:
    """The least TTC, the largest DRAC and MDRAC of an approach, from the states beside the device."""
    (tmp_path / "r.nod.xml").write_text('<nodes><node id="a" x="0" y="0"/><node id="b" x="2000" y="0"/></nodes>')
    (tmp_path / "r.edg.xml").write_text('<edges><edge id="ab" from="a" to="b" numLanes="1" speed="30"/></edges>')
    files = ("-n", tmp_path / "r.nod.xml", "-e", tmp_path / "r.edg.xml", "-o", tmp_path / "r.net.xml")
    built, printed = sumo_programs.run("netconvert", files)
    assert built, printed
    device = {
        "has.ssm.device": "true",
        "device.ssm.measures": "TTC DRAC MDRAC",
        "device.ssm.thresholds": "30 0.1 0.1",
        "device.ssm.range": "300",
        "device.ssm.mdrac.prt": "1",
        "device.ssm.file": str(tmp_path / "ssm.xml"),
    }
    given = "".join(f'<param key="{key}" value="{value}"/>' for key, value in device.items())
    (tmp_path / "r.rou.xml").write_text(
        '<routes><vType id="t" speedFactor="1" speedDev="0" sigma="0"/><route id="r" edges="ab"/>'
        '<vehicle id="lead" type="t" route="r" depart="0" departPos="200" departSpeed="10"/>'
        f'<vehicle id="back" type="t" route="r" depart="0" departPos="96" departSpeed="20">{given}</vehicle>'
        "</routes>"
    )
    sumo = load_library()
    start(
        sumo,
        [
            *("sumo", "-n", str(tmp_path / "r.net.xml"), "-r", str(tmp_path / "r.rou.xml")),
            *("--step-length", "0.1", "--no-step-log", "--no-warnings"),
        ],
    )
    try:
        sumo.step()
        for vehicle, speed_mps in (("lead", 10.0), ("back", 20.0)):
            sumo.vehicle.setSpeedMode(vehicle, 0)
            sumo.vehicle.setSpeed(vehicle, speed_mps)
        pairs = []
        for step in range(90):
            sumo.step()
            gap_m = sumo.lane_position("lead") - sumo.length("lead") - sumo.lane_position("back")
            pairs.append((gap_m, sumo.speed("back") - sumo.speed("lead")))
            if step == 60:
                sumo.vehicle.setSpeed("back", 10.0)
        sumo.vehicle.remove("back")
        sumo.step()
    finally:
        sumo.close()
    (conflict,) = ElementTree.parse(tmp_path / "ssm.xml").getroot()
    measured = {child.tag: float(child.attrib["value"]) for child in conflict}
    reckoned = {
        "minTTC": min(filter(None, (time_to_collision_s(*pair) for pair in pairs))),
        "maxDRAC": max(filter(None, (drac_mps2(*pair) for pair in pairs))),
        "maxMDRAC": max(filter(None, (mdrac_mps2(*pair) for pair in pairs))),
    }
    assert reckoned == pytest.approx(measured, abs=0.006)


def test_without_closing_or_time_to_react_there_is_none() -> None:
    assert time_to_collision_s(10.0, 0.0) is drac_mps2(10.0, -1.0) is mdrac_mps2(10.0, 0.0) is None
    assert mdrac_mps2(10.0, 10.0) is None
    assert drac_mps2(0.0, 10.0) is None


def test_constant_closing_exposes_for_the_time_below_the_threshold() -> None:
    step_s, threshold_s, nearest_s = 0.001, 3.0, 0.5
    steps = [(i * step_s, 5.0 - i * step_s) for i in range(round((5.0 - nearest_s) / step_s) + 1)]
    tet_s, tit_s2 = time_exposed(steps, threshold_s)
    assert tet_s == pytest.approx(threshold_s - nearest_s, abs=2 * step_s)
    assert tit_s2 == pytest.approx((threshold_s - nearest_s) ** 2 / 2, abs=0.01)
    assert time_exposed([(0.0, None), (1.0, 9.0)], threshold_s) == (0.0, 0.0)


def test_a_crossing_collides_if_the_first_is_still_there() -> None:
    assert crossing_time_to_collision_s((5.0, 5.0), (12.0, 10.0), 5.0) == pytest.approx(1.2)
    assert crossing_time_to_collision_s((5.0, 10.0), (12.0, 10.0), 5.0) is None
    assert crossing_time_to_collision_s((5.0, 0.0), (12.0, 10.0), 5.0) is None
