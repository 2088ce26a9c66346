"""Country roads and villages."""

from __future__ import annotations

from automotive_cosim.contracts import Weather
from automotive_cosim.drives.family import Family, Season

BEAUCE = (
    Family(
        id="beauce_november",
        about="Village to village on the Beauce plain, a grey November morning.",
        season=Season.WINTER,
        scenario="beauce",
        trips=("villages", "plain"),
        starts=("2026-11-17T08:15:00", "2026-11-22T10:40:00"),
        weather=Weather(4.0, 92.0, 0.0, 3, 95.0, 9000.0, 8.0),
        cast=("over_limit", "leader_close", "belt", "door", "tyre", "blue_light", "leader_brakes", "fatigue"),
    ),
)
