"""What the rule-perfect watcher does on the screen for what people aboard ask for, one touch at a time."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

from automotive_cosim.cockpit.apps.phone.state import TEMPLATES
from automotive_cosim.cockpit.language import word
from automotive_cosim.cockpit.tree import make_named, way
from automotive_cosim.contracts import Action, ActionType, Element, Observation
from automotive_cosim.contracts.errand import Errand, ErrandKind
from automotive_cosim.contracts.given import CarMake, Language
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.drives.errands import understood

GIVES_UP_S = 90.0
"""After this nobody waits for it any more."""
STEP_C = 0.5


@dataclass(frozen=True, slots=True)
class Touch:
    """One touch on the way to what was asked for."""

    key: str
    """Of the element, or how those of a list begin."""
    texts: tuple[str, ...] = ()
    """What the element of the list says, in any language."""

    def on(self, elements: Sequence[Element]) -> int | None:
        """The element's index; None if it is not there."""
        for index, element in enumerate(elements):
            key = key_of(element.resource_id)
            if element.is_enabled and (
                key.startswith(self.key) and element.text in self.texts if self.texts else key == self.key
            ):
                return index
        return None


class Hands:
    """Carries out what is asked for in turn."""

    def __init__(self) -> None:
        self._errands: list[Errand] = []
        self._heard = 0

    def hear(self, seen: Observation) -> None:
        """Takes in what was said since."""
        for text in seen.said[self._heard :]:
            errand = understood(text)
            if errand is not None:
                self._errands.append(replace(errand, at_s=seen.time_s))
        self._heard = len(seen.said)
        self._errands = [errand for errand in self._errands if seen.time_s - errand.at_s < GIVES_UP_S]

    def act(self, seen: Observation) -> Action | None:
        """The next touch for the newest errand that can go on; None if there is nothing to do."""
        for errand in sorted(self._errands, key=lambda each: each.kind is not ErrandKind.CALL):
            action = self._next(errand, seen.elements or ())
            if action is not None:
                return action
        return None

    def _next(self, errand: Errand, elements: Sequence[Element]) -> Action | None:
        if errand.kind is ErrandKind.CLIMATE:
            return self._warmed(errand, elements)
        is_last, action = self._towards(tuple(_way(errand)), elements)
        if is_last:
            self._errands.remove(errand)
        return action

    def _towards(self, way: tuple[Touch, ...], elements: Sequence[Element]) -> tuple[bool, Action | None]:
        """The next touch on a way, and whether it is the last one."""
        for touch in reversed(way):
            index = touch.on(elements)
            if index is not None:
                return touch is way[-1], Action(ActionType.CLICK, index=index)
        return False, None

    def _warmed(self, errand: Errand, elements: Sequence[Element]) -> Action | None:
        texts = {key_of(element.resource_id): element.text for element in elements}
        docked, on_screen = (f"{where}.{errand.about}_temperature" for where in ("dock", "hvac"))
        name, value = (docked, f"{docked}.value") if f"{docked}.value" in texts else (on_screen, on_screen)
        shown = re.match(r"\d+[.,]?\d*", texts.get(value, ""))
        if shown is None:
            return self._towards(tuple(_leads("climate")), elements)[1]
        left_c = float(errand.wanted) - float(shown[0].replace(",", "."))
        if abs(left_c) < STEP_C / 2:
            self._errands.remove(errand)
            return None
        index = Touch(f"{name}.{'increase' if left_c > 0 else 'decrease'}").on(elements)
        return None if index is None else Action(ActionType.CLICK, index=index)


@cache
def _leads(screen: str) -> tuple[Touch, ...]:
    """What leads to a screen, in whichever make the car is."""
    makes = (make_named(name) for name in CarMake if name is not CarMake.DRAWN)
    return tuple(dict.fromkeys(Touch(key) for make in makes for key in way(make, screen)))


def _way(errand: Errand) -> Iterator[Touch]:
    """The touches that lead to it from any screen; of those that are there, the last one is next."""
    match errand.kind:
        case ErrandKind.CALL:
            yield Touch("call.decline")
        case ErrandKind.PLACE:
            yield from _leads("map")
            yield Touch("map.place.", tuple(word(errand.about, language) for language in Language))
            yield Touch("place.start")
        case ErrandKind.MESSAGE:
            yield from _leads("phone")
            yield Touch("phone.tab.messages")
            yield Touch("phone.thread.", (errand.about,))
            yield Touch(f"thread.answer.{[str(text) for text in TEMPLATES].index(errand.wanted)}")
        case ErrandKind.CLIMATE:
            pass
