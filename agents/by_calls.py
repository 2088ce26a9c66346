"""The reference solution by calls of functions.

It is played by touch on a copy of the episode, and each command that it gives is translated into the call that
gives the same (``interface.translation``). Its looking about is left out: a call needs no screen. What it does
besides, it does as before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.cockpit.actions import point
from automotive_cosim.cockpit.calls import functions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import Signal, named
from automotive_cosim.cockpit.state import Command
from automotive_cosim.contracts import BY_HAND, Action, ActionType, Element, FeedbackCode, Observation
from automotive_cosim.contracts.given import ALL, Channel, Interface, See
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.session import play
from automotive_cosim.errors import ActionError, AgentError
from automotive_cosim.interface.functions import action_of, call_of
from automotive_cosim.interface.translation import actions_of
from automotive_cosim.tasking.instance import Instance

SAME_TIME_S = 0.05
LONGEST_WAIT_S = 10


@dataclass(frozen=True, slots=True)
class TimedCall:
    """One action of a translated solution."""

    action: Action
    heard: int
    """How much the driver had said when the reference solution came to it."""
    at_s: float
    """Seconds since the hand-over when it came to it: a finger has to get there, and what it waits for, such as a
    message or a seat that has to be warm for a while, takes its time for a call too."""
    before: object = None
    """Value of the signal that it sets, before it; None of any other action."""

    @property
    def signal(self) -> Signal[object] | None:
        """The signal that it sets."""
        if self.action.action_type is not ActionType.CALL:
            return None
        name, given = call_of(self.action)
        paths = functions()[name].signals
        if not paths:
            return None
        names = functions()[name].parameters[0].schema.get("enum", ())
        return named(paths[names.index(given["which"])] if "which" in given else paths[0])


class UntranslatableError(AgentError):
    """A command that no function gives."""


def translated(walk: Episode) -> tuple[TimedCall, ...]:
    """The reference solution as calls.

    Args:
        walk: an episode at its hand-over, which is played by touch and closed.

    Raises UntranslatableError: no function gives one of its commands."""
    conditions = replace(walk.setup.conditions, interface=Interface.TOUCH, see=See.BOTH)
    walk.setup = replace(walk.setup, channels=ALL - {Channel.SCREENSHOT}, conditions=conditions)
    oracle, calls = Oracle(), list[TimedCall]()
    oracle.reset(walk.goal)
    oracle.brief(walk.instance)
    try:
        while walk.end is None:
            at_s, heard = walk.observation.time_s, len(walk.heard)
            before, listed = walk.world.cockpit.copy(), tuple(walk.elements)
            action = oracle.act(replace(walk.observation, elements=listed))
            walk.step(action)
            if action.action_type not in BY_HAND:
                calls.append(TimedCall(action_of(*call_of(action)), heard, at_s))
                continue
            for command in _commanded(before, walk.world.cockpit, action, listed, walk.steps[-1].feedback.code):
                found = actions_of(command, before.state)
                if found is None:
                    raise UntranslatableError(f"no function does {command}"[:200])
                for one in found:
                    call = TimedCall(one, heard, at_s)
                    value = None if call.signal is None else before.signals[call.signal]
                    _add(calls, replace(call, before=value))
    finally:
        walk.close()
    return tuple(calls)


def _commanded(
    before: Cockpit, after: Cockpit, action: Action, listed: tuple[Element, ...], code: FeedbackCode
) -> Iterator[Command]:
    """What a touch commanded; messages that are read out while driving are not on the record of commands."""
    yield from (record.command for record in after.given[len(before.given) :])
    if code is FeedbackCode.READ_OUT:
        widget = before.touched(*point(action, listed))
        if widget is not None and widget.on_tap is not None and widget.on_tap.command is not None:
            yield widget.on_tap.command


def _add(calls: list[TimedCall], call: TimedCall) -> None:
    """Adds a call; of several in a row that set the same signal, as taps on plus do, only the last counts."""
    last = calls[-1] if calls else None
    if call.signal is not None and last is not None and last.signal is call.signal and last.heard == call.heard:
        calls[-1] = replace(call, before=last.before)
    else:
        calls.append(call)


@dataclass(slots=True)
class CallPlayer:
    """Plays calls in order, none before the driver had said what the reference solution had heard, and repeats the
    last."""

    calls: Sequence[TimedCall]
    is_timed: bool = True
    """Whether none is given before the reference solution came to it either."""
    _next: int = 0

    def act(self, observation: Observation) -> Action:
        """The next call, or to wait for its time."""
        call = self.calls[min(self._next, len(self.calls) - 1)]
        early_s = call.at_s - observation.time_s if self.is_timed else 0.0
        if early_s > SAME_TIME_S or len(observation.said) < call.heard:
            return Action(ActionType.WAIT, seconds=min(LONGEST_WAIT_S, max(1, int(early_s + SAME_TIME_S))))
        self._next += 1
        return call.action


class OracleByCalls:
    """The oracle without a screen: plays the reference solution as calls, each as soon as it can.

    What has to happen at a certain time it calls when the reference solution does: where a copy of the episode
    shows that hurrying loses."""

    name = "oracle"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self) -> None:
        self._branch: Callable[[], Episode] | None = None
        self._player: CallPlayer | None = None

    def reset(self, goal: str) -> None:
        self._branch = self._player = None

    def brief(
        self, instance: Instance, *, drawn: Callable[[], Sequence[Element]], branch: Callable[[], Episode]
    ) -> None:
        """Takes the episode, at its hand-over."""
        self._branch = branch

    def act(self, observation: Observation) -> Action:
        """The next call; before the first, the reference solution is translated and tried.

        Raises:
            ActionError: it was not told the task.
            UntranslatableError: no function gives one of the reference solution's commands."""
        if self._player is None:
            if self._branch is None:
                raise ActionError("the oracle has to be told the task before it acts")
            self._player = _fastest(translated(self._branch()), self._branch())
        return self._player.act(observation)


def _fastest(calls: Sequence[TimedCall], tried: Episode) -> CallPlayer:
    """Plays calls at once if they win so, else each at its time."""
    try:
        play(tried, CallPlayer(calls, is_timed=False))
        return CallPlayer(calls, is_timed=tried.verdict is None or not tried.verdict.success)
    finally:
        tried.close()
