"""Every condition is one line: whatever is in the table is in plans, ids, options, doors and reports."""

import inspect
import json

import pytest

from automotive_cosim.cli import evaluate, run
from automotive_cosim.doors.shared import conditions_of, takes_conditions
from automotive_cosim.episode.conditions import INPUTS, TABLE, Condition, Conditions
from automotive_cosim.errors import UserError
from automotive_cosim.publish.leaderboard import COLUMNS, DRIVE_COLUMNS
from automotive_cosim.report.findings import by_condition
from automotive_cosim.report.results import Results
from automotive_cosim.run.coverage import Coverage
from automotive_cosim.run.job_row import as_json, columns, from_line
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow
from tests.laws import over

BASE = {"agents": ["oracle"], "tasks": ["hard_car_wash"]}


def another(condition: Condition) -> object:
    """A value that is not the default."""
    return next((each for each in condition.choices if each != str(condition.default)), 3.0)


@over(TABLE)
def test_a_condition_reaches_jobs_ids_rows_tables_and_columns(condition: Condition) -> None:
    value = another(condition)
    plan = make_plan(BASE | {condition.name: [str(condition.default) if condition.choices else 0.0, value]})
    rows = [job.planned() for job in plan.episodes() if job.half == "first"]
    assert len({row.id for row in rows}) == 2
    assert {condition.of(row.conditions) for row in rows} == {condition.default, value}
    assert all(condition.name in columns(row) for row in rows)
    assert sorted(len(row.conditions.labels) for row in rows) == [0, 1]
    for row in rows:
        assert from_line(EpisodeRow, json.dumps(as_json(row)).encode()) == row
    found = Results(None, {"plan": {}}, tuple(rows), Coverage(2, 0))  # type: ignore[arg-type]
    assert [table.name for table in by_condition(found) if table.rows] == [f"by_{condition.word}"]


@over(TABLE)
def test_a_condition_has_help_an_option_of_each_command_and_a_column(condition: Condition) -> None:
    assert condition.help.endswith(".")
    for command in (run.run, evaluate.evaluate):
        assert condition.name in inspect.signature(command).parameters
    assert condition.words.heading in COLUMNS
    assert condition.words.heading in DRIVE_COLUMNS


def test_a_door_takes_whatever_an_agent_is_given_and_nothing_about_its_speed() -> None:
    @takes_conditions
    def start(task: str, **conditions: str) -> Conditions:
        return conditions_of(conditions)

    assert [*inspect.signature(start).parameters][1:] == [each.name for each in INPUTS]
    assert start("x", see="tree") == Conditions.named({"see": "tree"})
    for wrong in ({"clock": "model"}, {"sea": "tree"}, {"see": "tre"}):
        with pytest.raises(UserError):
            start("x", **wrong)


def test_a_row_of_0_2_which_has_no_table_of_conditions_is_refused() -> None:
    row = make_plan(BASE).episodes()[0].planned()
    flat = as_json(row)
    flat |= flat.pop("conditions")
    with pytest.raises(ValueError, match="conditions"):
        from_line(EpisodeRow, json.dumps(flat).encode())
