"""The oracle: plays the task's reference solution by public actions on what it observes."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace

from automotive_cosim.cockpit.actions import point
from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.registry import apps_in
from automotive_cosim.cockpit.touchscreen import OPPOSITE
from automotive_cosim.contracts import Action, ActionType, Direction, Element, FeedbackCode, GoalStatus, Observation
from automotive_cosim.contracts.given import See
from automotive_cosim.contracts.ids import resource_id
from automotive_cosim.episode.episode import Episode
from automotive_cosim.errors import ActionError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.moves import (
    Consult,
    Do,
    Hear,
    Inform,
    Move,
    Open,
    Slide,
    Tap,
    TapUntil,
    TypeText,
    Warn,
)

LIST = "ListView"
_DOCK = frozenset(resource_id(f"dock.{app.name}") for app in apps_in(Where.DOCK))
"""What scrolls row by row, by class name."""


class Oracle:
    """Proves that a task can be solved by public actions alone; see ``tasking.task.Half.moves``."""

    name = "oracle"
    model = "none"

    def __init__(self, see: See = See.BOTH) -> None:
        """Nothing is known yet.

        Args:
            see: how it sees the screen; it has the picture drawn only where it gets no list."""
        self.channels = frozenset({Channel.SCREENSHOT if see is See.PICTURE else Channel.ELEMENTS})
        self._moves: deque[Move] = deque()
        self._end = Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
        self._count = 0
        self.begun = 0
        """Number of the move that the last action belongs to, a repeated tap counted as several; with all of them
        done, how many there were."""
        self._pressed = 0
        self._lists_seen: set[str] = set()
        self._list = ""
        self._drawn: Callable[[], Sequence[Element]] = tuple[Element, ...]

    def reset(self, goal: str) -> None:
        self._moves.clear()
        self._pressed = 0
        self._lists_seen.clear()
        self._list = ""

    def brief(
        self,
        instance: Instance,
        moves: Sequence[Move] | None = None,
        declares: GoalStatus | None = None,
        *,
        drawn: Callable[[], Sequence[Element]] = tuple[Element, ...],
        branch: Callable[[], Episode] | None = None,
    ) -> None:
        """Takes the instance's reference solution, or other moves, one tap per action.

        Args:
            moves: another of its solutions, or other moves.
            declares: what to declare then; None for what is right.
            drawn: the boxes of the widgets in the present picture, with the texts that it shows. An agent that sees
                the picture alone finds its way by them, and acts by points."""
        self._drawn = drawn
        self._moves.clear()
        for move in instance.moves if moves is None else moves:
            repeats = move.times if isinstance(move, Tap) else 1
            self._moves.extend([move] * repeats)
        self._count = len(self._moves)
        reason = min(instance.half.reasons, default=None)
        self._end = Action(ActionType.STATUS, goal_status=declares or instance.half.declares, reason=reason)

    def act(self, observation: Observation) -> Action:
        """The next move, or the declaration after the last."""
        if observation.elements is not None:
            return self._act(observation)
        drawn = tuple(self._drawn())
        return by_point(self._act(replace(observation, elements=drawn)), drawn)

    def _act(self, observation: Observation) -> Action:
        elements = () if observation.elements is None else observation.elements
        while self._moves and _is_reached(self._moves[0], elements, observation.said):
            self._moves.popleft()
            self._pressed = 0
        self.begun = self._count - len(self._moves)
        if not self._moves:
            return self._end
        match self._moves[0]:
            case Tap(key, _, text):
                return self._touch(observation, key, text) or self._search(observation, key or text)
            case TapUntil(key, shown, text, at_most):
                if self._pressed >= at_most:
                    raise ActionError(f"{shown} does not read {text!r} after {at_most} taps on {key}")
                self._pressed += 1
                index = _index(elements, key, "")
                return _click(index) if index is not None else self._search(observation, key)
            case Slide(key, value, low, high):
                index = _index(elements, key, "")
                if index is None:
                    return self._search(observation, key)
                self._moves.popleft()
                return _slide(elements[index], (value - low) / (high - low))
            case TypeText(key, text, enter):
                index = _index(elements, key, "")
                if index is None:
                    return self._search(observation, key)
                self._moves.popleft()
                if enter:
                    self._moves.appendleft(Do(Action(ActionType.KEYBOARD_ENTER)))
                return Action(ActionType.INPUT_TEXT, index=index, text=text, clear_text=True)
            case Open(app):
                self._moves.popleft()
                return Action(ActionType.OPEN_APP, app_name=app)
            case Warn(kind, severity, speed_kmh):
                self._moves.popleft()
                return Action(ActionType.SHOW_ALERT, kind=kind, severity=severity, speed_kmh=speed_kmh)
            case Consult(text):
                self._moves.popleft()
                return Action(ActionType.ASK_DRIVER, text=text)
            case Inform(text):
                self._moves.popleft()
                return Action(ActionType.ANSWER, text=text)
            case Hear(text, at_most_s):
                self._pressed += 1
                if self._pressed > at_most_s:
                    raise ActionError(f"the driver does not say {text!r} within {at_most_s} s")
                return Action(ActionType.WAIT, seconds=1)
            case Do(action):
                self._moves.popleft()
                return action

    def _touch(self, observation: Observation, key: str, text: str) -> Action | None:
        index = _index(observation.elements or (), key, text)
        if index is None:
            return None
        self._moves.popleft()
        self._lists_seen.clear()
        self._list = ""
        return _click(index)

    def _search(self, observation: Observation, wanted: str) -> Action:
        """Scrolls the lists on the screen to their ends, one after the other, then to their beginnings."""
        if self._list and observation.feedback.code is not FeedbackCode.OK:
            self._lists_seen.add(self._list)
            self._list = ""
        for way in (Direction.DOWN, Direction.UP):
            for index, element in enumerate(observation.elements or ()):
                seen = f"{element.resource_id} {way}" in self._lists_seen
                if element.is_scrollable and element.class_name == LIST and not seen:
                    self._list = f"{element.resource_id} {way}"
                    return Action(ActionType.SCROLL, direction=way, index=index)
        raise ActionError(f"{wanted} is not on the screen, and no list that can be scrolled has it")


def _is_reached(move: Move, elements: Sequence[Element], said: Sequence[str]) -> bool:
    """Whether a repeated tap has reached its result, or the driver has said what is waited for."""
    if isinstance(move, Hear):
        return any(move.text in text for text in said)
    if not isinstance(move, TapUntil):
        return False
    shown = resource_id(move.shown)
    return any(element.resource_id == shown and _reads(element, move.text) for element in elements)


def _index(elements: Sequence[Element], key: str, text: str) -> int | None:
    """Where it is; of several the first, but the dock comes last: a place may be called Home too."""
    wanted = resource_id(key)
    dock_last = sorted(enumerate(elements), key=lambda entry: entry[1].resource_id in _DOCK)
    for index, element in dock_last:
        if not element.is_visible or (wanted and element.resource_id != wanted):
            continue
        if not text or (element.is_clickable and _reads(element, text)):
            return index
    return None


def _reads(element: Element, text: str) -> bool:
    return text in (element.text, element.text.partition("\n")[0], element.content_description)


def by_point(action: Action, elements: Sequence[Element]) -> Action:
    """The same action by a point instead of an index; a list is moved by a finger on it."""
    if action.index is None:
        return action
    x, y = point(action, elements)
    if action.action_type is ActionType.SCROLL:
        assert action.direction is not None
        return Action(ActionType.SWIPE, x=x, y=y, direction=OPPOSITE[action.direction])
    return replace(action, index=None, x=x, y=y)


def _click(index: int) -> Action:
    return Action(ActionType.CLICK, index=index)


def _slide(element: Element, share: float) -> Action:
    box = element.bbox_pixels
    x = box.x_min + share * (box.x_max - box.x_min)
    return Action(ActionType.CLICK, x=round(x), y=(box.y_min + box.y_max) // 2)
