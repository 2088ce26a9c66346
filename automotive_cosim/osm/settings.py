"""What can be set about an import and a download. Each field is an option of its command."""

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


@dataclass(frozen=True, slots=True)
class DownloadLimits:
    """How patient a download is."""

    timeout_s: Annotated[float, Ge(1), Le(3600), Option(form="S")] = 180.0
    """Seconds without an answer before giving up."""
    tries: Annotated[int, Ge(1), Le(20)] = 4
    """Maximum number of requests to a busy server."""
    size_mb: Annotated[float, Ge(0.001), Le(10_000), Option("max-mb", form="MB")] = 500.0
    """Size limit of the map."""
