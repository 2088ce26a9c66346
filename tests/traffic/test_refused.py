"""Scenarios that cannot be driven are refused in a line, and none is written to."""

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.errors import NoRoomError, ScenarioError, UnknownNameError
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.sumo import load_library
from tests.traffic.in_process import InProcess

pytestmark = pytest.mark.sumo

Variant = Callable[[Callable[[Path], None]], Scenario]


def edit(name: str, old: str, new: str) -> Callable[[Path], None]:
    def change(folder: Path) -> None:
        path = folder / name
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new), encoding="utf-8")

    return change


def cut(folder: Path) -> None:
    path = folder / "grid.net.xml"
    path.write_bytes(path.read_bytes()[:40_000])


LOST_CAR = '<vehicle id="x" depart="1"><route edges="cwc0 n3n4"/></vehicle>'


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda folder: (folder / "grid.rou.xml").unlink(), r"route-files .*grid\.rou\.xml"),
        (lambda folder: (folder / "grid.net.xml").unlink(), r"net-file .*grid\.net\.xml"),
        (lambda folder: (folder / "grid.net.xml").write_text("a map"), "not a complete SUMO network"),
        (lambda folder: (folder / "grid.net.xml").write_text("<routes/>"), "its root is <routes>"),
        (lambda folder: (folder / "grid.net.xml").write_text("<net/>"), "no road"),
        (lambda folder: (folder / "grid.sumocfg").write_text("<configuration/>"), "names no net-file"),
        (lambda folder: (folder / "grid.sumocfg").write_text("net"), "not a SUMO configuration|is not XML"),
        (cut, "not a complete SUMO network"),
        (edit("grid.rou.xml", 'from="cwc0"', 'from="cwc9"'), "cwc9"),
        (
            edit(
                "grid.rou.xml",
                "</routes>",
                '<vehicle id="x" depart="1"><route edges="cwc0 n3n4"/>'
                '<param key="has.rerouting.device" value="false"/></vehicle></routes>',
            ),
            "vehicle 'x' sets out at 1.1 s, but its class cannot drive its route 'cwc0 n3n4'",
        ),
        (edit("grid.sumocfg", "<processing>", '<processing><no-such-option value="1"/>'), "no-such-option"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_broken_scenario_is_refused_in_one_line(
    variant: Variant, change: Callable[[Path], None], said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    load_library()  # which may warn
    capfd.readouterr()
    scenario = variant(change)
    texts = []
    for make in (Forked, InProcess):
        with pytest.raises(ScenarioError, match=said) as caught:
            make(scenario)
        texts.append(str(caught.value))
    assert texts[0] == texts[1]
    assert "\n" not in texts[0]
    assert capfd.readouterr() == ("", "")


def test_a_network_without_projection_is_refused_unless_asked_for(variant: Variant, hurried: EgoPlan) -> None:
    scenario = variant(edit("grid.net.xml", 'projParameter="+proj=utm', 'projParameter="!" was="+proj=utm'))
    with pytest.raises(ScenarioError, match="no projection"):
        Forked(scenario, seed=1)
    simulation = Forked(scenario, seed=1, allow_unprojected=True)
    traffic = simulation.depart(hurried)
    assert traffic.network.projection is None
    states = traffic.advance(5.0).states
    assert all(state.lon_deg is None and state.lat_deg is None for state in states)
    assert states[-1].distance_m > 0
    traffic.close()
    simulation.close()


def test_a_trip_that_cannot_be_driven_is_refused(forked: Forked, hurried: EgoPlan, variant: Variant) -> None:
    with pytest.raises(ScenarioError, match=r"no edge 'cwc00'.*did you mean 'cwc0'"):
        forked.depart(replace(hurried, trip=replace(hurried.trip, from_edge="cwc00")))
    with pytest.raises(UnknownNameError, match="hurried"):
        forked.depart(replace(hurried, driver="hurry"))

    def close_the_east(folder: Path) -> None:
        path = folder / "grid.net.xml"
        lanes = ('<lane id="cec4_0"', '<lane id="cec4_1"')
        text = path.read_text()
        for lane in lanes:
            assert lane in text
            text = text.replace(lane, f'{lane} allow="bus"')
        path.write_text(text)
        (folder / "grid.rou.xml").write_text("<routes/>")

    simulation = Forked(variant(close_the_east))
    with pytest.raises(ScenarioError, match="no route for a car leads from 'c4ce' to 'cwc0'"):
        simulation.depart(replace(hurried, trip=replace(hurried.trip, from_edge="c4ce", to_edge="cwc0")))
    simulation.close()


def test_an_ego_that_finds_no_gap_has_an_error_of_its_own(variant: Variant, hurried: EgoPlan) -> None:
    """The same from this process and from another."""

    def fill(folder: Path) -> None:
        """A queue that never moves stands on the ego's first edge, end to end."""
        stop = '<stop lane="cwc0_{lane}" endPos="{end}" duration="100000"/>'
        cars = "".join(
            f'<vehicle id="v{lane}.{place}" depart="0" departLane="{lane}" departPos="{place}" departSpeed="0">'
            f'<route edges="cwc0"/>{stop.format(lane=lane, end=place)}</vehicle>'
            for lane in (0, 1)
            for place in range(6, 290, 7)
        )
        (folder / "grid.rou.xml").write_text(f"<routes>{cars}</routes>")
        config = folder / "grid.sumocfg"
        config.write_text(config.read_text().replace('time-to-teleport value="300"', 'time-to-teleport value="-1"'))

    scenario = variant(fill)
    texts = []
    for make in (Forked, InProcess):
        with closing(make(scenario, seed=1)) as simulation, pytest.raises(NoRoomError) as caught:
            simulation.depart(hurried)
        texts.append(str(caught.value))
    assert texts == ["the ego found no gap on 'cwc0' in 300 s of simulated time"] * 2


def test_a_scenario_folder_is_never_written_to(variant: Variant, hurried: EgoPlan) -> None:
    """Neither by options, nor by detectors, nor by what additional files include."""

    def talkative(folder: Path) -> None:
        edit(
            "grid.sumocfg",
            "</configuration>",
            """
            <output><summary-output value="summary.xml"/><tripinfo-output value="trips.xml"/></output>
            <fcd-output value="fcd.xml"/><log value="log.txt"/><save-state.times value="10"/>
            <additional-files value="more.add.xml"/><end value="10"/></configuration>""",
        )(folder)
        (folder / "more.add.xml").write_text("""<additional><include href="deep/deeper.add.xml"/>
            <edgeData id="all" file="edges.xml" freq="10"/></additional>""")
        (folder / "deep").mkdir()
        (folder / "deep/deeper.add.xml").write_text("""<additional>
            <e1Detector id="loop" lane="cwc0_0" pos="20" freq="10" file="loop.xml"/></additional>""")

    scenario = variant(talkative)
    before = {path: path.stat().st_mtime_ns for path in scenario.folder.rglob("*")}
    scenario.folder.chmod(0o555)
    simulation = Forked(scenario, seed=1)
    traffic = simulation.depart(hurried)
    assert len(traffic.advance(20.0).states) == 200
    traffic.close()
    simulation.close()
    scenario.folder.chmod(0o755)
    assert {path: path.stat().st_mtime_ns for path in scenario.folder.rglob("*")} == before
