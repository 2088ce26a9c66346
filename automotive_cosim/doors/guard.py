"""What a server over HTTP asks of each request, and that of the Model Context Protocol.

A browser's page on this machine can send requests here, and so can another machine if the address is not a local
one: a request names this server, comes from no other site and, where there is a token, has it, in its address
(``?token=``) or as ``Authorization: Bearer``.
"""

from __future__ import annotations

import asyncio
import hmac
from collections.abc import Collection
from http import HTTPStatus
from typing import Any, ClassVar
from urllib.parse import parse_qs

import uvicorn
from mcp.server.mcpserver import MCPServer
from mcp.server.transport_security import TransportSecuritySettings
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.protocols.http.auto import AutoHTTPProtocol

from automotive_cosim.service.own_names import is_own, own_names

NOT_ITS_OWN = TransportSecuritySettings(enable_dns_rebinding_protection=False)
"""``Guarded`` asks for more."""


def serve_http(server: MCPServer[Any], host: str, port: int, token: str) -> None:
    """Serves until it is interrupted. Raises SystemExit: the address cannot be used."""
    app = server.streamable_http_app(max_request_body_size=MOST_BYTES, transport_security=NOT_ITS_OWN)
    guarded = Guarded(app, host, port, token)
    uvicorn.run(guarded, host=host, port=port, log_level="warning", http=Punctual)


OTHER_SITE = "other sites may not use this"
MOST_BYTES = 2**20
"""Longest request; an action has some hundred bytes, an assessment some thousand."""


MOST_CONNECTIONS = 256
"""At once. One more ends the oldest that has sent no whole request yet."""
PATIENCE_S = 10.0
"""In which a connection has to have sent one."""


_Protocol: Any = AutoHTTPProtocol


class Punctual(_Protocol):  # type: ignore[misc]
    """A connection that makes room for others until it has sent a whole request, and has to do so soon.

    uvicorn waits for ever, and at its own limit refuses whoever comes.
    """

    _open: ClassVar[dict[Punctual, None]] = {}

    def connection_made(self, transport: asyncio.Transport) -> None:
        """Makes room for itself, or ends if there is none."""
        super().connection_made(transport)
        self._open[self] = None
        if len(self._open) > MOST_CONNECTIONS:
            oldest = next(each for each in self._open if each.is_waiting)  # at last, this one
            del self._open[oldest]
            oldest.transport.abort()
        self._late = self.loop.call_later(PATIENCE_S, self._look, self.cycle)

    def connection_lost(self, exc: Exception | None) -> None:
        """Is gone."""
        self._open.pop(self, None)
        self._late.cancel()
        super().connection_lost(exc)

    @property
    def is_waiting(self) -> bool:
        """Whether a request is still to come, or to be sent to its end."""
        return bool(self.cycle is None or self.cycle.more_body or self.cycle.response_complete)

    def _look(self, before: object) -> None:
        """Ends where nothing has come about since it last looked."""
        if self.is_waiting and self.cycle is before:
            self.transport.abort()
        else:
            self._late = self.loop.call_later(PATIENCE_S, self._look, self.cycle if self.is_waiting else self)


class Guarded:
    """An application that answers requests that name this server, have its token, come from no other site and say
    how long they are: at most ``MOST_BYTES``."""

    def __init__(
        self, app: ASGIApp, host: str, port: int, token: str | None = None, also: Collection[str] = ()
    ) -> None:
        """Guards an application that listens there.

        Args:
            token: what a request has to give; None for nothing.
            also: further values of ``Host`` by which it may be asked, such as that of its address in a network.
        """
        self._app = app
        self._names, self._port = own_names(host), port
        self._also = frozenset(name.lower() for name in also)
        self._token = None if token is None else token.encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answers a request, or refuses it."""
        refusal = None if scope["type"] == "lifespan" else self._refusal(scope)
        app = self._app if refusal is None else PlainTextResponse(refusal[1], refusal[0])
        await app(scope, receive, send)

    def _refusal(self, scope: Scope) -> tuple[HTTPStatus, str] | None:
        headers = Headers(scope=scope)
        host, origin = headers.get("host", ""), headers.get("origin")
        if not is_own(host, self._names, self._port) and host.lower() not in self._also:
            return HTTPStatus.MISDIRECTED_REQUEST, "this server has another name; use the address that it printed"
        if origin not in (None, f"http://{host}"):
            return HTTPStatus.FORBIDDEN, OTHER_SITE
        length = headers.get("content-length", "0")
        if "transfer-encoding" in headers or not length.isdecimal():
            return HTTPStatus.LENGTH_REQUIRED, "say how long the request is"
        if int(length) > MOST_BYTES:
            return HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {MOST_BYTES:,} bytes are read"
        if self._token is None:
            return None
        kind, _, given = headers.get("authorization", "").partition(" ")
        if kind.lower() != "bearer":
            given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[-1]
        if not hmac.compare_digest(given.strip().encode("utf-8", "replace"), self._token):
            return HTTPStatus.FORBIDDEN, "the token is missing or wrong; use the address that the server printed"
        return None
