"""``automotive-cosim show``: what the car, the map and the files consist of."""

from __future__ import annotations

import typer

from automotive_cosim.cli import catalogues, context, drive, functions, memory, schema, screens, signals

app = typer.Typer(
    help="Show screens, apps, signals, functions, drives and their events, local law and file formats.",
    no_args_is_help=True,
)
app.command()(screens.screens)
app.command()(signals.signals)
app.command()(functions.functions)
app.command("drives")(drive.drives)
app.command()(catalogues.apps)
app.command()(catalogues.events)
app.command()(catalogues.wakes)
app.command()(catalogues.spaces)
app.command()(catalogues.factors)
app.command()(catalogues.policy)
app.command(context_settings=context.COMMAND_SETTINGS)(context.context)
app.command()(memory.memory)
app.command()(schema.schema)
