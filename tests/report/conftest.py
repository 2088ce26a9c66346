"""A record as a run leaves it, made up: pages and plots need no simulation."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from automotive_cosim.run.episode import IN_RESULT, EpisodeSetup
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.trial_folder import shown


def _path() -> list[dict[str, Any]]:
    """20 s up to 80 km/h where 50 is posted, 10 s at it, 15 s down to 49; the last seconds without a limit."""
    speeds = [4.0 * t for t in range(20)] + [80.0] * 10 + [80.0 - 2.6 * t for t in range(12)] + [49.0] * 4
    return [
        {
            "at_s": float(second - 25),
            "speed_kmh": speed,
            "limit_kmh": 50.0 if second < 44 else None,
            "road": "Avenue Foch",
            "x_m": 10.0 * second,
            "y_m": 0.0,
            "heading_deg": 90.0,
        }
        for second, speed in enumerate(speeds)
    ]


def _episode(**changes: Any) -> dict[str, Any]:
    part = {"ok": True, "why": "as it should be"}
    verdict = {
        "success": True,
        "parts": {name: dict(part) for name in ("goal", "clean", "safe", "in_time", "declared")},
        "goal_s": 2.0,
        "reason_fits": None,
        "basis": "posted",
        "rule": "sign B14, 50 km/h",
    }
    return {
        "task": "road_speed_80_in_50",
        "half": "first",
        "scenario": "paris_centre",
        "agent": "asurada",
        "model": "rules",
        "seed": 0,
        "goal": "Is my driving all right? Speak up if it isn't.",
        "success": True,
        "reward": 1.0,
        "steps": 2,
        "sim_seconds": 2.0,
        "trace_sha256": "0123456789abcdef" * 4,
        "verdict": verdict,
        "violations": [],
        "timeline": [
            {"at_s": -25.0, "kind": "departure", "text": "departs on Avenue Foch: 0 km/h, 50 posted"},
            {"at_s": 0.0, "kind": "hand_over", "text": "hand-over to the agent on Avenue Foch: 80 km/h, 50 posted"},
            {"at_s": 1.0, "kind": "alert", "text": "alert to the driver: speed (warning)"},
            {"at_s": 2.0, "kind": "declared", "text": "declares complete"},
            {"at_s": 16.2, "kind": "limit", "text": "back at the limit: 51 km/h"},
        ],
        "path": _path(),
        "end": "declared",
        "error": None,
        "manifest": {
            "versions": {"automotive-cosim": "0.1.0", "python": "3.11"},
            "platform": "somewhere",
            "arguments": {"task": "road_speed_80_in_50", "scenario": None},
            "seeds": {"episode": 0},
            "started": "2026-01-01T08:00:00+01:00",
            "wall_seconds": 5.0,
        },
    } | changes


def _step(number: int, action: dict[str, Any] | None) -> dict[str, Any]:
    element = {
        "text": "Warn <driver> & co",
        "content_description": "",
        "class_name": "Button",
        "bbox_pixels": {"x_min": 0, "y_min": 0, "x_max": 100, "y_max": 60},
        "resource_id": "safety.warn",
        "package_name": "automotive",
    }
    return {
        "step": number,
        "time_s": 900.0 + number,
        "traffic": {"speed_mps": 20.0},
        "elements": [element],
        "action": action,
        "feedback": {"code": "ok", "text": ""},
        "context": "Speed limit here: 50 km/h",
        "thought": "80 is more than 50." if number else "",
    }


@pytest.fixture(scope="session")
def episode() -> Callable[..., dict[str, Any]]:
    return _episode


@pytest.fixture
def record(tmp_path: Path) -> Callable[..., Path]:
    """Writes a record with these changes of its result and returns its folder."""

    def write(**changes: Any) -> Path:
        folder = tmp_path / "record"
        (folder / "screenshots").mkdir(parents=True)
        actions = (None, {"action_type": "click", "index": 0}, {"action_type": "status", "goal_status": "complete"})
        steps = [_step(number, action) for number, action in enumerate(actions)]
        result = _episode(**changes)
        row = as_json(EpisodeSetup().planned()) | {name: result[name] for name in IN_RESULT if name in result}
        told = {"row": row, "result": result, "manifest": result.pop("manifest")}
        (folder / "trial.json").write_text(json.dumps(told), encoding="utf-8")
        lines = "".join(json.dumps(step) + "\n" for step in shown(steps))
        (folder / "steps.jsonl").write_text(lines, encoding="utf-8")
        for step in steps:
            Image.new("RGB", (1280, 720), (20, 30, 40)).save(
                folder / "screenshots" / f"step_{step['step']:03d}.jpg"
            )
        return folder

    return write
