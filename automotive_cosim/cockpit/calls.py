"""Calls: every function of the car by its name, what a call does, and the readings that no app has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import Annotated, Any

from automotive_cosim.cockpit import accessibility
from automotive_cosim.cockpit.app import App, Where
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.equipment import equipped
from automotive_cosim.cockpit.functions import CarFunction, as_told, groups, named, of_signals, reading, unknown
from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.make import HOME
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.registry import apps, pages
from automotive_cosim.cockpit.signals import CATALOGUE, HMI, MOTION
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.widgets import Rows, Screen
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say
from automotive_cosim.errors import ActionError, UnknownNameError

PLACE = frozenset(signal.path for signal in (MOTION.LATITUDE, MOTION.LONGITUDE, MOTION.HEADING))
"""Signals that no reading tells: what an agent may know of the place is part of its observation."""


@reading
def get_signals(
    state: State,
    path: Annotated[str, f"A VSS path, a branch such as Vehicle.Cabin.HVAC, or a group: {', '.join(groups())}."],
) -> Feedback:
    """Read the car's signals: sensors, switches and settings, by path, with their units as in VSS."""
    named = groups()
    wanted = path.strip().removesuffix(".*").rstrip(".")
    paths = named.get(wanted.lower()) or [
        each for each in CATALOGUE if each.casefold() == wanted.casefold() or each.startswith(f"{wanted}.")
    ]
    unread = {signal.path for each in state.vehicle.lacks if each.part is None for signal in each.signals}
    found = {
        each: None if each in unread else state.signals[CATALOGUE[each]] for each in paths if each not in PLACE
    }
    return as_told(found) if found else unknown("signal or group", path, (*named, *CATALOGUE))


@reading
def read_screen(
    state: State,
    screen: Annotated[str, "Name of the screen."],
    item: Annotated[str, "Part or item of it: a tab, a person, a place, an appointment; empty as it is."] = "",
) -> Feedback:
    """Read what a screen of the car shows, without opening it, line by line. What the screen hides while driving,
    this hides too."""
    app = _by_screen()[screen]
    if refusal := _not_installed(state, app):
        return refusal
    twin = state.copy()
    twin.make = HOME  # functions are the same in every make
    Show(screen).perform(twin)
    if item:
        ways = _ways(twin, screen)
        found = next((way for each in ways if (name := named(item, each)) and (way := each[name])), None)
        has_tabs = any(isinstance(way, Pick) for way in ways[1].values())
        if found is not None or not has_tabs:
            (found or Show(screen, item)).perform(twin)
        if (found is None and has_tabs) or _is_gone(twin):
            return unknown(f"item of {screen}", item, [name for each in ways for name in each])
    return as_told("\n".join(dict.fromkeys(_lines(twin))))


def _ways(state: State, screen: str) -> tuple[dict[str, Message], dict[str, Message]]:
    """What leads to a part or an item of a screen, by how it is listed, and by its own name: tabs, and rows of its
    app's screens."""
    texts, names = dict[str, Message](), dict[str, Message]()
    for page in _by_screen()[screen].pages:
        for widget in (widget for child in equipped(state, pages()[page].made(state)) for widget in child.walk()):
            match widget.on_tap:
                case Pick(_, name) as way if page == screen:
                    texts[widget.text], names[name] = way, way
                case Show(to, name) as way if to == screen and name:
                    texts[widget.text], names[name] = way, way
    return texts, names


def _is_gone(state: State) -> bool:
    return any(widget.key == f"{state.screen}.gone" for widget in pages()[state.screen].made(state))


def _lines(state: State) -> Iterator[str]:
    """What a screen shows from the beginning of its lists to their ends."""
    page, language = pages()[state.screen], state.signals[HMI.LANGUAGE]
    while True:
        made = equipped(state, page.made(state))
        whole = Screen(
            rect=state.size.whole,
            dock=state.frame.dock,
            night=False,
            children=tuple(translated(widget, language) for widget in made),
        )
        for element in accessibility.elements(whole):
            words = ". ".join(part for part in (element.text, element.content_description) if part)
            marks = " (on)" if element.is_checked or element.is_selected else ""
            if words:
                yield words.replace("\n", " ") + marks
        lists = [widget for child in made for widget in child.walk() if isinstance(widget, Rows)]
        more = {each.key: each.first + each.shown for each in lists if each.first < each.last_first}
        if not more:
            return
        state.scrolled = {**state.scrolled, **more}


@cache
def _readings() -> tuple[CarFunction, ...]:
    """Those that no app has; the screens are known once the apps are."""
    screen, item = read_screen.parameters
    named = replace(screen, schema={**screen.schema, "enum": list(pages())})
    return get_signals, replace(read_screen, parameters=(named, item))


@cache
def functions() -> Mapping[str, CarFunction]:
    """Every command and reading as a function, by its name: readings, then those of the actuators and of the apps.

    Raises ValueError: two functions have the same name."""
    every = (*_readings(), *of_signals(), *(function for app in apps().values() for function in app.functions))
    names = [function.name for function in every]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise ValueError(f"two functions of the car are named {', '.join(sorted(twice))}; name one of them anew")
    return {function.name: function for function in every}


@cache
def _owners() -> Mapping[str, App]:
    """The app that a function belongs to, by the function's name; those of the actuators belong to none."""
    return {function.name: app for app in apps().values() for function in app.functions}


@cache
def _by_screen() -> Mapping[str, App]:
    return {screen: app for app in apps().values() for screen in app.pages}


def function_named(name: str) -> CarFunction:
    """The function of that name. Raises ActionError: there is none."""
    if name not in functions():
        raise ActionError(str(UnknownNameError("function", name, functions(), "automotive-cosim show functions")))
    return functions()[name]


def call(state: State, name: str, arguments: Mapping[str, Any]) -> Feedback:
    """Does what a function says, as if its widget had been touched.

    Args:
        arguments: checked ones (``CarFunction.read``).

    Returns:
        What was set or read, or why not."""
    function = functions()[name]
    lacking = next((each for each in state.vehicle.lacks if name in each.functions), None)
    if lacking is not None:
        return Feedback(FeedbackCode.DISABLED, lacking.words)
    app = _owners().get(name)
    if app is not None and (refusal := _not_installed(state, app)):
        return refusal
    made = function.make(state, **arguments)
    if isinstance(made, Feedback):
        return made
    before = state.commands()
    done = state.perform(made)
    if done.code is not FeedbackCode.OK or done.text:
        return done
    after = state.commands()
    changed = (f"{key} is {value}" for key, value in after.items() if value != before.get(key))
    return Feedback(done.code, "; ".join(changed))


def _not_installed(state: State, app: App) -> Feedback | None:
    if app.where is not Where.STORE or app.name in state.of(Installed).apps:
        return None
    return Feedback(FeedbackCode.REFUSED, say("{app} is not installed; the store has it", app=app.name))
