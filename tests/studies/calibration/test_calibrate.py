"""Calibrations of the grid: what the folder holds, what is refused, and a demand that cannot flow."""

import json
import shutil
from collections import Counter
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from automotive_cosim import scenarios
from automotive_cosim.cli.main import app
from automotive_cosim.errors import UserError
from automotive_cosim.scenarios.variant import check_demand
from automotive_cosim.studies.calibration import result
from automotive_cosim.studies.calibration.calibrate import calibrate
from automotive_cosim.studies.calibration.candidates import Candidate, Candidates, Passing, passes
from automotive_cosim.studies.calibration.driving import HOUR_S, CountedTime, DrivenDemand, drive, passed
from automotive_cosim.studies.calibration.page import by_hour, findings, label_places, write_page
from automotive_cosim.studies.calibration.result import RECORD, Calibration, Carried, Met, read_calibration
from automotive_cosim.studies.calibration.settings import CalibrationOptions
from automotive_cosim.studies.equilibrium.gap import DrivenTrip, EdgeTimes
from automotive_cosim.traffic.options import Configuration, Setup, copied, read_configuration, run_options

COUNTS = Path(__file__).parents[3] / "docs/examples/grid_counts.csv"

PROFILE = (
    *(0.12, 0.07, 0.05, 0.05, 0.09, 0.25, 0.6, 0.95, 1.0, 0.85, 0.75, 0.76),
    *(0.8, 0.78, 0.77, 0.85, 0.95, 1.0, 0.9, 0.7, 0.5, 0.4, 0.3, 0.2),
)
"""Traffic of each hour of a day, as a share of the busiest's."""


def trip(name: str, exits_s: tuple[float, ...], departed_s: float = 0.0) -> DrivenTrip:
    return DrivenTrip(name, "car", departed_s, ("a", "b", "c")[: len(exits_s)], exits_s)


def test_what_passes_is_what_leaves_the_edge_in_the_hour() -> None:
    clock = CountedTime(begin_s=0.0, warm_up_s=100.0, hours=2)
    found = passed([trip("x", (50.0, 150.0, 3800.0)), trip("y", (3699.0, 3700.0, -1.0))], clock)
    assert found == {("b", 0): 1, ("c", 1): 1, ("a", 0): 1, ("b", 1): 1}


def test_a_full_turn_is_where_the_queue_begins() -> None:
    """Everybody waits on a and b; on c nobody does, so b to c is full, and a to b only waits behind it."""
    trips = tuple(trip(str(number), (500.0, 1000.0, 1010.0)) for number in range(5))
    found = DrivenDemand(trips, {}, 0, 0, 0.0).full_turns(CountedTime(0.0, 0.0, 1), dict.fromkeys("abc", 10.0))
    assert found == {(("b", "c"), 0): 5}


def test_departures_of_an_hour_pass_in_it_and_in_the_next() -> None:
    """The end of b is a quarter of an hour from the start; what left in the warm-up passes in the first hour."""
    routes = Candidates.of([trip("x", (1.0, 2.0, 3.0))]).routes
    clock, free_s = CountedTime(0.0, 600.0, 2), {"a": 0.0, "b": 900.0, "c": 7200.0}
    times = EdgeTimes(free_s, ())
    wanted: dict[Passing, int] = {
        ("b", 0): 0,
        ("b", 1): 1,
        (("b", "c"), 1): 2,
        ("c", 0): 3,
        ("c", 1): 4,
        ("elsewhere", 0): 5,
    }
    found = passes(routes, wanted, times, free_s, clock)
    matrix = np.zeros((6, 2))
    np.add.at(matrix, (found.rows, found.columns), found.shares)
    assert matrix.tolist() == [[1, 0], [0.25, 0.75], [0.25, 0.75], [1, 0], [1, 0], [0, 0]]
    known = Candidates.of([trip("x", (1.0, 2.0, 3.0))])
    assert known.costs_s(times, free_s, clock).tolist() == [[8100], [8100]]


def test_routes_of_one_start_and_end_share_its_trips_by_their_times() -> None:
    found = Candidates.of([trip("x", (1.0, 2.0, 3.0)), trip("y", (1.0, 2.0, 3.0))])
    assert found.add(Candidate(("a", "d", "c"), ("car",), 0.0))
    assert not found.add(Candidate(("a", "b", "c"), ("car",), 0.0)), "it is known"
    equal = found.prior(np.array([[100.0, 100.0]]))[0]
    slower = found.prior(np.array([[100.0, 150.0]]))[0]
    assert equal.sum() == pytest.approx(1)
    assert equal[0] > equal[1] > slower[1] > 0


def test_a_gridlock_is_named() -> None:
    assert not Carried(1000, 10, 10, 100, 0.7).gridlock
    assert "teleported" in Carried(1000, 10, 11, 0, 0.0).gridlock
    assert "could not enter" in Carried(1000, 10, 0, 101, 0.0).gridlock
    assert "stood" in Carried(1000, 10, 0, 0, 0.8).gridlock


def test_totals_and_shares_of_what_is_met() -> None:
    found = Met.of([(100.0, 100.0), (300.0, 100.0)])
    assert (found.count, found.good, found.total) == (2, 1, 2.0)
    assert Met.of([]).share == 0


@pytest.fixture(scope="module")
def made(sumo: None, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Calibration]:
    target = tmp_path_factory.mktemp("calibrated") / "grid"
    times = target.with_name("times.csv")
    times.write_text("from_edge,to_edge,hour,seconds\ncwc0,c4ce,8,70\nnowhere,c4ce,8,70\n")
    options = CalibrationOptions(times=times, rounds=3)
    return target, calibrate(scenarios.load("grid"), COUNTS, target, options, lambda _said, _share: None)


@pytest.mark.slow
def test_the_simulation_carries_the_counts(made: tuple[Path, Calibration]) -> None:
    target, found = made
    calibrated, before = found.met(held_out=False), found.met(held_out=False, unfitted=True)
    assert calibrated.share >= 0.85
    assert calibrated.share > before.share
    assert calibrated.total == pytest.approx(1, abs=0.05)
    assert found.met(held_out=True).mean_geh < found.met(held_out=True, unfitted=True).mean_geh
    assert found.again.share >= 0.85, "and not only with this seed"
    assert read_calibration(target) == found
    sites = Counter(row.held_out for row in found.rows)
    assert sites[True] == round(0.3 * len(found.rows))
    assert all((row.fitted is None) == row.held_out for row in found.rows)


@pytest.mark.slow
def test_the_folder_carries_what_its_record_says(made: tuple[Path, Calibration], tmp_path: Path) -> None:
    target, found = made
    scenario = scenarios.load(target)
    configuration = read_configuration(scenario.config)
    options = run_options(copied(configuration, tmp_path), Setup(scenario, found.seed)) | {
        "step-length": "1",
        "default.action-step-length": "1",
    }
    driven = drive(scenario.name, options, CountedTime(configuration.begin_s, scenario.sumo.warm_up_s, 1), tmp_path)
    assert [driven.flows.get((row.edge, 0), 0) for row in found.rows] == [row.simulated for row in found.rows]
    assert len(driven.trips) + driven.backlog == found.carried.vehicles
    assert scenario.start.hour == 8
    assert scenario.sumo.background_rerouting == 0


@pytest.mark.slow
def test_the_page_tells_all_sites_and_times_and_a_fit_that_makes_held_out_sites_worse(
    made: tuple[Path, Calibration],
) -> None:
    target, found = made
    text = write_page(target).read_text(encoding="utf-8")
    assert all(row.site in text and row.edge in text for row in found.rows)
    assert found.times[0].simulated_s is not None
    assert found.times[1].simulated_s is None
    assert (target / "plots/map.svg").is_file()
    told = "\n".join(findings(found))
    for word in (
        "held out, before the fit",
        "teleports",
        "travel times",
        "do not determine the demand",
        "with seed 1",
    ):
        assert word in told
    assert not found.is_worse_elsewhere
    assert "pill good" in text
    rows = tuple(replace(row, simulated=row.counted + 5000.0) if row.held_out else row for row in found.rows)
    worse = replace(found, rows=rows)
    before, count = worse.met(held_out=True, unfitted=True).good, worse.met(held_out=True).count
    assert f"{before} before, 0 after, of {count}" in "\n".join(findings(worse))
    record = target / "calibration.json"
    kept = record.read_bytes()
    record.write_text(json.dumps(worse.record()), encoding="utf-8")
    assert "pill good" not in write_page(target).read_text(encoding="utf-8")
    record.write_bytes(kept)


def test_names_of_sites_do_not_overlap_on_the_map() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure
    from matplotlib.text import Text

    axes = Figure(figsize=(7, 6)).add_subplot()
    axes.plot([0, 500], [0, 500])
    places = [(100.0 + number % 4, 100.0 + number) for number in range(12)]
    label_places(axes, [(f"site {number}", place, "k") for number, place in enumerate(places)])
    boxes = [Text.get_window_extent(each) for each in axes.texts]
    assert len(boxes) == len(places)
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


@pytest.mark.slow
@pytest.mark.parametrize("hours", [range(7, 10), pytest.param(range(24), marks=pytest.mark.proof)])
def test_a_day_is_calibrated_hour_by_hour(
    sumo: None, tmp_path: Path, hours: range, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tenth of the example's counts with the profile of a day; the grid's traffic, also a tenth, has none."""
    monkeypatch.setattr("automotive_cosim.studies.calibration.page.MANY_HOURS", 2)
    counts = tmp_path / "day.csv"
    sites = [line.split(",") for line in COUNTS.read_text().splitlines()[1:]]
    lines = [
        f"{site},{hour},{float(flow) * share / 10:.0f},{edge}"
        for site, counted, flow, edge in sites
        if counted == "8"
        for hour in hours
        for share in [PROFILE[hour]]
    ]
    counts.write_text("\n".join(["site,hour,vehicles_per_hour,edge", *lines]))
    grid = scenarios.load("grid")
    calm = replace(grid, sumo=replace(grid.sumo, scale=0.1))
    target = tmp_path / "out"
    options = CalibrationOptions(rounds=2, at_hour=8)
    found = calibrate(calm, counts, target, options, lambda _said, _share: None)
    assert found.hours == tuple(hours)
    assert found.met(held_out=False).mean_geh < 1 < found.met(held_out=False, unfitted=True).mean_geh
    for hour in hours:
        rows = [row for row in found.rows if row.hour == hour and not row.held_out]
        counted = sum(row.counted for row in rows)
        assert sum(row.simulated for row in rows) == pytest.approx(counted, rel=0.1, abs=10), hour
    scenario = scenarios.load(target)
    assert scenario.start.hour == 8
    assert read_configuration(scenario.config).begin_s == (8 - hours[0]) * HOUR_S
    page = write_page(target).read_text(encoding="utf-8")
    assert "Hour by hour" in page
    assert (target / "plots/day.svg").is_file()
    assert len(by_hour(found).rows) == 2 * len(hours)


@pytest.mark.slow
def test_a_fit_that_gridlocks_is_an_error_and_writes_nothing(
    sumo: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Traffic in which every vehicle that waits is too many."""
    monkeypatch.setattr(result, "BACKLOG_SHARE", -1.0)
    out = tmp_path / "out"
    words = [
        "scenarios",
        "calibrate",
        "grid",
        "--counts",
        str(COUNTS),
        "--out",
        str(out),
        "--rounds",
        "1",
        "--json",
    ]
    ran = CliRunner().invoke(app, words)
    assert ran.exit_code == 1
    assert "gridlocks: " in ran.stderr
    assert json.loads(ran.stdout)["out"] is None
    assert not out.exists()


def test_what_cannot_be_calibrated_is_refused_before_anything_runs(tmp_path: Path) -> None:
    grid = scenarios.load("grid")
    counts = tmp_path / "counts.csv"
    counts.write_text("site,hour,vehicles_per_hour,edge\na,8,10,nowhere\na,10,10,nowhere\n")

    def attempt(target: Path = tmp_path / "out", **options: object) -> None:
        calibrate(grid, counts, target, CalibrationOptions(**options), lambda _said, _share: None)  # type: ignore[arg-type]

    with pytest.raises(UserError, match="no counts of 9 h"):
        attempt()
    with pytest.raises(UserError, match="no counts of 11 h"):
        attempt(hours=(10, 11))
    with pytest.raises(UserError, match="--at 8 is not one of the calibrated hours"):
        attempt(hours=(10, 10), at_hour=8)
    with pytest.raises(UserError, match=r"no site could be placed.*\na: the network has no edge"):
        attempt(hours=(8, 8))
    (tmp_path / "full").mkdir()
    (tmp_path / "full/mine.txt").touch()
    with pytest.raises(UserError, match="exists; give --out"):
        attempt(tmp_path / "full", hours=(8, 8))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("hours", ["9-8", "24", "morning", "-1"])
def test_hours_are_first_and_last(hours: str) -> None:
    ran = CliRunner().invoke(app, ["scenarios", "calibrate", "grid", "--counts", str(COUNTS), f"--hours={hours}"])
    assert ran.exit_code
    assert "is not FIRST-LAST" in str(ran.exception)


def test_no_folder_is_replaced(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(scenarios.load("grid").folder, folder)
    with pytest.raises(UserError, match="exists"):
        calibrate(scenarios.load("grid"), COUNTS, folder, CalibrationOptions(), lambda _said, _share: None)
    assert not (folder / RECORD).exists()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"route-files": {"cars": "<trip/>", "buses": "<vehicle><stop/></vehicle>", "walks": "<person/>"}},
            "buses.xml has <stop> and walks.xml has <person>: .* copy of .*my.sumocfg, name only cars.xml as route",
        ),
        (
            {"route-files": {"all": "<trip/><vehicle><stop/></vehicle>"}},
            "put the vehicles without stops into a route",
        ),
        (
            {"additional-files": {"loops": "<e1Detector/>", "bus": "<flow/>"}},
            "name only loops.xml as additional-files",
        ),
        ({"additional-files": {"bus": "<flow/>"}}, "leave out additional-files"),
    ],
)
def test_a_demand_with_buses_is_told_which_files_to_leave_out(given, words, tmp_path):
    files = {}
    for option, texts in given.items():
        for name, text in texts.items():
            (tmp_path / f"{name}.xml").write_text(f"<routes>{text}</routes>")
        files[option] = tuple(tmp_path / f"{name}.xml" for name in texts)
    with pytest.raises(UserError, match=words):
        check_demand(Configuration(tmp_path / "my.sumocfg", tmp_path / "net.xml", files=files))


def test_a_demand_of_cars_is_taken(tmp_path):
    (tmp_path / "cars.xml").write_text("<routes><trip/></routes>")
    check_demand(
        Configuration(
            tmp_path / "my.sumocfg", tmp_path / "net.xml", files={"route-files": (tmp_path / "cars.xml",)}
        )
    )
