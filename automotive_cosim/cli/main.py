"""``automotive-cosim``: the commands, and the form of errors.

Exit codes: 0 done, 1 a check failed, 2 an error that the user can fix, 3 an infrastructure error,
130 interrupted, 141 the reader of its output is gone, 143 terminated.
"""

from __future__ import annotations

import ast
import io
import os
import signal
import sys
import threading
from contextlib import nullcontext
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from pkgutil import resolve_name
from typing import Annotated, Any

import typer

from automotive_cosim import __version__
from automotive_cosim.cli import CONTENTS, READ, RUN, TOOLS
from automotive_cosim.cli.terminal import discard_output, json_alone, open_streams, plain_streams
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.formats.plain import plain
from automotive_cosim.run.extensions import extensions

INTERRUPTED = 130
"""Typer's exit code for Ctrl-C: 128 plus the signal's number, as in shells."""
TERMINATED = 143
"""The same for SIGTERM: ``kill``, a stopped container, a batch system whose time is up."""
CLOSED_PIPE = 141
"""The same for SIGPIPE: who read the output, such as ``head``, has had enough."""

COMMANDS = (
    ("run", "run:run", RUN),
    ("eval", "evaluate:evaluate", RUN),
    ("search", "search:search", RUN),
    ("serve", "serve:serve", READ),
    ("report", "results:report", READ),
    ("compare", "compare:compare", READ),
    ("replay", "results:replay", READ),
    ("attribute", "results:attribute", READ),
    ("measures", "measures:measures", READ),
    ("export", "export:export", READ),
    ("publish", "publish:app", READ),
    ("tasks", "tasks:app", CONTENTS),
    ("scenarios", "scenarios:app", CONTENTS),
    ("agents", "agents:app", CONTENTS),
    ("show", "show:app", CONTENTS),
    ("ci", "ci:app", TOOLS),
    ("doctor", "doctor:doctor", TOOLS),
    ("bench", "bench:bench", TOOLS),
    ("keep", "keep:keep", TOOLS),
    ("mcp", "mcp:mcp", TOOLS),
    ("a2a", "a2a:a2a", TOOLS),
)
"""Their names, where they are, and in which part of the list they stand. Extensions add more."""
LIST = "--help"
"""Asked for without a command: the list of all."""
EXTENDED = "scenarios"
"""The group to which extensions add commands."""


@cache
def made(asked: str = "") -> typer.Typer:
    """The command line; of the commands above only the one that is asked for, if it is one of them, because to
    import the others takes longer than most commands do."""
    app = typer.Typer(
        name="automotive-cosim",
        help="Agents that operate the cockpit of a car in live SUMO traffic.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_options)
    rows = [(name, f"automotive_cosim.cli.{where}", panel) for name, where, panel in COMMANDS]
    rows += [row for extension in extensions() for row in extension.COMMANDS]
    alone = [row for row in rows if row[0] == asked]
    groups = {}
    for name, where, panel in alone or rows:
        command = _listed(where) if asked == LIST else resolve_name(where)
        if isinstance(command, typer.Typer):
            app.add_typer(command, name=name, rich_help_panel=panel)
            groups[name] = command
        else:
            app.command(name, rich_help_panel=panel)(command)
    if asked == EXTENDED or not (alone or asked == LIST):
        for extension in extensions():
            extension.add_commands(groups)
    return app


def _listed(where: str) -> Any:
    """A command or group that only has its help, read from its file: to import all takes most of a second."""
    module, _, named = where.partition(":")
    spec = find_spec(module)

    def listed() -> None: ...

    for node in ast.parse(Path(str(spec and spec.origin)).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef) and node.name == named:
            listed.__doc__ = ast.get_docstring(node)
        elif isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == named:
            said = {each.arg: each.value for each in getattr(node.value, "keywords", ())}["help"]
            group = typer.Typer(help=ast.literal_eval(said))
            group.callback()(listed)
            return group
    return listed


def __getattr__(name: str) -> typer.Typer:
    if name == "app":
        return made()
    raise AttributeError(name)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"automotive-cosim {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
    debug: Annotated[
        bool, typer.Option("--debug", envvar="AUTOMOTIVE_COSIM_DEBUG", help="Show the traceback of an error.")
    ] = False,
) -> None:
    if debug:
        os.environ["AUTOMOTIVE_COSIM_DEBUG"] = "1"


def main() -> None:
    """Runs the command line and ends the process; an error is one line on stderr."""
    terminations: list[int] = []

    def terminate(number: int, frame: object) -> None:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # a second one must not interrupt the clean-up
        terminations.append(number)
        raise KeyboardInterrupt  # ends as after Ctrl-C, which may be ignored from the start (nohup)

    def swallowed(lost: sys.UnraisableHookArgs) -> None:
        """A callback, such as a weak reference's, cannot raise: what interrupted it comes once more."""
        if not isinstance(lost.exc_value, KeyboardInterrupt):
            sys.__unraisablehook__(lost)
            return
        number = terminations.pop() if terminations else signal.SIGINT
        if number == signal.SIGTERM:
            signal.signal(signal.SIGTERM, terminate)
        threading.Timer(0.01, os.kill, (os.getpid(), number)).start()

    signal.signal(signal.SIGTERM, terminate)
    sys.unraisablehook = swallowed
    open_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a street's name must not end a run under an ASCII locale
            stream.reconfigure(errors="replace")
    words = set(sys.argv)
    asks_json = "--json" in words and not {"-h", "--help"} & words
    with json_alone() if asks_json else nullcontext(), plain_streams():
        code = _run()
        if code == INTERRUPTED:
            print("error: interrupted", file=sys.stderr)
            code = TERMINATED if terminations else INTERRUPTED
    sys.exit(code)


def _misused(error: typer.TyperException) -> str:
    """What is wrong with a command's words, and where to read what is right; empty once its help is printed."""
    said, context = error.format_message(), getattr(error, "ctx", None)
    if not said or said.endswith("?") or context is None:  # with a question mark it offers the right word itself
        return said
    return f"{said.removesuffix('.')}; see `{context.command_path} --help`"


def _run() -> int:
    """Runs a command; returns the exit code."""
    try:
        asked = next((word for word in sys.argv[1:] if not word.startswith("-")), LIST)
        return made(asked)(prog_name="automotive-cosim", standalone_mode=False) or 0
    except (UserError, InfrastructureError, typer.TyperException) as error:
        if os.environ.get("AUTOMOTIVE_COSIM_DEBUG"):
            raise
        problems = [_misused(error)] if isinstance(error, typer.TyperException) else error.args
        for problem in filter(None, map(str, problems)):
            print("error: " + " ".join(problem.split()), file=sys.stderr)
        return 3 if isinstance(error, InfrastructureError) else 2
    except SystemExit as end:  # typer's own, with a code of 1
        if not isinstance(end.__context__, BrokenPipeError):
            raise
        discard_output()
        return CLOSED_PIPE
    except UnicodeEncodeError as error:
        if os.environ.get("AUTOMOTIVE_COSIM_DEBUG"):
            raise
        near = error.object[max(0, error.start - 40) : error.end + 20].encode("utf-8", "backslashreplace").decode()
        print(f"error: a name is not valid UTF-8, near {plain(near)!r}; rename the file or folder", file=sys.stderr)
        return 2
    except OSError as error:
        if os.environ.get("AUTOMOTIVE_COSIM_DEBUG"):
            raise
        print(f"error: {error.strerror or error}: {error.filename or 'standard output'}", file=sys.stderr)
        return 2
