"""Runs the gates over tasks one by one."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import TrafficError, TriggerNotReachedError, UserError
from automotive_cosim.formats.files import read_json
from automotive_cosim.proof import gates
from automotive_cosim.proof.functions import functions_are_not_enough, functions_win
from automotive_cosim.proof.hand_over import Ground
from automotive_cosim.proof.house_rules import policy
from automotive_cosim.run.job_row import JobRow, Volatile
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.future import KnownDrives

GATES = (
    "oracle",
    "makes",
    "start",
    "world",
    "wording",
    "slip",
    "prefix",
    "late",
    "undone",
    "near",
    "coupled",
    "uncoupled",
    "optional",
    "effect",
    "knowable",
    "lawful",
    "policy",
    "functions",
    "trivial",
    "random",
    "leak",
    "road",
    "law",
    "sight",
    "lasting",
    "place",
    "repeat",
    "residue",
    "reach",
)
"""The gates, in the order of the table in ``gates``."""
SIMULATIONS = 16
"""Warm simulations that a worker keeps: the shipped networks, some of them also elsewhere on earth."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof(JobRow):
    """The result of the gates for one task with one seed; after an error, nothing is proven either way."""

    task: str
    seed: int
    wrong: dict[str, list[str]] = field(default_factory=dict)
    """Faults by gate that was tried; an empty list is a pass."""
    oracle_steps: dict[str, int] = field(default_factory=dict)
    """Number of actions of the reference solution by half, including the declaration."""
    traces: dict[str, str] = field(default_factory=dict)
    """SHA-256 of the reference solution's trace by half."""
    gate_seconds: Volatile[dict[str, float]] = field(default_factory=dict)
    """Wall time by gate."""


def proof_id(task_id: str, seed: int) -> str:
    """Id of the proof of a task with a seed."""
    return f"{task_id}-seed{seed}"


@dataclass(slots=True)
class _Findings:
    """The hand-overs of one proof, made when needed."""

    wrong: dict[str, list[str]] = field(default_factory=dict)
    oracle_steps: dict[str, int] = field(default_factory=dict)
    traces: dict[str, str] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def take(self, gate: str, wrong: Iterator[str], half: str = "") -> None:
        """Collects the faults that a gate finds."""
        began = time.perf_counter()
        self.wrong.setdefault(gate, []).extend(f"{half}: {text}" if half else text for text in wrong)
        self.seconds[gate] = self.seconds.get(gate, 0.0) + time.perf_counter() - began


class Prover:
    """Proves tasks one by one in warm simulations."""

    def __init__(self, chosen: Sequence[str] = GATES, simulations: Simulations | None = None) -> None:
        """Takes what it proves with.

        Args:
            chosen: the gates to try.
            simulations: warm ones, which the caller closes; by default its own."""
        self._chosen = frozenset(chosen)
        self._simulations = simulations or Simulations(count_limit=SIMULATIONS)
        self._owns_simulations = simulations is None
        self._known = KnownDrives(self._simulations)
        self._again = KnownDrives(self._simulations)
        """Whatever is known, driven a second time, to see whether it is the same."""
        self._last: tuple[str, int, str] | None = None
        """Task, seed and trace hash of the last reference solution."""

    def prove(self, task_id: str, seed: int, after: str = "") -> Proof:
        """Proves one task with one seed.

        Args:
            task_id: id in the catalogue.
            seed: determines traffic, drive, phrasing and parameters.
            after: another task, which must give the same trace after this one as before; empty skips this gate."""
        found = _Findings()
        broken: Exception | None = None
        grounds: dict[str, Ground] = {}
        try:
            before = self._trace_before(after, seed) if after and "residue" in self._chosen else ""
            for half in CATALOGUE[task_id].halves:
                grounds[half] = Ground.reach(CATALOGUE[task_id], half, seed, self._known)
            for half, ground in grounds.items():
                self._prove_half(found, half, ground)
            for gate in ("trivial", "law", "sight", "lasting", "place"):
                if gate in self._chosen:
                    found.take(gate, getattr(gates, gate)(grounds))
            if "knowable" in self._chosen:
                found.take("knowable", gates.parted(grounds))
            if "functions" in self._chosen:
                found.take("functions", functions_are_not_enough(grounds))
            if "reach" in self._chosen:
                found.take("reach", gates.reach(CATALOGUE[task_id], seed, self._known))
            if "residue" in self._chosen:
                found.take("residue", self._residue(after, before, grounds["first"]))
        except TriggerNotReachedError as error:
            found.take("reach", iter([str(error)]))
        except Exception as error:  # a fault in one task must not end the proof of the others
            broken = error
            self._forget()
        finally:
            for ground in grounds.values():
                ground.close()
        return Proof(
            id=proof_id(task_id, seed),
            task=task_id,
            seed=seed,
            wrong=found.wrong,
            oracle_steps=found.oracle_steps,
            traces=found.traces,
            gate_seconds=found.seconds,
            error=None if broken is None else f"{type(broken).__name__}: {broken}",
            error_kind=None if broken is None else type(broken).__name__,
        )

    def close(self) -> None:
        self._forget()
        if self._owns_simulations:
            self._simulations.close()

    def _prove_half(self, found: _Findings, half: str, ground: Ground) -> None:
        right = ground.reference
        found.oracle_steps[half] = len(right.actions)
        found.traces[half] = right.trace_sha256
        for gate in ("oracle", "makes", "start", "world", "wording", "slip", "prefix", "late", "random", "effect"):
            if gate in self._chosen:
                found.take(gate, getattr(gates, gate)(ground), half)
        for gate in ("undone", "near", "coupled", "uncoupled", "optional", "knowable", "lawful"):
            if gate in self._chosen and right.success:
                found.take(gate, getattr(gates, gate)(ground, right), half)
        if "policy" in self._chosen:
            found.take("policy", policy(ground), half)
        if "functions" in self._chosen and right.success:
            found.take("functions", functions_win(ground), half)
        for gate, drives in (("leak", self._known), ("road", self._known), ("repeat", self._again)):
            if gate in self._chosen:
                found.take(gate, getattr(gates, gate)(ground, drives), half)

    def _forget(self) -> None:
        """Forgets all drives, one of which may be broken."""
        self._known.close()
        self._again.close()

    def _trace_before(self, task_id: str, seed: int) -> str:
        """The trace hash of a task's reference solution; empty if it cannot be played."""
        if self._last is not None and self._last[:2] == (task_id, seed):
            return self._last[2]
        try:
            return self._trace(task_id, seed)
        except TrafficError:
            raise
        except Exception:  # a fault in one task must not end the proof of the others
            return ""

    def _residue(self, after: str, before: str, ground: Ground) -> Iterator[str]:
        """Plays the other task again, now that this one has used the same simulations."""
        if before and self._trace(after, ground.seed) != before:
            yield f"{after} gives another trace after it"
        self._last = ground.task.id, ground.seed, gates.hash_of_oracle(ground)

    def _trace(self, task_id: str, seed: int) -> str:
        with closing(Ground.reach(CATALOGUE[task_id], "first", seed, self._again)) as ground:
            return gates.hash_of_oracle(ground)


def read_traces(path: Path) -> Mapping[str, str]:
    """The traces that ``tasks validate --json`` printed: a SHA-256 by task, half and seed.

    Raises UserError: the file cannot be read, or has none."""
    try:
        traces = read_json(path)["traces"]
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise UserError(
            f"cannot read traces from {path}: {error}; give the output of `automotive-cosim tasks validate --json`"
        ) from error
    if not isinstance(traces, dict) or not all(isinstance(sha256, str) for sha256 in traces.values()):
        raise UserError(f"{path} has no traces; give the output of `automotive-cosim tasks validate --json`")
    return traces


def changed_traces(before: Mapping[str, str], now: Mapping[str, str]) -> tuple[str, ...]:
    """Names of the traces that differ from those on record, in order; one that is not on record is no change."""
    return tuple(name for name, sha256 in sorted(now.items()) if before.get(name, sha256) != sha256)


def as_json(proofs: Sequence[Proof], task_ids: Sequence[str], seeds: Sequence[int]) -> Json:
    """The proofs as one JSON object."""
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
        "seconds": {gate: round(sum(proof.gate_seconds.get(gate, 0.0) for proof in proofs), 1) for gate in tried},
        "errors": [{"task": proof.task, "seed": proof.seed, "why": proof.error} for proof in proofs if proof.error],
        "traces": {
            f"{proof.task}/{half}/{proof.seed}": sha256 for proof in proofs for half, sha256 in proof.traces.items()
        },
        "oracle_steps": {
            proof.task: proof.oracle_steps for proof in proofs if proof.seed == seeds[0] and proof.oracle_steps
        },
    }
