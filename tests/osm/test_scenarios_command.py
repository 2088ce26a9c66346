from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from automotive_cosim import scenarios
from automotive_cosim.cli.scenarios import app
from automotive_cosim.errors import UnknownNameError, UserError


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
