"""The time that one geo-context takes: at the same place again, and at a new place each time.

    python benchmarks/geo_context.py [ROUNDS]   # prints one JSON object, milliseconds

``same_place`` drives along one street, 1 cm a step; ``new_place`` jumps between cities of all continents, whose
rule files have been read once; ``new_country`` reads each country's rule files for the first time; ``first`` is the
very first context of a process.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from statistics import median, quantiles
from time import perf_counter

from automotive_cosim.contracts import (
    Around,
    DrivingState,
    GpsFix,
    Limit,
    LimitSource,
    RoadAhead,
    RoadHere,
    Weather,
)
from automotive_cosim.geo.locate import Geo

CITIES = (
    *((2.285, 48.873), (13.4, 52.52), (-0.12, 51.5), (12.5, 41.9), (-3.7, 40.42), (8.54, 47.37), (18.06, 59.33)),
    *((10.75, 59.91), (-73.98, 40.75), (-118.24, 34.05), (139.76, 35.68), (151.21, -33.87), (116.4, 39.9)),
    *((77.2, 28.6), (-46.63, -23.55), (55.3, 25.2), (28.05, -26.2), (-6.26, 53.35), (44.79, 41.72), (-30.0, 40.0)),
)
ROAD = RoadHere(
    *(
        "e",
        "e_0",
        0,
        1,
        10.0,
        "Avenue Foch",
        "primary",
        Limit(50 / 3.6, LimitSource.POSTED),
        False,
        None,
        None,
        None,
        1.0,
    )
)
CAR = DrivingState(
    *(0.0, 0.0, 0.0, None, None, 90.0, 15.0, 0.0, 0.0, 0.0),
    ROAD,
    RoadAhead(1000.0, 100.0, 0.0, 1.0, None, 0.0, None, None, None, None, None),
    Around(None, None, None, None, 1.0),
    hazard_lights=False,
    vehicle_count=1,
)
WEATHER = Weather(12.0, 80.0, 0.0, 45, 100.0, 300.0, 10.0)
START = datetime(2026, 1, 20, 9, tzinfo=UTC)


def measure(geo: Geo, places: Iterable[tuple[float, float]], *, text: bool) -> list[float]:
    """Milliseconds for each of the places."""
    taken = []
    for second, (lon, lat) in enumerate(places):
        fix = GpsFix(True, lon, lat, 3.0, 0.0, 90.0)
        time = START + timedelta(seconds=second)
        begin = perf_counter()
        context = geo.locate(CAR, fix, WEATHER, time)
        if text:
            context.text()
        taken.append((perf_counter() - begin) * 1000)
    return taken


def main() -> None:
    geo = Geo()
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    first = measure(geo, CITIES[:1], text=False)
    unread = measure(geo, CITIES[1:], text=False)
    street = [(2.285 + index * 1e-7, 48.873) for index in range(rounds)]
    world = [CITIES[index % len(CITIES)] for index in range(rounds)]
    figures = {"first_ms": first[0], "new_country_median_ms": median(unread), "new_country_worst_ms": max(unread)}
    for name, places in (("same_place", street), ("new_place", world)):
        for text in (False, True):
            taken = measure(geo, places, text=text)
            key = f"{name}{'_with_text' if text else ''}"
            figures[f"{key}_median_ms"] = median(taken)
            figures[f"{key}_p99_ms"] = quantiles(taken, n=100)[98]
    print(json.dumps({name: round(value, 4) for name, value in figures.items()}))


if __name__ == "__main__":
    main()
