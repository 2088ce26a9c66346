"""A person at the terminal, with numbered elements and a prompt: the same information as T3A."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TextIO

from automotive_cosim.agents.marks import listed
from automotive_cosim.agents.settings import T3A
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.contracts import (
    Action,
    ActionType,
    AlertKind,
    Direction,
    Element,
    GoalStatus,
    Observation,
    Reason,
)
from automotive_cosim.errors import ActionError
from automotive_cosim.interface.observe import Channel

HELP = f"""\
  NUMBER          tap that element           open APP        {", ".join(apps())}
  NUMBER TEXT     type into it               up, down        scroll
  home, back      go there                   wait [SECONDS]  let time pass
  alert KIND      warn the driver            ask QUESTION    ask the driver, who takes time to answer
  done            it is done                 no [REASON]     nothing has to be done: {", ".join(Reason)}
  cannot [REASON] it must not or cannot be   {{...}}           any action as JSON
"""


class Human:
    """Asks on the terminal until it is given an action."""

    name = "human"
    model = "none"
    channels: frozenset[Channel] = T3A.channels

    def __init__(self, ask: Callable[[], str] = input, out: TextIO | None = None) -> None:
        """Connects to a terminal.

        Args:
            ask: reads a line; raises ``EOFError`` at the end of the input.
            out: where to print the screen; by default standard error, which never carries results."""
        self._ask = ask
        self._out = out or sys.stderr
        self._heard = 0

    def reset(self, goal: str) -> None:
        """Prints the goal and how to answer."""
        self._heard = 0
        self._say(f"\n  the driver says: “{goal}”\n\n{HELP}")

    def act(self, observation: Observation) -> Action:
        """The action that the person enters; the end of the input interrupts the run.

        Raises KeyboardInterrupt: there is no more input."""
        self._show(observation)
        while True:
            self._say("> ", end="")
            try:
                return understood(self._ask())
            except ActionError as error:
                self._say(f"  {error}")
            except EOFError:
                raise KeyboardInterrupt from None

    def _show(self, seen: Observation) -> None:
        car = seen.vehicle
        speed = "" if car is None else f", {car.speed_kmh:.0f} km/h, {car.ambient_temperature_c:.0f} °C outside"
        for text in seen.said[self._heard :]:
            self._say(f"\n  the driver says: “{text}”")
        self._heard = len(seen.said)
        self._say(f"\n  {seen.time_s:.0f} s{speed}; last: {seen.feedback.code} {seen.feedback.text}")
        for index, element in listed(seen.elements or ()):
            if words := _words(element):
                self._say(f"  {index:3d}  {words}")

    def _say(self, text: str, end: str = "\n") -> None:
        print(text, end=end, file=self._out, flush=True)


def understood(line: str) -> Action:
    """The action that a line of input means. Raises ActionError: it is not an action."""
    line = line.strip()
    if line.startswith("{"):
        return parse(line)
    word, _, rest = line.partition(" ")
    word, rest = word.lower(), rest.strip()
    if word.isdecimal():
        tap = {"action_type": ActionType.CLICK, "index": int(word)}
        return parse(
            tap | {"action_type": ActionType.INPUT_TEXT, "text": rest, "clear_text": True} if rest else tap
        )
    plain: dict[str, dict[str, object]] = {
        "home": {"action_type": ActionType.NAVIGATE_HOME},
        "back": {"action_type": ActionType.NAVIGATE_BACK},
        "open": {"action_type": ActionType.OPEN_APP, "app_name": rest},
        "up": {"action_type": ActionType.SCROLL, "direction": Direction.UP},
        "down": {"action_type": ActionType.SCROLL, "direction": Direction.DOWN},
        "wait": {"action_type": ActionType.WAIT, "seconds": int(rest) if rest.isdecimal() else None},
        "ask": {"action_type": ActionType.ASK_DRIVER, "text": rest},
        "alert": {"action_type": ActionType.SHOW_ALERT, "kind": rest or AlertKind.SPEED},
        "done": {"action_type": ActionType.STATUS, "goal_status": GoalStatus.COMPLETE},
        "no": {
            "action_type": ActionType.STATUS,
            "goal_status": GoalStatus.NOT_NEEDED,
            "reason": rest or Reason.NONE,
        },
        "cannot": {
            "action_type": ActionType.STATUS,
            "goal_status": GoalStatus.INFEASIBLE,
            "reason": rest or Reason.NONE,
        },
    }
    if word not in plain:
        raise ActionError(f"{line[:40]!r} is not an action; give a number, or one of {', '.join(plain)}")
    return parse(plain[word])


def _words(element: Element) -> str:
    parts = [element.text, element.content_description]
    words = ": ".join(part for part in parts if part)
    state = " [on]" if element.is_checked else ""
    return f"{words}{state}{'' if element.is_clickable else '  (not clickable)'}" if words else ""
