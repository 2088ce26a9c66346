"""The signals as a standard VSS tree, in the format of the vss-tools JSON exporter.

    {"Vehicle": {"type": "branch", "description": ..., "children": {"Speed": {"type": "sensor", ...}}}}

(https://covesa.github.io/vehicle_signal_specification/). What VSS 6.0 lacks is in the same tree, with a comment.
"""

from __future__ import annotations

import re
from typing import Any

from automotive_cosim.cockpit.signals import CATALOGUE, Signal
from automotive_cosim.contracts import Json

DATATYPES = {bool: "boolean", float: "float", str: "string"}
"""VSS type of each signal type."""
OVERLAY = "Overlay: not in VSS 6.0."
_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z][a-z]+|\d+")


def tree() -> Json:
    """The whole tree, branches with their children, in the catalogue's order."""
    root: Json = {}
    for path, signal in CATALOGUE.items():
        *branches, name = path.split(".")
        level = root
        for depth, branch in enumerate(branches):
            node = level.setdefault(branch, _branch(branches[: depth + 1]))
            level = node["children"]
        level[name] = _leaf(signal)
    return root


def _branch(parts: list[str]) -> Json:
    return {"type": "branch", "description": _described(parts), "children": {}}


def _leaf(signal: Signal[Any]) -> Json:
    leaf: Json = {
        "type": str(signal.kind),
        "datatype": DATATYPES[float if signal.optional else type(signal.default)],
        "description": _described(signal.path.split(".")),
    }
    facts = {
        "unit": signal.unit or None,
        "min": signal.minimum,
        "max": signal.maximum,
        "allowed": list(signal.allowed) or None,
        "default": signal.default,
        "comment": OVERLAY if signal.overlay else None,
    }
    return leaf | {name: value for name, value in facts.items() if value is not None}


def _described(parts: list[str]) -> str:
    """A path in words: ``Is locked (cabin, door, row 1, driver side).``"""
    *places, name = (" ".join(_word(word) for word in _WORDS.findall(part)) for part in parts)
    within = f" ({', '.join(places[1:])})" if places[1:] else ""
    return f"{name[:1].upper()}{name[1:]}{within}."


def _word(word: str) -> str:
    return word if word.isupper() and len(word) > 1 else word.lower()
