"""A person plays: the acts of a page, in seconds, judged as an agent's."""

import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.cockpit.actions import perform
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode, Observation
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.errors import AgentError, UserError
from automotive_cosim.report.evaluation import write_report
from automotive_cosim.report.results import read_results
from automotive_cosim.run.rerun import rerun
from automotive_cosim.run.road import read_record
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.run.store import read_rows
from automotive_cosim.serve.person import WAITING, Person, Preview
from automotive_cosim.serve.play import Game
from automotive_cosim.traffic.fork import Simulations

from ..cockpit.conftest import town
from .conftest import Browser, Reply

Serving = Callable[..., Browser]

NOTHING = Observation("", 0.0, Feedback(FeedbackCode.NONE, ""))
CLICK = Action(ActionType.CLICK, x=1, y=1)
HOME_SCREEN = Action(ActionType.NAVIGATE_HOME)


def post(browser: Browser, path: str, value: Any, **headers: str) -> Reply:
    port = browser.server.server_port
    sent = {"Origin": f"http://127.0.0.1:{port}"} | headers
    return browser(path, "POST", body=json.dumps(value), **sent)


def test_a_second_without_an_act_goes_by(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [0.0]
    person = Person(clock=lambda: now_s[0])
    slept: list[float] = []
    monkeypatch.setattr(time, "sleep", lambda s: (slept.append(s), now_s.__setitem__(0, now_s[0] + s)))
    person.listen(lambda seen: None)
    now_s[0] = 1.0
    assert person.act(NOTHING) == Action(ActionType.WAIT, seconds=1)
    person.give(CLICK)
    person.give(CLICK)
    assert person.act(NOTHING) == CLICK, "an act is performed at once"
    assert slept == []
    assert person.act(NOTHING) == CLICK
    assert slept == [1.0], "the next one waits for its second"
    now_s[0] = 60.0
    assert person.act(NOTHING).action_type is ActionType.WAIT, "a late second is not made up for"
    person.stop()
    with pytest.raises(KeyboardInterrupt):
        person.act(NOTHING)


def test_only_a_few_acts_may_wait() -> None:
    person = Person()
    for _ in range(WAITING):
        person.give(CLICK)
    with pytest.raises(UserError, match="a second"):
        person.give(CLICK)


def test_an_act_is_shown_before_its_second_and_leaves_the_true_cockpit_alone() -> None:
    cockpit = Cockpit(town(), rng=np.random.default_rng(0))
    before, commands = cockpit.screenshot(), cockpit.commands()
    preview = Preview()
    preview.follow(cockpit)
    climate = preview.after(Action(ActionType.OPEN_APP, app_name="climate"))
    assert not np.array_equal(climate, before)
    again = preview.after(HOME_SCREEN)
    assert np.array_equal(again, before), "acts follow on each other"
    assert cockpit.screenshot() is before
    assert cockpit.commands() == commands
    real = cockpit.copy()
    perform(Action(ActionType.OPEN_APP, app_name="climate"), real, ())
    assert np.array_equal(real.screenshot(), climate)


def test_nobody_plays_unless_the_server_says_so(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path)
    assert browser("/api/about").json["plays"] is False
    assert browser("/api/play").status == 404
    assert post(browser, "/api/play/start", {"task": "hvac_fan_max"}).status == 405


def test_only_the_pages_themselves_may_act(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path, game=Game(tmp_path))
    leave = "/api/play/leave"
    assert post(browser, leave, {}).status == 200
    assert browser(leave, "POST", body="{}").status == 403, "without an origin"
    assert post(browser, leave, {}, Origin="http://evil.example").status == 403
    assert post(browser, leave, {}, Host="evil.example").status == 400
    assert browser(leave, "POST", body="{}", token="wrong").status == 403
    assert post(browser, leave, {"x": "y" * 20_000}).status == 413
    assert post(browser, "/api/runs", {}).status == 405


@pytest.mark.parametrize(
    ("path", "value", "why"),
    [
        ("start", {"task": "no_such_task", "name": "x"}, "no_such_task"),
        ("start", {"task": 3}, "must be strings"),
        ("start", {"task": "hvac_fan_max", "seed": True}, "whole number"),
        ("start", {"task": "hvac_fan_max", "seed": -1}, "whole number"),
        ("start", {"task": "hvac_fan_max", "half": "second"}, "half"),
        ("start", {"task": "hvac_fan_max", "name": "../../x"}, "code name"),
        ("start", {"task": "hvac_fan_max", "name": " "}, "code name"),
        ("pace", {"paused": True}, "only practice"),
        ("pace", {"speed": "x"}, "a number"),
        ("act", {"action_type": "click", "x": 1, "y": 1}, "no action is possible now"),
        ("act", [], "object"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(
    serving: Serving, tmp_path: Path, path: str, value: Any, why: str
) -> None:
    browser = serving(tmp_path, game=Game(tmp_path))
    refused = post(browser, f"/api/play/{path}", value)
    assert refused.status == 422
    assert why in refused.json["error"]
    assert browser("/api/play?seen=9").json["state"] == "idle"


def test_a_slowed_second_is_longer_and_a_stopped_clock_takes_no_act() -> None:
    person = Person(clock=lambda: 0.0)
    person.pace(0.25, paused=True)
    with pytest.raises(UserError, match="is stopped"):
        person.give(CLICK)
    person.pace(1.0, paused=False)
    person.give(CLICK)
    assert person.act(NOTHING) == CLICK


def test_leaving_what_counts_is_the_persons_failure() -> None:
    person = Person(counts=True)
    person.stop()
    with pytest.raises(AgentError, match="left"):
        person.act(NOTHING)


@pytest.mark.slow
def test_a_person_is_judged_as_an_agent_and_can_leave(
    serving: Serving, tmp_path: Path, simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("automotive_cosim.serve.person.TICK_S", 0.1)
    browser = serving(tmp_path, game=Game(tmp_path, "grid", simulations))

    def until(*states: str, when: Callable[[Any], bool] = lambda scene: True) -> Any:
        scene = browser("/api/play").json
        while scene["state"] not in states or not when(scene):
            scene = browser(f"/api/play?seen={scene['version']}").json
        return scene

    def tap(text: str) -> None:
        def boxes(scene: Any) -> list[list[int]]:
            return [each["box"] for each in scene["told"]["elements"] if each["text"].startswith(text)]

        box = boxes(until("acting", when=lambda scene: bool(boxes(scene))))[0]
        x, y = (box[0] + box[2]) // 2, (box[1] + box[3]) // 2
        assert post(browser, "/api/play/act", {"action_type": "click", "x": x, "y": y}).status == 200

    mine = {"task": "hvac_fan_max", "name": "blue heron"}
    assert post(browser, "/api/play/start", mine).status == 200
    assert post(browser, "/api/play/start", mine).status == 422, "one at a time"
    first = until("acting")
    assert first["told"]["goal"]
    assert browser("/api/play/screen").body.startswith(b"\xff\xd8")
    until("acting", when=lambda scene: scene["told"]["time_s"] >= 1.0)  # the road does not wait
    tap("Climate")
    tap("Max: Fan at full speed")
    assert post(browser, "/api/play/act", {"action_type": "status", "goal_status": "complete"}).status == 200
    over = until("over", "failed")
    assert over["error"] == ""
    run = browser(f"/api/runs/{over['record']}/episodes/{over['episode']}").json
    assert (run["agent"], run["model"], run["success"]) == ("human", "blue heron", True)
    assert post(browser, "/api/play/pace", {"paused": True}).status == 422, "what counts is never paused"

    assert post(browser, "/api/play/start", mine).status == 200
    until("acting")
    assert post(browser, "/api/play/leave", {}).status == 200
    assert until("over")["episode"] != over["episode"], "a second try is another episode"

    results = read_results(tmp_path / "people")
    assert results.coverage.is_complete
    rows = sorted(results.rows, key=lambda row: row.repeat)
    assert [(row.repeat, row.success, row.end) for row in rows] == [
        (0, True, "declared"),
        (1, False, "agent_failed"),
    ]
    assert {each.label for each in results.contestants} == {"human, blue heron, model's clock"}
    write_report(tmp_path / "people")
    assert "blue heron" in (tmp_path / "people" / "report.html").read_text(encoding="utf-8")
    assert read_record(tmp_path / "people" / "pictures" / rows[0].id / "road.jsonl.gz").seconds
    again = rerun(tmp_path / "people", rows[0].id)
    assert not [step for step in again if step.differs], "neither looking nor showing an act at once changed it"

    assert post(browser, "/api/play/start", {"task": "hvac_fan_max", "practice": True}).status == 200
    until("acting")
    assert post(browser, "/api/play/pace", {"paused": True, "speed": 0.5}).status == 200
    stands = until("acting", when=lambda scene: scene["paused"])
    assert stands["speed"] == 0.5
    assert post(browser, "/api/play/act", {"action_type": "navigate_home"}).status == 422, "the clock stands"
    assert post(browser, "/api/play/pace", {"paused": False, "speed": 3}).status == 422
    assert post(browser, "/api/play/leave", {}).status == 200
    left = until("over")
    assert browser(f"/api/runs/{left['record']}").json["end"] == "interrupted"
    assert len(read_results(tmp_path / "people").rows) == 2, "practice gives no row"
    (folder,) = (path for path in tmp_path.iterdir() if path.name != "people")
    assert {path.name for path in folder.iterdir()} >= {"trial.json", "episode.webp", "summary.html"}


@pytest.mark.slow
def test_a_drive_is_played_and_its_row_is_kept(
    serving: Serving, tmp_path: Path, simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    family = FAMILIES["grid_june"]
    shorter = replace(family.draw(1), duration_s=60.0)
    drawn = SimpleNamespace(id=family.id, scenario=family.scenario, season=family.season, draw=lambda seed: shorter)
    monkeypatch.setitem(FAMILIES, family.id, drawn)  # type: ignore[call-overload]
    monkeypatch.setattr("automotive_cosim.serve.person.TICK_S", 0.02)
    browser = serving(tmp_path, game=Game(tmp_path, simulations=simulations))
    assert post(browser, "/api/play/start", {"drive": "no_such", "name": "heron"}).status == 422
    assert post(browser, "/api/play/start", {"drive": "grid_june", "name": "heron", "seed": 1}).status == 200
    scene = browser("/api/play").json
    while scene["state"] not in ("over", "failed"):
        scene = browser(f"/api/play?seen={scene['version']}").json
    assert scene["error"] == ""
    (row,) = read_rows(tmp_path / "people-drives", DriveTrialRow).values()
    assert (row.agent, row.model, row.end) == ("human", "heron", "minutes_over")
    assert row.score is not None
    results = browser(f"/api/evaluations/{scene['record']}").json
    assert (results["kind"], results["rows"][0]["has_road"]) == ("drives", True)
    run = browser(f"/api/runs/{scene['record']}/episodes/{row.id}").json
    assert (run["kind"], run["task"], run["value"]) == ("drive", "grid_june", row.value)
    steps = browser(f"/api/runs/{scene['record']}/episodes/{row.id}/steps").json["steps"]
    assert len(steps) == row.steps + 1
    picture = f"/api/runs/{scene['record']}/episodes/{row.id}/pictures/{steps[-1]['picture']}"
    assert browser(picture).headers["Content-Type"] == "image/jpeg"
    write_report(tmp_path / "people-drives")
