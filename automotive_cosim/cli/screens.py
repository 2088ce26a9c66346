"""``automotive-cosim show screens``: every screen of the cockpit in one picture."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

FORMATS = {".webp": "WEBP", ".png": "PNG", ".jpg": "JPEG"}


def screens(
    out: Annotated[Path, typer.Option(help="Picture to write: .webp, .png or .jpg.")] = Path("runs/screens.webp"),
    language: Annotated[str, typer.Option(help="Language of the screens: en, fr, de or ja.")] = "en",
    screen: Annotated[str, typer.Option(help="Size of the screen: 1280x720, 1920x720 or 1080x1920.")] = "1280x720",
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
    with closing(Simulations()) as simulations:
        finder = SituationFinder(
            EpisodeSpec(scenario="paris_centre", conditions=Conditions.named({"screen": screen})), simulations
        )
        with closing(finder.find(SeedSource(0).next()).world) as world:
            cockpit = world.cockpit
    cockpit.inject(HMI.LANGUAGE.path, language)
    make_folder(out.parent)
    with drafted(out) as file:
        contact_sheet(cockpit).save(file, FORMATS[out.suffix], quality=80)
    typer.echo(f"{out} written")
