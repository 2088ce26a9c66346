"""An evaluation on the small grid, and its bundle."""

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.publish.bundle import write_bundle
from automotive_cosim.run.executor import failed
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.store import opened
from automotive_cosim.run.worker import run_job
from automotive_cosim.traffic.fork import Simulations

TASKS = ["hvac_fan_max", "system_local_units"]
PLAN = make_plan({"agents": ["asurada", "no-op"], "tasks": TASKS, "scenarios": ["grid"], "limits": {"steps": 6}})


@pytest.fixture(scope="session")
def ran(tmp_path_factory: pytest.TempPathFactory, simulations: Simulations, fork_server: ForkServer) -> Path:
    """Five judged episodes and one that ended in an error; not to be changed."""
    folder = tmp_path_factory.mktemp("publish") / "e"
    jobs = PLAN.jobs()
    with opened(folder, PLAN.as_json(), EpisodeRow, planned=len(jobs)) as store:
        for job in jobs[:-1]:
            store.append(replace(run_job(job, folder, Pictures.NONE, simulations, fork_server), wall_seconds=1.5))
        why = "/home/anna/lab/agent.py: gone"
        store.append(replace(failed(jobs[-1], "WorkerDied", why), failed_attempts=(f"WorkerDied: {why}",)))
    return folder


@pytest.fixture
def folder(ran: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(ran, tmp_path / "e"))


@pytest.fixture(scope="session")
def packed(ran: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its bundle; not to be changed."""
    out = tmp_path_factory.mktemp("packed") / "e.bundle"
    write_bundle(ran, out)
    return out


@pytest.fixture
def unpacked(packed: Path, tmp_path: Path) -> Iterator[Path]:
    """Its files."""
    from automotive_cosim.publish import archive

    with archive.unpacked(packed) as found:
        yield Path(shutil.copytree(found, tmp_path / "unpacked"))
