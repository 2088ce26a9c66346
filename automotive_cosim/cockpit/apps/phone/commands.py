"""Commands of the phone: outgoing and incoming calls, and messages."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.apps.phone.state import Directory, OnCall, PastCall, Phone, Sent, tell
from automotive_cosim.cockpit.commands import SimpleCommand
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode, Severity
from automotive_cosim.contracts.text import say

NOT_LINKED = say("No phone is connected: switch Bluetooth on first")
NOBODY_CALLS = Feedback(FeedbackCode.NO_EFFECT, say("nobody is calling"))


@dataclass(frozen=True, slots=True)
class Dial(Command):
    """Call somebody: a contact's name or a number."""

    who: str

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"calls"})

    def perform(self, state: State) -> Feedback:
        """The call, if a phone is linked."""
        if not state.signals[LINK.BLUETOOTH]:
            return state.refused(NOT_LINKED)
        state.keep(state.of(Phone).dialled(self.who, state.clock, state.time_s))
        tell(state)
        return state.said(say("Calling {who}", who=self.who), Icon.CALL_OUT)


def _call_emergency(state: State) -> Feedback:
    """Call the emergency services."""
    phone = state.of(Phone)
    state.keep(replace(phone, called=(*phone.called, "emergency")))
    state.notify(say("Emergency call placed"), Icon.PHONE_ALERT, Severity.CRITICAL)
    return Feedback(FeedbackCode.OK, say("the emergency services are called"))


CALL_EMERGENCY = SimpleCommand(_call_emergency, ("calls",))


def _hang_up(state: State) -> Feedback:
    """End the call."""
    phone = state.of(Phone)
    if phone.on_call is None:
        return Feedback(FeedbackCode.NO_EFFECT, say("there is no call"))
    state.keep(replace(phone, on_call=None))
    tell(state)
    return Feedback(FeedbackCode.OK, say("the call with {who} is over", who=phone.on_call.who))


HANG_UP = SimpleCommand(_hang_up, ("phone.on_call",))


def _take_call(state: State) -> Feedback:
    """Answer the ringing call."""
    phone, ringing = state.of(Phone), state.of(Phone).ringing
    if ringing is None:
        return NOBODY_CALLS
    state.keep(
        replace(
            phone.logged(PastCall(ringing.who, state.clock, "in")),
            ringing=None,
            on_call=OnCall(ringing.who, state.time_s),
            taken=(*phone.taken, ringing.who),
        )
    )
    tell(state)
    return Feedback(FeedbackCode.OK, say("you are on the phone with {who}", who=ringing.who))


TAKE_CALL = SimpleCommand(_take_call, ("calls.answered",))


def _decline_call(state: State) -> Feedback:
    """Decline the ringing call."""
    phone, ringing = state.of(Phone), state.of(Phone).ringing
    if ringing is None:
        return NOBODY_CALLS
    logged = phone.logged(PastCall(ringing.who, state.clock, "missed"))
    state.keep(replace(logged, ringing=None, declined=(*phone.declined, ringing.who)))
    tell(state)
    return Feedback(FeedbackCode.OK, say("the call from {who} is declined", who=ringing.who))


DECLINE_CALL = SimpleCommand(_decline_call, ("calls.declined",))


@dataclass(frozen=True, slots=True)
class SendReply(Command):
    """Send somebody a message."""

    to: str
    text: str
    own: bool = False
    """Whether in own words, which leave their field and are not shown while driving."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"messages.sent"})

    def perform(self, state: State) -> Feedback:
        """The message; to the present caller, it also declines the call."""
        if not state.signals[LINK.BLUETOOTH]:
            return state.refused(NOT_LINKED)
        ringing = state.of(Phone).ringing
        if ringing is not None and ringing.who == self.to:
            DECLINE_CALL.perform(state)
        state.keep(state.of(Phone).replied(Sent(self.to, self.text, state.time_s, self.own)))
        tell(state)
        hidden = state.locked(Restriction.NO_VOICE_TRANSCRIPTION) if self.own else ""
        if self.own:
            state.focus, state.typed = "", {}
        return state.said(say("Sent to {to}: {text}", to=self.to, text=hidden or self.text), Icon.REPLY)


@dataclass(frozen=True, slots=True)
class Read(Command):
    """Have somebody's messages read out, or open them where that is allowed."""

    who: str

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"messages.read"})

    def perform(self, state: State) -> Feedback:
        who, phone = self.who, state.of(Phone)
        thread = state.of(Directory).thread(who, phone)
        state.keep(phone.opened(who))
        state.notices = tuple(notice for notice in state.notices if notice.opens != ("thread", who))
        tell(state)
        words = thread.aloud() if thread else ""
        aloud = state.locked(Restriction.NO_TEXT_MESSAGE)
        return Feedback(
            FeedbackCode.READ_OUT if aloud else FeedbackCode.OK, say("{who} wrote: {text}", who=who, text=words)
        )
