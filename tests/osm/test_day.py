"""A day of traffic scaled to the counts of one road, on the village's main street."""

from __future__ import annotations

import gzip
import re
import shutil
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from datetime import time
from html import unescape
from pathlib import Path

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.scenarios import app
from automotive_cosim.errors import CountsError, ImportMapError, ScenarioError, UnknownNameError, UserError
from automotive_cosim.osm import ImportReport, day
from automotive_cosim.osm.day import DayOptions, make_day, read_day
from automotive_cosim.osm.demand import fastest_ways
from automotive_cosim.report.day import findings, write_day
from automotive_cosim.scenarios import load
from automotive_cosim.traffic import stability
from automotive_cosim.traffic.network import read_network

Imported = tuple[Path, ImportReport]

COUNTED = [
    40,
    30,
    20,
    20,
    30,
    60,
    120,
    200,
    240,
    220,
    200,
    200,
    210,
    200,
    190,
    200,
    220,
    240,
    250,
    220,
    160,
    110,
    80,
    60,
]
"""Vehicles per hour of a street in a village."""

QUICK = 10.0
"""Minutes of each hour."""


def _counts(folder: Path, flows: Sequence[float] = COUNTED) -> Path:
    rows = [f"{hour},{flow},{flow / 20}" for hour, flow in enumerate(flows)]
    path = folder / "counts.csv"
    path.write_text("\n".join(["hour,vehicles_per_hour,occupancy", *rows]), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def street(imported: Imported) -> str:
    """An edge of the main street, eastbound, beyond the crossroads."""
    network = read_network(next(imported[0].glob("*.net.xml.gz")))
    named = [edge for edge in network.edges.values() if edge.name == "Rue de l'Église" and edge.length_m > 100]
    return max(
        (edge for edge in named if edge.shape_m[-1][0] > edge.shape_m[0][0]), key=lambda edge: edge.shape_m[0][0]
    ).edge_id


@pytest.fixture(scope="module")
def made(imported: Imported, street: str, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, day.Day]:
    folder = tmp_path_factory.mktemp("day")
    options = DayOptions(edge=street, days=3, minutes=QUICK, at_hour=18)
    return folder / "out", make_day(imported[0], _counts(folder), folder / "out", options)


def _trips(folder: Path) -> list[ET.Element]:
    return list(ET.fromstring(gzip.decompress((folder / day.TRIPS).read_bytes())).iter("trip"))


def test_the_counted_road_carries_what_was_counted(made: tuple[Path, day.Day]) -> None:
    folder, found = made
    assert [each.counted_per_h for each in found.hours] == COUNTED
    assert found.hours_met >= 20
    assert max(found.met) == found.hours_met
    assert found.hours[18].simulated_occupancy > found.hours[3].simulated_occupancy > 0
    assert found.hours[18].counted_occupancy == pytest.approx(0.125)
    assert read_day(folder) == found


def test_the_demand_covers_the_day_hour_by_hour(made: tuple[Path, day.Day], street: str) -> None:
    folder, found = made
    trips = _trips(folder)
    departs = [float(trip.get("depart", "")) for trip in trips]
    assert departs == sorted(departs)
    assert departs[0] >= 0
    assert departs[-1] < 24 * 3600
    others = Counter(
        int(float(t.get("depart", "")) // 3600) for t in trips if street not in (t.get("via"), t.get("from"))
    )
    assert [others[each.hour] for each in found.hours] == [each.background for each in found.hours]
    assert others[18] == max(others.values()), "the others follow the counted road's profile"
    past = Counter(
        int(float(t.get("depart", "")) // 3600) for t in trips if street in (t.get("via"), t.get("from"))
    )
    assert sum(past.values()) == sum(each.passing for each in found.hours)
    # They set out a little earlier than they pass, by some minutes.
    assert all(abs(past[each.hour] - each.passing) <= 0.2 * each.passing + 10 for each in found.hours)


def test_it_is_a_scenario_that_runs_at_its_hour(made: tuple[Path, day.Day], imported: Imported) -> None:
    scenario = load(made[0])
    assert scenario.start.time() == time(18)
    assert scenario.ego.trips == load(imported[0]).ego.trips
    run = stability.measure(scenario, observe_s=120)
    assert run.vehicles_mean > 3
    config = (made[0] / scenario.sumo.config).read_text(encoding="utf-8")
    assert f'<begin value="{18 * 3600 - scenario.sumo.warm_up_s}"/>' in config
    assert "no calibration" in (made[0] / "README.md").read_text(encoding="utf-8")


def test_the_same_again_is_the_same_and_another_seed_another(
    imported: Imported, street: str, tmp_path: Path
) -> None:
    counts = _counts(tmp_path)
    before = {path.name: path.stat().st_mtime_ns for path in imported[0].iterdir()}
    made = [
        make_day(imported[0], counts, tmp_path / f"{number}", DayOptions(street, days=1, minutes=5, seed=seed))
        for number, seed in enumerate((1, 1, 2))
    ]
    assert made[0] == made[1]
    assert made[0] != made[2]
    for file in (day.TRIPS, day.DAY_FILE, "scenario.toml"):
        assert (tmp_path / "0" / file).read_bytes() == (tmp_path / "1" / file).read_bytes()
    assert {path.name: path.stat().st_mtime_ns for path in imported[0].iterdir()} == before


def test_a_way_means_all_its_edges_in_its_direction(imported: Imported) -> None:
    network = read_network(next(imported[0].glob("*.net.xml.gz")))
    piece = next(name for name in network.edges if name.startswith("-") and name.endswith("#2"))
    way = piece.split("#")[0]
    found = [edge.edge_id for edge in day._counted(network, way)]
    assert piece in found
    assert len(found) > 2
    assert all(name.startswith(f"{way}#") for name in found)
    assert [edge.edge_id for edge in day._counted(network, piece)] == [piece]


def test_what_cannot_be_done_is_said_in_one_line(imported: Imported, street: str, tmp_path: Path) -> None:
    counts, out = _counts(tmp_path), tmp_path / "out"
    with pytest.raises(UnknownNameError, match="no edge or OpenStreetMap way named '1O2'"):
        make_day(imported[0], counts, out, DayOptions("1O2"))
    with pytest.raises(ScenarioError, match="has no trips; give a folder that"):
        make_day(Path(str(load("grid").folder)), counts, out, DayOptions("cwc0"))
    with pytest.raises(CountsError, match="cannot be read"):
        make_day(imported[0], tmp_path / "nowhere.csv", out, DayOptions(street))
    lonely, elsewhere = _with_one_trip(imported[0], tmp_path / "lonely")
    with pytest.raises(CountsError, match=re.escape(f"none of the 1 trips of {lonely} passes {elsewhere} on its")):
        make_day(lonely, counts, out, DayOptions(elsewhere))
    assert not out.exists()
    out.mkdir()
    with pytest.raises(ImportMapError, match="exists"):
        make_day(imported[0], counts, out, DayOptions(street))
    with pytest.raises(ScenarioError, match=r"day\.json is not what"):
        read_day(out)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["counts.csv", "lonely", "out"]


def _with_one_trip(source: Path, target: Path) -> tuple[Path, str]:
    """The scenario with no more than one trip, and an edge that lies on another one's way."""
    shutil.copytree(source, target)
    network = read_network(net := next(target.glob("*.net.xml.gz")))
    file = next(target.glob("*.trips.xml.gz"))
    routes = ET.fromstring(gzip.decompress(file.read_bytes()))
    only, *rest = routes.iter("trip")
    ends = [(network.edges[only.get("from", "")], network.edges[only.get("to", "")])]
    (way,) = fastest_ways(ends, network, net, target)
    for trip in rest:
        routes.remove(trip)
    file.write_bytes(gzip.compress(ET.tostring(routes)))
    return target, next(name for name in network.edges if name not in {edge.edge_id for edge in way})


def test_the_page_says_what_holds_and_that_it_is_no_calibration(made: tuple[Path, day.Day]) -> None:
    folder, found = made
    page = write_day(folder).read_text(encoding="utf-8")
    assert "no calibration" in page
    assert page.count("<svg ") == 6
    for line in findings(found):
        assert line in unescape(page)
    rows = (folder / "tables" / "hours.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 25
    assert rows[19].startswith(f"18 h,250,{found.hours[18].simulated_per_h:.0f},")
    assert {path.name for path in (folder / "plots").iterdir()} == {"flow.svg", "occupancy.svg", "geh.svg"}


def test_an_evening_that_is_no_fuller_than_the_morning_is_said_to_be_so(made: tuple[Path, day.Day]) -> None:
    found = made[1]
    for morning, evening, word in ((0.1, 0.2, "is above"), (0.2, 0.2, "is not above"), (0.2, 0.1, "is not above")):
        hours = list(found.hours)
        hours[8] = replace(hours[8], simulated_occupancy=morning)
        hours[18] = replace(hours[18], simulated_occupancy=evening)
        assert (
            f"At 18 h the simulated occupancy {word} that at 8 h" in findings(replace(found, hours=tuple(hours)))[1]
        )


def test_the_command_prints_the_hours_and_leaves_a_page(imported: Imported, street: str, tmp_path: Path) -> None:
    arguments = ["day", str(imported[0]), "--counts", str(_counts(tmp_path)), "--edge", street]
    arguments += ["--out", str(tmp_path / "out"), "--minutes", "5", "--days", "1"]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.output
    assert "GEH is below 5 in" in done.stdout
    assert "no calibration" in done.stdout
    assert (tmp_path / "out" / "day.html").is_file()
    again = CliRunner().invoke(app, arguments)
    assert isinstance(again.exception, UserError)
    wrong = CliRunner().invoke(app, [*arguments, "--at", "24"])
    assert wrong.exit_code == 2
