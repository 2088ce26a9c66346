"""Folders of trials as 0.2 wrote them show the same as those of today."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.run.kept import pictures, read_trial

from .conftest import Browser, step, write_drive, write_evaluation, write_record

Serving = Callable[..., Browser]
OWN = {"id", "name", "folder", "started"}


def as_run(folder: Path) -> None:
    """Puts a folder of ``run`` into the form of 0.2."""
    told = read_trial(folder)
    (folder / "trial.json").unlink()
    (folder / "episode.json").write_text(json.dumps(told["result"] | {"manifest": told["manifest"]}))
    lines = "".join(json.dumps(step(number)) + "\n" for number in range(4))
    (folder / "steps.jsonl").write_text(lines)
    for path in pictures(folder):
        path.rename(path.with_suffix(".png"))


def as_drive(folder: Path) -> None:
    """The same with a folder of ``drive``."""
    told = read_trial(folder)
    (folder / "trial.json").unlink()
    (folder / "row.json").write_text(json.dumps(told["row"]))
    (folder / "timeline.json").write_text(json.dumps(told["result"]["timeline"]))
    lines = [json.loads(line) for line in (folder / "steps.jsonl").read_text().splitlines()]
    shown = [{"number": line.pop("step"), **line} for line in lines]
    (folder / "shown.jsonl").write_text("".join(json.dumps(line) + "\n" for line in shown))
    compared = [
        {"step": number, "action": None, "feedback": {"code": "ok", "text": ""}} for number in range(len(lines) - 1)
    ]
    (folder / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in compared))


def as_evaluation(folder: Path) -> None:
    """The same with a folder of ``eval``."""
    for path in pictures(folder / "pictures" / "one"):
        path.rename(path.parent.parent / path.name)
    (folder / "pictures" / "one" / "screenshots").rmdir()


@pytest.mark.parametrize(
    ("write", "as_before", "below"),
    [(write_record, as_run, ""), (write_drive, as_drive, ""), (write_evaluation, as_evaluation, "/episodes/one")],
)
def test_a_former_folder_shows_the_same(
    serving: Serving, tmp_path: Path, write: Any, as_before: Callable[[Path], None], below: str
) -> None:
    write(tmp_path / "now")
    as_before(write(tmp_path / "before"))
    browser = serving(tmp_path)
    listed = {record["name"]: record for record in browser("/api/runs").json["records"]}
    answers = []
    for name, line in listed.items():
        base = f"/api/runs/{line['id']}{below}"
        told = [line, *(browser(f"{base}{path}").json for path in ("", "/steps", "/road"))]
        answers.append([{key: value for key, value in each.items() if key not in OWN} for each in told])
        assert told[2]["steps"][0]["has_picture"], name
        shown = browser(f"{base}/pictures/0")
        assert (shown.status, shown.headers["Content-Type"].partition("/")[0]) == (200, "image")
    assert answers[0][2]["steps"] == answers[1][2]["steps"]
    assert answers[0] == answers[1]
