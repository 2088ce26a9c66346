"""Drives of a family on other roads."""

from dataclasses import replace

import pytest

from automotive_cosim.drives.elsewhere import elsewhere, name_of
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.scenarios import load, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic.rounds import planned

PLAN = FAMILIES["beauce_june"].draw(1)


@pytest.mark.slow
@pytest.mark.parametrize("place", ["grid", "paris_centre"])
def test_the_trips_of_another_place_are_driven_in_turn_and_all_else_stays(place: str) -> None:
    script, scenario = elsewhere(PLAN, place), open_scenario(place)
    first, *others = (scenario.trip(name) for name in script.trips)
    assert planned(network_of(scenario), first, (*others, first)).legs
    assert len(script.trips) >= 2
    assert replace(script, scenario=PLAN.scenario, trips=PLAN.trips) == PLAN


def test_a_drive_elsewhere_is_called_after_its_place() -> None:
    assert name_of("grid_january", "grid") == name_of("grid_january", "") == "grid_january"
    assert name_of("grid_january", "maps/heidelberg.sumocfg") == "heidelberg_january"
    assert name_of("paris_july", "tokyo") == "tokyo_july"


@pytest.mark.slow
def test_a_network_without_a_scenario_will_do() -> None:
    script = elsewhere(PLAN, str(load("grid").folder / "grid.net.xml"))
    assert script.trips
    assert elsewhere(PLAN, script.scenario) == script


def test_a_place_that_does_not_exist_is_refused() -> None:
    with pytest.raises(UnknownNameError):
        elsewhere(PLAN, "atlantis")
