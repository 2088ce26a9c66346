"""What an agent may be given: the channels of its observation, and the values of each condition."""

from __future__ import annotations

import re
from abc import abstractmethod
from enum import StrEnum
from typing import Self
from zlib import crc32


class Channel(StrEnum):
    """Channels that can be withheld from an agent; goal, time and feedback never are."""

    SCREENSHOT = "screenshot"
    ELEMENTS = "elements"
    VEHICLE = "vehicle"
    GPS = "gps"
    CONNECTIVITY = "connectivity"
    CONTEXT = "context"
    CAMERA = "camera"
    """The view through the windshield; only for who asks for it."""


ALL = frozenset(Channel) - {Channel.CAMERA}
"""Those that an agent is given unless it or its user says otherwise."""
PLACE = frozenset({Channel.GPS, Channel.CONTEXT})

NEEDS_PICTURE = "picture"
"""The tag of tasks in which something needed is in the picture alone: the list of elements does not tell it."""
NEEDS_ROAD = "windshield"
"""The tag of tasks in which something needed is seen through the windshield alone."""


class GeoInput(StrEnum):
    """What an agent is told about its place; ``interface.controls`` has a table."""

    FULL = "full"
    """GPS and context, as they are."""
    GPS = "gps"
    """GPS alone."""
    CONTEXT = "context"
    """The context alone, without the line that states the position."""
    WRONG = "wrong"
    """GPS, context and answers to queries of another country, the same in both halves of a pair."""
    IRRELEVANT = "irrelevant"
    """A text about bees, exactly as long, in place of the context; no GPS and no queries."""
    NONE = "none"
    """Neither."""

    @property
    def withheld(self) -> frozenset[Channel]:
        """Channels that it takes away."""
        kept = {
            GeoInput.GPS: {Channel.GPS},
            GeoInput.CONTEXT: {Channel.CONTEXT},
            GeoInput.IRRELEVANT: {Channel.CONTEXT},
            GeoInput.NONE: set[Channel](),
        }
        return PLACE - kept.get(self, PLACE)

    @property
    def answers(self) -> bool:
        """Whether the virtual sensor may be asked."""
        return Channel.CONTEXT not in self.withheld and self is not GeoInput.IRRELEVANT


class See(StrEnum):
    """How an agent sees the screen."""

    BOTH = "both"
    """As the list of elements and the picture."""
    TREE = "tree"
    """As the list of elements; tasks with the tag ``picture`` are left out."""
    PICTURE = "picture"
    """As the picture: no list, no ids, no descriptions; an action has to give a point."""
    NOTHING = "nothing"
    """Not at all, for who calls functions."""
    CAMERA = "camera"
    """As both, and who is shown the picture is also shown the road: the view through the windshield."""

    @property
    def words(self) -> str:
        """For people: ``picture alone``."""
        return "the road too" if self is See.CAMERA else f"{self} alone"

    def added(self, channels: frozenset[Channel]) -> frozenset[Channel]:
        """Channels that who wants these gets besides."""
        sees = self is See.CAMERA and Channel.SCREENSHOT in channels
        return frozenset({Channel.CAMERA}) if sees else frozenset()

    @property
    def withheld(self) -> frozenset[Channel]:
        """Channels that it takes away."""
        return {
            See.BOTH: frozenset[Channel](),
            See.TREE: frozenset({Channel.SCREENSHOT}),
            See.PICTURE: frozenset({Channel.ELEMENTS}),
            See.NOTHING: frozenset({Channel.SCREENSHOT, Channel.ELEMENTS}),
            See.CAMERA: frozenset[Channel](),
        }[self]


class Interface(StrEnum):
    """How an agent acts."""

    TOUCH = "touch"
    """On the screen, and by the safety calls."""
    FUNCTIONS = "functions"
    """By typed functions of the car; the screen cannot be touched."""
    BOTH = "both"
    """Either way."""

    @property
    def touches(self) -> bool:
        """Whether the screen can be touched."""
        return self is not Interface.FUNCTIONS

    @property
    def calls(self) -> bool:
        """Whether functions can be called."""
        return self is not Interface.TOUCH


class FeedbackDetail(StrEnum):
    """How much an agent is told about its last action; ``interface.feedback`` has a table."""

    QUIET = "quiet"
    """The control and whether it worked: ``Front defroster: done``."""
    VERBOSE = "verbose"
    """Also which signal changed, and its new value."""


OWN_PROMPT, OWN_MAKE = r"^.+\.(md|txt)@[0-9a-f]{64}$", r"^.+\.toml@[0-9a-f]{64}$"
"""A file with instructions of one's own, or with a make, and its SHA-256."""


class Order(StrEnum):
    """What the driver of a drive asks for, from a sentence to every threshold."""

    PLAIN = "plain"
    """To be kept safe and legal, and to be let drive."""
    USUAL = "usual"
    """What to see to, what to leave, and to be told nothing twice within a minute."""
    FULL = "full"
    """The same, and when each of the things that can be due is due, by figures."""

    @property
    def tells_thresholds(self) -> bool:
        """Whether its reader knows from which measure on something counts."""
        return self is Order.FULL


class Hearing(StrEnum):
    """How the words of the people in the car reach the agent."""

    TEXT = "text"
    """As they were said."""
    CABIN = "cabin"
    """As a recogniser made them out in the noise of that instant."""
    AUDIO = "audio"
    """As sound in that noise, for models that take sound; needs the extra ``voice``."""

    @property
    def is_by_ear(self) -> bool:
        """Whether the cabin's sound counts, in both directions."""
        return self is not Hearing.TEXT


class OrFile(StrEnum):
    """Words, or beside them ``FILE@SHA-256``; two of the same file are equal."""

    @classmethod
    def _missing_(cls, value: object) -> Self | None:
        """A value beside those listed."""
        if not isinstance(value, str) or not re.match(cls.own(), value):
            return None
        made = str.__new__(cls, value)
        made._name_ = made._value_ = value
        return made

    def __reduce_ex__(self, protocol: object) -> tuple[type[Self], tuple[str]]:
        """By its value: Python 3.11.2 stores members by name, under which there is none for a file."""
        return type(self), (self.value,)

    @classmethod
    @abstractmethod
    def own(cls) -> str:
        """The pattern of a file and its SHA-256."""

    @property
    def file(self) -> str:
        """The file's name as it was given; empty for those that come with the package."""
        return self.rpartition("@")[0]

    @property
    def sha256(self) -> str:
        """The file's; empty as above."""
        return self.rpartition("@")[2] if self.file else ""

    @property
    def words(self) -> str:
        """For people: ``short``; ``mine.md (3f2a9c1d)``."""
        return f"{self.file} ({self.sha256[:8]})" if self.file else str(self)

    @property
    def tag(self) -> str:
        """For ids, which name files: ``short``; ``own3f2a9c1d``."""
        return f"own{self.sha256[:8]}" if self.file else str(self)


class PromptLength(OrFile):
    """How much of the same facts the prompt of T3A, M3A and ASURADA spells out.

    Or ``FILE@SHA-256``, a file in place of the standard one's instructions (``episode.own_prompt``)."""

    STANDARD = "standard"
    """What an action takes once, each element in a few words, and of the rules those that can matter."""
    SHORT = "short"
    """For small models: actions by name alone, fewer words on how to answer, the last steps of the history."""

    @classmethod
    def own(cls) -> str:
        return OWN_PROMPT

    @property
    def length(self) -> PromptLength:
        """One of those listed: a file of one's own takes the rest from the standard prompt."""
        return PromptLength.STANDARD if self.file else self


class CarMake(OrFile):
    """Whose cockpit the car has: a file of ``cockpit/makes``, or ``FILE@SHA-256`` of one's own."""

    HOME = "home"
    """The one that the tasks were written for."""
    ALDER = "alder"
    """A bar on the left, lists in place of cards."""
    BIRCH = "birch"
    """American: a bar on top, mirrored, miles and Fahrenheit."""
    CEDAR = "cedar"
    """A bar on the right, and one tree of settings."""
    ROWAN = "rowan"
    """British: five entries, and two hubs behind them."""
    DRAWN = "drawn"
    """One of the others, by the seed of the episode."""

    @classmethod
    def own(cls) -> str:
        return OWN_MAKE

    def at(self, seed: int) -> CarMake:
        """The make of the episode with a seed: itself, or one of the others if it is drawn."""
        if self is not CarMake.DRAWN:
            return self
        known = [make for make in CarMake if make not in (CarMake.HOME, CarMake.DRAWN)]
        return known[crc32(f"make {seed}".encode()) % len(known)]


class DriverAttention(StrEnum):
    """Whether what the agent shows and says takes the driver's eyes and mind off the road."""

    OFF = "off"
    """The driver is attentive whatever happens."""
    ON = "on"
    """Screen, words and hours lower the driver's awareness."""

    @property
    def is_limited(self) -> bool:
        return self is DriverAttention.ON


class ToldPolicy(StrEnum):
    """Which rules an agent is told beside the driver's words; it is held to the house's in any case."""

    NONE = "none"
    HOUSE = "house"
    """The house rules (``interface.house_rules``)."""


class Language(StrEnum):
    """The languages of car and driver, by the codes of ``HMI.LANGUAGE``."""

    ENGLISH = "en"
    FRENCH = "fr"
    GERMAN = "de"
    JAPANESE = "ja"

    @property
    def words(self) -> str:
        """Its name in English: ``French``."""
        return self.name.capitalize()


class Clock(StrEnum):
    """What an agent's answer costs on the road, besides the action itself."""

    FIXED = "fixed"
    """The same for every answer, by default nothing."""
    MODEL = "model"
    """The seconds that the model really took, in addition."""
