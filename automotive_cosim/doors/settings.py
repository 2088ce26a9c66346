"""What can be set about the servers that others connect to. Each field is an option of ``mcp`` or ``a2a``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.contracts.given import Interface
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import OneOf, Option


def read_address(text: str) -> tuple[str, int]:
    """A host and a port. Raises UserError: it is no address."""
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise UserError(f"--http: {text!r} is not an address; give HOST:PORT, such as 127.0.0.1:8000")
    return host, int(port)


@dataclass(frozen=True, slots=True)
class McpSettings:
    """How the Model Context Protocol is served."""

    http: Annotated[tuple[str, int] | None, Option(form="HOST:PORT", read=read_address)] = None
    """Serve streamable HTTP at http://HOST:PORT/mcp, for whoever has the token, instead of standard input and
    output. AUTOMOTIVE_COSIM_MCP_TOKEN is the token; without it, each start draws one."""
    scenarios: Annotated[Path | None, Option(form="FOLDER")] = None
    """A folder of scenarios of your own, which assistants may name beside the shipped ones."""
    interface: Annotated[Interface, OneOf(Interface, "interface"), Option(form="|".join(Interface))] = (
        Interface.TOUCH
    )
    """How assistants act: on the screen (act), by functions of the car as tools, or by both."""


@dataclass(frozen=True, slots=True)
class A2aSettings:
    """Where the evaluating agent is served over A2A."""

    host: str = "127.0.0.1"
    """Address to listen at; 0.0.0.0 for every one."""
    port: Annotated[int, Ge(1), Le(65535)] = 9009
    """Port."""
    card_url: Annotated[str, Option(default="http://HOST:PORT/")] = ""
    """Its address as others see it, for its card."""

    @property
    def url(self) -> str:
        """The address on its card."""
        return self.card_url or f"http://{self.host}:{self.port}/"
