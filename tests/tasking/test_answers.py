"""What the driver is told: true where it says that all is well, and nothing that would be right elsewhere."""

import pytest

from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.verdict import only_answered
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

TRUE = (
    "No, everything is fine.",
    "You are not too fast here.",
    "Nothing has been left on.",
    "You're within what is allowed on this road.",
    "All clear, nobody is in your way.",
    "It isn't needed: 80 is posted, and you drive 78.",
    "The lamp may stay on in this fog.",
)
FALSE = (
    "",
    "Yes.",
    "You are too fast, slow down!",
    "The limit here is 50 km/h.",
    "That is 31 mph, no more.",
    "No, this is not allowed here.",
    "No! Brake, there is danger ahead.",
    "You should switch it off.",
    "What a nice day.",
)
QUIET = [(task.id, half) for task in CATALOGUE.values() for half in task.halves
         if task.half(half).declares == "not_needed"]  # fmt: skip


def instance(task="road_speed_80_in_50", half="second"):
    return draw(CATALOGUE[task], half, 0)


@pytest.mark.parametrize("said", TRUE)
def test_a_true_answer_is_enough_where_nothing_has_to_be_done(said):
    assert only_answered(instance(), [said])
    assert not only_answered(instance(half="first"), [said]), "there the driver has to be warned"


@pytest.mark.parametrize("said", FALSE)
def test_a_wrong_or_empty_answer_is_not(said):
    assert not only_answered(instance(), [said])
    assert not only_answered(instance(), [TRUE[0], said])


def test_without_a_word_complete_is_not_right():
    assert not only_answered(instance(), [])


@over(QUIET)
def test_to_say_that_all_is_well_is_true_wherever_nothing_has_to_be_done(task, half):
    assert only_answered(instance(task, half), ["No need, everything is already right: nothing to do."])
