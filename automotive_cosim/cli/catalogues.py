"""``automotive-cosim show`` with ``apps``, ``events``, ``wakes``, ``spaces``, ``factors`` or ``policy``."""

from __future__ import annotations

from collections.abc import Sequence

import typer

from automotive_cosim.cli.options import AsJson, print_json
from automotive_cosim.contracts import Json


def apps(as_json: AsJson = False) -> None:
    """List the apps of the car by the names that the action open_app takes."""
    from automotive_cosim.cockpit.registry import apps as known

    told = [
        {"id": app.name, "about": f"{app.title}, {app.where.value}", "also": sorted(app.aliases)}
        for app in known().values()
    ]
    _tell("apps", told, as_json=as_json)


def events(as_json: AsJson = False) -> None:
    """List all that may happen on drives: kinds of events with what is due, and what can be staged.

    Each kind has its look-alike, when an alert is right, and the source.
    """
    from automotive_cosim.drives.events import KINDS
    from automotive_cosim.drives.staging import BRINGS, ON_REQUEST

    _tell(
        "events",
        [
            {
                "id": kind.name,
                "stage": kind.name if kind.name in ON_REQUEST else "",
                "about": kind.about,
                "lookalike": kind.lookalike,
                "alerts": sorted(kind.alerts),
                "told_by": list(kind.told_by),
                "neutral": kind.neutral,
                "prepares_s": kind.lasts_s,
                "weight": kind.weight,
                "source": kind.source,
            }
            for kind in KINDS.values()
        ]
        + [
            {"id": name, "about": f"staged, brings about {' and '.join(kinds)}", "stage": name}
            for name, kinds in BRINGS.items()
        ],
        as_json=as_json,
    )


def wakes(as_json: AsJson = False) -> None:
    """List the changes of the readings that end a wait on a drive."""
    from automotive_cosim.drives.changes import WAKES

    _tell("wakes", [{"id": each.name, "about": each.about} for each in WAKES], as_json=as_json)


def spaces(as_json: AsJson = False) -> None:
    """List the scenarios that `search --space` knows by name."""
    from automotive_cosim.safety.space import LIBRARY, read_space

    _tell(
        "spaces", [{"id": name, "about": read_space(path).about} for name, path in LIBRARY.items()], as_json=as_json
    )


def factors(as_json: AsJson = False) -> None:
    """List what a search varies on drives, besides the conditions (`eval --help`)."""
    from automotive_cosim.drives.settings import DriveSettings
    from automotive_cosim.formats.docs import field_docs

    told = [{"id": name, "about": about} for name, about in field_docs(DriveSettings).items()]
    _tell("factors", told, as_json=as_json)


def policy(as_json: AsJson = False) -> None:
    """List the house rules, which `--policy house` tells an agent."""
    from automotive_cosim.interface.policy import HOUSE

    told = [{"id": str(each.id), "about": each.words, "source": each.source} for each in HOUSE]
    _tell("policy", told, as_json=as_json)


def _tell(name: str, listed: Sequence[Json], *, as_json: bool) -> None:
    if as_json:
        print_json({name: list(listed)})
        return
    for entry in listed:
        typer.echo(f"{entry['id']:20} {entry['about']}")
        for key, value in entry.items():
            if key not in ("id", "about") and value not in ([], ""):
                words = (
                    ", ".join(value) if isinstance(value, list) else f"{value:g}" if _is_number(value) else value
                )
                typer.echo(f"{'':20}   {key.replace('_', ' ')}: {words}")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)
