"""``automotive-cosim study``: what rerouting saves, what a measure does to congestion."""

import typer

from automotive_cosim.cli.study.compare import compare
from automotive_cosim.cli.study.congestion import congestion
from automotive_cosim.cli.study.days import days
from automotive_cosim.cli.study.reroute import reroute

app = typer.Typer(help="Measure what rerouting saves and what a measure does to congestion.", no_args_is_help=True)
for command in (reroute, congestion, days, compare):
    app.command()(command)
