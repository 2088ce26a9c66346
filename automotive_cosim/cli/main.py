"""``automotive-cosim``: the commands, and the form of errors.

Exit codes: 0 done, 1 a check failed, 2 an error that the user can fix, 3 an infrastructure error,
130 interrupted, 141 the reader of its output is gone, 143 terminated.
"""

from __future__ import annotations

import ast
import gc
import io
import os
import re
import signal
import sys
import threading
from contextlib import nullcontext
from copy import copy
from functools import cache
from pathlib import Path
from pkgutil import resolve_name
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import automotive_cosim
from automotive_cosim.cli import CONTENTS, READ, RUN, TOOLS
from automotive_cosim.cli.terminal import discard_output, json_alone, open_streams, plain_streams
from automotive_cosim.cli.watched import watched
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.formats.plain import plain
from automotive_cosim.run.extensions import extensions

INTERRUPTED = 130
"""Typer's exit code for Ctrl-C: 128 plus the signal's number, as in shells."""
TERMINATED = 143
"""The same for SIGTERM: ``kill``, a stopped container, a batch system whose time is up."""
CLOSED_PIPE = 141
"""The same for SIGPIPE: who read the output, such as ``head``, has had enough."""

YOUNG = 50_000
"""So many new objects before the next look for garbage: of a command's first second, most are classes that stay."""

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
    ("show screens", "show:screens", ""),
    ("show signals", "show:signals", ""),
    ("show functions", "show:functions", ""),
    ("show drives", "show:drives", ""),
    ("show apps", "show:apps", ""),
    ("show events", "show:events", ""),
    ("show wakes", "show:wakes", ""),
    ("show spaces", "show:spaces", ""),
    ("show factors", "show:factors", ""),
    ("show policy", "show:policy", ""),
    ("show context", "context:context", ""),
    ("show memory", "show:memory", ""),
    ("show schema", "show:schema", ""),
    ("ci", "ci:app", TOOLS),
    ("doctor", "doctor:doctor", TOOLS),
    ("bench", "bench:bench", TOOLS),
    ("keep", "keep:keep", TOOLS),
    ("mcp", "mcp:mcp", TOOLS),
    ("a2a", "a2a:a2a", TOOLS),
)
"""Their words, where they are, and in which part of the list they stand: commands, groups, and what groups have
besides their own. Extensions add more."""
LIST = "--help"
"""Asked for without a command: the list of all."""
OWN_AGENT = re.compile(r"^run .*--agent[ =](?!a2a:)\S+:")
"""A command line whose process someone else's code shares."""
SIGNED = "show context"
"""Its arguments may be negative numbers."""


class Program(TyperGroup):
    """The program. Its ``--json`` may stand among the words of a command that lists or reports."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Puts ``--json`` before a command that knows it, and behind one that does not, which refuses it."""
        command: Any = self
        takes = set[str]()
        words, asked, is_value = list[str](), list[str](), False
        for at, word in enumerate(args):
            if word == "--":  # behind it stand arguments
                words += args[at:]
                break
            (asked if word == "--json" and not is_value else words).append(word)
            is_value = word in takes and not is_value
            if word in getattr(command, "commands", {}):
                command = command.commands[word]
                valued = (each for each in command.params if not getattr(each, "is_flag", True))
                takes = {name for each in valued for name in each.opts}
        asked = asked[:1]
        tells = getattr(command.callback, "tells_json", False)
        return super().parse_args(ctx, [*asked, *words] if tells else [*words, *asked])


@cache
def made(*asked: str) -> typer.Typer:
    """The command line; with the words that are asked for, only what they name is imported, because to import the
    others takes longer than most commands do. What stands beside it is listed."""
    rows = {words: (f"automotive_cosim.cli.{where}", panel) for words, where, panel in COMMANDS}
    rows |= {words: (where, panel) for each in extensions() for words, where, panel in each.COMMANDS}
    named = next((words for words in (" ".join(asked[:2]), *asked[:1]) if words in rows), "")
    app = typer.Typer(
        name="automotive-cosim",
        cls=Program,
        help="Agents that operate the cockpit of a car in live SUMO traffic.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
    )
    apps = {"": app}
    for words, (where, panel) in rows.items():
        group, _, name = words.rpartition(" ")
        is_named = not asked or f"{named} ".startswith(f"{words} ")
        if group not in apps or not (is_named or group == named):
            continue
        command = resolve_name(where) if is_named else _listed(where)
        if isinstance(command, typer.Typer):
            apps[words] = copy(command)
            apps[words].registered_commands = [*command.registered_commands]
            apps[group].add_typer(apps[words], name=name, rich_help_panel=panel)
        else:
            signed = {"ignore_unknown_options": words == SIGNED}
            apps[group].command(name, rich_help_panel=panel or None, context_settings=signed)(command)
    # Typer imports pydantic to find out that no help was asked for, unless that has a default.
    below = asked[: 2 if asked[:1] and asked[0] in apps else 1]
    defaults: dict[str, Any] = {"help": False}
    for word in reversed(below):
        defaults = {"help": False, word: defaults}
    settings = {"help_option_names": ["-h", "--help"], "default_map": defaults}
    app.callback(context_settings=settings)(_options)
    return app


def _listed(where: str) -> Any:
    """A command or group that only has its help, read from its file: to import all takes most of a second."""
    module, _, named = where.partition(":")
    home = Path(automotive_cosim.__file__).parent.joinpath(*module.split(".")[1:])
    file = home / "__init__.py" if home.is_dir() else home.with_suffix(".py")

    def listed() -> None: ...

    for node in ast.parse(file.read_text(encoding="utf-8")).body:
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
        typer.echo(f"automotive-cosim {automotive_cosim.__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
    debug: Annotated[
        bool, typer.Option("--debug", envvar="AUTOMOTIVE_COSIM_DEBUG", help="Show the traceback of an error.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Where a command lists or reports: print JSON and nothing else.")
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

    gc.set_threshold(YOUNG)
    signal.signal(signal.SIGTERM, terminate)
    sys.unraisablehook = swallowed
    open_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a street's name must not end a run under an ASCII locale
            stream.reconfigure(errors="replace")
    words = set(sys.argv)
    asks_json = "--json" in words and not {"-h", "--help"} & words

    def ended() -> int:
        code = _run()
        if code != INTERRUPTED:
            return code
        print("error: interrupted", file=sys.stderr)
        return TERMINATED if terminations else INTERRUPTED

    with json_alone() if asks_json else nullcontext(), plain_streams():
        code = watched(ended) if OWN_AGENT.search(" ".join(sys.argv[1:])) else ended()
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
        asked = [word for word in sys.argv[1:] if not word.startswith("-")]
        return made(*asked[:2] or (LIST,))(prog_name="automotive-cosim", standalone_mode=False) or 0
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
