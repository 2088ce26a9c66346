"""Towns."""

from __future__ import annotations

from automotive_cosim.contracts import Weather
from automotive_cosim.drives.family import Family, Season

GRID = (
    Family(
        id="grid_march",
        about="Laps of a small town and its tunnel, a March morning.",
        season=Season.WINTER,
        scenario="grid",
        trips=("round", "tunnel", "avenue"),
        starts=("2026-03-10T08:30:00", "2026-03-15T11:00:00"),
        weather=Weather(9.0, 78.0, 0.0, 2, 40.0, 24000.0, 18.0),
        cast=("over_limit", "leader_close", "belt", "door", "tyre", "blue_light", "leader_brakes"),
    ),
)
