"""What a plan names of one's own, as hashes: results are not resumed with another agent or scenario of a name."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterable
from contextlib import suppress
from importlib.machinery import PathFinder
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.scenarios.opening import own_files


def own_code(agents: Iterable[str]) -> dict[str, str]:
    """The hash of the code of each ``package.module:Class`` among the names of agents.

    It covers the module's file, or all modules of its top-level package, and not what these import from elsewhere.
    Agents behind an address and those that are not found have none.
    """
    found: dict[str, str] = {}
    for name in agents:
        module, colon, made = name.partition(":")
        files = _files(module.partition(".")[0]) if colon and made.isidentifier() else []
        if files:
            found[name] = _sha256(files)
    return found


def own_scenarios(plan: Json) -> dict[str, dict[str, str]]:
    """The hashes of the files of each scenario of one's own that a plan names, by name of the file.

    Args:
        plan: with one ``scenario`` or several ``scenarios``. Those that cannot be read have none.
    """
    found: dict[str, dict[str, str]] = {}
    for name in (plan.get("scenario"), *(plan.get("scenarios") or ())):
        with suppress(UserError, OSError):
            named: dict[str, list[Path]] = {}
            for file in own_files(name) if name else ():
                named.setdefault(file.name, []).append(file)
            if named:
                found[str(name)] = {file: _sha256(paths) for file, paths in named.items()}
    return found


def _files(module: str) -> list[Path]:
    """The files of a top-level module, looked for as an import would, from the working folder on."""
    try:
        spec = PathFinder.find_spec(module, [str(Path.cwd()), *sys.path])
    except (ImportError, ValueError):
        return []
    if spec is None:
        return []
    if spec.submodule_search_locations is not None:
        return sorted(path for folder in spec.submodule_search_locations for path in Path(folder).rglob("*.py"))
    return [Path(spec.origin)] if spec.origin is not None and Path(spec.origin).is_file() else []


def _sha256(files: Iterable[Path]) -> str:
    hashed = hashlib.sha256()
    for path in files:
        with path.open("rb") as file:
            hashed.update(hashlib.file_digest(file, "sha256").digest())
    return hashed.hexdigest()
