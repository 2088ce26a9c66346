"""What all workers of an evaluation share: turns at a model, and the budget."""

import json
import pickle
import threading
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.main import app
from automotive_cosim.errors import BudgetSpentError, InfrastructureError, UserError
from automotive_cosim.models import ChatMessage, ModelReply
from automotive_cosim.models.turns import LocalTurns
from automotive_cosim.run.batch import SPENT, run_plan, spent_before
from automotive_cosim.run.budget import Meter, MeterClient, Metered, Spent, served
from automotive_cosim.run.job_row import steady
from automotive_cosim.run.plan import Plan, make_plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.settings import Budget
from automotive_cosim.run.store import read_rows

ASK = [ChatMessage("user", "hi")]


class Answers:
    """A model whose answers cost ten tokens and a cent."""

    name, sees_pictures = "answers", False

    def chat(self, messages: object) -> ModelReply:
        return ModelReply("a", 7, 3, 0.01)


def test_turns_at_a_model_are_so_far_apart_and_those_of_others_are_not_waited_for() -> None:
    now_s = [100.0]
    turns = LocalTurns(lambda: now_s[0])
    assert [turns.wait_s("a/m", 30) for _ in range(3)] == [0.0, 2.0, 4.0]
    assert turns.wait_s("b/m", 30) == 0.0
    now_s[0] = 105.0
    assert turns.wait_s("a/m", 30) == 1.0
    now_s[0] = 500.0
    assert turns.wait_s("a/m", 30) == 0.0  # turns that nobody took are not saved up
    assert turns.wait_s("a/m", 30) == 2.0


@pytest.mark.parametrize(
    ("budget", "spent", "used", "words"),
    [
        (Budget(), Spent(10, 1.0), 0.0, ""),
        (Budget(50_000), Spent(12_000), 0.24, "38,000 of 50,000 tokens left"),
        (Budget(usd=2.0), Spent(9, 0.5), 0.25, "$1.50 of $2.00 left"),
        (Budget(100, 2.0), Spent(50, 1.5), 0.75, "50 of 100 tokens and $0.50 of $2.00 left"),
        (Budget(100), Spent(130), 1.0, "0 of 100 tokens left"),
    ],
)
def test_what_is_left_of_a_budget_is_told(budget: Budget, spent: Spent, used: float, words: str) -> None:
    assert (spent.share_of(budget), spent.left_of(budget)) == (used, words)


def test_many_connections_share_one_meter() -> None:
    with served(Meter(Budget(), Spent(5, 0.5))) as handle:
        assert isinstance(handle, MeterClient)
        copies = [pickle.loads(pickle.dumps(handle)) for _ in range(8)]

        def uses(client: MeterClient) -> list[float]:
            for _ in range(50):
                client.spend(1, 0.25)
            return [client.wait_s("a/m", 0.06) for _ in range(5)]

        with ThreadPoolExecutor(8) as threads:
            waits = sorted(wait for found in threads.map(uses, copies) for wait in found)
        assert handle.spent() == Spent(405, 100.5)
        assert [round(wait / 1000) for wait in waits] == list(range(40))


def test_who_does_not_have_the_key_gets_nothing() -> None:
    with served(Meter(Budget(), Spent())) as handle:
        address, _ = handle.__reduce__()[1]  # type: ignore[misc]
        with pytest.raises(Exception, match=r"digest|authentication"):
            MeterClient(address, b"another").spent()
        assert handle.spent() == Spent()


def test_a_meter_that_is_gone_is_no_fault_of_the_agent() -> None:
    with served(Meter(Budget(), Spent())) as handle:
        pass
    with pytest.raises(InfrastructureError, match="rerun the command"):
        handle.spent()


@pytest.mark.parametrize(
    ("budget", "answers", "said"),
    [(Budget(tokens=25), 3, "30 of 25 tokens"), (Budget(usd=0.02), 2, "0.02 of 0.02 dollars"), (Budget(), 9, "")],
)
def test_nothing_is_asked_once_the_budget_is_spent(budget: Budget, answers: int, said: str) -> None:
    meter = Meter(budget, Spent())
    model = Metered(Answers(), meter)
    for _ in range(answers):
        assert model.chat(ASK).text == "a"
    assert said in meter.refusal()
    if said:
        with pytest.raises(BudgetSpentError, match=said):
            model.chat(ASK)
        assert meter.spent().tokens == 10 * answers


@pytest.mark.parametrize("wrong", [{"tokens": 0}, {"usd": 0.0}, {"usd": float("nan")}])
def test_a_budget_is_above_0(wrong: dict[str, float]) -> None:
    with pytest.raises(UserError, match="above 0"):
        Budget(**wrong)  # type: ignore[arg-type]


def test_dollars_need_prices(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOCAL_API_KEY", "any")
    monkeypatch.setenv("LOCAL_BASE_URL", "http://127.0.0.1:1/v1")
    given = ["eval", "--agents", "t3a", "--models", "local/m", "--tasks", "hvac_fan_max", "--scenarios", "grid"]
    result = CliRunner().invoke(app, [*given, "--budget-usd", "5", "--dry-run"])
    assert isinstance(result.exception, UserError)
    assert "usd_per_million_in" in str(result.exception)


def test_what_agents_tell_of_themselves_spends_no_budget(tmp_path: Path) -> None:
    """A later start goes by the rows where nothing else was noted."""
    rows = {model: SimpleNamespace(model=model, tokens_in=7, tokens_out=3, cost_usd=0.5) for model in ("none", "m")}
    store: Any = SimpleNamespace(rows=rows, folder=tmp_path)
    assert spent_before(store) == Spent(10, 0.5)
    rows["none"].tokens_in, rows["none"].cost_usd = 10**9, 1e9
    assert spent_before(store) == Spent(10, 0.5)


# --- over several workers ---------------------------------------------------------------------------------------


def plan(**values: object) -> Plan:
    tasks = ["hvac_fan_max", "hvac_driver_seat_heater"]
    return make_plan({"agents": ["t3a"], "tasks": tasks, "scenarios": ["grid"], "seeds": [0, 1]} | values)


def rows_of(folder: Path) -> dict[str, EpisodeRow]:
    return read_rows(folder, EpisodeRow)


@pytest.mark.slow
def test_a_budget_holds_over_all_workers_and_the_rest_is_run_later(sumo: None, tmp_path: Path) -> None:
    """Wherever it stops, both agents have run the same episodes, but for one at most of each worker."""
    wanted = plan(agents=["t3a", "no-op"])
    whole = run_plan(wanted, tmp_path / "whole", executor=Processes(2))
    assert (whole.judged, whole.stopped) == (8, "")
    assert not (tmp_path / "whole" / SPENT).exists()
    rows = rows_of(tmp_path / "whole").values()
    each = max(row.tokens_in + row.tokens_out for row in rows)
    total = sum(row.tokens_in + row.tokens_out for row in rows)
    folder, part = tmp_path / "e", 3 * total // 4
    end = run_plan(wanted, folder, executor=Processes(2), budget=Budget(tokens=part))
    assert "budget is spent" in end.stopped
    assert 0 < end.judged < 8
    assert end.errors == 0
    met = Counter(row.instance for row in rows_of(folder).values())
    assert sum(count == 1 for count in met.values()) <= 2
    assert 2 in met.values()
    spent = json.loads((folder / SPENT).read_text())["tokens"]
    assert part <= spent <= part + 2 * each
    again = run_plan(wanted, folder, executor=Processes(2), budget=Budget(tokens=part))
    assert (again.ran, "budget is spent" in again.stopped) == (0, True)
    end = run_plan(wanted, folder, executor=Processes(2), budget=Budget(tokens=3 * total))
    assert (end.judged, end.stopped) == (8, "")
    assert {name: steady(row) for name, row in rows_of(folder).items()} == {
        name: steady(row) for name, row in rows_of(tmp_path / "whole").items()
    }


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """A server that says nothing is to be done; when it was asked."""
    times: list[float] = []
    said = 'Situation: I see.\nAction: {"action_type": "wait"}'

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            times.append(time.monotonic())
            self.rfile.read(int(self.headers["Content-Length"]))
            choice = {"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": said}}
            body = json.dumps({"choices": [choice], "usage": {"prompt_tokens": 7, "completion_tokens": 3}}).encode()
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: object) -> None: ...

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    monkeypatch.setenv("LOCAL_API_KEY", "any")
    monkeypatch.setenv("LOCAL_BASE_URL", f"http://127.0.0.1:{server.server_port}/v1")
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    yield times
    server.shutdown()
    server.server_close()


@pytest.mark.slow
def test_questions_of_all_workers_together_keep_to_the_rate(sumo: None, asked: list[float], tmp_path: Path) -> None:
    per_minute = 300
    wanted = plan(models=[f"local/m?per_minute={per_minute}"], limits={"steps": 3})
    end = run_plan(wanted, tmp_path / "e", executor=Processes(2))
    assert (end.judged, end.errors) == (4, 0)
    assert len(asked) >= 12
    apart_s = 60 / per_minute
    assert asked[-1] - asked[0] >= (len(asked) - 1) * apart_s - 0.5
    spent = rows_of(tmp_path / "e").values()
    assert sum(row.tokens_in + row.tokens_out for row in spent) == 10 * len(asked)
