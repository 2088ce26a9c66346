"""A scripted agent that speaks A2A, for tests: it answers what a function says, and keeps what it heard."""

import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

Json = dict[str, Any]
CARD_1_0 = {
    "name": "scripted",
    "description": "scripted",
    "version": "1",
    "supportedInterfaces": [
        {"url": "http://elsewhere.invalid:1/rpc", "protocolBinding": "JSONRPC", "protocolVersion": "1.0"}
    ],
    "capabilities": {"streaming": False},
    "defaultInputModes": ["text/plain"],
    "defaultOutputModes": ["text/plain"],
    "skills": [],
}
CARD_0_3 = {
    **{name: value for name, value in CARD_1_0.items() if name != "supportedInterfaces"},
    "url": "http://elsewhere.invalid:1/rpc",
    "protocolVersion": "0.3.0",
    "preferredTransport": "JSONRPC",
}
FAN = {"tool_name": "set_hvac_fan_speed", "arguments": {"percent": 100}}
DONE = {"tool_name": "status", "arguments": {"goal_status": "complete"}}


class RawError(Exception):
    """Makes the agent answer with a status, headers and bytes of its own."""

    def __init__(self, body: bytes = b"", status: int = 200, **headers: str) -> None:
        super().__init__(body)
        self.body, self.status = body, status
        self.headers = {name.replace("_", "-"): value for name, value in headers.items()}


Script = Callable[["RemoteAgent", Json, int], list[Any]]
"""From the agent, the message that it heard, and the number of messages of this context before, to the parts of its
answer: strings for text, objects for data."""


class RemoteAgent:
    """What it heard, by context, and how it answers."""

    def __init__(self, script: Script, card: Json | None = CARD_1_0, card_path: str = "agent-card.json") -> None:
        self.script, self.card, self.card_path = script, card, card_path
        self.heard: dict[str, list[Json]] = {}
        self.metadata: Json = {}
        """Of its next answers."""
        self.address = ""
        self.context: str | None = None
        """Says this context in place of the one that it was asked in."""
        self._lock = threading.Lock()

    @property
    def messages(self) -> list[Json]:
        return [message for messages in self.heard.values() for message in messages]

    def answer(self, request: Json) -> Json:
        message = request["params"]["message"]
        context = message["contextId"]
        with self._lock:
            turn = len(self.heard.setdefault(context, []))
            self.heard[context].append(message)
        old = request["method"] == "message/send"
        parts = [_part(each, old) for each in self.script(self, message, turn)]
        said = {
            "messageId": f"m{turn}",
            "contextId": self.context or context,
            "role": "agent" if old else "ROLE_AGENT",
            "parts": parts,
            "metadata": self.metadata,
        }
        result = said | {"kind": "message"} if old else {"message": said}
        return {"jsonrpc": "2.0", "id": request["id"], "result": result}


def _part(told: Any, old: bool) -> Json:
    kind = "text" if isinstance(told, str) else "data"
    return {kind: told} | ({"kind": kind} if old else {})


def data(message: Json) -> Json:
    """All data of a message."""
    return {name: value for part in message["parts"] for name, value in part.get("data", {}).items()}


def text(message: Json) -> str:
    """All text of a message."""
    return "\n".join(part["text"] for part in message["parts"] if "text" in part)


@contextmanager
def served(agent: RemoteAgent) -> Iterator[RemoteAgent]:
    """Serves an agent at ``agent.address``."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            known = self.path == f"/.well-known/{agent.card_path}"
            self._send(200 if known else 404, json.dumps(agent.card).encode() if known else b"", {})

        def do_POST(self) -> None:
            request = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            try:
                self._send(200, json.dumps(agent.answer(request)).encode(), {})
            except RawError as raw:
                self._send(raw.status, raw.body, raw.headers)

        def _send(self, status: int, body: bytes, headers: dict[str, str]) -> None:
            try:
                self.send_response(status)
                for name, value in (
                    {"Content-Type": "application/json", "Content-Length": str(len(body))} | headers
                ).items():
                    self.send_header(name, value)
                self.end_headers()
                self.wfile.write(body)
            except OSError:  # who asked waits no more
                pass

        def log_message(self, *args: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
    agent.address = f"http://127.0.0.1:{server.server_port}"
    try:
        yield agent
    finally:
        server.shutdown()
        server.server_close()
