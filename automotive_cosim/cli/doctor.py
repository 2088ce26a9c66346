"""``automotive-cosim doctor``: what is missing on this machine, and how to install it."""

from __future__ import annotations

import os
import platform
import shutil
import socket
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from enum import StrEnum
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import typer

from automotive_cosim.cli.options import AsJson, print_json
from automotive_cosim.contracts.plain import counted

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


def doctor(
    as_json: AsJson = False,
) -> None:
    """Check this machine and say what is missing and how to install it.

    Exit code 1 if episodes cannot run.
    """
    findings = [check() for check in CHECKS]
    ready = all(each.state is not Health.MISSING for each in findings)
    if as_json:
        print_json({"ok": ready, "checks": [asdict(each) for each in findings]})
    else:
        for each in findings:
            typer.echo(f"{each.state:<9}{each.about:<12}{each.found}" + (f"; {each.fix}" if each.fix else ""))
        typer.echo("ready" if ready else "not ready: fix what is missing")
    if not ready:
        raise typer.Exit(1)


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
