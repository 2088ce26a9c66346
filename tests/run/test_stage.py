"""Stages of a job: each is told once, and its amounts not more often than once a second."""

from __future__ import annotations

import pytest

from automotive_cosim.run import stage


def test_a_stage_is_told_once_and_its_amounts_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = 0.0
    monkeypatch.setattr(stage.time, "monotonic", lambda: now_s)
    told: list[str] = []
    with stage.telling(told.append):
        for now_s in (0.0, 0.5, 1.2):
            stage.doing("warming up traffic", f"{60 * now_s:.0f} of 600 s")
        stage.doing("agent at work", "step 0")
    stage.doing("nobody is told", "")
    assert told == ["warming up traffic, 0 of 600 s", "warming up traffic, 72 of 600 s", "agent at work, step 0"]
