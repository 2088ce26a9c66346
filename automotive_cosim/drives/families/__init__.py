"""The drive families over all shipped scenarios. They are fixed: another one gets another id."""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.drives.families.country import COUNTRY
from automotive_cosim.drives.families.motorways import MOTORWAYS
from automotive_cosim.drives.families.towns import TOWNS
from automotive_cosim.drives.family import Family
from automotive_cosim.errors import UnknownNameError

FAMILIES: Mapping[str, Family] = {family.id: family for family in (*COUNTRY, *MOTORWAYS, *TOWNS)}
"""Every family by its id."""


def family_named(name: str) -> Family:
    """The family of drives by name.

    Raises:
        UnknownNameError: there is none.
    """
    if name not in FAMILIES:
        raise UnknownNameError("family of drives", name, FAMILIES, "automotive-cosim show drives")
    return FAMILIES[name]


__all__ = ["FAMILIES", "family_named"]
