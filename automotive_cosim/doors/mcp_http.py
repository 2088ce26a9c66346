"""The server of the Model Context Protocol over HTTP, for whoever has its token.

A browser's page on this machine can send requests here, and so can another machine if the address is not a local
one: a request names this server, comes from no other site, and has the token, in its address (``?token=``) or as
``Authorization: Bearer``.
"""

from __future__ import annotations

import hmac
from http import HTTPStatus
from typing import Any
from urllib.parse import parse_qs

import uvicorn
from mcp.server.mcpserver import MCPServer
from mcp.server.transport_security import TransportSecuritySettings
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from automotive_cosim.service.own_names import is_own, own_names

NOT_ITS_OWN = TransportSecuritySettings(enable_dns_rebinding_protection=False)
"""``Guarded`` asks for more."""
MOST_BYTES = 2**20
"""Longest request; an action has some hundred bytes."""


def serve_http(server: MCPServer[Any], host: str, port: int, token: str) -> None:
    """Serves until it is interrupted.

    Raises:
        SystemExit: the address cannot be used.
    """
    app = server.streamable_http_app(
        max_request_body_size=MOST_BYTES,
        transport_security=NOT_ITS_OWN,
    )
    uvicorn.run(Guarded(app, host, port, token), host=host, port=port, log_level="warning")


class Guarded:
    """An application that answers requests that name this server, have its token and come from no other site."""

    def __init__(self, app: ASGIApp, host: str, port: int, token: str) -> None:
        """Guards an application that listens there."""
        self._app = app
        self._names, self._port = own_names(host), port
        self._token = token.encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answers a request, or refuses it."""
        refusal = None if scope["type"] == "lifespan" else self._refusal(scope)
        app = self._app if refusal is None else PlainTextResponse(refusal[1], refusal[0])
        await app(scope, receive, send)

    def _refusal(self, scope: Scope) -> tuple[HTTPStatus, str] | None:
        headers = Headers(scope=scope)
        host, origin = headers.get("host", ""), headers.get("origin")
        if not is_own(host, self._names, self._port):
            return HTTPStatus.MISDIRECTED_REQUEST, "this server has another name; use the address that it printed"
        if origin not in (None, f"http://{host}"):
            return HTTPStatus.FORBIDDEN, "other sites may not use this"
        kind, _, given = headers.get("authorization", "").partition(" ")
        if kind.lower() != "bearer":
            given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[-1]
        if not hmac.compare_digest(given.strip().encode("utf-8", "replace"), self._token):
            return HTTPStatus.FORBIDDEN, "the token is missing or wrong; use the address that the server printed"
        return None
