"""The environment behind OpenEnv's own server, asked by its own client."""

import base64
import socket
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from automotive_cosim.contracts import Json

pytest.importorskip("openenv", reason="needs an environment of its own: pip install 'openenv>=0.10,<0.11'")
from openenv import GenericEnvClient

from tests.doors.conftest import CALLS, DRIVE, WAIT

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]
SERVER = Path(__file__).resolve().parents[2] / "docs/examples/openenv_server.py"
RESET: Json = {"task": "hvac_fan_max", "scenario": "grid", "seed": 0}


@pytest.fixture
def client(sumo: None, program, until) -> Iterator[GenericEnvClient]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    program(sys.executable, str(SERVER), str(port))

    def answers() -> bool:
        with socket.socket() as tried:
            return tried.connect_ex(("127.0.0.1", port)) == 0

    until(answers)
    with GenericEnvClient(base_url=f"http://127.0.0.1:{port}", message_timeout_s=120).sync() as made:
        yield made


def test_pages_of_other_sites_and_folders_of_this_machine_are_out_of_reach(client, tmp_path) -> None:
    address = client._async._base_url.replace("ws:", "http:")
    assert urllib.request.urlopen(f"{address}/health").status == 200
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(
            urllib.request.Request(f"{address}/health", headers={"Origin": "http://evil.example"})
        )
    (tmp_path / "scenario.toml").write_text("", "utf-8")
    for name in (str(tmp_path), str(tmp_path / "nowhere"), "..", "/etc"):
        with pytest.raises(RuntimeError, match="no scenario named"):
            client.reset(**RESET | {"scenario": name})


def test_the_reference_solution_earns_the_reward_with_the_command_lines_trace(client, oracle) -> None:
    actions, trace = oracle
    for wrong in ({"task": "no_such_task"}, RESET | {"geo": "moon"}, RESET | {"sead": 1}):
        with pytest.raises(RuntimeError, match=r"no_such_task|moon|sead"):
            client.reset(**wrong)
    result = client.reset(**RESET)
    assert not result.done
    assert base64.b64decode(result.observation["picture"]).startswith(b"\x89PNG")
    for action in actions:
        assert not result.done
        assert (result.reward, result.observation["outcome"]) == (None, None)
        assert "verdict" not in result.observation["turn"]
        result = client.step({"action": action})
    assert (result.done, result.reward) == (True, 1.0)
    assert result.observation["outcome"]["trace_sha256"] == trace
    assert client.state()["step_count"] == len(actions)
    with pytest.raises(RuntimeError, match="reset first"):
        client.step({"action": actions[0]})
    bare = client.reset(**RESET, pictures=False)
    assert bare.observation["picture"] is None
    assert client.step({"action": "no JSON"}).observation["turn"]["feedback"]["code"] == "malformed"


def test_functions_are_listed_and_called_by_name(client) -> None:
    result = client.reset(**RESET, interface="functions", see="nothing")
    names = {each["function"]["name"] for each in result.observation["functions"]}
    assert {name for name, _ in CALLS} <= names
    assert "click" not in names
    for function, arguments in CALLS:
        result = client.step({"function": function, "arguments": arguments})
    assert (result.done, result.reward) == (True, 1.0)
    client.reset(**RESET, interface="functions", see="nothing")
    with pytest.raises(RuntimeError, match="one of the two"):
        client.step({})


def test_a_drive_earns_its_score(client, drive_trace: str) -> None:
    result = client.reset(**DRIVE)
    while not result.done:
        result = client.step({"action": WAIT})
    assert result.reward == 0.0
    assert result.observation["outcome"]["trace_sha256"] == drive_trace
