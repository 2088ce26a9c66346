"""The table of touch, functions and both: means and paired differences, by hand."""

from dataclasses import replace
from pathlib import Path

from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.report.interfaces import interfaces
from automotive_cosim.report.results import Results
from automotive_cosim.run.coverage import Coverage
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow

PLAN = make_plan({"agents": ["caller"], "tasks": ["hvac_fan_max", "hvac_cold_hands", "apps_pay_parking"]})


def results(won: dict[str, tuple[bool, bool, bool]], steps: dict[str, int]) -> Results:
    """Each interface's success on three tasks, and its steps."""
    rows: list[EpisodeRow] = []
    for name, outcomes in won.items():
        for job, success in zip(PLAN.jobs(), outcomes, strict=True):
            conditions = Conditions.named({"interface": name})
            planned = replace(job.planned(), id=f"{job.id}-{name}", conditions=conditions, success=success)
            rows.append(replace(planned, steps=steps[name], sim_seconds=2.0 * steps[name], interaction_s=None))
    return Results(Path(), {"plan": PLAN.as_json(), "starts": []}, tuple(rows), Coverage(len(rows), 0))


def test_each_interface_is_compared_with_touch() -> None:
    won = {"touch": (True, False, False), "functions": (True, True, True)}
    found = interfaces(results(won, {"touch": 5, "functions": 2}))
    touch, functions = (dict(zip(found.columns, map(str, row), strict=True)) for row in found.rows)
    assert (touch["Interface"], functions["Interface"]) == ("touch", "functions")
    assert touch["Success"].endswith("1/3")
    assert (touch["Success minus touch's"], touch["Steps"]) == ("–", "5.0")
    assert functions["Success minus touch's"] == "+67%", "three tasks are too few for an interval"
    assert functions["Steps minus touch's"] == "-3.0"
    assert functions["Time, s minus touch's"] == "-6.0"
    assert functions["Driver's interaction, s minus touch's"] == "–", "it was not measured"


def test_one_interface_alone_is_no_comparison() -> None:
    assert not interfaces(results({"both": (True, True, True)}, {"both": 1})).rows
