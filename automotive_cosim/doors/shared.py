"""What several doors share: one service for a whole process, and specifications from plain words."""

from __future__ import annotations

import atexit
from functools import cache
from typing import Any

from automotive_cosim.agents.settings import geo_input
from automotive_cosim.contracts import Json
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.episode.specification import (
    EpisodeSpec,
    feedback_of,
    language_of,
    screen_of,
    see_of,
)
from automotive_cosim.service import EpisodeService, ServiceLimits

LIMITS = ServiceLimits(episodes=1000, idle_s=86_400.0)
"""For hosts that limit their episodes themselves, and end each."""


@cache
def shared_service() -> EpisodeService:
    """The episodes of this process, for a host that limits them itself."""
    service = EpisodeService(limits=LIMITS)
    atexit.register(service.close)
    return service


def episode_spec(**words: Any) -> EpisodeSpec:
    """An episode of a task, with its conditions in words.

    Args:
        words: fields of ``EpisodeSpec``; ``geo``, ``see``, ``feedback``, ``screen`` and ``language`` as text.

    Raises:
        UnknownNameError: there is no such condition.
    """
    return EpisodeSpec(**_typed(words))


def drive_spec(**words: Any) -> DriveSpec:
    """A drive, with its conditions in words, as ``episode_spec``."""
    return DriveSpec(**_typed(words))


def _typed(words: Json) -> Json:
    kinds = {
        "geo": geo_input,
        "see": see_of,
        "feedback": feedback_of,
        "screen": screen_of,
        "language": language_of,
    }
    return words | {name: kind(words[name]) for name, kind in kinds.items() if name in words}
