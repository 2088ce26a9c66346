"""Why a task did not start at another place is said: no sign, or a law that says otherwise."""

from typing import Any, cast

import pytest

from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec
from automotive_cosim.errors import UserError
from automotive_cosim.interface.observe import See


def _finder(task: str) -> SituationFinder:
    return SituationFinder(EpisodeSpec(task, "first", scenario="grid"), cast("Any", None))


def test_a_network_without_signs_is_named_as_the_reason() -> None:
    finder = _finder("road_speed_80_in_50")
    assert "no limit is posted anywhere" in finder._lacking()
    finder._has_signs = True
    assert finder._lacking() == ""


def test_a_law_that_says_otherwise_is_named_as_the_reason() -> None:
    finder = _finder("phenomenon_rear_fog_in_mist")
    assert finder._lacking() == ""
    finder._missing = "the law of Germany answers differently"
    assert "a verified rule on the rear fog lamp (compare FR.rear_fog)" in finder._lacking()
    assert "the law of Germany answers differently" in finder._lacking()


def test_a_task_that_needs_the_view_of_the_road_is_refused_without_it() -> None:
    seeing = Conditions(see=See.CAMERA)
    SituationFinder(EpisodeSpec("camera_mode_by_the_signal", conditions=seeing), cast("Any", None))
    with pytest.raises(UserError, match="view of the road, which see = both leaves out; give see = camera"):
        SituationFinder(EpisodeSpec("camera_mode_by_the_signal"), cast("Any", None))


def test_a_task_that_needs_the_picture_is_refused_without_it() -> None:
    for see in (See.PICTURE, See.BOTH):
        SituationFinder(EpisodeSpec("hard_theos_pump", conditions=Conditions(see=see)), cast("Any", None))
    with pytest.raises(UserError, match="hard_theos_pump needs the picture, which see = tree withholds"):
        SituationFinder(EpisodeSpec("hard_theos_pump", conditions=Conditions(see=See.TREE)), cast("Any", None))
