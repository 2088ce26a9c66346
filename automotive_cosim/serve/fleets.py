"""What the pages show of the fleets of an evaluation, while they drive and afterwards."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.report.drives import OF_A_CAR, shown_car
from automotive_cosim.run.fleet_record import FAILS, fleets_in, read_fleet
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.rows import DriveTrialRow, read_trials
from automotive_cosim.run.store import read_manifest
from automotive_cosim.serve.records import NotHereError


def fleets(folder: Path) -> Json:
    """Those that have been driven, or are being driven. Raises UserError: the folder is damaged."""
    manifest = read_manifest(folder)
    return {
        "name": folder.name,
        "about": f"{', '.join(manifest['plan']['agents'])}. Each car has its own agent; click one.",
        "columns": OF_A_CAR,
        "running": is_being_written(folder / "lock"),
        "fails": FAILS,
        "fleets": [{"id": name, "words": name, "running": is_running} for name, is_running in fleets_in(folder)],
    }


def cars(folder: Path, name: str) -> Json:
    """The cars of a fleet, as far as their drives are over.

    Raises:
        NotHereError: there is no such fleet.
        UserError: the folder is damaged."""
    if name not in dict(fleets_in(folder)):
        raise NotHereError(f"there are no cars of {name!r}")
    fleet, rows = read_fleet(folder, name), read_trials(folder)
    trials = fleet.trials if fleet else {}
    known = {car: row for car, trial in trials.items() if isinstance(row := rows.get(trial), DriveTrialRow)}
    return {"cars": [as_json(shown_car(car, row)) for car, row in known.items()]}


PARTS: Mapping[str, Callable[..., Json]] = {"": fleets, "cars": cars}
"""What pages ask of an evaluation, as of a study (``ResultsKind.served``)."""
