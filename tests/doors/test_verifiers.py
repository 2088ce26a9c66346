"""The taskset in verifiers' own rollout: tools, trace and reward."""

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.tasking.verdict import PARTS

pytest.importorskip("verifiers", reason="the extra harnesses is not installed")
import verifiers.v1 as vf
from mcp import Client

from automotive_cosim.doors.verifiers import CockpitConfig, CockpitTaskset
from tests.doors.conftest import CALLS, WAIT

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


class Plays(vf.Harness[vf.HarnessConfig]):
    """A harness without a model: it calls the tools with these actions."""

    SUPPORTS_MCP, NEEDS_CONTAINER, EXECUTES_CODE = True, False, False
    calls: list[tuple[str, Json]]
    told: list[Json]

    async def launch(self, *given: Any, mcp_urls: dict[str, str] | None = None, **named: Any) -> vf.ProgramResult:
        urls = mcp_urls or next(each for each in given if isinstance(each, dict))
        async with Client(next(iter(urls.values()))) as client:
            self.told = [{"tools": sorted(tool.name for tool in (await client.list_tools()).tools)}]
            self.told.append((await client.call_tool("observe", {})).structured_content)
            for name, given in self.calls:
                self.told.append((await client.call_tool(name, given)).structured_content)
        return vf.ProgramResult(0, "", "")


@pytest.fixture
def rollout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sumo: None) -> Callable[..., Any]:
    """A whole rollout with these actions: its trace, and what the tools told."""
    monkeypatch.setenv("HOME", str(tmp_path))

    def run(
        actions: list[Json], calls: Sequence[tuple[str, Json]] = (), **named: Any
    ) -> tuple[vf.Trace, list[Json]]:
        [task] = CockpitTaskset(CockpitConfig(**{"tasks": "hvac_fan_max", "scenario": "grid"} | named))
        config = vf.AgentConfig(harness=vf.HarnessConfig(id="null"), runtime=vf.SubprocessConfig(), model="none")
        agent = vf.Agent(config)
        agent.harness = Plays(config.harness)
        agent.harness.calls = [("act", {"action": action}) for action in actions] + list(calls)
        trace = asyncio.run(agent.run(task))
        return trace, agent.harness.told

    return run


def test_the_reference_solution_earns_the_reward_with_the_command_lines_trace(rollout, oracle) -> None:
    actions, trace_sha256 = oracle
    trace, told = rollout(actions)
    assert not trace.errors
    assert told[0]["tools"] == ["act", "observe"]
    assert told[1]["goal"]
    assert "verdict" not in told[-1]
    assert trace.state.outcome["trace_sha256"] == trace_sha256
    assert trace.reward == 1.0
    assert {name: trace.metrics[name] for name in PARTS} == dict.fromkeys(PARTS, 1.0)


def test_functions_are_tools_of_their_own(rollout) -> None:
    trace, told = rollout([], CALLS, interface="functions", see="nothing")
    assert not trace.errors
    assert {"observe", "set_hvac_fan_speed", "status"} <= set(told[0]["tools"])
    assert "act" not in told[0]["tools"]
    assert trace.reward == 1.0


def test_who_stops_early_earns_nothing(rollout) -> None:
    trace, _ = rollout([{"action_type": "wait"}])
    assert not trace.errors
    assert (trace.reward, trace.state.outcome) == (0.0, None)


def test_a_drive_earns_its_score(rollout, drive_trace: str) -> None:
    trace, told = rollout([WAIT] * 30, tasks="", drives="grid_june", minutes=0.5, scenario=None, seeds=(3,))
    assert told[1]["on_watch"]
    assert trace.state.outcome["trace_sha256"] == drive_trace
    assert trace.reward == 0.0


def test_what_cannot_begin_is_an_error_of_the_rollout(rollout) -> None:
    trace, _ = rollout([], scenario="no_such_place")
    assert "no_such_place" in trace.errors[0].message
    assert "success" not in {name for name, value in trace.rewards.items() if value is not None}


def test_tasks_are_named_and_what_is_wrong_is_told() -> None:
    tasks = list(CockpitTaskset(CockpitConfig(tasks="hvac_fan_max,road_fog_limit", seeds=[0, 1])))
    names = [task.data.name for task in tasks]
    assert len(names) == len(set(names)) == 6
    for wrong in ({"tasks": "no_such_task"}, {"geo": "moon"}, {"seeds": [-1]}):
        with pytest.raises(UserError):
            list(CockpitTaskset(CockpitConfig(**wrong)))


def test_verifiers_finds_it_by_its_name() -> None:
    name = "automotive-cosim-verifiers"
    assert vf.taskset_config_type(name) is CockpitConfig
    assert isinstance(vf.load_taskset(CockpitConfig(id=name)), CockpitTaskset)
