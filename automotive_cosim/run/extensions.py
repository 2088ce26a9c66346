"""What extends the package, which knows nothing of it: a sub-package with a module ``extension``.

Its ``COMMANDS`` are rows of the command line, also in its groups. Its ``kinds()`` are kinds of results folder, by
the word under ``study`` in the plan of a manifest. An installation without the sub-package lacks these and nothing
else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

import automotive_cosim
from automotive_cosim.errors import UserError

if TYPE_CHECKING:
    from automotive_cosim.contracts import Json
    from automotive_cosim.run.effect import ActEffect


@dataclass(frozen=True, slots=True)
class ResultsKind:
    """What can be done with a kind of results folder, as names of functions: ``package.module:function``."""

    page: str
    """Of the folder; writes the report into it and returns ``report.html``."""
    unit: str
    """What one of its rows is about: ``drive`` or ``seed``."""
    attributed: str = ""
    """Of the folder and the beginning of an item's id; what the acts in it changed."""
    served: Mapping[str, str] = field(default_factory=dict)
    """What the pages of ``serve`` ask, by the last part of its address; each of the folder, and of the item."""

    def write_page(self, folder: Path) -> Path:
        """Writes the folder's report; returns its page.

        Raises:
            UserError: the folder has no results, is damaged, or cannot be written.
            SetupError: the extra ``reports`` is not installed."""
        page: Path = resolve_name(self.page)(folder)
        return page

    def effects(self, folder: Path, item: str) -> list[ActEffect]:
        """What the acts of items changed.

        Raises UserError: this kind has no acts, or no such item, or cannot be read."""
        if not self.attributed:
            raise UserError(f"{folder} has no acts whose effect could be measured; give a folder with runs")
        found: list[ActEffect] = resolve_name(self.attributed)(folder, item)
        return found

    def shown(self, part: str, folder: Path, *items: str) -> Json | None:
        """What a page of ``serve`` shows of the folder; None if there is no such part.

        Raises UserError: it is not in the folder, or cannot be read."""
        if part not in self.served:
            return None
        values: Json = resolve_name(self.served[part])(folder, *items)
        return values


@cache
def extensions() -> tuple[Any, ...]:
    """The modules ``extension`` of all that are installed."""
    home = Path(automotive_cosim.__file__).parent
    names = sorted(path.parent.name for path in home.glob("*/extension.py"))
    return tuple(import_module(f"{automotive_cosim.__name__}.{name}.extension") for name in names)


def kind_of(plan: Mapping[str, Any]) -> ResultsKind | None:
    """The kind of a folder with that plan in its manifest; None for one of the package's own.

    Raises UserError: no extension here has that kind."""
    if "study" not in plan:
        return None
    for each in extensions():
        if kind := each.kinds().get(plan["study"]):
            found: ResultsKind = kind
            return found
    raise UserError(f"the folder has a study of kind {plan['study']!r}, which this installation cannot read")
