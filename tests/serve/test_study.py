"""A study with people whose episodes end at once: nothing here starts SUMO."""

import csv
import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.report.results import read_results
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.executor import failed
from automotive_cosim.run.rows import PartsHeld
from automotive_cosim.serve import play
from automotive_cosim.serve.dealing import PeoplePlan
from automotive_cosim.serve.detection import FIGURES, detected, figures
from automotive_cosim.serve.study import LOG, QUESTIONS, PeopleStudy

from .conftest import Browser

PLAN = PeoplePlan(("heron", "fox"), ("road_speed_80_in_50", "hvac_fan_max"))
ANSWERS = dict.fromkeys(QUESTIONS, 4)


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Episodes end as they begin: those of the first half are won, hvac_fan_max could not be judged."""

    def begin(game: play.Game, job: EpisodeSetup, folder: Path, keep: Callable[[Any], None]) -> None:
        won = job.half == "first"
        if job.task == "hvac_fan_max" and job.model == "fox":
            keep(failed(job, "TrafficError", "it broke"))
        else:
            keep(
                replace(job.planned(), success=won, parts=PartsHeld(won, True, True, True, True), trace_sha256="0")
            )

    monkeypatch.setattr(play.Game, "begin", begin)


def finish(study: PeopleStudy, seat: str) -> list[str]:
    phases = []
    while (phase := study.turn(seat)["phase"]) != "over":
        phases.append(phase)
        if phase == "play":
            study.begin(seat)
        else:
            study.answer(seat, ANSWERS)
    return phases


def test_a_study_is_resumed_and_becomes_results_and_an_export(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    study = PeopleStudy(PLAN, folder)
    heron = study.join("heron")
    assert "verdicts" not in study.turn(heron)
    study.begin(heron)
    assert study.turn(heron)["phase"] == "ask"
    with pytest.raises(UserError, match="answer the questions first"):
        study.begin(heron)
    study.close()
    with (folder / LOG).open("ab") as log:
        log.write(b'{"at": "2026-')  # a kill in the middle of a line

    study = PeopleStudy(PLAN, folder)
    with pytest.raises(UserError, match="choose your code name again"):
        study.turn(heron)
    heron, fox = study.join("heron", heron), study.join("fox")
    assert finish(study, heron) == ["ask", *["play", "ask"] * 2]
    assert finish(study, fox).count("ask") == 2, "nobody is asked about what could not be judged"
    told = study.turn(heron)
    assert sum(each["success"] for each in told["verdicts"]) == 2
    assert told["verdicts"] != study.turn(fox)["verdicts"]

    lines = study.export()
    assert [line["person"] for line in lines] == ["heron"] * 3 + ["fox"] * 3
    assert [line["place"] for line in lines] == [1, 2, 3] * 2
    for line in lines:
        assert line["times_begun"] == 1
        assert (line["sure"] == 4) is (line["error"] is None)
        assert line["begun"] <= line["ended"] <= (line["answered"] or line["ended"])
    back = list(csv.DictReader(io.StringIO(study.as_csv())))
    assert [line["success"] for line in back] == [str(line["success"] or "") if line["success"] is None
                                                  else str(line["success"]) for line in lines]  # fmt: skip
    results = read_results(folder)
    assert results.coverage.is_complete
    assert [each.model for each in results.contestants] == ["fox", "heron"]
    study.close()
    with pytest.raises(UserError, match="a different plan"):
        PeopleStudy(replace(PLAN, people=("heron", "fox", "owl")), folder)


def test_a_code_name_is_for_one_window(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = PeopleStudy(PLAN, tmp_path / "mine")
    with pytest.raises(UserError, match="this study has no code name"):
        study.join("owl")
    seat = study.join("heron")
    assert study.join("heron", seat) == seat
    with pytest.raises(UserError, match="another window"):
        study.join("heron")
    with pytest.raises(UserError, match="another window"):
        study.join("heron", study.join("fox"))
    monkeypatch.setattr("automotive_cosim.serve.study.AWAY_S", 0.0)
    assert study.join("heron") != seat
    with pytest.raises(UserError, match="choose your code name again"):
        study.begin(seat)
    study.close()


@pytest.mark.parametrize("wrong", [0, 6, 2.5, "3", True, None])
def test_an_answer_is_a_number_of_the_scale(tmp_path: Path, wrong: object) -> None:
    study = PeopleStudy(PLAN, tmp_path / "mine")
    seat = study.join("heron")
    with pytest.raises(UserError, match="no question to answer"):
        study.answer(seat, ANSWERS)
    study.begin(seat)
    with pytest.raises(UserError, match="1 to 5"):
        study.answer(seat, ANSWERS | {"hard": wrong})
    study.answer(seat, ANSWERS)
    study.close()


def test_who_takes_part_sees_the_study_alone(serving: Callable[..., Browser], tmp_path: Path) -> None:
    (tmp_path / "shown").mkdir()
    browser = serving(tmp_path / "shown", study=PeopleStudy(PLAN, tmp_path / "shown" / "mine"))
    person = browser.server.people_token
    origin = {"Origin": f"http://127.0.0.1:{browser.server.server_port}"}

    def post(path: str, value: object) -> Any:
        return browser(path, "POST", body=json.dumps(value), token=person, **origin)

    assert browser("/api/about", token=person).json["visitor"] == "person"
    assert browser("/", token=person).status == 200
    for path in ("/api/runs", "/api/tasks", "/api/tasks/hvac_fan_max", "/api/scenarios", "/api/study/rows.csv",
                 "/api/study/rows.json", "/api/play"):  # fmt: skip
        assert browser(path, token=person).status == 404, path
    assert post("/api/play/start", {"task": "hvac_fan_max", "name": "x"}).status == 405
    seat = post("/api/study/join", {"name": "heron"}).json["seat"]
    assert post(f"/api/study/play/start?seat={seat}", {"task": "hvac_fan_max"}).status == 405, "nobody chooses"
    assert post(f"/api/study/play/pace?seat={seat}", {"paused": True}).status == 405, "the clock never stands"
    assert post("/api/study/begin?seat=wrong", {}).status == 422
    assert post(f"/api/study/begin?seat={seat}", {}).status == 200
    assert browser(f"/api/study/seat?seat={seat}", token=person).json["phase"] == "ask"
    scene = browser(f"/api/study/play?seat={seat}", token=person).json
    assert "record" not in scene
    assert "verdict" not in json.dumps(scene)
    assert browser("/api/study/rows.csv").headers["Content-Type"].startswith("text/csv")
    assert len(browser("/api/study/rows.json").json) == 6
    assert browser("/api/study", token="wrong").status == 403


@pytest.mark.parametrize(
    ("reactions", "expected"),
    [
        ([], (0, 0, None, None)),
        ([None], (1, 0, 0.0, None)),
        ([99.9, 100, 2500, 2500.1, None], (5, 2, 0.4, 1300.0)),
        ([300, 500.5], (2, 2, 1.0, 400.2)),
    ],
)
def test_hits_are_reactions_of_100_to_2500_ms(reactions: list[float | None], expected: tuple[object, ...]) -> None:
    events = [detected({"phase": "task", "reaction_ms": each}) for each in reactions]
    others = [{"phase": "rest", "reaction_ms": 200.0}]
    assert figures(events + others, "task") == dict(zip(FIGURES, expected, strict=True))


def test_dots_are_counted_by_episode_and_phase_since_it_was_begun(
    serving: Callable[..., Browser], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(play.Game, "begin", lambda game, job, folder, keep: None)  # it is never over
    study = PeopleStudy(replace(PLAN, detection=True), tmp_path / "mine")
    browser = serving(tmp_path, study=study)
    origin = {"Origin": f"http://127.0.0.1:{browser.server.server_port}"}
    seat = study.join("fox")

    def sent(phase: object, reaction_ms: object) -> int:
        body = json.dumps({"phase": phase, "reaction_ms": reaction_ms})
        return browser(f"/api/study/detected?seat={seat}", "POST", body=body, token=person, **origin).status

    person = browser.server.people_token
    assert browser("/api/study", token=person).json["detection"]["every_ms"] == [3000, 5000]
    assert sent("task", 300) == 422, "nothing has begun"
    study.begin(seat)
    assert sent("task", 900) == 200
    study.begin(seat)
    for phase, wrong in (
        ("task", "300"),
        ("task", -1),
        ("task", 3001),
        ("task", True),
        ("play", 300),
        (None, None),
    ):
        assert sent(phase, wrong) == 422
    for phase, reaction in (("rest", 310.04), ("task", 450), ("task", None), ("task", 20)):
        assert sent(phase, reaction) == 200
    rest, task = ({"stimuli": 1, "hits": 1, "hit_rate": 1.0, "reaction_ms": 310.0},
                  {"stimuli": 3, "hits": 1, "hit_rate": 0.333, "reaction_ms": 450.0})  # fmt: skip
    assert browser("/api/study/seen", token=person).status == 404, "nobody sees the others' figures"
    assert browser("/api/study/seen").json["fox"] == {"rest": rest, "task": task}
    line = next(line for line in study.export() if line["times_begun"])
    assert {name: line[f"task_{name}"] for name in FIGURES} == task
    assert line["rest_reaction_ms"] == 310.0


def test_without_the_task_there_is_nothing_to_detect(tmp_path: Path) -> None:
    study = PeopleStudy(PLAN, tmp_path / "mine")
    seat = study.join("fox")
    assert (study.overview()["detection"], study.seen()) == (None, {})
    assert not any("reaction_ms" in name for name in study.export()[0])
    with pytest.raises(UserError, match="nothing to detect"):
        study.detect(seat, {"phase": "task", "reaction_ms": 300})
    study.close()
