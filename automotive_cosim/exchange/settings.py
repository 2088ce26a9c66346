"""The formats in which a kept trial can be written. Each field is an option of ``export``."""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Annotated

from automotive_cosim.formats.annotations import Option


@dataclass(frozen=True, slots=True)
class ExportFormats:
    """What is written."""

    openscenario: Annotated[str | None, Option(form="VERSION")] = None
    """Write scenario.xosc in this version of OpenSCENARIO XML: 1.2 or 1.3."""
    opendrive: bool = False
    """Write the road as road.xodr, which scenario.xosc then names."""
    osi: bool = False
    """Write a trace of OSI ground truth, by the name that OSI recommends, as .osi and as .mcap."""
    ssam: bool = False
    """Write trajectories.trj, for FHWA's Surrogate Safety Assessment Model."""
    fcd: bool = False
    """Write fcd.xml, SUMO's floating car data."""
    csv: bool = False
    """Write trajectories.csv."""
    parquet: bool = False
    """Write trajectories.parquet."""

    def __bool__(self) -> bool:
        return any(astuple(self))
