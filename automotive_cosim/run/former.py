"""Modes, which earlier versions had: ``prompted``, which every episode is now, and ``monitoring``, now drives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from automotive_cosim.errors import UserError

INSTEAD = "drives have replaced monitoring: `automotive-cosim drive`, and `automotive-cosim eval --drives all`"


def without_mode(values: Mapping[str, Any], where: str) -> dict[str, Any]:
    """A plan or an episode's setup without its modes, so that one of an earlier version can be read.

    Args:
        values: its fields.
        where: what they were read from.

    Raises:
        UserError: it has another mode than ``prompted``.
    """
    for name in ("mode", "modes"):
        if name in values and values[name] not in ("prompted", ["prompted"]):
            raise UserError(f"{where} has an older format: its {name} is {values[name]!r}; {INSTEAD}")
    return {name: value for name, value in values.items() if name not in ("mode", "modes")}
