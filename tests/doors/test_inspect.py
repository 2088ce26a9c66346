"""Inspect's own evaluation over the cockpit: the reference solution wins, and its trace is the command line's."""

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Json
from automotive_cosim.errors import TrafficError, UserError
from automotive_cosim.run.episode import EpisodeSetup, Shot, Watcher, run_episode
from automotive_cosim.service import EpisodeService
from automotive_cosim.tasking.verdict import PARTS
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

pytest.importorskip("inspect_ai", reason="the extra inspect is not installed")
from inspect_ai import eval as evaluate
from inspect_ai.log import EvalLog
from inspect_ai.model import ModelOutput, ModelUsage, get_model

from automotive_cosim.doors import inspect_tasks

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


class Actions(Watcher):
    def __init__(self) -> None:
        self.played: list[Json] = []

    def stepped(self, shot: Shot) -> None:
        assert shot.step.action
        self.played.append(to_json(shot.step.action))


@pytest.fixture(scope="module")
def oracle(simulations: Simulations) -> tuple[list[Json], str | None]:
    """The reference solution's actions, and the trace that they give on the command line."""
    watcher = Actions()
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="oracle", model="none")
    result = run_episode(setup, make_agent("oracle"), (watcher,), simulations=simulations)
    return watcher.played, result.trace_sha256


@pytest.fixture
def service(simulations: Simulations, monkeypatch: pytest.MonkeyPatch) -> Iterator[EpisodeService]:
    with closing(EpisodeService(simulations, inspect_tasks.LIMITS)) as made:
        monkeypatch.setattr(inspect_tasks, "shared_service", lambda: made)
        yield made


@pytest.fixture
def inspect(service: EpisodeService, tmp_path: Path) -> Callable[..., EvalLog]:
    def run(actions: list[Json], **options: Any) -> EvalLog:
        usage = ModelUsage(input_tokens=1, output_tokens=1, total_tokens=2)
        outputs = [ModelOutput.for_tool_call("mockllm/model", "act", {"action": action}) for action in actions]
        outputs.append(ModelOutput.from_content("mockllm/model", "Done."))
        for output in outputs:
            output.usage = usage  # without it the mock model looks for a tokenizer in the network
        model = get_model("mockllm/model", custom_outputs=outputs)
        cockpit = inspect_tasks.cockpit(tasks="hvac_fan_max", scenario="grid")
        [log] = evaluate(cockpit, model=model, log_dir=str(tmp_path), display="none", **options)
        return log

    return run


def test_the_reference_solution_wins_with_the_command_lines_trace(inspect, oracle) -> None:
    actions, trace = oracle
    log = inspect(actions)
    assert log.status == "success", log.error
    [sample] = log.samples
    score = sample.scores["verdict"]
    assert score.value == dict.fromkeys(("success", *PARTS), 1)
    assert (score.metadata["trace_sha256"], score.metadata["end"]) == (trace, "declared")
    found = {
        each.name: {name.rpartition("/")[2]: entry.value for name, entry in each.metrics.items()}
        for each in log.results.scores
    }
    assert found["success"]["mean"] == 1.0
    assert 0 < found["success"]["low"] < found["success"]["high"] <= 1
    kinds = [content.type for content in sample.messages[1].content]
    assert kinds == ["text", "image"]


def test_a_model_that_stops_is_judged_as_it_is(inspect) -> None:
    [sample] = inspect([{"action_type": "fly"}]).samples
    assert sample.scores["verdict"].value["success"] == 0
    assert sample.scores["verdict"].metadata["steps"] == 1
    assert sample.scores["verdict"].metadata["end"] == "out_of_budget"


def test_what_a_limit_cuts_short_is_judged_as_it_is(inspect, service) -> None:
    [sample] = inspect([{"action_type": "wait"}] * 9, message_limit=6).samples
    assert sample.limit.type == "message"
    assert sample.scores["verdict"].metadata["end"] == "out_of_budget"
    assert not service._running


def test_what_the_road_breaks_is_an_error_of_the_sample(inspect, service, monkeypatch) -> None:
    def fails(episode_id: str, action: Json) -> None:
        raise TrafficError("the simulation died")

    monkeypatch.setattr(service, "act", fails)
    log = inspect([{"action_type": "wait"}])
    assert log.status == "error"
    assert "the simulation died" in log.samples[0].error.message


@pytest.mark.parametrize(
    ("tasks", "seeds"), [("hvac_fan_max,road_speed_80_in_50", "0,1"), (["hvac_*"], 3), ("road_fog_limit", [0, 2])]
)
def test_samples_are_tasks_halves_and_seeds(tasks, seeds) -> None:
    dataset = inspect_tasks.cockpit(tasks=tasks, seeds=seeds).dataset
    ids = [sample.id for sample in dataset]
    assert len(ids) == len(set(ids)) > 0
    for sample in dataset:
        assert sample.metadata["half"] in CATALOGUE[sample.metadata["task"]].halves
        assert "goal" not in sample.metadata


def test_what_is_wrong_is_told() -> None:
    for wrong in ({"tasks": "no_such_task"}, {"geo": "moon"}, {"seeds": "one"}):
        with pytest.raises(UserError):
            inspect_tasks.cockpit(**wrong)
