"""The code of an agent of one's own, as a hash: results are not resumed with another agent of that name."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterable
from importlib.machinery import PathFinder
from pathlib import Path


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
        hashed.update(hashlib.sha256(path.read_bytes()).digest())
    return hashed.hexdigest()
