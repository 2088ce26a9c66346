"""Evaluations of drives: the plan, the rows, resuming, and the report."""

import json
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.main import app
from automotive_cosim.contracts.given import Clock
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.score import together
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UserError
from automotive_cosim.report.drives import LEAST_DRIVES, grouped, interval, tables, told, write_drives
from automotive_cosim.run.batch import Progress
from automotive_cosim.run.drive_recorder import DriveRecorder
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.rewatch import compare, rewatch, watched
from automotive_cosim.run.road import read_road
from automotive_cosim.run.row import as_json, from_json, steady
from automotive_cosim.run.store import read_rows, read_trace
from automotive_cosim.run.watch import WatchSetup, run_watch
from automotive_cosim.run.watch_row import WatchRow
from automotive_cosim.run.watches import families_named, make_watch_plan, run_watch_plan
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
        ({"drives": [], "agents": ["silent"]}, "drives"),
        ({"drives": ["all"], "agents": ["human"]}, "human"),
        ({"drives": ["all"], "agents": ["rule-perfct"]}, "rule-perfect"),
        ({"drives": ["all"], "agents": ["silent"], "latency": [-1.0]}, "latency"),
    ],
)
def test_a_wrong_plan_is_refused_by_name(values: dict[str, object], named: str) -> None:
    with pytest.raises(UserError, match=named):
        make_watch_plan(values).check()


def test_every_drive_has_its_own_id_and_is_run_with_others_of_its_traffic() -> None:
    plan = make_watch_plan(
        {"drives": ["grid"], "agents": ["silent", "asurada"], "seeds": [0, 1], "latency": [0.0, 3.0], "repeats": 2}
    )
    jobs = plan.jobs()
    assert len(jobs) == len({job.id for job in jobs}) == 2 * 2 * 2 * 2 * 2
    order = [job.simulation for job in jobs]
    assert len([1 for before, now in pairwise(order) if before != now]) == len(set(order)) - 1


def test_drives_take_nothing_that_belongs_to_tasks() -> None:
    given = ["eval", "--drives", "all", "--agents", "silent", "--tasks", "hvac_fan_max"]
    result = CliRunner().invoke(app, given)
    assert isinstance(result.exception, UserError)
    assert "tasks" in str(result.exception)


# --- on a drive ----------------------------------------------------------------------------------------------

PLAN = {"drives": ["grid_january"], "agents": ["rule-perfect", "silent"], "seeds": [4]}


@pytest.fixture(scope="module")
def folder(sumo: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An evaluation of one drive by two watchers."""
    made = tmp_path_factory.mktemp("drives") / "made"
    end = run_watch_plan(make_watch_plan(PLAN), made, executor=Processes(1), retries=0)
    assert (end.judged, end.errors) == (2, 0)
    return made


def rows_of(folder: Path) -> dict[str, WatchRow]:
    return {row.agent: row for row in read_rows(folder, WatchRow).values()}


@pytest.mark.slow
def test_rows_tell_who_watched_better_and_are_read_back(folder: Path) -> None:
    rows = rows_of(folder)
    perfect, silent = rows["rule-perfect"], rows["silent"]
    assert perfect.value is not None
    assert silent.value == 0.0
    assert perfect.value > 60.0
    assert silent.harm == silent.baseline_harm
    assert perfect.baseline_harm == silent.harm
    assert from_json(WatchRow, json.loads(json.dumps(as_json(perfect)))) == perfect


@pytest.mark.slow
def test_a_finished_drive_is_not_run_again(folder: Path) -> None:
    before = (folder / "episodes.jsonl").read_bytes()
    end = run_watch_plan(make_watch_plan(PLAN), folder, executor=Processes(1), retries=0)
    assert (end.ran, end.done) == (0, 2)
    assert (folder / "episodes.jsonl").read_bytes() == before


@pytest.mark.slow
def test_what_is_left_when_a_run_is_broken_off_is_made_up_for(folder: Path, tmp_path: Path) -> None:
    """And the same plan gives the same rows."""

    def break_off(progress: Progress[WatchRow]) -> None:
        if progress.done == 1:
            raise KeyboardInterrupt

    wanted = make_watch_plan(PLAN)
    with pytest.raises(KeyboardInterrupt):
        run_watch_plan(wanted, tmp_path / "e", executor=Processes(1), retries=0, tell=break_off)
    assert len(read_rows(tmp_path / "e", WatchRow)) == 1
    end = run_watch_plan(wanted, tmp_path / "e", executor=Processes(1), retries=0)
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
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks at /proc")
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
            "--latency", "0,3", "--workers", "1", "--out", out, cwd=tmp_path, stdout=subprocess.DEVNULL,
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
    assert all(row.events for row in read_rows(tmp_path / "whole", WatchRow).values())
    rows, again = (read_rows(tmp_path / name, WatchRow) for name in ("whole", "killed"))
    assert {id_: steady(row) for id_, row in again.items()} == {id_: steady(row) for id_, row in rows.items()}
    assert len({row.trace_sha256 for row in rows.values()}) == 2
    for part in ("traces", "timelines"):
        files, others = (
            {path.name: path.read_bytes() for path in (tmp_path / name / part).iterdir()}
            for name in ("whole", "killed")
        )
        assert len(files) == 2
        assert others == files


@pytest.mark.slow
def test_a_replay_gives_the_same_trace_and_says_what_differs(folder: Path, tmp_path: Path) -> None:
    row = rows_of(folder)["rule-perfect"]
    replayed = CliRunner().invoke(app, ["replay", str(folder), row.id])
    assert replayed.exit_code == 0, replayed.output
    assert f"all {row.steps + 1} steps are the same" in replayed.output
    steps = read_trace(folder, row.id)
    quiet = [step | {"action": {"action_type": "wait", "seconds": 1}} if step["action"] else step for step in steps]
    different = compare(steps, watched(row, quiet).steps)
    assert "action" in next(step for step in different if step.differs).differs
    with pytest.raises(UserError, match="no drive in"):
        rewatch(folder, "grid_december")


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

    setup = WatchSetup("grid_june", 1, "slow", conditions=Conditions(clock=Clock.MODEL, latency_s=0.5))
    agent = Slow()
    with (
        closing(Simulations()) as simulations,
        closing(DriveRecorder(tmp_path / "drive", setup, agent)) as recorder,
    ):
        first = run_watch("slow", setup, agent, simulations=simulations, watchers=(recorder,))
        again = watched(first.row, first.steps, simulations)
    assert len({step["thought_s"] for step in first.steps}) > 2
    assert not [step for step in compare(first.steps, again.steps) if step.differs]
    assert again.row.trace_sha256 == first.row.trace_sha256
    assert (again.row.events, again.row.acts, again.row.score) == (
        first.row.events,
        first.row.acts,
        first.row.score,
    )
    lines = list(read_road(tmp_path / "drive" / "road.jsonl.gz"))
    road = [line for line in lines if "at_s" in line]
    assert lines[-1]["baseline"]
    assert [round(line["at_s"], 1) for line in road] == first.timeline["time_s"][1:]
    assert [line["speed_kmh"] for line in road] == first.timeline["speed_kmh"][1:]
    shown = (tmp_path / "drive" / "shown.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["number"] for line in shown] == list(range(len(first.steps)))


@pytest.mark.sumo
@pytest.mark.slow
def test_one_command_gives_the_scores_at_fixed_latencies(tmp_path: Path) -> None:
    values = PLAN | {"agents": ["rule-perfect"]}
    jobs = make_watch_plan(values | {"latency": [0, 1, 3, 10]}).jobs()
    assert {job.setup.conditions.latency_s for job in jobs} == {0, 1, 3, 10}
    two = make_watch_plan(values | {"latency": [0, 10]})
    assert run_watch_plan(two, tmp_path / "e", executor=Processes(1), retries=0).judged == 2
    rows = read_rows(tmp_path / "e", WatchRow).values()
    scores = {each.conditions.latency_s: mine[0].value for each, mine in grouped(rows).items()}
    assert scores[10.0] < scores[0.0]  # type: ignore[operator]
    assert "latency 10 s" in write_drives(tmp_path / "e").read_text("utf-8")


@pytest.mark.slow
def test_the_report_has_a_timeline_of_each_drive(folder: Path) -> None:
    page = write_drives(folder).read_text("utf-8")
    rows = rows_of(folder)
    assert {path.stem for path in (folder / "plots").iterdir()} == {row.id for row in rows.values()}
    assert "rule-perfect" in page
    assert page.count("<svg ") == 2 * len(rows)
    assert (folder / "tables" / "watchers.csv").read_text("utf-8").startswith("Watcher,Drives,Hours,Score")


@pytest.mark.slow
def test_intervals_come_from_whole_drives(folder: Path) -> None:
    perfect, silent = (rows_of(folder)[name] for name in ("rule-perfect", "silent"))

    def value(rows: list[WatchRow]) -> float:
        return together([row.score for row in rows if row.score is not None]).value

    few = [replace(perfect, id=str(number), seed=number) for number in range(LEAST_DRIVES - 1)]
    assert interval(few, value) is None  # type: ignore[arg-type]
    assert told(few, value, ".0f") == f"{value(few):.0f}"  # type: ignore[arg-type]
    mixed = [replace(row, seed=number) for number, row in enumerate([perfect, silent] * LEAST_DRIVES)]
    bounds = interval(mixed, value)  # type: ignore[arg-type]
    assert bounds is not None
    assert bounds.low < value(mixed) < bounds.high
    repeated = [replace(row, repeat=number) for number, row in enumerate([perfect, silent] * LEAST_DRIVES)]
    assert interval(repeated, value) is None  # type: ignore[arg-type]
    assert [table.name for table in tables(mixed)] == ["watchers", "kinds", "families"]
    assert len(grouped(mixed)) == 2
