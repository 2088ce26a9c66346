"""The parts of the prompt, in which each fact is told once.

    switch: 32 Seat heat: Off - Driver: Seat heat, 41 Sync [on]

Elements of one kind that follow each other share a line; what only shows something has no index and stands once,
and none has an id: no action takes one. A text is quoted where its own signs could be taken for the list's. Of the
rules of the place, those that can matter to what was said keep their line. After an action, what changed on the
screen stands for the second list. What changes by itself stands last, so that a model's cache holds the rest.
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
from automotive_cosim.cockpit.actions import FIELDS, TEXT_LIMIT, signatures
from automotive_cosim.cockpit.restrictions import in_words
from automotive_cosim.cockpit.theme import STATUS_HEIGHT
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
SHOWN = "shown"
"""What their elements are listed as: which of the two it is matters to nobody."""
PLAIN = re.compile(r"[^\s\",\[\]]|[^\s\",\[\]][^\",\[\]]*[^\s\",\[\]]")
"""A text that needs no quotes."""
CHANGING = (
    "speed_kmh", "cabin_temperature_c", "cabin_humidity_pct", "energy_level_pct", "range_km",
    "speed_limit_sign_kmh", "leader_gap_m", "leader_time_to_collision_s",
)  # fmt: skip
"""Readings of the car that change while nobody does anything."""
HERE = ("Road: ", "Speed limit here: ", "Posted for ", "Sign ahead: ", "Time: ", "Weather: ", "Blue light: ")
"""How lines of the geo-context begin that change on the way."""
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
    "Daytime lamps": r"lamp|light|beam",
    "Through traffic": r"through|closed|street|short ?cut",
    "Emergency vehicles": r"siren|blue light|ambulance|police|fire|emergency|room|way|behind|yield",
    "Emergency corridor": r"corridor|lane|jam|queue|siren|blue light|ambulance|room|way|side",
    "Passing a stopped vehicle": r"pass|stop|hazard|breakdown|broken|lane|roadside|shoulder",
    "Following distance": r"distance|gap|follow|close|behind|ahead|front of|bumper|tail|cruise|back",
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
    """Each visible element's kind, and what it reads: index, label, meaning and state. What only shows something
    that another one says is left out; what stands in the status bar, such as clock and speed, comes last."""
    there = listed(tuple(elements))
    meant = [(element.text, element.content_description) for _, element in there if element.content_description]
    known: set[str] = set()
    last: list[tuple[str, str]] = []
    for index, element in there:
        kind = KINDS.get(element.class_name, element.class_name.casefold())
        if kind not in SHOWS or _can_act(element):
            yield kind, _entry(element, index)
            continue
        words, alone = _entry(element, None), "" if element.content_description else element.text
        is_said = alone and any(alone == text or f" {told}".endswith(f" {alone}") for text, told in meant)
        if is_said or any(f": {told}".endswith(f": {words}") for told in known):
            continue
        known.add(words)
        if element.bbox_pixels.y_max <= STATUS_HEIGHT:
            last.append((SHOWN, words))
        else:
            yield SHOWN, words
    yield from last


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
    left_out = f"Fields in brackets may be left out{targets}; a text has up to {TEXT_LIMIT} characters."
    return f"{names}\n{left_out} A switch is off unless it is marked [on]."


def context(text: str, words: str, told: Collection[str] = ()) -> str:
    """The lines of the geo-context, without the sources of rules that were verified; topics that cannot matter to
    the driver's words are only named.

    Args:
        told: how lines begin that say what the prompt says elsewhere."""
    kept: list[str] = []
    here: list[str] = []
    further: list[str] = []
    for line in map(one_line, text.split("\n")):
        begins = next((begin for begin in ONLY_IF_ASKED if line.startswith(begin)), None)
        if line.startswith(FURTHER):
            further.append(line.removeprefix(FURTHER))
        elif line.startswith(tuple(told)):
            continue
        elif begins is None or re.search(ONLY_IF_ASKED[begins], words, re.IGNORECASE):
            (here if line.startswith(HERE) else kept).append(CITED.sub(_doubt, line))
        elif begins != "Usual in":
            further.append(begins.casefold())
    return "\n".join([*kept, *([FURTHER + ", ".join(further)] if further else []), *here])


def vehicle(state: VehicleState) -> tuple[str, str]:
    """The car's readings, without the lamps that are off: those that stay, and those that change by themselves."""
    shown = {name: value for name, value in asdict(state).items() if value is not None and value is not False}
    locked = sorted(in_words(state.restrictions).split(", "), key=lambda word: not word.startswith("no "))
    shown["restrictions"] = ", ".join(locked).replace(", no ", ", ")
    noticed = shown.pop("noticed", "")
    lines = {name: f"{name}: {_number(value)}" for name, value in shown.items()}
    stays = [line for name, line in lines.items() if name not in CHANGING]
    changing = [lines[name] for name in CHANGING if name in lines]
    return "\n".join(stays), "\n".join([*changing, *noticed.splitlines()])


def _number(value: object) -> str:
    """With one decimal, if it has any."""
    return f"{value:.1f}".removesuffix(".0") if isinstance(value, float) else str(value)


def _entry(element: Element, index: int | None) -> str:
    label, meaning = one_line(element.text), one_line(element.content_description)
    state = ", ".join(_state(element))
    if index is None:
        # Without an index of its own, a number at its beginning could be taken for one.
        both = f"{meaning}: {label}" if label and meaning and label not in meaning else meaning or label
        words = [_quoted(both or element.class_name, is_first=True)]
    else:
        words = [str(index), _quoted(label or meaning or element.class_name)]
        words += ["-", _quoted(meaning)] if label and meaning else []
    return " ".join([*words, *([f"[{state}]"] if state else [])])


def _state(element: Element) -> Iterator[str]:
    if element.is_selected:
        yield "chosen"
    elif element.is_checked:
        yield "on"
    if not element.is_enabled:
        yield "disabled"
    if element.is_scrollable and element.class_name != "SeekBar":
        yield "scrolls"
    if element.class_name == "SeekBar":
        box = element.bbox_pixels
        yield f"x {box.x_min} to {box.x_max}, y {(box.y_min + box.y_max) // 2}"


def _quoted(text: str, *, is_first: bool = False) -> str:
    is_plain = PLAIN.fullmatch(text) and " - " not in text and not (is_first and text[0].isdigit())
    return text if is_plain else json.dumps(text, ensure_ascii=False)


def _doubt(cited: re.Match[str]) -> str:
    return "" if cited[1] == "verified" else f" ({cited[1]})"
