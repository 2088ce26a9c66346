"""``automotive-cosim tasks validate``: proves tasks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import TasksFrom, print_json, tells_json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.proof.settings import ProofSettings

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from automotive_cosim.proof.prover import Proof

FAILED = 1


@tells_json
@takes(ProofSettings)
def validate(tasks_from: TasksFrom = None, as_json: bool = False, **settings: Any) -> None:
    """Prove that tasks can be solved by public actions, cannot be solved by trivial strategies, and repeat exactly.

    Exit code 1 if a gate fails, else 3 if a proof could not be completed. With --out, rerun the command to resume.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.proof.batch import prove
    from automotive_cosim.proof.prover import GATES, changed_traces, read_traces
    from automotive_cosim.proof.prover import as_json as json_of
    from automotive_cosim.run.choosing import choose

    told = filled(ProofSettings, settings)
    chosen = GATES if told.gates == ("all",) else told.gates
    task_ids = choose(told.tasks, told.suite)
    if (part := told.part) is not None:
        asked, task_ids = len(task_ids), part.taken(task_ids)
        if not task_ids:
            raise UserError(
                f"--part {part.number}/{part.of} contains none of {counted(asked, 'task')}; give fewer parts"
            )
    before = None if told.against is None else read_traces(told.against)
    console = Console(stderr=True, markup=True)

    def tell(proof: Proof, done: int, planned: int) -> None:
        faults = [f"{gate}: {why}" for gate, found in proof.wrong.items() for why in found]
        faults += [proof.error] if proof.error else []
        mark = "[red]✗[/]" if faults else "[green]✓[/]"
        console.print(f"{mark} {done}/{planned} {proof.task}, seed {proof.seed}", highlight=False)
        for fault in faults:
            console.print(f"    {fault}", highlight=False, markup=False, soft_wrap=True)

    def begun(planned: int) -> None:
        console.print(
            f"{counted(planned, 'proof')} by {counted(len(chosen), 'gate')}, up to a minute each; "
            "each is reported when it ends",
            highlight=False,
            soft_wrap=True,
        )

    try:
        proofs = prove(task_ids, told.seeds, chosen, workers=told.workers, out=told.out, begun=begun, tell=tell)
    except KeyboardInterrupt:
        if told.out is not None:
            typer.echo(f"finished proofs are in {told.out}; rerun the command to resume", err=True)
        raise
    result = json_of(proofs, task_ids, told.seeds)
    changed = changed_traces(before, result["traces"]) if before is not None else ()
    for name in changed:
        console.print(f"[red]✗[/] {name}: its reference solution gives a different trace", highlight=False)
    if as_json:
        print_json(result)
    else:
        for line in _summary(proofs, chosen):
            typer.echo(line)
        failed = sum(bool(entry["failed"]) for entry in result["gates"].values())
        typer.echo(
            f"{counted(len(task_ids), 'task')}, {counted(len(told.seeds), 'seed')}: {failed} of "
            f"{counted(len(result['gates']), 'gate')} failed, {counted(len(result['errors']), 'error')}"
        )
    if changed or any(entry["failed"] for entry in result["gates"].values()):
        raise typer.Exit(FAILED)
    if result["errors"]:
        raise InfrastructureError(
            f"{len(result['errors'])} of {counted(len(proofs), 'proof')} ended in an infrastructure error"
        )


def _summary(proofs: Sequence[Proof], gates: Sequence[str]) -> Iterator[str]:
    """A line for each gate, then one for each task that is not proven, in no more than 80 columns each."""
    wide = max(map(len, gates))
    for gate in gates:
        tried = [proof.wrong[gate] for proof in proofs if gate in proof.wrong]
        passed = sum(not wrong for wrong in tried)
        said = f"{passed:,} of {counted(len(tried), 'proof')} passed" if tried else "nothing to test"
        yield f"{'ok  ' if passed == len(tried) else 'FAIL'}  {gate:<{wide}}  {said}"
    for task_id in dict.fromkeys(proof.task for proof in proofs):
        own = [proof for proof in proofs if proof.task == task_id]
        failed = [gate for gate in gates if any(proof.wrong.get(gate) for proof in own)]
        failed += ["not completed"] * any(proof.error for proof in own)
        if failed:
            yield f"{task_id}: {', '.join(failed)}"
