"""Resource ids say nothing, and tell everything apart."""

import re
from typing import Any

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Direction, Feedback, FeedbackCode
from automotive_cosim.contracts.ids import key_of, resource_id

NEUTRAL = re.compile(r"view_[0-9a-f]{6}(_\d+)?")


def test_ids_are_neutral_stable_and_unique(cockpit: Cockpit, walker: Any) -> None:
    views = walker(cockpit)
    keys = {widget.key for view in views for widget in view.cockpit.tree.walk() if widget.key}
    shown = {element.resource_id for view in views for element in view.cockpit.elements()} - {""}
    assert len(keys) > 600
    assert len({resource_id(key) for key in keys}) == len(keys)
    assert all(NEUTRAL.fullmatch(each) for each in shown)
    assert {key_of(each) for each in shown} <= keys
    assert resource_id("hvac.front_defroster") == "view_8a0bcd"


def test_entries_of_a_list_have_its_id_and_their_number() -> None:
    first, other = resource_id("map.place.0"), resource_id("map.place.12")
    assert first.rpartition("_")[0] == other.rpartition("_")[0] == resource_id("map.place")
    assert (first.rpartition("_")[2], other.rpartition("_")[2]) == ("0", "12")
    assert resource_id("") == key_of("") == key_of("view_of_a_guess") == ""


def test_feedback_names_no_key(cockpit: Cockpit) -> None:
    cockpit.open_app("media")
    told: Feedback = cockpit.scroll("media.entries", Direction.UP)
    assert told == Feedback(FeedbackCode.NO_EFFECT, "Tracks and stations cannot move further up")
