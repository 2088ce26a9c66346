import io
import json
import os
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.tasks import CATALOGUE

pytestmark = pytest.mark.usefixtures("warm")

GRID = ("--task", "hvac_fan_max", "--scenario", "grid")
KEYS = {
    "task", "scenario", "agent", "model", "seed", "success", "reward", "steps", "sim_seconds", "trace_sha256",
    "out",
}  # fmt: skip
PROGRAM = (sys.executable, "-c", "from automotive_cosim.cli.main import main; main()")


def test_json_prints_one_object_and_the_record_is_whole(cli, tmp_path):
    ran = cli("run", "--json", *GRID, "--agent", "oracle")
    assert ran.code == 0
    assert ran.err == ""
    assert ran.out.count("\n") == 1
    told = json.loads(ran.out)
    assert set(told) >= KEYS
    assert told["success"] is True
    folder = tmp_path / told["out"]
    assert folder.parent == tmp_path / "runs"
    left = {path.name for path in folder.iterdir()}
    assert left == {"trial.json", "steps.jsonl", "screenshots", "road.jsonl.gz", "episode.webp", "summary.html"}


def test_without_a_terminal_it_tells_in_plain_lines(cli):
    ran = cli("run", *GRID, "--agent", "oracle", "--out", "out")
    assert ran.code == 0
    assert "\x1b" not in ran.out
    for word in ("hand-over", "step 1", "success", "declared", "out/summary.html"):
        assert word in ran.out, ran.out
    assert "Traceback" not in ran.out + ran.err


def test_an_episode_that_is_not_solved_has_run_all_the_same(cli):
    ran = cli("run", "--json", *GRID, "--agent", "always-alert")
    assert ran.code == 0
    assert json.loads(ran.out)["success"] is False


def test_force_replaces_a_record(cli):
    first = json.loads(cli("run", "--json", *GRID, "--agent", "oracle", "--out", "out").out)
    again = json.loads(cli("run", "--json", *GRID, "--agent", "oracle", "--out", "out", "--force").out)
    assert first == again


def test_a_file_of_actions_is_played(cli, tmp_path):
    actions = [
        {"action_type": "open_app", "app_name": "climate"},
        {"action_type": "status", "goal_status": "complete"},
    ]
    (tmp_path / "a.jsonl").write_text("\n".join(map(json.dumps, actions)), encoding="utf-8")
    told = json.loads(cli("run", "--json", *GRID, "--actions", "a.jsonl", "--out", "out").out)
    assert told["agent"] == "script"
    assert told["steps"] == len(actions)
    lines = [json.loads(line) for line in Path("out/steps.jsonl").read_text(encoding="utf-8").splitlines()]
    assert [line["action"] for line in lines[1:]] == actions


def test_a_trigger_out_of_reach_is_no_failure_and_leaves_no_folder(cli, tmp_path, monkeypatch):
    task = CATALOGUE["road_speed_80_in_50"]
    hasty = replace(task.half("second"), trigger=replace(task.half("second").trigger, within_s=5.0))
    monkeypatch.setitem(CATALOGUE._tasks, task.id, replace(task, second=hasty))
    ran = cli("run", "--json", "--scenario", "grid", "--task", "road_speed_80_in_50", "--half", "second")
    assert ran.code == 3
    assert json.loads(ran.out)["success"] is None
    assert len(ran.err.splitlines()) == 1
    assert ran.err.startswith("error: task 'road_speed_80_in_50'")
    assert not list(tmp_path.iterdir())


def test_a_terminal_that_knows_ascii_alone_gets_the_whole_record(cli, tmp_path, monkeypatch):
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(io.FileIO(1, "w", closefd=False), encoding="ascii"))
    done = cli("run", *GRID, "--agent", "oracle", "--out", "out")
    assert (done.code, done.err) == (0, "")
    assert "the driver says: ?" in done.out
    assert (tmp_path / "out" / "summary.html").is_file()


def test_ctrl_c_while_the_command_line_loads_ends_it_in_silence(program, tmp_path):
    (tmp_path / "typer.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\nwhile True: pass\n")
    code = "from automotive_cosim_main import main; main()"
    process = program(sys.executable, "-c", code, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    said, _ = process.communicate(timeout=60)
    assert (process.returncode, said) == (-signal.SIGINT, "")


@pytest.mark.parametrize("handler", ["default_int_handler", "SIG_IGN", "SIG_DFL"])
def test_the_console_script_leaves_ctrl_c_as_it_was(handler):
    program = f"""
import signal, sys
signal.signal(signal.SIGINT, signal.{handler})
sys.argv = ["automotive-cosim", "--version"]
from automotive_cosim_main import main
try: main()
finally: assert signal.getsignal(signal.SIGINT) is signal.{handler}, signal.getsignal(signal.SIGINT)
"""
    subprocess.run([sys.executable, "-c", program], check=True, capture_output=True)


@pytest.fixture
def long_run(program, tmp_path, until):
    """A run of minutes in a session of its own, far enough to have recorded two steps."""
    wait = json.dumps({"action_type": "wait", "seconds": 10})
    (tmp_path / "a.jsonl").write_text("\n".join([wait] * 30), encoding="utf-8")
    process = program(
        *PROGRAM, "run", *GRID, "--actions", "a.jsonl", "--out", "out",
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    steps = tmp_path / "out" / "steps.jsonl"
    until(lambda: steps.is_file() and steps.read_text(encoding="utf-8").count("\n") >= 2)
    return process


@pytest.mark.parametrize(
    ("send", "what", "code"),
    [(os.killpg, signal.SIGINT, 130), (os.kill, signal.SIGTERM, 143)],
    ids=["ctrl-c, to all", "a request to end, to the program alone"],
)
def test_a_signal_keeps_what_was_recorded_and_ends_every_process(
    long_run, tmp_path, send, what, code, until, session
):
    send(long_run.pid, what)
    _, err = long_run.communicate(timeout=30)
    assert long_run.returncode == code
    assert "Traceback" not in err
    assert "out" in err
    lines = (tmp_path / "out" / "steps.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["step"] for line in lines] == list(range(len(lines)))
    told = json.loads((tmp_path / "out" / "trial.json").read_text(encoding="utf-8"))
    assert told["row"]["end"] == "interrupted"
    assert (tmp_path / "out" / "summary.html").is_file()
    until(lambda: not session(long_run.pid))


def test_a_kill_keeps_the_steps_and_leaves_no_process(long_run, tmp_path, until, session):
    long_run.kill()
    long_run.communicate()
    for line in (tmp_path / "out" / "steps.jsonl").read_text(encoding="utf-8").splitlines()[:-1]:
        json.loads(line)
    assert json.loads((tmp_path / "out" / "trial.json").read_text(encoding="utf-8")).keys() == {"manifest"}
    until(lambda: not session(long_run.pid))


def test_the_lines_of_a_drive_are_in_the_order_of_their_times(cli, tmp_path):
    (tmp_path / "wait.jsonl").write_text('{"action_type": "wait", "seconds": 10}\n' * 2, encoding="utf-8")
    told = cli("run", "--scenario", "grid", "--task", "hvac_fan_max", "--actions", "wait.jsonl").out
    live = told.partition("the driver says")[2].partition("not solved")[0]
    times = [float(found) for found in re.findall(r"^ *([+-]\d+\.\d) s  ", live, re.MULTILINE)]
    assert len(times) > 5
    assert times == sorted(times)
    assert live.index("step 1") < live.index("km/h")


@pytest.mark.parametrize(
    ("act", "said", "more", "told"),
    [
        ("raise KeyError('seat')", "raised KeyError: 'seat'", (), "out"),
        ("return None", "NoneType", ("--json",), "err"),
    ],
)
def test_an_agent_that_gives_no_action_is_told_with_the_reason(cli, tmp_path, act, said, more, told):
    name = f"none_{act[:5]}"
    (tmp_path / f"{name}.py").write_text(
        f"class Agent:\n    def reset(self, goal): ...\n    def act(self, seen): {act}\n"
    )
    ran = cli("run", *more, *GRID, "--agent", f"{name}:Agent", "--out", "out", "--most", "steps=2")
    (line,) = [line for line in getattr(ran, told).splitlines() if said in line]
    assert "gave no action in 2 steps, at first: " in line
    assert ran.out.count("gives no action") == (0 if more else 2)  # once as it runs and once afterwards


@pytest.mark.parametrize("act", ["os._exit(0)", "os.kill(os.getpid(), signal.SIGSEGV)"])
def test_an_agent_that_ends_the_process_of_its_run_is_told(program, tmp_path, act):
    (tmp_path / "ends.py").write_text(
        f"import os, signal\nclass Agent:\n    def reset(self, goal): ...\n    def act(self, seen): {act}\n"
    )
    words = (*PROGRAM, "run", "--json", *GRID, "--agent", "ends:Agent")
    run = program(*words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    out, told = run.communicate(timeout=240)
    assert (run.returncode, out) == (2, "")
    assert "error: the agent's code ended the run: its process " in told
