"""Makes what reaches a terminal plain text, and keeps standard output free for JSON.

print, typer.echo -> Plain -> the stream
rich -> console.Console -> the stream, with rich's own controls
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, redirect_stdout
from typing import Any, TextIO, cast

import typer

from automotive_cosim.formats.plain import OBEYED, plain


def escaped(text: str) -> str:
    """A text of JSON with its control characters in JSON's notation."""
    return OBEYED.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


class Plain:
    """A stream that writes only plain text."""

    encoding = "utf-8"
    """Its encoding; for a stream that reports ``ascii``, click would write to the bytes below instead."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self.rich_proxied_file = stream
        """The stream that rich's consoles write to: they use this attribute of a wrapper."""

    def write(self, text: str) -> int:
        return self._stream.write(plain(text))

    def writelines(self, lines: Iterable[str]) -> None:
        """Writes the lines as plain text."""
        self._stream.writelines(map(plain, lines))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def plain_streams() -> Iterator[None]:
    """Within the block, standard output and standard error take only plain text."""
    kept = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = (cast(TextIO, Plain(stream)) for stream in kept)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = kept


@contextmanager
def json_alone() -> Iterator[None]:
    """Within the block, only ``print_alone`` prints to standard output. What libraries, agents and the processes
    started here print there goes to standard error."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    _outputs.append((kept, sys.stdout.encoding))
    try:
        with redirect_stdout(sys.stderr):
            yield
    finally:
        _outputs.pop()
        os.dup2(kept, 1)
        os.close(kept)


_outputs: list[tuple[int, str]] = []
"""The standard output that is kept free, with its encoding."""


def print_alone(text: str) -> None:
    """Prints a text to standard output, within ``json_alone`` too."""
    if not _outputs:
        typer.echo(text)
        return
    descriptor, encoding = _outputs[-1]
    with open(descriptor, "w", encoding=encoding, errors="replace", closefd=False) as output:
        output.write(f"{text}\n")


def open_streams() -> None:
    """Gives the process a standard input, output and error where it was started without one, as some services do.

    Otherwise the next file that is opened would take the number of the stream, and be printed into."""
    while (opened := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(opened, True)
    os.close(opened)
    sys.stdin = sys.stdin or os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stdout = sys.stdout or os.fdopen(1, "w", encoding="utf-8", closefd=False)
    sys.stderr = sys.stderr or os.fdopen(2, "w", encoding="utf-8", closefd=False)


def discard_output() -> None:
    """Throws away what is still to be printed: its reader is gone."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)
