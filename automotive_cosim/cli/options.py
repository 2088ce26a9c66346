"""Options that several commands take."""

from __future__ import annotations

import inspect
import json
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial, wraps
from pathlib import Path
from typing import Annotated, Any, ParamSpec, get_type_hints

import typer
from annotated_types import Ge, Le

from automotive_cosim.cli.batches import words
from automotive_cosim.cli.derived import number_in
from automotive_cosim.cli.terminal import escaped, print_alone
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.tasking.sets import Suite

P = ParamSpec("P")

LARGE_BYTES = 4_000_000
"""A network of some 2,000 edges, or packed of ten times as many, which is read in a second."""


def _use_tasks_from(folder: Path | None) -> None:
    """Sets the variable before anything imports the catalogue; worker processes inherit it."""
    if folder is not None:
        from automotive_cosim.tasking.own_files import VARIABLE, own_files

        own_files(folder)
        os.environ[VARIABLE] = str(folder.resolve())


TasksFrom = Annotated[
    Path | None,
    typer.Option(
        "--tasks-from",
        help="A folder of your own tasks, beside the catalogue; other commands read AUTOMOTIVE_COSIM_TASKS.",
        callback=_use_tasks_from,
        is_eager=True,
        show_default=False,
    ),
]
"""For commands that run or prove tasks; others read ``AUTOMOTIVE_COSIM_TASKS``. Its callback handles the value."""


TASKS_HELP = (
    "Ids, patterns, tags, modules, dimensions, subsets, abilities, core, general, safety, all; separated by commas."
)
TaskNames = Annotated[str, typer.Option("--tasks", help=TASKS_HELP)]
SUITE_HELP = f"Task suite: {', '.join(Suite)}, live or all. An id selects a task in any, and core sixty."
SuiteName = Annotated[str, typer.Option("--suite", help=SUITE_HELP)]
"""For every command that chooses tasks by words."""


def reads_results(command: Callable[P, None]) -> Callable[P, None]:
    """For a command that reads what another one wrote and someone may have changed since: any fault in it is one
    error for the user, and ``--debug`` shows its cause."""

    @wraps(command)
    def guarded(*given: P.args, **named: P.kwargs) -> None:
        try:
            command(*given, **named)
        except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
            folder = next((value for value in (*given, *named.values()) if isinstance(value, Path)), "the folder")
            what = f"{type(error).__name__}: {error}"[:200]
            raise UserError(f"{folder} does not match this version's format ({what}); create it again") from error

    return guarded


def tells_json(command: Callable[..., None]) -> Callable[..., None]:
    """For every command that lists or reports: its ``as_json`` is the program's ``--json``, wherever it stands."""
    signature = inspect.signature(command, eval_str=True)
    context = inspect.Parameter("context", inspect.Parameter.KEYWORD_ONLY, annotation=typer.Context)

    @wraps(command)
    def told(*, context: typer.Context, **given: Any) -> None:
        command(as_json=context.find_root().params.get("as_json", False), **given)

    made: Any = told
    made.tells_json = True
    made.__doc__ = f"{command.__doc__}\n\n--json prints it as JSON, and nothing else."
    own = [each.replace(kind=context.kind) for each in signature.parameters.values() if each.name != "as_json"]
    made.__signature__ = signature.replace(parameters=[*own, context])
    return told


def print_json(values: object) -> None:
    """Prints the JSON of ``--json``; nothing else prints any."""
    print_alone(escaped(json.dumps(values, ensure_ascii=False)))


MOST_SEED = 2**31 - 1
"""SUMO takes no larger one."""
Seed = Annotated[
    int,
    typer.Option(
        "--seed",
        help="Seed; the same seed gives the same trace.",
        metavar="N",
        parser=partial(number_in, int, (Ge(0), Le(MOST_SEED))),
    ),
]
AGENT_HELP = (
    "Agent; `agents` lists them; package.module:Class is one of your own, a2a:http://HOST:PORT one that speaks A2A."
)
AgentName = Annotated[str, typer.Option("--agent", help=AGENT_HELP)]
ModelName = Annotated[
    str,
    typer.Option(
        "--model",
        help="Model for the agent: rules, local, local/FILE.gguf, replay/FOLDER, replay/NAME, openai/NAME, "
        "PROVIDER/NAME.",
    ),
]


@dataclass(frozen=True, slots=True)
class LimitSettings:
    """Limits of a trial that are set otherwise; None leaves them as they are."""

    steps: Annotated[int | None, Le(100_000)] = None
    tokens: Annotated[int | None, Le(10**9)] = None
    seconds: Annotated[int | None, Le(10**6)] = None
    """Of waiting for the model."""
    wall: Annotated[int | None, Le(10**6)] = None

    @property
    def wall_s(self) -> float:
        """Most real time in seconds."""
        return math.inf if self.wall is None else float(self.wall)


def _read_limits(text: str) -> LimitSettings:
    """Limits such as ``steps=40,tokens=20000``."""
    hints = get_type_hints(LimitSettings, include_extras=True)
    found = {}
    for word in words("most", text):
        name, _, number = word.partition("=")
        if name not in hints:
            raise UnknownNameError("limit in --most", name, hints)
        found[name] = number_in(int, (Ge(1), *hints[name].__metadata__), number)
    return LimitSettings(**found)


Most = Annotated[
    LimitSettings | None,
    typer.Option(
        "--most",
        help="Other limits of a run, as in steps=40,tokens=20000,seconds=60: actions, waits among them; tokens "
        "to and from the model (2 million; 20 million for a drive); seconds to wait for it in all (1800; 14400). "
        "At one of them an episode is judged as it is, and a drive goes on unwatched; so it is, with `run`, after "
        "wall seconds of real time since the hand-over or the departure.",
        metavar="LIMITS",
        parser=_read_limits,
        show_default=False,
    ),
]


@dataclass(frozen=True, slots=True)
class DriveChanges:
    """What can be set about a drive on the command line, by the names of ``DriveSettings``."""

    minutes: Annotated[float | None, Ge(0.1), Le(60)] = None
    """End drives after this many simulated minutes."""
    errands: bool = False
    """On drives, people aboard also ask for things, near what safety asks for."""
    cars: Annotated[int | None, Ge(1), Le(512)] = None
    """Drive so many cars in one traffic, each with an agent, a driver and a judge of its own."""


Force = Annotated[bool, typer.Option("--force", help="Replace the results in --out.")]


def tell_opening(*names: str) -> None:
    """Says at once which large networks are being read: a city's takes seconds."""
    for path in map(Path, names):
        nets = (
            path.glob("*.net.xml*") if path.is_dir() else path.parent.glob("*.net.xml*") if path.is_file() else ()
        )
        if sum(net.stat().st_size for net in nets) >= LARGE_BYTES:
            typer.echo(f"opening {path}", err=True)
