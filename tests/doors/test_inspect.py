"""Inspect's own evaluation over cockpit and drives: the reference gets the command line's trace and figures."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.contracts import Json
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.errors import TrafficError, UserError
from automotive_cosim.interface.observe import ALL
from automotive_cosim.report.drives import FIGURES, WITH_INTERVAL, interval
from automotive_cosim.report.stats import LEAST_CLUSTERS
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.run.trial import run_trial
from automotive_cosim.service import EpisodeService
from automotive_cosim.tasking.verdict import PARTS
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

pytest.importorskip("inspect_ai", reason="the extra harnesses is not installed")
from inspect_ai import Task
from inspect_ai import eval as evaluate
from inspect_ai.log import EvalLog
from inspect_ai.model import ModelOutput, ModelUsage, get_model
from inspect_ai.scorer import SampleScore, Score

from automotive_cosim.doors import inspect_tasks, shared
from tests.doors.conftest import CALLS

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


@pytest.fixture
def service(simulations: Simulations, monkeypatch: pytest.MonkeyPatch) -> Iterator[EpisodeService]:
    with closing(EpisodeService(simulations, shared.LIMITS)) as made:
        monkeypatch.setattr(inspect_tasks, "shared_service", lambda: made)
        yield made


@pytest.fixture
def inspect(service: EpisodeService, tmp_path: Path) -> Callable[..., EvalLog]:
    def run(
        actions: list[Json], of: Task | None = None, calls: Sequence[tuple[str, Json]] = (), **options: Any
    ) -> EvalLog:
        usage = ModelUsage(input_tokens=1, output_tokens=1, total_tokens=2)
        named = [*(("act", {"action": action}) for action in actions), *calls]
        outputs = [ModelOutput.for_tool_call("mockllm/model", name, given) for name, given in named]
        outputs.append(ModelOutput.from_content("mockllm/model", "Done."))
        for output in outputs:
            output.usage = usage  # without it the mock model looks for a tokenizer in the network
        model = get_model("mockllm/model", custom_outputs=outputs)
        of = of or inspect_tasks.cockpit(tasks="hvac_fan_max", scenario="grid")
        [log] = evaluate(of, model=model, log_dir=str(tmp_path), display="none", **options)
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


def test_functions_are_tools_of_their_own(inspect) -> None:
    of = inspect_tasks.cockpit(tasks="hvac_fan_max", scenario="grid", interface="functions", see="nothing")
    log = inspect([], of, calls=CALLS)
    assert log.status == "success", log.error
    [sample] = log.samples
    assert sample.scores["verdict"].value["success"] == 1
    [model] = {event.event: event for event in sample.events if event.event == "model"}.values()
    offered = {tool.name: tool for tool in model.tools}
    assert "act" not in offered
    assert offered["set_hvac_fan_speed"].parameters.properties["percent"].maximum == 100
    assert "by calling its functions" in sample.messages[0].text


def test_a_model_that_stops_is_judged_as_it_is(inspect) -> None:
    [sample] = inspect([{"action_type": "fly"}]).samples
    assert sample.scores["verdict"].value["success"] == 0
    assert sample.scores["verdict"].metadata["steps"] == 1
    assert sample.scores["verdict"].metadata["end"] == "out_of_budget"


def test_odd_and_giant_calls_cost_a_step_each_and_the_model_sees_no_name_path_or_verdict(inspect) -> None:
    odd: list[Any] = [
        {"action_type": "answer", "text": "x" * 300_000},
        {"action_type": "answer", "text": "\x1b[2J"},  # a lone surrogate breaks Inspect's own log
        {"action_type": "wait", "seconds": 1e999},
        {"a": {"b": [1] * 10_000}},
        {"action_type": "click", "index": -(10**30)},
        {},
    ]
    log = inspect(odd)
    assert log.status == "success", log.error
    [sample] = log.samples
    assert sample.scores["verdict"].metadata["steps"] == len(odd)
    assert sample.scores["verdict"].value["success"] == 0
    given = [message for message in sample.messages if message.role != "assistant"]
    told = json.dumps([each.text for each in given])
    assert len(given) >= len(odd)
    for word in (
        "hvac_fan_max",
        "verdict",
        "success",
        "trace_sha256",
        "grid",
        str(Path.cwd()),
        str(Path.home()),
        "/tmp",
    ):
        assert word not in told, word


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


def test_only_tasks_with_phrasings_are_samples_in_another_language() -> None:
    dataset = inspect_tasks.cockpit(tasks="hvac_fan_max,hard_car_wash", language="de").dataset
    assert {(sample.metadata["task"], sample.metadata["conditions"]["language"]) for sample in dataset} == {
        ("hard_car_wash", "de")
    }


def test_what_is_wrong_is_told() -> None:
    for wrong in (
        {"tasks": "no_such_task"},
        {"geo": "moon"},
        {"seeds": "one"},
        {"language": "es"},
        {"language": "fr"},
    ):
        with pytest.raises(UserError):
            inspect_tasks.cockpit(**wrong)


# --- drives ------------------------------------------------------------------------------------------------------


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> str:
    """A family of drives that are over after four minutes."""
    family = FAMILIES["grid_june"]
    shorter = replace(family.draw(43), duration_s=240.0)
    drawn = SimpleNamespace(id=family.id, scenario=family.scenario, season=family.season, draw=lambda seed: shorter)
    monkeypatch.setitem(FAMILIES, family.id, drawn)  # type: ignore[call-overload]
    return family.id


class Seeing(RulePerfect):
    """Gets what Inspect's models get."""

    channels = ALL


@pytest.fixture
def watched(short: str, simulations: Simulations) -> tuple[DriveTrialRow, list[Json]]:
    """The rule-perfect watcher's drive on the command line: its row, and its steps."""
    setup = DriveSetup(short, 43, agent="rule-perfect")
    recorder = Recorder(setup, None)
    row = run_trial(setup, Seeing(), (recorder,), simulations=simulations)
    assert isinstance(row, DriveTrialRow)
    return row, recorder.lines[:-1]


def test_the_rule_perfect_watchers_acts_give_the_command_lines_drive(inspect, short, watched) -> None:
    acts = [step["action"] for step in watched[1] if step["action"]]
    log = inspect(acts, inspect_tasks.drives(families=short, seeds=43, pictures=False))
    assert log.status == "success", log.error
    [sample] = log.samples
    score, row = sample.scores["watched"], watched[0]
    assert row.score.met > 0
    assert score.metadata["trace_sha256"] == row.trace_sha256
    assert score.metadata["end"] == "minutes_over"
    assert list(score.value.values()) == [figure([row]) for _, figure, _ in FIGURES[:WITH_INTERVAL]]
    assert [each.name for each in log.results.scores] == list(inspect_tasks.SCORES)
    assert [next(iter(each.metrics.values())).value for each in log.results.scores] == list(score.value.values())
    assert not {"event", "obliged_s", "lookalike"} & set(sample.messages[1].content[0].text.split('"'))


def test_the_rest_of_a_drive_that_a_limit_cuts_short_goes_on_without_the_model(inspect, service, short) -> None:
    waits = [{"action_type": "wait", "seconds": 1}] * 9
    log = inspect(waits, inspect_tasks.drives(short, 43), message_limit=6)
    [sample] = log.samples
    assert sample.limit.type == "message"
    found = sample.scores["watched"]
    assert (found.metadata["end"], found.metadata["sim_seconds"]) == ("out_of_budget", 240.0)
    assert found.value["score"] == 0.0
    assert not service._running


def test_a_drive_that_the_road_breaks_is_an_error_of_the_sample(inspect, service, short, monkeypatch) -> None:
    def fails(episode_id: str, action: Json) -> None:
        raise TrafficError("the simulation died")

    monkeypatch.setattr(service, "act", fails)
    log = inspect([{"action_type": "wait"}], inspect_tasks.drives(short, 43))
    assert log.status == "error"
    assert "the simulation died" in log.samples[0].error.message
    assert not log.samples[0].scores


def test_figures_of_several_drives_are_the_reports_with_its_intervals(inspect, short, watched) -> None:
    acts = [step["action"] for step in watched[1] if step["action"]]
    [sample] = inspect(acts, inspect_tasks.drives(families=short, seeds=43)).samples
    score = sample.scores["watched"]

    def of(seed: int) -> SampleScore:
        met = score.metadata["result"]["score"] | {"nuisances": seed % 3}
        outcome = score.metadata | {"seed": seed, "result": score.metadata["result"] | {"score": met}}
        return SampleScore(score=Score(value=score.value, metadata=outcome))

    for count in (LEAST_CLUSTERS - 1, LEAST_CLUSTERS + 1):
        rows = [
            replace(watched[0], seed=seed, score=replace(watched[0].score, nuisances=seed % 3))
            for seed in range(count)
        ]
        for name, figure in inspect_tasks.SCORES.items():
            found = inspect_tasks.figure(name)([of(seed) for seed in range(count)])
            bounds = interval(rows, figure)
            assert found["value"] == figure(rows)
            assert (found.get("low"), found.get("high")) == ((bounds.low, bounds.high) if bounds else (None, None))


def test_samples_of_drives_are_families_and_seeds() -> None:
    dataset = inspect_tasks.drives("grid,nordic_*", "0,3").dataset
    families = {"grid_january", "grid_june", "nordic_december", "nordic_july"}
    assert {(sample.metadata["family"], sample.metadata["seed"]) for sample in dataset} == {
        (family, seed) for family in families for seed in (0, 3)
    }
    for wrong in ({"families": "moon_*"}, {"seeds": "-1"}, {"see": "sideways"}):
        with pytest.raises(UserError):
            inspect_tasks.drives(**wrong)
