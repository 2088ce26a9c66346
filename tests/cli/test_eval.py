import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from automotive_cosim.errors import install_hint
from automotive_cosim.run.job_row import JobRow
from automotive_cosim.run.store import opened, read_trace, write_trace

GRID = ("--tasks", "hvac_fan_max", "--scenarios", "grid")
PROGRAM = (sys.executable, "-c", "from automotive_cosim.cli.main import main; main()")


def test_the_plan_is_shown_first_and_a_dry_run_ends_there(cli, tmp_path):
    ran = cli("eval", "--agents", "oracle,t3a", *GRID, "--seeds", "0-2,7", "--geo", "full,none", "--dry-run")
    assert ran.code == 0
    assert "16 from 4 warm simulations" in ran.out
    assert "say nothing about a language model" in " ".join(ran.out.split())
    tasks = ("--tasks", "hvac_fan_max,road_speed_80_in_50", "--scenarios", "grid")
    for option, count in (((), "1 from"), (("--everywhere",), "3 from")):
        assert count in cli("eval", "--agents", "oracle", *tasks, *option, "--dry-run").out
    assert not list(tmp_path.iterdir())


@pytest.mark.sumo
def test_a_run_is_told_and_the_same_command_finds_it_done(cli, tmp_path):
    (tmp_path / "plan.toml").write_text('agents = ["oracle"]\ntasks = ["hvac_fan_max"]\nscenarios = ["grid"]\n')
    first = cli("eval", "--plan", "plan.toml", "--json")
    assert (first.code, first.out.count("\n")) == (0, 1)
    told = json.loads(first.out)
    assert (told["planned"], told["successes"], told["errors"], told["ran"]) == (1, 1, 0, 1)
    assert Path(told["out"], "manifest.json").is_file()
    (agent,) = told["agents"]
    assert (agent["agent"], agent["episodes"], agent["successes"], agent["rate"]) == ("oracle", 1, 1, 1.0)
    assert agent["interval"][0] < 1 == agent["interval"][1]
    assert told["answer"].startswith("oracle (told the answer) solves 1 of 1 episode")
    again = cli("eval", "--agents", "oracle", *GRID)
    assert again.code == 0
    assert "1 of 1 episodes; 1 succeeded, 0 failed" in again.out
    assert "1 succeeded; 1 of 1 planned episode judged\n" in again.out
    assert len(list((tmp_path / "runs").iterdir())) == 1
    assert cli("eval", "--agents", "oracle", *GRID, "--at-least", "1").code == 0


KILLS_WORKER = """
import os, pathlib
class Kills:
    def reset(self, goal):
        fork_server = pathlib.Path("/proc", str(os.getppid()), "stat").read_text()
        os.kill(int(fork_server.rpartition(")")[2].split()[1]), 9)
    def act(self, seen): ...
"""


@pytest.mark.sumo
def test_errors_are_listed_and_set_the_exit_code(cli, tmp_path):
    (tmp_path / "kills.py").write_text(KILLS_WORKER)
    ran = cli("eval", "--agents", "oracle,kills:Kills", *GRID, "--out", "e", "--retries", "0")
    assert ran.code == 3
    assert "WorkerDied" in ran.out
    assert "1 succeeded; 1 of 2 planned episodes judged, 1 error\n" in ran.out
    assert ran.err.startswith("error: 1 of 2 episodes ended in an infrastructure error")


@pytest.mark.sumo
def test_an_agent_that_fails_is_judged_and_told(cli, tmp_path):
    (tmp_path / "raises.py").write_text(
        "class Raises:\n    def reset(self, goal): raise RuntimeError('broken')\n    def act(self, seen): ...\n"
    )
    ran = cli("eval", "--agents", "oracle,raises:Raises", *GRID, "--out", "e")
    assert ran.code == 0
    assert "1 succeeded; 2 of 2 planned episodes judged" in ran.out
    assert "agent raises:Raises failed in 1 run, e.g. " in ran.out
    assert "RuntimeError: broken" in ran.out
    ran = cli("eval", "--agents", "oracle,raises:Raises", *GRID, "--out", "e", "--at-least", "0.8")
    assert (ran.code, ran.err) == (1, "raises:Raises: 0 of 1 episode succeeded, a smaller share than 0.8\n")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "has no agent"),
        (("--agents", "t4a"), "did you mean"),
        (("--agents", "t3a", "--seeds", "3-1"), "--seeds"),
        (("--agents", "t3a", "--tasks", "nothing_*"), "no task"),
        (("--agents", "t3a", "--pictures", "some"), "no choice of pictures"),
        (("--agents", "t3a", "--workers", "0"), "whole number"),
        (("--agents", "t3a", "--executor", "rya"), "did you mean 'ray'?"),
        (("--agents", "t3a", "--executor", "ray:"), "no executor named 'ray:'"),
        (("--agents", "t3a", "--scenarios", ""), "--scenarios is empty"),
        (("--plan", "none.toml"), "none.toml"),
    ],
)
def test_bad_input_is_one_line(cli, arguments, said, tmp_path):
    ran = cli("eval", *arguments)
    assert ran.code == 2
    assert ran.err.startswith("error: ")
    assert ran.err.count("\n") == 1
    assert said in ran.err
    assert not list(tmp_path.iterdir())


def test_without_ray_the_command_that_installs_it_is_named(cli, monkeypatch, tmp_path):
    monkeypatch.delitem(sys.modules, "automotive_cosim.run.on_ray", raising=False)
    monkeypatch.setitem(sys.modules, "ray", None)
    ran = cli("eval", "--agents", "oracle", *GRID, "--executor", "ray")
    assert (ran.code, ran.err) == (
        2,
        f"error: the ray package is missing; install it with `{install_hint('cluster')}`\n",
    )
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_written_is_one_line(cli):
    ran = cli("eval", "--agents", "oracle", *GRID, "--out", "/proc/x")
    assert ran.code == 2
    assert ran.err.startswith("error: cannot write to /proc/x")
    assert ran.err.count("\n") == 1


@pytest.mark.sumo
@pytest.mark.parametrize(
    "in_background", [False, pytest.param(True, marks=pytest.mark.proof)], ids=["ctrl-c", "nohup, then kill"]
)
def test_a_stop_says_how_to_go_on(program, tmp_path, until, session, in_background):
    """In the background SIGINT is ignored from the start, and stays so: Ctrl-C is for another program."""
    process = program(
        *PROGRAM, "eval", "--agents", "oracle", *GRID, "--repeats", "50", "--out", "e", "--workers", "2",
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        sigint=signal.SIG_IGN if in_background else signal.default_int_handler,
    )  # fmt: skip
    lines = tmp_path / "e" / "episodes.jsonl"

    def episodes() -> int:
        return lines.read_bytes().count(b"\n") if lines.is_file() else 0

    until(lambda: episodes() >= 1)
    os.killpg(process.pid, signal.SIGINT)
    if in_background:
        ended = episodes()
        until(lambda: episodes() >= ended + 2)
        process.terminate()
    _, err = process.communicate(timeout=60)
    assert process.returncode == (143 if in_background else 130)
    assert err.endswith("error: interrupted\n")
    assert "Traceback" not in err
    assert "rerun the command to resume" in err
    assert "of 50 planned episodes judged" in err
    assert lines.read_bytes().endswith(b"\n")
    until(lambda: not session(process.pid))


@pytest.mark.sumo
def test_a_stored_episode_is_run_again_and_compared_step_by_step(cli, tmp_path):
    ran = json.loads(cli("eval", "--agents", "always-alert", *GRID, "--out", "e", "--json").out)
    assert ran["agent_failures"] == []
    assert ran["judged"] == 1
    (trace,) = (tmp_path / "e" / "traces").glob("*.jsonl.gz")
    name = trace.name.removesuffix(".jsonl.gz")
    again = cli("replay", "e", name)
    assert again.code == 0, again.err
    assert again.out.count("the same\n") >= 4
    assert "all 3 steps are the same" in again.out
    judged_again = cli("publish", "regrade", "e")
    assert (judged_again.code, judged_again.out) == (0, "0 of 1 verdicts change; 1 of 1 planned episode judged\n")
    lines = read_trace(tmp_path / "e", name)
    lines[2]["signals"]["Vehicle.Speed"] = -1.0
    write_trace(tmp_path / "e", name, lines)
    differs = cli("replay", "e", "hvac_fan_max")
    assert differs.code == 1
    assert "1 of 3 steps differ, starting with step 2" in differs.out
    assert "differs in signals" in differs.out
    assert cli("replay", "e", "hvac_x").code == 2
    assert cli("report", "e").code == 0
    assert (tmp_path / "e" / "report.html").is_file()


@pytest.mark.parametrize(
    ("plan", "said"), [(None, "is not an evaluation"), ({"tasks": ["all"]}, "holds no agents' episodes")]
)
def test_a_folder_that_is_no_evaluation_is_told(cli, tmp_path, plan, said):
    if plan is not None:
        with opened(tmp_path / "f", plan, JobRow, parts=()):
            pass
    assert (plan is not None) or "there is no such folder" in cli("report", "f").err
    for command in (("report", "f"), ("replay", "f", "x"), ("publish", "regrade", "f"), ("compare", "f", "f")):
        ran = cli(*command)
        assert (ran.code, ran.err.count("\n")) == (2, 1)
        assert said in ran.err


def test_a_dry_run_needs_no_key_and_says_how_long_and_what_is_missing(cli, monkeypatch):
    monkeypatch.delenv("NOWHERE_API_KEY", raising=False)
    plan = ("--agents", "t3a", "--models", "nowhere/m", "--tasks", "hvac_fan_max", "--scenarios", "grid")
    ran = cli("eval", *plan, "--dry-run")
    assert (ran.code, ran.err) == (0, "")
    assert "time: less than a minute with 1 worker" in ran.out
    assert "to fix before it can run: model 'nowhere/m' requires a key in NOWHERE_API_KEY" in ran.out
    refused = cli("eval", *plan)
    assert refused.code == 2
    assert "NOWHERE_API_KEY" in refused.err


def test_two_studies_are_sent_to_their_own_command(cli, tmp_path):
    (tmp_path / "s").mkdir()
    (tmp_path / "s/manifest.json").write_text('{"format": 1, "plan": {"study": "congestion"}}')
    ran = cli("compare", "s", "s")
    assert (ran.code, "s is a study; `automotive-cosim study compare` compares" in ran.err) == (2, True)
    assert "`study`" in cli("report", "--help").out
    assert "local/FILE.gguf" in cli("run", "--help").out.replace("\n", "")
