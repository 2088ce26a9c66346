"""Errors that a user can fix: one line that says what came, exit code 2, no traceback, nothing left behind."""

import json
import re
import shutil

import pytest

from automotive_cosim.scenarios import load

ACTION = '{"action_type": "navigate_home"}\n'


def _assert_refused(ran, *words):
    assert ran.code == 2
    assert ran.out == ""
    lines = ran.err.splitlines()
    assert len(lines) == 1, ran.err
    assert lines[0].startswith("error: ")
    for word in words:
        assert word in lines[0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--task", "road_speed_80_in_5"], ["road_speed_80_in_5'", "did you mean 'road_speed_80_in_50'"]),
        (["--task", "x" * 1000], ["x" * 80 + "…'", "List them with"]),
        (["--half", "secnd"], ["secnd", "did you mean 'second'"]),
        (["--task", "hvac_fan_max", "--half", "second"], ["second", "first"]),
        (["--agent", "asurda"], ["asurda", "did you mean 'asurada'"]),
        (["--model", "rule"], ["rule", "did you mean 'rules'"]),
        (["--scenario", "gird"], ["gird", "did you mean 'grid'"]),
        (["--scenario", "."], ["scenario.toml"]),
        (["--scenario", ""], ["--scenario is empty"]),
        (["--seed", "-1"], ["--seed", "-1"]),
        (["--seed", "one"], ["--seed", "one"]),
        (["--actions", "nowhere.jsonl"], ["nowhere.jsonl"]),
        (["--taks", "x"], ["--taks"]),
        (["surplus"], ["surplus"]),
        (["--drive", "grid_june", "--no-gps"], ["--no-gps is about a task; omit it with --drive"]),
        (["--errands"], ["--errands is about a drive; give --drive"]),
        (["--drive", "grid_joon"], ["did you mean 'grid_june'"]),
    ],
)
def test_a_wrong_argument_is_one_line(cli, tmp_path, arguments, words):
    _assert_refused(cli("run", *arguments), *words)
    assert not list(tmp_path.iterdir())


def test_a_row_of_an_episode_that_was_not_planned_is_not_replayed(cli, tmp_path):
    manifest = {"format": 1, "plan": {"agents": ["oracle"], "tasks": ["hvac_fan_max"]}, "starts": []}
    row = dict(id="own-1", task="hvac_fan_max", half="first", pair="", dimension="explicit_control", module="hvac",
               scenario="grid", agent="oracle", model="none", conditions={}, seed=0, repeat=0)  # fmt: skip
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    (tmp_path / "episodes.jsonl").write_text(json.dumps(row) + "\n")
    _assert_refused(cli("replay", ".", "own"), "manifest.json has no episode own-1")
    for command in (["report", "."], ["compare", ".", "."], ["publish", "regrade", "."]):
        for text in ("{}", '{"format": 1}', '{"format": 1, "plan": 3}', "[" * 10_000):
            (tmp_path / "manifest.json").write_text(text)
            _assert_refused(cli(*command))


def test_a_trial_that_version_0_2_recorded_is_refused(cli, tmp_path):
    (tmp_path / "steps.jsonl").touch()
    (tmp_path / "episode.json").write_text("{}")
    _assert_refused(cli("replay", "."), "version 0.2 or an earlier one recorded it", "record the run again")


@pytest.mark.parametrize("arguments", [["rnu"], ["--verson"], ["tasks", "show", "hvac_fan_mix"], ["tasks", "lst"]])
def test_so_is_a_wrong_command(cli, arguments):
    _assert_refused(cli(*arguments))


@pytest.mark.parametrize("line", ["{", "[]", '{"action_type": "clik"}', '{"action_type": "click"}'])
def test_a_malformed_action_is_refused_before_anything_runs(cli, tmp_path, line):
    (tmp_path / "actions.jsonl").write_text(ACTION + line + "\n", encoding="utf-8")
    _assert_refused(cli("run", "--actions", "actions.jsonl"), "actions.jsonl, line 2")
    assert [path.name for path in tmp_path.iterdir()] == ["actions.jsonl"]


def test_a_folder_that_is_not_empty_is_left_alone(cli, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.txt").write_text("mine", encoding="utf-8")
    _assert_refused(cli("run", "--out", "out"), "out is not empty", "--force")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["thesis.txt"]


def test_a_file_is_no_folder(cli, tmp_path):
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    _assert_refused(cli("run", "--out", "out"), "out is a file")
    _assert_refused(cli("run", "--out", "out/below"), "out")
    assert (tmp_path / "out").read_text(encoding="utf-8") == "mine"


def test_a_folder_that_cannot_be_made_is_told_before_anything_runs(cli):
    _assert_refused(cli("run", "--out", "/proc/x"), "cannot write to /proc")


@pytest.mark.parametrize(
    ("content", "words"), [("", ["lacks"]), ("name = ", ["not TOML"]), (b"\xff\xfe", ["not UTF-8 text"])]
)
def test_a_broken_scenario_is_named(cli, tmp_path, content, words):
    folder = tmp_path / "mine"
    folder.mkdir()
    data = content if isinstance(content, bytes) else content.encode()
    (folder / "scenario.toml").write_bytes(data)
    _assert_refused(cli("run", "--scenario", "mine"), "scenario.toml", *words)
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_every_problem_of_a_scenario_is_a_line(cli, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "scenario.toml").write_text('nmae = "x"', encoding="utf-8")
    ran = cli("run", "--scenario", "mine")
    assert (ran.code, ran.out) == (2, "")
    missing, unknown = ran.err.splitlines()
    assert missing.startswith("error: mine/scenario.toml lacks 'name', 'title',")
    assert unknown == "error: mine/scenario.toml line 1: no field named 'nmae': did you mean 'name'?"


@pytest.mark.sumo
def test_a_network_without_projection_is_refused(cli, tmp_path):
    folder = tmp_path / "flat"
    shutil.copytree(load("grid").folder, folder)
    net = folder / "grid.net.xml"
    text = re.sub(r'projParameter="[^"]*"', 'projParameter="!"', net.read_text(encoding="utf-8"))
    net.write_text(text, encoding="utf-8")
    _assert_refused(cli("run", "--json", "--task", "hvac_fan_max", "--scenario", "flat"), "projection")
    assert [path.name for path in tmp_path.iterdir()] == ["flat"]


def test_debug_shows_the_traceback(cli, monkeypatch):
    monkeypatch.setenv("AUTOMOTIVE_COSIM_DEBUG", "1")
    from automotive_cosim.cli import main as module
    from automotive_cosim.errors import UnknownNameError

    monkeypatch.setattr("sys.argv", ["automotive-cosim", "run", "--task", "nope"])
    with pytest.raises(UnknownNameError):
        module.main()


def test_json_prints_nothing_on_stdout_when_refused(cli):
    ran = cli("run", "--json", "--task", "nope")
    _assert_refused(ran)
    with pytest.raises(json.JSONDecodeError):
        json.loads(ran.out)
