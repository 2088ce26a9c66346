"""A process that runs jobs for a batch, one after the other; those of an evaluation share warm simulations."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import dataclass
from multiprocessing import connection, parent_process
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.agents.settings import geo_input
from automotive_cosim.contracts import Json
from automotive_cosim.errors import CosimError
from automotive_cosim.run.collect import Collector, Pictures, failed
from automotive_cosim.run.episode import run_episode
from automotive_cosim.run.moments import write_judged
from automotive_cosim.run.plan import Job
from automotive_cosim.run.store import write_trace
from automotive_cosim.traffic.fork import Simulations

WARM = 2
"""Simulations that a worker keeps; the episodes come sorted, so that one is in use and one may come back."""


@dataclass(frozen=True, slots=True)
class CannotWrite:
    """Says that the results cannot be kept: everything has to stop."""

    error: OSError


Runner = Callable[[Any], Json]
"""Runs a job and returns its row, whatever went wrong; OSError if something cannot be written."""

Opener = Callable[[], AbstractContextManager[Runner]]
"""Makes a worker's runner; it is sent to the worker, so it is a function of a module or a partial of one."""


def work(jobs: Connection, opener: Opener) -> None:
    """Answers each job with its row, until None comes.

    Ctrl-C is the parent's to handle; when the parent is gone, this process ends at once.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with opener() as run:
        while (job := jobs.recv()) is not None:
            try:
                answer: Json | CannotWrite = run(job)
            except OSError as error:
                answer = CannotWrite(error)
            jobs.send(answer)


@contextmanager
def episodes(folder: Path, pictures: Pictures) -> Iterator[Runner]:
    """What runs the jobs of an evaluation."""
    with closing(Simulations(count_limit=WARM)) as simulations:
        yield lambda job: run_job(job, folder, pictures, simulations)


def run_job(job: Job, folder: Path, pictures: Pictures, simulations: Simulations) -> Json:
    """Runs one episode, keeps its trace and pictures, and returns its row; an error becomes a row too.

    Raises:
        OSError: trace or pictures cannot be written.
    """
    setup, began_s = job.setup, time.perf_counter()
    collector = Collector(pictures)
    settings = AgentSettings(geo_input(setup.geo), seed=setup.seed, most_tokens=job.limits.tokens)
    try:
        agent = make_agent(setup.agent, job.model, settings)
        result = run_episode(setup, agent, (collector,), simulations=simulations)
    except CosimError as error:
        row = failed(job, type(error).__name__, str(error))
    except Exception as error:
        # A fault in an agent or in here must not take the evaluation with it; it is counted and listed.
        row = failed(job, type(error).__name__, f"{type(error).__name__}: {error}")
    else:
        row = collector.row(job, result)
        if lines := collector.trace(result):
            write_trace(folder, job.id, lines)
            if judged := collector.judged():
                write_judged(folder, job.id, judged)
            collector.keep_pictures(folder / "pictures" / job.id, result)
    return row | {"wall_seconds": round(time.perf_counter() - began_s, 3)}


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
