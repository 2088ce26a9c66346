"""``automotive-cosim show``: what the car, the map and the files consist of."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import print_json, tells_json
from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError

app = typer.Typer(
    help="Show screens, apps, signals, functions, drives and their events, local law and file formats.",
    no_args_is_help=True,
)
"""Its commands stand in ``main.COMMANDS``, so that each is imported alone."""

FORMATS = {".webp": "WEBP", ".png": "PNG", ".jpg": "JPEG"}


def screens(
    out: Annotated[Path, typer.Option(help="Picture to write: .webp, .png or .jpg.")] = Path("runs/screens.webp"),
    language: Annotated[str, typer.Option(help="Language of the screens: en, fr, de or ja.")] = "en",
    screen: Annotated[str, typer.Option(help="Size of the screen: 1280x720, 1920x720 or 1080x1920.")] = "1280x720",
    make: Annotated[str, typer.Option(help="Whose cockpit: a make, or a file of your own (.toml).")] = "home",
) -> None:
    """Draw every screen by day and by night, as it is at the start of a drive."""
    from automotive_cosim.cockpit.signals import HMI
    from automotive_cosim.episode.conditions import Conditions
    from automotive_cosim.episode.situation import SituationFinder
    from automotive_cosim.episode.specification import EpisodeSpec, SeedSource
    from automotive_cosim.errors import UserError
    from automotive_cosim.formats.writing import drafted, make_folder
    from automotive_cosim.report.contactsheet import contact_sheet
    from automotive_cosim.traffic.fork import Simulations

    if out.suffix not in FORMATS:
        raise UserError(
            f"{out} is not a picture format that can be written; give --out a name ending in .webp, .png or .jpg"
        )
    under = Conditions.named({"screen": screen, "make": make})
    with closing(Simulations()) as simulations:
        finder = SituationFinder(EpisodeSpec(scenario="paris_centre", conditions=under), simulations)
        with closing(finder.find(SeedSource(0).next()).world) as world:
            cockpit = world.cockpit
    cockpit.inject(HMI.LANGUAGE.path, language)
    make_folder(out.parent)
    with drafted(out) as file:
        contact_sheet(cockpit).save(file, FORMATS[out.suffix], quality=80)
    typer.echo(f"{out} written")


@tells_json
def signals(as_json: bool = False) -> None:
    """List the vehicle's signals: path, kind, valid values, default."""
    from automotive_cosim.cockpit.signals import CATALOGUE

    if as_json:
        listed = [
            {"path": path, "kind": signal.kind, "values": signal.range, "default": signal.default}
            for path, signal in CATALOGUE.items()
        ]
        print_json({"signals": listed})
        return
    width = max(map(len, CATALOGUE))
    for path, signal in CATALOGUE.items():
        default = "nothing" if signal.default is None else json.dumps(signal.default)
        typer.echo(f"{path:<{width}}  {signal.kind:<8}  {signal.range}; {default}")


@tells_json
def functions(
    as_json: bool = False,
    tools: Annotated[
        str, typer.Option(metavar="FORM", help="Print them as tools of an API: openai, mcp or anthropic.")
    ] = "",
) -> None:
    """List the functions that an agent can call with --interface functions or both."""
    from automotive_cosim.errors import UnknownNameError
    from automotive_cosim.interface import functions as known

    forms = {"openai": known.as_openai, "mcp": known.as_mcp, "anthropic": known.as_anthropic}
    if tools and tools not in forms:
        raise UnknownNameError("form of tools", tools, forms)
    every = known.functions().values()
    if tools or as_json:
        form = forms.get(tools, known.as_json)
        print_json([form(function) for function in every])
        return
    for function in every:
        typer.echo(known.signature(function, is_told=False).removeprefix("- "))
        typer.echo(f"    {function.about}")
    typer.echo(f"\n{len(every)} functions; --json and --tools print their JSON Schemas")


@tells_json
def drives(as_json: bool = False) -> None:
    """List the families of drives, with their season and what can happen in them."""
    from automotive_cosim.drives.families import FAMILIES

    listed = [
        {"id": family.id, "season": family.season, "about": family.about, "stages": list(family.cast)}
        for family in FAMILIES.values()
    ]
    if as_json:
        print_json({"drives": listed})
        return
    for family in listed:
        typer.echo(f"{family['id']:24} {family['season']:7} {family['about']}")
        typer.echo(f"{'':34} stages {', '.join(family['stages'])}")


@tells_json
def apps(as_json: bool = False) -> None:
    """List the apps of the car by the names that the action open_app takes."""
    from automotive_cosim.cockpit.registry import apps as known

    told = [
        {"id": app.name, "about": f"{app.title}, {app.where.value}", "also": sorted(app.aliases)}
        for app in known().values()
    ]
    _tell("apps", told, as_json=as_json)


@tells_json
def events(as_json: bool = False) -> None:
    """List all that may happen on drives: kinds of events with what is due, and what can be staged.

    Each kind has its look-alike, when an alert is right, and the source."""
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


@tells_json
def wakes(as_json: bool = False) -> None:
    """List the changes of the readings that end a wait on a drive."""
    from automotive_cosim.drives.changes import WAKES

    _tell("wakes", [{"id": each.name, "about": each.about} for each in WAKES], as_json=as_json)


@tells_json
def spaces(as_json: bool = False) -> None:
    """List the scenarios that `search --space` knows by name."""
    from automotive_cosim.safety.space import LIBRARY, read_space

    _tell(
        "spaces", [{"id": name, "about": read_space(path).about} for name, path in LIBRARY.items()], as_json=as_json
    )


@tells_json
def factors(as_json: bool = False) -> None:
    """List what a search varies on drives, besides the conditions (`eval --help`)."""
    from automotive_cosim.drives.settings import DriveSettings
    from automotive_cosim.formats.docs import field_docs

    told = [{"id": name, "about": about} for name, about in field_docs(DriveSettings).items()]
    _tell("factors", told, as_json=as_json)


@tells_json
def policy(as_json: bool = False) -> None:
    """List the house rules, which `--policy house` tells an agent."""
    from automotive_cosim.interface.house_rules import HOUSE

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


@tells_json
def memory(
    file: Annotated[Path, typer.Argument(help="The file given to `run --memory`.")], as_json: bool = False
) -> None:
    """Show what ASURADA remembers: which strategy it tried where, for what, and how often it worked."""
    from automotive_cosim.agents.memory import Memory

    if not file.is_file():
        raise UserError(f"there is no memory in {file}; `automotive-cosim run --memory {file}` creates one")
    kept = list(Memory(file).all())
    if as_json:
        print_json([strategy.as_json() for strategy in kept])
        return
    for strategy in kept:
        typer.echo(f"{strategy.place}: “{strategy.goal}”")
        typer.echo(f"  when    {strategy.trigger}")
        typer.echo(f"  did     {strategy.steps}")
        typer.echo(f"  worked  {strategy.worked} of {strategy.worked + strategy.failed}")
    typer.echo("1 strategy" if len(kept) == 1 else f"{len(kept)} strategies")


def schema(
    name: Annotated[
        str | None, typer.Argument(help="Name of a format; omit it to list them.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="File to write; standard output if not given.", show_default=False)
    ] = None,
) -> None:
    """Print the JSON Schema of a file format, so that an editor can check and complete such files."""
    from automotive_cosim import schemas
    from automotive_cosim.errors import UserError
    from automotive_cosim.formats.writing import write_whole

    if name is None:
        if out is not None:
            raise UserError(f"--out {out} needs the NAME of a schema; `automotive-cosim show schema` lists them")
        for known in schemas.names():
            typer.echo(f"{known:<10}{schemas.about(known)}")
        return
    text = schemas.text(name)
    if out is None:
        typer.echo(text, nl=False)
    else:
        write_whole(out, text)
        typer.echo(f"{out} written")
