"""Commands that every app uses: to set signals, to replace app data, to ask the driver."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from automotive_cosim.cockpit.messages import Back
from automotive_cosim.cockpit.signals import ADAS, LIGHTS, Signal
from automotive_cosim.cockpit.state import AppData, Command, CommandRecord, QuestionRecord, State
from automotive_cosim.contracts import Cruise, Feedback, FeedbackCode, Hazards
from automotive_cosim.contracts.text import say

LOOKING = frozenset({"questions", "messages.read"})
"""Commands that change nothing: to ask, and to have a message read out."""


@dataclass(frozen=True, slots=True)
class SimpleCommand(Command):
    """A command that has nothing to say but that it is given."""

    effect: Callable[[State], Feedback]
    aimed: tuple[str, ...]
    """What it aims at, in every state."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset(self.aimed)

    def perform(self, state: State) -> Feedback:
        return self.effect(state)


@dataclass(frozen=True, slots=True)
class Set(Command):
    """Command a signal."""

    signal: Signal[Any]
    value: Any

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({self.signal.path})

    def perform(self, state: State) -> Feedback:
        """Sets the actuator and what is coupled to it, and makes the related requests to the road."""
        signal, value = self.signal, self.value
        before = state.signals.snapshot()
        refusal = state.vehicle.command(signal, value)
        if refusal:
            return state.refused(refusal)
        state.settle()
        if before == state.signals.snapshot():
            return Feedback(
                FeedbackCode.NO_EFFECT,
                say("{signal} is already {value}", signal=_short(signal), value=_said(value)),
            )
        for data in state.apps:
            data.commanded(state, signal)
        _tell_road(state, before)
        return Feedback(FeedbackCode.OK, say("{signal} is {value}", signal=_short(signal), value=_said(value)))


@dataclass(frozen=True, slots=True)
class SetAll(Command):
    """Command several signals at once."""

    values: tuple[tuple[Signal[Any], Any], ...]
    said: str

    def aims(self, state: State) -> frozenset[str]:
        return frozenset(signal.path for signal, _ in self.values)

    def perform(self, state: State) -> Feedback:
        """Sets all actuators; if the car refuses one of them, none."""
        return set_all(state, self.values, self.said)

    def repeat(self, state: State, record: CommandRecord, keys: Collection[str]) -> None:
        """Turns the switches that are among the keys."""
        values = tuple((signal, value) for signal, value in self.values if signal.path in keys)
        if values:
            state.perform(SetAll(values, self.said))


@dataclass(frozen=True, slots=True)
class Put(Command):
    """Replace what an app keeps, and say so."""

    data: AppData
    said: str

    @property
    def prepares(self) -> bool:
        return self.data.prepares

    def aims(self, state: State) -> frozenset[str]:
        """What of it is commanded and changes."""
        before, after = state.of(type(self.data)).commands(), self.data.commands()
        return frozenset(key for key in after if after[key] != before[key])

    def changes(self, state: State) -> Mapping[str, Any]:
        """The fields in which it differs from what is kept."""
        before = state.of(type(self.data))
        return {
            each.name: getattr(self.data, each.name)
            for each in fields(self.data)  # type: ignore[arg-type]
            if getattr(self.data, each.name) != getattr(before, each.name)
        }

    def perform(self, state: State) -> Feedback:
        return state.change(self.data, self.said)

    def repeat(self, state: State, record: CommandRecord, keys: Collection[str]) -> None:
        """Changes the same fields, if all that it aims at is among the keys, so that nothing is slipped in."""
        if self.prepares or record.aims <= frozenset(keys):
            state.keep(replace(state.of(type(self.data)), **record.changes))  # type: ignore[type-var]


@dataclass(frozen=True, slots=True)
class Remove(Put):
    """Remove what the page is about, say so, and leave the page."""

    def perform(self, state: State) -> Feedback:
        """The new data, on the previous screen."""
        done = state.change(self.data, self.said)
        if done.code is FeedbackCode.OK:
            Back().perform(state)
        return done


@dataclass(frozen=True, slots=True)
class AskDriver(Command):
    """Ask the driver something, by voice."""

    text: str

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"questions"})

    def perform(self, state: State) -> Feedback:
        """Notes the question, and how many commands that change something came before it."""
        if not self.text.strip():
            return Feedback(FeedbackCode.REFUSED, say("The question has no words"))
        before = sum(bool(record.aims - LOOKING) for record in state.given)
        state.questions += (QuestionRecord(self.text, before),)
        return Feedback(FeedbackCode.OK, "")


def set_all(state: State, values: tuple[tuple[Signal[Any], Any], ...], said: str) -> Feedback:
    """Sets several actuators; if the car refuses one of them, none."""
    before, vehicle = state.signals.snapshot(), state.vehicle.copy()
    for signal, value in values:
        refusal = vehicle.command(signal, value)
        if refusal:
            return state.refused(refusal)
    state.vehicle = vehicle
    state.settle()
    if before == state.signals.snapshot():
        return Feedback(FeedbackCode.NO_EFFECT, say("it is already set that way"))
    _tell_road(state, before)
    return Feedback(FeedbackCode.OK, said)


def _tell_road(state: State, before: Mapping[str, Any]) -> None:
    """Requests what others see, and the speed to keep."""
    after = state.signals
    if before[LIGHTS.HAZARD.path] != after[LIGHTS.HAZARD]:
        state.pending += (Hazards(after[LIGHTS.HAZARD]),)
    was, now = _kept_speed(before), _kept_speed(after.snapshot())
    if was != now:
        state.pending += (Cruise(now),)


def _kept_speed(values: Mapping[str, Any]) -> float | None:
    """The speed limit of cruise control or the limiter."""
    if values[ADAS.CRUISE_ACTIVE.path]:
        return float(values[ADAS.CRUISE_SPEED.path])
    return float(values[ADAS.LIMITER_SPEED.path]) if values[ADAS.LIMITER_ACTIVE.path] else None


def _short(signal: Signal[Any]) -> str:
    return signal.path.removeprefix("Vehicle.")


def _said(value: Any) -> str:
    if isinstance(value, bool):
        return say("on") if value else say("off")
    return f"{value:g}" if isinstance(value, float) else str(value)
