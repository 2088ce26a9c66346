"""Evaluations on a real Ray cluster of two nodes, both on this machine."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

import pytest

from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.run.batch import SPENT, run_plan
from automotive_cosim.run.job_row import steady as steady_part
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow
from automotive_cosim.run.settings import Budget, Pictures
from automotive_cosim.run.store import read_rows, stamp

pytest.importorskip("ray", reason="the extra `cluster` is not installed")
on_ray = pytest.importorskip("automotive_cosim.run.on_ray")  # before Ray, whose environment it sets
OnRay = on_ray.OnRay

pytestmark = [pytest.mark.long, pytest.mark.sumo, pytest.mark.slow]

AGENTS = """
import os, time

class Base:
    channels = ()
    def reset(self, goal): assert os.path.isfile(__file__) and "ray" in __file__, "not in its own copy"

class Dies(Base):
    def act(self, observation): os.kill(os.getpid(), 9)

class Hangs(Base):
    def act(self, observation): time.sleep(600)

class Slow(Base):
    def reset(self, goal):
        super().reset(goal)
        self.left = 3
    def act(self, observation):
        time.sleep(0.3)
        self.left -= 1
        if self.left == 0: return {"action_type": "status", "goal_status": "complete"}
        return {"action_type": "wait", "seconds": 1}
"""
TASKS = """
[own_fan]
is = { like = "asked", module = "hvac", deadline = "comfort", start = "paris_centre", trigger = ["driving", 3, 60] }
templates = "Fan to max. / Fan all the way up. / Full blast on the blower. / Highest setting. / Maximum air flow."
goal = "HVAC.FAN_SPEED = 100"
moves = "open climate; tap hvac.fan.max"
"""
OBJECT_STORE_BYTES = 80 * 1024**2
MARK = "COSIM_TEST_MARK"


def plan(*agents, **values):
    return make_plan({"agents": list(agents), "tasks": ["hvac_fan_max"], "scenarios": ["grid"]} | values)


def steady(folder):
    return {name: steady_part(row) for name, row in read_rows(folder, EpisodeRow).items()}


def files(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def marked(mark):
    """Command lines of the processes that were started under a mark and still run, by process id."""
    found = {}
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if f"{MARK}={mark}".encode() in (path / "environ").read_bytes().split(b"\0"):
                found[int(path.name)] = (path / "cmdline").read_text()
        except OSError:
            continue
    return {pid: words for pid, words in found.items() if words}


def until(true, within_s=150.0):
    end_s = time.monotonic() + within_s
    while not true():
        assert time.monotonic() < end_s, "did not come about"
        time.sleep(0.1)


@pytest.fixture(scope="module")
def ray_folder():
    """Ray's own files; its sockets take no long names."""
    folder = Path(tempfile.mkdtemp(prefix="r", dir="/tmp"))
    yield folder
    shutil.rmtree(folder)


@pytest.fixture(scope="module")
def cluster(ray_folder):
    """Two nodes of a CPU each; while they still run, nothing of ours is left on them."""
    from ray.cluster_utils import Cluster

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RAY_TMPDIR", str(ray_folder))
        patch.setenv(MARK, "cluster")
        node = {"num_cpus": 1, "object_store_memory": OBJECT_STORE_BYTES, "include_dashboard": False}
        made = Cluster(initialize_head=True, head_node_args=node)
        made.add_node(num_cpus=1, object_store_memory=OBJECT_STORE_BYTES)
    assert marked("cluster")
    yield made
    until(lambda: not [words for words in marked("cluster").values() if "automotive_cosim" in words])
    for pid in marked("cluster"):  # left to themselves, some of Ray's own take half a minute
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    made.shutdown()
    until(lambda: not marked("cluster"))


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A folder with an agent and a task of somebody's own, in which he works."""
    folder = tmp_path / "mine"
    (folder / "tasks").mkdir(parents=True)
    (folder / "mine.py").write_text(AGENTS)
    (folder / "tasks" / "own.toml").write_text(TASKS)
    monkeypatch.chdir(folder)
    return folder


@pytest.mark.proof
def test_the_rows_and_files_are_those_of_a_local_run(cluster, tmp_path):
    wanted = plan("oracle", "always-alert", seeds=[0, 1])
    with OnRay(cluster.address) as executor:
        assert executor.count == 2
        end = run_plan(wanted, tmp_path / "far", executor=executor, pictures=Pictures.FAILURES)
    assert end.done == end.planned == end.judged == end.ran == 4
    run_plan(wanted, tmp_path / "near", pictures=Pictures.FAILURES)
    assert steady(tmp_path / "far") == steady(tmp_path / "near")
    assert any((tmp_path / "far" / "pictures").iterdir())
    for part in ("traces", "pictures"):
        assert files(tmp_path / "far" / part) == files(tmp_path / "near" / part)


@pytest.mark.proof
def test_drives_on_ray_are_those_of_a_local_run(cluster, tmp_path):
    drive = {"drives": ["grid_january"], "agents": ["rule-perfect"], "seeds": [0], "settings": {"minutes": 2}}
    wanted = make_plan(drive)
    with OnRay(cluster.address) as executor:
        end = run_plan(wanted, tmp_path / "far", executor=executor)
    assert end.done == end.planned == end.judged == 1
    run_plan(wanted, tmp_path / "near", executor=Processes(1))
    far, near = (read_rows(tmp_path / name, DriveTrialRow) for name in ("far", "near"))
    assert {name: steady_part(row) for name, row in far.items()} == {
        name: steady_part(row) for name, row in near.items()
    }
    for part in ("traces",):
        assert files(tmp_path / "far" / part) == files(tmp_path / "near" / part)


@pytest.mark.proof
def test_a_budget_holds_over_the_nodes_of_a_cluster(cluster, tmp_path):
    wanted = plan("t3a", seeds=[0], repeats=2)  # both ask the model more than once, whichever asks first
    with OnRay(cluster.address) as executor:
        end = run_plan(wanted, tmp_path / "e", executor=executor, budget=Budget(tokens=1))
        assert "budget is spent" in end.stopped
        assert (end.judged, end.errors) == (0, 0)
        assert json.loads((tmp_path / "e" / SPENT).read_text())["tokens"] > 0
        end = run_plan(wanted, tmp_path / "e", executor=executor)
    assert (end.judged, end.stopped) == (2, "")


@pytest.mark.proof
def test_what_dies_or_hangs_on_a_node_costs_its_episode_alone(cluster, mine):
    with OnRay(cluster.address, sent=mine) as executor:
        end = run_plan(plan("oracle", "mine:Dies"), mine.parent / "e", executor=executor, retries=0)
        hangs = plan("mine:Hangs", limits={"agent_step_s": 1})
        run_plan(hangs, mine.parent / "hangs", executor=executor, retries=0)
    assert (end.planned, end.judged, end.successes, end.errors) == (2, 2, 1, 0)
    rows = [
        *read_rows(mine.parent / "e", EpisodeRow).values(),
        *read_rows(mine.parent / "hangs", EpisodeRow).values(),
    ]
    ends = {row.agent: row.end for row in rows}
    assert ends == {"oracle": "declared", "mine:Dies": "agent_failed", "mine:Hangs": "agent_failed"}


@pytest.mark.proof
def test_files_that_cannot_be_written_here_stop_the_run_and_the_command_goes_on(cluster, tmp_path):
    wanted = plan("oracle")
    blocked = tmp_path / "e" / "traces" / f"{wanted.jobs()[0].id}.jsonl.gz"
    blocked.mkdir(parents=True)
    with OnRay(cluster.address) as executor:
        with pytest.raises(UserError, match=r"cannot write to .* rerun the command to resume"):
            run_plan(wanted, tmp_path / "e", executor=executor)
        blocked.rmdir()
        assert run_plan(wanted, tmp_path / "e", executor=executor).successes == 1


@pytest.mark.proof
def test_a_node_that_is_lost_costs_only_its_running_episodes(cluster, mine):
    wanted = plan("mine:Slow", seeds=[0, 1], repeats=3)
    other = next(node for node in cluster.list_all_nodes() if not node.head)
    lost = []

    def tell(progress):
        if progress.ran == 2 and not lost:
            lost.append(progress.done)
            cluster.remove_node(other, allow_graceful=False)

    with OnRay(cluster.address, sent=mine) as executor:
        end = run_plan(wanted, mine.parent / "e", executor=executor, tell=tell)
        until(lambda: executor.count == 1)
    assert lost == [2]
    assert (end.planned, end.judged, end.errors, end.ran) == (6, 6, 0, 6)
    rows = read_rows(mine.parent / "e", EpisodeRow).values()
    failures = [failure for row in rows for failure in row.failed_attempts]
    assert len(failures) <= 1, "the node ran one episode at a time"
    assert all(failure.startswith("WorkerDied: ") for failure in failures)
    assert len({(row.seed, row.trace_sha256) for row in rows}) == 2


@pytest.mark.proof
def test_a_cluster_of_its_own_is_ended_by_ctrl_c_and_the_same_plan_goes_on(program, mine, ray_folder):
    code = "from automotive_cosim.cli.main import main; main()"
    arguments = ("--agents", "mine:Slow", "--scenarios", "grid", "--repeats", "3", "--out", "../e", "--json")
    arguments += ("--tasks", "own_fan", "--tasks-from", "tasks")
    far = ("--executor", "ray:.", "--workers", "1")
    process = program(
        sys.executable, "-c", code, "eval", *arguments, *far, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        env=os.environ | {"RAY_TMPDIR": str(ray_folder), MARK: "own"},
    )  # fmt: skip
    lines = mine.parent / "e" / "episodes.jsonl"
    until(lambda: process.poll() is not None or (lines.is_file() and lines.stat().st_size > 0))
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, ""), err
    assert "Traceback" not in err
    assert "rerun the command to resume" in err
    until(lambda: not marked("own"))
    kept = len(read_rows(mine.parent / "e", EpisodeRow))
    assert 1 <= kept < 3
    again = subprocess.run(
        [sys.executable, "-c", code, "eval", *arguments], capture_output=True, text=True, check=True
    )
    assert f'"planned": 3, "judged": 3, "successes": 0, "errors": 0, "ran": {3 - kept}' in again.stdout


def test_a_node_with_other_versions_is_refused():
    ours = stamp()
    on_ray._check_same("10.0.0.5", ours | {"git": None})
    theirs = ours | {"versions": ours["versions"] | {"libsumo": "1.0"}}
    with pytest.raises(UserError, match=r"node 10\.0\.0\.5 has libsumo 1\.0 and this machine .*; install the same"):
        on_ray._check_same("10.0.0.5", theirs)


@pytest.mark.parametrize("address", ["127.0.0.1:1", "nowhere", "ray://127.0.0.1:10001", "127.0.0.1:99999"])
def test_an_address_without_a_cluster_is_told_at_once(address):
    began_s = time.monotonic()
    with pytest.raises(SetupError, match=r"Ray cluster"):
        OnRay(address).__enter__()
    assert time.monotonic() - began_s < 20
