"""The drive families over all shipped scenarios, from ``families.toml``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from automotive_cosim.contracts import Weather
from automotive_cosim.drives.family import Family, Season
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.shipped import fields_of, shipped_table


def family_named(name: str) -> Family:
    """The family of drives by name.

    Raises:
        UnknownNameError: there is none.
    """
    if name not in FAMILIES:
        raise UnknownNameError("family of drives", name, FAMILIES, "automotive-cosim show drives")
    return FAMILIES[name]


def _read() -> dict[str, Family]:
    told = shipped_table("drives", "families.toml")
    mixes = told.pop("mixes")
    return {name: _family(name, mixes, **fields) for name, fields in told.items()}


def _family(
    name: str,
    mixes: Mapping[str, Sequence[str]],
    *,
    season: str,
    weather: Sequence[Any],
    cast: Sequence[str],
    **plain: Any,
) -> Family:
    """A family of its table, in which a name in capitals stands for a mix of kinds."""
    kinds = tuple(kind for word in cast for kind in mixes.get(word, (word,)))
    return Family(id=name, season=Season(season), weather=Weather(*weather), cast=kinds, **fields_of(plain))


FAMILIES: Mapping[str, Family] = _read()
"""Every family by its id."""
