"""``automotive-cosim agents``: the agents that can operate the cockpit."""

from __future__ import annotations

import typer

from automotive_cosim.cli.options import print_json, tells_json

app = typer.Typer(help="The agents that can operate the cockpit.", invoke_without_command=True)


@app.callback()
def _default(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_agents(context=context)


@app.command("list")
@tells_json
def list_agents(as_json: bool = False) -> None:
    """List the agents and the models behind them."""
    from automotive_cosim.agents import ABOUT, AGENTS
    from automotive_cosim.models import MODELS

    if as_json:
        print_json({"agents": list(AGENTS), "about": dict(ABOUT), "models": list(MODELS)})
        return
    others = {"package.module:Class": "your own", "a2a:http://HOST:PORT": "one that speaks A2A, as CAR-bench's do"}
    about = {name: ABOUT[name] for name in AGENTS} | others
    for name, line in about.items():
        typer.echo(f"{name:<{max(map(len, about))}}  {line}")
    typer.echo(f"models: {', '.join(MODELS)}")


@app.command("formats")
@tells_json
def list_formats(as_json: bool = False) -> None:
    """List the native formats: their models, coordinates and words, with version, date and source of the words."""
    from automotive_cosim.agents import FORMATS

    if as_json:
        print_json({"formats": {name: form.as_json() for name, form in FORMATS.items()}})
        return
    for name, form in FORMATS.items():
        declines = f"; declines with {form.declines}" if form.declines else ""
        typer.echo(f"{name}: {form.models}; {form.grid.told}{declines}; has no {', '.join(form.lacks)}")
        for words in form.words:
            typer.echo(f"    {', '.join(words.verbs)}\n        {words.version}; {words.date}, {words.source}")


@app.command()
@tells_json
def show(name: str, as_json: bool = False) -> None:
    """Show an agent's inputs and actions and, if it uses a model, its prompt."""
    from importlib.resources import files

    from automotive_cosim.agents import FORMATS, MODELLED, PROFILES, NativeAgent, make_agent

    if name == NativeAgent.name:
        channels = sorted(NativeAgent.channels)
        actions = sorted(frozenset[str]().union(*(form.actions for form in FORMATS.values())))
    else:
        channels = sorted(make_agent(name).channels)
        actions = sorted(PROFILES[name].actions) if name in PROFILES else []
    prompt = ""
    if name in MODELLED:
        file = "standard" if name in PROFILES else name
        prompt = files("automotive_cosim.agents").joinpath("prompts", f"{file}.md").read_text("utf-8")
    if as_json:
        print_json({"name": name, "channels": channels, "actions": actions, "prompt": prompt})
        return
    typer.echo(f"{name}: gets {', '.join(channels) or 'only the goal'}")
    if name == NativeAgent.name:
        typer.echo("its model gets the screenshot alone; `automotive-cosim agents formats` has its words\n")
    elif actions:
        typer.echo(f"actions: {', '.join(actions)}\n")
    typer.echo(prompt, nl=False)
