"""Scenarios made from the grid, and simulations of it that tests may share."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from automotive_cosim.scenarios import Scenario, load
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked

Edit = Callable[[Path], None]


@pytest.fixture(scope="session")
def grid() -> Scenario:
    return load("grid")


@pytest.fixture(scope="session")
def forked(sumo: None, grid: Scenario) -> Iterator[Forked]:
    simulation = Forked(grid, seed=1)
    yield simulation
    simulation.close()


@pytest.fixture(scope="session")
def hurried(grid: Scenario) -> EgoPlan:
    """Along the avenue; with this seed the driver follows the first requests."""
    return EgoPlan(grid.trip("avenue"), "hurried", seed=3)


@pytest.fixture
def variant(grid: Scenario, tmp_path: Path) -> Callable[[Edit], Scenario]:
    """A copy of the grid with something changed in its folder."""

    def make(edit: Edit) -> Scenario:
        folder = tmp_path / "variant"
        shutil.copytree(grid.folder, folder)
        edit(folder)
        return load(folder)

    return make


@pytest.fixture(scope="session")
def walkable(sumo: None) -> Edit:
    def build(folder: Path, *, first: bool = True) -> None:
        """Gives the grid sidewalks, and zebra crossings over the avenue in its middle, on which people go first."""
        zebras = "".join(
            f'<crossing node="c2" edges="{arm}" priority="{str(first).lower()}"/>'
            for arm in ("c1c2 c2c1", "c2c3 c3c2")
        )
        (folder / "zebra.con.xml").write_text(f"<connections>{zebras}</connections>")
        plain = (
            "-n",
            folder / "grid.nod.xml",
            "-e",
            folder / "grid.edg.xml",
            "--proj.utm",
            "--output.street-names",
        )
        walks = ("-x", folder / "zebra.con.xml", "--sidewalks.guess", "--no-turnarounds.except-deadend")
        built, printed = sumo_programs.run("netconvert", [*plain, *walks, "-o", folder / "grid.net.xml"])
        assert built, printed
        (folder / "grid.rou.xml").write_text("<routes/>")

    return build
