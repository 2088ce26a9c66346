"""The server against the protocol's own client: over standard input and output, over HTTP, and in this process."""

import base64
import json
import os
import re
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.cockpit import own_make
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import CarMake, Interface
from automotive_cosim.doors.shared import conditions_of, own_scenario
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.interface.functions import functions
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.script import ScriptedAgent
from automotive_cosim.run.trial import run_trial
from automotive_cosim.service import EpisodeService, ServiceLimits
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

pytest.importorskip("mcp", reason="the extra doors is not installed")
import anyio
from mcp import Client, StdioServerParameters, stdio_client

from automotive_cosim.doors.mcp import make_server
from tests.doors.conftest import DRIVE, WAIT

START: Json = {"task": "hvac_fan_max", "scenario": "grid", "seed": 0}
ACTIONS: list[Json] = [
    {"action_type": "open_app", "app_name": "climate"},
    {"action_type": "fly"},
    {"action_type": "status", "goal_status": "complete"},
]
SERVER = ["-c", "from automotive_cosim_main import main; main()", "mcp"]


@pytest.fixture(scope="module")
def trace(simulations: Simulations) -> str:
    """The trace of the same actions on the command line; a line that cannot be read costs a step there too."""

    class Script(ScriptedAgent):
        def act(self, observation):
            return parse(left.pop(0))

    left = [*ACTIONS]
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="script", model="none")
    result = run_trial(setup, Script([]), simulations=simulations)
    assert result.steps == 3
    assert result.trace_sha256
    return result.trace_sha256


@pytest.fixture
def service(simulations: Simulations) -> Iterator[EpisodeService]:
    with closing(EpisodeService(simulations, ServiceLimits(episodes=2))) as made:
        yield made


def inside(service: EpisodeService, talk: Callable[[Client], Any], interface: Interface = Interface.TOUCH) -> Any:
    """What an assistant gets from a server in this process."""

    async def run() -> Any:
        async with Client(make_server(service, interface)) as client:
            return await talk(client)

    return anyio.run(run)


async def drive(client: Client, **options: Any) -> Json:
    """Plays the actions; the outcome."""
    turn = await call(client, "start", START, **options)
    for action in ACTIONS:
        assert turn["end"] is None
        turn = await call(client, "act", {"episode_id": turn["episode_id"], "action": action})
    return await call(client, "finish", {"episode_id": turn["episode_id"]})


async def call(client: Client, tool: str, given: Json, **options: Any) -> Json:
    result = await client.call_tool(tool, given, **options)
    assert not result.is_error, result.content
    assert json.loads(result.content[0].text) == result.structured_content
    return result.structured_content


async def refused(client: Client, tool: str, given: Json) -> str:
    result = await client.call_tool(tool, given)
    assert result.is_error
    return result.content[0].text


@pytest.mark.slow
@pytest.mark.sumo
@pytest.mark.parametrize("mode", ["auto", "legacy"])
def test_an_assistant_gets_the_command_lines_trace(trace: str, service: EpisodeService, mode: str) -> None:
    """Over standard input and output, and in the older form of the protocol."""
    told: list[tuple[float, float | None, str | None]] = []

    async def progress(done: float, total: float | None, message: str | None) -> None:
        told.append((done, total, message))

    async def run() -> Json:
        program = StdioServerParameters(command=sys.executable, args=SERVER, env=dict(os.environ))
        server = stdio_client(program) if mode == "auto" else make_server(service, Interface.TOUCH)
        async with Client(server, mode=mode) as client:
            return await drive(client, progress_callback=progress)

    outcome = anyio.run(run)
    assert (outcome["trace_sha256"], outcome["steps"], outcome["end"]) == (trace, 3, "declared")
    if mode == "auto":
        assert "loading Grid" in (told[0][2] or "")
        assert [done for done, total, _ in told if total] == sorted(done for done, total, _ in told if total) != []


def test_an_assistant_keeps_watch_on_a_drive(service: EpisodeService, drive_trace: str) -> None:
    async def watch(client: Client) -> Json:
        listed = await call(client, "list_drives", {})
        assert "grid_june" in {each["id"] for each in listed["drives"]}
        turn = await call(client, "start", DRIVE)
        while turn["end"] is None:
            assert turn["on_watch"]
            assert "noticed" in turn["vehicle"]
            turn = await call(client, "act", {"episode_id": turn["episode_id"], "action": WAIT})
        return await call(client, "finish", {"episode_id": turn["episode_id"]})

    outcome = inside(service, watch)
    assert (outcome["trace_sha256"], outcome["end"]) == (drive_trace, "minutes_over")
    assert outcome["result"]["value"] == 0.0


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({}, "give a task or a drive"),
        (START | DRIVE, "one of the two"),
        ({"drive": "grid_jun"}, "grid_june"),
        (DRIVE | {"minutes": 0}, "minutes"),
        (START | {"minutes": 5}, "for a drive alone"),
    ],
)
def test_what_is_no_trial_is_refused_by_name(service: EpisodeService, given: Json, named: str) -> None:
    async def begin(client: Client) -> str:
        return await refused(client, "start", given)

    assert named in inside(service, begin)


@pytest.mark.slow
@pytest.mark.sumo
def test_two_assistants_over_http_get_the_command_lines_trace(trace: str, program, until) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    program(
        sys.executable,
        *SERVER,
        "--http",
        f"127.0.0.1:{port}",
        env={**os.environ, "AUTOMOTIVE_COSIM_MCP_TOKEN": "our-token"},
    )

    def answers() -> bool:
        with socket.socket() as tried:
            return tried.connect_ex(("127.0.0.1", port)) == 0

    until(answers)
    outcomes: list[Json] = []

    async def one() -> None:
        async with Client(f"http://127.0.0.1:{port}/mcp?token=our-token") as client:
            outcomes.append(await drive(client))

    async def run() -> None:
        async with anyio.create_task_group() as group:
            group.start_soon(one)
            group.start_soon(one)

    anyio.run(run)
    assert [outcome["trace_sha256"] for outcome in outcomes] == [trace, trace]


def test_every_tool_says_what_it_takes_and_an_episode_is_named_in_all_but_three(service: EpisodeService) -> None:
    async def talk(client: Client) -> Any:
        return (await client.list_tools()).tools

    tools = {tool.name: tool for tool in inside(service, talk)}
    assert set(tools) == {"list_tasks", "list_drives", "start", "observe", "act", "finish"}
    for name, tool in tools.items():
        assert tool.description
        assert "context" not in tool.input_schema["properties"]
        assert ("episode_id" in tool.input_schema.get("required", ())) == (name in {"observe", "act", "finish"})
    assert '"action_type": "show_alert"' in tools["act"].input_schema["properties"]["action"]["description"]


def test_a_turn_has_a_picture_and_nothing_of_the_verdict(service: EpisodeService) -> None:
    async def talk(client: Client) -> Any:
        return await client.call_tool("start", START)

    result = inside(service, talk)
    text, picture = result.content
    assert base64.b64decode(picture.data).startswith(b"\x89PNG")
    assert picture.mime_type == "image/png"
    told = set(json.loads(text.text))
    assert told == {
        "episode_id", "step", "end", "goal", "said", "time_s", "feedback",
        "elements", "vehicle", "connectivity", "gps", "context",
    }  # fmt: skip


def test_words_as_sound_are_parts_of_their_own(service: EpisodeService, monkeypatch) -> None:
    monkeypatch.setattr("automotive_cosim.episode.specification.is_installed", lambda: True)
    monkeypatch.setattr("automotive_cosim.episode.session.sounding", lambda text, snr_db: b"RIFF")

    async def talk(client: Client) -> Any:
        return await client.call_tool("start", START | {"hear": "audio"})

    text, _, sound = inside(service, talk).content
    assert (base64.b64decode(sound.data), sound.mime_type) == (b"RIFF", "audio/wav")
    assert json.loads(text.text)["goal"] == "[spoken]"
    assert "UklGRg" not in text.text


def test_the_list_says_no_more_of_a_task_than_its_name_and_halves(service: EpisodeService) -> None:
    async def talk(client: Client) -> Json:
        return {suite: await call(client, "list_tasks", {"suite": suite}) for suite in Suite}

    told = inside(service, talk)
    for suite in Suite:
        listed = told[suite]["tasks"]
        assert [(task["id"], tuple(task["halves"])) for task in listed] == [
            (task.id, task.halves) for task in CATALOGUE.of(suite)
        ]
        assert {frozenset(task) for task in listed} == {frozenset({"id", "halves"})}


@pytest.mark.parametrize(
    ("tool", "given", "said"),
    [
        ("start", START | {"task": "hvac_fan_maxx"}, "did you mean 'hvac_fan_max'"),
        ("start", START | {"half": "third"}, "third"),
        ("start", START | {"seed": -1}, "greater than or equal to 0"),
        ("start", START | {"geo": "none at all"}, "geo control"),
        ("start", START | {"language": "es"}, "no language named 'es'"),
        ("start", START | {"language": "de"}, "has no phrasings in German"),
        ("start", START | {"channels": ["radar"]}, "no channel named 'radar'"),
        ("start", START | {"scenario": "nowhere"}, "no scenario named 'nowhere'"),
        ("list_tasks", {"tasks": "nothing*"}, "nothing"),
        ("observe", {"episode_id": "0"}, "no episode '0'"),
        ("finish", {"episode_id": "0"}, "no episode '0'"),
        ("act", {"episode_id": "0", "action": {"action_type": "wait"}}, "no episode '0'"),
        ("act", {"episode_id": "0"}, "action"),
    ],
)
def test_what_is_wrong_is_told(service: EpisodeService, tool: str, given: Json, said: str) -> None:
    assert said in inside(service, lambda client: refused(client, tool, given))


ELSEWHERE = ("{}", "{}/own", "{}/../..", "/etc", "/", "~", ".", "..", "own/..", "\x00", "{}/plain")


@pytest.mark.parametrize("named", ELSEWHERE)
def test_a_client_finds_nothing_out_about_the_folders_of_this_machine(
    service: EpisodeService, tmp_path: Path, named: str
) -> None:
    """It is told the same of what is there and of what is not."""
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "scenario.toml").write_text("", "utf-8")
    (tmp_path / "plain").mkdir()
    for name in (named.format(tmp_path), named.format(tmp_path) + "nowhere"):
        told = inside(service, lambda client, name=name: refused(client, "start", START | {"scenario": name}))
        assert "no scenario named" in told
        assert "; " in told


def test_a_client_names_the_scenarios_of_the_owners_folder(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "scenario.toml").write_text("", "utf-8")
    assert own_scenario("mine", tmp_path) == str(tmp_path / "mine")
    assert [own_scenario(name, folder) for name in (None, "", "grid") for folder in (None, tmp_path)] == [
        None, None, "", "", "grid", "grid",
    ]  # fmt: skip
    whole = str(tmp_path / "mine")
    for name, folder in (("mine", None), ("mine/", tmp_path), ("./mine", tmp_path), (whole, tmp_path)):
        with pytest.raises(UnknownNameError, match="no scenario named"):
            own_scenario(name, folder)


def test_an_action_may_come_as_text_and_channels_are_left_out(service: EpisodeService) -> None:
    async def talk(client: Client) -> Any:
        turn = await call(client, "start", START | {"channels": ["elements"]})
        given = {"episode_id": turn["episode_id"], "action": json.dumps(ACTIONS[0])}
        return await client.call_tool("act", given)

    result = inside(service, talk)
    assert len(result.content) == 1
    assert result.structured_content["feedback"]["code"] == "ok"
    assert "vehicle" not in result.structured_content


@pytest.mark.slow
def test_calls_that_come_together_wait_for_each_other(service: EpisodeService) -> None:
    """Each is one step, and none sees half of another's."""
    turns: list[Json] = []

    async def talk(client: Client) -> Json:
        begun = await call(client, "start", {**START, "channels": ["elements"]})
        given = {"episode_id": begun["episode_id"]}

        async def act() -> None:
            turns.append(await call(client, "act", {**given, "action": {"action_type": "wait", "seconds": 1}}))

        async with anyio.create_task_group() as group:
            for _ in range(8):
                group.start_soon(act)
        return await call(client, "finish", given)

    outcome = inside(service, talk)
    assert outcome["steps"] == 8
    assert sorted(turn["step"] for turn in turns) == list(range(1, 9))
    assert not any("success" in json.dumps(turn) or "verdict" in json.dumps(turn) for turn in turns)


@pytest.mark.slow
def test_an_episode_that_is_over_or_was_never_there_is_nobodys(service: EpisodeService) -> None:
    async def talk(client: Client) -> list[str]:
        begun = await call(client, "start", START)
        await call(client, "finish", {"episode_id": begun["episode_id"]})
        return [
            await refused(client, tool, {"episode_id": given} | ({"action": "{}"} if tool == "act" else {}))
            for tool in ("observe", "act", "finish")
            for given in (begun["episode_id"], "0" * 16, "", "../x", "\x1b[31m" * 1000)
        ]

    told = inside(service, talk)
    assert len(told) == 15
    assert all("no episode " in each and len(each) < 300 for each in told)


@pytest.mark.slow
@pytest.mark.parametrize(
    "action",
    ["[" * 100_000, "x" * 500_000, {"action_type": "answer", "text": "x" * 500_000}, {"a": {"b": [1] * 10_000}},
     '{"action_type": "wait", "seconds": 1e999}', '{"action_type": "answer", "text": "\\ud800"}'],
)  # fmt: skip
def test_a_giant_or_odd_action_costs_a_step_and_nothing_else(service: EpisodeService, action: Any) -> None:
    async def talk(client: Client) -> tuple[Json, Json]:
        begun = await call(client, "start", {**START, "channels": ["elements"]})
        given = {"episode_id": begun["episode_id"]}
        return await call(client, "act", {**given, "action": action}), await call(client, "finish", given)

    turn, outcome = inside(service, talk)
    assert turn["step"] == outcome["steps"] == 1
    assert outcome["success"] is False
    assert len(json.dumps(turn["feedback"])) < 2000


@pytest.mark.slow
@pytest.mark.sumo
@pytest.mark.parametrize("served", [Interface.TOUCH, Interface.FUNCTIONS])
def test_the_functions_are_tools_with_their_schemas(service: EpisodeService, served: Interface) -> None:
    every = {function.name: function.parameters for function in functions().values()}

    async def talk(client: Client) -> Json:
        before = {tool.name for tool in (await client.list_tools()).tools}
        assert ("act" in before, set(every) <= before) == (served.touches, served.calls)
        turn = await call(client, "start", START | {"interface": "functions", "see": "nothing"})
        tools = {tool.name: tool.input_schema for tool in (await client.list_tools()).tools}
        for name, parameters in every.items():
            given = tools[name]["properties"]
            assert {key: given[key]["type"] for key in parameters["properties"]} == {
                key: schema["type"] for key, schema in parameters["properties"].items()
            }
            assert set(tools[name]["required"]) == {"episode_id", *parameters["required"]}
        episode = {"episode_id": turn["episode_id"]}
        assert "elements" not in turn
        assert (
            "percent" in (await call(client, "set_hvac_fan_speed", episode | {"percent": 400}))["feedback"]["text"]
        )
        told = await call(client, "get_signals", episode | {"path": "hvac"})
        assert "FanSpeed" in told["feedback"]["text"]
        await call(client, "set_hvac_fan_speed", episode | {"percent": 100})
        await call(client, "status", episode | {"goal_status": "complete"})
        return await call(client, "finish", episode)

    outcome = inside(service, talk, served)
    assert (outcome["success"], outcome["steps"]) == (True, 4)


@pytest.mark.slow
@pytest.mark.sumo
def test_what_clients_write_as_text_or_null_is_taken(service: EpisodeService) -> None:
    async def talk(client: Client) -> None:
        (only,) = (await call(client, "list_tasks", {"tasks": '["hvac_fan_max"]'}))["tasks"]
        assert only["id"] == "hvac_fan_max"
        for nothing in (None, "null", "None", ""):
            filled = dict.fromkeys(("drive", "half", "seed", "minutes", "errands", "channels", "screen"), nothing)
            turn = await call(client, "start", START | filled | {"channels": ["null"]})
            await call(client, "finish", {"episode_id": turn["episode_id"]})
        assert "did you mean 'none'" in await refused(client, "start", START | {"geo": "None"})
        for tool in (await client.list_tools()).tools:
            assert tool.input_schema["additionalProperties"] is False
            said = await refused(client, tool.name, START | {"episode_id": "x", "action": "{}", "sed": 1})
            assert re.search(rf"no argument of {tool.name} named '\w+'", said), said
        assert "did you mean 'seed'" in await refused(client, "start", START | {"sed": 1})
        turn = await call(client, "start", START | {"geo": "none", "policy": ""})
        assert "gps" not in turn
        fenced = '```json\n{"action_type": "wait"}\n```'
        turn = await call(client, "act", {"episode_id": turn["episode_id"], "action": fenced})
        assert turn["feedback"]["code"] == "ok"
        turn = await call(client, "start", START | {"interface": "functions"})
        of = {"episode_id": turn["episode_id"]}
        for text in ("null", '["milk"]', '{"a": 1}', "12"):
            turn = await call(client, "ask_driver", of | {"text": text})
            assert turn["feedback"]["code"] == "ok", f"{text} is what was asked"
        turn = await call(client, "wait", of | {"seconds": "null"})
        assert turn["feedback"]["code"] == "ok"

    inside(service, talk)


def test_nobody_names_files_of_this_machine_through_a_door(tmp_path):
    (tmp_path / "own.toml").write_text('bar = { entries = ["home", "apps"] }', encoding="utf-8")
    named = own_make.resolved(str(tmp_path / "own.toml"))
    for given in ({"make": str(tmp_path / "own.toml")}, {"make": named}, {"prompt": f"mine.md@{named[-64:]}"}):
        with pytest.raises(UserError, match="choose from"):
            conditions_of(given)
    assert conditions_of({"make": "drawn", "prompt": "short", "hear": "cabin"}).make is CarMake.DRAWN
