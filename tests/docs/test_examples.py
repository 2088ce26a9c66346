"""What stands in docs/examples is run: the hamlet is imported and driven through, the agent is evaluated."""

import json
import os
import re
import runpy
import shlex
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


STUB = """#!/bin/bash
echo "$PWD" "$@" >> "$CALLS"
case $1 in eval) exit $EVAL;; compare) exit $COMPARE;; esac
"""
"""Notes what it is asked for, in the place of the program."""


@pytest.fixture
def script(tmp_path, cli, monkeypatch):
    """The script that ``ci init`` writes, as a service would call it, on a copy of the example with one task and
    seed: how it ended, and what it asked the program for, in which folder."""
    shutil.copytree(EXAMPLES / "my-agent", tmp_path / "checkout", ignore=shutil.ignore_patterns(".github"))
    plan = tmp_path / "checkout/plan.toml"
    whole = plan.read_text(encoding="utf-8")
    one = whole.replace("seeds = [3, 4]", "seeds = [4]").replace(
        ', "hvac_driver_seat_heater", "hvac_cold_hands"', ""
    )
    assert len(one) < len(whole) - 40
    plan.write_text(one, encoding="utf-8")
    with monkeypatch.context() as patch:
        patch.chdir(tmp_path / "checkout")
        assert cli("ci", "init").code == 0
    stub, calls = tmp_path / "bin/automotive-cosim", tmp_path / "calls"
    stub.parent.mkdir()
    stub.write_text(STUB, encoding="utf-8")
    stub.chmod(0o755)

    def run(*words, evaluates=0, compares=0):
        calls.write_text("")
        given = {"CALLS": str(calls), "EVAL": str(evaluates), "COMPARE": str(compares)}
        path = f"{stub.parent}{os.pathsep}{os.environ['PATH']}"
        ended = subprocess.run(
            ["bash", "checkout/ci/evaluate.sh", *words],
            cwd=tmp_path,
            env={**os.environ, **given, "PATH": path},
            capture_output=True,
            text=True,
            check=False,
        )
        return ended, [shlex.split(line) for line in calls.read_text().splitlines()]

    return run


def test_the_script_evaluates_an_agents_repository_and_fails_if_it_gets_worse(script, cli, tmp_path, monkeypatch):
    def performed(out, *words):
        """The exit codes of what the script asks for, which it is told, and its own; and the reports."""
        words = ("checkout", "checkout/plan.toml", out, *words)
        _, calls = script(*words)
        codes = []
        for folder, *asked in calls:
            monkeypatch.chdir(folder)
            codes.append(cli(*asked).code)
        cases = ElementTree.parse(tmp_path / out / "compare.xml")
        told = (tmp_path / out / "compare.md").read_text(encoding="utf-8")
        return (*codes, script(*words, evaluates=codes[0], compares=codes[1])[0].returncode), cases, told

    codes, cases, told = performed("first")
    assert (codes, len(cases.findall(".//testcase"))) == ((0, 0, 0), 1)
    assert "unchanged" in told
    agent = tmp_path / "checkout/my_agent.py"
    whole = agent.read_text(encoding="utf-8")
    agent.write_text(whole.replace(', "fan": "Max"', ""), encoding="utf-8")
    assert agent.read_text(encoding="utf-8") != whole
    codes, cases, told = performed("second", "first/after")
    assert (codes, len(cases.findall(".//failure"))) == ((0, 1, 1), 1)
    assert "**Lost" in told
    agent.write_text(
        "class Careful:\n    def reset(self, goal): raise ValueError('no config')\n    def act(self, seen): ...\n",
        encoding="utf-8",
    )
    codes, cases, told = performed("third")
    assert codes == (1, 0, 1)
    assert "No agent succeeds, neither before nor after" in told
    (error,) = cases.findall(".//error")
    assert "ValueError: no config" in error.get("message")


def test_a_refused_second_start_names_the_scripts_argument_and_keeps_the_reports(script, tmp_path):
    (tmp_path / "out").mkdir()
    kept = [tmp_path / "out" / name for name in ("compare.xml", "compare.md")]
    for each in kept:
        each.write_text("earlier", encoding="utf-8")
    ran, calls = script("checkout", "checkout/plan.toml", "out", evaluates=2)
    assert (ran.returncode, len(calls)) == (2, 1)
    assert "OUT out, the third argument" in ran.stderr
    assert [each.read_text(encoding="utf-8") for each in kept] == ["earlier", "earlier"]


def test_the_examples_seeds_say_each_word_that_its_agent_knows():
    """So that a deleted word turns it red."""
    known = runpy.run_path(str(EXAMPLES / "my-agent/my_agent.py"))["KNOWN"]
    plan = tomllib.loads((EXAMPLES / "my-agent/plan.toml").read_text(encoding="utf-8"))
    said = [draw(CATALOGUE[task], "first", seed).goal.lower() for task in plan["tasks"] for seed in plan["seeds"]]
    assert all(any([each for each in known if each in goal] == [word] for goal in said) for word in known)


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


def test_ci_init_leaves_nothing_to_fill_in_and_overwrites_nothing(script, cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path / "checkout")
    workflow, written = Path(".github/workflows/evaluate.yml"), Path("ci/evaluate.sh")
    text = workflow.read_text(encoding="utf-8")
    assert not re.search(r"@[A-Z]+@|OWNER|TODO", text)
    steps = yaml.safe_load(text)["jobs"]["evaluate"]["steps"]
    assert all("run" in each or "uses" in each for each in steps)
    assert sum("ci/evaluate.sh" in each.get("run", "") for each in steps) == 2
    assert written.read_text(encoding="utf-8") == SCRIPT.read_text(encoding="utf-8")
    written.unlink()
    workflow.write_text("mine", encoding="utf-8")
    refused = cli("ci", "init")
    assert (refused.code, workflow.read_text(encoding="utf-8"), written.exists()) == (2, "mine", False)
    assert "evaluate.yml exists, and nothing is overwritten" in refused.err
    assert cli("ci", "init", "none.toml").code == 2


def test_the_script_says_how_it_is_called(script):
    ran, calls = script("checkout")
    assert (ran.returncode, calls) == (2, [])
    assert "evaluate.sh CHECKOUT PLAN OUT" in ran.stderr
