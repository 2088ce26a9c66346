"""Laws over the suite that a look through the windshield decides."""

import re

import numpy as np
import pytest

from automotive_cosim.contracts.given import NEEDS_ROAD
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource
from automotive_cosim.proof.hand_over import SEEING
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Differs
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.view.paint import LAMP_COLOURS
from tests.laws import over

SEEN = ("a red light", "a green light", " in front within ", "brake lamps")
"""How triggers tell what no screen, context or query does."""


@over(CATALOGUE.of(Suite.CAMERA))
def test_only_what_the_view_shows_tells_the_halves_apart(task):
    assert NEEDS_ROAD in task.tags
    assert Differs.TRAFFIC in task.differs
    told = [str(task.half(name).trigger.condition) for name in task.halves]
    assert all(any(words in each for words in SEEN) for each in told), told
    assert task.first.goal != task.second.goal or task.first.tells != task.second.tells or task.second.reasons


def test_some_pairs_ask_for_a_look_and_nobody_else_does():
    assert len(CATALOGUE.of(Suite.CAMERA)) >= 10
    assert not [
        task.id for task in CATALOGUE.values() if NEEDS_ROAD in task.tags and task.suite is not Suite.CAMERA
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("half", "lamp", "other"), [("first", "red", "green"), ("second", "green", "red")])
def test_the_signal_is_in_the_view_and_in_no_words(simulations, half, lamp, other):
    finder = SituationFinder(EpisodeSpec("camera_mode_by_the_signal", half, conditions=SEEING), simulations)
    world = finder.find(SeedSource(0).next()).world
    view, words = world.view().astype(int), world.moment.context.text().casefold()
    world.close()
    lit = {name: (np.abs(view - LAMP_COLOURS[name]).sum(2) < 60).sum() for name in (lamp, other)}
    assert lit[lamp] > 10
    assert lit[lamp] > 3 * lit[other]
    assert not re.search(r"\b(red|green|traffic) (light|signal)", words)
