"""Two evaluations made by hand, compared as a check on a change would."""

import json
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from jinja2 import Template

import automotive_cosim
from automotive_cosim.contracts.given import Clock
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UserError
from automotive_cosim.report import templates
from automotive_cosim.report.regression import as_json, changes, junit, markdown, plain
from automotive_cosim.run.executor import failed
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, PartsHeld
from automotive_cosim.run.store import opened

TASKS = ["road_speed_80_in_50", "hvac_fan_max", "hvac_cold_hands", "hvac_driver_seat_heater", "apps_pay_parking"]
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
    assert PLAN.jobs()[2].task in told.partition("**Lost")[2]
    assert "missing: goal" in told


def test_what_an_agent_raised_is_told_where_it_lost(tmp_path):
    raised = {"malformed": 20, "malformed_why": "agent 'mine' raised ZeroDivisionError: division by zero"}
    found = changes(write(tmp_path / "a"), write(tmp_path / "b", lost={1}, **raised))
    for told in (markdown(found, 0.0), junit(found)):
        assert "no action in 20 steps, at first: agent 'mine' raised ZeroDivisionError" in told


EVERY = "".join(map(chr, (*range(0x300), *range(0xD7F0, 0xD800), *range(0xDFFF, 0xE010), *range(0xFDC0, 0x10010))))
EVERY += "".join(map(chr, (*range(0x1FFF0, 0x20010), *range(0x10FFF0, 0x110000))))


def test_junit_and_pages_hold_only_characters_that_they_may(tmp_path, monkeypatch):
    raised = {"agent_error": "it raised OSError: \ufffe\uffff\x00\x1b[1m\ufdd0\U0001ffff ]]> \U0001f697&"}
    text = junit(changes(write(tmp_path / "a"), write(tmp_path / "b", lost={1}, **raised)))
    said = ElementTree.fromstring(text.encode())[0].find("testcase/error").get("message")
    assert "OSError: \ufffd\ufffd" in said
    assert "]]> \U0001f697&" in said
    monkeypatch.setattr(templates._ENVIRONMENT, "get_template", lambda name: Template("{{ text }}"))
    page = templates.render("any", text=EVERY)
    assert len(page) == len(EVERY)
    for code in map(ord, page):  # HTML, 13.2.3.5 and Infra: no controls, surrogates, noncharacters
        assert code in (9, 10, 13) or not (code < 0x20 or 0x7F <= code < 0xA0)
        assert not any((0xD800 <= code < 0xE000, 0xFDD0 <= code < 0xFDF0, code & 0xFFFE == 0xFFFE)), hex(code)
    assert {chr(code) for code in (0x7E, 0xA0, 0xFDCF, 0xFDF0, 0xFFFD, 0x1FFFD, 0x10FFFD)} <= set(page)


def test_an_agent_that_raises_in_every_step_is_an_error_of_junit_before_the_change_too(tmp_path):
    raised = {
        "steps": 20,
        "malformed": 20,
        "malformed_why": "agent 'mine' raised ZeroDivisionError: division by zero",
    }
    everything = set(range(len(PLAN.jobs())))
    broken = write(tmp_path / "a", lost=everything, **raised)
    once = {**raised, "malformed": 1}
    for folder, errors in ((broken, len(everything)), (write(tmp_path / "b", lost=everything, **once), 0)):
        suite = ElementTree.fromstring(junit(changes(folder, folder)))[0]
        assert int(suite.get("errors")) == errors == len(suite.findall("testcase/error"))
        assert all("ZeroDivisionError" in each.get("message") for each in suite.iter("error"))
    gone = write(tmp_path / "c", lost={1}, agent_error="it raised OSError: no such file")
    suite = ElementTree.fromstring(junit(changes(write(tmp_path / "d"), gone)))[0]
    assert (suite.get("failures"), suite.get("errors")) == ("0", "1")
    assert "OSError: no such file" in suite.find("testcase/error").get("message")


def test_the_headline_has_the_figures_of_the_comparison_it_prints(tmp_path):
    """An error before and another failure now leave the plan's rates alike, and what was judged both times fell."""
    found = changes(write(tmp_path / "a", errors={0}), write(tmp_path / "b", lost={1}))
    whole = len(PLAN.jobs())
    assert [rate.value for rate in found[0].rates] == [1 - 1 / whole] * 2
    assert found[0].outcome(0.0) == "worse"
    told = markdown(found, 0.0).splitlines()[0]
    assert f"success 100% before, {1 - 1 / (whole - 1):.0%} after" in told
    broken = changes(write(tmp_path / "c", lost={1}), write(tmp_path / "d", lost={1}, errors={1}))
    assert "1 is no longer judged" in markdown(broken, 0.0).splitlines()[0]


def test_the_summary_for_a_terminal_is_narrow_and_says_what_the_markdown_says(tmp_path):
    found = changes(write(tmp_path / "a", lost={1}), write(tmp_path / "b", lost={1, 2}))
    head, *lines = plain(found, 0.0).splitlines()
    assert markdown(found, 0.0).startswith(f"**{head}**")
    assert max(map(len, lines)) <= 80
    assert f"{len(PLAN.jobs()) - 1}/{len(PLAN.jobs())} before" in lines[1]
    assert [line for line in lines if PLAN.jobs()[2].task in line], "what was lost is named"


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
    halves = [number for number, job in enumerate(PLAN.jobs()) if job.pair and job.seed == 0]
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
    assert (tmp_path / "m.md").read_text() == markdown(changes(tmp_path / "a", tmp_path / "b"), 0.0)
    assert worse.output.splitlines()[0] == (tmp_path / "m.md").read_text().splitlines()[0].strip("*")
    assert "|" not in worse.output
    assert ElementTree.parse(tmp_path / "j.xml").getroot().tag == "testsuites"
    assert runner.invoke(app, ["compare", first, second, "--threshold", "60"]).exit_code == 0
    assert runner.invoke(app, ["compare", first, first]).exit_code == 0
    refused = runner.invoke(app, ["compare", first, second, "--threshold", "-1"])
    assert refused.exit_code == 2
    assert "'-1' is not a number from 0 to 100" in refused.output


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


DRIVES = make_plan({"agents": ["silent"], "drives": ["grid_june"], "seeds": list(range(6))})


def scored(folder, points, plan=DRIVES):
    """An evaluation of drives with one event each, whose costs give these scores; None has not been run."""
    from automotive_cosim.drives.judge import Judgement
    from automotive_cosim.drives.score import score

    empty = score(Judgement((), ()), 600.0)
    with opened(folder, plan.as_json(), DriveTrialRow) as store:
        for job, value in zip(sorted(plan.jobs(), key=lambda job: job.seed), points, strict=True):
            if value is not None:
                made = replace(empty, events=1, missed=1, worth=1.0, cost=1.0 - value / 50)
                assert made.value == pytest.approx(value)
                store.append(replace(job.planned(), score=made, value=made.value))
    return folder


def test_drives_are_compared_by_their_score_and_never_by_success(tmp_path):
    before, after = scored(tmp_path / "a", [0] * 6), scored(tmp_path / "b", [0, -533, 0, 0, 40, 0])
    (found,) = changes(before, after)
    assert found.unit == "drives"
    assert 100 * found.found.difference == pytest.approx((40 - 533) / 6)
    assert found.found.bounds.low < (40 - 533) / 6 < found.found.bounds.high
    assert (found.outcome(0.0), found.outcome(0.81)) == ("worse", "worse")
    assert found.outcome(0.83) == "not distinguishable"
    assert (found.count("lost"), found.count("won")) == (1, 1)
    told = markdown((found,), 0.0)
    assert told.startswith("**silent (negative control) is worse: score 0 before, −82 after, of 6 drives")
    assert "−533 after" in told.partition("**Lost")[2]
    assert "score 0 before, −533 after" in junit((found,))
    assert as_json((found,), 0.0)["contestants"][0]["score"] == pytest.approx([0, (40 - 533) / 6])
    alike = changes(before, before)
    assert "No agent is worse: score 0 before, 0 after, of 6 drives" in markdown(alike, 0.0)


def test_few_drives_have_no_interval(tmp_path):
    few = make_plan({"agents": ["silent"], "drives": ["grid_june"], "seeds": [0, 1]})
    (found,) = changes(scored(tmp_path / "a", [0, 0], few), scored(tmp_path / "b", [0, -10], few))
    assert found.found.bounds is None
    assert "-5 points |" in markdown((found,), 0.0)


def test_drives_are_told_with_their_score_and_its_interval(tmp_path):
    from automotive_cosim.report.answer import agents_as_json
    from automotive_cosim.report.results import read_results

    (told,) = agents_as_json(read_results(scored(tmp_path / "a", [100, 100, 100, 100, 100, -20])))
    assert (told["agent"], told["drives"], told["score"]) == ("silent", 6, pytest.approx(80))
    assert told["interval"][0] < 80 < told["interval"][1] <= 100


def test_a_share_of_the_score_is_asked_of_drives(tmp_path):
    from automotive_cosim.cli.evaluate import _short
    from automotive_cosim.report.results import read_results

    done = read_results(scored(tmp_path / "a", [100, 100, 100, 100, 100, -20]))
    assert _short(done, 0.8) == []
    assert "score 80, less than 90 of 100 points" in _short(done, 0.9)[0]
    stopped = read_results(scored(tmp_path / "b", [100, 100, 100, 100, 100, None]))
    assert _short(stopped, 0.8) == ["1 drive not run"]


def test_of_two_plans_only_what_both_have_is_compared_and_the_headline_says_so(tmp_path):
    part = make_plan({"agents": ["silent"], "drives": ["grid_june"], "seeds": [0, 1]})
    found = changes(scored(tmp_path / "a", [0, 0], part), scored(tmp_path / "b", [0, 0, -90, -90, -90, -90]))
    told = markdown(found, 0.0)
    assert "score 0 before, 0 after, of 2 drives that both planned (2 before, 6 after)" in told


def test_the_headline_says_that_an_evaluation_was_stopped_and_no_case_of_it_has_steps(tmp_path):
    found = changes(scored(tmp_path / "a", [0] * 6), scored(tmp_path / "b", [0, 0, 0, 0, 0, None]))
    assert "stopped early after, 1 of 6 not run" in markdown(found, 0.0).splitlines()[0]
    assert "it has not been run" in junit(found)
    assert "shows each step" not in junit(found)


def test_folders_of_drives_name_their_agents_when_they_share_none(tmp_path):
    other = make_plan({"agents": ["asurada", "t3a"], "drives": ["grid_june"], "seeds": [0]})
    with pytest.raises(UserError, match=r"b \(asurada.*; t3a.*\) have no agent in common"):
        changes(scored(tmp_path / "a", [0] * 6), scored(tmp_path / "b", [0, 0], other))


def test_a_file_that_cannot_be_written_is_named_itself(tmp_path):
    from automotive_cosim.formats.writing import write_whole

    with pytest.raises(FileNotFoundError) as found:
        write_whole(tmp_path / "none" / "x.xml", "x")
    assert found.value.filename == str(tmp_path / "none" / "x.xml")
