import json

import pytest

from automotive_cosim.run import bench


@pytest.mark.sumo
@pytest.mark.slow
def test_every_figure_is_there(cli, monkeypatch):
    monkeypatch.setattr(bench, "REPEATS", 1)
    monkeypatch.setattr(bench, "RESETS", 3)
    ran = cli("bench", "--json", "--scenario", "grid", "--steps", "100")
    assert (ran.code, ran.err) == (0, "")
    figures = json.loads(ran.out)
    assert figures["vehicles"] > 0
    steps = ("libsumo_s_per_step", "forked_s_per_step", "env_s_per_step", "env_rendered_s_per_step")
    assert all(figures[name] > 0 for name in (*steps, "reset_fork_s", "reset_reload_s"))
    assert 0 < figures["rss_per_extra_env_mb"] < figures["rss_mb"]


@pytest.mark.parametrize("arguments", [["--scenario", "gird"], ["--steps", "1"]])
def test_bad_input_is_one_line(cli, arguments):
    ran = cli("bench", *arguments)
    assert ran.code == 2
    assert len([line for line in ran.err.splitlines() if line.startswith("error: ")]) == 1
