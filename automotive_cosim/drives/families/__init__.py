"""The drive families over all shipped scenarios. They are fixed: another one gets another id."""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.drives.families.country import BEAUCE
from automotive_cosim.drives.families.town import GRID
from automotive_cosim.drives.family import Family

FAMILIES: Mapping[str, Family] = {family.id: family for family in (*BEAUCE, *GRID)}
"""Every family by its id."""

__all__ = ["FAMILIES"]
