"""``automotive-cosim tasks``: lists, shows and proves the catalogue."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Annotated

import typer

from automotive_cosim.cli.options import SuiteName, TaskNames, print_json, tells_json
from automotive_cosim.cli.validate import validate
from automotive_cosim.contracts.plain import counted

if TYPE_CHECKING:
    from automotive_cosim.tasking.task import Task

app = typer.Typer(help="List, show and prove tasks.", no_args_is_help=True)
app.command("validate")(validate)


@app.command("list")
@tells_json
def list_(tasks: TaskNames = "all", suite: SuiteName = "standard", as_json: bool = False) -> None:
    """List the tasks, one per line, then their counts by module and dimension, and in the hard suite by ability."""
    from automotive_cosim.run.difficulty import hardest, level, rated

    chosen = _chosen(tasks, suite)
    if as_json:
        print_json([rated(task) for task in chosen])
        return
    width = max(len(task.id) for task in chosen)
    for task in chosen:
        halves = "pair" if task.second else "single"
        steps = counted(task.optimal_steps, "step")
        ability = "" if task.ability is None else f"{task.ability:<9}  "
        typer.echo(
            f"{task.id:<{width}}  {halves:<6}  {task.dimension:<18}  {level(hardest(task)):<23}  {ability}{steps}"
        )
    typer.echo(f"\n{_cells(chosen)}\n{_abilities(chosen)}{_instances(chosen)}")


@app.command()
@tells_json
def show(
    task: Annotated[str, typer.Argument(help="Id of the task.", show_default=False)], as_json: bool = False
) -> None:
    """Show what the driver says, when the task starts, and what is right."""
    from automotive_cosim.proof import trail
    from automotive_cosim.run import difficulty
    from automotive_cosim.tasking.words import choices_in_words, half_in_words
    from automotive_cosim.tasks import CATALOGUE

    entry = CATALOGUE[task]
    halves = {name: [*half_in_words(entry.half(name)), *trail.of_half(entry, name)] for name in entry.halves}
    if as_json:
        print_json(difficulty.rated(entry) | {"trail": list(trail.of_task(entry)), "halves": halves})
        return
    steps = counted(entry.optimal_steps, "step")
    kind = f"{entry.suite} suite, {entry.module}, {entry.dimension}, {entry.subset}"
    typer.echo(f"{entry.id}  ({kind}, {difficulty.level(difficulty.hardest(entry))}, {steps})")
    for words in entry.templates:
        typer.echo(f"  “{words}”")
    for name, choices in entry.parameters.items():
        said = choices_in_words(choices)
        typer.echo(f"  {{{name}}}: {said}")
    if entry.ability is not None:
        typer.echo(f"ability     {entry.ability}; a guess loses: {entry.guess_loses}")
    typer.echo(f"skills      {', '.join(sorted(entry.skills)) or 'none'}")
    typer.echo(f"tags        {', '.join(sorted(entry.tags)) or 'none'}")
    typer.echo(f"languages   {', '.join(entry.languages)}")
    typer.echo(f"scenarios   {', '.join(entry.runs_in)}")
    for label, said in trail.of_task(entry):
        typer.echo(f"{label:<11} {said}")
    for name, lines in halves.items():
        typer.echo(f"\n{name} half")
        for label, said in lines:
            typer.echo(f"  {label:<9} {said}")
    if entry.difference:
        typer.echo(f"\ndifference: {entry.difference}")


def _chosen(words: str, suite: str) -> list[Task]:
    from automotive_cosim.run.choosing import choose
    from automotive_cosim.tasks import CATALOGUE

    return [CATALOGUE[task_id] for task_id in choose((word.strip() for word in words.split(",")), suite)]


def _cells(tasks: list[Task]) -> str:
    """Modules by dimensions."""
    from automotive_cosim.tasking.task import Dimension, Module

    counts = Counter((task.module, task.dimension) for task in tasks)
    rows = [["", *(str(dimension).replace("_", " ") for dimension in Dimension), "all"]]
    for module in Module:
        own = [counts[module, dimension] for dimension in Dimension]
        rows.append([str(module), *map(str, own), str(sum(own))])
    sums = [sum(counts[module, dimension] for module in Module) for dimension in Dimension]
    rows.append(["all", *map(str, sums), str(len(tasks))])
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if column else cell.ljust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    )


def _abilities(tasks: list[Task]) -> str:
    """How many of the tasks are hard by which ability; empty where none is of the hard suite."""
    from automotive_cosim.tasking.task import Ability

    counts = Counter(task.ability for task in tasks)
    told = ", ".join(f"{ability} {counts[ability]}" for ability in Ability if counts[ability])
    return f"by ability: {told}\n" if told else ""


def _instances(tasks: list[Task]) -> str:
    """The number of different instances, in words."""
    from automotive_cosim.tasking.instance import instances

    return f"{sum(map(instances, tasks)):,} episodes by words, parameters and scenario"
