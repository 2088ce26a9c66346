"""Proves many tasks with many seeds, in parallel and resumable."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.proof.prover import GATES, Proof, Prover, proof_id
from automotive_cosim.run.batch import BatchKind, Progress
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.executor import Job, Runner
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.store import Store
from automotive_cosim.tasks import CATALOGUE

PIECE = 12
"""Number of tasks of one simulation that a worker takes; each is also tried for residue of the one before."""
WALL_LIMIT_S = 3_600.0
"""Wall time that the proof of one task with one seed may take; a slow one takes a minute."""


@dataclass(frozen=True, slots=True)
class ProofPlan:
    """The plan of a proof: every task with every seed."""

    tasks: tuple[str, ...]
    """Ids, patterns, tags and so on, as for ``run.choosing.choose``."""
    seeds: tuple[int, ...]
    gates: tuple[str, ...] = GATES

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest; proofs of other files say nothing about these."""
        return {
            "tasks": list(self.tasks),
            "seeds": list(self.seeds),
            "gates": [gate for gate in GATES if gate in self.gates],
            "task_files": CATALOGUE.digest(),
        }

    def check(self) -> None:
        """Checks every name before anything runs. Raises UnknownNameError: no such gate, or no such task."""
        for gate in self.gates:
            if gate not in GATES:
                raise UnknownNameError("gate", gate, GATES)
        choose(self.tasks)

    def jobs(self) -> tuple[ProofJob, ...]:
        """Every task with every seed, grouped by simulation."""
        by_traffic: dict[tuple[str, int], list[str]] = {}
        for seed in self.seeds:
            for task_id in choose(self.tasks):
                by_traffic.setdefault((CATALOGUE[task_id].first.start.scenario, seed), []).append(task_id)
        return tuple(
            ProofJob(task_id, seed, (f"{scenario} {at // PIECE}", seed), task_ids[at - 1] if at % PIECE else "")
            for (scenario, seed), task_ids in by_traffic.items()
            for at, task_id in enumerate(task_ids)
        )


@dataclass(frozen=True, slots=True)
class ProofJob(Job):
    """One task with one seed."""

    task: str
    seed: int
    group: tuple[str, int]
    """Scenario, group of its tasks, and seed."""
    after: str
    """See ``Prover.prove``. It follows from the plan and not from what a worker has just done, so the distribution
    of jobs does not affect the result."""

    @property
    def simulation(self) -> tuple[str, int]:
        """Its group: an inherited property would be a field's default."""
        return self.group

    @property
    def wall_s(self) -> float:
        """Limit of its wall time."""
        return WALL_LIMIT_S

    @property
    def id(self) -> str:
        """The proof's name in results: task and seed."""
        return proof_id(self.task, self.seed)

    def planned(self) -> Proof:
        """Its row before anything is proven."""
        return Proof(id=self.id, task=self.task, seed=self.seed)


def prove(
    tasks: Sequence[str],
    seeds: Sequence[int],
    chosen: Sequence[str] = GATES,
    *,
    workers: int = 1,
    out: Path | None = None,
    begun: Callable[[int], None] = lambda planned: None,
    tell: Callable[[Proof, int, int], None] = lambda proof, done, planned: None,
) -> list[Proof]:
    """Proves every task with every seed; a proof that ends in an error is retried once.

    Args:
        tasks: ids of the catalogue, or anything else that ``run.choosing.choose`` accepts.
        seeds: each determines traffic, drive, phrasing and parameters.
        chosen: gates to try.
        workers: number of processes, which does not affect the result.
        out: folder of the proofs, from which the same call resumes; None keeps nothing.
        begun: called once with the number of proofs, before the first.
        tell: called with each proof as it ends, existing ones first, with the number done and the total.

    Returns:
        Sorted by task, in the catalogue's order, then seed.

    Raises:
        UserError: there is no such gate or task, or the folder cannot take the proofs.
        InfrastructureError: no worker becomes available.
        KeyboardInterrupt: passed on; only the running proofs are lost."""
    found: list[Proof] = []

    def rounds(plan: ProofPlan, store: Store[Proof]) -> Iterator[Sequence[ProofJob]]:
        jobs = plan.jobs()
        begun(len(jobs))
        kept = [proof for job in jobs if (proof := store.rows.get(job.id)) and proof.error is None]
        for done, proof in enumerate(kept, start=1):
            tell(proof, done, len(jobs))
        yield jobs
        found.extend(store.rows[job.id] for job in jobs)

    def heard(progress: Progress[Proof]) -> None:
        if progress.ended is not None:
            tell(progress.ended, progress.done, progress.planned)

    plan = ProofPlan(tuple(tasks), tuple(seeds), tuple(chosen))
    kind: BatchKind[ProofPlan, ProofJob, Proof] = BatchKind(Proof, partial(proofs, plan.gates), rounds=rounds)
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-proof-") as scratch:
        kind.run(plan, out or Path(scratch), executor=Processes(workers), tell=heard)
    order = {task_id: number for number, task_id in enumerate(CATALOGUE)}
    return sorted(found, key=lambda proof: (order[proof.task], proof.seed))


@contextmanager
def proofs(chosen: Sequence[str]) -> Iterator[Runner[ProofJob, Proof]]:
    """Makes the runner of proofs in a worker."""
    with closing(Prover(chosen)) as prover:
        # Only the row of a proof is kept.
        yield lambda job, folder: prover.prove(job.task, job.seed, job.after)
