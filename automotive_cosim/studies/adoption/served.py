"""What the pages show of a study of adoption: the equipped cars of every share, while they drive and afterwards."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.run.row import as_json
from automotive_cosim.serve.records import NotHereError
from automotive_cosim.studies.adoption.adoption import AdoptionStudy
from automotive_cosim.studies.adoption.fleets import FAILS, fleet_id, fleets_in


def shares(folder: Path) -> Json:
    """The shares that have been driven, or are being driven.

    Raises:
        UserError: it is not a study's folder, or is damaged.
    """
    study = AdoptionStudy.read(folder)
    return {
        "name": folder.name,
        "scenario": study.plan.scenario,
        "agent": study.plan.agent,
        "planned": len(study.plan.jobs()),
        "done": len(study.rows),
        "running": is_being_written(folder / "lock"),
        "fails": FAILS,
        "fleets": [{"id": name, "running": is_running} for name, is_running in fleets_in(folder)],
    }


def cars(folder: Path, name: str) -> Json:
    """The rows of the equipped cars of a share; none before all shares of its seed have been driven.

    Raises:
        NotHereError: there is no such share.
        UserError: the study is damaged.
    """
    if name not in dict(fleets_in(folder)):
        raise NotHereError(f"there are no cars of {name!r}")
    found = {
        fleet_id(row.seed, each.share): each.cars for row in AdoptionStudy.read(folder).rows for each in row.shares
    }
    return {"cars": [as_json(car) for car in found.get(name, ())]}
