"""``automotive-cosim agents``: the agents that can operate the cockpit."""

from __future__ import annotations

import typer

app = typer.Typer(help="The agents that can operate the cockpit.", invoke_without_command=True)


@app.callback()
def _default(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_agents()


@app.command("list")
def list_agents() -> None:
    """List the agents and the models behind them."""
    from automotive_cosim.agents import AGENTS
    from automotive_cosim.models import MODELS

    for name in AGENTS:
        typer.echo(name)
    typer.echo("package.module:Class (your own)")
    typer.echo(f"models: {', '.join(MODELS)}")


@app.command()
def show(name: str) -> None:
    """Show an agent's inputs and actions and, if it uses a model, its prompt."""
    from importlib.resources import files

    from automotive_cosim.agents import FORMATS, MODELLED, PROFILES, NativeAgent, make_agent

    if name == NativeAgent.name:
        typer.echo(f"{name}: gets {', '.join(sorted(NativeAgent.channels))}; its model, the screenshot alone\n")
        for form, each in FORMATS.items():
            typer.echo(f"{form}: {', '.join(each.verbs)}\n    has no {', '.join(each.lacks) or 'gaps'}")
        typer.echo()
    else:
        agent = make_agent(name)
        typer.echo(f"{agent.name}: gets {', '.join(sorted(agent.channels)) or 'only the goal'}")
    if name in PROFILES:
        typer.echo(f"actions: {', '.join(sorted(PROFILES[name].actions))}\n")
    if name in MODELLED:
        typer.echo(files("automotive_cosim.agents").joinpath("prompts", f"{name}.md").read_text("utf-8"), nl=False)
