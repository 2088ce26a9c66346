"""The command that proves tasks, on tasks of one's own on the grid: resumed, killed, with tasks that go wrong."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from automotive_cosim.errors import TrafficError
from automotive_cosim.proof import batch, gates, prover
from automotive_cosim.proof.batch import ProofPlan
from automotive_cosim.proof.prover import Proof, Prover
from automotive_cosim.run.store import read_rows

PROGRAM = (sys.executable, "-c", "from automotive_cosim.cli.main import main; main()", "tasks", "validate")
OWN = """
import os, time
from dataclasses import dataclass
from pathlib import Path
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.cockpit.signals import HVAC, SEAT
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import driving, Trigger

class Trouble:
    writes = frozenset({HVAC.SYNC.path})

class Waits(Trouble):
    def holds(self, start, now, trace):
        Path("reached").touch()
        while Path("wait").exists():
            time.sleep(0.1)
        return SignalIs(HVAC.SYNC, (False,)).holds(start, now, trace)

class Raises(Trouble):
    def holds(self, start, now, trace): raise RuntimeError("no such thing")

class Dies(Trouble):
    def holds(self, start, now, trace): os.kill(os.getpid(), 9)

def sync(name, goal, *more):
    words = tuple(f"{said} {name.replace('_', ' ')}" for said in ("Sync off.", "One each.", "Split it.", "Apart."))
    start = Start("grid", "avenue")
    ways = Open("climate"), Tap("hvac.sync"), *more
    trigger, deadline = Trigger(driving(), 3.0, 60.0), Deadline(60.0, "an errand")
    half = Half(start, trigger, goal, ways, deadline, Basis.WISH)
    return Task(name, Module.HVAC, Dimension.EXPLICIT_CONTROL, words, half, scenarios=("grid",))

RIGHT = SignalIs(HVAC.SYNC, (False,))
TASKS = (
    sync("own_one", RIGHT),
    sync("own_two", RIGHT),
    sync("own_waits", Waits()),
    sync("own_raises", Raises()),
    sync("own_dies", Dies()),
    sync("own_twice", RIGHT, Tap("hvac.sync")),
)
"""


def words(tasks, *more, only="oracle,start,residue"):
    return [*PROGRAM, "--tasks-from", "tasks", "--tasks", tasks, "--gates", only, *more]


@pytest.fixture
def command(tmp_path, monkeypatch):
    """The command's words, for an empty folder beside one with tasks."""
    (tmp_path / "tasks").mkdir()
    (tmp_path / "tasks" / "own.py").write_text(OWN)
    monkeypatch.chdir(tmp_path)
    return words


@pytest.fixture(scope="module")
def whole(sumo, tmp_path_factory):
    """Two tasks proven with two seeds by one worker: what was told, and the folder."""
    home = tmp_path_factory.mktemp("proven")
    (home / "tasks").mkdir()
    (home / "tasks" / "own.py").write_text(OWN)
    asked = words("own_one,own_two", "--seeds", "0-1", "--json", "--out", "whole")
    return subprocess.run(asked, cwd=home, capture_output=True, text=True, check=False), home / "whole"


@pytest.fixture
def validate(command, cli, own_tasks):
    """In this process, whose workers are forked from one that has imported everything."""

    def run(*words, **named):
        own_tasks(Path("tasks"))
        return cli(*command(*words, **named)[len(PROGRAM) - 2 :])

    return run


def told(out):
    return {name: value for name, value in json.loads(out).items() if name != "seconds"}


@pytest.mark.sumo
@pytest.mark.slow
def test_neither_workers_nor_a_stop_show_and_what_is_proven_is_not_proven_again(validate, whole, tmp_path):
    alone, folder = whole
    assert alone.returncode == 0, alone.stderr
    assert told(alone.stdout)["gates"].keys() == {"oracle", "start", "residue"}
    assert {entry["checked"] for entry in told(alone.stdout)["gates"].values()} == {4}
    head, *lines = alone.stderr.splitlines()
    assert head.startswith("4 proofs by 3 gates, ")
    assert [line.split()[1] for line in lines] == ["1/4", "2/4", "3/4", "4/4"]
    assert {path.name for path in folder.parent.iterdir()} == {"tasks", "whole"}
    shared = validate("own_one,own_two", "--seeds", "0-1", "--json", "--workers", "2")
    assert told(shared.out) == told(alone.stdout)
    assert {path.name for path in tmp_path.iterdir()} == {"tasks"}

    cut = tmp_path / "cut"
    cut.mkdir()
    (cut / "manifest.json").write_bytes((folder / "manifest.json").read_bytes())
    lines = (folder / "episodes.jsonl").read_bytes().splitlines(keepends=True)
    (cut / "episodes.jsonl").write_bytes(lines[0] + lines[1][:40])
    again = validate("own_one,own_two", "--seeds", "0-1", "--json", "--out", "cut")
    assert told(again.out) == told(alone.stdout)
    written = (cut / "episodes.jsonl").read_bytes().splitlines(keepends=True)
    assert written[0] == lines[0]
    assert len(written) == 4
    assert [line.split()[1] for line in again.err.splitlines()[1:]] == ["1/4", "2/4", "3/4", "4/4"]


@pytest.mark.sumo
@pytest.mark.slow
def test_another_plan_or_a_changed_task_wants_another_folder(validate, whole, tmp_path):
    _, folder = whole
    shutil.copytree(folder, tmp_path / "f")
    other = validate("own_one,own_two", "--seeds", "0", "--out", "f")
    assert other.code == 2
    assert "started with a different plan: seeds was [0, 1] and is [0]" in other.err
    (tmp_path / "tasks" / "own.py").write_text(OWN.replace("Split it.", "Part it."))
    changed = validate("own_one,own_two", "--seeds", "0-1", "--out", "f")
    assert (changed.code, changed.err.count("\n")) == (2, 1)
    assert "a different plan: task_files was" in changed.err
    assert len(read_rows(tmp_path / "f", Proof)) == 4


@pytest.mark.proof
@pytest.mark.long
@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize("how", ["kill", "ctrl-c"])
def test_however_it_is_ended_no_worker_is_left_and_the_command_goes_on(
    command, program, tmp_path, until, session, how
):
    (tmp_path / "wait").touch()
    words = command("own_one,own_waits", "--seeds", "0", "--workers", "2", "--out", "f", only="oracle,start")
    process = program(*words, stderr=subprocess.PIPE)
    lines = tmp_path / "f" / "episodes.jsonl"
    try:
        until(lambda: lines.is_file() and lines.read_bytes().endswith(b"\n") and (tmp_path / "reached").exists())
        assert len(session(process.pid)) > 2, "the task that waits has a worker and a simulation"
        if how == "kill":
            process.kill()
        else:
            os.killpg(process.pid, signal.SIGINT)
        until(lambda: not session(process.pid))
    finally:
        (tmp_path / "wait").unlink()  # so that what is left ends whatever came of it
        _, said = process.communicate()
    if how == "ctrl-c":
        assert process.returncode == 130
        assert "finished proofs are in f; rerun the command to resume" in said
        assert "Traceback" not in said
    kept = lines.read_bytes()
    again = subprocess.run(words, capture_output=True, text=True, check=False)
    assert again.returncode == 0, again.stderr
    assert lines.read_bytes().startswith(kept)
    assert read_rows(tmp_path / "f", Proof).keys() == {"own_one-seed0", "own_waits-seed0"}


@pytest.mark.sumo
def test_a_task_that_breaks_the_proof_costs_that_one_alone_and_is_tried_again(validate, tmp_path):
    ran = validate("own_one,own_raises,own_dies", "--seeds", "0", "--out", "f", only="oracle,start")
    assert ran.code == 3
    assert "own_raises, seed 0\n    RuntimeError: no such thing\n" in ran.err
    assert "own_dies, seed 0\n    the worker died with exit code -9\n" in ran.err
    assert ran.err.endswith("error: 2 of 3 proofs ended in an infrastructure error\n")
    assert re.search(r"3 tasks, 1 seed: 0 of \d+ gates failed, 2 errors\n$", ran.out)
    attempts = {row.task: row.attempts for row in read_rows(tmp_path / "f", Proof).values()}
    assert attempts == {"own_one": 1, "own_raises": 2, "own_dies": 2}


@pytest.mark.sumo
def test_a_gate_that_fails_is_told_beneath_its_task_and_sets_the_exit_code(validate):
    ran = validate("own_twice", "--seeds", "0", "--json")
    assert ran.code == 1
    _, first, *faults = ran.err.splitlines()
    assert first.endswith("1/1 own_twice, seed 0")
    (failed,) = told(ran.out)["gates"]["oracle"]["failed"]
    assert faults == [f"    oracle: {failed['why']}"]
    assert "goal" in failed["why"]


def test_pieces_go_together_and_each_task_comes_after_one_of_its_piece():
    jobs = ProofPlan(("all",), (0, 1)).jobs()
    assert len({job.id for job in jobs}) == len(jobs)
    pieces = {}
    for job in jobs:
        pieces.setdefault(job.simulation, []).append(job)
    assert max(map(len, pieces.values())) == batch.PIECE
    for piece in pieces.values():
        assert [job.after for job in piece] == ["", *(job.task for job in piece[:-1])]
        assert {job.seed for job in piece} == {piece[0].simulation[1]}


@pytest.fixture
def proving(monkeypatch):
    """Proves tasks of these names on the grid, all alike, whose reference solutions have the given trace hashes."""

    def make(hashes):
        given = iter(hashes)
        monkeypatch.setattr(prover.Ground, "reach", lambda task, half, seed, simulations: Standing(task, seed))
        monkeypatch.setattr(prover, "CATALOGUE", {"a": Named("a"), "b": Named("b")})
        monkeypatch.setattr(gates, "hash_of_oracle", lambda ground: next(given))
        monkeypatch.setattr(Prover, "_prove_half", lambda self, proof, half, ground: None)
        return Prover(("residue",))

    return make


class Named:
    halves = ("first",)

    def __init__(self, name):
        self.id = name


class Standing:
    def __init__(self, task, seed):
        self.task, self.seed = task, seed

    def close(self):
        pass


@pytest.mark.parametrize(("later", "wrong"), [("a1", []), ("a2", ["a gives another trace after it"])])
def test_what_a_task_leaves_is_seen_whether_or_not_the_other_was_proven_here(proving, later, wrong):
    here = proving(["a1", later, "b1"])
    assert here.prove("a", 0).wrong == {"residue": []}
    assert here.prove("b", 0, "a").wrong == {"residue": wrong}
    alone = proving(["a1", later, "b1"])
    assert alone.prove("b", 0, "a").wrong == {"residue": wrong}
    other_seed = proving(["a1", "a3", later.replace("1", "3"), "b1"])
    other_seed.prove("a", 1)
    assert other_seed.prove("b", 0, "a").wrong == {"residue": wrong}


def test_another_task_that_cannot_be_played_is_no_fault_of_this_one(proving):
    assert proving(["b1"]).prove("b", 0, "no_such_task").wrong == {"residue": []}


def test_a_simulation_that_dies_beforehand_proves_nothing(proving, monkeypatch):
    here = proving(["b1"])

    def dies(*_):
        raise TrafficError("the simulation died")

    monkeypatch.setattr(Prover, "_trace", dies)
    proof = here.prove("b", 0, "a")
    assert (proof.error, proof.wrong) == ("TrafficError: the simulation died", {})
