"""What the pages show of a study of adoption: the equipped cars of every share, while they drive and afterwards."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.run.fleet_record import FAILS, fleets_in
from automotive_cosim.run.job_row import as_json
from automotive_cosim.serve.records import NotHereError
from automotive_cosim.studies.adoption.adoption import AdoptionStudy, fleet_id
from automotive_cosim.studies.adoption.page import COLUMNS, shown_car


def shares(folder: Path) -> Json:
    """The shares that have been driven, or are being driven.

    Raises UserError: it is not a study's folder, or is damaged."""
    study = AdoptionStudy.read(folder)
    seeds = counted(len(study.plan.jobs()), "seed")
    return {
        "name": folder.name,
        "about": f"{study.plan.agent} in {study.plan.scenario}; {len(study.rows)} of {seeds} done. "
        "Each car on the map has the assistant.",
        "columns": COLUMNS,
        "running": is_being_written(folder / "lock"),
        "fails": FAILS,
        "fleets": [
            {"id": name, "words": f"{name.replace('seed', 'seed ').replace('-', ', ', 1)} %", "running": is_running}
            for name, is_running in fleets_in(folder)
        ],
    }


def cars(folder: Path, name: str) -> Json:
    """The rows of the equipped cars of a share; none before all shares of its seed have been driven.

    Raises:
        NotHereError: there is no such share.
        UserError: the study is damaged."""
    if name not in dict(fleets_in(folder)):
        raise NotHereError(f"there are no cars of {name!r}")
    found = {
        fleet_id(row.seed, each.share): each.cars for row in AdoptionStudy.read(folder).rows for each in row.shares
    }
    return {"cars": [as_json(shown_car(car)) for car in found.get(name, ())]}
