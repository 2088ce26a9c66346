"""Rows come back from their lines, those of older versions too, and bad ones are told."""

import json
from dataclasses import MISSING, fields, replace
from typing import Any

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.proof.prover import Proof
from automotive_cosim.run.executor import failed
from automotive_cosim.run.figures import DriveFigures
from automotive_cosim.run.job_row import JobRow, as_json, columns, from_json, from_line, steady
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow, PartsHeld
from automotive_cosim.run.store import opened, read_rows
from automotive_cosim.tasking.task import Basis
from automotive_cosim.tasking.verdict import PARTS, Part, Verdict

OLD: dict[str, Any] = {
    "id": "a", "task": "road_speed_80_in_50", "half": "first", "pair": "p", "dimension": "environment_alerts",
    "module": "road", "scenario": "paris_centre", "agent": "oracle", "model": "none", "seed": 0,
    "repeat": 0, "conditions": {}, "success": True, "reward": 1.0, "end": "declared", "steps": 2, "error": None,
    "parts": {"goal": True, "clean": True, "safe": True, "in_time": True, "declared": True}, "error_kind": None,
    "drive": {"overspeed_m": 0.0, "min_time_to_collision_s": 40.9, "arrival_s": 271.1, "energy_wh": 42.9},
    "baseline_drive": {"overspeed_m": 9.5, "min_time_to_collision_s": None, "arrival_s": None, "energy_wh": 50},
    "cost_usd": 0, "trace_sha256": "ab" * 32,
}  # fmt: skip
"""An episode without the fields that came later."""

JOB = make_plan({"agents": ["oracle"], "tasks": ["road_speed_80_in_50"]}).jobs()[0]
DRIVE = DriveFigures(1.5, None, 60.0, 9.0)
EPISODE = replace(
    JOB.planned(), success=False, parts=PartsHeld(True, True, True, False, True), parameters={"x": 3}, drive=DRIVE,
    baseline_drive=DRIVE, prompt_tokens=(400, 500), attempts=2, failed_attempts=("WorkerDied: gone",),
)  # fmt: skip
ROWS = (
    EPISODE,
    failed(JOB, "WorkerDied", "its process ended"),
    Proof(id="p", task="t", seed=0, wrong={"oracle": [], "near": ["why"]}, oracle_steps={"first": 3}),
    JobRow(id="j"),
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=lambda row: type(row).__name__)
def test_a_row_comes_back_from_its_line_equal_and_typed(row):
    comes_back(row)


def comes_back(row):
    line = json.dumps(as_json(row)).encode()
    again = from_line(type(row), line)
    assert again == row
    assert [type(getattr(again, each.name)) for each in fields(row)] == [
        type(getattr(row, each.name)) for each in fields(row)
    ]
    assert json.loads(line).keys() == {each.name for each in fields(row)}


@pytest.mark.parametrize(
    ("kind", "required"),
    [(EpisodeRow, "id task half pair dimension module scenario agent model seed"), (Proof, "id task seed")],
)
def test_whatever_is_added_to_a_row_has_a_default_so_that_older_lines_are_still_read(kind, required):
    assert required_of(kind) == set(required.split())


def required_of(kind):
    return {each.name for each in fields(kind) if each.default is MISSING and each.default_factory is MISSING}


def test_lines_without_the_later_fields_are_read():
    row = from_line(EpisodeRow, json.dumps(OLD).encode())
    assert row.baseline_drive == DriveFigures(9.5, None, None, 50.0)
    assert (row.skills, row.tokens_in, row.attempts, row.held_out) == ((), 0, 1, False)
    assert row.has_succeeded
    assert not row.missing


def test_fields_of_a_newer_version_are_passed_over():
    assert from_line(EpisodeRow, json.dumps(OLD | {"lane_changes": 3}).encode()) == from_line(
        EpisodeRow, json.dumps(OLD).encode()
    )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"steps": "two"}, "steps: "),
        ({"success": 1}, "success: "),
        ({"dimension": "depth"}, "dimension: "),
        ({"drive": {"overspeed_m": 1.0}}, "drive.min_time_to_collision_s: "),
        ({"task": None}, "task: "),
    ],
)
def test_a_line_that_is_none_is_named_with_its_field_and_what_to_do(tmp_path, change, said):
    with opened(tmp_path / "e", {"agents": ["oracle"]}, EpisodeRow) as store:
        store.append(EPISODE)
    with (tmp_path / "e" / "episodes.jsonl").open("a") as lines:
        lines.write(json.dumps(OLD | change) + "\n")
    with pytest.raises(UserError) as caught:
        read_rows(tmp_path / "e", EpisodeRow)
    assert f"line 2 cannot be read: {said}" in str(caught.value)
    assert "the version that wrote it" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_may_differ_between_two_runs_is_left_out_where_they_are_compared():
    other = replace(EPISODE, wall_seconds=7.0, attempts=1, failed_attempts=(), model_seconds=3.0)
    assert steady(other) == steady(EPISODE)
    assert as_json(EPISODE).keys() - steady(EPISODE).keys() == {
        "wall_seconds", "attempts", "failed_attempts", "model_seconds",
    }  # fmt: skip
    assert steady(replace(EPISODE, steps=9)) != steady(EPISODE)


def test_a_data_frame_has_a_column_for_each_part_and_figure():
    made = columns(EPISODE)
    assert (made["part_in_time"], made["baseline_drive_overspeed_m"], made["dimension"]) == (
        False, 1.5, "driving_alignment",
    )  # fmt: skip
    assert not {"parts", "drive", "baseline_drive"} & made.keys()
    assert "part_goal" not in columns(JOB.planned())


VERDICT = Verdict(
    Part(True, "reached"), Part(True, "nothing else"), Part(False, "no lamps"), Part(True, "4 s"),
    Part(True, "said"), goal_s=4.0, reason_fits=None, basis=Basis.POSTED, rule="sign B14",
)  # fmt: skip
STORED: dict[str, Any] = {
    "success": False,
    "parts": {
        "goal": {"ok": True, "why": "reached"}, "clean": {"ok": True, "why": "nothing else"},
        "safe": {"ok": False, "why": "no lamps"}, "in_time": {"ok": True, "why": "4 s"},
        "declared": {"ok": True, "why": "said"},
    },
    "goal_s": 4.0, "reason_fits": None, "basis": "posted", "rule": "sign B14",
}  # fmt: skip


def test_a_verdict_is_stored_as_ever_and_read_back_typed():
    assert VERDICT.as_json() == STORED
    assert list(VERDICT.as_json()["parts"]) == list(PARTS) == [each.name for each in fields(PartsHeld)]
    assert from_json(Verdict, STORED) == VERDICT
    assert PartsHeld.of(VERDICT).missing == ("safe",)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"parts": {"goal": {"ok": True, "why": ""}}}, "clean"),
        ({"parts": {**STORED["parts"], "safe": {"ok": "perhaps", "why": ""}}}, "safe.ok"),
        ({"parts": None}, "goal"),
        ({"basis": "hearsay"}, "basis"),
    ],
)
def test_a_stored_verdict_that_is_none_is_refused(changes, named):
    with pytest.raises(ValueError, match=named):
        from_json(Verdict, STORED | changes)
