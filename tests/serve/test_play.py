"""A person plays: the acts of a page, in seconds, judged as an agent's."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode, Observation
from automotive_cosim.errors import UserError
from automotive_cosim.run.road import read_record
from automotive_cosim.serve.play import WAITING, Game, Person

from .conftest import Browser, Reply

Serving = Callable[..., Browser]

NOTHING = Observation("", 0.0, Feedback(FeedbackCode.NONE, ""))
CLICK = Action(ActionType.CLICK, x=1, y=1)


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
        ("start", {"task": "no_such_task"}, "no_such_task"),
        ("start", {"task": 3}, "texts"),
        ("start", {"task": "hvac_fan_max", "seed": True}, "whole number"),
        ("start", {"task": "hvac_fan_max", "seed": -1}, "whole number"),
        ("start", {"task": "hvac_fan_max", "half": "second"}, "half"),
        ("start", {"task": "hvac_fan_max", "name": "../../x"}, "code name"),
        ("act", {"action_type": "click", "x": 1, "y": 1}, "nobody can act"),
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


@pytest.mark.slow
@pytest.mark.sumo
def test_a_person_is_judged_as_an_agent_and_can_leave(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path, game=Game(tmp_path, scenario="grid"))

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

    assert post(browser, "/api/play/start", {"task": "hvac_fan_max", "name": "blue heron"}).status == 200
    assert post(browser, "/api/play/start", {"task": "hvac_fan_max"}).status == 422, "one at a time"
    first = until("acting")
    assert first["told"]["goal"]
    assert browser("/api/play/screen").body.startswith(b"\xff\xd8")
    until("acting", when=lambda scene: scene["told"]["time_s"] >= 1.0)  # the road does not wait
    tap("Climate")
    tap("Max: Fan at full speed")
    assert post(browser, "/api/play/act", {"action_type": "status", "goal_status": "complete"}).status == 200
    over = until("over", "failed")
    assert over["error"] == ""
    run = browser(f"/api/runs/{over['record']}").json
    assert (run["agent"], run["model"], run["success"]) == ("human", "blue heron", True)
    (folder,) = (path for path in tmp_path.iterdir() if path.is_dir())
    assert {path.name for path in folder.iterdir()} >= {"episode.json", "episode.webp", "summary.html"}
    assert read_record(folder / "road.jsonl.gz").seconds

    assert post(browser, "/api/play/start", {"task": "hvac_fan_max"}).status == 200
    until("acting")
    assert post(browser, "/api/play/leave", {}).status == 200
    left = until("over")
    assert browser(f"/api/runs/{left['record']}").json["end"] == "interrupted"
