"""What can be set about an episode by words. Each field is an option of ``run``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge

from automotive_cosim.contracts import lon_lat
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import Latitude, Longitude, Option

DEFAULT_TASK = "road_speed_80_in_50"
ANYWHERE = "hvac_fan_max"
"""The default task of ``run`` in other places than its own: it comes about wherever a car drives, the other one
only where the right limit is posted."""


def read_origin(text: str) -> tuple[float, float]:
    """A longitude and latitude in degrees. Raises UserError: it is no position on earth."""
    try:
        found = lon_lat(text)
    except ValueError as error:
        raise UserError(f"--origin: {error}") from error
    if found is None:
        raise UserError(f"--origin {text!r} is not a longitude and latitude; give degrees such as 9.19,45.46")
    return found


@dataclass(frozen=True, slots=True)
class EpisodeSettings:
    """What is run, and where; the same with the same actions gives the same trace."""

    task: Annotated[str, Option(default=f"{DEFAULT_TASK}, elsewhere {ANYWHERE}")] = DEFAULT_TASK
    """Id of the task, one of `tasks list`."""
    half: str = "first"
    """Half of a pair: `first` or `second`."""
    scenario: str | None = None
    """A scenario's name or folder, or any .sumocfg or .net.xml(.gz), instead of the task's or drive's own."""
    origin: Annotated[tuple[Longitude, Latitude] | None, Option(form="LON,LAT", read=read_origin)] = None
    """Move the centre of the network to this place, with its law, clock and climate; the task's own date, time and
    weather stay."""
    gps: bool = True
    """Without GPS the place is unknown, and the network needs no projection."""
    from_place: Annotated[str, Option("from", form="PLACE")] = ""
    """Where the car's route begins, instead of the task's trip: a street, an edge or LON,LAT."""
    to_place: Annotated[str, Option("to", form="PLACE")] = ""
    """Where it ends; if only one of the two is given, the other is drawn."""
    seed: Annotated[int, Ge(0)] = 0
    """Seed of the traffic, and of everything that is drawn; the same seed gives the same trace."""
