"""A task in words, for lists and pages."""

from __future__ import annotations

from collections.abc import Iterable

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.tasking.binding import needs
from automotive_cosim.tasking.moves import Consult, Hear, Inform, Open, Slide, Tap, TapUntil, TypeText, Warn
from automotive_cosim.tasking.parameters import Choices, FromCockpit
from automotive_cosim.tasking.task import Half


def choices_in_words(choices: Choices) -> str:
    """The values that a parameter may take."""
    if isinstance(choices, FromCockpit):
        return f"one of the cockpit's {choices.kind}"
    return ", ".join(map(str, choices))


def half_in_words(half: Half) -> Iterable[tuple[str, str]]:
    """What each part of a half is called, and what it says."""
    start = half.start
    yield "where", f"{start.scenario}, trip {start.trip}" + (", parked" if start.parked else "")
    if start.origin:
        yield "at", f"{start.origin[0]:g}, {start.origin[1]:g} (longitude, latitude)"
    if start.start:
        yield "when", start.start[:16].replace("T", " ")
    after = f", {half.trigger.after_s:g} s after departure or later" if half.trigger.after_s else ""
    yield "trigger", f"{half.trigger.condition}, for {half.trigger.for_s:g} s{after}"
    yield "goal", f"{half.goal}, then declare `{half.declares}`"
    if half.may_write:
        yield "allowed", f"{', '.join(sorted(half.may_write))} may be commanded besides"
    for coming in start.interruptions:
        yield "meanwhile", f"{_coming(coming)}, {coming.at_s:g} s after the hand-over"
    ways = dict.fromkeys(", ".join(map(_move, way)) or "declare at once" for way in (half.moves, *half.ways))
    for number, way in enumerate(ways):
        yield "solution", f"{'or ' if number else ''}{way}"
    for words in half.tells:
        yield "tells", " or ".join(map(str, words))
    if half.most_words is not None:
        yield "tells", f"in {half.most_words} words at most"
    for topic in half.topics:
        yield "driver", f"asked about {topic.name}, says {topic.reply!r}"
    for says in half.says:
        yield "driver", f"{says}, says {says.text!r}"
    for slip in half.slips:
        yield "slip", ", ".join(map(_move, slip)) or "declare at once"
    yield "deadline", f"{half.deadline.seconds:g} s: {half.deadline.reason}"
    yield "basis", f"{half.basis}: {half.rule}" if half.rule else str(half.basis)
    for need in needs(half):
        yield "in another country", f"needs {need}"


def _coming(coming: Arrival | CarChange) -> str:
    if isinstance(coming, Arrival):
        return f"{coming.kind} from {coming.who}"
    return f"{coming.path} {coming.value}"


def _move(move: object) -> str:
    match move:
        case Open(name):
            return f"open {name}"
        case Tap(key, times, text):
            return f"tap {key or repr(text)}" + (f" x{times}" if times != 1 else "")
        case TapUntil(key, shown, text):
            return f"tap {key} until {shown} reads {text!r}"
        case Slide(key, value):
            return f"slide {key} to {value}"
        case TypeText(key, text):
            return f"type {text!r} into {key}"
        case Warn(kind):
            return f"alert {kind}"
        case Consult(text):
            return f"ask {text!r}"
        case Inform(text):
            return f"answer {text!r}"
        case Hear(text):
            return f"wait until the driver says {text!r}"
        case _:
            return str(getattr(getattr(move, "action", move), "action_type", move))
