"""Agents, their switches and their memory on the command line."""

import io
import json
from pathlib import Path

import pytest

from automotive_cosim.agents import ABOUT, AGENTS, MODELLED, PROFILES, Caller, NativeAgent
from automotive_cosim.models import MODELS

GRID = ("--task", "hvac_fan_max", "--scenario", "grid")


def test_agents_and_models_are_listed(cli):
    for command in (("agents",), ("agents", "list")):
        told = cli(*command).out
        assert set(AGENTS) <= set(told.split())
        assert all(form in told for form in MODELS)


@pytest.mark.parametrize("name", AGENTS)
def test_an_agent_is_shown(cli, name):
    told = cli("agents", "show", name).out
    assert told.startswith(f"{name}: gets ")
    answers_in_text = name in MODELLED and name != "caller"  # which answers by calls
    assert ("## How to answer" in told) == answers_in_text


@pytest.mark.usefixtures("warm")
def test_the_rule_model_is_named_for_what_it_is(cli):
    told = json.loads(cli("run", "--json", *GRID, "--agent", "m3a").out)
    assert told["model"] == "rules"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--agent", "t3b"), "t3a"),
        (("--agent", "nowhere:Mine"), "nowhere"),
        (("--model", "gpt"), "openai/NAME"),
        (("--model", "nowhere/m"), "NOWHERE_API_KEY"),
        (("--model", "replay/nowhere"), "no folder or recording"),
        (("--model", "replay/no/where"), "steps.jsonl"),
        (("--geo", "wrnog"), "wrong"),
        (("--without", "gps,radar"), "part of an agent"),
        (("--memory", "no/such/folder/m"), "memory"),
        (("--most", "tokens=0"), "whole number"),
    ],
)
def test_what_does_not_exist_is_told_in_one_line_and_leaves_nothing(cli, tmp_path, arguments, said):
    ran = cli("run", *GRID, *arguments)
    assert ran.code == 2
    assert said in ran.err
    assert len(ran.err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("warm")
def test_an_agent_of_ones_own_is_run_from_the_working_folder(cli, tmp_path):
    (tmp_path / "my_agents.py").write_text(
        "class Mine:\n"
        "    def reset(self, goal): ...\n"
        "    def act(self, seen): return {'action_type': 'status', 'goal_status': 'complete'}\n"
    )
    told = json.loads(cli("run", "--json", *GRID, "--agent", "my_agents:Mine").out)
    assert (told["agent"], told["success"], told["steps"]) == ("Mine", False, 1)


@pytest.mark.usefixtures("warm")
def test_what_is_kept_can_be_shown(cli, tmp_path):
    for _ in range(2):
        cli("run", "--json", *GRID, "--memory", "kept.sqlite")
    kept = json.loads(cli("show", "memory", "kept.sqlite", "--json").out)
    assert [(entry["worked"], entry["failed"]) for entry in kept] == [(2, 0)]
    assert "click index=Max" in kept[0]["steps"]
    text = cli("show", "memory", "kept.sqlite").out
    assert kept[0]["goal"] in text
    assert "2 of 2" in text


def test_a_missing_memory_is_told_and_not_made(cli, tmp_path):
    ran = cli("show", "memory", "none.sqlite")
    assert ran.code == 2
    assert "no memory" in ran.err
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("warm")
def test_geo_and_switches_stand_in_the_record(cli):
    cli("run", "--json", *GRID, "--geo", "none", "--without", "reflection,screen", "--out", "out")
    written = json.loads(Path("out/trial.json").read_text(encoding="utf-8"))["result"]
    assert (written["conditions"]["geo"], written["without"]) == ("none", ["reflection", "screen"])
    lines = Path("out/steps.jsonl").read_text(encoding="utf-8").splitlines()
    stages = [stage["stage"] for line in lines for stage in json.loads(line)["stages"]]
    assert "reflect" not in stages


@pytest.mark.usefixtures("warm")
def test_a_person_plays_at_the_terminal(cli, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("open climate\nnonsense\ndone\n"))
    ran = cli("run", "--json", *GRID, "--agent", "human")
    told = json.loads(ran.out)
    assert (told["agent"], told["steps"], told["success"]) == ("human", 2, False)
    assert "'nonsense' is not an action" in ran.err


@pytest.mark.usefixtures("warm")
def test_a_person_who_leaves_interrupts(cli, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    assert cli("run", *GRID, "--agent", "human").code == 130


@pytest.mark.usefixtures("warm")
def test_a_single_run_is_replayed_and_a_change_is_found(cli, tmp_path):
    assert cli("run", *GRID, "--agent", "asurada", "--without", "queries", "--out", "one").code == 0
    again = cli("replay", "one")
    assert (again.code, again.out.count("the same")) == (
        0,
        len((tmp_path / "one/steps.jsonl").read_text(encoding="utf-8").splitlines()) + 1,
    )
    assert "replay one" in (tmp_path / "one/summary.html").read_text(encoding="utf-8")
    refused = cli("replay", "one", "hvac")
    assert (refused.code, refused.err) == (2, "error: one holds a single run; omit 'hvac'\n")
    record = json.loads((tmp_path / "one/trial.json").read_text(encoding="utf-8"))
    record["manifest"]["setup"]["seed"] += 1
    (tmp_path / "one/trial.json").write_text(json.dumps(record), encoding="utf-8")
    assert cli("replay", "one").code == 1
    record["manifest"]["setup"]["seedd"] = 1
    (tmp_path / "one/trial.json").write_text(json.dumps(record), encoding="utf-8")
    assert "did you mean 'seed'" in cli("replay", "one").err


def test_every_agent_has_a_line_of_its_own(cli):
    assert set(MODELLED) == {*PROFILES, NativeAgent.name, Caller.name}
    lines = cli("agents").out.splitlines()
    assert all(any(line.split() == [name, *ABOUT[name].split()] for line in lines) for name in AGENTS)
