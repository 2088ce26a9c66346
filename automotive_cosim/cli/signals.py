"""``automotive-cosim show signals``: what the car measures and what can be commanded."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import AsJson, print_json


def signals(
    vss: Annotated[bool, typer.Option("--vss", help="Print a VSS tree in JSON.")] = False,
    out: Annotated[Path | None, typer.Option(help="File for the VSS tree.", show_default="standard output")] = None,
    as_json: AsJson = False,
) -> None:
    """List the vehicle's signals: path, kind, valid values, default."""
    from automotive_cosim.cockpit import vss as tree_of
    from automotive_cosim.cockpit.signals import CATALOGUE
    from automotive_cosim.errors import UserError

    if vss:
        text = json.dumps(tree_of.tree(), indent=2, ensure_ascii=False) + "\n"
        if out is None:
            typer.echo(text, nl=False)
        else:
            out.write_text(text, encoding="utf-8")
            typer.echo(f"{out} written")
        return
    if out is not None:
        raise UserError(f"--out {out} is for the VSS tree; add --vss")
    if as_json:
        listed = [
            {"path": path, "kind": signal.kind, "values": signal.range, "default": signal.default}
            for path, signal in CATALOGUE.items()
        ]
        print_json({"signals": listed})
        return
    width = max(map(len, CATALOGUE))
    for path, signal in CATALOGUE.items():
        default = "nothing" if signal.default is None else json.dumps(signal.default)
        typer.echo(f"{path:<{width}}  {signal.kind:<8}  {signal.range}; {default}")
