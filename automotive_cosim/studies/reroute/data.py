"""A study as data: every future as a row, as CSV and, with pyarrow, as Parquet, described by a data package.

``datapackage.json`` follows the Data Package standard (https://datapackage.org): it names every file with its hash
and every column with its type, and holds what a new run needs: plan, versions and hashes of the scenario's files.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

from automotive_cosim.contracts import Json
from automotive_cosim.errors import CosimError
from automotive_cosim.formats.csvs import csv_text
from automotive_cosim.formats.files import read_bytes
from automotive_cosim.formats.writing import drafted, write_whole
from automotive_cosim.run.job_row import InColumns, columns
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.reroute.policies import chosen, parse_policy
from automotive_cosim.studies.reroute.results import Study, all_decisions
from automotive_cosim.studies.reroute.rows import (
    NOBODY,
    NOTHING,
    Branch,
    Decision,
    DecisionLine,
    DecisionPoint,
    OthersTotals,
    PolicyChoice,
    Totals,
    TripLine,
)

TYPES = {bool: "boolean", int: "integer", float: "number", str: "string"}
DTYPES = {"integer": "Int64", "number": "Float64", "boolean": "boolean", "string": "string"}
"""pandas' names of the types of columns that may have empty cells."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FutureRow(DecisionLine):
    """One future of one decision that was driven: a line of ``futures.csv``."""

    excluded: str
    """Why the decision is in no average; empty if it counts."""
    draw: int
    """0 with the random numbers of the drive itself."""
    draw_seed: int | None
    """Seed of the fresh random numbers; None for draw 0 and for placebos, whose draw identifies them."""
    branch: int | None
    """Number of the branch; None for keeping the route."""
    is_placebo: bool
    policies: str
    """Policies that choose this future by the newest news and at the first compliance, separated by spaces,
    without ``best``."""
    ego: Annotated[Totals, InColumns("ego")]
    gain: Annotated[Totals, InColumns("gain")]
    """What it saves compared with keeping the route in the same draw; a kept route, compared with draw 0."""
    others: Annotated[OthersTotals, InColumns("others")]


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeRow(TripLine):
    """One whole drive under one policy: a line of ``whole_drives.csv``."""

    policy: str
    compliance: float
    draw: int
    reroutings: int
    excluded: str
    gain: Annotated[Totals, InColumns("gain")]
    others: Annotated[OthersTotals, InColumns("others")]


def futures(study: Study) -> Iterator[FutureRow]:
    """Every future of every decision, including decisions that do not count."""
    for point in all_decisions(study.rows):
        decision = point.decision
        assert point.drive.stay is not None, "it has a decision"
        by_branch = choosers(study.plan, decision)
        kept = Branch(gains=NOTHING, totals=point.drive.stay, others=NOBODY)
        driven: list[tuple[int, int | None, Branch, tuple[Branch, ...]]] = [(0, None, kept, decision.branches)]
        driven += [
            (draw, each.seed, each.stay, each.branches) for draw, each in enumerate(decision.replicates, start=1)
        ]
        for draw, seed, stay, branches in driven:
            for number, future in enumerate((stay, *branches), start=-1):
                branch = None if number < 0 else number
                yield _future(point, draw, seed, branch, future, by_branch.get(branch, ""))
        if decision.placebo is not None:
            yield _future(point, 1, None, None, decision.placebo, by_branch.get(None, ""), is_placebo=True)


def whole_drives(study: Study) -> Iterator[WholeRow]:
    """Every whole drive under a policy."""
    for row in study.rows:
        for drive in row.whole:
            yield WholeRow(
                **row.line,
                policy=drive.policy,
                compliance=drive.compliance,
                draw=drive.draw,
                reroutings=drive.reroutings,
                excluded=drive.excluded,
                gain=drive.branch.gains,
                others=drive.branch.others,
            )


def write_data(study: Study) -> list[Path]:
    """Writes the data files and their description into a study's folder; returns their paths.

    Raises OSError: they cannot be written."""
    written: list[Path] = []
    resources: list[Json] = []
    kinds: dict[str, Sequence[FutureRow | WholeRow | PolicyChoice]] = {
        "choices": study.all_choices,
        "futures": tuple(futures(study)),
        "whole_drives": tuple(whole_drives(study)),
    }
    for name, rows in kinds.items():
        if not rows and name != "choices":
            continue
        path = study.folder / f"{name}.csv"
        write_whole(path, as_csv(rows))
        written.append(path)
        if rows and find_spec("pyarrow") is not None:
            written.append(_write_parquet(path.with_suffix(".parquet"), rows))
        resources += [_resource(each, rows) for each in written if each.stem == name]
    package = {
        "$schema": "https://datapackage.org/profiles/2.0/datapackage.json",
        "name": "rerouting-study",
        "resources": resources,
        "study": {name: study.manifest[name] for name in ("plan", "starts")},
        "inputs": inputs(study),
    }
    write_whole(study.folder / "datapackage.json", json.dumps(package, indent=1, ensure_ascii=False))
    return written


def as_csv(rows: Sequence[object]) -> str:
    """Rows of one kind as CSV, one per line, with the columns of a data frame."""
    made = [columns(row) for row in rows]
    return csv_text(made[0], (row.values() for row in made)) if made else ""


def inputs(study: Study) -> Json:
    """SHA-256 of the files beside the scenario's configuration, by name; empty if they are no longer there."""
    try:
        config = study.plan.opened.config
    except CosimError:
        return {}
    if not config.is_file():
        return {}
    files = [path for path in sorted(config.parent.iterdir()) if path.is_file()]
    return {path.name: hashlib.sha256(read_bytes(path)).hexdigest() for path in files}


def _future(
    point: DecisionPoint,
    draw: int,
    seed: int | None,
    branch: int | None,
    future: Branch,
    policies: str,
    *,
    is_placebo: bool = False,
) -> FutureRow:
    return FutureRow(
        **point.line,
        excluded=point.decision.excluded,
        draw=draw,
        draw_seed=seed,
        branch=branch,
        is_placebo=is_placebo,
        policies=policies,
        ego=future.totals,
        gain=future.gains,
        others=future.others,
    )


def choosers(plan: StudyPlan, decision: Decision) -> dict[int | None, str]:
    """The policies that choose each branch, by the newest news and at the first compliance, without ``best``."""
    found: dict[int | None, list[str]] = {}
    for text in plan.policies:
        if text != "best":
            number = chosen(parse_policy(text), decision, decision.news[0].age_s, plan.compliance[0])
            found.setdefault(number, []).append(text)
    return {branch: " ".join(names) for branch, names in found.items()}


def _write_parquet(path: Path, rows: Sequence[object]) -> Path:
    import pandas as pd

    made = [columns(row) for row in rows]
    # The declared types, not the narrowest that fit these values, so that files of several studies match.
    dtypes = {name: DTYPES.get(_type(row[name] for row in made), "object") for name in made[0]}
    frame = pd.DataFrame({name: pd.Series([row[name] for row in made], dtype=dtypes[name]) for name in dtypes})
    with drafted(path) as file:
        frame.to_parquet(file, index=False)
    return path


def _resource(path: Path, rows: Sequence[object]) -> Json:
    """A file's description: where it is, its hash, and its columns."""
    content = read_bytes(path)
    made = [columns(row) for row in rows]
    fields = [{"name": name, "type": _type(row[name] for row in made)} for name in (made[0] if made else ())]
    return {
        "name": path.stem if path.suffix == ".csv" else f"{path.stem}-parquet",
        "path": path.name,
        "format": path.suffix.removeprefix("."),
        "bytes": len(content),
        "hash": f"sha256:{hashlib.sha256(content).hexdigest()}",
        "schema": {"fields": fields},
    }


def _type(values: Iterator[Any]) -> str:
    """The type of a column: the common type of its values."""
    kinds = {type(value) for value in values if value is not None}
    if kinds == {int, float}:
        return "number"
    return TYPES.get(kinds.pop(), "any") if len(kinds) == 1 else "any"
