"""Evaluations without workers: what is tested is not the processes."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from automotive_cosim.run.budget import Spent
from automotive_cosim.run.executor import JobPhase
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.settings import Budget, Pictures
from automotive_cosim.run.worker import run_job
from automotive_cosim.traffic.fork import Simulations


@dataclass
class Here:
    """Runs trials in this process, on warm traffic that is there already: an executor, and its one worker."""

    simulations: Simulations
    fork_server: ForkServer
    folder: Path = Path()
    job: Any = None
    count: int = 1
    is_ready: bool = True
    phase: JobPhase = field(default_factory=JobPhase)

    @property
    def handles(self) -> list[Any]:
        return [0]

    def metered(self, budget: Budget, before: Spent) -> Any:
        return Processes().metered(budget, before)

    def start(self, opener: Any, folder: Path) -> Any:
        self.folder = folder
        return self

    def wait(self, handles: Any, timeout_s: float) -> Any:
        return handles

    def give(self, job: Any) -> None:
        self.job = job

    def answer(self) -> Any:
        return run_job(self.job, self.folder, Pictures.NONE, self.simulations, self.fork_server)

    def end(self, *, at_once: bool) -> None:
        pass
