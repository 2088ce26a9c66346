"""The function of the handbook."""

from __future__ import annotations

from typing import Annotated

from automotive_cosim.cockpit.apps.manual.state import TOPICS, ManualFilm
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, locked, offered
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import State
from automotive_cosim.formats.annotations import OneOf

NAMES = tuple(str(topic[0]) for topic in TOPICS)


@offered
def play_manual_video(
    state: State,
    topic: Annotated[str, OneOf(NAMES), "The topic."],
    on: Annotated[bool, "True plays its video, false stops it."] = True,
) -> CallMade:
    """Play the video of a topic of the owner's manual, or stop it. Only while parked."""
    if not on:
        return Put(ManualFilm(), "")
    return locked(state, Restriction.NO_VIDEO) or Put(ManualFilm(NAMES.index(topic), state.time_s), "")


FUNCTIONS = (play_manual_video,)
