import json
import subprocess
import sys

import pytest

from automotive_cosim.errors import SetupError
from automotive_cosim.run.peers import NAMES, WAYS, PeerFigures
from automotive_cosim.traffic import sumo_programs

KEYS = {
    "scenario", "vehicles", "bare_sumo_s_per_step", "libsumo_s_per_step", "env_s_per_step", "in_process_s_per_step",
    "in_process_ratio", "forked_s_per_step", "forked_single_s_per_step",
    "env_rendered_s_per_step", "reset_reload_s", "reset_fork_s", "rss_mb", "rss_per_extra_env_mb",
}  # fmt: skip


@pytest.mark.sumo
@pytest.mark.slow
def test_every_figure_is_there_and_a_fork_beats_a_reload(cli):
    ran = cli("bench", "--json", "--scenario", "grid", "--steps", "200")
    assert ran.code == 0
    assert ran.err == ""
    figures = json.loads(ran.out)
    assert set(figures) >= KEYS
    assert figures["vehicles"] > 0
    assert all(figures[name] > 0 for name in KEYS if name.endswith("_s_per_step"))
    assert 0 < figures["reset_fork_s"] < figures["reset_reload_s"]
    if figures["rss_mb"] is not None:
        assert 0 < figures["rss_per_extra_env_mb"] < figures["rss_mb"]


def test_without_the_sumo_program_the_reason_stands_in_its_place(monkeypatch):
    from automotive_cosim.run import measure
    from automotive_cosim.scenarios import load

    def missing(name: str) -> None:
        raise SetupError(f"{name} is not installed")

    monkeypatch.setattr(sumo_programs, "program", missing)
    assert measure._bare(load("grid"), 100) == (None, "sumo is not installed")


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize("way", sorted(WAYS.keys() - {"sumo_rl"}))
def test_each_way_to_run_the_traffic_is_timed(way):
    command = [sys.executable, "-m", "automotive_cosim.run.peers", way, "grid", "20"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    told = PeerFigures(NAMES[way], **json.loads(done.stdout.splitlines()[-1]))
    assert told.s_per_second > 0
    assert (told.reset_s is not None) == (told.s_per_second_of_episodes is not None) == (way == "states_forked")


def test_without_sumo_rl_it_says_what_is_missing(cli, monkeypatch):
    from automotive_cosim.run import measure

    monkeypatch.setattr(measure, "find_spec", lambda name: None)
    ran = cli("bench", "--scenario", "grid", "--peers")
    assert ran.code != 0
    assert "pip install sumo-rl" in ran.err
    assert "Traceback" not in ran.err


@pytest.mark.parametrize("arguments", [["--scenario", "gird"], ["--steps", "1"]])
def test_bad_input_is_one_line(cli, arguments):
    ran = cli("bench", *arguments)
    assert ran.code == 2
    assert len([line for line in ran.err.splitlines() if line.startswith("error: ")]) == 1
