"""A format's texts: reads the calls out of an answer, and writes them. Nothing in an answer is ever evaluated."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any, Protocol

from automotive_cosim.agents import answer
from automotive_cosim.agents.answer import ended, objects
from automotive_cosim.agents.native.verbs import CAR, CAR_ACTIONS, GuiCall, Meaning, Verb
from automotive_cosim.agents.thoughts import LOST, spoken
from automotive_cosim.agents.written import written
from automotive_cosim.cockpit.actions import grammar, to_json
from automotive_cosim.contracts import UNCALLED, ActionType, Direction, Json
from automotive_cosim.errors import ActionError

Verbs = Mapping[str, Verb]


class Syntax(Protocol):
    """How a format writes calls."""

    @property
    def whole(self) -> re.Pattern[str]:
        """What an answer that was cut off has at least, so that its calls are none of its thoughts."""
        ...

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        """The calls in an answer, in order. Raises ActionError: it has none."""
        ...

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str: ...

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        """The calls that a model may make, for its prompt; the picture has the coordinates 0 to width, height."""
        ...


def _sample(name: str, verb: Verb) -> str:
    """A placeholder for an argument."""
    if name == verb.direction:
        return "up|down|left|right"
    if name == verb.seconds:
        return "seconds"
    if name == verb.says:
        return "..."
    if verb.meaning is Meaning.END:
        return "complete|infeasible" if name == "goal_status" else "success|failure"
    return {Meaning.KEY: "home|back|enter", Meaning.OPEN: "name"}.get(verb.meaning, "...")


# --- UI-TARS ------------------------------------------------------------------------------------------------

_LABEL = re.compile(r"action\s*[:\uff1a]", re.IGNORECASE)
_THOUGHT = re.compile(r"^\s*(?:thought|reflection|reason)\s*[:\uff1a]", re.IGNORECASE | re.MULTILINE)
_WHOLE_CALL = re.compile(r"^[ \t]*([A-Za-z_]+)\((.*?)\)[ \t]*$", re.MULTILINE | re.DOTALL)
"""A call as the models are told to write it: on lines of its own, its parenthesis closed."""
_CALL_BEGINS = re.compile(r"^[\s`*>-]*(?:<\w+>\s*)?([A-Za-z_]+)[ \t]*\(", re.MULTILINE)
_ARGUMENT = re.compile(
    r"""
    (?:(?P<name>[A-Za-z_]\w*)\s*=\s*)?
    (?:
        (?P<quote>['"])(?P<quoted>(?:\\.|.)*?)(?P=quote)(?=\s*(?:,\s*[A-Za-z_]\w*\s*=|\)|\Z))
      | (?P<bare>(?:\([^()]*\)|\[[^\[\]]*\]|[^,()\[\]])+)
    )
    """,
    re.VERBOSE | re.DOTALL,
)
_STARTS = frozenset({"point", "start_point", "start_box", "start", "box", "bbox", "coordinate", "position"})
_ENDS = frozenset({"end_point", "end_box", "end"})
"""Names for the two points of a call. A model of one version writes those of another; so does its own parser read
them all (bytedance/UI-TARS ``codes/ui_tars/action_parser.py``)."""
_WIDE = str.maketrans("\uff08\uff09\uff1a\uff0c\uff1d\u2018\u2019\u201c\u201d", "():,=''\"\"")
_QUOTED_OR_WIDE = re.compile(
    r"""(['"\u2018\u2019\u201c\u201d])(.*?)(['"\u2018\u2019\u201c\u201d])(?=\s*(?:[,\uff0c)\uff09]|$))"""
    r"""|[\uff08\uff09\uff1a\uff0c\uff1d]""",
    re.DOTALL | re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class Labelled:
    """``Thought: ...``, ``Action: name(argument='...')``: UI-TARS; or the same calls in Seed's tags."""

    point: str
    """Form of a point, with ``{x}`` and ``{y}``."""
    is_tagged: bool = False
    """Whether the prompt asks for tags; both forms are read."""
    whole: re.Pattern[str] = re.compile(r"action\s*[:\uff1a].*\(.*\)|</function>", re.IGNORECASE | re.DOTALL)

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        """See ``Syntax``. Points are read in the forms of all versions, whatever the prompt shows."""
        text = ended(text)
        marks = list(_LABEL.finditer(text))
        tagged = [(name, given) for name, given in written(text, {}) if isinstance(given, dict)]
        if tagged and "<function" in text:
            plain = [
                (name, {key: str(each).replace("\\n", "\n") for key, each in given.items()})
                for name, given in tagged
            ]
            return [GuiCall(name, _named(given, verbs.get(name))) for name, given in plain]
        if not marks and _THOUGHT.search(text):
            raise ActionError(LOST)
        tail = text[marks[-1].end() if marks else 0 :].strip().strip("`").strip()
        calls = [(found[1], _keywords(found[2])) for found in _WHOLE_CALL.finditer(tail)]
        if not calls or not all(name in verbs for name, _ in calls):
            calls = _loosely(tail, verbs) or _loosely(_narrow(tail), verbs) or _alone(tail, verbs) or calls
        if not calls:
            raise ActionError("the answer has no action; end it with `Action: name(argument='...')`")
        return [GuiCall(name, _named(arguments, verbs.get(name))) for name, arguments in calls]

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str:
        lines = "\n\n".join(self._call(call, verbs[call.name]) for call in calls)
        return f"<think>{thought}</think>\n{lines}" if self.is_tagged else f"Thought: {thought}\nAction: {lines}"

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        lines = [
            f"{name}({', '.join(f'{each}={self._shown(each, verb)!r}' for each in verb.arguments())})"
            for name, verb in verbs.items()
            if not verb.unasked
        ]
        if self.is_tagged:
            form = self._call(GuiCall("NAME", {"ARGUMENT": "..."}), Verb(Meaning.WAIT))
            lines += ["", f"Call one in this form:\n{form}"]
        return "\n".join(lines)

    def _shown(self, name: str, verb: Verb) -> str:
        if name in verb.at + verb.to:
            return self.point.format(x="x", y="y")
        return _sample(name, verb)

    def _call(self, call: GuiCall, verb: Verb) -> str:
        said = {
            name: self.point.format(x=value[0], y=value[1]) if name in verb.at + verb.to else str(value)
            for name, value in call.arguments.items()
        }
        if self.is_tagged:
            given = "".join(f"<parameter={name}>{text}</parameter>\n" for name, text in said.items())
            return f"<seed:tool_call>\n<function={call.name}>\n{given}</function>\n</seed:tool_call>"
        return f"{call.name}({', '.join(f'{name}={text!r}' for name, text in said.items())})"


def _keywords(text: str) -> Json:
    """``name='text', ...`` as a mapping; quotes inside a text need not be escaped."""
    try:
        call = ast.parse(f"_({text})", mode="eval").body
        assert isinstance(call, ast.Call)
        assert not call.args
        return {word.arg: ast.literal_eval(word.value) for word in call.keywords if word.arg}
    except (SyntaxError, ValueError, AssertionError, RecursionError, MemoryError):
        return _arguments(text)


def _loosely(tail: str, verbs: Verbs) -> list[tuple[str, Json]]:
    """Calls of known words that begin a line, whatever follows them; a parenthesis or quote may be missing."""
    known = {name.lower(): name for name in verbs}
    begun = [found for found in _CALL_BEGINS.finditer(tail) if found[1].lower() in known]
    return [
        (known[mark[1].lower()], _arguments(tail[mark.end() : following.start() if following else len(tail)]))
        for mark, following in zip_longest(begun, begun[1:])
    ]


def _alone(tail: str, verbs: Verbs) -> list[tuple[str, Json]]:
    """A word that takes no argument, as the whole answer, without its parentheses."""
    word = tail.strip("`*.; \n").lower()
    return [(word, {})] if word in verbs and not verbs[word].arguments() else []


def _arguments(text: str) -> Json:
    """The arguments up to the parenthesis that closes the call, or to the end. One without a name has its place."""
    given: Json = {}
    at = 0
    while (found := _ARGUMENT.match(text, at)) is not None:
        value = found["bare"].strip().strip("'\"`") if found["bare"] else found["quoted"].replace("\\n", "\n")
        if found["name"] or value:
            given[found["name"] or str(len(given))] = value
        at = found.end()
        while at < len(text) and text[at] in ", \t\n":
            at += 1
        if at >= len(text) or text[at] == ")":
            break
    return given


def _named(given: Json, verb: Verb | None) -> Json:
    """The arguments by the names that the word has for them."""
    if verb is None:
        return given
    placed = [value for name, value in given.items() if name.isdecimal()]
    named = {name: value for name, value in given.items() if not name.isdecimal()}
    for wanted, others in ((verb.at[:1], _STARTS), (verb.to[:1], _ENDS)):
        for name in wanted:
            other = next((each for each in named if each in others), None)
            if name not in named and other is not None:
                named[name] = named.pop(other)
    if verb.text:
        alone = placed[:1] or ([*named.values()] if len(named) == 1 else [])
        return named if verb.text in named or not alone else {verb.text: alone[0]}  # hotkey(hotkey='enter')
    if verb.direction and verb.direction not in named:  # scroll(down)
        way = next((value for value in placed if str(value).lower() in set(Direction)), None)
        if way is not None:
            named[verb.direction] = way
            placed.remove(way)
    if len(verb.at) == 2 and len(placed) == 2:
        named |= dict(zip(verb.at, placed, strict=True))
    if len(verb.at) == 1 and verb.at[0] not in named:
        if placed:  # click(644, 364)
            named[verb.at[0]] = placed
        elif {"x", "y"} <= named.keys():  # click(x=644, y=364)
            named[verb.at[0]] = [named.pop("x"), named.pop("y")]
    return named


def _narrow(text: str) -> str:
    """Punctuation of full width as ASCII, except inside quoted texts."""

    def narrowed(match: re.Match[str]) -> str:
        if match[1] is None:
            return match[0].translate(_WIDE)
        return match[1].translate(_WIDE) + match[2] + match[3].translate(_WIDE)

    return _QUOTED_OR_WIDE.sub(narrowed, text)


# --- tool calls in the text: Qwen, GUI-Owl, MAI-UI ----------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ToolCalls:
    """``<tool_call>{"name": ..., "arguments": {"action": ...}}</tool_call>``."""

    function: str = "mobile_use"
    preamble: str = "Thought: {thought}\nAction: {thought}\n"
    """What stands before the calls, with ``{thought}``."""
    whole: re.Pattern[str] = re.compile(r"</tool_call>")

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        """See ``Syntax``. The same function in the tags of later Qwen is read, too."""
        said = ended(text)
        tagged = [
            {"name": name, "arguments": given}
            for name, given in (written(said, {}) if "<function=" in said else ())
        ]
        calls = [call for value in tagged or objects(said) if (call := _tool_call(value, verbs))]
        if not calls:
            raise ActionError('the answer has no <tool_call>{"name": ..., "arguments": {...}}</tool_call>')
        return calls

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str:
        values = [
            {"name": CAR, "arguments": dict(call.arguments)}
            if call.name == CAR
            else {"name": self.function, "arguments": {"action": call.name, **call.arguments}}
            for call in calls
        ]
        texts = (f"<tool_call>\n{json.dumps(value, ensure_ascii=False)}\n</tool_call>" for value in values)
        return self.preamble.format(thought=thought) + "\n".join(texts)

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        touch = {name: verb for name, verb in verbs.items() if verb.meaning is not Meaning.CAR and not verb.unasked}
        properties: Json = {"action": {"type": "string", "enum": list(touch)}}
        for verb in touch.values():
            for name in verb.arguments():
                properties.setdefault(name, _schema(name, verb))
        functions = [
            {
                "name": self.function,
                "description": f"Use the car's touch screen of {width}x{height}; coordinates are [x, y].",
                "parameters": {"type": "object", "properties": properties, "required": ["action"]},
            }
        ]
        if CAR in verbs:
            functions.append(car_function())
        tools = "\n".join(json.dumps({"type": "function", "function": function}) for function in functions)
        return (
            f"<tools>\n{tools}\n</tools>\n\nCall one inside <tool_call></tool_call>:\n"
            f'<tool_call>\n{{"name": "{self.function}", "arguments": {{"action": ...}}}}\n</tool_call>'
        )


def car_function() -> Json:
    """The function with the car's own actions, as a JSON Schema."""
    kinds = [kind for kind in UNCALLED if kind in CAR_ACTIONS]
    return {
        "name": CAR,
        "description": f"Use the car's own functions. The arguments are one of:\n{grammar(kinds)}",
        "parameters": {
            "type": "object",
            "properties": {"action_type": {"type": "string", "enum": [str(kind) for kind in kinds]}},
            "required": ["action_type"],
        },
    }


def _schema(name: str, verb: Verb) -> Json:
    if name in verb.at + verb.to:
        return {"type": "array", "items": {"type": "number"}, "description": "[x, y]"}
    if name == verb.seconds:
        return {"type": "number"}
    return (
        {"type": "string", "description": _sample(name, verb)}
        if _sample(name, verb) != "..."
        else {"type": "string"}
    )


def _tool_call(value: Json, verbs: Verbs) -> GuiCall | None:
    """The call in an object; None if it is none. Some models send the arguments as text or leave the frame out."""
    given: Any = value.get("arguments", value.get("parameters"))
    if isinstance(given, str):
        given = next(iter(objects(given)), None)
    if given is None and value.get("action") in verbs:
        given = value
    if not isinstance(given, dict):
        return None
    if value.get("name") == CAR:
        return GuiCall(CAR, given)
    word = given.get("action", value.get("name") if value.get("name") in verbs else None)
    return (
        None if word is None else GuiCall(str(word), {key: each for key, each in given.items() if key != "action"})
    )


# --- an object that names its action: GLM, Holo ------------------------------------------------------------------

_BOX_MARK = re.compile(r"<\|(?:begin|end)_of_box\|>|</?answer>")


@dataclass(frozen=True, slots=True)
class Objects:
    """``{"action_type": "click", "box_2d": ...}`` after labels, or within ``{"thought": ..., "action": {...}}``."""

    key: str
    """Name of the key with the action's name."""
    form: str
    """Of an answer, with ``{thought}`` and ``{action}``, both as JSON where its first character is a brace."""
    whole: re.Pattern[str] = re.compile(r"action\W.*\}|\(.*\)", re.IGNORECASE | re.DOTALL)

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        """See ``Syntax``. The calls of these models' forms for a desktop are read, too."""
        said = _BOX_MARK.sub("", ended(text))
        calls = []
        for value in objects(said):
            inner = next((each for each in (value.get("action"), value) if isinstance(each, dict)), value)
            if isinstance(inner.get(self.key), str):
                calls.append(
                    GuiCall(inner[self.key], {name: each for name, each in inner.items() if name != self.key})
                )
        return calls or Labelled("").read(said, verbs)

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str:
        told = [json.dumps({self.key: call.name, **call.arguments}, ensure_ascii=False) for call in calls]
        says = json.dumps(thought) if self.form.startswith("{") else thought
        return "\n".join(self.form.format(thought=says, action=each) for each in told)

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        lines = [
            json.dumps({self.key: name} | {each: _shown(each, verb) for each in verb.arguments()})
            for name, verb in verbs.items()
            if not verb.unasked
        ]
        form = self.form.format(thought='"..."' if self.form.startswith("{") else "...", action="{...}")
        return "\n".join([*lines, "", f"Answer in this form, x from 0 to {width}, y from 0 to {height}:", form])


def _shown(name: str, verb: Verb) -> object:
    if name in verb.at + verb.to:
        return 0 if len(verb.at) == 2 else [["x_min", "y_min", "x_max", "y_max"]]
    return False if name in (verb.enter.partition(":")[0], verb.clear.partition(":")[0]) else _sample(name, verb)


# --- Python's pyautogui: OpenCUA ----------------------------------------------------------------------------

_AT = ["click", "doubleClick", "triple_click", "tripleClick", "rightClick", "middleClick", "moveTo", "dragTo"]
_ORDER: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(_AT, ("x", "y")),
    **dict.fromkeys(("write", "typewrite"), ("message",)),
    **dict.fromkeys(("press", "hotkey"), ("keys",)),
    **dict.fromkeys(("scroll", "hscroll"), ("clicks", "x", "y")),
    "sleep": ("seconds",),
    "terminate": ("status",),
}
"""Names of positional arguments."""


@dataclass(frozen=True, slots=True)
class Code:
    """``## Action``, ``## Code`` with lines of pyautogui: OpenCUA."""

    whole: re.Pattern[str] = re.compile(r"```.*```", re.DOTALL)

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        said = ended(text)
        blocks = re.findall(r"```(?:python|code)?\s*\n(.*?)(?:```|\Z)", said, re.DOTALL)
        source = blocks[-1] if blocks else "\n".join(_CODE_LINE.findall(said))
        try:
            statements = _statements(source)
            calls = list(_joined(_python(each) for each in statements if not isinstance(each, ast.Import)))
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise ActionError(
                f"the code cannot be read: {error}; write one call with constants per line"
            ) from error
        if not calls:
            raise ActionError("the answer has no code; end it with a block of pyautogui calls")
        return calls

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str:
        lines = "\n".join(line for call in calls for line in _lines(call))
        return f"## Action:\n{thought}\n\n## Code:\n```python\n{lines}\n```"

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        lines = (
            line
            for name, verb in verbs.items()
            if not verb.unasked
            for line in _lines(GuiCall(name, {each: _Word(each) for each in verb.arguments()}))
        )
        return "\n".join(lines)


class _Word(str):
    """A placeholder, shown without quotes."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


_CODE_LINE = re.compile(r"^[ \t]*((?:pyautogui|computer|time)\.\w+\(.*)$", re.MULTILINE)


def _statements(source: str) -> list[ast.stmt]:
    """The statements of a source; its last parenthesis may be missing."""
    try:
        return ast.parse(source).body
    except SyntaxError:
        return ast.parse(_narrow(source).rstrip() + (")" if source.count("(") > source.count(")") else "")).body


def _python(statement: ast.stmt) -> GuiCall:
    """The call in a line such as ``pyautogui.click(x=1, y=2)``."""
    match statement:
        case ast.Expr(ast.Call(ast.Attribute(ast.Name("pyautogui" | "computer" | "time"), name), given, words)):
            values = [ast.literal_eval(each) for each in given]
            names = _ORDER.get(name, ())
            if name == "hotkey" and len(values) > 1:
                raise ValueError("this car has no combinations of keys")
            if len(values) > len(names):
                raise ValueError(f"{name} has too many arguments")
            found = dict(zip(names, values, strict=False))
            return GuiCall(name, found | {word.arg: ast.literal_eval(word.value) for word in words if word.arg})
    raise ValueError(f"{ast.unparse(statement)[:60]!r} is no call of pyautogui")


def _joined(calls: Iterator[GuiCall]) -> Iterator[GuiCall]:
    """Calls with the meaning that pyautogui gives them by sign and by order: scroll's direction, a drag's start."""
    start: Json | None = None
    for call in calls:
        given = dict(call.arguments)
        if call.name == "moveTo":
            start = {"x": given.get("x"), "y": given.get("y")}
            continue
        if call.name in ("scroll", "hscroll"):
            clicks = given.pop("clicks", 0)
            ways = ("up", "down") if call.name == "scroll" else ("right", "left")
            given["direction"] = ways[0] if isinstance(clicks, int | float) and clicks > 0 else ways[1]
            yield GuiCall("scroll", given)
        elif call.name == "dragTo":
            from_x, from_y = (start or {}).get("x"), (start or {}).get("y")
            yield GuiCall("dragTo", {"from_x": from_x, "from_y": from_y, "x": given.get("x"), "y": given.get("y")})
        elif call.name.lower().endswith("click") and start is not None and not {"x", "y"} & given.keys():
            yield GuiCall(call.name, given | start)
        else:
            yield GuiCall(call.name, given)
        start = None
    if start is not None:
        raise ValueError("moving the pointer does nothing on a touch screen")


def _lines(call: GuiCall) -> Iterator[str]:
    given = dict(call.arguments)
    module = {"terminate": "computer", "triple_click": "computer", "sleep": "time"}.get(call.name, "pyautogui")
    name = call.name
    if name == "dragTo":
        yield f"pyautogui.moveTo(x={given.pop('from_x')!r}, y={given.pop('from_y')!r})"
    first = ""
    if name == "scroll":
        way = given.pop("direction")
        name = "hscroll" if way in ("left", "right") else "scroll"
        first = "5, " if way in ("up", "right") else "-5, "
    words = first + ", ".join(f"{key}={value!r}" for key, value in given.items())
    yield f"{module}.{name}({words.removesuffix(', ')})"


# --- calls by a provider's own API ------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Calls:
    """Calls that came over an API of their own: OpenAI, Anthropic, Gemini (``models.apis``)."""

    whole: re.Pattern[str] = re.compile(r'"calls": \[\{')

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        """See ``Syntax``. An answer in words alone ends the episode: that is how these models end it."""
        try:
            told = json.loads(text)
            calls = [_plainly(str(call["name"]), dict(call["arguments"])) for call in told["calls"]]
            said = told["say"]
        except (ValueError, LookupError, TypeError, RecursionError) as error:
            raise ActionError(f"the answer is no list of calls: {error}") from error
        if not calls and not spoken(str(said)).strip():
            raise ActionError("the answer is empty; call a function, or say that you are done")
        return calls or [GuiCall(END, {})]

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str:
        told = [{"name": call.name, "arguments": dict(call.arguments)} for call in calls if call.name != END]
        return json.dumps({"say": thought, "calls": told}, ensure_ascii=False)

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        """See ``Syntax``; the protocol itself describes them."""
        return ""


END = "end"
"""The word for an answer without a call."""


def _plainly(name: str, given: Json) -> GuiCall:
    """A call with its arguments as the table names them."""
    if name == "drag" and "path" in given:  # OpenAI
        path = [[*point.values()] if isinstance(point, dict) else list(point) for point in given["path"]]
        return GuiCall(name, {"from": path[0], "to": path[-1]})
    if name == "scroll" and "scroll_y" in given:  # OpenAI: a wheel's distance, down and right above zero
        across, down = given.pop("scroll_x", 0), given.pop("scroll_y")
        by_row = ("down" if down > 0 else "up") if abs(down) >= abs(across) else ("right" if across > 0 else "left")
        return GuiCall(name, given | {"direction": by_row})
    held = given.get("keys") if name not in ("keypress", "hotkey", "key_combination") else None
    if held or (given.get("text") and name.endswith(("click", "drag", "scroll"))):
        raise ActionError(f"{name} with keys held down: this car has no such keys")
    if name in ("click", "double_click") and given.get("button") in _BUTTONS:
        return GuiCall(_BUTTONS[given["button"]], given)
    return GuiCall(name, given)


_BUTTONS: Mapping[str, str] = {"right": "right_click", "back": "go_back", "forward": "go_forward"}
"""OpenAI's buttons of a mouse other than the left, as words of their own."""


# --- this project's own JSON --------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class JsonSyntax:
    """``Situation``, ``Plan``, ``Action: {"action_type": ...}``: as this project's other agents answer."""

    whole: re.Pattern[str] = re.compile(r"^action\W.*\}", re.IGNORECASE | re.DOTALL | re.MULTILINE)

    def read(self, text: str, verbs: Verbs) -> list[GuiCall]:
        action = answer.read(text).action
        return [GuiCall(str(action.action_type), to_json(action))]

    def write(self, thought: str, calls: Sequence[GuiCall], verbs: Verbs) -> str:
        lines = "\n".join(f"Action: {json.dumps(dict(call.arguments), ensure_ascii=False)}" for call in calls)
        return f"Situation: {thought}\nPlan: none\n{lines}"

    def describe(self, verbs: Verbs, width: int, height: int) -> str:
        kinds = [ActionType(name) for name in verbs]
        return grammar(kinds).replace(POINT_TOO, "").replace('"index": <int>', '"x": <int>, "y": <int>')


POINT_TOO = ' (or "x", "y" in place of "index")'
