"""Every measurement in ``benchmarks/`` runs, with its smallest input."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from contextlib import closing
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from automotive_cosim.envs.flat_drive import ACTIONS, FlatDriveEnv

FOLDER = Path(__file__).parents[2] / "benchmarks"
GRID = FOLDER.parent / "sumo_scenarios" / "grid" / "grid.net.xml"
LIMITS = {
    "meta": {},
    "speedLimitsByCountryCode": {"FR": [{"name": "urban", "tags": {"maxspeed": "50"}}]},
}
"""A table of default limits."""


@dataclass(frozen=True)
class Smallest:
    """The smallest input of a script."""

    words: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    """Optional libraries."""
    program: str = ""
    """An optional program."""


CASES = {
    "calibration": Smallest(("--scenario", "grid", "--rounds", "1")),
    "cockpit": Smallest(("--frames", "1", str(GRID))),
    "dead_reckoning": Smallest(("grid", "tunnel")),
    "decisions": Smallest(("--decisions", "40", "--envs", "1", "--only", "flat")),
    "default_limits": Smallest(("limits.json",)),
    "drives": Smallest(("--minutes", "0")),
    "exchange": Smallest(("--scenarios", "grid"), program="qc_opendrive"),
    "eta": Smallest(("grid", "--seeds", "1", "--at", "5", "--step", "1")),
    "faults": Smallest(("--parts", "resets", "--resets", "1")),
    "futures": Smallest(
        (
            "--scenario",
            "grid",
            "--trips",
            "round",
            "--departures",
            "0",
            "--per-drive",
            "1",
            "--replicates",
            "1",
            "--delay",
            "0",
        )
    ),
    "geo_context": Smallest(("2",)),
    "interfaces": Smallest(("--help",)),
    "large_imports": Smallest(("--edges", "60")),
    "crime": Smallest(("--help",)),
    "measures": Smallest(),
    "logical_scenarios": Smallest(("--only", "speeding", "--tries", "1", "--minutes", "1")),
    "looking": Smallest(("grid", "2")),
    "pages": Smallest(("1",), needs=("playwright",), program="chromium"),
    "ppo_drive": Smallest(
        (
            *("--families", "grid_june", "--unseen", "grid_january", "--minutes", "0.3", "--drives", "1"),
            *("--demonstrations", "1", "--corrected", "1", "--epochs", "1", "--few", "1"),
            *("--steps", "64", "--rounds", "1", "--workers", "1"),
        ),
        needs=("torch", "stable_baselines3"),
    ),
    "ppo_flat": Smallest(("--steps", "64", "--rounds", "1"), needs=("torch", "stable_baselines3")),
    "scale": Smallest(("--streets", "4", "--trips", "1")),
    "search": Smallest(("--seeds", "1", "--most", "20")),
    "sensitivity": Smallest(("--seeds", "1", "--points", "16")),
    "studies": Smallest(("--studies", "2")),
    "towns": Smallest(("4",)),
    "drive_tables": Smallest(("--help",)),
}


def test_every_script_has_a_case() -> None:
    if not FOLDER.is_dir():
        pytest.skip("not run from a checkout")
    assert {file.stem for file in FOLDER.glob("*.py")} == CASES.keys()


@pytest.mark.slow
@pytest.mark.sumo
@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_it_measures(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    if not (FOLDER / f"{name}.py").is_file():
        pytest.skip("not run from a checkout")
    missing = [library for library in case.needs if find_spec(library) is None]
    if case.program and shutil.which(case.program) is None:
        missing.append(case.program)
    if missing:
        pytest.skip(f"{', '.join(missing)} not installed")
    (tmp_path / "limits.json").write_text(json.dumps(LIMITS), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, FOLDER / f"{name}.py", *case.words],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout
    assert case.words == ("--help",) or any(character.isdigit() for character in done.stdout)


@pytest.mark.slow
@pytest.mark.sumo
def test_a_policy_is_filmed_around_its_alerts(tmp_path: Path) -> None:
    if not FOLDER.is_dir():
        pytest.skip("not run from a checkout")
    with closing(FlatDriveEnv("grid_june")) as env:
        (size,) = env.observation_space.shape
    biases = np.zeros(len(ACTIONS))
    biases[-1] = 1.0
    np.savez(tmp_path / "loud.npz", weights0=np.zeros((len(ACTIONS), size)), biases0=biases)
    words = ("--film", "loud.npz", "--unseen", "grid_june", "--minutes", "0.2")
    done = subprocess.run(
        [sys.executable, FOLDER / "ppo_drive.py", *words], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    with Image.open(tmp_path / "loud.webp") as film:
        assert film.n_frames == int(done.stdout.split()[-2]) > 3  # type: ignore[attr-defined]
