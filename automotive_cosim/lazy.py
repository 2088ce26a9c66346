"""Packages that load their names at first use: to import all of them takes longer than most commands.

Which names, and where each is defined, stands in the package's stub, ``__init__.pyi``, which type checkers read.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path


def lazily(package: str, file: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """``__getattr__`` and ``__dir__`` of a package, by its ``__name__`` and ``__file__``."""

    @cache
    def homes() -> Mapping[str, str]:
        body = ast.parse(Path(file).with_suffix(".pyi").read_text(encoding="utf-8")).body
        found = [node for node in body if isinstance(node, ast.ImportFrom)]
        return {each.name: str(node.module) for node in found for each in node.names}

    def get(name: str) -> object:
        if name == "__all__":
            return sorted(homes())
        if name.startswith("__") or name not in homes():
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(import_module(homes()[name]), name)
        setattr(sys.modules[package], name, value)
        return value

    return get, lambda: sorted({*vars(sys.modules[package]), *homes()})
