"""``automotive-cosim signals``: what the car measures and what can be commanded."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import AsJson, print_json

app = typer.Typer(help="The vehicle's signals.", no_args_is_help=True)


@app.command("list")
def list_(as_json: AsJson = False) -> None:
    """List the signals: path, kind, valid values, default."""
    from automotive_cosim.cockpit.signals import CATALOGUE

    if as_json:
        signals = [
            {"path": path, "kind": signal.kind, "values": signal.range, "default": signal.default}
            for path, signal in CATALOGUE.items()
        ]
        print_json({"signals": signals})
        return
    width = max(map(len, CATALOGUE))
    for path, signal in CATALOGUE.items():
        default = "nothing" if signal.default is None else json.dumps(signal.default)
        typer.echo(f"{path:<{width}}  {signal.kind:<8}  {signal.range}; {default}")


@app.command()
def export(
    out: Annotated[Path | None, typer.Option(help="File to write; standard output if not given.")] = None,
) -> None:
    """Export the signals as a VSS tree in JSON."""
    from automotive_cosim.cockpit import vss

    text = json.dumps(vss.tree(), indent=2, ensure_ascii=False) + "\n"
    if out is None:
        typer.echo(text, nl=False)
    else:
        out.write_text(text, encoding="utf-8")
        typer.echo(f"{out} written")
