"""``automotive-cosim mcp``: a server for assistants that speak the Model Context Protocol."""

from __future__ import annotations

from typing import Annotated

import typer

from automotive_cosim.cli.options import TasksFrom, number, whole_number
from automotive_cosim.contracts.given import Interface
from automotive_cosim.errors import SetupError, UserError, install_hint


def _address(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise typer.BadParameter(f"{text!r} is not an address; give HOST:PORT, such as 127.0.0.1:8000")
    return host, int(port)


def mcp(
    http: Annotated[
        str,
        typer.Option(
            help="Serve streamable HTTP at http://HOST:PORT/mcp, for whoever has the token, instead of standard "
            "input and output.",
            metavar="HOST:PORT",
            show_default=False,
        ),
    ] = "",
    token: Annotated[
        str,
        typer.Option(
            envvar="AUTOMOTIVE_COSIM_MCP_TOKEN",
            help="What requests over HTTP have to give, in the address or as a bearer token.",
            show_default="a new one each time",
        ),
    ] = "",
    episodes: Annotated[
        int, typer.Option(help="Maximum number of concurrent episodes.", metavar="N", parser=whole_number(1, 1000))
    ] = 16,
    idle_s: Annotated[
        float,
        typer.Option(
            "--idle-s",
            help="Seconds after which an idle episode is closed.",
            metavar="SECONDS",
            parser=number(1, 1e6),
        ),
    ] = 900.0,
    interface: Annotated[
        Interface,
        typer.Option(help="How assistants act: on the screen (act), by functions of the car as tools, or by both."),
    ] = Interface.TOUCH,
    tasks_from: TasksFrom = None,
) -> None:
    """Serve episodes to any assistant that speaks the Model Context Protocol."""
    import secrets
    import threading
    from contextlib import closing

    try:
        from automotive_cosim.doors.mcp import make_server
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("mcp", "mcp_types"):
            raise
        raise SetupError(f"the mcp package is missing; install it with `{install_hint('mcp')}`") from error
    from automotive_cosim.service import EpisodeService, ServiceLimits

    address = _address(http) if http else None
    with closing(EpisodeService(limits=ServiceLimits(episodes, idle_s))) as service:
        server = make_server(service, interface)
        if address is None:
            # Not on this thread: the server cannot be interrupted while it waits for standard input.
            talk = threading.Thread(target=server.run, args=("stdio",), daemon=True)
            talk.start()
            talk.join()
        else:
            from automotive_cosim.doors.mcp_http import serve_http

            asked = token or secrets.token_urlsafe(24)
            typer.echo(f"http://{http}/mcp?token={asked}")
            try:
                serve_http(server, *address, asked)
            except SystemExit as error:  # the address is in use, or not this machine's
                raise UserError(f"cannot serve at {http}; choose another address with --http") from error
