"""What can be set about an import. Each field is an option of ``scenarios import``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.formats.annotations import Option
from automotive_cosim.osm.area import Area


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """What can be set about an import."""

    name: str = ""
    """The scenario's name; by default, the file's."""
    country: str = ""
    """ISO 3166-1 code such as FR; by default, from the map's position."""
    area: Annotated[Area | None, Option("bbox", default="all", form="W,S,E,N", read=Area.parse)] = None
    """Use only what is within this box, in degrees."""
    density_per_km: Annotated[float, Option("density")] = 1.0
    """Vehicles per km of lane at a time if all drove freely, before scaling down."""
    seed: Annotated[int, Ge(0), Le(2**31 - 2)] = 0
    """Seed of the traffic and the ego trips."""
    stable_for_min: Annotated[float, Ge(1), Le(110), Option("minutes", form="M")] = 30.0
    """Minutes for which the traffic must flow after its warm-up."""
    quick: bool = False
    """Use light traffic, and test it for only ten minutes."""
    replaces: Annotated[bool, Option("force")] = False
    """Replace the scenario in --out."""
