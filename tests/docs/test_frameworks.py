"""The examples for agent frameworks, each against a scripted server that speaks chat completions.

``AUTOMOTIVE_COSIM_FRAMEWORKS`` names a Python in which the frameworks are installed, as their requirements need not
fit this package's.
"""

import json
import os
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).parents[2] / "docs/examples/frameworks"
PYTHON = os.environ.get("AUTOMOTIVE_COSIM_FRAMEWORKS", sys.executable)
NEEDS = {
    "openai_agents.py": ("agents.mcp",),
    "langgraph_car.py": ("langgraph", "langchain_mcp_adapters", "langchain_openai"),
    "smolagents_car.py": ("mcpadapt", "openai", "smolagents"),
}
LONGEST = 15
"""Lines of code of an example."""


class _Model(BaseHTTPRequestHandler):
    """Starts the episode, sets the fan, declares, ends, and tells what it was told last."""

    def do_POST(self) -> None:
        asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        told = [(each["role"], json.dumps(each["content"])) for each in asked["messages"]]
        results = [text for role, text in told if role == "tool" or (role == "user" and "Observation:" in text)]
        found = [match for each in results if (match := re.search(r"episode_id\W+([\w-]+)", each))]
        named = {"episode_id": found[0][1]} if found else {}
        script: list[tuple[str, dict[str, Any]]] = [
            ("start", {"task": "hvac_fan_max", "scenario": "grid", "see": "nothing"}),
            ("set_hvac_fan_speed", {**named, "percent": 100}),
            ("status", {**named, "goal_status": "complete"}),
            ("finish", named),
        ]
        message: dict[str, Any] = {"role": "assistant", "content": None}
        calls = script[len(results) :][:1]
        if not calls and any(each["function"]["name"] == "final_answer" for each in asked["tools"]):
            calls = [("final_answer", {"answer": results[-1]})]  # how an agent of smolagents ends
        if not calls:
            message["content"] = results[-1]
        else:
            message["tool_calls"] = [
                {
                    "id": f"call_{len(results)}",
                    "type": "function",
                    "function": {"name": name, "arguments": json.dumps(given)},
                }
                for name, given in calls
            ]
        choice = {"index": 0, "finish_reason": "tool_calls" if calls else "stop", "message": message}
        usage = {"prompt_tokens": 1, "completion_tokens": 1, "total_tokens": 2}
        body = {"id": "x", "object": "chat.completion", "created": 0, "model": "m", "choices": [choice]}
        answer = json.dumps(body | {"usage": usage}).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(answer)))
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *args: object) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Says nothing."""


@pytest.fixture
def model() -> Iterator[str]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Model)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}/v1"
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize("example", NEEDS)
def test_an_example_is_short(example):
    lines = (FOLDER / example).read_text(encoding="utf-8").splitlines()
    assert len([line for line in lines if line.strip() and not line.startswith('"""')]) <= LONGEST


@pytest.mark.slow
@pytest.mark.sumo
@pytest.mark.parametrize("example", NEEDS)
def test_an_example_wins(example, model, tmp_path):
    for name in NEEDS[example]:
        tried = subprocess.run([PYTHON, "-c", f"import {name}"], cwd=tmp_path, capture_output=True, check=False)
        if tried.returncode:
            pytest.skip(f"{PYTHON} has no {name}; AUTOMOTIVE_COSIM_FRAMEWORKS names one that has")
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    own = {"PATH": path, "OPENAI_BASE_URL": model, "OPENAI_API_KEY": "none", "OPENAI_AGENTS_DISABLE_TRACING": "1"}
    done = subprocess.run(
        [PYTHON, str(FOLDER / example), "m"],
        env={**os.environ, **own},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    assert '"success": true' in done.stdout.replace("\\", ""), done.stdout[-2000:]
