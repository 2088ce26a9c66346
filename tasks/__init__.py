"""The catalogue of tasks, one file per module of the cockpit; the other suites have folders of their own."""

from __future__ import annotations

if __name__ != "automotive_cosim.tasks":
    raise ImportError(f"import this package as automotive_cosim.tasks, not as {__name__}")

import os
from pathlib import Path

from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasking.own_files import VARIABLE
from automotive_cosim.tasks import (
    apps,
    apps_asking,
    at_the_kerb,
    body_and_ears,
    clarify,
    comms,
    comms_aboard,
    comms_asking,
    folder,
    half_noticed,
    hard,
    hints,
    hvac,
    hvac_aboard,
    hvac_asking,
    hvac_hints,
    hvac_safety,
    leaving,
    left_to_the_car,
    limits,
    maps,
    maps_aboard,
    maps_asking,
    maps_hints,
    maps_safety,
    media,
    media_aboard,
    media_asking,
    noticed,
    on_the_open_road,
    one_of_two,
    outright,
    phenomenon,
    phenomenon_aboard,
    phenomenon_asking,
    refused,
    road,
    road_aboard,
    road_asking,
    second_thoughts,
    sign_and_sky,
    so_ordered,
    spoken,
    system,
    system_aboard,
    system_asking,
    system_doors_aboard,
    unasked,
    under_way,
    word_from_others,
)

__all__ = ["CATALOGUE"]

CATALOGUE = Catalogue()
"""Every task by its id."""

for _module in (
    maps,
    maps_asking,
    maps_hints,
    maps_safety,
    hvac,
    hvac_asking,
    hvac_hints,
    hvac_safety,
    road,
    road_asking,
    phenomenon,
    phenomenon_asking,
    media,
    media_asking,
    apps,
    apps_asking,
    system,
    system_asking,
    comms,
    comms_asking,
    second_thoughts,
    comms_aboard,
    hvac_aboard,
    maps_aboard,
    media_aboard,
    phenomenon_aboard,
    road_aboard,
    system_doors_aboard,
    system_aboard,
    leaving,
    under_way,
    outright,
    one_of_two,
    noticed,
    left_to_the_car,
    unasked,
    at_the_kerb,
    refused,
    on_the_open_road,
    half_noticed,
    body_and_ears,
    word_from_others,
    sign_and_sky,
    so_ordered,
    hints,
    hard,
    limits,
    clarify,
):
    CATALOGUE.add(*map(spoken.spoken, _module.TASKS))

if os.environ.get(VARIABLE):
    folder.add_folder(CATALOGUE, Path(os.environ[VARIABLE]))
