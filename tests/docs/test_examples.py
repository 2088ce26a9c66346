"""What stands in docs/examples is run: the hamlet is imported and driven through, the agent is evaluated."""

import json
import os
import runpy
import shutil
import subprocess
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml

from automotive_cosim.scenarios import load
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasks import CATALOGUE

TOP = Path(__file__).parents[2]
EXAMPLES = TOP / "docs/examples"
SCRIPT = TOP / ".github/actions/evaluate/evaluate.sh"
pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("sumo")]


def test_the_hamlet_is_imported_as_it_is_drawn_and_a_car_speeds_through_it(cli, tmp_path):
    assert cli("scenarios", "import", EXAMPLES / "hamlet.osm").code == 0
    report = json.loads((tmp_path / "hamlet/import.json").read_text(encoding="utf-8"))
    assert report["country"] == "FR"
    assert report["signals"] == 1
    assert load(tmp_path / "hamlet").ego.trips
    ran = cli("run", "--scenario", "hamlet", "--task", "road_speed_80_in_50", "--json")
    assert json.loads(ran.out)["success"] is True


@pytest.fixture
def evaluate(tmp_path, on_path):
    """The script, as a service would call it, on a copy of the example with a seed less."""
    shutil.copytree(EXAMPLES / "my-agent", tmp_path / "checkout")
    plan = tmp_path / "checkout/plan.toml"
    both = plan.read_text(encoding="utf-8")
    assert "seeds = [3, 4]" in both
    plan.write_text(both.replace("seeds = [3, 4]", "seeds = [4]"), encoding="utf-8")

    def run(*arguments):
        return subprocess.run(
            ["bash", SCRIPT, *arguments], cwd=tmp_path, capture_output=True, text=True, check=False
        )

    return run


def test_the_script_evaluates_an_agents_repository_and_fails_if_it_gets_worse(evaluate, tmp_path):
    first = evaluate("checkout", "checkout/plan.toml", "first")
    assert first.returncode == 0, first.stderr
    cases = ElementTree.parse(tmp_path / "first/compare.xml").findall(".//testcase")
    assert len(cases) == 3
    assert "unchanged" in (tmp_path / "first/compare.md").read_text(encoding="utf-8")
    won = sum(
        json.loads(row)["success"] for row in (tmp_path / "first/after/episodes.jsonl").read_text().splitlines()
    )
    assert won >= 2, "it solves most of its tasks"
    agent = tmp_path / "checkout/my_agent.py"
    whole = agent.read_text(encoding="utf-8")
    agent.write_text(whole.replace(', "fan": "Max"', ""), encoding="utf-8")
    assert agent.read_text(encoding="utf-8") != whole
    worse = evaluate("checkout", "checkout/plan.toml", "second", "first/after")
    assert worse.returncode == 1, worse.stderr
    assert ElementTree.parse(tmp_path / "second/compare.xml").findall(".//failure")
    assert "**Lost" in (tmp_path / "second/compare.md").read_text(encoding="utf-8")
    agent.write_text(
        "class Careful:\n    def reset(self, goal): raise ValueError('no config')\n    def act(self, seen): ...\n",
        encoding="utf-8",
    )
    alone = evaluate("checkout", "checkout/plan.toml", "third")
    assert alone.returncode == 1, alone.stderr
    told = (tmp_path / "third/compare.md").read_text(encoding="utf-8")
    assert "No agent succeeds, neither before nor after" in told
    errors = ElementTree.parse(tmp_path / "third/compare.xml").findall(".//error")
    assert len(errors) == 3
    assert all("ValueError: no config" in each.get("message") for each in errors)


def test_the_examples_seeds_say_each_word_that_its_agent_knows():
    """So that a deleted word turns it red."""
    known = runpy.run_path(str(EXAMPLES / "my-agent/my_agent.py"))["KNOWN"]
    plan = tomllib.loads((EXAMPLES / "my-agent/plan.toml").read_text(encoding="utf-8"))
    said = [draw(CATALOGUE[task], "first", seed).goal.lower() for task in plan["tasks"] for seed in plan["seeds"]]
    assert all(any([each for each in known if each in goal] == [word] for goal in said) for word in known)


def test_a_refused_second_start_names_the_scripts_argument_and_keeps_the_reports(evaluate, tmp_path):
    (tmp_path / "out").mkdir()
    kept = [tmp_path / "out" / name for name in ("compare.xml", "compare.md")]
    for each in kept:
        each.write_text("earlier", encoding="utf-8")
    (tmp_path / "checkout/my_agent.py").unlink()
    ran = evaluate("checkout", "checkout/plan.toml", "out")
    assert ran.returncode == 2
    assert "OUT out, the third argument" in ran.stderr
    assert [each.read_text(encoding="utf-8") for each in kept] == ["earlier", "earlier"]


@pytest.mark.parametrize(("code", "ends", "is_kept"), [(0, 0, True), (1, 0, True), (2, 0, False), (3, 3, True)])
def test_the_action_takes_a_base_that_cannot_be_evaluated_for_no_baseline(tmp_path, code, ends, is_kept):
    steps = yaml.safe_load(SCRIPT.with_name("action.yml").read_text(encoding="utf-8"))["runs"]["steps"]
    (step,) = [each for each in steps if each.get("name") == "Evaluate the base branch"]
    script = tmp_path / "evaluate.sh"
    script.write_text(f'#!/bin/bash\nmkdir -p "$3/after"\nexit {code}\n', encoding="utf-8")
    script.chmod(0o755)
    given = {"GITHUB_ACTION_PATH": str(tmp_path), "RUNNER_TEMP": str(tmp_path), "PLAN": "plan.toml"}
    ran = subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", step["run"]],
        cwd=tmp_path,
        env=os.environ | given,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == ends
    assert ("No baseline" in ran.stdout) == (code == 2)
    assert (tmp_path / "base").is_dir() == is_kept


def test_the_script_says_how_it_is_called(evaluate):
    ran = evaluate("checkout")
    assert ran.returncode == 2
    assert "evaluate.sh CHECKOUT PLAN OUT" in ran.stderr
