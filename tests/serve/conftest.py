"""Records made by hand, and a server that shows them: nothing here starts SUMO."""

import gzip
import http.client
import json
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from automotive_cosim.formats.layout import LIVE, WATCHED
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.rows import EpisodeRow, PartsHeld
from automotive_cosim.run.trial_folder import shown
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.server import WebServer
from automotive_cosim.serve.study import PeopleStudy
from automotive_cosim.tasking.task import Dimension, Module

HOSTILE = "<img src=x onerror=\"document.title='broken in'\">"
BUTTON = {
    "text": "Warn driver",
    "content_description": "",
    "class_name": "Button",
    "bbox_pixels": {"x_min": 640, "y_min": 360, "x_max": 960, "y_max": 480},
    "resource_id": "safety.warn",
    "package_name": "automotive",
    "is_clickable": True,
}


def step(number: int, thought: str = "") -> dict[str, Any]:
    action = {"action_type": "click", "index": 0} if number else None
    return {
        "step": number,
        "time_s": 100.0 + 2 * number,
        "local_time": "2026-11-17T08:16:00+01:00",
        "traffic": {"speed_mps": 20.0},
        "signals": {},
        "elements": [BUTTON],
        "action": action,
        "feedback": {"code": "ok", "text": thought},
        "context": "Place: Paris",
        "thought": thought,
        "stages": [{"stage": "interpret", "text": thought, "reply": None}],
    }


def result(**changes: Any) -> dict[str, Any]:
    made = {
        "task": "road_speed_80_in_50", "half": "first", "scenario": "grid", "agent": "oracle", "model": "none",
        "seed": 0, "goal": "Watch my speed.", "success": True, "reward": 1.0, "steps": 3, "sim_seconds": 6.0,
        "trace_sha256": "0" * 64, "end": "declared", "error": None,
        "verdict": {"parts": {"goal": {"ok": True, "why": "reached"}}, "basis": "wish", "rule": ""},
        "timeline": [{"at_s": 2.0, "kind": "action", "text": "taps “Warn driver”"}],
        "path": [
            {"at_s": float(s), "speed_kmh": 72.0, "limit_kmh": 50.0, "road": "Rue", "x_m": 20.0 * s, "y_m": 0.0,
             "heading_deg": 90.0}
            for s in range(-2, 8)
        ],
        "violations": [],
    }  # fmt: skip
    return made | changes


GROUND = [["water", [-500, 10, 500, 10, 500, 60, -500, 60]], ["green", [-500, -90, 500, -90, 500, -10, -500, -10]]]


def road(seconds: range = range(-2, 8)) -> list[dict[str, Any]]:
    lane = ["road", 3.2, [-500.0, 0.0, 500.0, 0.0], [["light", 0]]]
    head: list[dict[str, Any]] = [
        {"format": 1, "radius_m": 800.0, "left_hand": False, "has_place": True},
        {"lanes": [lane], "junctions": [[500, -5, 510, -5, 510, 5]], "ground": GROUND},
        {"vehicles": [[0, "ego", "passenger", 4.5, 1.8], [1, HOSTILE, "bus", 12.0, 2.5]]},
    ]
    return head + [
        {
            "at_s": float(s), "seen": [[0, 20.0 * s, 0.0, 90.0, 20.0, 8], [1, 30.0, 5.0, 270.0, 0.0, 4]],
            "lights": {"light": "r"}, "speed_kmh": 72.0, "limit_kmh": 50.0, "road": "Rue",
            "local_time": "2026-11-17T08:16:00+01:00", "sun_deg": 20.0, "weather_code": 0,
            "incidents": [], "events": [],
        }
        for s in seconds
    ]  # fmt: skip


def packed(lines: list[dict[str, Any]]) -> bytes:
    return gzip.compress("".join(json.dumps(line) + "\n" for line in lines).encode())


def write_record(folder: Path, steps: int = 4, *, finished: bool = True, **changes: Any) -> Path:
    """A record of ``run``, as it is or as a killed run leaves it."""
    (folder / "screenshots").mkdir(parents=True)
    lines = shown([step(number, changes.get("goal", "")) for number in range(steps)])
    (folder / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    for number in range(steps):
        Image.new("RGB", (320, 180), (40 * number, 90, 160)).save(folder / "screenshots" / f"step_{number:03d}.jpg")
    (folder / "road.jsonl.gz").write_bytes(packed(road()))
    told: dict[str, Any] = {"manifest": {"started": "2026-11-22T21:59:42+00:00"}}
    if finished:
        told["result"] = result(**changes)
    (folder / "trial.json").write_text(json.dumps(told), encoding="utf-8")
    return folder


def write_drive(folder: Path) -> Path:
    """A record of ``drive``: one event that was met, one that was missed, and a look-alike."""
    (folder / "screenshots").mkdir(parents=True)
    lines = [
        {
            **{"step": number, "picture": min(number, 1), "at_s": 2.0 * number, "local_time": "", "words": "waits"},
            **{"action": None, "target": None, "feedback": {"code": "ok", "text": ""}, "thought": "", "stages": []},
            **{"context": "", "speed_kmh": 72.0},
        }
        for number in range(4)
    ]
    (folder / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    for number in range(2):
        Image.new("RGB", (320, 180), (90, 40 * number, 160)).save(folder / "screenshots" / f"step_{number:03d}.jpg")
    baseline = {"baseline": [[float(s), 15.0 * s, 0.0, 90.0, 15.0] for s in range(8)]}
    (folder / "road.jsonl.gz").write_bytes(packed([*road(range(8)), baseline]))
    events = [
        {"kind": kind, "words": kind, "lookalike": alike, "weight": 1.0, "outcome": outcome, "observable_s": 1.0,
         "obliged_s": 2.0, "deadline_s": None if alike else 5.0, "ends_s": 6.0}
        for kind, alike, outcome in (("limit", False, "hit"), ("rain", False, "missed"), ("dusk", True, "avoided"))
    ]  # fmt: skip
    acts = [{"time_s": 3.0, "words": "warns of speed", "worth": "right"}]
    row = {"id": "one", "season": "summer", "family": "grid_june", "scenario": "grid",
           "agent": "rule-perfect", "model": "none", "seed": 0,
           "value": 50.0, "events": events, "acts": acts, "end": "minutes_over"}  # fmt: skip
    told = {"row": row, "result": {"timeline": {}}, "manifest": {"setup": {"family": "grid_june", "seed": 0}}}
    (folder / "trial.json").write_text(json.dumps(told), encoding="utf-8")
    return folder


def write_evaluation(
    folder: Path, won: tuple[bool, bool] = (True, False), agent: str = "oracle", model: str = "none"
) -> Path:
    (folder / "traces").mkdir(parents=True)
    (folder / "pictures" / "one" / "screenshots").mkdir(parents=True)
    plan = {"format": 1, "plan": {"agents": [agent]}, "episodes": 2, "starts": [{"started": "2026-11-22T18:00:00"}]}
    (folder / "manifest.json").write_text(json.dumps(plan), encoding="utf-8")
    rows = [
        EpisodeRow(
            id=name, task="road_speed_80_in_50", half="first", pair="", dimension=Dimension.DRIVING_ALIGNMENT,
            module=Module.ROAD, scenario="grid", agent=agent, model=model,
            seed=seed, repeat=0, success=ok, steps=3, sim_seconds=6.0, parts=PartsHeld(ok, True, True, True, True),
        )
        for seed, (name, ok) in enumerate(zip(("one", "two"), won, strict=True))
    ]  # fmt: skip
    text = "".join(json.dumps(as_json(row)) + "\n" for row in rows)
    (folder / "episodes.jsonl").write_text(text, encoding="utf-8")
    trace = [*map(step, range(4)), {"result": result()}]
    (folder / "traces" / "one.jsonl.gz").write_bytes(packed(trace))
    for name in ("step_000.jpg", "road_001.jpg"):
        Image.new("RGB", (320, 180)).save(folder / "pictures" / "one" / "screenshots" / name)
    return folder


def write_study(folder: Path) -> Path:
    """A study of rerouting in the small scenario: a decision with another way, and one of an older version."""
    pytest.importorskip("automotive_cosim.studies")
    from automotive_cosim.studies.reroute.plan import StudyPlan
    from automotive_cosim.studies.reroute.rows import NOTHING, Branch, Decision, News, OthersTotals, TripRow

    plan = StudyPlan(scenario="grid", seeds=(0,), policies=("never", "always"))
    job = plan.jobs()[0]
    manifest = {"format": 1, "plan": plan.as_json(), "starts": [{"started": "2026-11-22T18:00:00"}]}
    branch = Branch(
        gains=replace(NOTHING, time_s=30.0),
        totals=NOTHING,
        others=OthersTotals(count=3, gain_s=-4.0, changed=1, unfinished_stay=0, unfinished=0),
    )
    old = Decision(
        at_s=900.0, edge="cwc0", delay_s=70.0, eta_s=100.0, relative_speed=0.5,
        news=(News(age_s=0.0, stay_s=100.0, delay_s=70.0, offered_s=80.0, branch=0),), own=None, agents={},
        agents_rerouted=(), branches=(branch,),
    )  # fmt: skip
    new = replace(old, at_s=950.0, ways=(("cwc0", "c0c1", "c1c2"), ("cwc0", "c0n0", "n0n1")))
    row = TripRow(
        id=job.id, scenario="grid", share=job.share, seed=0, departure_s=0.0, trip=job.trip.name, stay=NOTHING,
        decisions=(old, new),
    )  # fmt: skip
    folder.mkdir(parents=True)
    (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    (folder / "episodes.jsonl").write_text(json.dumps(as_json(row)) + "\n", encoding="utf-8")
    track = ["id,draw,branch,is_placebo,time_s,x_m,y_m,speed_mps,edge"]
    for branch_, seconds in (("", 40), ("0", 10)):
        track += [f"{job.id}-1,0,{branch_},False,{950 + s},{100.0 + s},{200.0},1,a" for s in range(seconds + 1)]
    (folder / "trajectories").mkdir()
    text = gzip.compress("\n".join([*track, ""]).encode())
    (folder / "trajectories" / f"{job.id}.csv.gz").write_bytes(text)
    return folder


def write_adoption(folder: Path) -> Path:
    """A study of adoption with two equipped cars, of which one has lost its assistant."""
    pytest.importorskip("automotive_cosim.studies")
    from automotive_cosim.studies.adoption.adoption import (
        AdoptionPlan,
        AdoptionRow,
        Cohort,
        EquippedCar,
        ShareOutcome,
    )

    plan = AdoptionPlan("grid", seeds=(1,), shares=(100.0,))
    both = Cohort(
        cars=2, arrived=2, time_s=60.0, before_s=70.0, lost_s=5.0, side=0.1, near_s_h=0.0, energy_wh_km=700.0
    )
    named = {"departs_s": 0.0, "time_s": 60.0, "arrived": True, "lost_s": 5.0, "driven_m": 500.0, "warnings": 0}
    cars = (
        EquippedCar(car="ego", before_s=70.0, reroutes=1, **named),
        EquippedCar(car=HOSTILE, before_s=None, reroutes=0, error="ValueError: boom", **named),
    )
    outcome = ShareOutcome(
        share=1.0, equipped=both, others=None, all=both, reroutes=1, warnings=0, hazards=0, failed=1, cars=cars
    )
    row = AdoptionRow(id="seed1", scenario="grid", seed=1, shares=(outcome,))
    lines = road()
    lines[5]["events"] = ["ego: another way, which the driver takes", f"{HOSTILE}: loses its assistant: boom"]
    live = folder / "live" / "seed1-100"
    live.mkdir(parents=True)
    (live / "road.jsonl.gz").write_bytes(packed(lines))
    (folder / "manifest.json").write_text(json.dumps({"format": 1, "plan": plan.as_json()}), encoding="utf-8")
    (folder / "episodes.jsonl").write_text(json.dumps(as_json(row)) + "\n", encoding="utf-8")
    return folder


def write_live_drive(study: Path, drive: str, seconds: range = range(1, 8)) -> Path:
    """A drive of a running study as somebody sees it who watches."""
    folder = study / LIVE / drive
    folder.mkdir(parents=True)
    (study / LIVE / WATCHED).touch()
    rest = {"action": None, "target": None, "feedback": {"code": "", "text": ""}, "context": "", "thought": HOSTILE}
    saved = "decision 1, alternative 1: saves +30 s, all others -4 s"
    words = ("departure", "decision 1: 70 s of delay ahead", saved)
    stages = [{"name": "who chooses what", "text": "alternative 1: always"}]
    lines = [
        {**rest, "step": number, "at_s": 2.0 * number, "words": told, "stages": stages}
        for number, told in enumerate(words)
    ]
    (folder / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    head, *rows = road(seconds)
    about = {"task": "avenue", "scenario": "grid", "agent": "departs after 0 s", "model": "none", "seed": 0}
    (folder / "road.jsonl.gz").write_bytes(packed([head | about, *rows]))
    return folder


@dataclass
class Reply:
    status: int
    headers: http.client.HTTPMessage
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


@dataclass
class Browser:
    """Asks a server as somebody who has opened its address."""

    server: WebServer

    def __call__(
        self, path: str, method: str = "GET", *, token: str | None = None, body: str | None = None, **headers: str
    ) -> Reply:
        """``token`` replaces the cookie's; an underscore in a header's name is a hyphen."""
        connection = http.client.HTTPConnection("127.0.0.1", self.server.server_port, timeout=10)
        port = self.server.server_port
        cookie = self.server.token if token is None else token
        sent = {"Host": f"127.0.0.1:{port}", "Cookie": f"automotive_cosim_{port}={cookie}"}
        sent |= {name.replace("_", "-"): value for name, value in headers.items()}
        connection.request(method, path, body, headers=sent)
        answer = connection.getresponse()
        reply = Reply(answer.status, answer.headers, answer.read())
        connection.close()
        return reply


@pytest.fixture
def serving() -> Iterator[Callable[..., Browser]]:
    servers: list[tuple[WebServer, threading.Thread]] = []

    def start(
        *folders: Path, host: str = "127.0.0.1", game: Game | None = None, study: PeopleStudy | None = None
    ) -> Browser:
        server = WebServer(list(folders), host, game=game, study=study)
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        servers.append((server, thread))
        return Browser(server)

    yield start
    for server, thread in servers:
        server.shutdown()
        thread.join()
        server.server_close()
