"""Drives of several cars in one traffic: each has a row, and what fails in one is that car's."""

import gzip
import json
import shutil
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from automotive_cosim.agents import make_agent
from automotive_cosim.cli.main import app
from automotive_cosim.contracts import Action, Observation
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import AgentError, ModelError, UserError
from automotive_cosim.formats.layout import PICTURES
from automotive_cosim.publish.verify import verify
from automotive_cosim.report.drives import shown_car
from automotive_cosim.report.evaluation import write_report
from automotive_cosim.report.results import load_results, read_results
from automotive_cosim.run.attribution import attribute
from automotive_cosim.run.batch import run_plan
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.fleet import record_of, run_fleet
from automotive_cosim.run.fleet_record import read_fleet
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.job_row import as_json, steady
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.regrade import regrade
from automotive_cosim.run.rerun import rerun
from automotive_cosim.run.rows import DriveTrialRow, FleetRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.store import read_rows, read_trace, write_trace
from automotive_cosim.run.trial import TrialRun, run_trial
from automotive_cosim.run.worker import run_job
from automotive_cosim.serve.content import Content
from automotive_cosim.serve.records import NotHereError, RecordFolders
from automotive_cosim.traffic.fork import Simulations
from tests.here import Here

pytestmark = pytest.mark.sumo

SHORT = DriveSettings(minutes=0.4)


def fleet_of(cars: int | None, agent: str = "rule-perfect", family: str = "grid_june") -> DriveSetup:
    return DriveSetup(family, 2, agent=agent, settings=replace(SHORT, cars=cars))


class Failing(RulePerfect):
    """An agent that fails as it is told to at its third answer."""

    def __init__(self, error: Exception) -> None:
        super().__init__()
        self.left, self.error = 2, error

    def act(self, observation: Observation) -> Action:
        self.left -= 1
        if self.left < 0:
            raise self.error
        return super().act(observation)


@pytest.mark.parametrize("family", ["grid_june", "london_november", "gulf_july"])
@pytest.mark.parametrize("agent", ["rule-perfect", "alert-often"])
def test_a_fleet_of_one_is_todays_drive(simulations: Simulations, family: str, agent: str) -> None:
    alone, one = (fleet_of(cars, agent, family) for cars in (None, 1))
    mine = run_trial(alone, make_agent(agent), simulations=simulations)
    (ours,) = run_fleet(one.cars, [TrialRun(one, make_agent(agent))], simulations)
    changed = {"id": ours.id, "settings": one.settings}
    assert mine.trace_sha256
    assert steady(replace(mine, **changed)) == steady(ours)


def test_what_fails_in_one_car_is_that_cars(simulations: Simulations) -> None:
    setup = fleet_of(4)
    agents = [RulePerfect(), Failing(AgentError("a fault")), Failing(ModelError("no answer")), RulePerfect()]
    runs = [TrialRun(car, agent) for car, agent in zip(setup.cars, agents, strict=True)]
    rows = run_fleet(setup.cars, runs, simulations)
    assert [row.end for row in rows] == [End.MINUTES_OVER, End.AGENT_FAILED, End.ERROR, End.MINUTES_OVER]
    assert [row.error_kind for row in rows] == [None, None, "ModelError", None]
    assert rows[1].agent_error == "a fault"
    whole = FleetRow.of(rows)
    assert (whole.error, whole.id, whole.has_succeeded) == ("no answer", setup.id, False)
    assert [row.id for row in whole.stored] == [car.id for car in reversed(setup.cars)]
    silent = run_fleet(setup.cars, [TrialRun(car, make_agent("silent")) for car in setup.cars], simulations)
    assert all(row.error is None for row in silent)


def test_a_car_that_finds_no_gap_has_a_row_that_says_so(
    simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("automotive_cosim.traffic.fork.RemoteRoad.entered", lambda self: ())
    setup = fleet_of(2)
    rows = run_fleet(setup.cars, [TrialRun(car, make_agent("silent")) for car in setup.cars], simulations)
    assert [row.error_kind for row in rows] == [None, "NoRoomError"]
    assert FleetRow.of(rows).error is None  # it would find none again


@pytest.fixture(scope="module")
def driven(simulations: Simulations, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An evaluation of two fleets with their pictures."""
    folder = tmp_path_factory.mktemp("fleets") / "eval"
    with closing(ForkServer()) as fork_server:
        here = Here(simulations, fork_server)
        here.answer = lambda: run_job(here.job, here.folder, Pictures.ALL, simulations, fork_server)  # type: ignore[method-assign]
        plan = make_plan({"agents": ["alert-often", "asurada"], "drives": ["grid_june"], "seeds": [2],
                          "settings": {"minutes": 0.4, "cars": 3}})  # fmt: skip
        end = run_plan(plan, folder, executor=here)
    assert (end.planned, end.done, end.errors) == (6, 6, 0)
    return folder


def test_rows_are_of_cars_and_a_lost_one_is_made_again(
    driven: Path, simulations: Simulations, tmp_path: Path
) -> None:
    results = read_results(driven)
    assert str(results.coverage).startswith("6 of 6 planned drives judged")
    assert sorted((row.agent, row.car, row.seed) for row in results.drives) == [
        (agent, car, 2 + car) for agent in ("alert-often", "asurada") for car in range(3)
    ]
    assert not any(row.agent_error for row in results.drives)
    assert load_results(driven).index.nunique() == 6
    assert all(read_trace(driven, row.id)[-1]["result"]["timeline"] for row in results.drives)
    again = list(regrade(driven))
    assert len(again) == 6
    assert not any(each.differs or each.problem for each in again)
    folder = tmp_path / "again"
    folder.mkdir()
    (folder / "manifest.json").write_bytes((driven / "manifest.json").read_bytes())
    lines = (driven / "episodes.jsonl").read_bytes().splitlines(keepends=True)
    lost = json.loads(
        lines.pop(next(number for number, line in enumerate(lines) if b'"car":2' in line.replace(b" ", b"")))
    )
    (folder / "episodes.jsonl").write_bytes(b"".join(lines))
    assert not read_results(folder).coverage.is_complete
    with closing(ForkServer()) as fork_server:
        plan = make_plan(json.loads((driven / "manifest.json").read_text())["plan"])
        end = run_plan(plan, folder, executor=Here(simulations, fork_server))
    assert (end.ran, end.done) == (3, 6)
    before, now = (read_rows(each, DriveTrialRow) for each in (driven, folder))
    assert {name: steady(row) for name, row in before.items()} == {name: steady(row) for name, row in now.items()}
    assert lost["id"] in now


def test_report_and_pages_have_a_map_whose_cars_open(driven: Path) -> None:
    page = write_report(driven).read_text(encoding="utf-8")
    rows = read_rows(driven, DriveTrialRow)
    leaders = [row.id for row in rows.values() if not row.car]
    assert page.count('id="roads"') == 2
    records = RecordFolders([driven.parent])
    (entry,) = records.entries()
    content = Content(records)
    shown = content.study(entry.id, "")
    assert {each["id"] for each in shown["fleets"]} == set(map(record_of, leaders))
    assert set(content.evaluation(entry.id)["fleets"]) == set(map(record_of, leaders))
    for leader in leaders:
        name = record_of(leader)
        fleet = read_fleet(driven, name)
        assert fleet is not None
        assert f'href="{name}.html#car-3"' in page
        cars_page = (driven / f"{name}.html").read_text(encoding="utf-8")
        assert cars_page.count('class="card one"') == 3
        assert "A score of 0 is doing nothing" in cars_page
        assert fleet.ways.keys() == fleet.trials.keys() == {"ego", "ego.1", "ego.2"}
        assert set(fleet.trials.values()) <= rows.keys()
        cars = content.study(entry.id, "cars", name)["cars"]
        assert [len(car["cells"]) for car in cars] == [len(shown["columns"])] * 3
        assert content.run(entry.id, fleet.trials["ego.2"])["kind"] == "drive"
        assert next(iter(content.road(entry.id, name, 0)))["cars"] == fleet.trials
    assert '<h2 id="cars">Cars of fleets</h2>' in page
    with pytest.raises(NotHereError):
        content.study(entry.id, "cars", "another")


def second_car(folder: Path) -> str:
    """The id of a car that acts, and is not the first."""
    return next(
        row.id for row in read_rows(folder, DriveTrialRow).values() if (row.agent, row.car) == ("alert-often", 1)
    )


def test_a_car_is_replayed_with_its_fleet_and_recorded_anew(driven: Path, tmp_path: Path) -> None:
    name = next(
        row.id for row in read_rows(driven, DriveTrialRow).values() if row.agent == "alert-often" and row.car
    )
    again = tmp_path / "again"
    replayed = CliRunner().invoke(app, ["replay", str(driven), name, "--out", str(again)])
    assert replayed.exit_code == 0, replayed.output
    assert "steps are the same" in replayed.output
    before = driven / PICTURES / name
    for file in ("road.jsonl.gz", "steps.jsonl.gz"):
        assert gzip.decompress((again / file).read_bytes()) == gzip.decompress((before / file).read_bytes())
    pictures = sorted(path.relative_to(before) for path in before.glob("**/*.jpg"))
    assert pictures
    assert all((again / picture).read_bytes() == (before / picture).read_bytes() for picture in pictures)
    with pytest.raises(UserError, match="among others; give the folder of their evaluation"):
        rerun(again)


def test_verify_drives_a_fleet_again_and_names_the_car_that_differs(driven: Path, tmp_path: Path) -> None:
    found = verify(driven, replays=2, seed=1)
    assert not found.problems
    assert "6 drives replayed, drawn with seed 1" in found.facts
    folder = Path(shutil.copytree(driven, tmp_path / "forged"))
    name = next(
        row.id for row in read_rows(folder, DriveTrialRow).values() if row.agent == "alert-often" and row.car
    )
    *steps, last = read_trace(folder, name)
    steps[-1] = steps[-1] | {"sha256": steps[-1]["sha256"] | {"signals": 64 * "0"}}
    write_trace(folder, name, [*steps, last])
    (problem,) = verify(folder, replays=2, seed=1).problems
    assert name in problem.file
    assert problem.field == f"step {len(steps) - 1} signals"


def test_the_acts_of_a_car_are_left_out_all_else_equal(driven: Path, simulations: Simulations) -> None:
    row = max(read_rows(driven, DriveTrialRow).values(), key=lambda row: (len(row.acts), row.car))
    effects = attribute(driven, row.id, simulations=simulations)
    assert sum(len(each.steps) == 1 for each in effects) == len({act.time_s for act in row.acts}) > 0


@pytest.mark.slow
def test_the_command_runs_a_fleet_and_tells_of_each_car(sumo: None, tmp_path: Path) -> None:
    words = ["run", "--drive", "grid_june", "--agent", "silent", "--seed", "2", "--minutes", "0.4", "--cars", "2"]
    done = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "fleet")])
    assert done.exit_code == 0, done.output
    assert "Car 0:" in done.output
    assert "Car 1:" in done.output
    assert len(read_rows(tmp_path / "fleet", DriveTrialRow)) == 2
    again = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "fleet"), "--force"])
    assert again.exit_code
    assert "never replaced" in str(again.exception)


def test_a_car_of_a_fleet_does_not_drive_alone(simulations: Simulations) -> None:
    with pytest.raises(UserError, match="cannot drive alone"):
        DriveSpec("grid_june", settings=DriveSettings(cars=2)).begin(simulations)
    assert as_json(fleet_of(None).planned())["car"] == 0


def test_a_cars_page_says_where_its_agent_gave_no_action() -> None:
    row = replace(fleet_of(2).planned(), end=End.MINUTES_OVER, malformed=1, malformed_why="it raised")
    assert shown_car("ego", row).words == "minutes over; no action in 1 step, at first: it raised"
    assert shown_car("ego", replace(row, malformed=0)).words == "minutes over"
