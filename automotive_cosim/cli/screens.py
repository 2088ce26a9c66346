"""``automotive-cosim show screens``: every screen of the cockpit in one picture."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer


def screens(
    out: Annotated[Path, typer.Option(help="Picture to write: .webp, .png or .jpg.")] = Path("runs/screens.webp"),
    scenario: Annotated[str, typer.Option(help="Scenario in which the car drives.")] = "paris_centre",
    language: Annotated[str, typer.Option(help="Language of the screens: en, fr, de or ja.")] = "en",
    screen: Annotated[str, typer.Option(help="Size of the screen: 1280x720, 1920x720 or 1080x1920.")] = "1280x720",
    width: Annotated[int, typer.Option(help="Width of each screen in pixels.", min=160, max=1280)] = 400,
    each: Annotated[Path | None, typer.Option(help="Folder for a full-size picture of each screen.")] = None,
) -> None:
    """Draw every screen by day and by night, as it is at the start of a drive."""
    from automotive_cosim.cockpit.signals import HMI
    from automotive_cosim.episode.conditions import Conditions
    from automotive_cosim.episode.situation import SituationFinder
    from automotive_cosim.episode.specification import EpisodeSpec, SeedSource
    from automotive_cosim.errors import UserError
    from automotive_cosim.report.contactsheet import contact_sheet, pictures
    from automotive_cosim.traffic.fork import Simulations

    if out.suffix not in (".webp", ".png", ".jpg"):
        raise UserError(
            f"{out} is not a picture format that can be written; give --out a name ending in .webp, .png or .jpg"
        )
    with closing(Simulations()) as simulations:
        finder = SituationFinder(
            EpisodeSpec(scenario=scenario, conditions=Conditions.named({"screen": screen})), simulations
        )
        with closing(finder.find(SeedSource(0).next()).world) as world:
            cockpit = world.cockpit
    cockpit.inject(HMI.LANGUAGE.path, language)
    out.parent.mkdir(parents=True, exist_ok=True)
    contact_sheet(cockpit, width).save(out, quality=80)
    if each is not None:
        each.mkdir(parents=True, exist_ok=True)
        for name, picture in pictures(cockpit):
            picture.save(each / f"{name.replace(', ', '_')}.png")
    typer.echo(f"{out} written")
