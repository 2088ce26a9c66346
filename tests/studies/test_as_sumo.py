"""The traffic of others' files is SUMO's, as a congestion study drives it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.studies.congestion.plan import CongestionPlan
from automotive_cosim.traffic.stability import measure
from automotive_cosim.traffic.sumo_programs import run
from tests.scenarios.test_foreign import OTHERS
from tests.studies.beside_sumo import INTERVAL_S, beside, made


def test_its_steps_are_those_of_the_file_or_the_options(tmp_path: Path) -> None:
    net, routes = (next(scenarios.load("grid").folder.glob(f"*.{what}.xml*")) for what in ("net", "rou"))
    config = tmp_path / "town.sumocfg"
    config.write_text(
        f'<configuration><net-file value="{net}"/><route-files value="{routes}"/><step-length value="0.5"/>'
        "</configuration>",
        encoding="utf-8",
    )
    for given, step_s in ((None, 0.5), (1.0, 1.0)):
        assert CongestionPlan(str(config), step_s=given).scene().sumo.step_length_s == step_s


@pytest.mark.parametrize("name", scenarios.shipped())
def test_without_an_ego_every_road_is_as_in_sumo(name: str, sumo: None) -> None:
    ours, sumos = beside(scenarios.load(name).config, 10.0, INTERVAL_S, trips=False)
    assert ours.edges == sumos.edges != []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["all classes", *OTHERS])
def test_without_an_ego_every_vehicle_drives_as_in_sumo(
    name: str, tmp_path: Path, data_of_others: Callable[[str], Path], sumo: None
) -> None:
    ours, sumos = beside(data_of_others(OTHERS[name]) if name in OTHERS else made(tmp_path))
    assert dict(ours.trips.items() - sumos.trips.items()) == {}
    assert len(ours.trips) > 50
    assert ours == sumos


@pytest.mark.slow
def test_the_check_of_an_hour_is_of_what_sumo_does_by_the_file(tmp_path: Path, sumo: None) -> None:
    config = made(tmp_path)
    stated = '<time-to-teleport value="20"/><step-length'
    config.write_text(config.read_text().replace("<step-length", stated))
    scenario = open_scenario(config)
    scenario = replace(scenario, sumo=replace(scenario.sumo, warm_up_s=60.0))
    found = measure(scenario, observe_s=300.0, step_length_s=0.5)
    summary = ["--seed", "0", "--end", "360", "--summary-output", "s.xml", "--summary-output.period", "1"]
    assert run("sumo", ["-c", str(config), *summary], tmp_path)[0]
    steps = re.findall(
        '<step time="([^"]*)".* arrived="([^"]*)".* teleports="([^"]*)"', (tmp_path / "s.xml").read_text()
    )
    (_, *before), (_, *after) = next(step for step in steps if float(step[0]) == 60), steps[-1]
    arrived, teleports = (int(last) - int(first) for first, last in zip(before, after, strict=True))
    assert (found.arrived, found.teleports, found.longest_wait_s) == (arrived, teleports, 20)
    assert teleports
    assert f"{teleports} vehicles stood for over 20 s" in found.problems[1]
