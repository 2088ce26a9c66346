"""From when on an encounter is critical."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Gt

from automotive_cosim.formats.annotations import Option
from automotive_cosim.measures.formulas import REACTION_S


@dataclass(frozen=True, slots=True)
class Thresholds:
    """From when on an encounter is critical, and what counts as one."""

    ttc_s: Annotated[float, Gt(0), Option(form="S")] = 3.0
    """TTC up to which a driver is exposed (Minderhoud and Bovy, 2001; default of SUMO's SSM device). SSAM has 1.5,
    the threshold of a serious conflict."""
    drac_mps2: Annotated[float, Gt(0), Option("drac", form="MPS2")] = 3.4
    """DRAC from which a conflict is serious (Archer, 2005: 3.35; AASHTO's comfortable limit is 3.4). SUMO's SSM
    device has 3.0."""
    mdrac_mps2: Annotated[float, Gt(0)] = 3.4
    """The same of the MDRAC (default of SUMO's SSM device)."""
    pet_s: Annotated[float, Gt(0), Option(form="S")] = 2.0
    """PET up to which a crossing is a conflict (default of SUMO's SSM device). SSAM has 5.0, serious from 1.5."""
    range_m: Annotated[float, Gt(0), Option("range", form="M")] = 50.0
    """How far the others are looked at, from front to front (default of SUMO's SSM device)."""
    reaction_s: Annotated[float, Gt(0)] = REACTION_S
    """Reaction time in the MDRAC."""
    joins_s: Annotated[float, Gt(0)] = 2.0
    """Critical readings of one pair with a shorter break between them are one encounter (our choice)."""
    following_below_deg: Annotated[float, Gt(0)] = 30.0
    """Angle between headings below which one follows the other (SSAM: rear end)."""
    crossing_above_deg: Annotated[float, Gt(0)] = 85.0
    """Angle above which they cross, and below which they merge (SSAM)."""


DEFAULT_THRESHOLDS = Thresholds()
"""The customary thresholds."""
