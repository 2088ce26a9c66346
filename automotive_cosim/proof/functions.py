"""The gate of functions: what is won by touch is won by calls.

The reference solution is played by touch, and each command that it gives is translated into the call that gives the
same (``interface.translation``). Its looking about is left out: a call needs no screen. What it does besides, it
does as before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from automotive_cosim.agents.trivial import AlwaysAlert
from automotive_cosim.cockpit.actions import point
from automotive_cosim.cockpit.calls import functions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import Signal, named
from automotive_cosim.cockpit.state import Command
from automotive_cosim.contracts import (
    BY_HAND,
    Action,
    ActionType,
    AlertKind,
    Element,
    FeedbackCode,
    GoalStatus,
    Observation,
)
from automotive_cosim.contracts.given import Interface, See
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.loop import Actor
from automotive_cosim.interface.functions import action_of, call_of
from automotive_cosim.interface.translation import actions_of
from automotive_cosim.proof.ground import Ground, Played, finish

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


class UntranslatableError(Exception):
    """A command that no function gives."""


def translated(ground: Ground) -> tuple[TimedCall, ...]:
    """The reference solution as calls.

    Raises:
        UntranslatableError: no function gives one of its commands.
    """
    oracle, walk, calls = ground.oracle(), ground.episode.branch(), list[TimedCall]()
    try:
        while walk.end is None:
            at_s, heard = walk.observation.time_s, len(walk.heard)
            action = oracle.act(walk.observation)
            before, listed = walk.world.cockpit.copy(), walk.elements
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
class _Caller:
    """Plays calls in order, none before the reference solution came to it or the driver had said what it had heard,
    and repeats the last."""

    calls: Sequence[TimedCall]
    _next: int = 0

    def act(self, observation: Observation) -> Action:
        call = self.calls[min(self._next, len(self.calls) - 1)]
        early_s = call.at_s - observation.time_s
        if early_s > SAME_TIME_S or len(observation.said) < call.heard:
            return Action(ActionType.WAIT, seconds=min(LONGEST_WAIT_S, max(1, int(early_s + SAME_TIME_S))))
        self._next += 1
        return call.action


def _play(ground: Ground, actor: Actor, *, stop_when_lost: bool = False) -> Played:
    """An episode from the hand-over of an agent that calls functions and sees nothing of the screen."""
    episode: Episode = ground.episode.branch()
    conditions = replace(episode.setup.conditions, interface=Interface.FUNCTIONS, see=See.NOTHING)
    episode.setup = replace(episode.setup, conditions=conditions)
    return finish(episode, actor, stop_when_lost=stop_when_lost)


def functions_win(ground: Ground) -> Iterator[str]:
    """Plays the reference solution as calls, and each call with a wrong value. What hangs on the picture is left
    out."""
    if ground.task.needs_picture:
        return
    try:
        calls = translated(ground)
    except UntranslatableError as error:
        yield str(error)
        return
    played = _play(ground, _Caller(calls))
    if not played.success:
        yield f"by functions it fails: {played.why}"
        return
    for at, call in enumerate(calls):
        wrongs = tuple(_wrong(call))
        others = ((*calls[:at], wrong, *calls[at + 1 :]) for wrong in wrongs)
        if wrongs and all(_play(ground, _Caller(other)).success for other in others):
            if _play(ground, _Caller((*calls[:at], *calls[at + 1 :]))).success:
                continue  # it led the finger somewhere, as to another source's list
            name, given = call_of(wrongs[-1].action)
            yield f"succeeds with {name} {given}, which is wrong"


def _wrong(call: TimedCall) -> Iterator[TimedCall]:
    """The same call with each wrong value: a switch the other way, a number moved from what it was in the other
    direction, any other choice, of which one has to lose. None of a call that sets no signal."""
    signal, (name, given) = call.signal, call_of(call.action)
    if signal is None:
        return
    *_, value = functions()[name].parameters
    now = given[value.name]
    if isinstance(now, bool):
        wrong: tuple[object, ...] = (not now,)
    elif isinstance(call.before, float):
        moved = call.before - signal.step if now > call.before else call.before + signal.step
        wrong = (min(signal.high, max(signal.low, moved)),)
    else:
        wrong = signal.allowed
    for each in wrong:
        if each != now:
            yield replace(call, action=action_of(name, {**given, value.name: each}))


def functions_are_not_enough(grounds: dict[str, Ground]) -> Iterator[str]:
    """Plays strategies without a look: to end at once in each way, and to warn of speed, or of what a reference
    solution warns of, whatever happens. Other warnings are the gate ``trivial``'s, which plays the same actions."""
    ends = {str(status): TimedCall(Action(ActionType.STATUS, goal_status=status), 0, 0.0) for status in GoalStatus}
    for name, end in ends.items():
        if all(_play(ground, _Caller((end,))).success for ground in grounds.values()):
            yield f"{name} at once wins by functions"
    warnings = (action.kind for ground in grounds.values() for action in ground.reference.actions if action)
    for kind in dict.fromkeys((AlertKind.SPEED, *filter(None, warnings))):
        warner = AlwaysAlert(kind)
        if all(_play(ground, ground.agent(warner), stop_when_lost=True).success for ground in grounds.values()):
            yield f"always {kind} wins by functions"
