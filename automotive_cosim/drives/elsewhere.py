"""The drives of a family on another scenario, or on a network of somebody else's."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import Scenario, Trip, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic.additional import reading_once
from automotive_cosim.traffic.options import read_configuration, stamp
from automotive_cosim.traffic.rounds import in_turn


def elsewhere(script: DriveScript, place: str) -> DriveScript:
    """The same date, weather, people, car and staging on other roads: as many of the place's trips as can be driven
    one after another and over again.

    Args:
        place: a shipped scenario, or the path of a scenario's folder, a ``.sumocfg`` or a ``.net.xml``.

    Raises:
        UnknownNameError: no such scenario.
        ScenarioError: its files are invalid, or none of its trips can be driven again and again.
    """
    with reading_once():
        scenario = open_scenario(place)
        trips = _in_turn(scenario, stamp(read_configuration(scenario.config)))
    if not trips:
        raise ScenarioError(
            f"no trip of {place} leads back to its start, so a drive would end too soon; a drive needs a "
            "network in which the car can turn back"
        )
    turned = script.seed % len(trips)
    names = tuple(trip.name for trip in trips)
    return replace(script, scenario=place, trips=names[turned:] + names[:turned], origin=None)


def name_of(family: str, place: str) -> str:
    """What people call a drive of a family at a place: the family is named for its own place and its month."""
    known = FAMILIES.get(family)
    if not place or known is None or place == known.scenario:
        return family
    return f"{Path(place).name.partition('.')[0]}_{family.rpartition('_')[2]}"


@lru_cache(maxsize=16)
def _in_turn(scenario: Scenario, files: tuple[object, ...]) -> tuple[Trip, ...]:
    """Its trips that can be driven in turn; kept while its files are as they are, for every reset asks for them."""
    return in_turn(network_of(scenario).open_at_all_hours(), scenario.ego.trips)
