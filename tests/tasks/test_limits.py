"""Laws over the suite of limits."""

import pytest

from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.signals import HVAC, SEAT
from automotive_cosim.contracts import GoalStatus
from automotive_cosim.tasking.dialogue import untold
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.moves import Inform
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

LIMITS = CATALOGUE.of(Suite.LIMITS)
TOLD = [
    (task, half, number) for task in LIMITS for half in task.halves if task.half(half).tells for number in range(6)
]
CONTENT = dict.fromkeys(("places", "contacts"), ("something",))


def test_there_are_thirty_pairs_and_more_of_every_module():
    assert len(LIMITS) >= 30
    assert len({task.module for task in LIMITS}) == 8
    assert not any(task.id.startswith("limits_") for task in CATALOGUE.of(Suite.STANDARD))


@over(LIMITS)
def test_a_limit_is_a_pair_whose_second_half_cannot_be_done(task):
    assert task.id.startswith("limits_")
    assert task.second is not None
    assert task.first.declares is GoalStatus.COMPLETE
    assert task.second.declares is GoalStatus.INFEASIBLE
    assert task.second.tells
    assert len(task.templates) == 5


@over(TOLD)
def test_the_reference_solution_tells_all_and_silence_does_not(task, half, number):
    instance = draw(task, half, number, CONTENT)
    said = [move.text for move in instance.moves if isinstance(move, Inform)]
    assert untold(said, instance.half.tells) == ()
    assert untold([], instance.half.tells) == instance.half.tells
    assert all(len(text) <= 120 for text in said)


@over([(task, number) for task in LIMITS for number in range(6)])
def test_the_words_for_one_half_do_not_serve_in_the_other(task, number):
    first, second = (draw(task, half, number, CONTENT) for half in task.halves)
    said = [move.text for move in first.moves if isinstance(move, Inform)]
    assert untold(said, second.half.tells)
    assert not second.half.goal.writes


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("The seats have no ventilation.", 0),
        ("I've set the ventilation to low.", 1),
        ("That isn't possible.", 1),
        ("", 2),
    ],
)
def test_a_driver_has_been_told_by_any_of_some_words(said, left):
    assert len(untold([said], (("ventilation", "seat fan"), ("no", "not", "isn t")))) == left


@pytest.mark.parametrize(
    ("task", "said"),
    [
        ("limits_rear_defroster", "The rear defroster isn't working, it has to be seen to."),
        ("limits_wind_that_cannot_be", "I can't tell: the wind reading cannot be right."),
        ("limits_pressure_that_cannot_be", "Its pressure reads far too high; the sensor looks defective."),
        ("limits_ticket_without_a_network", "The car is offline, so I couldn't pay for the parking."),
    ],
)
def test_plain_words_tell_what_is_missing(task, said):
    assert untold([said], draw(CATALOGUE[task], "second", 0, CONTENT).half.tells) == ()


@pytest.mark.parametrize("task", ["limits_coldest_air", "limits_charge_to_the_brim", "limits_slow_limiter"])
def test_the_value_that_was_asked_for_or_the_last_one_there_is_tells_a_range(task):
    drawn = draw(CATALOGUE[task], "second", 0, CONTENT)
    asked = next(iter(drawn.parameters.values()))
    shown = f"{asked:g}" if isinstance(asked, float) else asked
    assert untold([f"{shown} is not possible in this car."], drawn.half.tells) == ()


def test_a_wrong_reading_that_is_passed_on_does_not_tell_that_it_is_wrong():
    tells = draw(CATALOGUE["limits_wind_that_cannot_be"], "second", 0, CONTENT).half.tells
    assert untold(["The wind sensor reads 388 km/h."], tells)


def test_a_form_may_be_filled_in_before_it_turns_out_that_it_cannot_be_sent():
    second = draw(CATALOGUE["limits_ticket_without_a_network"], "second", 0, CONTENT).half
    assert second.allowed_writes == {"parking.zone", "parking.minutes"}


def test_the_lowest_temperature_is_told_wherever_it_is_set():
    (lack,) = draw(CATALOGUE["limits_coldest_air"], "second", 0, CONTENT).half.start.lacks
    assert {"hvac.driver_temperature", "dock.driver_temperature.value"} <= set(lack.keys)


def test_a_lack_bars_its_values_alone():
    airing = Lacking("seat ventilation", (SEAT.DRIVER_HEATING,), (-100.0, -1.0))
    assert airing.bars(SEAT.DRIVER_HEATING, -50.0)
    assert not airing.bars(SEAT.DRIVER_HEATING, 50.0)
    assert not airing.bars(SEAT.PASSENGER_HEATING, -50.0)
    feet = Lacking("air vents for the feet", (HVAC.AIR_DISTRIBUTION,), ("DOWN",))
    assert feet.bars(HVAC.AIR_DISTRIBUTION, "DOWN")
    assert not feet.bars(HVAC.AIR_DISTRIBUTION, "UP")
