"""The apps that are installed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.state import AppData


@dataclass(frozen=True, slots=True)
class Installed(AppData):
    """Names of the installed apps, among those that can be removed."""

    apps: tuple[str, ...]

    def with_app(self, name: str, wanted: bool, offered: Iterable[str]) -> Installed:
        """A copy with or without an app, in the order of all that are offered."""
        return Installed(tuple(app for app in offered if (wanted if app == name else app in self.apps)))

    def commands(self) -> dict[str, Any]:
        return {"apps.installed": list(self.apps)}
