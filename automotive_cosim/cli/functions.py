"""``automotive-cosim show functions``: what an agent can call."""

from __future__ import annotations

from typing import Annotated

import typer

from automotive_cosim.cli.options import print_json


def functions(
    as_json: Annotated[bool, typer.Option("--json", help="Print each with its JSON Schema.")] = False,
    openai: Annotated[bool, typer.Option("--openai", help="Print tools of OpenAI's chat completions.")] = False,
    mcp: Annotated[bool, typer.Option("--mcp", help="Print tools of the Model Context Protocol.")] = False,
    anthropic: Annotated[bool, typer.Option("--anthropic", help="Print tools of Anthropic's messages.")] = False,
) -> None:
    """List the functions that an agent can call with --interface functions or both."""
    from automotive_cosim.errors import UserError
    from automotive_cosim.interface import functions as known

    forms = {
        "--json": (as_json, known.as_json),
        "--openai": (openai, known.as_openai),
        "--mcp": (mcp, known.as_mcp),
        "--anthropic": (anthropic, known.as_anthropic),
    }
    chosen = {name: form for name, (wanted, form) in forms.items() if wanted}
    if len(chosen) > 1:
        raise UserError(f"{' and '.join(chosen)} are two forms; give one of them")
    every = known.functions().values()
    if chosen:
        (form,) = chosen.values()
        print_json([form(function) for function in every])
        return
    for function in every:
        typer.echo(known.signature(function, is_told=False).removeprefix("- "))
        typer.echo(f"    {function.about}")
    typer.echo(f"\n{len(every)} functions; --json, --openai, --mcp and --anthropic print their JSON Schemas")
