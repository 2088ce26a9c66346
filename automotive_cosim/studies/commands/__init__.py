"""``automotive-cosim study``: what rerouting saves, what an intervention does to congestion."""

import typer

from automotive_cosim.studies.commands.network import COMMANDS
from automotive_cosim.studies.commands.reroute import compare, reroute

app = typer.Typer(
    help="Measure what rerouting saves and what an intervention does to congestion.", no_args_is_help=True
)
for command in (reroute, *COMMANDS, compare):
    app.command()(command)
