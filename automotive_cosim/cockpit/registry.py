"""The apps that there are: every file and folder of ``apps/``."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.resources import files

from automotive_cosim.cockpit.app import App, AppPage, Where

_PACKAGE = "automotive_cosim.cockpit.apps"


@cache
def apps() -> Mapping[str, App]:
    """Every app by its name, in their order. Raises ValueError: two apps or two screens have the same name."""
    here = list(files(_PACKAGE).iterdir())
    modules = [
        each.name.removesuffix(".py") for each in here if each.name.endswith(".py") and each.name != "__init__.py"
    ]
    modules += [f"{each.name}.app" for each in here if each.joinpath("app.py").is_file()]
    found: list[App] = [import_module(f"{_PACKAGE}.{module}").APP for module in sorted(modules)]
    found.sort(key=lambda app: app.order)
    for kind, names in (
        ("apps", [name for app in found for name in (app.name, *app.aliases)]),
        ("screens", [name for app in found for name in app.pages]),
    ):
        twice = {name for name in names if names.count(name) > 1}
        if twice:
            raise ValueError(
                f"two {kind} of the cockpit are named {', '.join(sorted(twice))}; name one of them anew"
            )
    return {app.name: app for app in found}


@cache
def apps_in(where: Where) -> tuple[App, ...]:
    """The apps that are opened there."""
    return tuple(app for app in apps().values() if app.where is where)


@cache
def pages() -> Mapping[str, AppPage]:
    """Every screen by its name."""
    return {name: page for app in apps().values() for name, page in app.pages.items()}


@cache
def docked() -> Mapping[str, str]:
    """By screen, the app of the dock that it belongs to; the launcher, unless its app is in the dock itself."""
    launcher = {Where.LAUNCHER: "apps", Where.STORE: "apps"}
    return {name: launcher.get(app.where, app.name) for app in apps().values() for name in app.pages}


@cache
def by_any_name() -> Mapping[str, tuple[str, str]]:
    """By name, title and other name, the app that opens and the part that is shown."""
    known = apps().values()
    return (
        {app.title.lower(): (app.name, "") for app in known}
        | {alias: (app.name, part) for app in known for alias, part in app.aliases.items()}
        | {app.name: (app.name, "") for app in known}
    )
