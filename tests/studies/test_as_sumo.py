"""The traffic of others' files is SUMO's, as a congestion study drives it."""

import re
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.cli.batches import tell_notes
from automotive_cosim.scenarios import difference, open_scenario
from automotive_cosim.scenarios.difference import notes_of
from automotive_cosim.studies.congestion.plan import CongestionPlan
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.stability import measure
from automotive_cosim.traffic.sumo import EGO, load_library, start
from automotive_cosim.traffic.sumo_programs import run
from tests.scenarios.test_foreign import OTHERS
from tests.studies.beside_sumo import INTERVAL_S, beside, made
from tests.traffic.in_process import InProcess

MOST = [name for name in scenarios.shipped() if name != "grid"]


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


@pytest.mark.parametrize(
    "name",
    [
        *(pytest.param(each, marks=pytest.mark.proof) for each in scenarios.shipped()),
        *(pytest.param(each, marks=pytest.mark.slow) for each in ("all classes", *OTHERS)),
    ],
)
def test_without_an_ego_every_vehicle_drives_as_in_sumo(
    name: str, tmp_path: Path, data_of_others: Callable[[str], Path], sumo: None
) -> None:
    ours, sumos = beside(_configuration(name, tmp_path, data_of_others))
    assert dict(ours.trips.items() - sumos.trips.items()) == {}
    assert name in scenarios.shipped() or len(ours.trips) > 50
    assert ours == sumos


def _configuration(name: str, folder: Path, data_of_others: Callable[[str], Path]) -> Path:
    if name in scenarios.shipped():
        return scenarios.load(name).config
    return data_of_others(OTHERS[name]) if name in OTHERS else made(folder)


ASKS = re.compile(r"get|is[A-Z]|has[A-Z]|subscribe|unsubscribe|convert|find|step|start|close|_")
"""Beginnings of the names of libsumo's functions that only ask, or run the simulation."""


def _asked_of_sumo(monkeypatch: pytest.MonkeyPatch) -> list[tuple[float, Callable[[], object]]]:
    """Everything that is done to vehicles, types and routes from now on, with the simulation time."""
    import libsumo

    done: list[tuple[float, Callable[[], object]]] = []

    def kept(function: Callable[..., object]) -> Callable[..., object]:
        def call(*given: object, **named: object) -> object:
            done.append((libsumo.simulation.getTime(), partial(function, *given, **named)))
            return function(*given, **named)

        return call

    for home in (libsumo.vehicle, libsumo.vehicletype, libsumo.route):
        for name in dir(home):
            if ASKS.match(name) is None and callable(function := getattr(home, name)):
                monkeypatch.setattr(home, name, kept(function))
    return done


def _positions() -> dict[str, tuple[str, float, float]]:
    import libsumo

    of = libsumo.vehicle
    return {each: (of.getLaneID(each), of.getLanePosition(each), of.getSpeed(each)) for each in of.getIDList()}


def with_an_ego(config: Path, drive_s: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> int:
    """Drives with an ego, then bare SUMO to which only what was done to the ego's car is done: all are where they
    were, second by second. Returns how many vehicles that were at the end."""
    import libsumo

    scenario = open_scenario(config)
    scenario = replace(scenario, sumo=replace(scenario.sumo, warm_up_s=60.0))
    done = _asked_of_sumo(monkeypatch)
    seen = []
    with closing(InProcess(scenario, seed=1, allow_unprojected=True)) as simulation:
        drive = simulation.depart(EgoPlan(scenario.ego.trips[0], "steady", seed=1))
        for second in range(drive_s):
            seen.append((libsumo.simulation.getTime(), _positions()))
            if drive.state.end is not None:
                break
            if second % 20 == 10:
                drive.alternatives()
            drive.advance(1.0)
    touched = {str(call.args[0]) for _, call in done}  # type: ignore[attr-defined]
    assert all(each == "DEFAULT_VEHTYPE" or each.startswith((EGO, "automotive_cosim.")) for each in touched)
    library = load_library()
    monkeypatch.chdir(tmp_path)
    start(library, ["sumo", "-c", str(config.absolute()), "--seed=1", "--no-step-log", "--no-warnings"])
    with closing(library):
        for at_s, there in seen:
            while library.time() < at_s - 1e-9:
                while done and done[0][0] < library.time() + 1e-9:
                    done.pop(0)[1]()
                library.step()
            assert _positions() == there, at_s
    return len(there)


@pytest.mark.sumo
@pytest.mark.parametrize(
    "name", ["grid", *(pytest.param(each, marks=pytest.mark.proof) for each in (*MOST, "all classes", *OTHERS))]
)
def test_with_an_ego_everybody_drives_as_in_sumo_with_that_car(
    name: str, tmp_path: Path, data_of_others: Callable[[str], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    config = _configuration(name, tmp_path, data_of_others)
    assert with_an_ego(config, 100, monkeypatch, tmp_path) > 1


def test_the_size_of_what_cannot_be_kept_is_told_before_the_start(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], sumo: None
) -> None:
    config = made(tmp_path, end_s=600)
    as_it_is = open_scenario(config)
    assert difference._size(as_it_is).endswith("(+0.0% and +0.0%)")
    assert tuple(notes_of(as_it_is)) == as_it_is.notes
    text = config.read_text()
    for stated, kept in (("step-length", "1 instead of 2"), ("no-internal-links", "which is left out")):
        value = "2" if stated == "step-length" else "true"
        config.write_text(re.sub("<step-length [^>]*>", f'<{stated} value="{value}"/>', text))
        tell_notes([open_scenario(config)])
        said = capsys.readouterr().err
        assert f"but for {stated}" in said
        assert kept in said
        (changes,) = re.findall(r"of seed 0 \((.*) and (.*)\)", said)
        assert changes != ("+0.0%", "+0.0%")
    config.write_text(text)
    net = tmp_path / "made.net.xml"
    slow = '<param key="maxspeed:conditional" value="18 @ (Mo-Su 00:00-24:00)"/>'
    net.write_text(re.sub('(<edge id="[A-D].*?)</edge>', rf"\1{slow}</edge>", net.read_text(), flags=re.DOTALL))
    tell_notes([open_scenario(config)])
    said = capsys.readouterr().err
    assert "but for the hours of limits and closures on 48 edges" in said
    ((ours_kmh, sumos_kmh),) = re.findall(r"at (\S+) km/h instead of \S+ vehicles at (\S+) km/h", said)
    assert float(ours_kmh) < 0.8 * float(sumos_kmh), "SUMO does not read them"


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
