"""The ``controller`` of a device, as AndroidWorld's agents use it: adb requests in, actions of the car out.

A request is a message of ``android_env``, or anything with its fields; no package of AndroidWorld is needed here.
What adb splits belongs together here: the words of a text are one action, and so are the two taps of a double tap.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from automotive_cosim.agents.native.verbs import KEYS, drag, typed
from automotive_cosim.contracts import Action, ActionType, Element
from automotive_cosim.errors import ActionError

OK, FAILED = 1, 5
"""Of ``AdbResponse.Status``: OK, ADB_ERROR."""
BUTTONS = (ActionType.NAVIGATE_HOME, ActionType.NAVIGATE_BACK, ActionType.KEYBOARD_ENTER)
"""In the order of ``AdbRequest.PressButton.Button``."""
KEYCODES = {"3": "home", "4": "back", "66": "enter"}
CLEARS = ("keycombination", "113", "29")
"""Ctrl-A, which comes before a deletion."""
HOLD_MS = 500
"""A touch that stays this long in one place is a long press."""


@dataclass(frozen=True, slots=True)
class Output:
    """The output of a generic request."""

    output: bytes = b""


@dataclass(frozen=True, slots=True)
class Response:
    """The answer to a request, in the fields of ``AdbResponse``."""

    status: int = OK
    error_message: str = ""
    generic: Output = field(default_factory=Output)


class Controller:
    """Answers adb's requests. All its methods are called on the agent's thread."""

    def __init__(
        self,
        perform: Callable[[Action], None],
        elements: Callable[[], Sequence[Element]],
        screen_px: tuple[int, int],
    ) -> None:
        """Begins with nothing pending.

        Args:
            perform: performs an action and waits until its time has passed.
            elements: those on the screen now.
            screen_px: width and height."""
        self._perform = perform
        self._elements = elements
        self.device_screen_size = screen_px
        self.last: tuple[int, int] | None = None
        """The pixel that was touched last."""
        self._tap: tuple[int, int] | None = None
        self._words = ""
        self._clear = False

    def execute_adb_call(self, request: Any) -> Response:
        """Performs one request. Raises ActionError: the car has nothing like it."""
        command = request.WhichOneof("command")
        if command == "tap":
            return self._tapped((request.tap.x, request.tap.y), will_repeat=request.timeout_sec == 0)
        if command == "input_text":
            self._words += _unescaped(request.input_text.text)
            return Response()
        if command == "generic" and list(request.generic.args)[:1] == ["shell"]:
            return self._shell(list(request.generic.args)[1:])
        self.flush()
        if command == "press_button":
            return self._done(Action(BUTTONS[request.press_button.button]))
        if command == "start_activity":
            return self._open(request.start_activity.full_activity)
        return Response(FAILED, f"this car has no {command}")

    def flush(self) -> None:
        """Performs what waited for its second half: a tap that may become two, a text word by word."""
        tap, words, clear = self._tap, self._words, self._clear
        self._tap, self._words, self._clear = None, "", False
        if tap is not None:
            self.touch(Action(ActionType.CLICK, x=tap[0], y=tap[1]))
        if words:
            self._perform(typed(words, self._elements(), self.last, clear=clear))

    def touch(self, action: Action) -> None:
        """Performs a touch, and remembers where it was."""
        if action.x is not None and action.y is not None:
            self.last = action.x, action.y
        self._perform(action)

    def _tapped(self, point: tuple[int, int], *, will_repeat: bool) -> Response:
        if self._tap == point:
            self._tap = None
            return self._done(Action(ActionType.DOUBLE_TAP, x=point[0], y=point[1]))
        self.flush()
        if will_repeat:
            self._tap = point
            return Response()
        return self._done(Action(ActionType.CLICK, x=point[0], y=point[1]))

    def _shell(self, words: list[str]) -> Response:
        told = self._told(" ".join(words))
        if told:
            return Response(generic=Output(told.encode()))
        if words[:1] == ["input"]:
            return self._input(words[1:])
        if words[:2] == ["monkey", "-p"]:
            self.flush()
            return self._open(words[2])
        return Response()  # settings, broadcasts: nothing of them is on this screen

    def _told(self, command: str) -> str:
        width, height = self.device_screen_size
        if command.startswith("dumpsys input"):
            return f"logicalFrame=[0, 0, {width}, {height}]\nphysicalFrame=[0, 0, {width}, {height}]\n"
        if command.startswith("dumpsys window"):
            return "mCurrentRotation=ROTATION_0\n"
        return f"Physical size: {width}x{height}\n" if command.startswith("wm size") else ""

    def _input(self, words: list[str]) -> Response:
        if tuple(words[:3]) == CLEARS:
            self.flush()
            self._clear = True
            return Response()
        kind, numbers = words[0] if words else "", [int(word) for word in words[1:] if word.lstrip("-").isdecimal()]
        if kind == "text":
            self._words += _unescaped(" ".join(words[1:]))
            return Response()
        self.flush()
        if kind == "tap" and len(numbers) == 2:
            return self._done(Action(ActionType.CLICK, x=numbers[0], y=numbers[1]))
        if kind in ("swipe", "draganddrop") and len(numbers) in (4, 5):
            return self._done(_moved(numbers))
        if kind == "keyevent" and len(words) == 2:
            name = KEYCODES.get(words[1], words[1].removeprefix("KEYCODE_").lower())
            if name not in KEYS:
                raise ActionError(f"this car has no key {words[1][:40]!r}; it has home, back and enter")
            return self._done(Action(KEYS[name]))
        raise ActionError(f"adb's `input {' '.join(words)[:60]}` is nothing that this car knows")

    def _open(self, name: str) -> Response:
        return self._done(Action(ActionType.OPEN_APP, app_name=name))

    def _done(self, action: Action) -> Response:
        self.touch(action)
        return Response()


def _moved(numbers: list[int]) -> Action:
    start, end = (numbers[0], numbers[1]), (numbers[2], numbers[3])
    if start != end:
        return drag(start, end)
    is_held = len(numbers) == 5 and numbers[4] >= HOLD_MS
    return Action(ActionType.LONG_PRESS if is_held else ActionType.CLICK, x=start[0], y=start[1])


def _unescaped(text: str) -> str:
    """A text as it was before it was prepared for adb's shell."""
    return re.sub(r"\\(.)", r"\1", text.replace("%s", " "))
