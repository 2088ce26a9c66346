"""``automotive-cosim show signals``: what the car measures and what can be commanded."""

from __future__ import annotations

import json

import typer

from automotive_cosim.cli.options import AsJson, print_json


def signals(as_json: AsJson = False) -> None:
    """List the vehicle's signals: path, kind, valid values, default."""
    from automotive_cosim.cockpit.signals import CATALOGUE

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
