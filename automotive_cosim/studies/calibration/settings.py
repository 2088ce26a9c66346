"""What can be set about a calibration. Each field is an option of its command."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import Option

HOURS = re.compile(r"(\d{1,2})(?:-(\d{1,2}))?")


def first_and_last(text: str) -> tuple[int, int]:
    """The hours in ``7-9`` or ``8``. Raises UserError: it is neither."""
    found = HOURS.fullmatch(text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (24, 24)
    if not first <= last < 24:
        raise UserError(f"--hours {text!r} is not FIRST-LAST, each from 0 to 23, such as 7-9")
    return first, last


@dataclass(frozen=True, slots=True)
class CalibrationOptions:
    """What can be set about a calibration."""

    sites: Annotated[Path | None, Option(default="columns of --counts")] = None
    """Table with site and edge or lon,lat,bearing; or SUMO's file of detectors."""
    times: Annotated[Path | None, Option(default="none")] = None
    """Measured travel times to compare: from_edge,to_edge,hour,seconds."""
    hours: Annotated[
        tuple[int, int] | None, Option(default="all counted", form="FIRST[-LAST]", read=first_and_last)
    ] = None
    """Local hours to calibrate."""
    at_hour: Annotated[int | None, Ge(0), Le(23), Option("at", default="the first", form="HOUR")] = None
    """Local hour at which the ego departs."""
    hold_out: Annotated[float, Ge(0), Le(0.9), Option(form="SHARE")] = 0.3
    """Share of the sites to hold out of the fit."""
    rounds: Annotated[int, Ge(1), Le(50)] = 10
    """Maximum rounds of fit and simulation."""
    seed: Annotated[int, Ge(0), Le(2**31 - 2)] = 0
    """Seed of everything random."""
