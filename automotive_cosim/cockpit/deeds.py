"""Records what is commanded at a cockpit, so that it can be done once more at another, in full or in part."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import fields, replace
from typing import Any

from automotive_cosim.cockpit import update
from automotive_cosim.cockpit.messages import (
    Ask,
    AskDriver,
    AskPullOver,
    AskSlowDown,
    CallEmergency,
    DeclineCall,
    Deed,
    Dial,
    Drive,
    Enter,
    Guide,
    HangUp,
    Honk,
    Message,
    Pay,
    Play,
    Put,
    Read,
    Record,
    ResetTrip,
    SendReply,
    Set,
    SetAll,
    Skip,
    Take,
    TakeCall,
    WarnDriver,
    Wash,
)
from automotive_cosim.cockpit.signals import MEDIA
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import Answer, Feedback, FeedbackCode, Reroute, RoadRequest

CARRIED_OUT = frozenset({FeedbackCode.OK, FeedbackCode.NO_EFFECT})
BOOKS = frozenset({"draft", "navigation", "listening", "phone", "desk"})
"""App data that is a dataclass, so that a change of one field is told from one of another."""
PREPARED = "draft"
"""App data that commands nothing by itself but is used by what does."""
UNKNOWN = Answer(True, "")
"""The reply to a request that was not made at the other cockpit."""


def perform(state: State, message: Message) -> Feedback:
    """Performs a message, and records it if it commands or prepares something and the car carries it out."""
    own = message.then if isinstance(message, Enter) else message
    if isinstance(own, Put) and own.book in BOOKS:
        book, commands = getattr(state, own.book), state.commands()
        feedback = update.perform(state, message)
        after = state.commands()
        aims = frozenset(key for key in after if after[key] != commands[key])
        changes = _changed(book, own.value)
        if aims or own.book == PREPARED:
            state.deeds += (Deed(state.time_s, own, aims, changes),)
        return feedback
    feedback = update.perform(state, message)
    aims = _aims(own)
    if aims and (feedback.code in CARRIED_OUT):
        state.deeds += (Deed(state.time_s, own, aims),)
    return feedback


def note_answer(state: State, request: RoadRequest, answer: Answer) -> None:
    """Records the road's reply to the last command."""
    if state.deeds:
        *before, last = state.deeds
        state.deeds = (*before, replace(last, answers=(*last.answers, (request, answer))))


def repeat(state: State, deed: Deed, keys: Collection[str]) -> None:
    """Does once more what was done elsewhere, as far as it aims at these keys of ``State.commands``.

    Of several switches at once, those among the keys are turned; any other deed is done in full or not at all: app
    data and a route only if all that they aim at is among the keys, so that nothing is slipped in. What it
    asks of the road is answered as it was then.
    """
    message = deed.message
    if isinstance(message, SetAll):
        values = tuple((signal, value) for signal, value in message.values if signal.path in keys)
        if values:
            perform(state, SetAll(values, message.said))
    elif isinstance(message, Put):
        if message.book == PREPARED or deed.aims <= frozenset(keys):
            setattr(state, message.book, replace(getattr(state, message.book), **deed.changes))
    elif deed.aims <= frozenset(keys) or (deed.aims & frozenset(keys) and not isinstance(message, Guide)):
        perform(state, message)
    pending, state.pending = state.pending, ()
    for request in pending:
        reply = next((answer for asked, answer in deed.answers if asked == request), UNKNOWN)
        update.answered(state, request, reply)


def _changed(before: Any, after: Any) -> dict[str, Any]:
    """The fields in which two dataclasses of a kind differ."""
    return {
        each.name: getattr(after, each.name)
        for each in fields(before)
        if getattr(after, each.name) != getattr(before, each.name)
    }


def _aims(message: Message) -> frozenset[str]:
    """The commands that a message is given for; none if it commands nothing."""
    match message:
        case Set(signal):
            return frozenset({signal.path})
        case SetAll(values):
            return frozenset(signal.path for signal, _ in values)
        case WarnDriver():
            return frozenset({"alerts"})
        case Guide(place, onward):
            named = (("navigation.destination", place), ("navigation.onward", onward))
            return frozenset(key for key, name in named if name) or frozenset({"requests"})
        case Ask(Reroute(destination)) if destination:
            return frozenset({"navigation.destination"})
        case Ask() | Take() | AskSlowDown() | AskPullOver():
            return frozenset({"requests"})
        case Play() | Skip():
            return frozenset({MEDIA.SELECTED.path, "media.playlist"})
        case AskDriver():
            return frozenset({"questions"})
        case CallEmergency() | Dial():
            return frozenset({"calls"})
        case HangUp():
            return frozenset({"phone.on_call"})
        case TakeCall():
            return frozenset({"calls.answered"})
        case DeclineCall():
            return frozenset({"calls.declined"})
        case SendReply():
            return frozenset({"messages.sent"})
        case Read():
            return frozenset({"messages.read"})
        case Pay():
            return frozenset({"payments"})
        case Drive():
            return frozenset({"driver.profile"})
        case Record():
            return frozenset({"apps.memos", "apps.recording"})
        case ResetTrip(meter):
            return frozenset({"trip.resets_b" if meter == "b" else "trip.resets"})
        case Honk():
            return frozenset({"horn"})
        case Wash():
            return frozenset({"washer"})
        case _:
            return frozenset()
