"""Tables that come with the package, as TOML beside the module that reads them."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from importlib.resources import files
from typing import Any


def shipped_table(package: str, name: str) -> dict[str, Any]:
    """A file's table, read anew at each call.

    Args:
        package: below ``automotive_cosim``, as ``traffic``.
        name: the file's."""
    return tomllib.loads(files(f"automotive_cosim.{package}").joinpath(name).read_text("utf-8"))


def fields_of(table: Mapping[str, Any]) -> dict[str, Any]:
    """A table as the fields of a frozen dataclass, which has tuples where TOML has lists."""
    return {name: tuple(value) if isinstance(value, list) else value for name, value in table.items()}
