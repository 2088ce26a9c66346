"""Evaluations of drives: the plan, the rows, resuming, and the report."""

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from math import inf
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from automotive_cosim.agents import make_agent
from automotive_cosim.cli.main import app
from automotive_cosim.contracts.given import Clock
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.score import together
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import UserError
from automotive_cosim.publish.bundle import write_bundle
from automotive_cosim.publish.leaderboard import write_leaderboard
from automotive_cosim.publish.verify import verify
from automotive_cosim.report.drives import grouped, interval, tables, told
from automotive_cosim.report.evaluation import write_report
from automotive_cosim.report.regression import changes
from automotive_cosim.report.stats import LEAST_CLUSTERS
from automotive_cosim.run.attribution import attribute
from automotive_cosim.run.batch import Progress, run_plan
from automotive_cosim.run.coverage import unit_of
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.job_row import as_json, from_json, steady
from automotive_cosim.run.plan import families_named, make_plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.regrade import regrade
from automotive_cosim.run.rerun import Recorded, compare, played, rerun
from automotive_cosim.run.road import read_road
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.run.store import read_rows, read_trace
from automotive_cosim.run.trial import run_trial
from automotive_cosim.run.trial_folder import read_steps, read_trial
from automotive_cosim.traffic.fork import Simulations


def test_families_are_named_by_id_pattern_scenario_or_season() -> None:
    assert families_named(("grid_june",)) == ("grid_june",)
    assert set(families_named(("grid_*",))) == set(families_named(("grid",)))
    assert set(families_named(("summer", "winter"))) == set(families_named(("all",))) == set(FAMILIES)


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"drives": ["grid_jun"], "agents": ["silent"]}, "grid_june"),
        ({"drives": ["all"]}, "--agents"),
        ({"drives": ["all"], "agents": ["human"]}, "human"),
        ({"drives": ["all"], "agents": ["rule-perfct"]}, "rule-perfect"),
        ({"drives": ["all"], "agents": ["silent"], "latency_s": [-1.0]}, "latency"),
    ],
)
def test_a_wrong_plan_is_refused_by_name(values: dict[str, object], named: str) -> None:
    with pytest.raises(UserError, match=named):
        make_plan(values).check()


def test_every_drive_has_its_own_id_and_is_run_with_others_of_its_traffic() -> None:
    plan = make_plan(
        {
            "drives": ["grid"],
            "agents": ["silent", "asurada"],
            "seeds": [0, 1],
            "latency_s": [0.0, 3.0],
            "repeats": 2,
        }
    )
    jobs = plan.jobs()
    assert len(jobs) == len({job.id for job in jobs}) == 2 * 2 * 2 * 2 * 2
    order = [job.simulation for job in jobs]
    assert len([1 for before, now in pairwise(order) if before != now]) == len(set(order)) - 1


def test_tasks_and_drives_are_planned_together_and_apart() -> None:
    tasks, drives = (
        {"tasks": ["hvac_fan_max"], "agents": ["silent"]},
        {"drives": ["grid_june"], "agents": ["silent"]},
    )
    both = {job.id for job in make_plan(tasks | drives).jobs()}
    apart = [{job.id for job in make_plan(values).jobs()} for values in (tasks, drives)]
    assert both == set.union(*apart)
    assert list(map(len, apart)) == [1, 1]
    plans = map(make_plan, (tasks, drives, tasks | drives))
    assert [unit_of(plan.as_json()) for plan in plans] == ["episode", "drive", "run"]


def test_a_drive_belongs_to_the_set_of_its_seed() -> None:
    values = {"drives": ["grid_june"], "agents": ["silent"], "seeds": list(range(40))}
    whole, dev, test = (
        {job.seed for job in make_plan(values | {"split": split}).jobs()} for split in ("both", "dev", "test")
    )
    assert dev | test == whole
    assert dev
    assert test
    assert not dev & test


# --- on a drive ----------------------------------------------------------------------------------------------

PLAN = {"drives": ["grid_january"], "agents": ["rule-perfect", "silent"], "seeds": [0], "settings": {"minutes": 2}}


@pytest.fixture(scope="module")
def folder(sumo: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An evaluation of one drive by two watchers."""
    made = tmp_path_factory.mktemp("drives") / "made"
    end = run_plan(make_plan(PLAN), made, executor=Processes(1), retries=0)
    assert (end.judged, end.errors) == (2, 0)
    return made


def rows_of(folder: Path) -> dict[str, DriveTrialRow]:
    return {row.agent: row for row in read_rows(folder, DriveTrialRow).values()}


@pytest.mark.slow
def test_rows_tell_who_watched_better_and_are_read_back(folder: Path) -> None:
    rows = rows_of(folder)
    perfect, silent = rows["rule-perfect"], rows["silent"]
    assert perfect.value is not None
    assert silent.value == 0.0
    assert perfect.value > 60.0
    assert silent.harm == silent.baseline_harm
    assert perfect.baseline_harm == silent.harm
    assert from_json(DriveTrialRow, json.loads(json.dumps(as_json(perfect)))) == perfect


@pytest.mark.slow
def test_a_finished_drive_is_not_run_again(folder: Path) -> None:
    before = (folder / "episodes.jsonl").read_bytes()
    end = run_plan(make_plan(PLAN), folder, executor=Processes(1), retries=0)
    assert (end.ran, end.done) == (0, 2)
    assert (folder / "episodes.jsonl").read_bytes() == before


@pytest.mark.slow
def test_what_is_left_when_a_run_is_broken_off_is_made_up_for(folder: Path, tmp_path: Path) -> None:
    """And the same plan gives the same rows."""

    def break_off(progress: Progress[DriveTrialRow]) -> None:
        if progress.done == 1:
            raise KeyboardInterrupt

    wanted = make_plan(PLAN)
    with pytest.raises(KeyboardInterrupt):
        run_plan(wanted, tmp_path / "e", executor=Processes(1), retries=0, tell=break_off)
    assert len(read_rows(tmp_path / "e", DriveTrialRow)) == 1
    end = run_plan(wanted, tmp_path / "e", executor=Processes(1), retries=0)
    assert (end.ran, end.done) == (1, 2)
    assert {name: steady(row) for name, row in rows_of(tmp_path / "e").items()} == {
        name: steady(row) for name, row in rows_of(folder).items()
    }


EVALUATES = """
from dataclasses import replace
from types import SimpleNamespace
from automotive_cosim.cli.main import main
from automotive_cosim.drives.families import FAMILIES

family = FAMILIES["grid_june"]
shorter = replace(family.draw(1), duration_s=80.0)
FAMILIES["grid_june"] = SimpleNamespace(
    id=family.id, scenario=family.scenario, season=family.season, draw=lambda seed: shorter
)
if __name__ == "__main__":
    main()
"""
"""The command line, with a short drive: its workers import this file as well."""
MARKS = """
from pathlib import Path
from automotive_cosim.drives.watchers import RulePerfect

class Marks(RulePerfect):
    def reset(self, goal):
        super().reset(goal)
        self.begins = True

    def act(self, observation):
        with Path(__file__).with_name("marks").open("a") as file:
            file.write("drive act\\n" if self.begins else "act\\n")
        self.begins = False
        return super().act(observation)
"""


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.long
@pytest.mark.proof
def test_an_evaluation_killed_in_the_middle_of_a_drive_resumes_to_the_same_rows_and_traces(
    program: Callable[..., subprocess.Popen[str]],
    until: Callable[[Callable[[], object]], None],
    session: Callable[[int], list[str]],
    tmp_path: Path,
) -> None:
    """Killed, a program can write nothing more; the drive that it was in is made anew, the finished one is kept."""
    (tmp_path / "evaluates.py").write_text(EVALUATES)
    (tmp_path / "marked.py").write_text(MARKS)
    (tmp_path / "marks").touch()

    def begin(out: str) -> subprocess.Popen[str]:
        return program(
            sys.executable, "evaluates.py", "eval", "--drives", "grid_june", "--agents", "marked:Marks",
            "--latency", "0,3", "--workers", "1", "--pictures", "none", "--out", out,
            cwd=tmp_path, stdout=subprocess.DEVNULL,
        )  # fmt: skip

    def acts() -> list[int]:
        """How often the agent acted on each drive that it began."""
        return [drive.count("act") for drive in (tmp_path / "marks").read_text().split("drive")[1:]]

    def lines() -> bytes:
        path = tmp_path / "killed" / "episodes.jsonl"
        return path.read_bytes() if path.is_file() else b""

    assert begin("whole").wait(300) == 0
    whole = acts()
    assert len(whole) == 2
    process = begin("killed")
    until(lambda: len(acts()) == 4 and acts()[3] >= whole[1] // 2)
    process.kill()
    process.wait()
    kept = lines()
    assert kept.count(b"\n") == 1, "the second drive was over already"
    until(lambda: not session(process.pid))
    assert begin("killed").wait(300) == 0
    assert acts() == [*whole, whole[0], acts()[3], whole[1]], "the finished drive was made again"
    assert acts()[3] < whole[1]
    assert lines().startswith(kept)
    assert all(row.events for row in read_rows(tmp_path / "whole", DriveTrialRow).values())
    rows, again = (read_rows(tmp_path / name, DriveTrialRow) for name in ("whole", "killed"))
    assert {id_: steady(row) for id_, row in again.items()} == {id_: steady(row) for id_, row in rows.items()}
    assert len({row.trace_sha256 for row in rows.values()}) == 2
    for part in ("traces",):
        files, others = (
            {path.name: path.read_bytes() for path in (tmp_path / name / part).iterdir()}
            for name in ("whole", "killed")
        )
        assert len(files) == 4
        assert others == files


@pytest.mark.slow
def test_a_replay_gives_the_same_trace_and_says_what_differs(folder: Path, tmp_path: Path) -> None:
    row = rows_of(folder)["rule-perfect"]
    replayed = CliRunner().invoke(app, ["replay", str(folder), row.id])
    assert replayed.exit_code == 0, replayed.output
    assert f"all {row.steps + 1} steps are the same" in replayed.output
    *steps, _ = read_trace(folder, row.id)
    job = DriveSetup(row.family, row.seed, settings=row.settings, agent=row.agent, model=row.model)
    quiet = [step | {"action": {"action_type": "wait", "seconds": 1}} if step["action"] else step for step in steps]
    different = compare(steps, played(Recorded(job, quiet, frozenset(row.channels)))[1].lines[:-1])
    assert "action" in next(step for step in different if step.differs).differs
    with pytest.raises(UserError, match="no drive in"):
        rerun(folder, "grid_december")


@pytest.mark.slow
def test_a_drive_by_the_models_clock_is_repeated_exactly_and_recording_changes_nothing(
    sumo: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    family = FAMILIES["grid_june"]
    shorter = replace(family.draw(1), duration_s=110.0)
    drawn = SimpleNamespace(id=family.id, scenario=family.scenario, season=family.season, draw=lambda seed: shorter)
    monkeypatch.setitem(FAMILIES, family.id, drawn)  # type: ignore[call-overload]

    class Slow(RulePerfect):
        """Takes another time for each answer, as a model does."""

        @property
        def answer_s(self) -> float:
            return 0.4 + 1.7 * (len(self._told) % 4)

    setup = DriveSetup("grid_june", 1, Conditions(clock=Clock.MODEL, latency_s=0.5), agent="slow")
    agent = Slow()
    with (
        closing(Simulations()) as simulations,
        closing(Recorder(setup, tmp_path / "drive")) as recorder,
        closing(RoadRecorder(tmp_path / "drive", setup.about)) as road_recorder,
    ):
        first = run_trial(setup, agent, (recorder, road_recorder), simulations=simulations)
        assert isinstance(first, DriveTrialRow)
        *steps, last = recorder.lines
        again, kept = played(Recorded(setup, steps, frozenset(first.channels)), simulations=simulations)
    assert len({step["thought_s"] for step in steps}) > 2
    assert not [step for step in compare(steps, kept.lines[:-1]) if step.differs]
    assert isinstance(again, DriveTrialRow)
    assert again.trace_sha256 == first.trace_sha256
    assert (again.events, again.acts, again.score) == (first.events, first.acts, first.score)
    timeline = last["result"]["timeline"]
    lines = list(read_road(tmp_path / "drive" / "road.jsonl.gz"))
    road = [line for line in lines if "at_s" in line]
    assert lines[-1]["baseline"]
    assert [round(line["at_s"], 1) for line in road] == timeline["time_s"][1:]
    assert [line["speed_kmh"] for line in road] == timeline["speed_kmh"][1:]
    recorded = read_steps(tmp_path / "drive")
    assert [path.name for path in (tmp_path / "drive").glob("steps*")] == ["steps.jsonl.gz"]
    for name in ("step", "action", "thought_s", "feedback", "sha256"):
        assert [line[name] for line in recorded] == [step[name] for step in steps]
    waits = [
        (line["words"], round(line["at_s"] - before["at_s"]))
        for before, line in pairwise(recorded)
        if line["action"] and line["action"]["action_type"] == "wait"
    ]
    assert waits
    assert all(abs(int(words.split()[1]) - passed_s) <= 1 for words, passed_s in waits), (
        "what passed, not what was asked"
    )
    told = read_trial(tmp_path / "drive")
    assert told["row"] == as_json(first)
    assert told["result"] == {"timeline": timeline}


@pytest.mark.sumo
@pytest.mark.slow
def test_one_command_gives_the_scores_at_fixed_latencies(tmp_path: Path) -> None:
    values = PLAN | {"agents": ["rule-perfect"]}
    jobs = make_plan(values | {"latency_s": [0, 1, 3, 10]}).jobs()
    assert {job.conditions.latency_s for job in jobs} == {0, 1, 3, 10}
    two = make_plan(values | {"latency_s": [0, 10]})
    assert run_plan(two, tmp_path / "e", executor=Processes(1), retries=0).judged == 2
    rows = read_rows(tmp_path / "e", DriveTrialRow).values()
    scores = {each.conditions.latency_s: mine[0].value for each, mine in grouped(rows).items()}
    assert scores[10.0] < scores[0.0]  # type: ignore[operator]
    assert "latency 10 s" in write_report(tmp_path / "e").read_text("utf-8")


@pytest.mark.slow
def test_drives_are_graded_again_compared_bundled_verified_and_ranked(folder: Path, tmp_path: Path) -> None:
    assert [each.differs for each in regrade(folder)] == [False, False]
    assert not [each.problem for each in regrade(folder) if each.problem]
    found = changes(folder, folder)
    assert {(each.unit, each.outcome(0.0)) for each in found} == {("drives", "unchanged")}
    (tmp_path / "bundles").mkdir()
    contents = write_bundle(folder, tmp_path / "bundles" / "drives.zip")
    assert contents.counts.judged == 2
    checked = verify(tmp_path / "bundles" / "drives.zip", replays=1)
    assert checked.problems == ()
    assert write_leaderboard(tmp_path / "bundles", tmp_path / "page.html") == []
    page = (tmp_path / "page.html").read_text("utf-8")
    assert page.index("rule-perfect") < page.index("silent")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"value": 100.0}, "value"),
        ({"seed": 5}, "seed"),
        ({"waits": 1}, "waits"),
        ({"distraction_s": 900.0}, "distraction_s"),
        ({"end": "declared"}, "end"),
    ],
)
def test_a_changed_row_of_a_drive_is_found(
    folder: Path, tmp_path: Path, changed: dict[str, object], named: str
) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    path = copy / "episodes.jsonl"
    first, *others = path.read_text("utf-8").splitlines()
    path.write_text("\n".join([json.dumps(json.loads(first) | changed), *others]) + "\n", "utf-8")
    assert any(named in problem.field for problem in verify(copy).problems)


@pytest.mark.slow
def test_the_report_has_a_timeline_of_each_drive(folder: Path) -> None:
    page = write_report(folder).read_text("utf-8")
    rows = rows_of(folder)
    assert {path.stem for path in (folder / "plots").iterdir()} == {row.id for row in rows.values()}
    assert "rule-perfect" in page
    assert page.count("<svg ") == 2 * len(rows)
    assert (folder / "tables" / "watchers.csv").read_text("utf-8").startswith("Watcher,Drives,Hours,Score")


@pytest.mark.slow
def test_intervals_come_from_whole_drives(folder: Path) -> None:
    perfect, silent = (rows_of(folder)[name] for name in ("rule-perfect", "silent"))

    def value(rows: list[DriveTrialRow]) -> float:
        return together([row.score for row in rows if row.score is not None]).value

    few = [replace(perfect, id=str(number), seed=number) for number in range(LEAST_CLUSTERS - 1)]
    assert interval(few, value) is None  # type: ignore[arg-type]
    assert told(few, value, ".0f") == f"{value(few):.0f}"  # type: ignore[arg-type]
    mixed = [replace(row, seed=number) for number, row in enumerate([perfect, silent] * LEAST_CLUSTERS)]
    bounds = interval(mixed, value)  # type: ignore[arg-type]
    assert bounds is not None
    assert bounds.low < value(mixed) < bounds.high
    repeated = [replace(row, repeat=number) for number, row in enumerate([perfect, silent] * LEAST_CLUSTERS)]
    assert interval(repeated, value) is None  # type: ignore[arg-type]
    names = ["watchers", "faults", "acts", "kinds", "families", "effects", "measures", "exposure"]
    assert [table.name for table in tables(mixed, folder)] == names
    assert len(grouped(mixed)) == 2


@pytest.mark.slow
def test_the_effects_of_a_drive_of_an_evaluation_are_in_its_report(folder: Path, simulations: Simulations) -> None:
    rows = rows_of(folder)
    perfect, silent = rows["rule-perfect"], rows["silent"]
    effects = attribute(folder, perfect.id, simulations=simulations)
    assert [each.at_s for each in effects if len(each.steps) == 1] == [act.time_s for act in perfect.acts]
    assert all(each.points is not None for each in effects if each.steps)
    missed = [each.effect for each in attribute(folder, silent.id, simulations=simulations)]
    assert silent.score is not None
    assert len(missed) == silent.score.missed
    assert all(effect.startswith("missed ") for effect in missed)
    found = next(table for table in tables([perfect, silent], folder) if table.name == "act_effects")
    assert len(found.rows) == len(effects) + len(missed) > 0


@pytest.mark.parametrize(("limits", "steps"), [({"drive_steps": 2}, 2), ({"drive_model_s": 9.0}, 100_000)])
def test_a_drive_has_limits_of_its_own(limits: dict[str, float], steps: int) -> None:
    values = {"drives": ["grid_june"], "tasks": ["hvac_fan_max"], "agents": ["silent"], "limits": limits}
    drive, episode = sorted(make_plan(values).jobs(), key=lambda job: isinstance(job, EpisodeSetup))
    assert drive.limits == episode.limits.of_drives
    assert episode.max_steps == 20
    assert drive.limits.model_s == limits.get("drive_model_s", 14_400.0)
    assert drive.max_steps == steps


def test_the_rest_of_a_drive_is_unwatched_once_a_limit_is_reached(simulations: Simulations) -> None:
    for most_steps, wall_s, end, from_s in (
        (2, inf, End.OUT_OF_STEPS, 11.0),
        (100, 0.0, End.OUT_OF_BUDGET, 0.0),
        (100, inf, End.MINUTES_OVER, None),
    ):
        settings = DriveSettings(minutes=0.5)
        setup = DriveSetup("grid_june", 3, settings=settings, max_steps=most_steps, agent="alert-often")
        agent = make_agent("alert-often")
        recorder = Recorder(setup, None)
        row = run_trial(setup, agent, (recorder,), simulations=simulations, wall_s=wall_s)
        assert isinstance(row, DriveTrialRow)
        score = row.score
        assert (row.end, row.unwatched_from_s) == (end, from_s)
        assert score is not None
        assert score.driven_s == pytest.approx(30.0)
        assert recorder.lines[-1]["result"]["timeline"]["watched_until_s"] == from_s
