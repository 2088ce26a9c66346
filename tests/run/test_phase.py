"""Phases of a job: each is told once, and its amounts not more often than once a second."""

import pytest

from automotive_cosim.run import executor


def test_a_phase_is_told_once_and_its_amounts_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = 0.0
    monkeypatch.setattr(executor.time, "monotonic", lambda: now_s)
    told: list[executor.JobPhase] = []
    with executor.telling(told.append):
        for now_s in (0.0, 0.5, 1.2):
            executor.warming_up(60 * now_s, 600)
        executor.doing("agent at work", "step 0")
        for now_s in (1.3, 2.0, 2.4):
            executor.doing("driving", share=now_s / 10)
    executor.doing("nobody is told", "")
    assert told == [
        executor.JobPhase("warming up traffic, 0 of 600 s", is_warm_up=True, share=0.0),
        executor.JobPhase("warming up traffic, 72 of 600 s", is_warm_up=True, share=0.12),
        executor.JobPhase("agent at work, step 0"),
        executor.JobPhase("driving", share=0.13),
        executor.JobPhase("driving", share=0.24),
    ]
