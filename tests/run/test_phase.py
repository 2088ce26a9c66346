"""Stages of a job: each is told once, and its amounts not more often than once a second."""

import pytest

from automotive_cosim.run import phase


def test_a_stage_is_told_once_and_its_amounts_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = 0.0
    monkeypatch.setattr(phase.time, "monotonic", lambda: now_s)
    told: list[phase.JobPhase] = []
    with phase.telling(told.append):
        for now_s in (0.0, 0.5, 1.2):
            phase.warming_up(60 * now_s, 600)
        phase.doing("agent at work", "step 0")
        for now_s in (1.3, 2.0, 2.4):
            phase.doing("driving", share=now_s / 10)
    phase.doing("nobody is told", "")
    assert told == [
        phase.JobPhase("warming up traffic, 0 of 600 s", is_warm_up=True, share=0.0),
        phase.JobPhase("warming up traffic, 72 of 600 s", is_warm_up=True, share=0.12),
        phase.JobPhase("agent at work, step 0"),
        phase.JobPhase("driving", share=0.13),
        phase.JobPhase("driving", share=0.24),
    ]
