"""Observations as text: what an agent's model reads.

A prompt is a Markdown file with ``$slots``. A section (``## ...``) with a slot that has no value is omitted,
including its heading: what an agent is not given does not occur. Any text from outside is put on one line, so no
name of a street or a contact can begin a section of its own.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from string import Template

from automotive_cosim.agents import prompt_parts
from automotive_cosim.agents.lines import one_line
from automotive_cosim.agents.settings import AgentProfile
from automotive_cosim.cockpit.actions import FIELDS, to_json
from automotive_cosim.contracts import Action, ActionType, Element, GpsFix, Json, Observation, VehicleState
from automotive_cosim.contracts.given import Interface, PromptLength
from automotive_cosim.interface.functions import signature
from automotive_cosim.interface.observe import Channel

SHOWN_FLAGS = ("is_checked", "is_selected", "is_editable", "is_scrollable", "is_long_clickable")
SLIDERS = ("SeekBar",)
"""Elements whose bounds are listed, because it matters where they are touched."""
HOLDERS = frozenset({*SLIDERS, "EditText"})
"""Elements whose text is what they are set to; their description names them."""


def fill(name: str, slots: Mapping[str, str | None]) -> str:
    """The prompt file of that name with its slots filled.

    Args:
        name: of the file, without its suffix.
        slots: the value of each slot; None omits its section."""
    text = files("automotive_cosim.agents").joinpath("prompts", f"{name}.md").read_text("utf-8")
    sections = re.split(r"^(?=## )", text, flags=re.MULTILINE)
    kept = [section for section in sections if all(slots[slot] is not None for slot in _slots(section))]
    return Template("".join(kept)).substitute({slot: value or "" for slot, value in slots.items()})


def turn(
    profile: AgentProfile,
    observation: Observation,
    history: Sequence[str] = (),
    plan: str = "",
    recalled: Sequence[str] = (),
    pictures: bool = False,
) -> str:
    """The prompt of one turn of an agent.

    Args:
        history: one line per step so far.
        plan: what it intended to do next when it last acted.
        recalled: what it remembers of earlier episodes, one line each.
        pictures: whether the screen is sent along, and the marked screen if there is a list."""
    given = profile.channels
    stays, now = _vehicle(observation.vehicle)
    is_listed, is_told = Channel.ELEMENTS in given, Channel.CONTEXT in given
    return fill(
        _file(profile, observation),
        {
            "instructions": profile.instructions,
            "hands": _HANDS[profile.interface],
            "grammar": _grammar(profile, by_point=not is_listed, on_watch=observation.on_watch),
            "policy": observation.policy,
            "thresholds": "" if profile.order.tells_thresholds else None,
            "goal": driver_words(observation),
            "history": "\n".join(map(one_line, history)) or None,
            "plan": one_line(plan) or None,
            "feedback": _timed_result(observation),
            "elements": prompt_parts.told(observation.elements or ()) if is_listed else None,
            "pictures": _pictured(PICTURES if is_listed else PICTURE, observation) if pictures else None,
            "seen": "the screen, its elements" if is_listed else "the screen",
            "vehicle": stays if Channel.VEHICLE in given else None,
            "now": now if Channel.VEHICLE in given else None,
            "connectivity": _connectivity(observation) if Channel.CONNECTIVITY in given else None,
            "gps": _gps(observation.gps) if Channel.GPS in given else None,
            "context": _context(profile, observation) if is_told else None,
            "weigh": PLACE_COUNTS if is_told else "",
            "memory": "\n".join(map(one_line, recalled)) or None,
        },
    )


def _file(profile: AgentProfile, observation: Observation) -> str:
    if profile.instructions:
        return OWN
    if observation.on_watch:
        return DRIVE
    return profile.length


def situation(
    profile: AgentProfile,
    observation: Observation,
    *,
    pictures: bool,
    is_spoken: bool = True,
    is_resulting: bool = True,
) -> str:
    """The situation alone, for an agent whose protocol carries the rest: the functions and what was called.

    Args:
        is_spoken: whether it has what the driver said.
        is_resulting: whether it has the last result; without it, the time that has passed alone."""
    given = profile.channels
    stays, now = _vehicle(observation.vehicle)
    is_listed = Channel.ELEMENTS in given
    return fill(
        "caller_now",
        {
            "goal": driver_words(observation) if is_spoken else None,
            "feedback": _timed_result(observation) if is_resulting else None,
            "passed": None if is_resulting else passed(observation),
            "elements": prompt_parts.told(observation.elements or ()) if is_listed else None,
            "pictures": _pictured(PICTURE, observation) if pictures else None,
            "vehicle": stays if Channel.VEHICLE in given else None,
            "now": now if Channel.VEHICLE in given else None,
            "connectivity": _connectivity(observation) if Channel.CONNECTIVITY in given else None,
            "gps": _gps(observation.gps) if Channel.GPS in given else None,
            "context": _context(profile, observation) if Channel.CONTEXT in given else None,
        },
    )


TOLD_ELSEWHERE = {Channel.GPS: "Position: ", Channel.VEHICLE: "Speed: "}
"""Lines of the geo-context that a section of a channel repeats."""
PLACE_COUNTS = (
    "Weigh the place against what the car is doing: the same act can be right in one place and wrong in another."
)
DRIVE = "drive"
"""The prompt of a drive, the same for every agent."""
OWN = "own"
"""The prompt with instructions from a file, of tasks and of drives."""
UNASKED = frozenset({ActionType.STATUS})
"""Actions that a watch has no use for."""
ON_DRIVES = {
    ActionType.WAIT: "wait until something changes, or for up to 60 seconds",
    ActionType.SHOW_ALERT: "warn the driver on screen and by voice",
}
"""What actions do that are described otherwise in a task."""
PICTURES = (
    "Two pictures come with this text: the screen as it is, and the same with each element framed and numbered. "
    "The numbers are the indices below."
)
PICTURE = "One picture comes with this: the screen as it is now, as wide and high in pixels as x and y count."
ROAD = "The last picture is the road: the view through the windshield, or behind the car in reverse."


def _pictured(words: str, seen: Observation) -> str:
    return words if seen.camera is None else f"{words} {ROAD}"


_HANDS: Mapping[Interface, str] = {
    Interface.TOUCH: "touch screen and safety functions",
    Interface.FUNCTIONS: "functions",
    Interface.BOTH: "touch screen and functions",
}
"""What an agent operates."""
FUNCTIONS = (
    'Functions for the action `call`: {"action_type": "call", "function": <name>, "arguments": {<key>: <value>}}'
)
"""Without an example, which small models call whatever the driver wants."""
BEFORE_AND_AFTER = {
    (True, True): "Two pictures come with this text: the screen before the action and after it.",
    (True, False): "A picture comes with this text: the screen before the action.",
    (False, True): "A picture comes with this text: the screen after the action.",
}
"""What is said about the pictures, by whether there is one of before and of after."""


def _grammar(profile: AgentProfile, *, by_point: bool, on_watch: bool) -> str:
    """The actions, and the functions that can be called; in a watch, a wait ends when something changes and nothing
    ends the watch."""
    kinds = profile.actions - (UNASKED if on_watch else frozenset())
    text = prompt_parts.actions(kinds, by_point=by_point, by_name=profile.length is PromptLength.SHORT)
    for action, about in ON_DRIVES.items() if on_watch else ():
        text = text.replace(FIELDS[action].about, about)
    if profile.functions:
        is_told = profile.length is not PromptLength.SHORT
        text = "\n".join([text, "", FUNCTIONS, *(signature(each, is_told=is_told) for each in profile.functions)])
    return text


def look_back(
    before: Observation,
    action: Action | None,
    after: Observation,
    plan: str = "",
    pictures: tuple[bool, bool] = (False, False),
) -> str:
    """The prompt that asks about the result of an action, or of an answer that could not be read.

    Args:
        before: what was seen when it was chosen.
        action: the action; None for an answer that could not be read.
        after: what is seen now.
        pictures: whether a picture of before and one of after come with it."""
    lists = (before.elements, after.elements)
    slots = {
        "goal": driver_words(after),
        "action": action_words(action, before),
        "plan": one_line(plan) or None,
        "feedback": _timed_result(after),
        "pictures": BEFORE_AND_AFTER.get(pictures),
        "changes": None if lists[0] is None or lists[1] is None else prompt_parts.changes(lists[0], lists[1]),
    }
    return fill("lesson", slots)


def step(number: int, action: Action | None, seen: Observation, after: Observation, lesson: str = "") -> str:
    """One line of history: the action, when it was chosen, its result, and the lesson.

    Args:
        action: the action; None for an answer that could not be read.
        lesson: what the agent learnt from it."""
    learnt = f"; {one_line(lesson)}" if lesson else ""
    came = f"{after.feedback.code} {one_line(after.feedback.text)}".rstrip()
    return f"Step {number} at {seen.time_s:.0f} s: {action_words(action, seen)} -> {came}{learnt}"


def driver_words(observation: Observation) -> str:
    """The wish, and on a line each what the driver has said since."""
    return "\n".join([one_line(observation.goal), *(f"Since then: {one_line(text)}" for text in observation.said)])


def _slots(section: str) -> set[str]:
    return set(re.findall(r"\$([a-z]+)", section))


def result(observation: Observation) -> str:
    """The last action's result, as it came: a function's can be JSON."""
    return f"{observation.feedback.code}: {observation.feedback.text}".rstrip(": ")


def _timed_result(observation: Observation) -> str:
    """The same on one line, with the time since the hand-over, which no screen shows to the second."""
    return f"{one_line(result(observation))} ({passed(observation)})"


def passed(observation: Observation) -> str:
    """The time since the hand-over in words."""
    return f"{observation.time_s:.0f} s have passed"


def _context(profile: AgentProfile, observation: Observation) -> str:
    """The geo-context; short only for who can ask for the rest, and not in a watch, where anything can matter."""
    text = observation.context or "unknown"
    if ActionType.QUERY in profile.actions and not observation.on_watch:
        told = [line for channel, line in TOLD_ELSEWHERE.items() if channel in profile.channels]
        return prompt_parts.context(text, driver_words(observation), told)
    return _lines(text)


def _lines(text: str) -> str:
    """Lines, none of which begins a section."""
    return "\n".join(one_line(line) for line in text.split("\n"))


def listing(index: int, element: Element) -> Json:
    """An element as a list shows it: a JSON object without what is empty or false."""
    entry: Json = {"index": index, "kind": element.class_name}
    if element.text:
        entry["text"] = one_line(element.text)
    if element.content_description:
        entry["description"] = one_line(element.content_description)
    if element.resource_id:
        entry["id"] = one_line(element.resource_id)
    if element.class_name in SLIDERS:
        box = element.bbox_pixels
        entry["bounds"] = [box.x_min, box.y_min, box.x_max, box.y_max]
    if element.is_clickable:
        entry["clickable"] = True
    if not element.is_enabled:
        entry["disabled"] = True
    return entry | {flag.removeprefix("is_"): True for flag in SHOWN_FLAGS if getattr(element, flag)}


def _vehicle(vehicle: VehicleState | None) -> tuple[str, str]:
    return ("unknown", "unknown") if vehicle is None else prompt_parts.vehicle(vehicle)


def _connectivity(observation: Observation) -> str:
    link = observation.connectivity
    if link is None:
        return "unknown"
    return f"{link.kind} in reach" if link.online else "no network in reach"


def _gps(fix: GpsFix | None) -> str:
    if fix is None:
        return "no receiver"
    where = f"{fix.lat_deg:.5f}, {fix.lon_deg:.5f}"
    heading = f"heading {fix.heading_deg:.0f} degrees"
    if fix.has_fix:
        return f"{where} (accurate to {fix.accuracy_m:.0f} m), {heading}"
    return f"{where} (no fix for {fix.age_s:.0f} s), {heading}. GPS is out; `estimate_position` is for that."


def target(action: Action | None, seen: Observation) -> str:
    """The element that an action refers to, by what it says; empty if it refers to none."""
    elements = seen.elements or ()
    if action is None or action.index is None or not 0 <= action.index < len(elements):
        return ""
    element = elements[action.index]
    texts = element.text, element.content_description
    return next(filter(None, reversed(texts) if element.class_name in HOLDERS else texts), element.resource_id)


def action_words(action: Action | None, seen: Observation) -> str:
    """An action on one line, with the words of its element instead of the index."""
    if action is None:
        return "unreadable answer"
    fields = to_json(action)
    kind, on = fields.pop("action_type"), target(action, seen)
    if on:
        fields["index"] = on
    return " ".join([str(kind), *(f"{name}={one_line(str(value))}" for name, value in fields.items())])
