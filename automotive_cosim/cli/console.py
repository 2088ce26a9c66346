"""Tables, panels and progress in a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rich.console import Console as RichConsole
from rich.console import ConsoleOptions, RenderableType
from rich.segment import Segment

from automotive_cosim.formats.plain import plain


class Console(RichConsole):
    """rich's console for plain texts without markup."""

    def __init__(self, *, markup: bool = False, **named: Any) -> None:
        super().__init__(markup=markup, emoji=False, **named)

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """The pieces to write for something; rich's own controls are marked as such."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=plain(segment.text))
