from pathlib import Path

import pytest
from typer.testing import CliRunner

from automotive_cosim import scenarios
from automotive_cosim.cli.scenarios import app
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.osm.doubts import by_kind


@pytest.mark.sumo
def test_import_makes_a_folder_and_prints_the_figures(
    formats: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["import", str(formats[".pbf"]), "--seed", "2", "--density", "0.5"])
    assert done.exit_code == 0, done.output
    assert scenarios.load(tmp_path / "village").name == "village"
    for word in (
        "edges",
        "limits",
        "as mapped",
        "signals",
        "tunnels",
        "scale",
        "halted",
        "took",
        "guessed",
        "OpenStreetMap",
    ):
        assert word in done.stdout
    told = done.stderr.splitlines()
    assert told[0] == "reading the map", "a log has the progress too"
    assert any(line.startswith("testing whether traffic flows at scale 1, in steps of 1 s") for line in told)
    assert len(told) == len(set(told))


def test_what_differs_by_numbers_and_values_alone_is_one_line() -> None:
    alike = [f"turn arrows not followed: turn:lanes={value}: way 1" for value in ("left", "right")]
    of_lanes = [f"turn:lanes={value} on 2 lanes, left out: way 2" for value in ("left|right", "through")]
    told = list(by_kind([alike[0], "lanes=1.5, left out: way 3", alike[1], *of_lanes]))
    assert [line.partition(":")[0] for line in told] == ["turn arrows not followed", "lanes=1.5, left out", "turn"]
    assert sum("2 forms; import.json has all" in line for line in told) == 2


def test_import_passes_errors_on(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["import", str(tmp_path / "nowhere.osm.pbf"), "--out", str(tmp_path / "out")])
    assert isinstance(done.exception, UserError)
    assert not list(tmp_path.iterdir())


def test_show_tells_a_scenarios_trips(imported: tuple[Path, object]) -> None:
    done = CliRunner().invoke(app, ["show", str(imported[0])])
    assert done.exit_code == 0, done.output
    for trip in scenarios.load(imported[0]).ego.trips:
        assert trip.name in done.stdout
    assert isinstance(CliRunner().invoke(app, ["show", "pariss"]).exception, UnknownNameError)


def test_list_names_every_shipped_scenario() -> None:
    done = CliRunner().invoke(app, ["list"])
    assert done.exit_code == 0, done.output
    assert all(name in done.stdout for name in scenarios.shipped())
