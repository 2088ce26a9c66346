"""What the pages are given: live records from where a reader was, every task and scenario, texts only as text."""

import gzip
import json
import re
from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.contracts.given import GeoInput
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.formats.writing import is_being_written, mark_as_written
from automotive_cosim.scenarios import shipped
from automotive_cosim.serve import catalogue
from automotive_cosim.serve.server import WebServer
from automotive_cosim.tasking.task import Basis
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.voice.engines import as_wav

from .conftest import HOSTILE, Browser, road, step, write_record

Serving = Callable[..., Browser]
STATIC = sorted(Path(str(files("automotive_cosim.serve") / "static")).iterdir())


def test_a_running_record_is_read_from_where_the_reader_was(serving: Serving, tmp_path: Path) -> None:
    run = write_record(tmp_path / "run", steps=2, finished=False)
    browser = serving(tmp_path)
    raw = (run / "road.jsonl.gz").open("wb")
    mark_as_written(raw)
    file = gzip.GzipFile(fileobj=raw, mode="wb")

    def write(seconds: range) -> None:
        lines = road(seconds)
        for line in lines if seconds.start < 0 else lines[3:]:
            file.write(json.dumps(line).encode() + b"\n")
        file.flush()
        raw.flush()

    write(range(-2, 3))
    (record,) = browser("/api/runs").json["records"]
    assert record["running"] is True
    base = f"/api/runs/{record['id']}"
    seen = browser(f"{base}/road").json["lines"]
    assert len(seen) == 3 + 5
    steps = browser(f"{base}/steps").json
    assert (len(steps["steps"]), steps["running"]) == (2, True)

    write(range(3, 5))
    with (run / "steps.jsonl").open("a", encoding="utf-8") as more:
        more.write(json.dumps(step(2)) + "\n" + json.dumps(step(3))[:50])
    more_lines = browser(f"{base}/road?skip={len(seen)}").json["lines"]
    assert [line["at_s"] for line in more_lines] == [3.0, 4.0]
    assert [each["number"] for each in browser(f"{base}/steps?skip=2").json["steps"]] == [2], "no half line"

    file.close()
    raw.close()
    assert not is_being_written(run / "road.jsonl.gz")
    assert browser(f"{base}/steps?skip=3").json == {"steps": [], "running": False}


def test_what_was_heard_is_told_and_played(serving: Serving, tmp_path: Path) -> None:
    run = write_record(tmp_path / "run", steps=2)
    lines = [json.loads(line) for line in (run / "steps.jsonl").read_text(encoding="utf-8").splitlines()]
    lines[0] |= {"heard": ["Wash my peat."], "cabin_db": 71.5}
    (run / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    sounds, outside = run / "sounds", tmp_path / "outside.wav"
    sounds.mkdir()
    wav = as_wav(np.zeros(1600, np.float32))
    outside.write_bytes(wav)
    browser = serving(run)
    (record,) = browser("/api/runs").json["records"]
    base = f"/api/runs/{record['id']}"
    first = sounds / "step_000_0.wav"
    for content, status, says in (
        (wav, 200, ""),
        (b"not a sound", 422, "step_000_0.wav is no WAV file"),
        (outside, 404, ""),
    ):
        first.unlink(missing_ok=True)
        if isinstance(content, bytes):
            first.write_bytes(content)
        else:
            first.symlink_to(content)
        reply = browser(f"{base}/sounds/0/0")
        assert reply.status == status
        if status == 200:
            assert (reply.body, reply.headers["Content-Type"]) == (wav, "audio/wav")
        else:
            assert says in reply.json["error"]
    one, other = browser(f"{base}/steps").json["steps"]
    heard = {"said": "Watch my speed.", "heard": "Wash my peat.", "noise_db": 71.5, "can_sound": True}
    assert one["uttered"] == [heard]
    assert other["uttered"] == []
    for nothing in ("0/1", "1/0", "9/0"):
        assert browser(f"{base}/sounds/{nothing}").status == 404


def test_the_list_tells_runs_of_a_pair_apart(serving: Serving, tmp_path: Path) -> None:
    given = Conditions()
    write_record(tmp_path / "with_place", conditions=given.as_json())
    write_record(tmp_path / "without_place", conditions=replace(given, geo=GeoInput.NONE).as_json())
    records = {each["name"]: each for each in serving(tmp_path)("/api/runs").json["records"]}
    assert {name: each["conditions"] for name, each in records.items()} == {
        "with_place": [],
        "without_place": ["geo none"],
    }
    known, withheld = records["with_place"], records["without_place"]
    assert (known["beside"], withheld["beside"]) == (withheld["id"], None)
    with WebServer([tmp_path], port=0) as server:
        assert server.address.endswith(f"#/beside/{known['id']}/{withheld['id']}")


def test_hostile_names_stay_text(serving: Serving, tmp_path: Path) -> None:
    write_record(tmp_path / "run", goal=HOSTILE, task=HOSTILE)
    browser = serving(tmp_path)
    answer = browser("/api/runs")
    assert answer.headers["Content-Type"] == "application/json; charset=utf-8"
    assert answer.json["records"][0]["goal"] == HOSTILE


@pytest.mark.parametrize("path", STATIC, ids=lambda path: path.name)
def test_no_script_makes_markup_from_text_and_no_page_has_a_script_or_style_inside(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".js":
        assert not re.search(
            r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|srcdoc|javascript:", text
        )
        assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text), "nothing is fetched from elsewhere"
    if path.suffix == ".html":
        assert not re.search(r"<style|\son\w+=|style=|<script(?![^>]*src=\"/static/)", text)


def test_every_script_that_is_imported_exists() -> None:
    names = {path.name for path in STATIC}
    for path in STATIC:
        if path.suffix in (".js", ".html"):
            named = re.findall(r'from "\./([\w.]+)"|/static/([\w.]+)"', path.read_text(encoding="utf-8"))
            assert {one or other for one, other in named} <= names


def test_every_task_has_a_page_with_its_law() -> None:
    assert [each["id"] for each in catalogue.tasks()["tasks"]] == list(CATALOGUE)
    for task in CATALOGUE.values():
        page = catalogue.task(task.id)
        assert [half["name"] for half in page["halves"]] == list(task.halves)
        for half in page["halves"]:
            lawful = task.half(half["name"]).basis is Basis.LAW
            assert bool(half["laws"]) == lawful, f"{task.id} names a rule that exists"
        json.dumps(page)


def test_every_scenario_has_a_page() -> None:
    found = catalogue.all_scenarios()["scenarios"]
    assert [each["name"] for each in found] == list(shipped())
    for each in found:
        assert each["trips"]
        if each["has_map"]:
            assert catalogue.scenario_map(each["name"]).is_file()
