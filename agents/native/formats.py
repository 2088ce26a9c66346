"""The table of formats: for each family of models its words (``words.txt``), its coordinates and its form.

A swipe is the finger's movement; a scroll shows what lies in its direction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any
from urllib.parse import parse_qsl, urlencode

from automotive_cosim.agents.native.grid import Grid, Pixels, Resized, Share
from automotive_cosim.agents.native.syntax import (
    Calls,
    Code,
    JsonSyntax,
    Labelled,
    Objects,
    Syntax,
    ToolCalls,
    car_function,
)
from automotive_cosim.agents.native.verbs import (
    CAR,
    CAR_ACTIONS,
    KEYS,
    TOUCHES,
    GuiCall,
    Hand,
    Meaning,
    Verb,
    actions,
    pointed,
)
from automotive_cosim.contracts import UNCALLED, Action, ActionType, GoalStatus, Json
from automotive_cosim.errors import ActionError, UnknownNameError, UserError
from automotive_cosim.models.apis import Anthropic, Gemini, OpenAI, ProviderApi

QWEN25_GRID = Resized(28, 56 * 56, 12_845_056)


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """Words of a family, and where they were seen."""

    version: str
    """Of the models or their tool."""
    date: str
    """Of the source."""
    source: str
    verbs: Mapping[str, Verb]


@dataclass(frozen=True, slots=True)
class Format:
    """How a family of models answers."""

    models: str
    """Which they are."""
    syntax: Syntax
    grid: Grid
    words: tuple[Vocabulary, ...]
    verbs: Mapping[str, Verb]
    """All of these, by name; of two meanings, the first."""
    api: ProviderApi | None = None
    """The protocol of its endpoint; None for chat completions."""

    @property
    def actions(self) -> frozenset[ActionType]:
        """The actions that it has words for."""
        found: set[ActionType] = set()
        for name, verb in self.verbs.items():
            if verb.unasked:
                continue
            if verb.meaning is Meaning.KEY:
                found |= {KEYS[verb.means]} if verb.means else set(KEYS.values())
            elif verb.meaning is Meaning.CAR and name != CAR:
                found.add(ActionType(name))
            else:
                found |= _MEANT[verb.meaning]
        return frozenset(found)

    @property
    def stops_at_failure(self) -> bool:
        """Whether its makers leave out what follows a failed action of the same answer."""
        return isinstance(self.api, Anthropic)

    @property
    def lacks(self) -> tuple[str, ...]:
        """The actions and statuses of the benchmark that it has no words for."""
        statuses = () if ActionType.SHOW_ALERT in self.actions else (str(GoalStatus.NOT_NEEDED),)
        return (*(str(kind) for kind in UNCALLED if kind not in self.actions), *statuses)

    @property
    def declines(self) -> str:
        """The words with which it says that nothing can or should be done."""
        ends = (Meaning.END, Meaning.CAR)
        told = [name for name, verb in self.verbs.items() if verb.meaning in ends and not verb.unasked]
        return ", ".join(name for name in told if name in (CAR, "status") or self.verbs[name].may_decline)

    def as_json(self) -> Json:
        words = [asdict(each) | {"verbs": [*each.verbs]} for each in self.words]
        told = {"models": self.models, "coordinates": self.grid.told, "declines_with": self.declines}
        return told | {"lacks": [*self.lacks], "words": words}

    def acts(self, text: str, hand: Hand) -> list[tuple[Action, GuiCall]]:
        """The actions of an answer, each with the call that asks for it.

        Raises ActionError: it cannot be read, has a word that the format does not have, or asks for what the car
        does not have."""
        found: list[tuple[Action, GuiCall]] = []
        calls = self.syntax.read(text, self.verbs)
        for call in calls:
            if call.name not in self.verbs:
                raise ActionError(_unknown(call.name, self))
            for action in actions(self.verbs, call, hand):
                found.append((action, call))
                if action.x is not None and action.y is not None:
                    hand = replace(hand, last=(action.x, action.y), has_touched=True)
            if (pointer := pointed(self.verbs[call.name], call, hand)) is not None:
                hand = replace(hand, last=pointer)
        return found or [(Action(ActionType.WAIT, seconds=1), call) for call in calls[:1]]  # it only pointed


def _unknown(name: str, form: Format) -> str:
    """That a format does not have a word, and which do."""
    told = str(UnknownNameError("action in this format", name[:40], [*form.verbs]))
    known = [other for other, each in FORMATS.items() if name in each.verbs]
    return f"{told}; ?format={' or '.join(known)} would know {name!r}" if known else told


_MEANT: Mapping[Meaning, frozenset[ActionType]] = {
    **{meaning: frozenset({action}) for meaning, action in TOUCHES.items()},
    Meaning.TYPE: frozenset({ActionType.INPUT_TEXT}),
    Meaning.SCROLL: frozenset({ActionType.SCROLL}),
    Meaning.FLICK: frozenset({ActionType.SWIPE}),
    Meaning.DRAG: frozenset({ActionType.SWIPE}),
    Meaning.OPEN: frozenset({ActionType.OPEN_APP}),
    Meaning.WAIT: frozenset({ActionType.WAIT}),
    Meaning.SAY: frozenset({ActionType.ANSWER}),
    Meaning.ASK: frozenset({ActionType.ASK_DRIVER}),
    Meaning.END: frozenset({ActionType.STATUS}),
    Meaning.CAR: CAR_ACTIONS,
}


@cache
def vocabularies() -> Mapping[str, Vocabulary]:
    """Every family's words, by its name in ``words.txt``."""
    text = (files("automotive_cosim.agents.native") / "words.txt").read_text(encoding="utf-8")
    found = {}
    for head, *lines in (block.splitlines() for block in text.strip().split("\n\n")[1:]):
        name, version, date, source = head.split(" | ")
        found[name] = Vocabulary(version, date, source, dict(_verbs(";".join(lines))))
    return MappingProxyType(found)


def _verbs(text: str) -> Iterator[tuple[str, Verb]]:
    for spec, _, names in (each.rpartition(": ") for each in text.split(";")):
        meaning, *marks = spec.split()
        given: dict[str, Any] = dict(mark.split("=", 1) for mark in marks if "=" in mark)
        given |= {key: tuple(given[key].split(",")) for key in ("at", "to", "ways") if key in given}
        verb = Verb(Meaning(meaning), **given, point_optional="optional" in marks)
        for name in names.split():
            yield name.removeprefix("~"), replace(verb, unasked=name[0] == "~")


def _format(
    models: str, syntax: Syntax, grid: Grid, *names: str, api: ProviderApi | None = None, car: bool = False
) -> Format:
    words = tuple(vocabularies()[name] for name in names)
    verbs: dict[str, Verb] = {}
    for each in words:
        verbs = {**verbs, **each.verbs, **verbs}
    return Format(models, syntax, grid, words, verbs | ({CAR: Verb(Meaning.CAR)} if car or api else {}), api)


def _boxed(form: Format) -> Format:
    """The same words with points as the first UI-TARS names them."""
    named = {"point": "start_box", "start_point": "start_box", "end_point": "end_box"}
    verbs = {
        name: replace(verb, at=tuple(map(named.__getitem__, verb.at)), to=tuple(map(named.__getitem__, verb.to)))
        for name, verb in form.verbs.items()
    }
    return replace(form, verbs=verbs)


_SCREEN_ALONE = frozenset(UNCALLED) - {ActionType.QUERY, ActionType.ESTIMATE_POSITION}
_PLAIN: dict[str, Verb] = {str(kind): Verb(Meaning.CAR) for kind in UNCALLED if kind in _SCREEN_ALONE}
_FUNCTIONS = (car_function(),)
_THINKING = "<thinking>\n{thought}\n</thinking>\n"
_HOLO = '{{"note": "", "thought": {thought}, "action": {action}}}'
_POINT = "<point>{x} {y}</point>"
_COMPUTER = "qwen-computer"


def _anthropic(models: str, *tool: str) -> Format:
    return _format(models, Calls(), Pixels(), "anthropic", api=Anthropic(_FUNCTIONS, *tool))


FORMATS: Mapping[str, Format] = {
    "anthropic": _anthropic("Claude's computer use, its toolset of 2026"),
    "anthropic-2025-01": _anthropic(
        "Claude's computer use, tool of January 2025", "computer_20250124", "computer-use-2025-01-24"
    ),
    "anthropic-2025-11": _anthropic(
        "Claude's computer use, tool of November 2025", "computer_20251124", "computer-use-2025-11-24"
    ),
    "gemini": _format(
        "Gemini's computer use", Calls(), Share(1000), "gemini-2.5", "gemini-3.5", api=Gemini(_FUNCTIONS)
    ),
    "glm-4.5v": _format(
        "GLM-4.5V and later, GLM-4.1V", Objects("action_type", "Memory: none\nReason: {thought}\nAction: {action}"),
        Share(999), "glm", "glm-computer",
    ),
    "gui-owl": _format(
        "GUI-Owl, Mobile-Agent-v3", ToolCalls(preamble=f"{_THINKING}<conclusion>\n{{thought}}\n</conclusion>\n"),
        QWEN25_GRID, "qwen-2.5", "qwen-answer", _COMPUTER, car=True,
    ),
    "gui-owl-1.5": _format(
        "GUI-Owl 1.5, Mobile-Agent-v3.5", ToolCalls(), Share(1000),
        "qwen-2.5", "qwen-answer", "gui-owl-1.5", _COMPUTER, car=True,
    ),
    "holo-1.5": _format("Holo1, Holo1.5", Objects("action", _HOLO), QWEN25_GRID, "holo"),
    "holo-2": _format("Holo2", Objects("action", _HOLO), Share(1000), "holo"),
    "json": Format("any model", JsonSyntax(), Pixels(), (), _PLAIN),
    "mai-ui": _format("MAI-UI", ToolCalls(preamble=_THINKING), Share(999), "mai-ui", car=True),
    "openai": _format("OpenAI's computer use", Calls(), Pixels(), "openai", api=OpenAI(_FUNCTIONS)),
    "opencua": _format("OpenCUA", Code(), Resized(28, 3136, 12_845_056), "opencua"),
    "qwen2.5-vl": _format(
        "Qwen2.5-VL", ToolCalls(preamble=""), QWEN25_GRID, "qwen-2.5", _COMPUTER, car=True
    ),
    "qwen3-vl": _format("Qwen3-VL, Qwen3.5", ToolCalls(), Share(999), "qwen-3", "qwen-answer", _COMPUTER, car=True),
    "ui-tars-1.0": _boxed(
        _format("UI-TARS 1.0, Doubao 1.5", Labelled("<|box_start|>({x},{y})<|box_end|>"), Share(1000), "ui-tars")
    ),
    "ui-tars-1.5": _format(
        "UI-TARS 1.5", Labelled(_POINT), Resized(28, 100 * 28 * 28, 16_384 * 28 * 28), "ui-tars"
    ),
    "ui-tars-2": _format(
        "UI-TARS 2, Seed 1.6 and later", Labelled(_POINT, is_tagged=True), Share(1000), "ui-tars"
    ),
}  # fmt: skip
"""The formats by name."""


def chosen(model: str) -> tuple[str, Format]:
    """The model's name without its setting ``format``, and that format.

    Raises:
        UserError: it has none.
        UnknownNameError: there is no such format."""
    whole, _, query = model.partition("?")
    settings = parse_qsl(query, keep_blank_values=True)
    names = [value for name, value in settings if name == "format"]
    if len(names) != 1:
        raise UserError(
            f"agent 'native' requires the format of its model, as in --model {whole}?format=NAME; "
            f"formats are {', '.join(FORMATS)}"
        )
    if names[0] not in FORMATS:
        raise UnknownNameError("format", names[0], FORMATS)
    left = urlencode([(name, value) for name, value in settings if name != "format"])
    return whole + (f"?{left}" if left else ""), FORMATS[names[0]]
