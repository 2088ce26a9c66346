"""A stopped evaluation says so everywhere, and its contestants stand side by side on what all of them ran."""

import re
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.main import app
from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.evaluation import all_tables, write_report
from automotive_cosim.report.regression import changes, markdown
from automotive_cosim.report.results import read_results, standings
from automotive_cosim.report.summary import main, progress, rate_of
from automotive_cosim.report.tables import Cell
from automotive_cosim.run.executor import failed
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow, PartsHeld
from automotive_cosim.run.store import opened

TASKS = ["hvac_fan_max", "phenomenon_front_window_fogged", "road_speed_80_in_50"]
PLAN = make_plan({"agents": ["asurada", "t3a", "always-alert"], "tasks": TASKS, "seeds": [0, 1]})
JOBS = PLAN.jobs()
WON = PartsHeld(goal=True, clean=True, safe=True, in_time=True, declared=True)


def write(folder, ran, errors=(), plan=PLAN, count=True):
    """An evaluation that has run the jobs with these numbers, and won all but those that ended in an error."""
    jobs = plan.jobs()
    with opened(folder, plan.as_json(), EpisodeRow, planned=len(jobs) if count else None) as store:
        for number in ran:
            if number in errors:
                store.append(failed(jobs[number], "WorkerDied", "gone"))
            else:
                store.append(replace(jobs[number].planned(), success=True, parts=WON))
    return folder


def invoke(*words):
    return CliRunner().invoke(app, list(map(str, words)))


@pytest.mark.parametrize("cut", range(len(JOBS) + 1))
def test_wherever_it_stops_everything_planned_is_accounted_for(tmp_path, cut):
    found = read_results(write(tmp_path / "e", range(cut), errors=range(0, cut, 5)))
    covered = found.coverage
    assert (covered.judged + covered.errors, covered.planned) == (cut, len(JOBS))
    assert covered.is_complete == (cut == len(JOBS))
    assert f"of {len(JOBS)} planned" in str(covered)
    assert ("not run" in str(covered)) == (cut < len(JOBS))
    assert len(found.contestants) == 3
    for each in found.contestants:
        rate = rate_of(found.planned_of(each))
        assert rate.planned == len(JOBS) // 3
        assert rate.value == (rate.successes / (rate.judged + rate.errors) if rate.judged else None)
    waiting = re.findall(r"episodes? \([^)]*?(\d+) not run", "\n".join(standings(found)))
    assert sum(map(int, waiting)) == len(JOBS) - cut


def test_a_rate_is_over_episodes_that_ran_with_what_was_not_judged_beside(tmp_path):
    mine = [number for number, job in enumerate(JOBS) if job.agent == "asurada"]
    assert len(mine) == 10
    found = read_results(write(tmp_path / "e", mine[:7], errors=mine[:1]))
    (row,) = (row for row in progress(found).rows if str(row[0]).startswith("asurada"))
    assert tuple(map(str, row[1:5])) == ("10", "6", "1", "3")
    assert re.fullmatch(r"86% \(\d+–\d+\), 6/7, 1 error, 3 not run", str(row[5]))
    (line,) = (line for line in standings(found) if line.startswith("asurada"))
    assert "6 of 7 episodes (1 error, 3 not run)" in line


@pytest.mark.parametrize("cut", range(1, len(JOBS)))
def test_contestants_stand_side_by_side_on_what_all_of_them_ran(tmp_path, cut):
    found = read_results(write(tmp_path / "e", range(cut), errors={0, 3}))
    instances = [{row.instance for row in found.shared().of(each)} for each in found.contestants]
    assert instances[0] == instances[1] == instances[2]
    assert len(instances[0]) == found.coverage.shared_instances
    ran = [{row.instance for row in found.of(each)} for each in found.contestants]
    assert instances[0] == ran[0] & ran[1] & ran[2]
    assert len((ran[0] | ran[1] | ran[2]) - instances[0]) <= 1
    overview, *others, last = all_tables(found, {})
    assert (overview.name, last.name) == ("progress", "errors")
    behind = {
        name
        for table in others
        for row in table.rows
        for cell in row
        if isinstance(cell, Cell)
        for name in cell.episodes
    }
    assert behind <= found.coverage.shared
    assert sum(int(str(row[4])) for row in overview.rows) == len(JOBS) - cut


def test_an_error_of_one_contestant_takes_no_instance_from_the_others(tmp_path):
    found = read_results(write(tmp_path / "e", range(len(JOBS)), errors=range(len(JOBS) // 3)))
    assert len(found.shared().rows) == len(found.rows) == len(JOBS)
    assert "errors" in str(main(found.shared()).rows)


@pytest.mark.slow
def test_the_page_the_terminal_and_the_other_commands_say_so(tmp_path):
    part, whole = write(tmp_path / "part", range(11)), write(tmp_path / "whole", range(len(JOBS)))
    told = f"11 of {len(JOBS)} planned episodes judged, {len(JOBS) - 11} not run"
    page = write_report(part).read_text(encoding="utf-8")
    assert told in page
    assert f"Incomplete: 11 of {len(JOBS)}" in page
    assert "No infrastructure errors" not in page
    assert "Incomplete" not in write_report(whole).read_text(encoding="utf-8")
    assert told in invoke("report", part).output
    assert told in invoke("publish", "regrade", part).output
    for before, after, outcome in ((part, part, "incomplete"), (part, whole, "incomplete"), (whole, part, "worse")):
        ran = invoke("compare", before, after)
        assert (ran.exit_code, "unchanged" in ran.output) == (1, False)
        assert outcome in ran.output
    assert "it has not been run" in invoke("compare", whole, part).output
    assert invoke("compare", whole, whole).exit_code == 0


def test_a_fall_in_a_stopped_evaluation_is_worse_not_merely_incomplete(tmp_path):
    before = write(tmp_path / "a", range(11))
    after = write(tmp_path / "b", range(11), errors={4})
    assert {each.outcome(0.0) for each in changes(before, after)} >= {"worse", "incomplete"}


def test_where_nothing_was_judged_nothing_has_become_worse(tmp_path):
    nothing = write(tmp_path / "a", ())
    assert {each.outcome(0.0) for each in changes(nothing, nothing)} == {"incomplete"}


def test_a_contestant_without_an_episode_yet_is_shown(tmp_path):
    mine = [number for number, job in enumerate(JOBS) if job.agent == "asurada"]
    found = read_results(write(tmp_path / "e", mine))
    assert {each.agent for each in found.contestants} == {"asurada", "t3a", "always-alert"}
    assert not found.shared().rows
    page = write_report(tmp_path / "e").read_text(encoding="utf-8")
    assert "on the 0 episodes that all of them have run" in page
    assert any(
        line.startswith("t3a") and f"0 of 0 episodes ({len(JOBS) // 3} not run)" in line
        for line in standings(found)
    )


@pytest.mark.slow
def test_a_catalogue_that_has_changed_since_invents_no_episodes(tmp_path, monkeypatch):
    whole = write(tmp_path / "whole", range(len(JOBS)))
    part = write(tmp_path / "part", range(9))
    older = write(tmp_path / "older", range(9), count=False)
    monkeypatch.setattr(type(PLAN), "jobs", lambda self: JOBS[:-2])
    assert read_results(whole).coverage.is_complete
    assert f"had {len(JOBS)} episodes and has {len(JOBS) - 2}" in str(read_results(part).coverage)
    assert "Incomplete</span>" in write_report(part).read_text(encoding="utf-8")
    assert "incomplete" in markdown(changes(part, part), 0.0)
    assert read_results(older).coverage.planned == len(JOBS) - 2
    monkeypatch.setattr(type(PLAN), "jobs", lambda self: JOBS[:5])
    assert "4 episodes not in the plan" in str(read_results(older).coverage)


PLANTED = {"tables": 2, "plots": 2, ".report.html.lock": 2, "report.html": 0, ".report.html.part": 0}
"""Links in somebody else's folder, and the exit code of a report on it."""


@pytest.mark.parametrize("name", PLANTED)
def test_a_report_on_somebody_elses_folder_writes_through_no_link(tmp_path, name, cli):
    folder = write(tmp_path / "e", range(len(JOBS)))
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "diary.txt").write_text("private")
    (folder / name).symlink_to(outside if name in ("tables", "plots") else outside / "diary.txt")
    done = cli("report", folder)
    assert done.code == PLANTED[name]
    if done.code:
        assert done.err.count("\n") == 1
        assert f"{name} is a link, and nothing here goes through one" in done.err
    assert {path.name: path.read_text() for path in outside.iterdir()} == {"diary.txt": "private"}


def test_of_two_reports_on_one_folder_one_is_refused(tmp_path, cli):
    folder = write(tmp_path / "e", range(3))
    with drafted(folder / "report.html") as other:
        done = cli("report", folder)
        other.write(b"the other one's")
    assert done.code == 2
    assert re.fullmatch(r".*another program is writing \S+report.html; wait.*\n", done.err)
    assert (folder / "report.html").read_text() == "the other one's"
    assert not (folder / "tables").exists()
