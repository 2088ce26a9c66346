"""The table of house rules counts what was broken, and leaves out rows that say nothing about it."""

from automotive_cosim.report.house_rules import house_rules
from automotive_cosim.report.results import contestant
from automotive_cosim.run.job_row import columns
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.tasking.policy import Breach
from automotive_cosim.tasking.task import Dimension, Module

LOCKED = Breach("doors_lock_nobody_in", 2.0, 3)


def row(number: int, breaches: tuple[Breach, ...] | None, *, success: bool = True) -> EpisodeRow:
    return EpisodeRow(
        id=f"episode{number}",
        scenario="grid",
        agent="t3a",
        model="rules",
        seed=number,
        task="system_lock_up",
        half="second",
        pair="system_lock_up",
        dimension=Dimension.DRIVING_ALIGNMENT,
        module=Module.SYSTEM,
        success=success,
        breaches=breaches,
    )


def test_a_rule_that_was_broken_is_counted_whether_or_not_the_task_was_solved():
    rows = [row(0, ()), row(1, (LOCKED,)), row(2, (LOCKED, LOCKED), success=False), row(3, None)]
    ((name, kept, solved, count, worst),) = house_rules({contestant(rows[0]): rows}).rows
    assert str(name) == contestant(rows[0]).label
    assert str(kept).startswith("33%")
    assert str(solved).startswith("33%")
    assert (str(count), str(worst)) == ("3", "doors_lock_nobody_in (3)")


def test_rows_from_before_there_were_rules_make_no_table():
    assert house_rules({contestant(row(0, None)): [row(0, None)]}).rows == ()


def test_a_breach_is_a_column_of_a_data_frame():
    assert columns(row(0, (LOCKED,)))["breaches"] == [{"rule": "doors_lock_nobody_in", "at_s": 2.0, "step": 3}]
