"""``automotive-cosim a2a``: the benchmark as an evaluating agent."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import TasksFrom, whole_number
from automotive_cosim.errors import SetupError, UserError, install_hint


@takes(ExecutorSettings, only=["workers"])
def a2a(
    host: Annotated[str, typer.Option(help="Address to listen at; 0.0.0.0 for every one.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port.", metavar="N", parser=whole_number(1, 65535))] = 9009,
    card_url: Annotated[
        str,
        typer.Option(help="Its address as others see it, for its card.", show_default="http://HOST:PORT/"),
    ] = "",
    tasks_from: TasksFrom = None,
    **settings: Any,
) -> None:
    """Serve the benchmark as an evaluating agent over A2A, as AgentBeats has it."""
    try:
        from automotive_cosim.doors.a2a import serve
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("a2a", "google", "httpx", "starlette", "uvicorn"):
            raise
        raise SetupError(f"the a2a-sdk package is missing; install it with `{install_hint('a2a')}`") from error
    url = card_url or f"http://{host}:{port}/"
    typer.echo(url)
    try:
        serve(host, port, url, filled(ExecutorSettings, settings).processes)
    except SystemExit as error:  # the address is in use, or not this machine's
        raise UserError(f"cannot serve at {host}:{port}; choose another address with --host and --port") from error
