"""Interventions and incidents in words, for tables and answers: ``c2c3 closed`` for ``closure edge=c2c3``."""

from __future__ import annotations

from collections.abc import Mapping
from string import Formatter

from automotive_cosim.scenarios.wording import spelled

PHRASES: Mapping[str, str] = {
    "breakdown": "breakdown on {edge}",
    "sign": "sign of {limit_kmh} km/h on {edges}",
    "roadworks": "roadworks on {edge} at {limit_kmh} km/h",
    "jam": "jam of {length_m} m on {edges}",
    "closure": "{edge} closed",
    "school_zone": "school zone on {edges}, {limit_kmh} km/h from {opens} to {closes}",
    "rush_hour": "demand × {scale}",
    "tractor": "tractor from {from_edge} to {to_edge}",
    "pedestrians": "pedestrians from {from_edge} to {to_edge}",
    "vehicle": "a vehicle on {route}",
    "advice": "advice to {share} of the cars",
    "signals": "{control} signals",
}
"""By kind, with the fields that it requires."""

FIELDS: Mapping[str, str] = {
    "age_s": "news {} s old",
    "closed_lanes": "lane {} closed",
    "compliance": "{} follow",
    "every_s": "every {} s",
    "from_s": "from {} s on",
    "hold_s": "one car per lane passes every {} s",
    "least_s": "if {} s are saved",
    "position_m": "at {} m",
    "to_s": "until {} s",
}
"""Words for other fields; the rest are told by name."""

VALUES: Mapping[str, str] = {"static": "fixed", "delay_based": "delay-based"}
SHARES = frozenset({"share", "compliance"})
"""Fields told as a percentage."""


def name_of(text: str) -> str:
    """An intervention or incident as its line says it, in words; two that differ have different names.

    Args:
        text: a line that a plan has checked, as ``closure edge=c2c3``; empty for no intervention."""
    kind, *pairs = text.split() or [""]
    phrase = PHRASES.get(kind)
    if phrase is None:
        return text or "none"
    said = {name for _, name, _, _ in Formatter().parse(phrase) if name}
    split = (pair.partition("=") for pair in pairs)
    given = {spelled(name, said): _told(name, value) for name, _, value in split}
    rest = (
        FIELDS.get(name, f"{name.replace('_', ' ')} {{}}").format(given[name]) for name in given if name not in said
    )
    return ", ".join((phrase.format(**given), *rest))


def _told(name: str, value: str) -> str:
    return f"{100 * float(value):g} %" if name in SHARES else VALUES.get(value, value)
