"""``automotive-cosim show schema``: the formats of files that users write, for use in editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def schema(
    name: Annotated[
        str | None, typer.Argument(help="Name of a format; omit it to list them.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="File to write; standard output if not given.", show_default=False)
    ] = None,
) -> None:
    """Print the JSON Schema of a file format, so that an editor can check and complete such files."""
    from automotive_cosim import schemas
    from automotive_cosim.errors import UserError
    from automotive_cosim.formats.writing import write_whole

    if name is None:
        if out is not None:
            raise UserError(f"--out {out} needs the NAME of a schema; `automotive-cosim show schema` lists them")
        for known in schemas.names():
            typer.echo(f"{known:<10}{schemas.about(known)}")
        return
    text = schemas.text(name)
    if out is None:
        typer.echo(text, nl=False)
    else:
        write_whole(out, text)
        typer.echo(f"{out} written")
