"""The protocol's own calculator, run in the environment that it is installed in; nothing of it is imported here."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import SetupError
from automotive_cosim.formats.files import parse_json
from automotive_cosim.safety.protocol.evidence import Evidence, Protocol

COMMAND = "euroncap_rating_2026"
LASTS_S = 300.0
"""Longest that it may take; it takes some ten seconds."""
ASSUMED = ("SLIF - General requirements",)
"""What has to be met for anything to be scored, and no trial shows."""
KPI = " KPI"
"""What ends the names of the accuracy's rows where they are filled in."""
Scores = Mapping[str, tuple[float, float]]
"""Points and the most there are, by the calculator's name of a row or category."""


def install(made: Protocol) -> str:
    """How to install the calculator, in one line."""
    return f"pipx install {made.package}=={made.version}"


def points(made: Protocol, found: Sequence[Evidence]) -> tuple[Scores, Scores]:
    """Least and most points: with all that was not tried taken as failed, and as passed.

    Raises SetupError: the calculator is not installed, is another one than the protocol's file names, or fails."""
    command = shutil.which(COMMAND)
    if command is None:
        raise SetupError(f"no points: {COMMAND} is not on the PATH; {install(made)}")
    # A tool's command is a link into its own environment, where its Python lies beside it.
    home = Path(command).resolve().parent
    python = next((each for name in ("python", "python3", "python.exe") if (each := home / name).is_file()), None)
    if python is None:
        raise SetupError(f"no points: no Python lies beside {command}; {install(made)}")
    wanted = {"version": made.version, "sha256": made.sha256}
    values = [_values(made, found, untried=untried) for untried in (False, True)]
    request = {"package": made.package, "wanted": wanted, "values": values}
    program = str(files("automotive_cosim.safety.protocol").joinpath("calculate.py"))
    try:
        done = subprocess.run(
            [str(python), "-I", program],
            input=json.dumps(request).encode(),
            capture_output=True,
            timeout=LASTS_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise SetupError(f"no points: the calculator did not end: {error}") from error
    if done.returncode:
        last = done.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["without a word"]
        raise SetupError(f"no points: the calculator failed: {last[0]}")
    told = parse_json(done.stdout)
    if "points" not in told:
        raise SetupError(
            f"no points: {made.package} {told['version']} is installed (sha256 {told['sha256'][:12]}), and this "
            f"report knows {made.version} ({made.sha256[:12]}); {install(made)} --force"
        )
    least, most = ({name: (has[0], has[1]) for name, has in each.items()} for each in told["points"])
    return least, most


def _values(made: Protocol, found: Sequence[Evidence], *, untried: bool) -> Json:
    """What is filled in: a row holds if every trial of it succeeded."""
    limits: dict[str, dict[str, bool | None]] = {}
    hazards: dict[str, bool | None] = {}
    verified: dict[str, bool] = dict.fromkeys(ASSUMED, True)
    for each in found:
        match each.row.part:
            case "limits":
                by_country = each.by_country.items()
                limits[each.row.name] = {
                    made.countries[country]: one.holds for country, one in by_country if country in made.countries
                }
            case "hazards" if each.holds is not None:
                hazards[each.row.name] = each.holds
            case "accuracy" | "controls":
                holds = untried if each.holds is None else each.holds
                verified[each.row.name + (KPI if each.row.part == "accuracy" else "")] = holds
    return {"limits": limits, "hazards": hazards, "verified": verified, "untried": untried}
