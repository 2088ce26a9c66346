"""Commands to the phone, the music and the smaller apps."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta

from automotive_cosim.cockpit import calls
from automotive_cosim.cockpit.desk import PRICES, Ticket, TripMeter
from automotive_cosim.cockpit.media import Entry, queue
from automotive_cosim.cockpit.messages import (
    DeclineCall,
    Dial,
    HangUp,
    Honk,
    Message,
    Pay,
    Read,
    Record,
    ResetTrip,
    SendReply,
    TakeCall,
    Wash,
)
from automotive_cosim.cockpit.signals import BODY, DRIVE, ENERGY, LINK, MEDIA
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import Quantity, say

WASH_PCT = 2.0
"""Share of the washer's tank used per wash."""


def run(state: State, message: Message) -> Feedback:
    """Carries out one message that is addressed to an app."""
    match message:
        case Dial(who):
            return calls.dial(state, who)
        case HangUp():
            return calls.hang_up(state)
        case TakeCall():
            return calls.answer(state)
        case DeclineCall():
            return calls.decline(state)
        case SendReply(to, text):
            return calls.reply(state, to, text)
        case Read(who):
            return calls.read(state, who)
        case Pay():
            return _pay(state)
        case Record():
            return _record(state)
        case ResetTrip(meter):
            return _reset_trip(state) if meter == "a" else _reset_trip_b(state)
        case Honk():
            state.horns += 1
            state.signals[DRIVE.HORN] = True
            return Feedback(FeedbackCode.OK, say("the horn sounds"))
        case Wash():
            return _wash(state)
        case _:
            raise TypeError(f"{message} is not known")


def _pay(state: State) -> Feedback:
    if not state.signals[LINK.ONLINE] or state.outside is None:
        return state.refused(say("Paying needs a connection"))
    desk = state.desk
    until = state.clock_at(state.outside.local_time + timedelta(minutes=desk.minutes))
    ticket = Ticket(desk.zone, desk.minutes, price(desk.zone, desk.minutes), until)
    state.desk = replace(desk, tickets=(*desk.tickets, ticket))
    return state.said(
        say("Paid {price}: {zone} until {time}", price=Quantity(f"{ticket.price:.2f}"), zone=desk.zone, time=until),
        Icon.TICKET,
    )


def price(zone: str, minutes: int) -> float:
    """Pays for a parking space."""
    return round(PRICES[zone] * minutes / 60, 2)


def _record(state: State) -> Feedback:
    since = state.desk.recording_since_s
    if since is None:
        state.desk = replace(state.desk, recording_since_s=state.time_s)
        return Feedback(FeedbackCode.OK, say("the memo is being recorded"))
    seconds = int(state.time_s - since)
    memo = say(
        "Memo {number}, {time}, {length}",
        number=len(state.desk.memos) + 1,
        time=state.clock,
        length=f"{seconds // 60}:{seconds % 60:02d}",
    )
    state.desk = replace(state.desk, recording_since_s=None, memos=(*state.desk.memos, memo))
    return Feedback(FeedbackCode.OK, say("{memo} is kept", memo=memo))


def _reset_trip(state: State) -> Feedback:
    state.desk = replace(state.desk, resets=state.desk.resets + 1, trip_from=odometer(state))
    return Feedback(FeedbackCode.OK, say("the trip computer is reset"))


def _reset_trip_b(state: State) -> Feedback:
    meter = TripMeter(since=odometer(state), resets=state.desk.trip_b.resets + 1)
    state.desk = replace(state.desk, trip_b=meter)
    return Feedback(FeedbackCode.OK, say("trip B is reset"))


def odometer(state: State) -> tuple[float, float, float]:
    """Driven metres, simulation time and battery level."""
    driven_m = 0.0 if state.outside is None else state.outside.driving.distance_m
    return driven_m, state.time_s, state.signals[ENERGY.LEVEL]


def _wash(state: State) -> Feedback:
    left = state.signals[BODY.WASHER_FLUID]
    if left < WASH_PCT:
        return state.refused(say("The washer's tank is empty"))
    state.signals[BODY.WASHER_FLUID] = left - WASH_PCT
    state.washes += 1
    return state.said(say("The windshield is washed"), Icon.WASHER)


# --- music ------------------------------------------------------------------------------------------------


def start(state: State, entry: Entry) -> None:
    """The entry plays from its beginning."""
    signals = state.signals
    state.played_s = 0.0
    signals[MEDIA.PLAYED], signals[MEDIA.TRACK], signals[MEDIA.ARTIST] = entry.uri, entry.title, entry.by


def skipped(state: State, by: int) -> str:
    """Address of the entry a number of places later in the queue."""
    signals = state.signals
    entries = queue(state.library, state.listening, signals[MEDIA.SOURCE], signals[MEDIA.SHUFFLE])
    uris = [entry.uri for entry in entries]
    now = uris.index(signals[MEDIA.PLAYED]) if signals[MEDIA.PLAYED] in uris else -by
    return uris[(now + by) % len(uris)]


def play_on(state: State, dt_s: float) -> None:
    """The music continues; at the end of an entry, the next one plays, or the same again."""
    signals = state.signals
    entry = state.library.by_uri[signals[MEDIA.PLAYED]]
    if signals[MEDIA.ACTION] != "PLAY" or entry.length_s is None:
        return
    state.played_s += dt_s
    if state.played_s >= entry.length_s:
        late_s = state.played_s - entry.length_s
        uri = entry.uri if signals[MEDIA.REPEAT] else skipped(state, 1)
        start(state, state.library.by_uri[uri])
        state.played_s = late_s
