"""``automotive-cosim bench``: the cost of the coupling on this machine, compared with bare SUMO."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson, print_json
from automotive_cosim.run.settings import BenchSettings

if TYPE_CHECKING:
    from rich.table import Table

    from automotive_cosim.run.measure import Figures


@takes(BenchSettings)
def bench(as_json: AsJson = False, **settings: Any) -> None:
    """Time bare SUMO, a libsumo loop and the environment side by side; also resets and memory."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.measure import measure

    progress = Console(stderr=True, quiet=as_json, highlight=False)
    told = filled(BenchSettings, settings)

    def say(what: str) -> None:
        progress.print(f"measuring: {what}")

    figures = measure(told.scenario, told.steps, say, peers=told.peers)
    if as_json:
        print_json(figures.as_json())
    else:
        Console(highlight=False).print(_table(figures))


def _table(figures: Figures) -> Table:
    from rich.table import Table

    from automotive_cosim.run.peers import EPISODE_S

    what = f"{figures.vehicles} vehicles, {figures.steps} steps of {figures.step_length_s:g} s"
    table = Table(title=f"{figures.scenario}: {what}", title_justify="left")
    table.add_column("what")
    table.add_column("figure", justify="right")
    table.add_column("", style="dim")
    bare = figures.bare_sumo_s_per_step

    def per_step(seconds: float | None) -> tuple[str, str]:
        if seconds is None:
            return "none", figures.bare_sumo_missing or ""
        ratio = f"{seconds / bare:.2f} of bare sumo" if bare else ""
        return f"{seconds * 1000:.3f} ms", ratio

    table.add_row("bare sumo, per step", *per_step(bare))
    table.add_row("libsumo loop, per step", *per_step(figures.libsumo_s_per_step))
    inside = f"{figures.in_process_ratio:.2f} of bare steps in the same process"
    table.add_row(
        "driving states in one process, per step", f"{figures.in_process_s_per_step * 1000:.3f} ms", inside
    )
    table.add_row("driving states, forked, ten steps per message", *per_step(figures.forked_s_per_step))
    table.add_row("driving states, forked, one step per message", *per_step(figures.forked_single_s_per_step))
    table.add_row("environment, per step", *per_step(figures.env_s_per_step))
    table.add_row("environment with rendering, per step", *per_step(figures.env_rendered_s_per_step))
    warm_up = f"{figures.warm_up_s:g} s of traffic before the ego departs"
    table.add_row("reset by reload and warm-up", f"{figures.reset_reload_s:.2f} s", warm_up)
    ratio = f"{figures.reset_reload_s / figures.reset_fork_s:.0f} times as fast"
    table.add_row("reset by fork", f"{figures.reset_fork_s * 1000:.0f} ms", ratio)
    table.add_row(
        "memory of one environment", _megabytes(figures.rss_mb), "all its processes, shared pages counted once"
    )
    table.add_row("memory of each additional one", _megabytes(figures.rss_per_extra_env_mb), "on the same traffic")
    for peer in figures.peers:
        ratio = f"{peer.s_per_second / figures.peers[0].s_per_second:.2f} of the loop"
        table.add_row(f"{peer.name}, steps of 1 s", f"{peer.s_per_second * 1000:.3f} ms", ratio)
        if peer.reset_s is not None and peer.s_per_second_of_episodes is not None:
            whole = f"{peer.s_per_second_of_episodes * 1000:.3f} ms per second"
            spread = f"{whole} in episodes of {EPISODE_S / 60:.0f} min"
            table.add_row(f"{peer.name}, a new episode", f"{peer.reset_s * 1000:.0f} ms", spread)
    return table


def _megabytes(value: float | None) -> str:
    return "only on Linux" if value is None else f"{value:.0f} MB"
