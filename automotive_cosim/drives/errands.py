"""Errands on a drive: what people aboard ask for, when, and in which words.

They come a few seconds after something is staged, so that whoever carries them out has the hands full when safety
asks for something. One of them is declined by the driver at once.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.state import TEMPLATES
from automotive_cosim.cockpit.occupants import Seat
from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.contracts.errand import Errand, ErrandKind
from automotive_cosim.contracts.given import Language
from automotive_cosim.drives.order import SPOKEN
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.formats.shipped import fields_of
from automotive_cosim.tasking.draws import Draws, Purpose

AFTER_S = (3.0, 9.0)
"""How long after a staging somebody asks."""
ASKED_APART_S = 100.0
"""An errand counts for a minute and a half."""
SPARE_S = 100.0
"""No errand comes later than this before the end."""
MOST_ERRANDS = len(ErrandKind)
WRITES_S, RINGS_S = 6.0, 3.0
"""How long before the driver speaks of it a message comes, and a call rings."""
PEOPLE = ("Noor Haddad", "Mia Frost", "Tom Hale", "Ayumi Sato", "Luca Ferri", "Eva Lund")
"""Nobody of these is in the phone book, so that no name occurs twice."""
DEGREES = ("19", "23", "24")
PLACE = "Work"
REPLIES = (str(TEMPLATES[0]), str(TEMPLATES[2]))


@dataclass(frozen=True, slots=True)
class ErrandWords:
    """The words of one language, with ``{name}`` for who or what it is about."""

    driver_climate: str
    passenger_climate: str
    replies: tuple[str, str]
    """By the reply that is wanted (``REPLIES``)."""
    call: str
    place: str
    no: tuple[str, str]
    """What the driver adds to what is declined: the driver's own, or the passenger's."""


WORDS: Mapping[Language, ErrandWords] = {
    language: ErrandWords(**fields_of(told["errands"])) for language, told in SPOKEN.items()
}


THANKS: Mapping[Language, str] = {
    Language.ENGLISH: "Thanks, that's done: “{words}”",
    Language.FRENCH: "Merci, c'est fait : « {words} »",
    Language.GERMAN: "Danke, das ist erledigt: „{words}“",
    Language.JAPANESE: "ありがとう、済んだよ：「{words}」",
}
"""What is said once it is carried out, so that nobody does it again whenever the words are read."""


def thanks(errand: Errand, language: Language) -> str:
    """What is said once it is done."""
    return THANKS[language].format(words=said(errand, language))


def words_about(errand: Errand, language: Language) -> tuple[str, ...]:
    """Everything that may be said about it."""
    return (said(errand, language), *(() if errand.is_declined else (thanks(errand, language),)))


def said(errand: Errand, language: Language) -> str:
    """What is said; with the driver's no, if it is declined."""
    words = WORDS[language]
    text = _form(errand, words).format(about=errand.about, wanted=errand.wanted)
    no = words.no[errand.about == "passenger"]
    return f"{text} {no}" if errand.is_declined else text


def understood(text: str) -> Errand | None:
    """What was asked for in these words, in any language, at second 0; None if nothing is to be done."""
    for words in WORDS.values():
        if text.endswith(words.no):
            return None
        for errand in _forms():
            form = re.escape(_form(errand, words)).replace(r"\{about\}", "(?P<about>.+)")
            found = re.fullmatch(form.replace(r"\{wanted\}", "(?P<wanted>.+)"), text)
            if found is not None:
                named = found.groupdict()
                return replace(
                    errand,
                    about=named.get("about", errand.about),
                    wanted=named.get("wanted", errand.wanted),
                )
    return None


def every() -> Iterator[Errand]:
    """Every errand that can be drawn, declined or not."""
    named = (
        *(Errand(ErrandKind.CLIMATE, 0.0, *each) for each in product(("driver", "passenger"), DEGREES)),
        *(Errand(ErrandKind.MESSAGE, 0.0, *each) for each in product(PEOPLE, REPLIES)),
        *(Errand(ErrandKind.CALL, 0.0, who) for who in PEOPLE),
        Errand(ErrandKind.PLACE, 0.0, PLACE),
    )
    return (replace(each, is_declined=is_declined) for each in named for is_declined in (False, True))


def _forms() -> tuple[Errand, ...]:
    """One errand for each form of words."""
    return (
        *(Errand(ErrandKind.CLIMATE, 0.0, seat) for seat in ("driver", "passenger")),
        *(Errand(ErrandKind.MESSAGE, 0.0, "", reply) for reply in REPLIES),
        Errand(ErrandKind.CALL, 0.0, ""),
        Errand(ErrandKind.PLACE, 0.0, PLACE),
    )


def _form(errand: Errand, words: ErrandWords) -> str:
    match errand.kind:
        case ErrandKind.CLIMATE:
            return words.passenger_climate if errand.about == "passenger" else words.driver_climate
        case ErrandKind.MESSAGE:
            return words.replies[REPLIES.index(errand.wanted)]
        case ErrandKind.CALL:
            return words.call
        case ErrandKind.PLACE:
            return words.place


def with_errands(script: DriveScript) -> DriveScript:
    """The script with errands near what it stages, and the messages and calls that they are about."""
    rng = Draws(f"{script.family} errands", script.seed).rng(Purpose.DRIVE)
    times_s: list[float] = []
    for staged in script.staged:
        at_s = staged.at_s + float(round(rng.uniform(*AFTER_S)))
        if at_s <= script.duration_s - SPARE_S and (not times_s or at_s >= times_s[-1] + ASKED_APART_S):
            times_s.append(at_s)
    times_s = sorted(float(at_s) for at_s in rng.permutation(times_s)[:MOST_ERRANDS])
    kinds = [list(ErrandKind)[index] for index in rng.permutation(len(ErrandKind))]
    people = [PEOPLE[index] for index in rng.permutation(len(PEOPLE))]
    is_accompanied = any(one.seat is Seat.PASSENGER and one.kind.is_person for one in script.aboard)
    declined = int(rng.integers(max(1, len(times_s))))
    errands: list[Errand] = []
    for number, at_s in enumerate(times_s):
        kind = kinds[number % len(kinds)]
        about, wanted = people[number], ""
        if kind is ErrandKind.CLIMATE:
            about = "passenger" if is_accompanied else "driver"
            wanted = DEGREES[int(rng.integers(len(DEGREES)))]
        elif kind is ErrandKind.MESSAGE:
            wanted = REPLIES[int(rng.integers(len(REPLIES)))]
        elif kind is ErrandKind.PLACE:
            about = PLACE
        refused = number == declined and len(times_s) > 1
        errands.append(Errand(kind, at_s, about, wanted, refused))
    writes = (
        Arrival("message", errand.at_s - WRITES_S, errand.about, "Where are you?")
        for errand in errands
        if errand.kind is ErrandKind.MESSAGE
    )
    rings = (
        Arrival("call", errand.at_s - RINGS_S, errand.about) for errand in errands if errand.kind is ErrandKind.CALL
    )
    return replace(
        script,
        errands=tuple(errands),
        arrivals=(*script.arrivals, *writes, *rings),
        signals={HVAC.SYNC.path: False, **script.signals},  # each side has its own temperature
    )
