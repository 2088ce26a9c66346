"""``automotive-cosim bench``: the cost of the coupling on this machine, compared with a bare libsumo loop."""

from __future__ import annotations

from functools import partial
from typing import Annotated

import typer
from annotated_types import Ge, Le

from automotive_cosim.cli.derived import number_in
from automotive_cosim.cli.options import print_json, tells_json


@tells_json
def bench(
    scenario: Annotated[
        str, typer.Option(help="A scenario's name or folder, any .sumocfg or .net.xml(.gz).")
    ] = "paris_centre",
    steps: Annotated[
        int,
        typer.Option(
            help="SUMO steps to measure after the warm-up.",
            metavar="N",
            parser=partial(number_in, int, (Ge(100), Le(10**6))),
        ),
    ] = 2000,
    as_json: bool = False,
) -> None:
    """Time a libsumo loop and the environment side by side; also resets and memory."""
    from automotive_cosim.run.bench import measure

    def say(what: str) -> None:
        if not as_json:
            typer.echo(f"measuring: {what}", err=True)

    found = measure(scenario, steps, say)
    if as_json:
        print_json(found.as_json())
        return
    typer.echo(f"{found.scenario}: {found.vehicles} vehicles, {found.steps} steps of {found.step_length_s:g} s")
    for what, seconds in (
        ("libsumo loop, per step", found.libsumo_s_per_step),
        ("driving states, forked, per step", found.forked_s_per_step),
        ("environment, per step", found.env_s_per_step),
        ("environment with rendering, per step", found.env_rendered_s_per_step),
    ):
        typer.echo(f"{what:<40}{seconds * 1000:>9.3f} ms  {seconds / found.libsumo_s_per_step:.2f} of the loop")
    warm_up = f"with {found.warm_up_s:g} s of traffic before the ego departs"
    typer.echo(f"{'reset by reload and warm-up':<40}{found.reset_reload_s * 1000:>9.0f} ms  {warm_up}")
    times = f"{found.reset_reload_s / found.reset_fork_s:.0f} times as fast"
    typer.echo(f"{'reset by fork':<40}{found.reset_fork_s * 1000:>9.0f} ms  {times}")
    typer.echo(f"{'memory of one environment':<40}{found.rss_mb:>9.0f} MB  all its processes, shared pages once")
    typer.echo(f"{'memory of each additional one':<40}{found.rss_per_extra_env_mb:>9.0f} MB  on the same traffic")
