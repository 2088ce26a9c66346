"""SUMO's own programs, only from the installed ``eclipse-sumo`` distribution.

A ``SUMO_HOME`` of another version would select that version's data and type maps, so it is neither read nor set in
this process: the programs get an environment of their own.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import Distribution, PackageNotFoundError, distribution, version
from pathlib import Path

from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.traffic.confinement import confined

INSTALL = install_hint("maps")


def home() -> Path:
    """The folder with SUMO's ``bin``, ``data`` and ``tools``.

    Raises SetupError: eclipse-sumo is not installed, or in another version than libsumo."""
    try:
        installed: Distribution = distribution("eclipse-sumo")
    except PackageNotFoundError as error:
        raise SetupError(
            f"this requires SUMO's programs (eclipse-sumo), which are not installed: {INSTALL}"
        ) from error
    if installed.version != version("libsumo"):
        raise SetupError(f"eclipse-sumo {installed.version} and libsumo {version('libsumo')} differ: {INSTALL}")
    return Path(str(installed.locate_file("sumo")))


def program(name: str) -> Path:
    """The path of ``netconvert``, ``duarouter``, ``sumo``, …

    Raises SetupError: it is not installed."""
    path = home() / "bin" / name
    if not path.is_file():
        raise SetupError(f"eclipse-sumo is installed without {name}; install it again: {INSTALL}")
    return path


def environment() -> Mapping[str, str]:
    """The environment SUMO's programs run in: ours, but with the installed SUMO's own data."""
    data = home() / "data"
    return os.environ | {"SUMO_HOME": str(home()), "PROJ_DATA": str(data / "proj"), "PROJ_LIB": str(data / "proj")}


def run(
    name: str,
    arguments: Sequence[str | Path],
    folder: Path | None = None,
    heard: Callable[[str], None] = lambda line: None,
) -> tuple[bool, str]:
    """Runs a program to its end.

    Args:
        arguments: its options. A comma in a file's name parts two files, and a colon a host from its port: name
            files in a folder that anybody chose from within it.
        folder: where it runs; it can then write nowhere else, if the kernel can see to that.
        heard: called with each line as it is printed; with ``--verbose``, these are the program's own stages.

    Returns:
        Whether it succeeded, and everything it printed."""
    command = [str(program(name)), *map(str, arguments)]
    lines: list[str] = []
    with subprocess.Popen(
        command if folder is None else confined(folder, command),
        cwd=folder,
        env=environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    ) as process:
        try:
            for line in process.stdout or ():
                lines.append(line)
                heard(line.strip())
        except BaseException:
            process.kill()
            raise
    return process.returncode == 0, "".join(lines)


def first_error(printed: str) -> str:
    """The first ``Error:`` line of what a SUMO program printed; its last line if there is none."""
    lines = [line.strip() for line in printed.splitlines() if line.strip()]
    errors = [line.removeprefix("Error:").strip() for line in lines if line.startswith("Error:")]
    return (errors or lines[-1:] or ["it printed nothing"])[0]
