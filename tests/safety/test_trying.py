"""A search in SUMO: its folder is an evaluation, and goes on where it was stopped."""

from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.agents import Agent
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.agents.trivial import AlwaysAlert
from automotive_cosim.contracts import Json
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.staging import BRINGS
from automotive_cosim.drives.watchers import Silent
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import DUE
from automotive_cosim.report.results import read_results
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.plan import Plan, make_plan
from automotive_cosim.run.rows import DriveTrialRow, TrialRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.trial import TrialSetup, run_trial
from automotive_cosim.run.worker import run_with
from automotive_cosim.safety import due
from automotive_cosim.safety.budget import SearchBudget
from automotive_cosim.safety.dossier.filing import write_dossier
from automotive_cosim.safety.due import why_not
from automotive_cosim.safety.hunt import Hunt, hunt
from automotive_cosim.safety.page import FINDINGS, PAGE, PLANS, write_findings
from automotive_cosim.safety.samplers import make_sampler
from automotive_cosim.safety.space import FactorChoices, FactorRange, FailureRule, Space
from automotive_cosim.safety.trying import check_space, trial_of, trying
from automotive_cosim.traffic.fork import Simulations

SPACE = Space(
    (
        FactorChoices("task", ("hvac_fan_max",)),
        FactorChoices("scenario", ("grid",)),
        FactorRange("latency_s", 0.0, 9.0, 0.0),
    )
)
ABOUT: Json = {"sampler": "sobol", "space": "", "agent": "oracle", "model": "rules", "seed": 0}


def plan() -> Plan:
    trials = [as_json(trial_of(SPACE.nominal))]
    return make_plan({"agents": ["oracle"], "models": ["rules"], "trials": trials})


@pytest.mark.slow
def test_a_search_finds_what_is_planted_and_goes_on(tmp_path: Path, simulations: Simulations) -> None:
    def run(job: TrialSetup, folder: Path) -> TrialRow:
        agent: Agent = AlwaysAlert() if job.conditions.latency_s > 5 else Oracle()
        return run_with(nullcontext(agent), job, folder, Pictures.NONE, simulations)

    folder = tmp_path / "search"
    check_space(SPACE, plan())
    ran: list[int] = []
    found: list[Hunt] = []
    for budget in (2, 4, 4):
        with trying(SPACE, plan(), folder, run) as tries:
            found.append(hunt(SPACE, tries, make_sampler("sobol", SPACE, 2, 1), budget))
            page = write_findings(folder, found[-1], "oracle", "rules", ABOUT)
        ran.append(tries.ran)
    with trying(SPACE, plan(), folder, run, budget=SearchBudget(hours=1), used_s=3600) as tries:
        spent = hunt(SPACE, tries, make_sampler("sobol", SPACE, 2, 1), 5)
    assert "1 hours" in spent.stopped
    assert (spent.tried, tries.ran) == (found[2].tried, 0), "what is known costs nothing"
    assert ran[0] > 0
    assert ran[2] == 0
    assert found[2].tried == found[1].tried
    (minimal,) = found[2].minimal
    assert minimal.changed == ("latency_s",)
    assert 5 < float(minimal.point["latency_s"]) < 7
    assert page.name == PAGE
    assert "latency at least" in page.read_text()
    assert "deterministic stand-in" not in page.read_text(), "the oracle has no model"
    assert (folder / FINDINGS).is_file()
    assert make_plan({**_read(folder / PLANS / "01.toml")}).jobs()
    dossier, _ = write_dossier(folder)
    assert minimal.words(SPACE) in dossier.read_text("utf-8")
    assert (dossier.parent / "data" / PLANS / "01.toml").is_file()
    results = read_results(folder)
    assert results.coverage.problem == ""
    assert not results.coverage.not_run
    assert len(results.rows) == len({each.outcome.trial for each in found[2].tried})


def _read(path: Path) -> Json:
    from automotive_cosim.run.plan import read_plan

    return read_plan(path)


SHORT = DriveSettings(minutes=2.5, coarse=True)


@pytest.mark.slow
def test_without_an_agent_as_much_comes_due_as_a_silent_one_misses(simulations: Simulations) -> None:
    found = {}
    for stage in ("belt", "leader_stops", "tractor"):
        kinds = BRINGS.get(stage, (stage,))
        spec = DriveSetup("grid_june", 3, settings=replace(SHORT, stage=stage), agent="silent", model="none")
        row = run_trial(spec, Silent(), simulations=simulations)
        assert isinstance(row, DriveTrialRow)
        missed = any(event.outcome.counts for event in row.events if event.kind in kinds)
        found[stage] = why_not(spec, kinds, simulations)
        assert missed is not bool(found[stage]), (stage, found[stage])
    assert found["belt"] == ""
    assert found["tractor"] in ("it never came", "it came and asked for no act")


@pytest.mark.slow
def test_what_cannot_come_about_is_said_before_with_how_to_mend_it(
    tmp_path: Path, simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(due, "MENDS", (("minutes", 2.4),))
    fixed = {"minutes": 2.0, "coarse": True, "drive": "grid_june", "stage_s": 30.0}
    space, none = (
        Space(
            (*(FactorChoices(name, (value,)) for name, value in fixed.items()), FactorChoices("stage", stages)),
            FailureRule(events=("belt", "tractor")),
        )
        for stages in (("belt", "tractor"), ("tractor",))
    )
    asked = make_plan({"agents": ["silent"], "trials": [as_json(trial_of(space.nominal))]})
    screen = due.DueScreen(space, asked, simulations, tmp_path)
    line, told = screen.check()
    assert told == "driven without an agent: something comes due in 1 of 2 choices of drive and stage"
    assert line.startswith(
        "grid_june, tractor: nothing came due in 1 drive without an agent: it never came (1); nor with minutes 2.4"
    )
    assert screen.is_due(space.nominal)
    again = due.DueScreen(space, asked, simulations, tmp_path)
    assert list(again.check()) == [line, told]
    assert again.tried == 0, "what was tried is kept"
    for damage in ("{", "[1]", '{"a": 1}'):
        (tmp_path / DUE).write_text(damage)
        assert due.DueScreen(space, asked, simulations, tmp_path).tried == 0, "what cannot be read is tried again"
    with trying(space, asked, tmp_path, lambda job, folder: pytest.fail("nothing is run")):
        pass  # the search itself goes on in that folder
    with pytest.raises(UserError, match="nothing comes due in this space"):
        list(due.DueScreen(none, asked, simulations, tmp_path).check())
