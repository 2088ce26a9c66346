"""Runs AndroidWorld's agents unchanged: ``Class(env)``, ``step(goal)``, and an ``env`` that they read and act on,
either by ``env.execute_action`` or by ``env.controller`` and adb.

Such an agent calls the environment; here the environment calls the agent. So it runs on a thread of its own, which
pauses between its actions: ``act`` resumes it until it executes the next one.

    agent thread   step(goal) -> env.get_state() ... env.execute_action(action) | waits
    this thread    act(observation) -------------------------------------------> Action

Their fixed pauses are switched off, and so are those of the device's modules: here, time passes only on the road.
A class with ``keeps_pauses = True`` keeps them. ``step`` gets what the driver has said since beneath the goal.
"""

from __future__ import annotations

import queue
import re
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from automotive_cosim.agents import prompt
from automotive_cosim.agents.adb import Controller
from automotive_cosim.agents.native.verbs import STATUSES, typed
from automotive_cosim.cockpit.actions import FIELDS, check, parse
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import Action, ActionType, BoundingBox, Element, GoalStatus, Observation
from automotive_cosim.errors import ActionError
from automotive_cosim.interface.observe import Channel

DEVICE = "android_world.env."
"""AndroidWorld's modules that work the device."""
GOAL_STATUS = re.compile(r"""['"]goal_status['"]\s*:\s*['"](\w+)""")


@dataclass(frozen=True)
class Bounds:
    """A box in pixels, with the properties that AndroidWorld's agents use."""

    x_min: int
    x_max: int
    y_min: int
    y_max: int

    @property
    def center(self) -> tuple[float, float]:
        """The middle of the box."""
        return (self.x_min + self.x_max) / 2, (self.y_min + self.y_max) / 2

    @property
    def width(self) -> int:
        """Size in pixels."""
        return self.x_max - self.x_min

    @property
    def height(self) -> int:
        """Size in pixels."""
        return self.y_max - self.y_min

    @property
    def area(self) -> int:
        """Area in square pixels."""
        return self.width * self.height


@dataclass
class UIElement:
    """An element in AndroidWorld's fields."""

    text: str | None
    content_description: str | None
    class_name: str
    bbox_pixels: Bounds
    hint_text: str | None
    is_checked: bool
    is_checkable: bool
    is_clickable: bool
    is_editable: bool
    is_enabled: bool
    is_focused: bool
    is_focusable: bool
    is_long_clickable: bool
    is_scrollable: bool
    is_selected: bool
    is_visible: bool
    package_name: str
    resource_name: str
    resource_id: str
    bbox: Bounds | None = None
    tooltip: str | None = None


@dataclass
class _AndroidWorldState:
    """The result of ``get_state``."""

    pixels: npt.NDArray[np.uint8]
    ui_elements: list[UIElement]
    forest: None = None
    auxiliaries: None = None


class _Prints:
    """While any agent acts, what is printed goes to standard error: it is not this program's output."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._acting = 0
        self._output = sys.stdout

    def __enter__(self) -> None:
        with self._lock:
            if not self._acting:
                self._output, sys.stdout = sys.stdout, sys.stderr
            self._acting += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._acting -= 1
            if not self._acting:
                sys.stdout = self._output


_PRINTS = _Prints()


class _EpisodeOverError(BaseException):
    """Ends an agent's thread at its next call; no ``except Exception`` of the agent catches it."""


@dataclass(frozen=True)
class _Over:
    """The agent returned from ``step`` without an action, or says that it is done."""

    declared: bool
    data: Any


class _Environment:
    """The environment that an AndroidWorld agent gets. All its methods are called on the agent's thread."""

    orientation = 0
    foreground_activity_name = "org.automotive_cosim.cockpit"

    def __init__(self, screen_px: tuple[int, int]) -> None:
        self.logical_screen_size = self.device_screen_size = screen_px
        self.physical_frame_boundary = (0, 0, *screen_px)
        self.interaction_cache = ""
        self.seen: queue.Queue[Observation | None] = queue.Queue()
        self.done: queue.Queue[Action | _Over | Exception | SystemExit] = queue.Queue()
        self.acted = False
        self.controller = Controller(self.perform, self.elements, screen_px)
        self._now: Observation | None = None

    def get_state(self, wait_to_stabilize: bool = False) -> _AndroidWorldState:
        """The screen as it is now."""
        self.controller.flush()
        now = self.now()
        width, height = self.logical_screen_size
        pixels = np.zeros((height, width, 3), np.uint8) if now.screenshot is None else now.screenshot
        return _AndroidWorldState(np.array(pixels), [_ui_element(element) for element in now.elements or ()])

    def reset(self, go_home: bool = False) -> _AndroidWorldState:
        return self.get_state()

    def execute_action(self, action: Any) -> None:
        """Passes the action on and waits until its time has passed. A text is typed and entered, as on the device.

        Raises:
            ActionError: there is no such action here.
            ValueError: it has no target."""
        self.controller.flush()
        known = translated(action, self.elements(), self.controller.last, self.logical_screen_size)
        if known.action_type is ActionType.ANSWER:
            self.interaction_cache = known.text or ""
        self.controller.touch(known)
        if known.action_type is ActionType.INPUT_TEXT:
            self.perform(Action(ActionType.KEYBOARD_ENTER))

    def perform(self, action: Action) -> None:
        """Hands an action over and waits until its time has passed."""
        self.acted = True
        self.done.put(check(action))
        self.wait()

    def elements(self) -> Sequence[Element]:
        return self.now().elements or ()

    def hide_automation_ui(self) -> None:
        """Does nothing."""

    def display_message(self, message: str, header: str = "") -> None:
        """Does nothing."""

    def wait(self) -> None:
        """Waits for a new observation."""
        self._now = None
        self.now()

    def now(self) -> Observation:
        """The current observation; ends the thread when the episode is over."""
        if self._now is None:
            self._now = self.seen.get()
        if self._now is None:
            raise _EpisodeOverError
        return self._now


class AndroidWorldAgent:
    """Adapts an AndroidWorld agent to this project's protocol."""

    model = "own"
    channels = frozenset({Channel.ELEMENTS, Channel.SCREENSHOT})

    def __init__(self, make: Callable[..., Any]) -> None:
        """Takes the agent's class or factory.

        Args:
            make: called with an environment, e.g. the agent's class; returns an object with ``step(goal)``."""
        self._make = make
        self.name = getattr(make, "__name__", "androidworld")
        self._env: _Environment | None = None

    def reset(self, goal: str) -> None:
        """The thread of the previous episode ends; the first observation makes a new agent."""
        if self._env is not None:
            self._env.seen.put(None)
        self._env = None

    def act(self, observation: Observation) -> Action:
        """Resumes the agent until its next action, or the end of a ``step`` without one.

        Raises ActionError: it raised, took no action in a step, or took one that does not exist here."""
        if self._env is None:
            self._env = _Environment(_screen_px(observation))
            threading.Thread(target=self._live, args=(self._env,), daemon=True).start()
        self._env.seen.put(observation)
        with _PRINTS:
            done = self._env.done.get()
        if isinstance(done, Action):
            return done
        if isinstance(done, ActionError):
            raise done
        if isinstance(done, Exception | SystemExit):
            raise ActionError(f"agent {self.name!r} raised {type(done).__name__}: {done}") from done
        if not done.declared:
            raise ActionError(f"agent {self.name!r} took no action in this step")
        return Action(ActionType.STATUS, goal_status=_declared(done.data))

    def _live(self, env: _Environment) -> None:
        agent = None
        try:
            env.now()
            while True:
                env.acted = False
                outcome: _Over | Exception | SystemExit
                try:
                    agent = agent or self._made(env)
                    result = agent.step(_wish(env.now()))
                    outcome = _Over(bool(getattr(result, "done", False)), getattr(result, "data", None))
                    env.controller.flush()
                    if not (env.acted or outcome.declared):
                        _catch_up(env, outcome.data)
                except (Exception, SystemExit) as error:  # without an answer, `act` would wait forever
                    outcome = error
                handed_over = isinstance(outcome, _Over) and env.acted and not outcome.declared
                if not handed_over:
                    env.done.put(outcome)
                    env.wait()
        except _EpisodeOverError:
            return

    def _made(self, env: _Environment) -> Any:
        agent = self._make(env)
        if not getattr(agent, "keeps_pauses", False):
            _take_pauses(agent)
        return agent


def _wish(seen: Observation) -> str:
    """What the driver wants, and beneath it what he has said since, as in every prompt; house rules come first."""
    words = prompt.driver_words(seen) if seen.said else seen.goal
    return f"House rules:\n{seen.policy}\n\n{words}" if seen.policy else words


def _screen_px(seen: Observation) -> tuple[int, int]:
    """Width and height of the screen that is observed; without its picture, of the smallest that holds the list."""
    if seen.screenshot is not None:
        height, width = seen.screenshot.shape[:2]
        return width, height
    boxes = [element.bbox_pixels for element in seen.elements or ()]
    right, bottom = max((box.x_max for box in boxes), default=0), max((box.y_max for box in boxes), default=0)
    holding = [size for size in ScreenSize if right <= size.width and bottom <= size.height]
    found = min(holding, key=lambda size: size.width * size.height, default=ScreenSize.STANDARD)
    return found.width, found.height


def translated(
    action: Any,
    elements: Sequence[Element] = (),
    last: tuple[int, int] | None = None,
    screen_px: tuple[int, int] = (ScreenSize.STANDARD.width, ScreenSize.STANDARD.height),
) -> Action:
    """An AndroidWorld ``JSONAction``, or anything with its attributes, as one of ours.

    Args:
        elements: those on the screen; a text without a target goes to the one with the focus.
        last: the pixel that was touched last.
        screen_px: width and height; a swipe without a target begins in the middle.

    Raises:
        ActionError: there is no such action here.
        ValueError: a touch has no target."""
    names = {field.name for field in fields(Action)} - {"action_type"}
    given = {name: value for name in names if (value := getattr(action, name, None)) is not None}
    kind = str(getattr(action, "action_type", ""))
    takes = FIELDS.get(ActionType(kind)) if kind in set(ActionType) else None
    if takes is not None:
        known = (*takes.required, *takes.optional, *(("index", "x", "y") if takes.target else ()))
        given = {name: value for name, value in given.items() if name in known}
        if takes.target and not {"index", "x", "y"} & set(given):
            if kind == ActionType.INPUT_TEXT:
                return check(typed(given.get("text", ""), elements, last, clear=bool(given.get("clear_text"))))
            if kind != ActionType.SWIPE:
                raise ValueError(f"Invalid {kind} action: {action}")
            given |= {"x": screen_px[0] // 2, "y": screen_px[1] // 2}
        if kind == ActionType.SWIPE:  # up and down are the finger's directions there, left and right are not
            given["direction"] = _ACROSS.get(given.get("direction", ""), given.get("direction"))
    for name in ("x", "y", "index"):
        if isinstance(given.get(name), float):
            given[name] = round(given[name])
    return parse({"action_type": kind, **given})


_ACROSS = {"left": "right", "right": "left"}


class _NoPauses:
    """The module ``time`` as the device's modules see it: nothing has to come to rest."""

    def __getattr__(self, name: str) -> Any:
        return getattr(time, name)

    def sleep(self, seconds: float) -> None:
        """Does nothing."""


def _take_pauses(agent: Any) -> None:
    """Lets an agent, and the device that it works, wait no fixed time after an action."""
    for name, pause in (("transition_pause", None), ("wait_after_action_seconds", 0.0)):
        if hasattr(agent, name):
            setattr(agent, name, pause)
    for name, module in list(sys.modules.items()):
        if name.startswith(DEVICE) and getattr(module, "time", None) is time:
            vars(module)["time"] = _NoPauses()


def _catch_up(env: _Environment, data: Any) -> None:
    """Performs what a step says that it did, but the device does by itself: to wait, and to answer."""
    for value in _values(data).values():
        if getattr(value, "action_type", None) in (ActionType.WAIT, ActionType.ANSWER):
            env.execute_action(value)
            return


def _declared(data: Any) -> GoalStatus:
    """The status in a step's data, where AndroidWorld's agents leave it, as an action or in the model's answer;
    ``complete`` without one."""
    values = _values(data)
    for value in values.values():
        status = getattr(value, "goal_status", None)
        if status in set(GoalStatus):
            return GoalStatus(status)
    for value in values.values():
        ending = _values(_values(value).get("arguments"))  # a tool call of the model, which its code has read
        if ending.get("action") == "terminate" and ending.get("status") in STATUSES:
            return STATUSES[ending["status"]]
    for name, value in values.items():
        if isinstance(value, str) and name.endswith(("output", "response")):
            said = [word for word in GOAL_STATUS.findall(value) if word in set(GoalStatus)]
            if said:
                return GoalStatus(said[-1])
    return GoalStatus.COMPLETE


def _values(data: Any) -> Mapping[str, Any]:
    return data if isinstance(data, dict) else {}


def _ui_element(element: Element) -> UIElement:
    shared = {field.name for field in fields(Element)} & {field.name for field in fields(UIElement)}
    values = {name: getattr(element, name) for name in shared}
    texts = {name: values[name] or None for name in ("text", "content_description", "hint_text")}
    return UIElement(
        **(values | texts | {"bbox_pixels": _bounds(element.bbox_pixels), "resource_name": element.resource_id})
    )


def _bounds(box: BoundingBox) -> Bounds:
    return Bounds(box.x_min, box.x_max, box.y_min, box.y_max)
