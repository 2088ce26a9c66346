"""``automotive-cosim a2a``: the benchmark as an evaluating agent."""

from __future__ import annotations

from typing import Any

import typer

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.doors.settings import A2aSettings
from automotive_cosim.errors import SetupError, UserError, install_hint


@takes(A2aSettings)
@takes(ExecutorSettings, only=["workers"])
def a2a(**settings: Any) -> None:
    """Serve the benchmark as an evaluating agent over A2A, as AgentBeats has it."""
    try:
        from automotive_cosim.doors.a2a import serve
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("a2a", "google", "httpx", "starlette", "uvicorn"):
            raise
        raise SetupError(f"the a2a-sdk package is missing; install it with `{install_hint('doors')}`") from error
    told = filled(A2aSettings, settings)
    typer.echo(told.url)
    try:
        serve(told.host, told.port, told.url, filled(ExecutorSettings, settings).processes)
    except SystemExit as error:  # the address is in use, or not this machine's
        raise UserError(
            f"cannot serve at {told.host}:{told.port}; choose another address with --host and --port"
        ) from error
