"""The effect of messages on the state, from a finger or a safety call."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit import errands
from automotive_cosim.cockpit.map import ZOOMS_M_PER_PX
from automotive_cosim.cockpit.mapscene import panned
from automotive_cosim.cockpit.media import source_of
from automotive_cosim.cockpit.messages import (
    BACKSPACE,
    Ask,
    AskDriver,
    AskPullOver,
    AskSlowDown,
    Back,
    CallEmergency,
    Drive,
    Enter,
    Focus,
    Follow,
    Guide,
    Key,
    Message,
    Pan,
    Pick,
    Play,
    Put,
    Set,
    SetAll,
    Show,
    Skip,
    Take,
    WarnDriver,
    Zoom,
)
from automotive_cosim.cockpit.restrictions import STRING_LIMIT
from automotive_cosim.cockpit.screens.safety import KINDS
from automotive_cosim.cockpit.signals import ADAS, LIGHTS, MEDIA, Signal
from automotive_cosim.cockpit.state import AlertDraft, AlertRecord, QuestionRecord, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    Answer,
    Cruise,
    Feedback,
    FeedbackCode,
    Hazards,
    PullOver,
    Reroute,
    RoadRequest,
    Severity,
    SlowDown,
)
from automotive_cosim.contracts.text import say

ADVICE: dict[AlertKind, str] = {
    AlertKind.SPEED: say("Slow down"),
    AlertKind.DISTANCE: say("Keep more distance"),
    AlertKind.COLLISION: say("Danger of collision: brake"),
    AlertKind.LANE: say("Stay in your lane"),
    AlertKind.FATIGUE: say("Time for a break"),
    AlertKind.DISTRACTION: say("Eyes on the road"),
    AlertKind.SEAT_BELT: say("Fasten seat belts"),
    AlertKind.VISIBILITY: say("Poor visibility"),
    AlertKind.SLIPPERY: say("Slippery road"),
    AlertKind.WEATHER: say("Dangerous weather"),
    AlertKind.TRAFFIC: say("Traffic ahead"),
    AlertKind.CORRIDOR: say("Form a rescue lane"),
    AlertKind.YIELD: say("Give way to an emergency vehicle"),
    AlertKind.MOVE_OVER: say("Move over: stopped vehicle ahead"),
    AlertKind.SCHOOL: say("School zone"),
    AlertKind.TUNNEL: say("Tunnel ahead"),
    AlertKind.VEHICLE: say("Check the vehicle"),
}
"""Texts of alerts without a text of their own."""


FOLDED = say("The keyboard is hidden")


def perform(state: State, message: Message) -> Feedback:
    """Performs a widget's message."""
    match message:
        case Show(screen, item):
            return show(state, screen, item)
        case Back():
            return back(state)
        case Set(signal, value):
            return command(state, signal, value)
        case SetAll(values, said):
            return command_all(state, values, said)
        case Put(book, value, said):
            return _change(state, book, value, said)
        case Pick(key, value):
            state.keyboard = False
            if key.endswith(".list") and value != state.picked.get(key):
                _rewind(state, key.removesuffix("list"))
            if key == "media.show" and value != state.picked.get(key):
                _rewind(state, "media.entries")
            return _change(state, "picked", {**state.picked, key: value}, say("It is shown"))
        case WarnDriver(alert):
            return _warn(state) if alert is None else give_alert(state, alert)
        case AskSlowDown():
            return _slow_down(state)
        case AskPullOver():
            return ask_road(state, PullOver())
        case Ask(request):
            return ask_road(state, request)
        case CallEmergency():
            return call_emergency(state)
        case AskDriver(text):
            return ask_driver(state, text)
        case Guide(place, onward):
            return guide(state, place, onward)
        case Take(edges):
            return ask_road(state, Reroute(edges=edges))
        case Focus(field):
            return _focus(state, field)
        case Enter(then):
            _focus(state, "")
            done = perform(state, then)
            return done if done.code is not FeedbackCode.NO_EFFECT else Feedback(FeedbackCode.OK, FOLDED)
        case Key(field, letters):
            return _key(state, field, letters)
        case Zoom(by):
            return _change(
                state, "zoom", min(len(ZOOMS_M_PER_PX) - 1, max(0, state.zoom + by)), say("The map is zoomed")
            )
        case Pan(right, down):
            return _change(state, "panned", panned(state, right, down), say("The map is moved"))
        case Follow(north_up):
            if state.panned is not None:
                return _change(state, "panned", None, say("The map follows the car"))
            return _change(
                state, "north_up", north_up, say("North is up") if north_up else say("The map turns with the car")
            )
        case Drive(profile):
            return _drive(state, profile)
        case Play(uri, playlist):
            return _play(state, uri, playlist)
        case Skip(by):
            return _play(state, errands.skipped(state, by), state.listening.playlist)
        case _:
            return errands.run(state, message)


def show(state: State, screen: str, item: str = "") -> Feedback:
    """Goes to a screen; the previous one can be returned to."""
    if screen == state.screen and item in ("", state.picked.get(screen)):
        return Feedback(FeedbackCode.NO_EFFECT, say("{screen} is already shown", screen=screen))
    state.past = (*state.past[-8:], (state.screen, state.picked.get(state.screen, "")))
    if item and item != state.picked.get(screen):
        state.picked = {**state.picked, screen: item}
        _rewind(state, f"{screen}.")
    _enter(state, screen)
    return Feedback(FeedbackCode.OK, say("{screen} is shown", screen=item or screen))


def back(state: State) -> Feedback:
    """Returns to the previous screen; with text in a field, first to the screen without it."""
    if state.focus or state.typed:
        state.focus, state.typed = "", {}
        return Feedback(FeedbackCode.OK, say("the search is closed"))
    if not state.past:
        return Feedback(FeedbackCode.NO_EFFECT, say("there is no screen to go back to"))
    *past, (last, item) = state.past
    state.past = tuple(past)
    state.picked = {**state.picked, last: item} if item else state.picked
    _enter(state, last)
    return Feedback(FeedbackCode.OK, say("{screen} is shown", screen=last))


def write(state: State, field: str, text: str) -> None:
    """Puts text into a field; lists return to their start."""
    printable = "".join(letter for letter in text if letter.isprintable())
    state.typed = {**state.typed, field: printable[:STRING_LIMIT]}
    state.scrolled = {}


def command(state: State, signal: Signal[Any], value: Any) -> Feedback:
    """Sets an actuator and what is coupled to it, and makes the related requests to the road."""
    before = state.signals.snapshot()
    refusal = state.vehicle.command(signal, value)
    if refusal:
        state.notify(refusal, Icon.INFO)
        return Feedback(FeedbackCode.REFUSED, refusal)
    settle(state)
    if before == state.signals.snapshot():
        return Feedback(
            FeedbackCode.NO_EFFECT, say("{signal} is already {value}", signal=_short(signal), value=_said(value))
        )
    if signal is MEDIA.SOURCE:
        _rewind(state, "media.")
    _tell_road(state, before)
    return Feedback(FeedbackCode.OK, say("{signal} is {value}", signal=_short(signal), value=_said(value)))


def command_all(state: State, values: tuple[tuple[Signal[Any], Any], ...], said: str) -> Feedback:
    """Sets several actuators; if the car refuses one of them, none."""
    before, vehicle = state.signals.snapshot(), state.vehicle.copy()
    for signal, value in values:
        refusal = vehicle.command(signal, value)
        if refusal:
            state.notify(refusal, Icon.INFO)
            return Feedback(FeedbackCode.REFUSED, refusal)
    state.vehicle = vehicle
    settle(state)
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


def give_alert(state: State, alert: Alert) -> Feedback:
    """Alerts the driver, on screen and by voice, and passes the alert to the road."""
    name, icon = KINDS[alert.kind]
    if alert.speed_kmh is not None and not 0 < alert.speed_kmh <= 400:
        return Feedback(
            FeedbackCode.REFUSED, say("{speed} km/h is not a valid speed to advise", speed=f"{alert.speed_kmh:g}")
        )
    text = " ".join(alert.text.split())[:STRING_LIMIT] or ADVICE[alert.kind]
    if alert.speed_kmh is not None and not alert.text:
        kmh = f"{alert.speed_kmh:.0f}"
        text = (
            say("Slow down to {speed} km/h", speed=kmh)
            if alert.kind is AlertKind.SPEED
            else say("{name}: {value}", name=text, value=f"{kmh} km/h")
        )
    state.alerts += (AlertRecord(state.clock, alert),)
    state.pending += (alert,)
    state.notify(text, icon, alert.severity)
    return Feedback(FeedbackCode.OK, say("{kind} alert given to the driver: {text}", kind=name, text=text))


def ask_road(state: State, request: RoadRequest) -> Feedback:
    """Makes an irrevocable request to the driver or the router."""
    if isinstance(request, Alert):
        return give_alert(state, request)
    if isinstance(request, SlowDown) and not 0 <= request.speed_kmh <= 400:
        return Feedback(
            FeedbackCode.REFUSED,
            say("{speed} km/h is not a valid speed to slow down to", speed=f"{request.speed_kmh:g}"),
        )
    words, icon = _asked(state, request)
    state.asked += (request,)
    state.pending += (request,)
    state.notify(words, icon)
    return Feedback(FeedbackCode.OK, words)


def guide(state: State, place: str, onward: str = "") -> Feedback:
    """Requests a route to a place or street; empty looks for a faster one."""
    known = state.atlas.find(place)
    feedback = ask_road(state, Reroute(known.edge_id if known else place))
    if place and onward and onward != place:
        state.navigation = replace(state.navigation, onward=onward)
    return feedback


def answered(state: State, request: RoadRequest, answer: Answer) -> None:
    """Shows the road's reply."""
    if isinstance(request, Alert) and state.alerts:
        *rest, last = state.alerts
        state.alerts = (*rest, AlertRecord(last.clock, last.alert, answer.reason))
    if isinstance(request, Cruise) and not answer.accepted:
        state.signals[ADAS.CRUISE_ACTIVE] = False
        state.signals[ADAS.LIMITER_ACTIVE] = False
    if isinstance(request, Reroute) and answer.accepted and request.destination:
        state.navigation = state.navigation.to(_place_name(state, request.destination))
    if not answer.accepted:
        state.notify(answer.reason, Icon.WARNING, Severity.WARNING)
    elif not isinstance(request, Alert | Hazards) and answer.reason:
        goal = _goal(state, request)
        state.notify(
            say("{name}: {value}", name=goal, value=answer.reason) if goal else answer.reason,
            _asked(state, request)[1],
        )


def _goal(state: State, request: RoadRequest) -> str:
    """The place that a new route leads to, and the one after it; empty if it is no place but a street."""
    place = state.atlas.at(request.destination) if isinstance(request, Reroute) else None
    if place is None:
        return ""
    return (
        say("{place}, then {onward}", place=place.name, onward=state.navigation.onward)
        if state.navigation.onward
        else place.name
    )


def _place_name(state: State, destination: str) -> str:
    place = state.atlas.at(destination)
    return destination if place is None else place.name


def call_emergency(state: State) -> Feedback:
    """Calls the emergency services with the car's position."""
    state.calls += ("emergency",)
    state.notify(say("Emergency call made"), Icon.PHONE_ALERT, Severity.CRITICAL)
    return Feedback(FeedbackCode.OK, say("the emergency services are called"))


def _enter(state: State, screen: str) -> None:
    """Shows a screen without what was typed on it, unless it was left because of a call."""
    if state.typed and (state.phone.ringing or state.phone.on_call):
        state.aside = {**state.aside, state.screen: state.typed}
    state.screen = screen
    state.panned = None
    state.focus, state.typed = "", state.aside.get(screen, {})
    state.aside = {name: typed for name, typed in state.aside.items() if name != screen}


def _change(state: State, name: str, value: Any, words: str) -> Feedback:
    if getattr(state, name) == value:
        return Feedback(FeedbackCode.NO_EFFECT, say("it is already set that way"))
    setattr(state, name, value)
    return Feedback(FeedbackCode.OK, words)


def _warn(state: State) -> Feedback:
    draft = state.draft
    if draft.kind is None:
        return Feedback(FeedbackCode.DISABLED, say("choose what to warn about first"))
    state.draft = AlertDraft()
    return give_alert(state, Alert(draft.kind, draft.severity, "", draft.speed_kmh))


def _slow_down(state: State) -> Feedback:
    wanted = state.draft.speed_kmh or state.signals[ADAS.LIMIT_SIGN]
    if wanted is None:
        why = say("No limit sign is known: set an advised speed first")
        state.notify(why, Icon.INFO)
        return Feedback(FeedbackCode.REFUSED, why)
    return ask_road(state, SlowDown(wanted))


def _drive(state: State, name: str) -> Feedback:
    profile = next(profile for profile in state.desk.profiles if profile.name == name)
    feedback = command_all(state, profile.values, say("{name} is now the driver", name=name))
    if feedback.code is FeedbackCode.REFUSED:
        return feedback
    state.desk = replace(state.desk, profile=name)
    return Feedback(FeedbackCode.OK, say("{name} is now the driver", name=name))


def _rewind(state: State, lists: str) -> None:
    """Resets the lists whose key has this prefix to their start, since their content changed."""
    state.scrolled = {key: first for key, first in state.scrolled.items() if not key.startswith(lists)}


def _focus(state: State, field: str) -> Feedback:
    if state.is_typing and state.focus == field:
        return Feedback(FeedbackCode.NO_EFFECT, say("it is already set that way"))
    state.focus, state.keyboard = field, bool(field)
    return Feedback(FeedbackCode.OK, say("The field takes text") if field else FOLDED)


def _key(state: State, field: str, letters: str) -> Feedback:
    text = state.typed.get(field, "")
    longer = text[:-1] if letters == BACKSPACE else text + letters
    if longer == text:
        return Feedback(FeedbackCode.NO_EFFECT, say("there is nothing to delete"))
    write(state, field, longer)
    return Feedback(FeedbackCode.OK, say("the field reads {text}", text=repr(state.typed[field])))


def _play(state: State, uri: str, playlist: str) -> Feedback:
    """Plays an entry from its beginning, with its source, at the present volume."""
    entry = state.library.by_uri[uri]
    values: tuple[tuple[Signal[Any], Any], ...] = (
        (MEDIA.SOURCE, source_of(uri)),
        (MEDIA.SELECTED, uri),
        (MEDIA.ACTION, "PLAY"),
    )
    feedback = command_all(state, values, "")
    if feedback.code is FeedbackCode.REFUSED:
        return feedback
    state.listening = replace(state.listening, playlist=playlist)
    errands.start(state, entry)
    return Feedback(FeedbackCode.OK, say("{title} plays", title=entry.title))


def settle(state: State) -> None:
    """Another source starts with its first entry; another entry starts at its beginning."""
    signals = state.signals
    entry = state.library.find(signals[MEDIA.SOURCE], signals[MEDIA.SELECTED])
    signals[MEDIA.SELECTED] = entry.uri
    if source_of(signals[MEDIA.PLAYED]) != signals[MEDIA.SOURCE] or not signals[MEDIA.PLAYED]:
        state.listening = replace(state.listening, playlist="")
        errands.start(state, entry)


LOOKING = frozenset({"questions", "messages.read"})
"""Commands that change nothing: to ask, and to have a message read out."""


def ask_driver(state: State, text: str) -> Feedback:
    """Notes a question to the driver, and how many commands that change something came before it."""
    if not text.strip():
        return Feedback(FeedbackCode.REFUSED, say("The question has no words"))
    before = sum(bool(deed.aims - LOOKING) for deed in state.deeds)
    state.questions += (QuestionRecord(text, before),)
    return Feedback(FeedbackCode.OK, "")


def _asked(state: State, request: RoadRequest) -> tuple[str, Icon]:
    match request:
        case SlowDown(speed_kmh):
            return say("Asked to slow down to {speed} km/h", speed=f"{speed_kmh:.0f}"), Icon.SLOWER
        case PullOver():
            return say("Asked to pull over"), Icon.PULL_OVER
        case Reroute(destination):
            name = _place_name(state, destination)
            return (
                say("Looking for a route to {place}", place=name) if name else say("Looking for a faster route")
            ), Icon.ROUTE
        case Cruise(speed_kmh):
            return (
                say("Cruise control off")
                if speed_kmh is None
                else say("Cruise control at {speed} km/h", speed=f"{speed_kmh:.0f}"),
                Icon.CRUISE,
            )
        case Hazards(on):
            return say("Hazard lights on") if on else say("Hazard lights off"), Icon.HAZARD
        case Alert(kind):
            return ADVICE[kind], KINDS[kind][1]


def _short(signal: Signal[Any]) -> str:
    return signal.path.removeprefix("Vehicle.")


def _said(value: Any) -> str:
    if isinstance(value, bool):
        return say("on") if value else say("off")
    return f"{value:g}" if isinstance(value, float) else str(value)
