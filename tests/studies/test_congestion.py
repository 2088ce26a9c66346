"""Congestion of a network: what SUMO writes, what is made of it, and that an intervention alone differs."""

import json
import shutil
from dataclasses import MISSING, fields, replace
from pathlib import Path
from string import Formatter

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.batches import ProgressView
from automotive_cosim.cli.console import Console
from automotive_cosim.cli.main import app
from automotive_cosim.cli.results import report
from automotive_cosim.errors import UserError
from automotive_cosim.formats.incidents import EgoIncident
from automotive_cosim.run.batch import Progress
from automotive_cosim.studies import load_study
from automotive_cosim.studies.congestion.outputs import cells, read_edges, read_flows
from automotive_cosim.studies.congestion.page import answer, warnings
from automotive_cosim.studies.congestion.plan import INTERVENTIONS, CongestionPlan
from automotive_cosim.studies.congestion.results import (
    CongestionStudy,
    NetworkPart,
    change,
    delay_h,
    indices,
    queue_m,
    throughput_per_h,
)
from automotive_cosim.studies.congestion.rows import (
    CongestionRow,
    FlowCell,
    FlowState,
    FlowSums,
    InterventionOutcome,
)
from automotive_cosim.studies.congestion.seed import CONGESTION
from automotive_cosim.studies.congestion.tables import emissions, whole, worst
from automotive_cosim.studies.congestion.words import PHRASES, name_of
from automotive_cosim.studies.versions import pairs

from .conftest import Draw


def cell(
    from_s: float, time_s: float, lost_s: float, road_class: str = "primary", queue_m: float = 0.0
) -> FlowCell:
    flow = FlowSums(time_s=time_s, lost_s=lost_s, distance_m=10 * (time_s - lost_s))
    return FlowCell(from_s=from_s, road_class=road_class, flow=flow, queue_m=queue_m, longest_m=2 * queue_m)


def outcome(*found: FlowCell, intervention: str = "", backlog: int = 0) -> InterventionOutcome:
    """An hour in which a vehicle arrives every minute."""
    states = [
        FlowState(at_s=60.0 * n, running=9, backlog=backlog, departed=n, arrived=n, teleported=0) for n in range(61)
    ]
    return InterventionOutcome(intervention=intervention, cells=found, states=tuple(states))


PLAN = CongestionPlan("grid", interventions=("closure edge=c1c2",), demand=(1.0, 2.0), step_s=0.1)


def study(*added_s: float, undriven_s: float = 0.0) -> CongestionStudy:
    """Each seed loses an hour, and more with the intervention, with which part of the driving falls away."""
    rows = [
        CongestionRow(
            id=f"seed{seed}",
            scenario="grid",
            seed=seed,
            outcomes=(
                outcome(cell(0.0, 7200.0, 3600.0)),
                outcome(
                    cell(0.0, 7200.0 + more_s - undriven_s, 3600.0 + more_s), intervention=PLAN.interventions[0]
                ),
            ),
        )
        for seed, more_s in enumerate(added_s)
    ]
    return CongestionStudy(Path(), {}, PLAN, tuple(rows))


def test_the_indices_are_those_of_the_books() -> None:
    """Nineteen free five minutes and one that takes three times as long, each with 100 s of free driving."""
    made = outcome(*(cell(300.0 * n, 300.0 if n == 19 else 110.0, 200.0 if n == 19 else 10.0) for n in range(20)))
    found = indices(PLAN, [made])
    assert found is not None
    assert found.travel_time == pytest.approx((19 * 110 + 300) / 2000)
    assert found.planning_time == pytest.approx(1.1), "the worst twentieth begins after 95 % of the driving"
    assert found.buffer == pytest.approx(1.1 / found.travel_time - 1)
    assert indices(PLAN, [made], NetworkPart("motorway")) is None


def test_delay_queues_and_throughput_are_by_class_and_period() -> None:
    made = outcome(
        cell(0.0, 500.0, 180.0, queue_m=60.0),
        cell(300.0, 500.0, 180.0, "residential"),
        cell(1800.0, 900.0, 360.0, queue_m=30.0),
        backlog=2,
    )
    assert delay_h(PLAN, made) == pytest.approx((180 + 180 + 360) / 3600 + 2), "two wait outside all the time"
    assert delay_h(PLAN, made, NetworkPart("primary", 0)) == pytest.approx(180 / 1800)
    assert delay_h(PLAN, made, NetworkPart("primary", 1)) == pytest.approx(360 / 1800)
    assert delay_h(PLAN, made, NetworkPart(None, 1)) == pytest.approx(360 / 1800 + 2)
    assert queue_m(PLAN, made, NetworkPart("primary", 0)) == (10.0, 120.0), (
        "of six times five minutes one has a queue"
    )
    assert throughput_per_h(PLAN, made) == throughput_per_h(PLAN, made, NetworkPart(None, 1)) == 60


def test_the_answer_stands_first_and_is_paired_by_seed() -> None:
    found = study(*(3600.0 + 36.0 * seed for seed in range(10)))
    added = change(found, PLAN.interventions[0])
    assert added is not None
    assert added.interval is not None
    assert added.value == pytest.approx(1.045)
    assert answer(found).startswith(
        "“c1c2 closed” costs 1.0 (1.0 to 1.1) vehicle-hours an hour of delay (+104%); "
        "as many kilometres are driven, "
    )
    jammed = study(*[3600.0] * 10, undriven_s=1800.0)
    told = answer(jammed)
    assert "vehicle-hours an hour of delay (+100%); 50.0% fewer kilometres are driven" in told, "and no saving"
    for each in (found, jammed):
        assert len(answer(each).split()) <= 40
    unsure = study(*(3600.0 if seed % 2 else -1800.0 for seed in range(10)))
    assert "cannot be told from 0" in answer(unsure)
    saved = study(*[-1800.0] * 10)
    fewer = replace(saved.rows[0].outcomes[1], kept_in=2)
    kept = replace(
        saved, rows=(replace(saved.rows[0], outcomes=(saved.rows[0].outcomes[0], fewer)), *saved.rows[1:])
    )
    assert "leaves out 0.5 (0.5 to 0.5) vehicle-hours" in answer(kept), (
        "a road that is closed to some saves nothing"
    )
    assert "saves 0.5 (0.5 to 0.5) vehicle-hours an hour of delay (−50%)" in answer(saved)
    assert [str(row[0]) for row in whole(found).rows] == ["none", "c1c2 closed"]


def test_it_warns() -> None:
    few = study(60.0)
    assert any("1 seed: no interval" in each for each in warnings(few))
    none = study(*[0.0] * 30)
    assert warnings(none) == ["“c1c2 closed” changes nothing in any seed."]
    jam = replace(none.rows[0].outcomes[1], gridlock="30 of 40 vehicles stand")
    jammed = replace(none.rows[0], outcomes=(none.rows[0].outcomes[0], jam))
    assert any("gridlocked" in each for each in warnings(replace(none, rows=(jammed, *none.rows[1:]))))
    (first, *_), *_ = (row.outcomes for row in none.rows)
    drained = replace(first, states=tuple(replace(each, departed=min(each.departed, 50)) for each in first.states))
    dry = [replace(row, outcomes=(drained, *row.outcomes[1:])) for row in none.rows]
    told = [each for each in warnings(replace(none, rows=tuple(dry))) if "the demand ends" in each]
    assert len(told) == 1
    assert "after 49 of 60 min" in told[0]


def test_sumos_outputs_are_read_against_the_usual_limit(tmp_path: Path) -> None:
    (tmp_path / "edges.xml").write_text(
        '<meandata><interval begin="100.00" end="160.00" id="flow">'
        '<edge id="a" sampledSeconds="60.00" timeLoss="20.00" waitingTime="5.00" speed="5.00"/>'
        '<edge id=":n_0" sampledSeconds="6.00" timeLoss="0.00" waitingTime="0.00" speed="9.00"/>'
        '</interval><interval begin="160.00" end="220.00" id="flow">'
        '<edge id="a" sampledSeconds="60.00" timeLoss="20.00" speed="5.00"/></interval></meandata>'
    )
    flows = list(read_flows(tmp_path, 100.0, [{}, {"a": (0.5, 0.0)}]))
    assert [(each.edge, each.from_s) for each in flows] == [("a", 0.0), (":n_0", 0.0), ("a", 60.0)]
    assert [each.flow.lost_s for each in flows] == [20.0, 0.0, 40.0], "at half the limit, half the time is lost too"
    *_, stopped = read_flows(tmp_path, 100.0, [{}, {"a": (0.5, 10.0)}])
    assert stopped.flow.lost_s == 35.0, "a stop takes no longer at half the limit"
    queues = ({}, {"a_0": 30.0, "a_1": 60.0}), ({},)
    found = cells(flows, queues, lambda edge: "junctions" if edge[0] == ":" else "primary")
    assert [each.road_class for each in found] == ["junctions", "primary"]
    primary = found[1]
    assert (primary.flow.time_s, primary.flow.distance_m, primary.flow.standing_s) == (120.0, 600.0, 5.0)
    assert (primary.queue_m, primary.longest_m) == (3.0, 60.0), "the mean of thirty samples"


CARS = """<routes>
    <vType id="car" vClass="passenger" sigma="0" speedFactor="1" speedDev="0"/>
    <route id="main" edges="access main exit"/>
    <flow id="cars" type="car" route="main" begin="0" end="20000" period="20" departSpeed="max"/>
</routes>"""


@pytest.fixture(scope="module")
def driven(two_ways: Draw, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Cars on the main road of the two ways, with roadworks on it, without and with advice."""
    plan = CongestionPlan(
        str(two_ways(CARS)),
        interventions=("roadworks edge=main limit_kmh=9", "advice share=0", "advice share=1 age_s=300"),
        seeds=(0,),
        minutes=20.0,
        warm_up_s=300.0,
        emissions=True,
    )
    folder = tmp_path_factory.mktemp("congestion") / "study"
    CONGESTION.run(plan, folder)
    return folder


def test_roadworks_cost_what_can_be_reckoned(driven: Path) -> None:
    """1,000 m at 2.5 instead of 10 m/s take 300 s more; a car every 20 s makes 15 vehicle-hours an hour."""
    found = CongestionStudy.read(driven)
    assert not found.errors
    (_, before), (_, works), (_, nobody), (_, all_) = (next(found.outcomes(each)) for each in found.interventions)
    assert found.interventions[0] == ""
    assert delay_h(found.plan, before) < 0.2, "free but for turns"
    late = [each.flow for each in works.cells if each.from_s == 900.0 and each.road_class == "unknown"]
    lost_h = sum(flow.lost_s for flow in late) / 300.0
    assert lost_h == pytest.approx(15.0, abs=1.0)
    for silent in (nobody, all_):
        assert (silent.cells, silent.states) == (before.cells, before.states), "there is nothing to avoid"
    assert sum(each.co2_g for each in works.emitted) != sum(each.co2_g for each in before.emitted)
    assert [edge for edge, *_ in worst(found, 1)] == ["main"]
    assert len(emissions(found).rows) == 4
    assert {row.edge for row in read_edges(driven / "edges" / "seed0.csv.gz")} == {"access", "main", "exit"}


def test_who_is_advised_leaves_the_roadworks(two_ways: Draw, tmp_path: Path) -> None:
    """With all of them advised by fresh news, cars take the other way, and the delay falls."""
    plan = CongestionPlan(
        str(two_ways(CARS)),
        interventions=("advice share=1", "advice share=1 compliance=0"),
        incidents=("roadworks edge=main limit_kmh=9 from_s=-300",),
        seeds=(0,),
        minutes=20.0,
        warm_up_s=600.0,
    )
    CONGESTION.run(plan, tmp_path / "study")
    found = CongestionStudy.read(tmp_path / "study")
    without, advised, deaf = (delay_h(plan, next(found.outcomes(each))[1]) for each in found.interventions)
    assert advised < 0.6 * without
    assert deaf == without
    assert answer(found).startswith("“advice to 100 % of the cars”, of 2 interventions the strongest, saves")


def test_the_frame_has_each_seed_and_measure_of_every_network(driven: Path, tmp_path: Path) -> None:
    frame, found = load_study(driven), CongestionStudy.read(driven)
    assert list(frame.intervention.fillna("")) == list(found.interventions)
    assert set(frame.seed) == {0}
    (_, works) = next(found.outcomes(found.interventions[1]))
    assert frame.delay_vehicle_h_per_h[1] == delay_h(found.plan, works)
    for name in ("01_a", "02_b"):
        shutil.copytree(driven, tmp_path / "both" / name)
    both = load_study(tmp_path / "both")
    assert list(both.network.unique()) == ["a", "b"]
    assert len(both) == 2 * len(frame)
    (tmp_path / "none").mkdir()
    with pytest.raises(UserError):
        load_study(tmp_path / "none")


def test_two_versions_are_compared_row_by_row(driven: Path, tmp_path: Path) -> None:
    again = shutil.copytree(driven, tmp_path / "suite" / "again")
    told = CliRunner().invoke(app, ["study", "compare", str(driven), str(again), "--json"])
    assert told.exit_code == 0
    assert json.loads(told.output)["same"]
    lines = again / "episodes.jsonl"
    row = json.loads(lines.read_text(encoding="utf-8"))
    lines.write_text(json.dumps(row | {"scenario": "elsewhere", "wall_seconds": 9.0}) + "\n", encoding="utf-8")
    told = CliRunner().invoke(app, ["study", "compare", str(driven), str(again)])
    assert told.exit_code == 0, "where the files are is no result"
    assert f"| {driven} and {again} |" in told.output
    row["outcomes"][1]["cells"][0]["flow"]["lost_s"] += 3600.0
    lines.write_text(json.dumps(row) + "\n", encoding="utf-8")
    told = CliRunner().invoke(app, ["study", "compare", str(driven), str(again)])
    assert told.exit_code == 1
    assert "1 of 1 row differ" in told.output
    assert "| delay, roadworks on main at 9 km/h |" in told.output
    assert "+3.00 |" in told.output, "an hour lost in twenty minutes"
    shutil.copytree(driven, tmp_path / "other" / "again")
    (pair,) = pairs(tmp_path / "suite", tmp_path / "other")
    assert (pair.name, pair.rows) == ("again", (1, 0, 0))
    for suite, place in ("five", "05_town"), ("two", "01_town"):
        shutil.copytree(driven, tmp_path / suite / place)
    assert [pair.name for pair in pairs(tmp_path / "five", tmp_path / "two")] == ["town"]
    shutil.copytree(driven, tmp_path / "two" / "02_town")
    for other in ("other", "two"):
        with pytest.raises(UserError, match="no study in common"):
            pairs(tmp_path / "five", tmp_path / other)


def test_the_report_is_whole(driven: Path) -> None:
    report(driven)
    page = (driven / "report.html").read_text(encoding="utf-8")
    assert page.index("<h1>“roadworks on main at 9 km/h”") < page.index("The network with each intervention")
    assert 'automotive_cosim.studies.load_study(".")' in page
    maps = {path.stem for path in (driven / "plots").glob("map_change*.svg")}
    assert maps == {"map_change", "map_change_2", "map_change_3"}, "each intervention has its own"
    for name in ("delay", "map", *maps, "mfd", "time_space", "time_space_intervention"):
        assert (driven / "plots" / f"{name}.svg").read_text(encoding="utf-8").startswith("<svg")
        assert (driven / "plots" / f"{name}.pdf").read_bytes().startswith(b"%PDF")
        assert (driven / "plots" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    for name in ("whole", "by_class", "roads", "emissions"):
        assert (driven / "tables" / f"{name}.csv").is_file()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("", "none"),
        ("closure edge=c2c3", "c2c3 closed"),
        ("advice share=0.5 compliance=0.8 age_s=300", "advice to 50 % of the cars, 80 % follow, news 300 s old"),
        ("signals control=static", "fixed signals"),
        ("signals control=delay_based", "delay-based signals"),
        ("breakdown edge=c2c3 position_m=100 to_s=1200", "breakdown on c2c3, at 100 m, until 1200 s"),
        ("breakdown edge=c2c3 position_m=100 aside=true", "breakdown on c2c3, at 100 m, aside true"),
        ("jam edges=a,b length_m=200 hold_s=15", "jam of 200 m on a,b, one car per lane passes every 15 s"),
        ("jam edge=a length_m=200", "jam of 200 m on a"),
    ],
)
def test_measures_are_named_in_words(line: str, words: str) -> None:
    assert name_of(line) == words


def test_every_kind_of_measure_has_its_words() -> None:
    """Each phrase has fields that the kind requires, so that it can always be said."""
    assert PHRASES.keys() == {name for name, kind in INTERVENTIONS.items() if not issubclass(kind, EgoIncident)}
    for name, phrase in PHRASES.items():
        required = {each.name for each in fields(INTERVENTIONS[name]) if each.default is MISSING}
        assert {field for _, field, _, _ in Formatter().parse(phrase) if field} <= required


@pytest.mark.parametrize(
    ("before", "doing", "left_s", "told"),
    [
        ("", (), None, "0 of 2 seeds\n"),
        ("", ("warming up traffic",), None, "0 of 2 seeds; warming up traffic\n"),
        ("1 error", (), 162.0, "0 of 2 seeds; 1 error, 2:42 left\n"),
    ],
)
def test_progress_has_no_empty_part(
    before: str, doing: tuple[str, ...], left_s: float | None, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    progress: Progress[CongestionRow] = Progress(2, 0, 0, 0, 0, 0, 1.0, left_s, None, doing)
    ProgressView[CongestionRow](Console(), "seeds", lambda _: before).tell(progress)
    assert capsys.readouterr().out == told


def test_a_study_that_was_stopped_says_how_much_is_missing() -> None:
    found = study(60.0, 60.0)
    assert warnings(found)[0].startswith("8 of 10 seeds are missing")
    assert "over 2 seeds, too few for an interval" in answer(found)


def test_a_report_says_who_did_not_get_to_a_closed_road() -> None:
    (row,) = study(60.0).rows
    row = replace(row, outcomes=(row.outcomes[0], replace(row.outcomes[1], cut_short=1, kept_in=2)))
    closed = CongestionStudy(Path(), {}, PLAN, (row,))
    assert "1 trip ended before the closed road and 2 vehicles that start there did not drive." in answer(closed)
    told = warnings(closed)
    assert any("1 trip ended before the closed road" in each and "2 vehicles" in each for each in told)
