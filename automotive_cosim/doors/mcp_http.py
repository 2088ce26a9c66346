"""The server of the Model Context Protocol over HTTP, for whoever has its token."""

from __future__ import annotations

from typing import Any

import uvicorn
from mcp.server.mcpserver import MCPServer
from mcp.server.transport_security import TransportSecuritySettings

from automotive_cosim.doors.guard import MOST_BYTES, Guarded, Punctual

NOT_ITS_OWN = TransportSecuritySettings(enable_dns_rebinding_protection=False)
"""``Guarded`` asks for more."""


def serve_http(server: MCPServer[Any], host: str, port: int, token: str) -> None:
    """Serves until it is interrupted. Raises SystemExit: the address cannot be used."""
    app = server.streamable_http_app(max_request_body_size=MOST_BYTES, transport_security=NOT_ITS_OWN)
    guarded = Guarded(app, host, port, token)
    uvicorn.run(guarded, host=host, port=port, log_level="warning", http=Punctual)
