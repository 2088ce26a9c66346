"""The cars of a fleet in a report: all on a map, each of which opens a page's part about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from automotive_cosim.report.templates import render
from automotive_cosim.run.fleet_record import DrivenFleet


@dataclass(frozen=True, slots=True)
class FleetCar:
    """A car of a fleet as it is shown."""

    name: str
    """SUMO's id."""
    kind: str
    """How it looks on the map."""
    words: str
    """What became of it."""
    cells: Sequence[str]
    """Its figures in the list of cars."""
    error: str = ""
    """How its assistant failed; empty if it did not."""


def shown_fleet(
    fleet: DrivenFleet,
    cars: Sequence[FleetCar],
    kinds: Mapping[str, str],
    columns: Sequence[str],
    page: str,
    *,
    title: str,
    about: str,
    note: str,
) -> tuple[str, str]:
    """A map for the report, whose cars are links, and the page that they lead to, both as HTML.

    Args:
        fleet: where the cars drove.
        kinds: what each kind on the map means: ``sooner`` is green, ``later`` amber, ``same`` grey, ``failed`` red.
    """
    left, bottom, right, top = fleet.box_m
    drawn = {
        "box": f"{left:.0f} {-top:.0f} {right - left:.0f} {top - bottom:.0f}",
        "roads": " ".join(map(_path, fleet.roads)),
        "cars": [_drawn(number, car, fleet) for number, car in enumerate(cars, 1)],
        "dot": round(max(right - left, top - bottom) / 250, 1),
        "kinds": kinds,
    }
    told = {"title": title, "about": about, "columns": columns, "note": note}
    own = render("report/map.html", **drawn, page="")
    failed = sum(bool(car.error) for car in cars)
    return render("report/map.html", **drawn, page=page), render(
        "report/fleet.html", **drawn, **told, map=own, failed=failed
    )


def _drawn(number: int, car: FleetCar, fleet: DrivenFleet) -> dict[str, object]:
    way = fleet.ways.get(car.name, ())
    return {
        "number": number,
        "row": car,
        "has_way": len(way) > 1,
        "way": _path(way),
        "end": [round(way[-1][0]), round(-way[-1][1])] if way else [],
        "notes": fleet.notes.get(car.name, ()),
    }


def _path(way: Sequence[tuple[float, float]]) -> str:
    return "".join(f"{'L' if number else 'M'}{x_m:.0f} {-y_m:.0f}" for number, (x_m, y_m) in enumerate(way))
