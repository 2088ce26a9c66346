"""What the driver may not do on the screen while driving: Android's ``CarUxRestrictions``.

The bits and limits are those of ``android.car.drivingstate.CarUxRestrictions``
(https://developer.android.com/reference/android/car/drivingstate/CarUxRestrictions).
"""

from __future__ import annotations

from enum import IntFlag, StrEnum

from automotive_cosim.contracts.text import say


class Restriction(IntFlag):
    """One bit per restriction."""

    BASELINE = 0
    NO_DIALPAD = 1
    NO_FILTERING = 2
    LIMIT_STRING_LENGTH = 4
    NO_KEYBOARD = 8
    NO_VIDEO = 16
    LIMIT_CONTENT = 32
    NO_SETUP = 64
    NO_TEXT_MESSAGE = 128
    NO_VOICE_TRANSCRIPTION = 256
    FULLY_RESTRICTED = 511


REASONS = {
    Restriction.NO_DIALPAD: say("The keypad is locked while driving"),
    Restriction.NO_KEYBOARD: say("Typing is locked while driving"),
    Restriction.NO_VIDEO: say("Videos play only while parked"),
    Restriction.LIMIT_CONTENT: say("Lists are shortened while driving"),
    Restriction.NO_SETUP: say("Available only while parked"),
    Restriction.NO_TEXT_MESSAGE: say("Messages are read out while driving"),
    Restriction.NO_VOICE_TRANSCRIPTION: say("Dictated words are not shown while driving"),
}
"""Texts shown for restrictions."""
STANDING_KMH = 0.5
"""Speed below which the car is stationary."""
STRING_LIMIT = 120
"""Characters of a text shown while ``LIMIT_STRING_LENGTH`` holds; the platform's default."""
ENTRIES_LIMIT = 21
"""Entries of a list shown while ``LIMIT_CONTENT`` holds; the platform's default."""


class Motion(StrEnum):
    """Android's driving states."""

    PARKED = "parked"
    IDLING = "idling"
    """Stationary in gear."""
    MOVING = "moving"


def motion(gear: str, speed_kmh: float) -> Motion:
    """The driving state."""
    if gear == "P":
        return Motion.PARKED
    return Motion.IDLING if speed_kmh < STANDING_KMH else Motion.MOVING


def in_words(given: int) -> str:
    """Restrictions as a list of words: ``no keyboard, no video``; ``none`` without any."""
    names = (str(each.name).lower().replace("_", " ") for each in Restriction(given))
    return ", ".join(names) or "none"


def restrictions(gear: str, speed_kmh: float) -> Restriction:
    """Parked: none. Stationary in gear: no video, no setup. Moving: all."""
    return _RESTRICTED[motion(gear, speed_kmh)]


_RESTRICTED = {
    Motion.PARKED: Restriction.BASELINE,
    Motion.IDLING: Restriction.NO_VIDEO | Restriction.NO_SETUP,
    Motion.MOVING: Restriction.FULLY_RESTRICTED,
}
