"""The examples for libraries of reinforcement learning, each run where the library is installed.

``AUTOMOTIVE_COSIM_RL`` names a Python in which they are, as torch and its kin are too large for the tests' own.
"""

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import gymnasium
import pytest
from PIL import Image

TOP = Path(__file__).parents[2]
FOLDER = TOP / "docs/examples/rl"
PYTHON = os.environ.get("AUTOMOTIVE_COSIM_RL", sys.executable)
HERE, LEARNS, GAME = "async_vector.py", "ten_minutes.py", "two_ways.py"
NEEDS = {
    "cleanrl_fleet.py": "pettingzoo",
    "cleanrl_loop.py": "torch",
    "rllib_ppo.py": "torch, ray.rllib",
    "sb3_fleet.py": "pettingzoo, stable_baselines3",
    "sb3_ppo.py": "stable_baselines3",
    "torchrl_rollout.py": "torchrl",
}


def test_every_example_is_tried():
    assert {path.name for path in FOLDER.glob("*.py")} == {HERE, LEARNS, GAME, *NEEDS}


@pytest.mark.slow
@pytest.mark.sumo
def test_the_one_that_needs_nothing_more_runs_to_its_end(monkeypatch, capsys):
    """In this process; ``tests/envs`` tries environments in processes of their own."""
    make_vec = gymnasium.make_vec
    monkeypatch.setattr(gymnasium, "make_vec", lambda *names, vectorization_mode, **more: make_vec(*names, **more))
    runpy.run_path(str(FOLDER / HERE), run_name="__main__")
    assert capsys.readouterr().out.startswith("0.")


@pytest.mark.slow
@pytest.mark.sumo
def test_the_one_that_learns_measures_and_films_two_policies(monkeypatch, tmp_path, capsys):
    """With two environments of eight steps, and no more than one update."""
    text = (FOLDER / LEARNS).read_text("utf-8").replace("BATCH = 8, 32, 8,", "BATCH = 2, 8, 1,")
    monkeypatch.setattr(sys, "argv", [LEARNS, str(tmp_path), "0.001", "2"])
    exec(compile(text, LEARNS, "exec"), {"__name__": "__main__"})
    told = capsys.readouterr().out.splitlines()
    assert [line.partition(":")[0] for line in told if "unseen" in line] == ["before", "after"]
    with Image.open(tmp_path / "ten_minutes.webp") as film:
        assert film.n_frames > 6


@pytest.mark.slow
@pytest.mark.sumo
def test_the_game_is_learned_measured_and_filmed(monkeypatch, tmp_path, capsys):
    """With a peak of two minutes, one day to learn from and two to measure, and one rule."""
    pytest.importorskip("scipy")
    text = (FOLDER / GAME).read_text("utf-8")
    for name, smaller in {
        "TRAINED, TESTED": "range(1), range(1000, 1002)",
        "PASSES, DAYS, RATE": "1, 2, 0.5",
        "PEAK": "(0.15,)",
        "RULES": "('never',)",
    }.items():
        text, count = re.subn(rf"^{name} = .*$", f"{name} = {smaller}", text, flags=re.MULTILINE)
        assert count == 1
    monkeypatch.setattr(sys, "argv", [GAME, str(tmp_path)])
    exec(compile(text, GAME, "exec"), {"__name__": "__main__"})
    told = capsys.readouterr().out
    assert "| never |" in told
    assert "learners by optimum" in told
    with Image.open(tmp_path / "film.webp") as film:
        assert film.n_frames > 6
    assert (tmp_path / "curve.png").is_file()


@pytest.mark.slow
@pytest.mark.sumo
@pytest.mark.parametrize("example", NEEDS)
def test_an_example_runs_to_its_end(example, tmp_path):
    needs = NEEDS[example]
    tried = subprocess.run([PYTHON, "-c", f"import {needs}"], cwd=tmp_path, capture_output=True, check=False)
    if tried.returncode:
        pytest.skip(f"{PYTHON} has no {needs}; AUTOMOTIVE_COSIM_RL names one that has")
    done = subprocess.run(
        [PYTHON, str(FOLDER / example)],
        env={**os.environ, "PYTHONPATH": str(TOP)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    assert done.stdout.splitlines()[-1].startswith("0."), done.stdout[-2000:]
