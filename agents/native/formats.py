"""The table of formats: for each model family its words, its coordinates and its form.

Sources: bytedance/UI-TARS ``codes/ui_tars``; QwenLM/Qwen3-VL ``cookbooks``; X-PLUG/MobileAgent; Tongyi-MAI/MAI-UI
``src/prompt.py``; xlang-ai/OpenCUA; the providers' own pages on computer use. A swipe is the finger's movement; a
scroll shows what lies in its direction.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import parse_qsl, urlencode

from automotive_cosim.agents.native.grid import Grid, Pixels, Resized, Share
from automotive_cosim.agents.native.syntax import (
    END,
    Calls,
    Code,
    JsonSyntax,
    Labelled,
    Syntax,
    ToolCalls,
    car_function,
)
from automotive_cosim.agents.native.verbs import CAR, CAR_ACTIONS, KEYS, Meaning, Verb
from automotive_cosim.contracts import UNCALLED, ActionType, GoalStatus
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.models.apis import Anthropic, Gemini, OpenAI, ProviderApi

QWEN25_GRID = Resized(28, 56 * 56, 12_845_056)


@dataclass(frozen=True, slots=True)
class Format:
    """How a family of models answers."""

    syntax: Syntax
    grid: Grid
    verbs: Mapping[str, Verb]
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
    def lacks(self) -> tuple[str, ...]:
        """The actions and statuses of the benchmark that it has no words for."""
        statuses = () if ActionType.SHOW_ALERT in self.actions else (str(GoalStatus.NOT_NEEDED),)
        return (*(str(kind) for kind in UNCALLED if kind not in self.actions), *statuses)


_MEANT: Mapping[Meaning, frozenset[ActionType]] = {
    Meaning.TAP: frozenset({ActionType.CLICK}),
    Meaning.DOUBLE_TAP: frozenset({ActionType.DOUBLE_TAP}),
    Meaning.HOLD: frozenset({ActionType.LONG_PRESS}),
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


def _ui_tars(at: str, start: str, end: str) -> dict[str, Verb]:
    return {
        "click": Verb(Meaning.TAP, at=(at,)),
        "left_double": Verb(Meaning.DOUBLE_TAP, at=(at,)),
        "long_press": Verb(Meaning.HOLD, at=(at,)),
        "type": Verb(Meaning.TYPE, text="content"),
        "scroll": Verb(Meaning.SCROLL, at=(at,), direction="direction", point_optional=True),
        "drag": Verb(Meaning.DRAG, at=(start,), to=(end,)),
        "open_app": Verb(Meaning.OPEN, text="app_name"),
        "press_home": Verb(Meaning.KEY, means="home"),
        "press_back": Verb(Meaning.KEY, means="back"),
        "wait": Verb(Meaning.WAIT),
        "finished": Verb(Meaning.END, means="success"),
        "call_user": Verb(Meaning.END, means="failure"),
        # Words of its training for other devices; on a touch screen, the right button is a long press.
        "left_single": Verb(Meaning.TAP, at=(at,), unasked=True),
        "right_single": Verb(Meaning.HOLD, at=(at,), unasked=True),
        "select": Verb(Meaning.DRAG, at=(start,), to=(end,), unasked=True),
        "hotkey": Verb(Meaning.KEY, text="key", unasked=True),
        "press": Verb(Meaning.KEY, text="key", unasked=True),
    }


_QWEN25: dict[str, Verb] = {
    "click": Verb(Meaning.TAP, at=("coordinate",)),
    "long_press": Verb(Meaning.HOLD, at=("coordinate",)),
    "swipe": Verb(Meaning.DRAG, at=("coordinate",), to=("coordinate2",)),
    "type": Verb(Meaning.TYPE, text="text"),
    "system_button": Verb(Meaning.KEY, text="button"),
    "key": Verb(Meaning.KEY, text="text"),
    "open": Verb(Meaning.OPEN, text="text"),
    "wait": Verb(Meaning.WAIT, seconds="time"),
    "terminate": Verb(Meaning.END, text="status"),
    CAR: Verb(Meaning.CAR),
}
_ANSWER: dict[str, Verb] = {"answer": Verb(Meaning.SAY, text="text")}
_QWEN3: dict[str, Verb] = {name: verb for name, verb in _QWEN25.items() if name not in ("key", "open")} | _ANSWER
_MAI_UI: dict[str, Verb] = {
    "click": Verb(Meaning.TAP, at=("coordinate",)),
    "double_click": Verb(Meaning.DOUBLE_TAP, at=("coordinate",)),
    "long_press": Verb(Meaning.HOLD, at=("coordinate",)),
    "type": Verb(Meaning.TYPE, text="text"),
    "swipe": Verb(Meaning.FLICK, at=("coordinate",), direction="direction", point_optional=True),
    "drag": Verb(Meaning.DRAG, at=("start_coordinate",), to=("end_coordinate",)),
    "open": Verb(Meaning.OPEN, text="text"),
    "system_button": Verb(Meaning.KEY, text="button"),
    "wait": Verb(Meaning.WAIT),
    "ask_user": Verb(Meaning.ASK, text="text"),
    "answer": Verb(Meaning.SAY, text="text"),
    "terminate": Verb(Meaning.END, text="status"),
    CAR: Verb(Meaning.CAR),
}
_OPENCUA: dict[str, Verb] = {
    "click": Verb(Meaning.TAP, at=("x", "y")),
    "doubleClick": Verb(Meaning.DOUBLE_TAP, at=("x", "y")),
    "triple_click": Verb(Meaning.DOUBLE_TAP, at=("x", "y")),
    "dragTo": Verb(Meaning.DRAG, at=("from_x", "from_y"), to=("x", "y")),
    "scroll": Verb(Meaning.SCROLL, at=("x", "y"), direction="direction", point_optional=True),
    "write": Verb(Meaning.TYPE, text="message"),
    "press": Verb(Meaning.KEY, text="keys"),
    "hotkey": Verb(Meaning.KEY, text="keys"),
    "sleep": Verb(Meaning.WAIT, seconds="seconds"),
    "wait": Verb(Meaning.WAIT),
    "terminate": Verb(Meaning.END, text="status"),
}
_OPENAI: dict[str, Verb] = {
    "click": Verb(Meaning.TAP, at=("x", "y")),
    "double_click": Verb(Meaning.DOUBLE_TAP, at=("x", "y")),
    "drag": Verb(Meaning.DRAG, at=("from",), to=("to",)),
    "scroll": Verb(Meaning.SCROLL, at=("x", "y"), direction="direction", point_optional=True),
    "type": Verb(Meaning.TYPE, text="text"),
    "keypress": Verb(Meaning.KEY, text="keys"),
    "wait": Verb(Meaning.WAIT),
    "screenshot": Verb(Meaning.WAIT),
    END: Verb(Meaning.END, means="success"),
    CAR: Verb(Meaning.CAR),
}
_ANTHROPIC: dict[str, Verb] = {
    "left_click": Verb(Meaning.TAP, at=("coordinate",)),
    "double_click": Verb(Meaning.DOUBLE_TAP, at=("coordinate",)),
    "triple_click": Verb(Meaning.DOUBLE_TAP, at=("coordinate",)),
    "left_click_drag": Verb(Meaning.DRAG, at=("start_coordinate",), to=("coordinate",)),
    "scroll": Verb(Meaning.SCROLL, at=("coordinate",), direction="scroll_direction", point_optional=True),
    "type": Verb(Meaning.TYPE, text="text"),
    "key": Verb(Meaning.KEY, text="text"),
    "wait": Verb(Meaning.WAIT, seconds="duration"),
    "screenshot": Verb(Meaning.WAIT),
    END: Verb(Meaning.END, means="success"),
    CAR: Verb(Meaning.CAR),
}
_GEMINI: dict[str, Verb] = {
    "click_at": Verb(Meaning.TAP, at=("x", "y")),
    "type_text_at": Verb(Meaning.TYPE, at=("x", "y"), text="text"),
    "scroll_document": Verb(Meaning.SCROLL, direction="direction"),
    "scroll_at": Verb(Meaning.SCROLL, at=("x", "y"), direction="direction"),
    "drag_and_drop": Verb(Meaning.DRAG, at=("x", "y"), to=("destination_x", "destination_y")),
    "key_combination": Verb(Meaning.KEY, text="keys"),
    "go_back": Verb(Meaning.KEY, means="back"),
    "wait_5_seconds": Verb(Meaning.WAIT, seconds="seconds"),
    END: Verb(Meaning.END, means="success"),
    CAR: Verb(Meaning.CAR),
}
_SCREEN_ALONE = frozenset(UNCALLED) - {ActionType.QUERY, ActionType.ESTIMATE_POSITION}
_PLAIN: dict[str, Verb] = {str(kind): Verb(Meaning.CAR) for kind in UNCALLED if kind in _SCREEN_ALONE}

_FUNCTIONS = (car_function(),)

FORMATS: Mapping[str, Format] = {
    "anthropic": Format(Calls(), Pixels(), _ANTHROPIC, Anthropic(_FUNCTIONS)),
    "anthropic-2025-01": Format(
        Calls(), Pixels(), _ANTHROPIC, Anthropic(_FUNCTIONS, "computer_20250124", "computer-use-2025-01-24")
    ),
    "anthropic-2025-11": Format(
        Calls(), Pixels(), _ANTHROPIC, Anthropic(_FUNCTIONS, "computer_20251124", "computer-use-2025-11-24")
    ),
    "gemini": Format(Calls(), Share(1000), _GEMINI, Gemini(_FUNCTIONS)),
    "gui-owl": Format(
        ToolCalls(preamble="<thinking>\n{thought}\n</thinking>\n<conclusion>\n{thought}\n</conclusion>\n"),
        QWEN25_GRID,
        _QWEN25 | _ANSWER,
    ),
    "gui-owl-1.5": Format(
        ToolCalls(), Share(1000), _QWEN25 | _ANSWER | {"interact": Verb(Meaning.ASK, text="text")}
    ),
    "json": Format(JsonSyntax(), Pixels(), _PLAIN),
    "mai-ui": Format(ToolCalls(preamble="<thinking>\n{thought}\n</thinking>\n"), Share(999), _MAI_UI),
    "openai": Format(Calls(), Pixels(), _OPENAI, OpenAI(_FUNCTIONS)),
    "opencua": Format(Code(), Resized(28, 3136, 12_845_056), _OPENCUA),
    "qwen2.5-vl": Format(ToolCalls(preamble=""), QWEN25_GRID, _QWEN25),
    "qwen3-vl": Format(ToolCalls(), Share(999), _QWEN3),
    "ui-tars-1.0": Format(
        Labelled("<|box_start|>({x},{y})<|box_end|>"), Share(1000), _ui_tars("start_box", "start_box", "end_box")
    ),
    "ui-tars-1.5": Format(
        Labelled("<point>{x} {y}</point>"),
        Resized(28, 100 * 28 * 28, 16_384 * 28 * 28),
        _ui_tars("point", "start_point", "end_point"),
    ),
}
"""The formats by name."""


def chosen(model: str) -> tuple[str, Format]:
    """The model's name without its setting ``format``, and that format.

    Raises:
        UserError: it has none.
        UnknownNameError: there is no such format.
    """
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
