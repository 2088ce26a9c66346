"""Whole studies: the order and number of workers, resuming, what is kept out, the report, the command."""

import csv
import gzip
import hashlib
import json
import re
import runpy
import shutil
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from statistics import median

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.main import app
from automotive_cosim.cli.results import report
from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import LIVE, ROAD, STEPS, WATCHED
from automotive_cosim.formats.writing import mark_as_written
from automotive_cosim.report.files import write_files
from automotive_cosim.run.attribution import sentence
from automotive_cosim.run.batch import Progress
from automotive_cosim.run.job_row import steady as steady_part
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.road import read_record
from automotive_cosim.run.store import read_rows
from automotive_cosim.studies import intervals, load_study
from automotive_cosim.studies.calls.chance import Fresh
from automotive_cosim.studies.reroute import batch
from automotive_cosim.studies.reroute.batch import REROUTE
from automotive_cosim.studies.reroute.data import futures
from automotive_cosim.studies.reroute.decisions import attributed
from automotive_cosim.studies.reroute.demand import read_demand
from automotive_cosim.studies.reroute.effects import effects
from automotive_cosim.studies.reroute.live import LiveTrip
from automotive_cosim.studies.reroute.page import write_study
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.reroute.points import NOT_CLEARED
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.rows import NOTHING, TripRow
from automotive_cosim.studies.reroute.tables import policies as policy_table
from automotive_cosim.studies.reroute.tables import tables
from automotive_cosim.studies.reroute.tracks import TRACKS
from automotive_cosim.studies.reroute.trip import NO_ROOM
from automotive_cosim.studies.reroute.warnings import steps_told

from .conftest import EDGES, MORE_TRIPS, Draw

JAMMED = """<routes>
    <vType id="car" vClass="passenger" sigma="0"/>
    <flow id="too_many" type="car" from="access" to="exit" begin="0" end="20000" period="1"/>
</routes>"""


DAWDLING = """<routes>
    <vType id="car" vClass="passenger" sigma="0.9"/>
    <flow id="many" type="car" from="access" to="exit" begin="0" end="20000" period="6"/>
</routes>"""


def steady(folder: Path) -> dict[str, Json]:
    return {name: steady_part(row) for name, row in read_rows(folder, TripRow).items()}


def write_tables(folder: Path) -> None:
    """As much of a report as takes no time."""
    study = Study.read(folder)
    write_files(folder, [*tables(study), *(table for table in effects(study) if table.rows)], ())


@pytest.fixture(scope="module")
def plan(two_ways: Draw) -> StudyPlan:
    """Two seeds, two departures, and trips that have nothing to decide."""
    return StudyPlan(
        str(two_ways(more=MORE_TRIPS)),
        departures_s=(0.0, 70.0),
        seeds=(0, 1),
        per_drive=2,
        every_s=20.0,
        ages_s=(0.0, 600.0),
    )


@pytest.fixture(scope="module")
def folder(plan: StudyPlan, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The study, run by one worker."""
    folder = tmp_path_factory.mktemp("study") / "one"
    end = REROUTE.run(plan, folder)
    assert (end.done, end.errors) == (len(plan.jobs()), 0)
    return folder


@pytest.fixture(scope="module")
def page(folder: Path) -> str:
    """The report of the study, with its tables and data."""
    return write_study(folder).read_text(encoding="utf-8")


def test_what_a_decision_changed_is_told_and_called_chance_if_it_was_driven_once(folder: Path) -> None:
    study = Study.read(folder)
    told = attributed(folder, "")
    assert sentence(told).endswith("each driven from the same traffic, changed more than chance does.")
    assert len(told) == sum(len(each.branches) for row in study.rows for each in row.decisions)
    assert all(each.is_neutral and "driven once" in each.act for each in told)
    assert any("may be chance: " in each.effect for each in told)
    with pytest.raises(UserError, match="begins with 'x'; choices"):
        attributed(folder, "x")


def test_order_and_number_of_workers_do_not_show(plan: StudyPlan, folder: Path, tmp_path: Path) -> None:
    REROUTE.run(plan, tmp_path / "two", executor=Processes(2))
    assert steady(tmp_path / "two") == steady(folder)


@pytest.mark.slow
def test_replicates_are_rows_that_come_out_equal_wherever_they_ran(two_ways: Draw, tmp_path: Path) -> None:
    """Also resumed after a kill; cars that dawdle make every draw another one."""
    plan = StudyPlan(
        str(two_ways(DAWDLING)), departures_s=(0.0,), seeds=(0, 1), per_drive=1, least_delay_s=0.0, replicates=3
    )
    REROUTE.run(plan, tmp_path / "one")
    REROUTE.run(plan, tmp_path / "two", executor=Processes(2))
    assert steady(tmp_path / "two") == steady(tmp_path / "one")
    study = Study.read(tmp_path / "one")
    assert {row.fresh for row in study.rows} == {Fresh.SEED}
    for point in study.decisions:
        told = attributed(tmp_path / "one", point.id)
        assert {each.draws for each in told} == {point.decision.draws}
        for number, each in enumerate(told):
            gains_s = [point.decision.gain(draw, number).time_s for draw in range(point.decision.draws)]
            found_s, noise_s = {**each.changed, **each.chance}.get("arrival_s", (0.0, 0.0))
            assert abs(median(gains_s) + found_s) <= 1.0 or "arrival_s" in each.chance
            assert "arrival_s" not in each.changed or abs(found_s) > noise_s
        seeds = [each.seed for each in point.decision.replicates]
        assert len(set(seeds)) == 2
        gains = [point.decision.gain(draw, 0) for draw in range(3)]
        assert len(set(gains)) == 3
        assert point.decision.gains(0).time_s == pytest.approx(sum(each.time_s for each in gains) / 3, abs=1e-3)
    assert len({each.seed for point in study.decisions for each in point.decision.replicates}) == 2 * len(
        study.decisions
    )
    single = tmp_path / "single"
    REROUTE.run(replace(plan, replicates=1), single)
    for one, many in zip(Study.read(single).rows, study.rows, strict=True):
        assert one.stay == many.stay, "the first draw is the same drive"
        assert [each.branches for each in one.decisions] == [each.branches for each in many.decisions]
    lines = (tmp_path / "one" / "episodes.jsonl").read_bytes().splitlines(keepends=True)
    (tmp_path / "two" / "episodes.jsonl").write_bytes(lines[0] + lines[1][:60])
    assert REROUTE.run(plan, tmp_path / "two").ran == 1
    assert steady(tmp_path / "two") == steady(tmp_path / "one")
    assert "cross-fitted" in write_study(tmp_path / "one").read_text(encoding="utf-8")


def test_watching_shows_every_drive_and_changes_nothing(plan: StudyPlan, folder: Path, tmp_path: Path) -> None:
    watched = tmp_path / "watched"
    with ExitStack() as stack:

        def watch(progress: Progress[TripRow]) -> None:
            mark_as_written(stack.enter_context((watched / LIVE / WATCHED).open("rb")))

        REROUTE.run(replace(plan, seeds=(0,)), watched, tell=watch)
    assert steady(watched)
    assert steady(watched).items() <= steady(folder).items()
    assert not list((folder / LIVE).glob("*/")), "nobody watched that one"
    decided = [row for row in read_rows(watched, TripRow).values() if row.decisions]
    assert decided
    for row in decided:
        seconds = read_record(watched / LIVE / row.id / ROAD).seconds
        assert [second.at_s for second in seconds] == list(range(1, len(seconds) + 1))
        assert all("ego" in {each.vehicle_id for each in second.vehicles} for second in seconds)
        shown = [json.loads(line) for line in (watched / LIVE / row.id / STEPS).read_text().splitlines()]
        assert [line["step"] for line in shown] == list(range(len(shown)))
        assert shown == sorted(shown, key=lambda line: line["at_s"])
        assert "always" in shown[1]["stages"][0]["text"]
        gain_s = row.decisions[0].gains(0).time_s
        assert any(f"decision 1, alternative 1: saves {gain_s:+.0f} s" in line["words"] for line in shown)


def test_a_full_disk_ends_the_watching_and_not_the_study(
    plan: StudyPlan, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(LiveTrip, "_is_watched", lambda live: live._folder is not None)
    monkeypatch.setattr(LiveTrip, "_begin", full)
    REROUTE.run(replace(plan, seeds=(0,)), tmp_path / "full")
    assert steady(tmp_path / "full").items() <= steady(folder).items()


def test_what_is_done_is_not_run_again(plan: StudyPlan, folder: Path, tmp_path: Path) -> None:
    """Also after a kill that cut the last line short: what is missing is driven, and comes out equal."""
    again = tmp_path / "again"
    again.mkdir()
    lines = (folder / "episodes.jsonl").read_bytes().splitlines(keepends=True)
    (again / "manifest.json").write_bytes((folder / "manifest.json").read_bytes())
    (again / "episodes.jsonl").write_bytes(b"".join(lines[:-3]) + lines[-3][:40])
    assert REROUTE.run(plan, again).ran == 3
    assert steady(again) == steady(folder)
    assert REROUTE.run(plan, again).ran == 0
    with pytest.raises(UserError, match="started with a different plan"):
        REROUTE.run(replace(plan, compliance=(0.5,)), again)


def test_what_has_nothing_to_decide_is_counted_and_kept_out(folder: Path) -> None:
    study = Study.read(folder)
    assert study.excluded["drive", "start is goal"] == 4
    assert study.excluded["drive", "no congestion met"] == 4
    assert study.excluded["drive", "no alternative"] == 4
    assert {row.trip for row in study.rows if not row.excluded} == {"across"}
    assert len(study.decisions) == 8
    assert {each.trip for each in study.choices} == {"across"}


def test_old_news_offers_nothing_worth_it(folder: Path) -> None:
    """The rule takes the other way by fresh news; by news from before the lorries it stays."""
    frame = load_study(folder)
    rule = frame[frame.policy == "delay:60"].set_index("age_s").rerouted
    assert rule.loc[0.0].all()
    assert len(rule.loc[600.0]) == len(rule.loc[0.0])


def test_every_future_of_a_decision_says_its_way(folder: Path) -> None:
    decisions = [each for row in read_rows(folder, TripRow).values() for each in row.decisions]
    assert decisions
    for decision in decisions:
        stay, *others = decision.ways
        assert len(others) == len(decision.branches)
        assert stay not in others
        assert len({(way[0], way[-1]) for way in decision.ways}) == 1, "from one place to the same destination"


def test_the_report_is_whole(folder: Path, page: str) -> None:
    assert "2 seeds have a decision" in page
    assert "no alternative" in page
    assert "one-shot" in page
    frame = load_study(folder)
    with (folder / "choices.csv").open(encoding="utf-8", newline="") as file:
        written = list(csv.DictReader(file))
    assert len(written) == len(frame) == 8 * 5 * 2
    assert [row["id"] for row in written] == list(frame.id)
    for name in (
        "policies",
        "costs",
        "by_congestion",
        "by_age",
        "noise",
        "excluded",
        "everyone",
        "by_trip",
        "traffic",
        "by_departure",
    ):
        for suffix in ("md", "csv", "tex"):
            assert (folder / "tables" / f"{name}.{suffix}").read_text(encoding="utf-8").strip()
    for name in ("policies", "promised", "congestion", "ages", "everyone"):
        assert (folder / "plots" / f"{name}.svg").read_text(encoding="utf-8").startswith("<svg")


@pytest.mark.usefixtures("page")
def test_every_future_is_a_row_and_the_package_describes_it(folder: Path) -> None:
    study = Study.read(folder)
    decisions = [decision for row in study.rows for decision in row.decisions]
    with (folder / "futures.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == sum(
        (1 + len(each.branches)) * each.draws + (each.placebo is not None) for each in decisions
    )
    always = [each for each in study.choices if (each.policy, each.age_s) == ("always", 0.0)]
    found = {row["id"]: float(row["gain_time_s"]) for row in rows if "always" in row["policies"].split()}
    assert found == {each.id: each.gain.time_s for each in always}
    package = json.loads((folder / "datapackage.json").read_text(encoding="utf-8"))
    assert package["study"]["plan"] == study.plan.as_json()
    assert "two.net.xml" in package["inputs"]
    for resource in package["resources"]:
        content = (folder / resource["path"]).read_bytes()
        assert resource["hash"] == f"sha256:{hashlib.sha256(content).hexdigest()}"
        if resource["format"] == "csv":
            header = content.decode().splitlines()[0].split(",")
            assert [field["name"] for field in resource["schema"]["fields"]] == header
            assert not [
                field
                for field in resource["schema"]["fields"]
                if field["type"] == "any" and field["name"] not in EMPTY_HERE
            ]


@pytest.mark.usefixtures("page")
def test_parquet_holds_the_same(folder: Path) -> None:
    pd = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    for name in ("choices", "futures"):
        read = pd.read_parquet(folder / f"{name}.parquet")
        assert list(read.columns) == list(pd.read_csv(folder / f"{name}.csv").columns)
        assert read.id.tolist() == pd.read_csv(folder / f"{name}.csv").id.tolist()
        assert {str(read[each].dtype) for each in ("share", "gain_time_s", "gain_co2_g")} == {"Float64"}, (
            "also whole"
        )
        assert str(read.seed.dtype) == str(read.branch.dtype) == "Int64"


EMPTY_HERE = {"gain_error_s", "won", "lost", "chose_best", "draw_seed"}
"""Columns that a study of single draws leaves empty."""


def test_compliance_is_swept_at_the_same_decisions(folder: Path, tmp_path: Path) -> None:
    """Who follows at one probability does so at every greater one; the data hold all, the tables the first."""
    swept = tmp_path / "swept"
    shutil.copytree(folder, swept)
    manifest = json.loads((swept / "manifest.json").read_text())
    levels = (1.0, 0.5, 0.0)
    manifest["plan"]["compliance"] = levels
    (swept / "manifest.json").write_text(json.dumps(manifest))
    write_study(swept)
    frame = load_study(swept)
    frame = frame[(frame.policy == "always") & (frame.age_s == 0.0)]
    full, half, none = (frame[frame.compliance == level].set_index("id") for level in levels)
    assert full.complies.all()
    assert full.rerouted.all()
    assert not none.complies.any()
    assert (none.gain_time_s == 0).all()
    assert 0 < half.complies.sum() < len(half)
    assert (half.gain_time_s == full.gain_time_s.where(half.complies, 0.0)).all()
    rows = list(csv.DictReader((swept / "tables" / "by_compliance.csv").read_text().splitlines()))
    assert [row["Compliance"] for row in rows] == ["100%", "50%", "0%"]
    assert float(rows[0]["always"]) == pytest.approx(full.gain_time_s.mean(), abs=0.05)
    assert float(rows[2]["always"]) == 0
    assert (swept / "plots" / "compliance.svg").exists()
    assert policy_table(Study.read(swept)) == policy_table(Study.read(folder)), "other tables are of the first"


def test_gridlocked_traffic_is_kept_apart(two_ways: Draw, tmp_path: Path) -> None:
    plan = StudyPlan(
        str(two_ways(JAMMED)),
        departures_s=(600.0,),
        seeds=(0,),
        per_drive=1,
        least_delay_s=0.0,
        placebo_every=0,
        limit_s=300.0,
    )
    REROUTE.run(plan, tmp_path / "jam")
    study = Study.read(tmp_path / "jam")
    assert not study.decisions
    assert {reason for _, reason in study.excluded} <= {NOT_CLEARED, NO_ROOM, "gridlock: waiting for long"}
    assert sum(study.excluded.values()) == 1


def test_each_share_is_traffic_of_its_own(two_ways: Draw, tmp_path: Path) -> None:
    plan = StudyPlan(
        str(two_ways()), departures_s=(0.0,), seeds=(0,), per_drive=1, shares=(0.0, 1.0), placebo_every=0
    )
    REROUTE.run(plan, tmp_path / "shares")
    study = Study.read(tmp_path / "shares")
    assert [row.share for row in study.rows] == [0.0, 1.0]
    assert {each.share for each in study.choices} == {0.0, 1.0}
    write_tables(tmp_path / "shares")
    assert "Too few seeds" in (tmp_path / "shares" / "tables" / "by_share.md").read_text()


def test_a_whole_drive_gains_what_its_one_rerouting_does(two_ways: Draw, tmp_path: Path) -> None:
    """There is one place to turn off, so following a policy is the one deviation, or none."""
    scenario = str(two_ways(more=MORE_TRIPS))
    policies = ("never", "always", "delay:3000", "sumo", "best")
    plan = StudyPlan(
        scenario,
        departures_s=(0.0,),
        seeds=(0,),
        per_drive=1,
        policies=policies,
        compliance=(1.0, 0.0),
        whole_drives=True,
        placebo_every=0,
        replicates=2,
    )
    REROUTE.run(plan, tmp_path / "whole")
    study = Study.read(tmp_path / "whole")
    row = {row.trip: row for row in study.rows}["across"]
    (decision,) = row.decisions
    always = [each for each in row.whole if (each.policy, each.compliance) == ("always", 1.0)]
    assert [each.draw for each in always] == [0, 1]
    for each in always:
        assert each.reroutings == 1
        assert each.branch.gains == decision.branches[decision.news[0].branch or 0].gains
    assert {(each.policy, each.reroutings) for each in row.whole if each.policy == "delay:3000"} == {
        ("delay:3000", 0)
    }
    assert {each.policy for each in row.whole} == {"always", "delay:3000", "sumo"}
    assert {each.reroutings for each in row.whole if each.compliance == 0} == {0}, "nobody follows"
    free = {row.trip: row for row in study.rows}["free"]
    assert free.excluded == "no congestion met"
    assert {each.branch.gains for each in free.whole} == {NOTHING}
    write_tables(tmp_path / "whole")
    text = (tmp_path / "whole" / "tables" / "whole.csv").read_text()
    assert "always,100%,3,0" in text, "the drives without a decision count; the one that has nowhere to go does not"


@pytest.mark.slow
def test_many_at_once_start_from_the_one(two_ways: Draw, tmp_path: Path) -> None:
    """Sending nobody along is the ego's branch; sending all along changes it, and nobody is counted twice."""
    plan = StudyPlan(
        str(two_ways(DAWDLING)),
        departures_s=(0.0,),
        seeds=(0,),
        per_drive=2,
        every_s=10.0,
        least_delay_s=0.0,
        together=(0.0, 1.0),
    )
    REROUTE.run(plan, tmp_path / "many")
    (row,) = Study.read(tmp_path / "many").rows
    first, second = row.decisions
    assert not second.together
    branch = first.branches[first.news[0].branch or 0]
    alone, everybody = first.together
    assert (alone.took, alone.took_gain_s) == (0, 0.0)
    assert alone.ego_gain_s == branch.gains.time_s
    assert alone.rest_gain_s == branch.others.gain_s
    assert 0 < everybody.took <= everybody.could == alone.could < branch.others.count
    assert everybody.took_gain_s < 0, "the other way is half as long again and nothing holds them up on their own"
    write_tables(tmp_path / "many")
    assert (tmp_path / "many" / "tables" / "many.md").read_text().count("\n| 0% |") == 2


@pytest.mark.slow
def test_a_closure_costs_who_would_have_driven_there(two_ways: Draw, tmp_path: Path) -> None:
    """With the other way closed, the ego that wanted to take it drives as if it had not."""
    plan = StudyPlan(str(two_ways()), departures_s=(0.0,), seeds=(0,), per_drive=1, placebo_every=0, close="back")
    REROUTE.run(plan, tmp_path / "closed")
    (row,) = Study.read(tmp_path / "closed").rows
    assert not row.error
    (decision,) = row.decisions
    (found,) = decision.closed
    assert not found.excluded
    assert (found.edge, found.draw) == ("back", 0)
    assert (found.stay_loss_s, found.others_loss_s, found.others_later) == (0, 0, 0), "nobody else drives there"
    assert found.open_gain_s == decision.branches[0].gains.time_s > 0
    assert found.other_loss_s == pytest.approx(found.open_gain_s - found.gain_s)
    assert found.gain_s == pytest.approx(0, abs=5), "both end up on the main road"
    write_tables(tmp_path / "closed")
    assert (tmp_path / "closed" / "tables" / "closed.md").read_text().count("\n| 0% | 1 | 0 |") == 1


def test_a_closure_needs_an_edge(two_ways: Draw) -> None:
    StudyPlan(str(two_ways()), close="ahead").check()
    with pytest.raises(UserError, match=r"no edge for cars named 'mian'.*main"):
        StudyPlan(str(two_ways()), close="mian").check()


def test_emissions_are_of_everyone_by_class_and_the_ego_can_be_electric(two_ways: Draw, tmp_path: Path) -> None:
    plan = StudyPlan(
        str(two_ways()),
        departures_s=(0.0,),
        seeds=(0,),
        per_drive=1,
        placebo_every=0,
        emissions=True,
        ego_class="Energy/default",
    )
    REROUTE.run(plan, tmp_path / "fleet")
    (row,) = Study.read(tmp_path / "fleet").rows
    (decision,) = row.decisions
    branch = decision.branches[0]
    assert row.stay is not None
    assert (row.stay.co2_g, row.stay.fuel_g) == (0, 0)
    assert row.stay.energy_wh > 50
    fleet = {each.emission_class: each for each in branch.fleet}
    ego = fleet.pop("ego: Energy/default")
    assert ego.energy_wh == pytest.approx(branch.gains.energy_wh, abs=0.01)
    assert ego.count == 1
    assert ego.noise_s < 0, "the other way is half as long again, and so is its noise"
    (lorries,) = fleet.values()
    assert lorries.count > 0
    saved = (lorries.co2_g, lorries.nox_g, lorries.fuel_g, lorries.energy_wh, lorries.noise_s)
    assert saved == (0, 0, 0, 0, 0), "nobody is in their way"
    write_tables(tmp_path / "fleet")
    assert "Energy/default" in (tmp_path / "fleet" / "tables" / "fleet.md").read_text()


def test_an_emission_class_that_sumo_lacks_is_named(two_ways: Draw, tmp_path: Path) -> None:
    plan = StudyPlan(str(two_ways()), departures_s=(0.0,), seeds=(0,), per_drive=1, ego_class="Steam/big")
    REROUTE.run(plan, tmp_path / "steam", retries=0)
    (row,) = Study.read(tmp_path / "steam").rows
    assert "Steam/big" in (row.error or "")


@pytest.mark.slow
def test_seeds_are_added_only_until_enough_is_known(
    two_ways: Draw, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without chance every seed finds the same gain, so the fewest that an interval takes are enough: four here."""
    monkeypatch.setattr(batch, "LEAST_SEEDS", 4)
    monkeypatch.setattr(intervals, "LEAST_SEEDS", 4)
    plan = StudyPlan(
        str(two_ways()), departures_s=(0.0,), seeds=tuple(range(8)), per_drive=1, placebo_every=0, half_width_s=1.0
    )
    REROUTE.run(plan, tmp_path / "until", executor=Processes(2))
    assert {row.seed for row in Study.read(tmp_path / "until").rows} == set(range(4))


AGENTS = """
from automotive_cosim.contracts import Action, ActionType, GoalStatus
from automotive_cosim.contracts.ids import resource_id

class Base:
    name, model, channels = "mine", "none", ("elements",)
    def reset(self, goal): self.goal = goal

class Idle(Base):
    def act(self, observation): return Action(ActionType.WAIT)

class Taps(Base):
    # opens the map's list of other ways and takes the first
    def reset(self, goal):
        assert "faster" in goal
        self.left = ["map.route", "route.tab.ways", "route.way.0"]
        self.is_open = False
    def act(self, observation):
        if not self.is_open:
            self.is_open = True
            return Action(ActionType.OPEN_APP, app_name="map")
        if not self.left:
            return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
        ids = [element.resource_id for element in observation.elements]
        return Action(ActionType.CLICK, index=ids.index(resource_id(self.left.pop(0))))
"""


def test_an_agent_gains_what_its_taps_do_and_one_that_does_nothing_changes_nothing(
    two_ways: Draw, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mine.py").write_text(AGENTS)
    monkeypatch.chdir(tmp_path)
    policies = ("never", "always", "agent:mine:Idle", "agent:mine:Taps")
    plan = StudyPlan(
        str(two_ways()),
        departures_s=(0.0,),
        seeds=(0,),
        per_drive=1,
        policies=policies,
        agent_steps=6,
        replicates=2,
        trajectories=True,
    )
    REROUTE.run(plan, tmp_path / "agent")
    study = Study.read(tmp_path / "agent")
    (point,) = study.decisions
    decision = point.decision
    (again,) = decision.replicates
    for draw in (decision, again):
        idle = draw.branches[decision.agents["mine:Idle"]]
        assert idle.gains == NOTHING
        assert idle.others.changed == 0
    taps = decision.branches[decision.agents["mine:Taps"]]
    always = decision.branches[decision.news[0].branch]
    assert taps.totals == always.totals, "the way is the same, wherever on the first road it was chosen"
    assert {each.policy: each.gain.time_s > 0 for each in study.choices}["agent:mine:Taps"]
    turned = {each.policy: each.rerouted for each in study.choices}
    assert turned["agent:mine:Taps"]
    assert not turned["agent:mine:Idle"]
    last_s = {}
    with gzip.open(tmp_path / "agent" / TRACKS / f"{point.drive.id}.csv.gz", "rt") as file:
        for row in csv.DictReader(file):
            last_s[row["id"], int(row["draw"]), row["branch"]] = float(row["time_s"])
    driven = list(futures(study))
    assert len(last_s) == len(driven) == 2 * (1 + len(decision.branches))
    for each in driven:
        if each.branch is not None:
            kept_s, own_s = (last_s[each.id, each.draw, branch] for branch in ("", str(each.branch)))
            assert kept_s - own_s == pytest.approx(each.gain.time_s), "the tracks end when the drives do"


ANSWERS = {
    "chance": r"1 branches, each driven 2 to 2 times\n.*within a decision: \d",
    "gain": r"always +\+31\.\d s ± nan, 1 decisions of 1 seeds",
    "policy": r"always +1\.0 +1\.0 +31\.",
    "ways": r"branch 0: .*out, back.*\nkept route: .*main",
    "who_pays": r"the ego gains: 2 futures, mean \+31",
}


def test_every_question_has_a_script_that_answers_it(
    small: StudyPlan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    scripts = sorted((Path(__file__).parents[2] / "docs/examples/studies").glob("*.py"))
    scripts = [path for path in scripts if path.stem != "urb"]  # which makes scenarios, and reads no study
    assert [path.stem for path in scripts] == sorted(ANSWERS)
    plan = replace(small, replicates=2, whole_drives=True, trajectories=True, policies=("never", "always"))
    REROUTE.run(plan, tmp_path / "study")
    write_study(tmp_path / "study")
    for path in scripts:
        monkeypatch.setattr("sys.argv", [str(path), str(tmp_path / "study")])
        capsys.readouterr()
        runpy.run_path(str(path))
        assert re.search(ANSWERS[path.stem], capsys.readouterr().out), path.stem
    page = (tmp_path / "study/decisions.html").read_text(encoding="utf-8")
    for word in ("Traffic news: ", "kept route", "alternative 1", "always", "+31", "<polyline"):
        assert word in page


def test_the_reference_agents_get_there_faster(two_ways: Draw, tmp_path: Path) -> None:
    """They hear the question, open the map and tap: the car takes the way that the news called quicker."""
    names = ("t3a", "asurada")
    policies = ("never", "always", "best", *(f"agent:{name}" for name in names))
    plan = StudyPlan(str(two_ways()), departures_s=(0.0,), seeds=(0,), per_drive=1, policies=policies)
    REROUTE.run(plan, tmp_path / "agent")
    study = Study.read(tmp_path / "agent")
    (point,) = study.decisions
    decision = point.decision
    always = decision.branches[decision.news[0].branch]
    for name in names:
        assert decision.branches[decision.agents[name]].totals == always.totals
        choice = {each.policy: each for each in study.choices}[f"agent:{name}"]
        assert choice.rerouted
        assert choice.gain.time_s > 0


def invoke(*words: str) -> tuple[str, Exception | None]:
    result = CliRunner().invoke(app, ["study", *words])
    error = result.exception
    return result.output, error if isinstance(error, Exception) else None


def test_the_command(two_ways: Draw, tmp_path: Path) -> None:
    words = ["reroute", "--scenario", str(two_ways()), "--departures", "0", "--seeds", "3", "--per-drive", "1"]
    out = tmp_path / "out"
    text, error = invoke(*words, "--out", str(out), "--json")
    assert error is None, text
    told = json.loads(text.strip().splitlines()[-1])
    assert (told["drives"], told["decisions"], told["errors"], told["excluded"]) == (1, 1, 0, {})
    assert (out / "report.html").is_file()
    (demand,) = read_demand(out)
    assert demand.gap is not None
    assert demand.gap.relative == 0, "the lorries have no other way"
    assert "relative gap 0.0%" in text
    assert (out / "tables" / "demand.md").is_file()
    written = (out / "report.html").read_bytes()
    report(out)
    assert (out / "report.html").read_bytes() == written


@pytest.mark.slow
def test_several_networks_in_one_table(two_ways: Draw, tmp_path: Path) -> None:
    """Each row is what its own study says; a second network may have trips with nothing to decide."""
    names = ",".join(str(two_ways(more=more)) for more in ("", MORE_TRIPS))
    words = ["reroute", "--scenario", names, "--departures", "0", "--seeds", "0", "--per-drive", "1"]
    words += ["--warm-up", "0,30", "--policies", "never,always,best"]
    text, error = invoke(*words, "--replicates", "1", "--out", str(tmp_path / "suite"), "--json")
    assert error is None, text
    told = json.loads(text.strip().splitlines()[-1])["networks"]
    with (tmp_path / "suite" / "networks.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows == told
    assert [row["Warm-up, s"] for row in rows] == ["0", "30"] * 2
    for row, folder in zip(
        rows, sorted(path for path in (tmp_path / "suite").iterdir() if path.is_dir()), strict=True
    ):
        study = Study.read(folder)
        (always,) = [each for each in study.choices if each.policy == "always"]
        assert row["Always saves, s"] == f"{always.gain.time_s:+.1f}"
        assert row["Edges"] == str(len(EDGES))
        assert (folder / "report.html").is_file()


def test_the_command_says_when_nothing_counts(two_ways: Draw, tmp_path: Path) -> None:
    words = ["reroute", "--scenario", str(two_ways(more=MORE_TRIPS)), "--departures", "8:30", "--seeds", "0"]
    text, error = invoke(*words, "--trips", "stands,free", "--out", str(tmp_path / "out"))
    assert isinstance(error, UserError)
    assert "no decision counted" in str(error)
    assert "start is goal" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--departures", "soon"], "soon"),
        (["--departures", "25:00"], "clock"),
        (["--ages", "fresh"], "--ages"),
        (["--seeds", "a"], "--seeds"),
        (["--shares", ""], "--shares is empty"),
        (["--policies", "delay:soon"], "delay:60"),
        (["--policies", "worthwhile:2"], "worthwhile:1.2:60"),
        (["--scenario", "atlantis"], "atlantis"),
    ],
)
def test_bad_input_is_told(words: list[str], said: str) -> None:
    text, error = invoke("reroute", "--dry-run", *words)
    assert isinstance(error, UserError), text
    assert said in str(error)


@pytest.mark.parametrize("given", ["many", "0"])
def test_the_bounds_of_a_number_are_told_with_the_word_beside(given: str) -> None:
    text, _ = invoke("reroute", "--dry-run", "--replicates", given)
    assert f"'{given}' is neither a whole number from 1 to 100 nor auto" in " ".join(text.replace("│", " ").split())


def test_a_folder_that_is_no_study_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError):
        write_study(tmp_path)


def test_a_sumo_configuration_is_studied_as_it_is_between_places(two_ways: Draw, tmp_path: Path) -> None:
    configuration = two_ways() / "two.sumocfg"
    plan = StudyPlan(
        str(configuration),
        departures_s=(0.0,),
        seeds=(0,),
        per_drive=1,
        from_place="access",
        to_place="exit",
        least_delay_s=0.0,
    )
    plan.check()
    before = {path.name: path.read_bytes() for path in configuration.parent.iterdir()}
    REROUTE.run(plan, tmp_path / "s")
    study = Study.read(tmp_path / "s")
    assert [(row.trip, len(row.decisions)) for row in study.rows] == [("chosen", 1)]
    assert not [*steps_told(plan.opened, 1.0)], "the configuration states no step"
    stated = configuration.with_name("stated.sumocfg")
    inner = configuration.read_text().replace("<input>", '<time><step-length value="0.5"/></time><input>')
    stated.write_text(inner)
    assert "0.5 s" in " ".join(steps_told(replace(plan, scenario=str(stated)).opened, 1.0))
    stated.unlink()
    assert {path.name: path.read_bytes() for path in configuration.parent.iterdir()} == before
    with pytest.raises(UserError, match="no street or edge 'nowhere'"):
        replace(plan, from_place="nowhere").check()
