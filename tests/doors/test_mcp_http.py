"""Over HTTP, the server answers whoever has its token, under its own names, and no other site's pages."""

import http.client
import socket
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import pytest

pytest.importorskip("mcp", reason="the extra doors is not installed")
import anyio
import uvicorn

from automotive_cosim.doors import guard
from automotive_cosim.doors.guard import Guarded, Punctual
from automotive_cosim.service.own_names import is_own, own_names
from tests.laws import over

PORT, TOKEN = 8123, "the-token"
OWN = f"127.0.0.1:{PORT}"
BEARER = {"authorization": f"Bearer {TOKEN}"}


async def reached(scope: Any, receive: Any, send: Any) -> None:
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"reached"})


def status(
    headers: Mapping[str, str], query: str = "", host: str = "127.0.0.1", path: str = "/mcp", app: Any = None
) -> int:
    """The status of the answer to a request."""
    sent: list[Any] = []

    async def receive() -> Any:
        return {"type": "http.request", "body": b"{}", "more_body": False}

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {
        "type": "http",
        "method": "POST",
        "path": path,
        "query_string": query.encode("latin-1"),
        "headers": [(name.encode(), value.encode("latin-1")) for name, value in headers.items()],
    }
    anyio.run(app or Guarded(reached, host, PORT, TOKEN), scope, receive, send)
    return int(sent[0]["status"])


@contextmanager
def listening() -> Iterator[int]:
    """A server that answers whoever comes; its port."""
    with socket.create_server(("127.0.0.1", 0), backlog=200) as line:
        config = uvicorn.Config(reached, http=Punctual, log_level="error", lifespan="off")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [line]})
        thread.start()
        try:
            yield line.getsockname()[1]
        finally:
            server.should_exit = True
            thread.join()


def answered(port: int) -> bool:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("GET", "/")
    found = connection.getresponse().read() == b"reached"
    connection.close()
    return found


def test_idle_connections_keep_nobody_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "MOST_CONNECTIONS", 8)
    with listening() as port:
        idle = [socket.create_connection(("127.0.0.1", port), timeout=20) for _ in range(40)]
        assert answered(port)
        assert all(ended(each) for each in idle[:30])
        for each in idle:
            each.close()


@pytest.mark.parametrize("sent", [b"", b"GET / HT", b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n{"])
def test_a_connection_has_to_send_its_request_soon(monkeypatch: pytest.MonkeyPatch, sent: bytes) -> None:
    monkeypatch.setattr(guard, "PATIENCE_S", 0.1)
    with listening() as port, socket.create_connection(("127.0.0.1", port), timeout=20) as slow:
        slow.sendall(sent)
        while not ended(slow):  # what answers before the body has come may have answered
            pass
        assert answered(port)


def ended(line: socket.socket) -> bool:
    try:
        return line.recv(65536) == b""
    except ConnectionResetError:
        return True


def test_the_token_is_taken_from_the_address_or_the_header() -> None:
    for name in (OWN, f"localhost:{PORT}", f"[::1]:{PORT}", f"LOCALHOST:{PORT}"):
        assert status({"host": name} | BEARER) == 200
        assert status({"host": name}, f"token={TOKEN}") == 200
        assert status({"host": name, "origin": f"http://{name}"} | BEARER) == 200


REFUSED = (
    *((403, {"host": OWN}, query, "/mcp") for query in ("", "token=", "token=the-toke", "token=the-token2",
      "token=%ff%fe", "TOKEN=the-token", "token=the%00-token")),
    *((403, {"host": OWN, "authorization": given}, "", "/mcp") for given in ("", "Bearer", "Bearer ",
      "Bearer wrong", "Basic the-token", "the-token", "Bearer \xff", "bearer the-token x")),
    *((421, {"host": name} | BEARER, "", "/mcp") for name in ("", "evil.example", f"evil.example:{PORT}",
      "127.0.0.1", "127.0.0.1:80", f"127.0.0.1.evil.example:{PORT}", f"{OWN}@evil.example", f"evil.example#{OWN}",
      f"10.0.0.1:{PORT}", "127.0.0.1:x")),
    (421, BEARER, "", "/mcp"),
    *((403, {"host": OWN, "origin": origin} | BEARER, "", "/mcp") for origin in ("null", "http://evil.example",
      f"https://127.0.0.1:{PORT}", "http://127.0.0.1:80", f"http://localhost:{PORT}", "")),
    *((403, {"host": OWN}, "", path) for path in ("/", "/mcp", "/mcp/", "/docs", "//mcp")),
)  # fmt: skip
"""The answer to a request with another token in the address or the header; with the token, under a name that is not
the server's, without one, or from another site's page; and to any path without the token."""


@over(REFUSED)
def test_who_does_not_belong_here_is_refused(code: int, headers: Mapping[str, str], query: str, path: str) -> None:
    assert status(headers, query, path=path) == code


def test_one_that_listens_everywhere_is_asked_by_any_address_but_by_no_foreign_name() -> None:
    names = own_names("0.0.0.0")
    assert is_own(f"10.1.2.3:{PORT}", names, PORT)
    assert is_own(f"[fe80::1]:{PORT}", names, PORT)
    assert not is_own(f"evil.example:{PORT}", names, PORT)
    assert status({"host": f"10.1.2.3:{PORT}"} | BEARER, host="0.0.0.0") == 200
    assert status({"host": f"10.1.2.3:{PORT}"}, host="0.0.0.0") == 403
