"""Outgoing and incoming calls and messages."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.arrivals import RINGS_S, Arrival
from automotive_cosim.cockpit.people import OnCall, PastCall, Received, Ringing
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import CALL, LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say

NOT_LINKED = say("No phone is connected: switch Bluetooth on first")


def dial(state: State, who: str) -> Feedback:
    """Calls somebody, if a phone is linked."""
    if not state.signals[LINK.BLUETOOTH]:
        return state.refused(NOT_LINKED)
    state.phone = state.phone.called(who, state.clock, state.time_s)
    state.calls += (who,)
    tell(state)
    return state.said(say("Calling {who}", who=who), Icon.CALL_OUT)


def hang_up(state: State) -> Feedback:
    """Ends the present call."""
    if state.phone.on_call is None:
        return Feedback(FeedbackCode.NO_EFFECT, say("there is no call"))
    who = state.phone.on_call.who
    state.phone = replace(state.phone, on_call=None)
    tell(state)
    return Feedback(FeedbackCode.OK, say("the call with {who} is over", who=who))


def answer(state: State) -> Feedback:
    """Answers the ringing call."""
    ringing = state.phone.ringing
    if ringing is None:
        return Feedback(FeedbackCode.NO_EFFECT, say("nobody is calling"))
    state.phone = replace(
        state.phone.logged(PastCall(ringing.who, state.clock, "in")),
        ringing=None,
        on_call=OnCall(ringing.who, state.time_s),
        taken=(*state.phone.taken, ringing.who),
    )
    tell(state)
    return Feedback(FeedbackCode.OK, say("you are on the phone with {who}", who=ringing.who))


def decline(state: State) -> Feedback:
    """Declines the ringing call."""
    ringing = state.phone.ringing
    if ringing is None:
        return Feedback(FeedbackCode.NO_EFFECT, say("nobody is calling"))
    state.phone = replace(
        state.phone.logged(PastCall(ringing.who, state.clock, "missed")),
        ringing=None,
        declined=(*state.phone.declined, ringing.who),
    )
    tell(state)
    return Feedback(FeedbackCode.OK, say("the call of {who} is declined", who=ringing.who))


def reply(state: State, to: str, text: str) -> Feedback:
    """Sends a message; to the present caller, it also declines the call."""
    if not state.signals[LINK.BLUETOOTH]:
        return state.refused(NOT_LINKED)
    if state.phone.ringing is not None and state.phone.ringing.who == to:
        decline(state)
    state.phone = state.phone.answered(to, text)
    tell(state)
    return state.said(say("Sent to {to}: {text}", to=to, text=text), Icon.REPLY)


def read(state: State, who: str) -> Feedback:
    """Reads out, or opens, somebody's messages."""
    thread = state.directory.thread(who, state.phone)
    state.phone = state.phone.opened(who)
    state.notices = tuple(notice for notice in state.notices if notice.opens != ("thread", who))
    tell(state)
    words = " ".join(map(_sentence, thread.lines)) if thread else ""
    aloud = state.locked(Restriction.NO_TEXT_MESSAGE)
    return Feedback(
        FeedbackCode.READ_OUT if aloud else FeedbackCode.OK, say("{who} wrote: {text}", who=who, text=words)
    )


def _sentence(text: str) -> str:
    """A message as it is read out before another: with its stop."""
    return text if text.endswith((".", "!", "?", "…", "。", "！", "？")) else f"{text}."


def receive(state: State) -> None:
    """Handles arrivals, and ends the ringing of a call whose time is over or whose phone is unlinked."""
    ringing = state.phone.ringing
    linked = state.signals[LINK.BLUETOOTH]
    if ringing is not None and (state.time_s - ringing.since_s >= RINGS_S or not linked):
        state.phone = replace(state.phone, ringing=None)
        _missed(state, ringing.who)
    waiting = []
    for arrival in state.expected:
        if arrival.at_s > state.time_s - state.departed_s:
            waiting.append(arrival)
        elif arrival.kind == "call":
            _ring(state, arrival, linked)
        elif linked and _covered(state):
            _take_in(state, arrival)
        else:
            waiting.append(arrival)
    state.expected = tuple(waiting)
    tell(state)


def tell(state: State) -> None:
    """The phone's state as signals."""
    phone, signals = state.phone, state.signals
    signals[CALL.RINGING] = "" if phone.ringing is None else phone.ringing.who
    signals[CALL.PARTNER] = "" if phone.on_call is None else phone.on_call.who
    signals[CALL.UNREAD] = float(len(state.directory.unread(phone)))


def _covered(state: State) -> bool:
    return state.outside is not None and state.outside.connectivity.online


def _ring(state: State, arrival: Arrival, linked: bool) -> None:
    """Rings, except under do not disturb or during a call. Without coverage or phone, no call comes."""
    if not (linked and _covered(state)):
        return
    phone = state.phone
    if phone.do_not_disturb or phone.on_call is not None or phone.ringing is not None:
        _missed(state, arrival.who)
    else:
        state.phone = replace(phone, ringing=Ringing(arrival.who, state.time_s))


def _missed(state: State, who: str) -> None:
    state.phone = state.phone.logged(PastCall(who, state.clock, "missed"))
    state.notify(
        say("Missed call from {who}", who=who),
        Icon.CALL_MISSED,
        seen=state.phone.do_not_disturb,
        opens=("contact", who),
    )


def _take_in(state: State, arrival: Arrival) -> None:
    state.phone = state.phone.received_from(Received(arrival.who, state.clock, arrival.text))
    state.notify(
        say("New message from {who}", who=arrival.who),
        Icon.MESSAGE,
        seen=state.phone.do_not_disturb,
        opens=("thread", arrival.who),
    )
