"""``automotive-cosim doctor``: what is missing on this machine, and how to install it."""

from __future__ import annotations

import os
import platform
import shutil
import socket
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from enum import StrEnum
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from automotive_cosim.cli.options import print_json, tells_json
from automotive_cosim.contracts.plain import counted

STEP_IN, STEP_OUT = 600, 50
"""Tokens that a step of T3A with a short prompt reads anew and writes, where the rest is in the runtime's cache."""
MEMORY_MB = 1000
"""For two workers on the shipped scenarios, each with a warm simulation (benchmarks/README.md)."""
DISK_MB = 500
"""For the scratch folders of simulations and an evaluation's results."""


class Health(StrEnum):
    """How a check ended."""

    OK = "ok"
    LIMITED = "limited"
    """It works, with limitations."""
    MISSING = "missing"
    """The package cannot run episodes."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What one check found."""

    about: str
    state: Health
    found: str
    fix: str = ""
    """What to do; empty if there is nothing to do."""


class Extra(NamedTuple):
    """An optional dependency: a package that it needs, and the commands that need it."""

    package: str
    used_by: str


EXTRAS = {
    "maps": Extra("osmium", "scenarios import and download"),
    "models": Extra("httpx2", "--model openai/NAME and --model local"),
    "reports": Extra("matplotlib", "report, tables as Parquet and PDFs"),
    "safety": Extra("optuna", "search and export to OSI"),
    "rl": Extra("stable_baselines3", "training in Flat-v0 and FlatDrive-v0"),
    "doors": Extra("mcp", "mcp, a2a and --agent a2a:http://HOST:PORT"),
    "harnesses": Extra("inspect_ai", "Inspect and verifiers"),
    "voice": Extra("faster_whisper", "--hear cabin with words that nobody has said yet"),
    "cluster": Extra("ray", "eval and study on many machines"),
}


@tells_json
def doctor(
    model: Annotated[
        str,
        typer.Option(
            help="Also try a local model, local/FILE.gguf: how long a question it takes, how fast it is, and how "
            "long it needs for the leaderboard's plan.",
            metavar="NAME",
            show_default=False,
        ),
    ] = "",
    as_json: bool = False,
) -> None:
    """Check this machine and say what is missing and how to install it.

    Exit code 1 if episodes cannot run."""
    tried = list(_of_model(model)) if model else []
    findings = [*(check() for check in CHECKS), *tried]
    ready = all(each.state is not Health.MISSING for each in findings)
    if as_json:
        print_json({"ok": ready, "checks": [asdict(each) for each in findings]})
    else:
        for each in findings:
            typer.echo(f"{each.state:<9}{each.about:<12}{each.found}" + (f"; {each.fix}" if each.fix else ""))
        typer.echo("ready" if ready else "not ready: fix what is missing")
    if not ready:
        raise typer.Exit(1)


def _of_model(name: str) -> Iterator[Finding]:
    """What there is to say about a model of this machine, of which two questions are asked.

    Raises:
        UserError: it is no model of this machine, or its file none that can be run.
        SetupError: its runtime is not installed."""
    from automotive_cosim.errors import UserError
    from automotive_cosim.formats.files import file_sha256
    from automotive_cosim.models.base import ChatMessage
    from automotive_cosim.models.gguf import KNOWN, read_model_file
    from automotive_cosim.models.local import Local, is_local
    from automotive_cosim.run.plan import BOARD, make_plan, read_plan

    if not is_local(name):
        raise UserError(f"--model {name!r} is no model of this machine; give local or local/FILE.gguf")
    model = Local(name)
    told, sha256 = read_model_file(model.file), file_sha256(model.file)
    known = KNOWN.get(sha256)
    yield Finding("model", Health.OK, f"{known.model}, by {known.maker}" if known else told.name)
    fix = "" if known else "not tried here: compare it with the hash that its maker publishes"
    yield Finding("its file", Health.OK if known else Health.LIMITED, f"sha256 {sha256}", fix)
    if not told.has_template:
        fix = "give a model that was trained to follow instructions"
        yield Finding("answers", Health.LIMITED, "no template of conversations in the file", fix)
    room = f"{model.context_tokens:,} tokens of a question (?context=N for more)"
    trained = f"{told.context:,} tokens trained on" if told.context else "the file names no length"
    is_short = 0 < told.context < model.context_tokens
    yield Finding("context", Health.LIMITED if is_short else Health.OK, f"{trained}; {room}")
    yield Finding("tools", Health.OK, "functions in its template" if told.has_tools else "none in its template")
    yield Finding("pictures", Health.OK, "none: the local runtime is given text alone")
    read, wrote = (Local(f"{name}{'&' if '?' in name else '?'}max_tokens={most}") for most in (1, 32))
    asked = read.chat([ChatMessage("user", "Count. " + " ".join(map(str, range(120))))])
    said = wrote.chat([ChatMessage("user", "Count from one to fifty, in words.")])
    in_per_s, out_per_s = asked.tokens_in / asked.seconds, said.tokens_out / max(said.seconds, 0.001)
    yield Finding("speed", Health.OK, f"{in_per_s:.0f} tokens a second read, {out_per_s:.0f} written, here and now")
    plan = make_plan(read_plan(Path(BOARD.stem)) | {"agents": ["t3a"]})
    steps = len(plan.jobs()) * plan.limits.steps
    minutes = steps * (STEP_IN / in_per_s + STEP_OUT / out_per_s) / 60
    found = f"{minutes:.0f} minutes at most for one agent, {counted(steps, 'step')}: --plan board --prompt short"
    yield Finding("the board", Health.OK, found)


def _python() -> Finding:
    return Finding("python", Health.OK, f"{platform.python_version()} on {platform.platform(terse=True)}")


def _folders() -> Finding:
    """A checkout that is not installed finds them by links, which git on Windows leaves as text files."""
    missing = [name for name in ("tasks", "agents", "sumo_scenarios") if not _is_package(name)]
    if not missing:
        return Finding("folders", Health.OK, "tasks, agents and scenarios found")
    fix = "install the checkout (`pip install -e .`) or the wheel, which do without the checkout's links"
    return Finding("folders", Health.MISSING, f"automotive_cosim has no {', '.join(missing)}", fix)


def _is_package(name: str) -> bool:
    try:
        return find_spec(f"automotive_cosim.{name}") is not None
    except ImportError:
        return False


def _sumo() -> Finding:
    from automotive_cosim.errors import SetupError
    from automotive_cosim.traffic.sumo import load_library

    try:
        load_library()
    except SetupError as error:
        found, _, fix = str(error).partition(": ")
        return Finding("SUMO", Health.MISSING, found, fix)
    return Finding("SUMO", Health.OK, f"libsumo {version('libsumo')}")


def _fonts() -> Finding:
    from automotive_cosim.cockpit.theme import Weight, font, sets_right_to_left
    from automotive_cosim.errors import SetupError, install_hint

    try:
        for weight in set(Weight) - {Weight.RIGHT_TO_LEFT}:
            font(weight, 16)
    except (SetupError, OSError) as error:
        return Finding("fonts", Health.MISSING, str(error), f"{install_hint()} --force-reinstall")
    if not sets_right_to_left():
        fix = f"for those: {install_hint('reports')}; on Debian also apt-get install libfribidi0"
        return Finding("fonts", Health.OK, "all fonts of the screens, but no Arabic or Hebrew", fix)
    return Finding("fonts", Health.OK, "all fonts of the screens")


def _processes() -> Finding:
    if hasattr(os, "fork"):
        return Finding("processes", Health.OK, f"fork; {counted(_cores(), 'core')}")
    return Finding("processes", Health.MISSING, "no fork", "use Linux; on Windows WSL, on macOS a container")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _confinement() -> Finding:
    from automotive_cosim.traffic.confinement import version

    if version():
        return Finding("confinement", Health.OK, "SUMO can write only to its scratch folder (Landlock)")
    found = "this kernel keeps no process from writing; SUMO's files are still checked and copied"
    return Finding("confinement", Health.LIMITED, found, "for scenarios of others use Linux 5.13 or newer")


def _memory() -> Finding:
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        free_mb = next(int(line.split()[1]) // 1024 for line in lines if line.startswith("MemAvailable"))
    except (OSError, StopIteration, ValueError):
        return Finding("memory", Health.OK, "unknown on this system")
    found = f"{free_mb:,} MB available"
    if free_mb >= MEMORY_MB:
        return Finding("memory", Health.OK, found)
    return Finding("memory", Health.LIMITED, found, f"free {MEMORY_MB:,} MB, or give eval --workers 1")


def _disk() -> Finding:
    scratch = tempfile.gettempdir()
    free_mb = shutil.disk_usage(scratch).free // 2**20
    found = f"{free_mb:,} MB free in {scratch}"
    if free_mb >= DISK_MB:
        return Finding("disk", Health.OK, found)
    return Finding("disk", Health.LIMITED, found, "free some space, or set TMPDIR to a folder on another disk")


def _ports() -> Finding:
    try:
        with socket.create_server(("127.0.0.1", 0)):
            return Finding("ports", Health.OK, "a server can listen on 127.0.0.1")
    except OSError as error:
        found = f"no server can listen on 127.0.0.1 ({error.strerror})"
        return Finding("ports", Health.LIMITED, found, "Ray and serve need one; everything else runs without")


def _extras() -> Finding:
    lacking = {name: extra for name, extra in EXTRAS.items() if find_spec(extra.package) is None}
    here = [name for name in EXTRAS if name not in lacking]
    found = f"installed: {', '.join(here) or 'none'}"
    if not lacking:
        return Finding("extras", Health.OK, found)
    uses = "; ".join(f"[{name}] for {extra.used_by}" for name, extra in lacking.items())
    return Finding("extras", Health.OK, f"{found}; not installed: {uses}")


def _version() -> Finding:
    from automotive_cosim.errors import install_hint

    try:
        return Finding("package", Health.OK, f"automotive-cosim {version('automotive-cosim')}")
    except PackageNotFoundError:
        return Finding("package", Health.LIMITED, "runs from a folder, but is not installed", install_hint())


CHECKS: tuple[Callable[[], Finding], ...] = (
    _version,
    _python,
    _folders,
    _sumo,
    _fonts,
    _processes,
    _confinement,
    _memory,
    _disk,
    _ports,
    _extras,
)
