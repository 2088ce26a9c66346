"""``automotive-cosim show functions``: what an agent can call."""

from __future__ import annotations

from typing import Annotated

import typer

from automotive_cosim.cli.options import print_json


def functions(
    as_json: Annotated[bool, typer.Option("--json", help="Print each with its JSON Schema.")] = False,
    tools: Annotated[
        str, typer.Option(metavar="FORM", help="Print them as tools of an API: openai, mcp or anthropic.")
    ] = "",
) -> None:
    """List the functions that an agent can call with --interface functions or both."""
    from automotive_cosim.errors import UnknownNameError
    from automotive_cosim.interface import functions as known

    forms = {"openai": known.as_openai, "mcp": known.as_mcp, "anthropic": known.as_anthropic}
    if tools and tools not in forms:
        raise UnknownNameError("form of tools", tools, forms)
    every = known.functions().values()
    if tools or as_json:
        form = forms.get(tools, known.as_json)
        print_json([form(function) for function in every])
        return
    for function in every:
        typer.echo(known.signature(function, is_told=False).removeprefix("- "))
        typer.echo(f"    {function.about}")
    typer.echo(f"\n{len(every)} functions; --json and --tools print their JSON Schemas")
