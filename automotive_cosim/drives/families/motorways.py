"""Motorways and ring roads."""

from __future__ import annotations

from automotive_cosim.contracts import Weather
from automotive_cosim.drives.families.event_mixes import CAR, COLD, DARK, DRIVER, PARKS, ROAD, WET
from automotive_cosim.drives.family import Family, Season

MOTORWAYS = (
    Family(
        id="autobahn_january",
        about="The A 5 between Frankfurt and Darmstadt on a January evening.",
        season=Season.WINTER,
        scenario="autobahn",
        trips=("south", "north"),
        starts=("2026-01-14T17:40:00", "2026-01-18T18:30:00"),
        weather=Weather(1.5, 90.0, 0.0, 3, 95.0, 9000.0, 9.0),
        cast=(*DRIVER, *CAR, "leader_brakes", "blue_light", "breakdown", *DARK, *COLD, "wipers", "range"),
    ),
    Family(
        id="autobahn_july",
        about="The same motorway on a July day.",
        season=Season.SUMMER,
        scenario="autobahn",
        trips=("south", "north"),
        starts=("2026-07-15T09:30:00", "2026-07-19T15:00:00"),
        weather=Weather(23.0, 58.0, 0.0, 1, 30.0, 24000.0, 12.0),
        cast=(*DRIVER, *CAR, "leader_brakes", *ROAD, "wipers", "range"),
    ),
    Family(
        id="peripherique_november",
        about="The périphérique and the streets beside it on a November evening.",
        season=Season.WINTER,
        scenario="peripherique",
        trips=("south", "streets", "north", "off_and_on"),
        starts=("2026-11-17T18:10:00", "2026-11-22T19:00:00"),
        weather=Weather(9.0, 88.0, 0.0, 3, 100.0, 9000.0, 12.0),
        cast=(*DRIVER, *CAR, "blue_light", "breakdown", "jam_tail", "lamps", "fog_lamps", *WET),
    ),
    Family(
        id="peripherique_june",
        about="The same roads on a June day.",
        season=Season.SUMMER,
        scenario="peripherique",
        trips=("south", "streets", "north", "off_and_on"),
        starts=("2026-06-16T09:30:00", "2026-06-21T14:00:00"),
        weather=Weather(20.0, 60.0, 0.0, 1, 30.0, 22000.0, 10.0),
        cast=(*DRIVER, *CAR, *ROAD, "wipers"),
    ),
    Family(
        id="gulf_january",
        about="Dubai's motorway, its service road and Al Barsha on a January evening.",
        season=Season.WINTER,
        scenario="gulf",
        trips=("service_road", "sheikh_zayed"),
        starts=("2026-01-13T18:40:00", "2026-01-16T19:30:00"),
        weather=Weather(20.0, 66.0, 0.0, 1, 20.0, 12000.0, 12.0),
        cast=(
            *DRIVER,
            *PARKS,
            *CAR,
            "leader_brakes",
            "blue_light",
            "breakdown",
            "jam_tail",
            "lamps",
            "weather_speed",
        ),
    ),
    Family(
        id="gulf_july",
        about="The same roads in the heat of a July afternoon.",
        season=Season.SUMMER,
        scenario="gulf",
        trips=("service_road", "sheikh_zayed"),
        starts=("2026-07-14T14:10:00", "2026-07-17T10:00:00"),
        weather=Weather(41.0, 30.0, 0.0, 0, 5.0, 9000.0, 16.0),
        cast=(*DRIVER, *PARKS, *CAR, "leader_brakes", *ROAD),
    ),
)
