"""``automotive-cosim show screens``: every screen of the cockpit in one picture."""

from __future__ import annotations

from contextlib import closing
from typing import Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.report.settings import ScreensSettings

FORMATS = {".webp": "WEBP", ".png": "PNG", ".jpg": "JPEG"}


@takes(ScreensSettings)
def screens(**settings: Any) -> None:
    """Draw every screen by day and by night, as it is at the start of a drive."""
    from automotive_cosim.cockpit.signals import HMI
    from automotive_cosim.episode.conditions import Conditions
    from automotive_cosim.episode.situation import SituationFinder
    from automotive_cosim.episode.specification import EpisodeSpec, SeedSource
    from automotive_cosim.errors import UserError
    from automotive_cosim.formats.writing import drafted, make_folder
    from automotive_cosim.report.contactsheet import contact_sheet
    from automotive_cosim.traffic.fork import Simulations

    told = filled(ScreensSettings, settings)
    if told.out.suffix not in FORMATS:
        raise UserError(
            f"{told.out} is not a picture format that can be written; give --out a name ending in .webp, .png or "
            ".jpg"
        )
    with closing(Simulations()) as simulations:
        finder = SituationFinder(
            EpisodeSpec(scenario="paris_centre", conditions=Conditions.named({"screen": told.screen})), simulations
        )
        with closing(finder.find(SeedSource(0).next()).world) as world:
            cockpit = world.cockpit
    cockpit.inject(HMI.LANGUAGE.path, told.language)
    make_folder(told.out.parent)
    with drafted(told.out) as file:
        contact_sheet(cockpit).save(file, FORMATS[told.out.suffix], quality=80)
    typer.echo(f"{told.out} written")
