"""``scenarios show | check | render`` and the options of ``run`` that choose place and way."""

import json
import re
import shutil
from pathlib import Path

import pytest
from PIL import Image

from automotive_cosim.scenarios import load

RUN = ("run", "--json", "--task", "hvac_fan_max")


def _refused(ran, *words):
    assert ran.code == 2
    assert ran.out == ""
    assert len(ran.err.splitlines()) == 1, ran.err
    for word in words:
        assert word in ran.err


def _episode(ran):
    assert ran.code == 0, ran.err
    return json.loads(ran.out)


@pytest.fixture
def flat(tmp_path):
    """The grid without projection."""
    folder = tmp_path / "flat"
    shutil.copytree(load("grid").folder, folder)
    net = folder / "grid.net.xml"
    net.write_text(re.sub(r'projParameter="[^"]*"', 'projParameter="!"', net.read_text(encoding="utf-8")))
    return folder


@pytest.mark.sumo
def test_no_gps_runs_to_the_end_with_map_film_and_page(cli, flat, tmp_path):
    result = _episode(cli(*RUN, "--scenario", flat, "--no-gps", "--out", "out"))
    assert result["success"]
    for name in ("trial.json", "steps.jsonl", "episode.webp", "summary.html"):
        assert 1000 < (tmp_path / "out" / name).stat().st_size < 5e6
    with Image.open(tmp_path / "out/episode.webp") as film:
        assert film.size == (960, 540)
        assert film.n_frames > result["steps"] + 1
    steps = [json.loads(line) for line in (tmp_path / "out" / "steps.jsonl").read_text().splitlines()]
    assert all(step["gps"] is None for step in steps)
    assert all(step["context"].startswith("Place: unknown") for step in steps)
    assert json.loads((tmp_path / "out" / "trial.json").read_text())["manifest"]["setup"]["gps"] is False


@pytest.mark.usefixtures("warm")
def test_a_plain_network_runs_and_says_what_was_assumed(cli, flat):
    ran = cli(*RUN, "--scenario", flat / "grid.net.xml")
    result = _episode(ran)
    assert result["scenario"] == "grid"
    notes = ran.err.splitlines()
    assert len(notes) == 2
    assert all(note.startswith("note: ") for note in notes)
    assert "without GPS" in ran.err
    assert "no traffic of its own" in ran.err


@pytest.mark.usefixtures("warm")
def test_origin_and_places(cli):
    here = _episode(cli(*RUN, "--scenario", "grid"))
    there = _episode(cli(*RUN, "--scenario", "grid", "--origin", "-3.7,40.4"))
    assert here["trace_sha256"] != there["trace_sha256"]
    ran = cli(
        "run", "--task", "hvac_fan_max", "--scenario", "grid", "--origin", "151.2,-33.9", "--from", "kings drive"
    )
    assert ran.code == 0, ran.err
    assert "traffic keeps" not in ran.out
    assert "loading the network" in ran.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--origin", "9"), ("--origin '9'", "9.19,45.46")),
        (("--origin", "a,b"), ("--origin 'a,b'",)),
        (("--origin", "9,91"), ("'9,91' is not a position on earth",)),
        (("--from", "Avenue Central"), ("did you mean 'Avenue Centrale'",)),
        (("--to", "2.35,48.86"), ("km from the nearest road",)),
        (("--scenario", "nowhere.sumocfg"), ("there is no file nowhere.sumocfg",)),
    ],
)
def test_a_place_that_is_none_is_one_line(cli, tmp_path, arguments, words):
    scenario = () if "--scenario" in arguments else ("--scenario", "grid")
    _refused(cli(*RUN, *scenario, *arguments), *words)
    assert not list(tmp_path.iterdir())


def test_show_takes_any_scenario(cli, flat):
    ran = cli("scenarios", "show", flat / "grid.net.xml")
    assert ran.code == 0
    assert "country  unknown" in ran.out
    assert "without GPS" in ran.err
    assert "drawn by seed from the climate" in cli("scenarios", "show", load("grid").folder / "grid.net.xml").out


def test_show_names_edges_by_street_and_lists_all(cli):
    told = cli("scenarios", "show", "grid").out
    assert "edges    56 edges open to cars, on 8 named streets; the longest:" in told
    assert "Avenue Centrale: c0c1, c0cw, c1c0, c1c2, c2c1, c2c3 and 6 more" in told
    assert told.count("\n") < 30
    listed = json.loads(cli("scenarios", "show", "grid", "--json").out)
    assert (listed["edge_count"], len(listed["edges"])) == (56, 56)
    known = {edge["id"]: (edge["street"], round(edge["length_m"]), edge["road_class"]) for edge in listed["edges"]}
    assert known["c0c1"] == ("Avenue Centrale", 186, "primary")


@pytest.mark.sumo
def test_check_prints_every_item(cli):
    ran = cli("scenarios", "check", "grid", "--quick")
    assert ran.code == 0
    assert "grid holds: yes" in ran.out
    for word in ("loads", "place", "roads", "trip avenue", "street Rue du Nord"):
        assert word in ran.out


@pytest.mark.sumo
def test_check_ends_with_1_if_something_fails(cli, flat):
    ran = cli("scenarios", "check", "--quick", "--json", flat, "grid")
    assert ran.code == 1
    found = json.loads(ran.out)
    assert found["ok"] is False
    assert [scenario["ok"] for scenario in found["scenarios"]] == [False, True]
    assert "has no projection" in found["scenarios"][0]["checks"][0]["detail"]
    _refused(cli("scenarios", "check", "gird"), "did you mean 'grid'")


def test_render_writes_where_it_says(cli, tmp_path):
    told = cli("scenarios", "render", "grid").out
    assert told == f"{Path('runs/maps/grid.webp')} written\n"
    assert (tmp_path / "runs/maps/grid.webp").is_file()
    assert [path.name for path in tmp_path.iterdir()] == ["runs"]


def test_render_writes_a_picture_for_each(cli, tmp_path):
    ran = cli("scenarios", "render", "grid", "border", "--out", "pictures")
    assert ran.code == 0
    assert sorted(path.name for path in (tmp_path / "pictures").iterdir()) == ["border.webp", "grid.webp"]
    assert cli("scenarios", "render", "grid", "--out", "one.png").code == 0
    with Image.open(tmp_path / "one.png") as picture:
        assert picture.width > 600


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("grid", "--out", "x.jpg"), ("x.jpg", ".webp or .png")),
        (("grid", "border", "--out", "x.png"), ("x.png", "a folder")),
        (("gird",), ("did you mean 'grid'",)),
    ],
)
def test_a_picture_that_cannot_be_is_one_line(cli, tmp_path, arguments, words):
    _refused(cli("scenarios", "render", *arguments), *words)
    assert not list(tmp_path.iterdir())
