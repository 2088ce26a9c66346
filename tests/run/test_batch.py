"""Evaluations on the small grid, with agents that die, hang and raise."""

import errno
import os
import sys
import time
from collections import Counter
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from functools import partial

import pytest

from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.interface.trace import sha256
from automotive_cosim.run import batch
from automotive_cosim.run.batch import run_jobs, run_plan
from automotive_cosim.run.executor import LostError
from automotive_cosim.run.job_row import steady as steady_part
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.queue import JobQueue
from automotive_cosim.run.regrade import regrade
from automotive_cosim.run.road import read_record
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.store import opened, read_rows, read_trace, trace_file
from automotive_cosim.run.trial_folder import pictures, read_steps, read_trial
from automotive_cosim.run.worker import run_job, run_with, trials
from automotive_cosim.tasks import CATALOGUE
from tests.here import Here
from tests.preloaded import ADDRESS

TROUBLE = """
import gc, os, pathlib, sys, time
NOUNS = ("Instance", "EpisodeSetup", "HandOver")
from automotive_cosim.errors import ModelError, TriggerNotReachedError

class Base:
    channels = ()
    def reset(self, goal):
        self.tries = pathlib.Path(__file__).with_name("tries")
        with self.tries.open("a") as file:
            file.write("x")

class Dies(Base):
    def act(self, observation): os.kill(os.getpid(), 9)

class KillsWorker(Base):
    def act(self, observation):
        fork_server = pathlib.Path("/proc", str(os.getppid()), "stat").read_text()
        os.kill(int(fork_server.rpartition(")")[2].split()[1]), 9)
        time.sleep(600)

class KillsWorkerOnce(KillsWorker):
    def act(self, observation):
        once = self.tries.with_name("once")
        if not once.exists():
            once.touch()
            super().act(observation)
        return {"action_type": "status", "goal_status": "complete"}

class Looks(Base):
    def act(self, observation):
        pid, found = os.getpid(), ""
        for _ in range(3):  # itself, what forked it, and the worker
            process = pathlib.Path("/proc", str(pid))
            found += (process / "cmdline").read_text() + (process / "environ").read_text()
            pid = (process / "stat").read_text().rpartition(")")[2].split()[1]
        known = [word for word in ("system_local_units", "trouble:Looks") if word in found]
        return {"action_type": "answer", "text": f"{len(found) > 1000} {known}"}

class Cheats(Base):
    def act(self, observation):
        return {"action_type": "status", "goal_status": "not_needed" if self.knows() else "complete"}

class Counts(Cheats):
    heard = {}
    def reset(self, goal): self.heard[goal] = self.heard.get(goal, 0) + 1
    def knows(self): return max(self.heard.values()) > 1

class Walks(Cheats):
    def knows(self):
        frame, found = sys._getframe(), gc.get_objects()
        while frame is not None:
            found += frame.f_locals.values()
            frame = frame.f_back
        return any(getattr(each, "half", None) is not None for each in found if type(each).__name__ in NOUNS)

class Blames(Base):
    def act(self, observation): raise TriggerNotReachedError("nobody gets here")

class BlamesModel(Base):
    def __init__(self): raise ModelError("no answer")
    def act(self, observation): ...

class Hangs(Base):
    def act(self, observation): time.sleep(600)

class Waits(Base):
    def act(self, observation): return {"action_type": "wait", "seconds": 5}

class Held(Base):
    # from the third episode on, as long as the file `hold` is there
    def reset(self, goal):
        super().reset(goal)
        self.number = self.tries.stat().st_size
    def act(self, observation):
        while self.number > 2 and self.tries.with_name("hold").exists(): time.sleep(0.05)
        return {"action_type": "wait", "seconds": 1}
"""


def plan(*agents, **values):
    return make_plan({"agents": list(agents), "tasks": ["hvac_fan_max"], "scenarios": ["grid"]} | values)


def steady(folder):
    return {name: steady_part(row) for name, row in read_rows(folder, EpisodeRow).items()}


@pytest.fixture
def trouble(tmp_path, monkeypatch):
    (tmp_path / "trouble.py").write_text(TROUBLE)
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    sys.modules.pop("trouble", None)


def tries(folder):
    return len((folder / "tries").read_text())


@pytest.mark.sumo
@pytest.mark.slow
def test_order_and_number_of_workers_do_not_show(tmp_path, monkeypatch):
    wanted = plan("oracle", "asurada", tasks=["hvac_fan_max", "system_local_units"], seeds=[0, 1])
    alone = run_plan(wanted, tmp_path / "one")
    assert alone.done == alone.planned == alone.judged == 12
    jobs = type(wanted).jobs
    monkeypatch.setattr(type(wanted), "jobs", lambda self: jobs(self)[::-1])
    run_plan(wanted, tmp_path / "two", executor=Processes(2))
    assert steady(tmp_path / "one") == steady(tmp_path / "two")
    before = (tmp_path / "one" / "episodes.jsonl").read_bytes()
    assert run_plan(wanted, tmp_path / "one").ran == 0
    assert (tmp_path / "one" / "episodes.jsonl").read_bytes() == before
    for row in read_rows(tmp_path / "one", EpisodeRow).values():
        *steps, result = read_trace(tmp_path / "one", row.id)
        assert sha256(steps) == row.trace_sha256 == result["result"]["trace_sha256"]
        assert len(steps) == row.steps + 1
        assert (
            trace_file(tmp_path / "one", row.id).read_bytes() == trace_file(tmp_path / "two", row.id).read_bytes()
        )


@pytest.mark.sumo
def test_while_the_first_jobs_wait_for_their_traffic_that_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(batch, "TELL_S", 0.05)
    told = []
    run_plan(plan("oracle"), tmp_path / "e", tell=told.append)
    first, *between, last = told
    assert (first.doing, last.doing) == ((), ())
    assert {(each.done, each.ended) for each in between} == {(0, None)}
    stages = list(dict.fromkeys(words.partition(",")[0] for each in between for words in each.doing if words))
    assert stages == ["loading grid", "warming up traffic", "driving to the hand-over", "agent at work"]
    assert last.ended is not None


@pytest.mark.sumo
@pytest.mark.slow
def test_a_worker_that_dies_again_and_again_costs_its_episode_alone_and_one_that_died_once_nothing(trouble):
    agents = ("oracle", "trouble:KillsWorker", "trouble:KillsWorkerOnce")
    end = run_plan(plan(*agents), trouble / "e", retries=1)
    assert (end.planned, end.judged, end.successes, end.errors) == (3, 2, 1, 1)
    assert tries(trouble) == 4
    rows = {row.agent: row for row in read_rows(trouble / "e", EpisodeRow).values()}
    again, once = (rows[name] for name in agents[1:])
    assert (again.success, again.error_kind) == (None, "WorkerDied")
    assert (again.attempts, len(again.failed_attempts)) == (2, 2)
    assert (once.attempts, len(once.failed_attempts)) == (2, 1)
    assert "WorkerDied" in once.failed_attempts[0]


@pytest.mark.sumo
def test_what_an_agent_does_is_its_own_failure_and_nobody_elses_error(trouble):
    bad = ("Dies", "Hangs", "Blames", "BlamesModel")
    limits = {"steps": 3, "agent_step_s": 1}
    wanted = plan("oracle", *(f"trouble:{name}" for name in bad), limits=limits)
    with pytest.raises(UserError, match="ModelError"):
        wanted.check()
    with opened(trouble / "e", wanted.as_json(), EpisodeRow) as store:
        end = run_jobs(wanted.jobs(), store, partial(trials, Pictures.NONE))
    assert (end.judged, end.successes, end.errors) == (5, 1, 0)
    assert tries(trouble) == 3, "none was tried twice"
    ends = {row.agent: (row.end, row.agent_error) for row in read_rows(trouble / "e", EpisodeRow).values()}
    assert ends["oracle"] == ("declared", None)
    assert ends["trouble:Blames"] == ("out_of_steps", None)
    assert ends["trouble:Dies"] == ("agent_failed", "its process was killed by SIGKILL")
    assert ends["trouble:Hangs"] == ("agent_failed", "its process took over 1 s for one step")
    assert ends["trouble:BlamesModel"][0] == "agent_failed"
    assert not any(each.differs or each.problem for each in regrade(trouble / "e"))


@pytest.mark.sumo
@pytest.mark.slow
def test_agents_that_count_or_look_around_never_know_the_second_half_nor_the_job(trouble, monkeypatch):
    for name in ("PYTEST_CURRENT_TEST", ADDRESS):
        monkeypatch.delenv(name)
    agents = ("trouble:Counts", "trouble:Walks", "trouble:Looks")
    end = run_plan(plan(*agents, tasks=["system_local_units"], limits={"steps": 1}), trouble / "e")
    assert (end.judged, end.successes) == (6, 0)
    for row in read_rows(trouble / "e", EpisodeRow).values():
        action = read_trace(trouble / "e", row.id)[1]["action"]
        if row.agent == "trouble:Looks":
            assert action["text"] == "True []"
        else:
            assert action["goal_status"] == "complete"


@pytest.mark.sumo
def test_an_episode_that_takes_too_long_is_ended_when_its_wall_time_is_over(trouble):
    began_s = time.monotonic()
    run_plan(plan("oracle", limits={"wall_s": 0.01, "agent_s": 0.01, "model_s": 0.01}), trouble / "e", retries=0)
    assert time.monotonic() - began_s < 60
    (row,) = read_rows(trouble / "e", EpisodeRow).values()
    assert (row.error_kind, row.success) == ("WallTime", None)


def test_steps_simulated_time_and_tokens_are_limited_and_judged(trouble, simulations, fork_server):
    def ran(agent, **limits):
        (job,) = plan(agent, limits=limits).jobs()
        return run_job(job, trouble, Pictures.NONE, simulations, fork_server)

    ends = [ran("trouble:Waits", steps=3), ran("trouble:Waits", sim_s=12), ran("asurada", tokens=10)]
    assert [(row.end, row.success) for row in ends] == [
        ("out_of_steps", False), ("out_of_time", False), ("out_of_budget", False),
    ]  # fmt: skip
    assert [row.steps for row in ends[:2]] == [3, 3]
    assert ends[1].sim_seconds == 15.0


def test_a_trigger_out_of_reach_is_sought_once_for_all_contestants_and_never_again(
    tmp_path, simulations, fork_server, monkeypatch
):
    task, far = CATALOGUE["system_local_units"], CATALOGUE["road_speed_80_in_50"].half("second").trigger
    second = replace(task.half("second"), trigger=replace(far, within_s=5.0))
    monkeypatch.setitem(CATALOGUE._tasks, task.id, replace(task, second=second))
    here, there = Here(simulations, fork_server), {"tasks": [task.id], "limits": {"steps": 2}}
    both = plan("no-op", "always-alert", **there)
    end = run_plan(both, tmp_path / "both", retries=5, executor=here)
    assert (end.planned, end.done, end.judged, end.ran, end.errors) == (4, 4, 2, 4, 2)
    rows = [row for row in read_rows(tmp_path / "both", EpisodeRow).values() if row.half == "second"]
    assert sorted(row.wall_seconds > 0 for row in rows) == [False, True]
    assert {(row.success, row.error_kind, row.attempts) for row in rows} == {(None, "TriggerNotReachedError", 1)}
    assert run_plan(both, tmp_path / "both", executor=here).ran == 0
    run_plan(plan("no-op", **there), tmp_path / "alone", executor=here)
    assert steady(tmp_path / "alone").items() <= steady(tmp_path / "both").items()


def test_pictures_are_kept_by_choice(tmp_path, simulations, fork_server):
    jobs = plan("oracle", "always-alert").jobs()
    for choice, count in ((Pictures.NONE, 0), (Pictures.FAILURES, 1), (Pictures.ALL, 2)):
        (tmp_path / choice / "traces").mkdir(parents=True)
        steps = {job.id: run_job(job, tmp_path / choice, choice, simulations, fork_server).steps for job in jobs}
        kept = list((tmp_path / choice / "pictures").glob("*"))
        assert len(kept) == count
        for folder in kept:
            lines = read_steps(folder)
            assert len(lines) == steps[folder.name] + 1
            assert {path.stem for path in pictures(folder)} == {f"step_{line['picture']:03d}" for line in lines}
            assert read_trial(folder)["row"]["id"] == folder.name
            assert read_record(folder / "road.jsonl.gz").seconds[-1].at_s >= steps[folder.name]


@pytest.mark.sumo
def test_a_disk_that_is_full_stops_the_run_and_the_command_goes_on(tmp_path, monkeypatch):
    (tmp_path / "e" / "traces").mkdir(parents=True)
    if os.geteuid() == 0:
        # root writes anywhere, but not into a folder that is a file
        wanted = plan("oracle")
        (tmp_path / "e" / "traces" / f".{wanted.jobs()[0].id}.jsonl.gz.lock").mkdir()
    else:
        (tmp_path / "e" / "traces").chmod(0o500)
    with pytest.raises(UserError, match=r"cannot write to .* rerun the command to resume"):
        run_plan(plan("oracle"), tmp_path / "e")
    for left in (tmp_path / "e" / "traces").iterdir():
        left.rmdir()
    (tmp_path / "e" / "traces").chmod(0o700)
    assert run_plan(plan("oracle"), tmp_path / "e").successes == 1


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EACCES])
def test_a_disk_that_is_full_within_a_trial_is_no_error_of_that_trial(tmp_path, code):
    @contextmanager
    def agent():
        raise OSError(code, os.strerror(code))
        yield

    job = plan("oracle").jobs()[0]
    with pytest.raises(OSError, match="No space") if code == errno.ENOSPC else nullcontext():
        assert run_with(agent(), job, tmp_path, Pictures.NONE, None).error_kind == "PermissionError"


@pytest.mark.sumo
@pytest.mark.slow
def test_a_kill_loses_at_most_the_running_episodes(program, trouble, until, session):
    wanted = plan("trouble:Held", seeds=[0, 1], repeats=2, limits={"steps": 2})
    script = (
        "import sys, pathlib; from automotive_cosim.run.batch import run_plan\n"
        "from automotive_cosim.run.plan import make_plan\n"
        "from automotive_cosim.run.processes import Processes\n"
        f"run_plan(make_plan({wanted.as_json()!r}), pathlib.Path('e'), executor=Processes(2))"
    )
    lines = trouble / "e" / "episodes.jsonl"
    (trouble / "go.py").write_text(f"if __name__ == '__main__':\n    {script.replace(chr(10), chr(10) + '    ')}\n")
    (trouble / "hold").touch()
    process = program(sys.executable, "go.py", cwd=trouble)
    until(lambda: lines.is_file() and lines.read_bytes().count(b"\n") >= 2 and tries(trouble) > 2)
    process.kill()
    process.wait()
    until(lambda: not session(process.pid))
    (trouble / "hold").unlink()
    kept = read_rows(trouble / "e", EpisodeRow)
    assert len(kept) == 2
    before = tries(trouble)
    end = run_plan(wanted, trouble / "e", executor=Processes(2))
    assert end.judged == 4
    assert end.ran == 2
    assert tries(trouble) - before == end.ran
    assert before - len(kept) <= 2
    run_plan(wanted, trouble / "whole")
    assert steady(trouble / "e") == steady(trouble / "whole")


def test_workers_take_what_they_have_warm_and_share_only_what_is_long():
    wanted = plan("oracle", scenarios=["grid"], seeds=[0, 1], repeats=3).jobs()
    queue = JobQueue(wanted)
    first = queue.take(None, Counter(), ())
    assert first is not None
    busy = Counter([first.simulation])
    second = queue.take(None, busy, ())
    assert second is not None
    assert second.simulation != first.simulation
    third = queue.take(first.simulation, busy, ())
    assert third is not None
    assert third.simulation == first.simulation
    assert queue.take(None, Counter(job.simulation for job in wanted), ()) is None


def test_kinds_that_were_not_timed_go_first_to_a_warm_simulation_and_last_to_a_cold_one():
    wanted = plan("always-alert", "no-op", "oracle", scenarios=["grid"], repeats=2).jobs()
    queue, timed = JobQueue(wanted), {wanted[0].kind}
    cold = queue.take(None, Counter(), timed)
    assert cold is not None
    assert cold.kind in timed
    warm = [queue.take(cold.simulation, Counter(), timed) for _ in range(5)]
    assert [job is not None and job.kind in timed for job in warm] == [False] * 4 + [True]
    assert not queue


def test_wherever_a_run_stops_the_contestants_of_all_but_one_instance_are_complete():
    wanted = plan("always-alert", "no-op", "oracle", scenarios=["grid"], seeds=[0, 1], repeats=3).jobs()
    queue, done, warm = JobQueue(wanted), Counter(), None
    while job := queue.take(warm, Counter(), {each.kind for each in wanted}):
        warm = job.simulation
        done[job.instance] += 1
        assert sum(judged < 3 for judged in done.values()) <= 1
    assert len(done) * 3 == len(wanted)


class Poor:
    """An executor whose workers never become ready, or are lost before they do."""

    count = 2
    is_ready = False

    def __init__(self, *, loses):
        self.loses, self.started, self.ended, self.waited_s = loses, 0, 0, []

    def metered(self, budget, before):
        return nullcontext()

    def start(self, opener, folder):
        self.started += 1
        return self

    @property
    def handles(self):
        return [object()]

    def wait(self, handles, timeout_s):
        self.waited_s.append(timeout_s)
        return handles[:1] if self.loses else []

    def answer(self):
        raise LostError("its node is gone")

    def end(self, *, at_once):
        self.ended += 1


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("loses", "said", "started"), [(False, "became ready in 600 s", 2), (True, "its node is gone", 7)]
)
def test_workers_that_never_get_ready_end_the_run_and_the_command_goes_on(tmp_path, loses, said, started):
    poor = Poor(loses=loses)
    with pytest.raises(InfrastructureError, match=f"{said}.*; rerun the command to resume"):
        run_plan(plan("oracle"), tmp_path / "e", executor=poor)
    assert (poor.started, poor.ended) == (started, started)
    assert all(300 < each_s < 601 for each_s in poor.waited_s), "a busy machine takes some of the 600 s"
    assert not read_rows(tmp_path / "e", EpisodeRow)
    assert run_plan(plan("oracle"), tmp_path / "e").successes == 1
