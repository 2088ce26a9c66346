"""Two evaluations made by hand, compared as a check on a change would."""

import json
from dataclasses import replace
from xml.etree import ElementTree

import pytest

import automotive_cosim
from automotive_cosim.contracts.given import Clock
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UserError
from automotive_cosim.report.regression import as_json, changes, junit, markdown
from automotive_cosim.run.episode_row import EpisodeRow, PartsHeld
from automotive_cosim.run.jobs import failed
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.store import opened

TASKS = ["road_speed_80_in_50", "hvac_fan_max", "hvac_cold_hands", "hvac_driver_seat_heater"]
PLAN = make_plan({"agents": ["asurada"], "tasks": TASKS, "seeds": [0, 1]})


def write(folder, lost=(), errors=(), agent="asurada", **changed):
    """An evaluation in which the named episodes are lost or broken, and all others won."""
    with opened(folder, PLAN.as_json(), EpisodeRow) as store:
        for number, job in enumerate(PLAN.jobs()):
            if number in errors:
                row = failed(job, "WorkerDied", "the worker died")
            else:
                won = number not in lost
                row = replace(job.planned(), success=won, parts=PartsHeld(won, True, True, True, True))
            store.append(replace(row, agent=agent, **changed))
    return folder


def test_the_same_twice_is_as_good(tmp_path):
    first = write(tmp_path / "a", lost={1})
    found = changes(first, write(tmp_path / "b", lost={1}))
    assert [each.unit for each in found] == ["episodes", "pairs"]
    assert not any(each.is_worse(0.0) for each in found)
    assert "unchanged" in markdown(found, 0.0)
    assert "Lost," not in markdown(found, 0.0)


def test_a_difference_within_chance_is_not_distinguishable_and_in_points(tmp_path):
    found = changes(write(tmp_path / "a", lost={1}), write(tmp_path / "b"))
    told = markdown(found, 0.0)
    assert found[0].outcome(0.0) == "not distinguishable"
    assert found[0].passes(0.0)
    assert f"{100 / len(PLAN.jobs()):+.1f} points (" in told
    assert as_json(found, 0.0)["ok"]
    assert not changes(tmp_path / "b", tmp_path / "a")[0].passes(0.0), "a fall is worse all the same"
    clear = changes(write(tmp_path / "c", lost=set(range(len(PLAN.jobs())))), tmp_path / "b")
    assert clear[0].outcome(0.0) == "better"


def test_a_fall_is_worse_beyond_what_is_allowed_and_named(tmp_path):
    found = changes(write(tmp_path / "a", lost={1}), write(tmp_path / "b", lost={1, 2}))
    episodes = found[0]
    share = 1 / len(PLAN.jobs())
    assert episodes.found.difference == pytest.approx(-share)
    assert episodes.is_worse(0.0)
    assert episodes.is_worse(share - 0.01)
    assert not episodes.is_worse(share)
    told = markdown(found, 0.0)
    assert PLAN.jobs()[2].task.id in told.partition("**Lost")[2]
    assert "missing: goal" in told


def test_what_an_agent_raised_is_told_where_it_lost(tmp_path):
    raised = {"malformed": 20, "malformed_why": "agent 'mine' raised ZeroDivisionError: division by zero"}
    found = changes(write(tmp_path / "a"), write(tmp_path / "b", lost={1}, **raised))
    for told in (markdown(found, 0.0), junit(found)):
        assert "no action in 20 steps, at first: agent 'mine' raised ZeroDivisionError" in told


def test_an_improvement_is_not_worse(tmp_path):
    found = changes(write(tmp_path / "a", lost={0, 1, 2}), write(tmp_path / "b"))
    assert found[0].count("won") == 3
    assert not any(each.is_worse(0.0) for each in found)


def test_what_is_not_judged_any_more_is_worse_and_hides_nowhere(tmp_path):
    found = changes(write(tmp_path / "a"), write(tmp_path / "b", errors={0}))
    assert found[0].count("error") == 1
    assert found[0].is_worse(1.0)
    assert "WorkerDied" in markdown(found, 1.0)
    back = changes(tmp_path / "b", tmp_path / "a")
    assert len(back[0].cases) == len(found[0].cases) - 1


def test_a_pair_with_a_half_that_is_not_judged_is_told_whichever_half_it_is(tmp_path):
    halves = [number for number, job in enumerate(PLAN.jobs()) if job.pair and job.setup.seed == 0]
    first = write(tmp_path / "a")
    for number in halves:
        pairs = changes(first, write(tmp_path / f"b{number}", errors={number}))[1]
        (broken,) = [case for case in pairs.cases if case.kind == "error"]
        assert broken.why


def test_junit_counts_what_it_lists(tmp_path):
    found = changes(write(tmp_path / "a", lost={1}), write(tmp_path / "b", lost={1, 2}, errors={3}))
    root = ElementTree.fromstring(junit(found))
    suite = root[0]
    kinds = [case[0].tag if len(case) else "passed" for case in suite]
    assert len(kinds) == int(suite.get("tests")) == len(PLAN.jobs())
    for tag, attribute in (("failure", "failures"), ("error", "errors")):
        assert kinds.count(tag) == int(suite.get(attribute)) == 1
    assert suite.get("skipped") is None, "what was not solved before either is no news"


def test_runs_that_share_nothing_are_refused(tmp_path):
    with pytest.raises(UserError, match="have no agent in common"):
        changes(write(tmp_path / "a"), write(tmp_path / "b", agent="t3a"))


def test_people_are_compared_with_themselves_and_beside_an_agent_it_is_said_where_to_look(tmp_path):
    people = write(tmp_path / "people", agent="human", model="heron", conditions=Conditions(clock=Clock.MODEL))
    later = write(
        tmp_path / "later", lost={2}, agent="human", model="heron", conditions=Conditions(clock=Clock.MODEL)
    )
    (episodes, _) = changes(people, later)
    assert (episodes.contestant.label, episodes.count("lost")) == ("human, heron, model's clock", 1)
    named = r"people \(human, heron, model's clock\) and \S+ \(asurada.*\) have no .* serve"
    with pytest.raises(UserError, match=named):
        changes(people, write(tmp_path / "agent"))


def test_the_command_tells_by_its_exit_code_and_writes_both_files(tmp_path):
    from typer.testing import CliRunner

    from automotive_cosim.cli.main import app

    first, second = str(write(tmp_path / "a")), str(write(tmp_path / "b", lost={2}))
    runner = CliRunner()
    files = ["--junit", str(tmp_path / "j.xml"), "--markdown", str(tmp_path / "m.md")]
    worse = runner.invoke(app, ["compare", first, second, *files])
    assert worse.exit_code == 1
    assert (tmp_path / "m.md").read_text() == worse.output
    assert ElementTree.parse(tmp_path / "j.xml").getroot().tag == "testsuites"
    assert runner.invoke(app, ["compare", first, second, "--threshold", "60"]).exit_code == 0
    assert runner.invoke(app, ["compare", first, first]).exit_code == 0
    refused = runner.invoke(app, ["compare", first, second, "--threshold", "-1"])
    assert isinstance(refused.exception, UserError)


def test_two_minor_versions_are_compared_only_if_told_and_that_is_said(tmp_path):
    before, after = write(tmp_path / "a"), write(tmp_path / "b", lost={1})
    manifest = json.loads((before / "manifest.json").read_text())

    def was_run_with(version):
        manifest["starts"][0]["versions"]["automotive-cosim"] = version
        (before / "manifest.json").write_text(json.dumps(manifest))

    assert manifest["starts"][0]["versions"]["automotive-cosim"] == automotive_cosim.__version__
    was_run_with("0.1.7")
    with pytest.raises(UserError, match=r"0\.1\.7 .* --mixed-versions"):
        changes(before, after)
    found = changes(before, after, mixed=True)
    assert "Before is automotive-cosim 0.1.7" in markdown(found, 0.0)
    assert as_json(found, 0.0)["mixed_versions"] is True
    was_run_with(".".join([*automotive_cosim.__version__.split(".")[:2], "99"]))
    assert "Before is" not in markdown(changes(before, after), 0.0)
    assert as_json(changes(before, after), 0.0)["mixed_versions"] is False
    del manifest["starts"][0]["versions"]
    (before / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(UserError, match="unknown"):
        changes(before, after)
