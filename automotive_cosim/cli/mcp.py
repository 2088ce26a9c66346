"""``automotive-cosim mcp``: a server for assistants that speak the Model Context Protocol."""

from __future__ import annotations

from typing import Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.doors.settings import McpSettings
from automotive_cosim.errors import SetupError, UserError, install_hint


@takes(McpSettings)
def mcp(**settings: Any) -> None:
    """Serve episodes to any assistant that speaks the Model Context Protocol."""
    import os
    import secrets
    import threading
    from contextlib import closing

    try:
        from automotive_cosim.doors.mcp import make_server
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("mcp", "mcp_types"):
            raise
        raise SetupError(f"the mcp package is missing; install it with `{install_hint('doors')}`") from error
    from automotive_cosim.service import EpisodeService

    told = filled(McpSettings, settings)
    if told.scenarios is not None and not told.scenarios.is_dir():
        raise UserError(f"{told.scenarios} is not a folder; give --scenarios a folder of scenarios")
    with closing(EpisodeService()) as service:
        server = make_server(service, told.interface, told.scenarios)
        if told.http is None:
            # Not on this thread: the server cannot be interrupted while it waits for standard input.
            talk = threading.Thread(target=server.run, args=("stdio",), daemon=True)
            talk.start()
            talk.join()
        else:
            from automotive_cosim.doors.guard import serve_http

            (host, port) = told.http
            token = os.environ.get("AUTOMOTIVE_COSIM_MCP_TOKEN") or secrets.token_urlsafe(24)
            typer.echo(f"http://{host}:{port}/mcp?token={token}")
            try:
                serve_http(server, host, port, token)
            except SystemExit as error:  # the address is in use, or not this machine's
                raise UserError(f"cannot serve at {host}:{port}; choose another address with --http") from error
