"""Runs the gates over tasks and seeds, in worker processes if wanted."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field

from automotive_cosim.contracts import Json
from automotive_cosim.errors import TriggerNotReachedError
from automotive_cosim.proof import gates
from automotive_cosim.proof.ground import Ground
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

GATES = (
    "oracle",
    "start",
    "prefix",
    "late",
    "undone",
    "near",
    "collateral",
    "trivial",
    "random",
    "leak",
    "road",
    "law",
    "repeat",
    "residue",
    "reach",
)
"""In the order of the table in ``gates``."""
SIMULATIONS = 16
"""Warm ones that a worker keeps: the shipped networks and some of them elsewhere on earth."""


@dataclass(slots=True)
class Proof:
    """What the gates say of one task with one seed."""

    task: str
    seed: int
    wrong: dict[str, list[str]] = field(default_factory=dict)
    """By gate that was tried; an empty list is a pass."""
    error: str = ""
    """What went wrong in the machinery, so that nothing is proven either way."""
    oracle_steps: dict[str, int] = field(default_factory=dict)
    """Actions of the expert by half, the declaration included."""
    seconds: dict[str, float] = field(default_factory=dict)
    """Wall time by gate."""

    def take(self, gate: str, wrong: Iterator[str], half: str = "") -> None:
        """Collects what a gate finds."""
        began = time.perf_counter()
        self.wrong.setdefault(gate, []).extend(f"{half}: {text}" if half else text for text in wrong)
        self.seconds[gate] = self.seconds.get(gate, 0.0) + time.perf_counter() - began


class Prover:
    """Proves one task after the other over warm simulations of its own."""

    def __init__(self, chosen: Sequence[str] = GATES) -> None:
        """Tries these gates."""
        self._chosen = frozenset(chosen)
        self._simulations = Simulations(count_limit=SIMULATIONS)
        self._before: tuple[str, str, int, str] | None = None
        """Task, half, seed and hash of the expert's episode that was proven last."""

    def prove(self, task_id: str, seed: int) -> Proof:
        """One task with one seed."""
        proof = Proof(task_id, seed)
        grounds: dict[str, Ground] = {}
        try:
            for half in CATALOGUE[task_id].halves:
                grounds[half] = Ground.reach(CATALOGUE[task_id], half, seed, self._simulations)
            for half, ground in grounds.items():
                self._prove_half(proof, half, ground)
            for gate in ("trivial", "law"):
                if gate in self._chosen:
                    proof.take(gate, getattr(gates, gate)(grounds))
            if "reach" in self._chosen:
                proof.take("reach", gates.reach(CATALOGUE[task_id], seed, self._simulations))
            if "residue" in self._chosen:
                proof.take("residue", self._residue(grounds["first"]))
        except TriggerNotReachedError as error:
            proof.take("reach", iter([str(error)]))
        except Exception as error:  # a fault in one task must not take the proof of the others with it
            proof.error = f"{type(error).__name__}: {error}"
        finally:
            for ground in grounds.values():
                ground.close()
        return proof

    def close(self) -> None:
        """Ends its simulations."""
        self._simulations.close()

    def _prove_half(self, proof: Proof, half: str, ground: Ground) -> None:
        right = ground.play(ground.oracle())
        proof.oracle_steps[half] = len(right.actions)
        for gate in ("oracle", "start", "prefix", "late", "random"):
            if gate in self._chosen:
                proof.take(gate, getattr(gates, gate)(ground), half)
        for gate in ("undone", "near", "collateral"):
            if gate in self._chosen and right.success:
                proof.take(gate, getattr(gates, gate)(ground, right), half)
        for gate in ("leak", "road", "repeat"):
            if gate in self._chosen:
                proof.take(gate, getattr(gates, gate)(ground, self._simulations), half)

    def _residue(self, ground: Ground) -> Iterator[str]:
        """The task before once more, now that this one has been at the same simulations."""
        if self._before is not None:
            task_id, half, seed, digest = self._before
            again = Ground.reach(CATALOGUE[task_id], half, seed, self._simulations)
            if gates.hash_of_oracle(again) != digest:
                yield f"{task_id} gives another trace after it"
            again.close()
        self._before = ground.task.id, ground.half_name, ground.seed, gates.hash_of_oracle(ground)


def prove(
    task_ids: Sequence[str],
    seeds: Sequence[int],
    chosen: Sequence[str] = GATES,
    *,
    workers: int = 1,
    tell: Callable[[Proof, int, int], None] = lambda proof, done, planned: None,
) -> list[Proof]:
    """Proves every task with every seed.

    Args:
        task_ids: of the catalogue.
        seeds: each is a traffic, a drive and a drawing of words and parameters.
        chosen: gates to try.
        workers: processes; the result does not depend on their number.
        tell: hears each proof as it comes, how many are done and how many there are.

    Returns:
        Sorted by task, in the catalogue's order, then seed.
    """
    groups = _groups(task_ids, seeds)
    planned, done = len(task_ids) * len(seeds), 0
    proofs: list[Proof] = []
    if workers == 1:
        for group in groups:
            for proof in _prove_group(group, chosen):
                done += 1
                tell(proof, done, planned)
                proofs.append(proof)
    else:
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(workers, mp_context=context) as pool:
            for future in as_completed([pool.submit(_listed, group, chosen) for group in groups]):
                for proof in future.result():
                    done += 1
                    tell(proof, done, planned)
                    proofs.append(proof)
    order = {task_id: number for number, task_id in enumerate(CATALOGUE)}
    return sorted(proofs, key=lambda proof: (order[proof.task], proof.seed))


def as_json(proofs: Sequence[Proof], task_ids: Sequence[str], seeds: Sequence[int]) -> Json:
    """All of it as one JSON object."""
    tried = [gate for gate in GATES if any(gate in proof.wrong for proof in proofs)]
    return {
        "tasks": len(task_ids),
        "seeds": list(seeds),
        "gates": {
            gate: {
                "checked": sum(gate in proof.wrong for proof in proofs),
                "failed": [
                    {"task": proof.task, "seed": proof.seed, "why": why}
                    for proof in proofs
                    for why in proof.wrong.get(gate, [])
                ],
            }
            for gate in tried
        },
        "seconds": {gate: round(sum(proof.seconds.get(gate, 0.0) for proof in proofs), 1) for gate in tried},
        "errors": [{"task": proof.task, "seed": proof.seed, "why": proof.error} for proof in proofs if proof.error],
        "oracle_steps": {
            proof.task: proof.oracle_steps for proof in proofs if proof.seed == seeds[0] and proof.oracle_steps
        },
    }


def _groups(task_ids: Sequence[str], seeds: Sequence[int]) -> list[list[tuple[str, int]]]:
    """Tasks that share a warm simulation, in pieces small enough to share out."""
    by_traffic: dict[tuple[str, int], list[tuple[str, int]]] = {}
    for seed in seeds:
        for task_id in task_ids:
            key = CATALOGUE[task_id].first.start.scenario, seed
            by_traffic.setdefault(key, []).append((task_id, seed))
    pieces = [jobs[at : at + PIECE] for jobs in by_traffic.values() for at in range(0, len(jobs), PIECE)]
    return sorted(pieces, key=len, reverse=True)


PIECE = 12


def _prove_group(jobs: Sequence[tuple[str, int]], chosen: Sequence[str]) -> Iterator[Proof]:
    prover = Prover(chosen)
    try:
        for task_id, seed in jobs:
            yield prover.prove(task_id, seed)
    finally:
        prover.close()


def _listed(jobs: Sequence[tuple[str, int]], chosen: Sequence[str]) -> list[Proof]:
    return list(_prove_group(jobs, chosen))
