"""The gate of functions: what is won by touch is won by calls (``agents.by_calls``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from automotive_cosim.agents.by_calls import CallPlayer, TimedCall, UntranslatableError, translated
from automotive_cosim.agents.trivial import AlwaysAlert
from automotive_cosim.cockpit.calls import functions
from automotive_cosim.contracts import Action, ActionType, AlertKind, GoalStatus
from automotive_cosim.contracts.given import Interface, See
from automotive_cosim.episode.session import Actor
from automotive_cosim.interface.functions import action_of, call_of
from automotive_cosim.proof.hand_over import Ground, Played, finish


def _play(ground: Ground, actor: Actor, *, stop_when_lost: bool = False) -> Played:
    """An episode from the hand-over of an agent that calls functions and sees nothing of the screen."""
    episode = ground.episode.branch()
    conditions = replace(episode.setup.conditions, interface=Interface.FUNCTIONS, see=See.NOTHING)
    episode.setup = replace(episode.setup, conditions=conditions)
    return finish(episode, actor, stop_when_lost=stop_when_lost)


def functions_win(ground: Ground) -> Iterator[str]:
    """Plays the reference solution as calls, and each call with a wrong value. What hangs on the picture is left
    out."""
    if ground.task.needs_picture:
        return
    try:
        calls = translated(ground.episode.branch())
    except UntranslatableError as error:
        yield str(error)
        return
    played = _play(ground, CallPlayer(calls))
    if not played.success:
        yield f"by functions it fails: {played.why}"
        return
    for at, call in enumerate(calls):
        wrongs = tuple(_wrong(call))
        others = ((*calls[:at], wrong, *calls[at + 1 :]) for wrong in wrongs)
        if wrongs and all(_play(ground, CallPlayer(other)).success for other in others):
            if _play(ground, CallPlayer((*calls[:at], *calls[at + 1 :]))).success:
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
        if all(_play(ground, CallPlayer((end,))).success for ground in grounds.values()):
            yield f"{name} at once wins by functions"
    warnings = (action.kind for ground in grounds.values() for action in ground.reference.actions if action)
    for kind in dict.fromkeys((AlertKind.SPEED, *filter(None, warnings))):
        warner = AlwaysAlert(kind)
        if all(_play(ground, ground.agent(warner), stop_when_lost=True).success for ground in grounds.values()):
            yield f"always {kind} wins by functions"
