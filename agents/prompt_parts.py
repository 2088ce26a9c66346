"""The parts of the prompt, in which each fact is told once.

    switch: 32 "Seat heat: Off" - "Driver: Seat heat", 41 "Sync" [on]

Elements of one kind that follow each other share a line; what only shows something has no index, and none has an
id: no action takes one. Of the rules of the place, those that can matter to what was said keep their line. After an
action, what changed on the screen stands for the second list.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import groupby

from automotive_cosim.agents.lines import one_line
from automotive_cosim.agents.marks import listed
from automotive_cosim.cockpit.actions import FIELDS, signatures
from automotive_cosim.cockpit.restrictions import in_words
from automotive_cosim.contracts import ActionType, Element, VehicleState

KINDS: Mapping[str, str] = {
    "TextView": "text",
    "ImageView": "image",
    "RadioButton": "option",
    "SeekBar": "slider",
    "EditText": "field",
}
"""Kinds of elements whose class has a shorter name; others have it in small letters."""
SHOWS = frozenset({"text", "image"})
"""Kinds that only show something, unless they can be touched."""
MOST_GONE = 12
"""Elements gone up to which each is named; with more of them, the screen is another one."""
CITED = re.compile(r" \((?:[^()]|\([^()]*\))*, (verified|secondary|knowledge|uncertain)(?: [\d-]+)?\)$")
"""The source of a rule at the end of its line, with its status."""
FURTHER = "Further rules, by query: "
ONLY_IF_ASKED: Mapping[str, str] = {
    "Phone in hand": r"phone|call|ring|text|message",
    "Screens": r"screen|video|film|watch|display",
    "Speed camera warners": r"camera|radar|speed trap|flash",
    "Turning on red": r"red|turn|junction|lights",
    "Bus lanes": r"bus|lane",
    "Through traffic": r"through|closed|street|short ?cut",
    "Low-emission zone": r"emission|zone|city|town|route",
    "Tolls": r"toll|pay|motorway",
    "Winter equipment": r"snow|ice|winter|tyre|chain|pass",
    "Studded tyres": r"stud|tyre|winter|snow",
    "Engine at a standstill": r"engine|idl|stand|queue|jam",
    "Blood alcohol limit": r"alcohol|drink|drunk|beer|wine",
    "Custom when hot": r"hot|heat|sun|warm|sweat|melt|roast",
    "Custom when cold": r"cold|frost|freez|ice|winter|chill",
    "Usual in": r"usual|weather|season|climate|month|year|forecast",
}
"""By the beginning of a line, the words of a wish to which it can matter. Lines with another beginning are told."""


def entries(elements: Sequence[Element]) -> Iterator[tuple[str, str]]:
    """Each visible element's kind, and what it reads: index, label, meaning and state."""
    for index, element in listed(tuple(elements)):
        kind = KINDS.get(element.class_name, element.class_name.casefold())
        yield kind, _entry(element, None if kind in SHOWS and not _can_act(element) else index)


def indices(elements: Sequence[Element]) -> list[int]:
    """Those of the visible elements that can be acted on."""
    return [index for index, element in listed(tuple(elements)) if _can_act(element)]


def _can_act(element: Element) -> bool:
    return element.is_clickable or element.is_editable or element.is_scrollable


def told(elements: Sequence[Element]) -> str:
    """The visible elements, those of one kind that follow each other on one line."""
    runs = groupby(entries(elements), key=lambda entry: entry[0])
    return "\n".join(f"{kind}: {', '.join(text for _, text in run)}" for kind, run in runs)


def changes(before: Sequence[Element], after: Sequence[Element]) -> str:
    """What an action changed on the screen: what is gone, and what is new."""
    was, now = (Counter(_entry(each, None) for _, each in listed(tuple(side))) for side in (before, after))
    gone, new = list((was - now).elements()), list((now - was).elements())
    if not gone and not new:
        return "nothing"
    if len(gone) > MOST_GONE:
        return f"another screen is shown: {', '.join(new) or 'nothing on it'}"
    return f"gone: {', '.join(gone) or 'nothing'}\nnew: {', '.join(new) or 'nothing'}"


def actions(kinds: Collection[ActionType], *, by_point: bool, by_name: bool = False) -> str:
    """The actions as names with their fields, and how a target is given."""
    point = "x and y are pixels" if by_point else "x and y, in pixels, may stand in place of index"
    names = signatures(kinds, by_point=by_point, is_told=not by_name)
    targets = f"; {point}" if any(FIELDS[kind].target for kind in kinds) else ""
    return f"{names}\nFields in brackets may be left out{targets}. A switch is off unless it is marked [on]."


def context(text: str, words: str) -> str:
    """The lines of the geo-context, without the sources of rules that were verified; topics that cannot matter to
    the driver's words are only named."""
    kept: list[str] = []
    further: list[str] = []
    for line in map(one_line, text.split("\n")):
        begins = next((begin for begin in ONLY_IF_ASKED if line.startswith(begin)), None)
        if line.startswith(FURTHER):
            further.append(line.removeprefix(FURTHER))
        elif begins is None or re.search(ONLY_IF_ASKED[begins], words, re.IGNORECASE):
            kept.append(CITED.sub(_doubt, line))
        elif begins != "Usual in":
            further.append(begins.casefold())
    return "\n".join([*kept, *([FURTHER + ", ".join(further)] if further else [])])


def vehicle(state: VehicleState) -> str:
    """The car's readings, without the lamps that are off."""
    shown = {name: value for name, value in asdict(state).items() if value is not None and value is not False}
    shown["restrictions"] = in_words(state.restrictions)
    noticed = shown.pop("noticed", "")
    lines = [f"{name}: {round(value, 1) if isinstance(value, float) else value}" for name, value in shown.items()]
    return "\n".join([*lines, *noticed.splitlines()])


def _entry(element: Element, index: int | None) -> str:
    label, meaning = one_line(element.text), one_line(element.content_description)
    words = [_quoted(label or meaning or element.class_name)]
    if label and meaning:
        words += ["-", _quoted(meaning)]
    state = ", ".join(_state(element))
    return " ".join([*([] if index is None else [str(index)]), *words, *([f"[{state}]"] if state else [])])


def _state(element: Element) -> Iterator[str]:
    if element.is_selected:
        yield "chosen"
    elif element.is_checked:
        yield "on"
    if not element.is_enabled:
        yield "disabled"
    if element.is_scrollable and element.class_name != "SeekBar":
        yield "scrolls"
    if element.is_long_clickable:
        yield "hold"
    if element.class_name == "SeekBar":
        box = element.bbox_pixels
        yield f"x {box.x_min} to {box.x_max}, y {(box.y_min + box.y_max) // 2}"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _doubt(cited: re.Match[str]) -> str:
    return "" if cited[1] == "verified" else f" ({cited[1]})"
