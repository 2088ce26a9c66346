"""``automotive-cosim scenarios equilibrate``: routes on which nobody would do better alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, tells_json
from automotive_cosim.errors import UserError
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings, OptimumSettings

if TYPE_CHECKING:
    from automotive_cosim.studies.equilibrium.optimum import SystemOptimum


@tells_json
@takes(OptimumSettings)
@takes(EquilibriumSettings, but=("seed",))
def equilibrate_scenario(
    folder: Annotated[Path, typer.Argument(help="Folder of a scenario, or any .sumocfg.", show_default=False)],
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Give a scenario's drivers their user-equilibrium routes, found by repeated simulation.

    Prints the relative gap of every step, as measured from the trips driven, and keeps the best step."""
    from automotive_cosim.scenarios.variant import check_target
    from automotive_cosim.studies.equilibrium.equilibrium import AssignmentStep, equilibrate
    from automotive_cosim.studies.equilibrium.optimum import OptimumStep, compare

    told = filled(OptimumSettings, settings)
    target = told.out or folder.with_name(f"{folder.resolve().name.removesuffix('.sumocfg')}_equilibrium")

    def tell(step: AssignmentStep) -> None:
        typer.echo(f"step {step.number}: {step.gap}; {step.changed} change")

    def tell_total(step: OptimumStep) -> None:
        total = step.total
        typer.echo(
            f"towards the optimum, step {step.number}: {total.mean_s:.1f} s per trip, {total.unfinished} had not "
            f"arrived, {total.teleports} teleports; {step.changed} change"
        )

    options = filled(EquilibriumSettings, settings)
    optimum = target.with_name(f"{target.name}_optimum")
    driven = [*(told.seeds or range(options.seed + 1, options.seed + 11))]
    if options.seed in driven or len(set(driven)) < 2:
        raise UserError(
            f"--seeds is {','.join(map(str, driven))}; give two or more seeds, but not {options.seed}, with which "
            "the search runs"
        )
    if told.system_optimum:
        check_target(optimum)  # before the equilibrium, which takes minutes
    found = equilibrate(folder, target, options, tell)
    compared = None
    if told.system_optimum:
        compared = compare(target, optimum, options, driven, tell_total)
    best = min(found, key=lambda step: step.gap.relative)
    if as_json:
        print_json(
            {"out": str(target), "kept": best.number, "relative_gaps": [step.gap.relative for step in found]}
            | ({} if compared is None else compared.as_json() | {"optimum": str(optimum)})
        )
        return
    reached = "" if best.gap.relative <= options.gap else f"; {options.gap:.1%} was not reached"
    typer.echo(f"{target}: the demand of step {best.number}, {best.gap}{reached}")
    if compared is not None:
        typer.echo(f"{optimum}: the demand of step {compared.kept}\n")
        _print_states(compared)


def _print_states(found: SystemOptimum) -> None:
    """Both states side by side, means over seeds."""
    from statistics import fmean

    from rich.table import Table

    from automotive_cosim.cli.console import Console

    table = Table(
        *("", "trips", "total, h", "per trip, s", "not arrived", "teleports"),
        box=None,
        header_style="bold",
        pad_edge=False,
    )
    for name, totals in (("user equilibrium", found.equilibrium), ("system optimum", found.optimum)):
        table.add_row(
            name,
            str(totals[0].trips),
            f"{fmean(each.total_s for each in totals) / 3600:.2f}",
            f"{fmean(each.mean_s for each in totals):.1f}",
            f"{fmean(each.unfinished for each in totals):.1f}",
            f"{fmean(each.teleports for each in totals):.1f}",
        )
    Console().print(table)
    low, high = found.interval
    typer.echo(
        f"\nprice of anarchy: {found.price_of_anarchy:.3f} ({low:.3f} to {high:.3f}, 95 % over {len(found.ratios)} "
        "seeds); a lower bound, as the search may not have found the optimum"
    )
    if found.kept == 0:
        typer.echo("the search found no routes with a lower total time than the equilibrium's")
    elif low <= 1 <= high:
        typer.echo("the interval includes 1: these seeds show no difference")
