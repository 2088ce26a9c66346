"""Calls that a model writes as its template has them, and that its server leaves in the words.

json       {"name": ..., "arguments": ...}, one or a list, within a mark or alone: Hermes, Qwen, Llama, Mistral,
           Granite, Phi, Cohere, Hunyuan, Nemotron, xLAM
headed     a mark, the name, and the arguments as JSON: Llama, Mistral, DeepSeek, Kimi, gpt-oss, Qwen-Agent, ReAct
tagged     a tag for the function and one for each parameter: Qwen3-Coder, Seed-OSS, MiniMax, MiniCPM, GLM,
           LongCat, Hunyuan, DeepSeek, Grok
pythonic   name(argument=value), in a list, a mark or a block: Llama, Olmo, LFM2, Gemini
braced     call:name{argument:value}: Gemma

A call that is only spoken of, between other words, is none. Nothing is ever evaluated.
"""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

from automotive_cosim.contracts import Json

NAMES = ("name", "tool_name", "toolName", "function_name", "function", "tool", "recipient_name")
ARGUMENTS = ("arguments", "parameters", "args", "input", "tool_input", "kwargs")
WrittenCall = tuple[str, object]
_NAME = r"(?:functions\.|default_api\.)?(?P<name>[A-Za-z_][\w.-]*?)"
_MARKED = (
    r"(?:<[|\uff5c]?(?:\w+:)?(?!\w*(?:respon|result|output))\w*(?:tool|function)\w*[|\uff5c]?>"
    r"|<\|(?:python_(?:tag|start)|START_ACTION|plugin|FunctionCallBegin)\|>|<TOOLCALL>|\[TOOL_CALLS\]"
    r"|^functools|^function call)"
)
_HEADED = re.compile(
    r"(?:<function=|\[TOOL_CALLS\]\s*|<\|tool_call_begin\|>\s*|\bto=|<\uff5ctool\u2581call\u2581begin\uff5c>"
    r"(?:function<\uff5ctool\u2581sep\uff5c>)?|^(?=[\w.-]+\[ARGS\])|\u273fFUNCTION\u273f:\s*"
    rf"|^Action:[ \t]*(?=[\w.-]+\s*\n\s*Action Input:)){_NAME}"
    r"(?:>|:\d+|\s|\[CALL_ID\][\w-]+|\[ARGS\]|<\uff5ctool\u2581sep\uff5c>|<\|\w+\|>|commentary|```|json|code"
    r"|\u273fARGS\u273f:|Action Input:)*(?=\{)",
    re.MULTILINE,
)
_CALL, _KEY, _VALUE = (rf"(?:\w{{1,20}}_)?{tag}(?::\w{{1,20}})?" for tag in ("tool_call", "arg_key", "arg_value"))
"""Tags of GLM, before which LongCat, and behind which Hunyuan, has a word."""
_TAGGED = re.compile(
    rf"<(?:\w+:)?(?:function|invoke|function_call)(?:=|\s+name=)[\"']?{_NAME}[\"']?\s*>(?P<body>.*?)"
    r"(?:</(?:\w+:)?(?:function|invoke|function_call)>|</(?:\w+:)?tool_call>)"
    rf"|<{_CALL}>\s*{_NAME.replace('name', 'glm')}\s*(?:<tool_sep(?::\w+)?>\s*)?"
    rf"(?P<pairs>(?:<{_KEY}>.*?</{_VALUE}>\s*)*)</{_CALL}>",
    re.DOTALL,
)
_PARAMETER = re.compile(
    r"<(?:\w+:)?param(?:eter)?(?:=|\s+name=)[\"']?([\w.-]+)[\"']?[^<>]*>((?:\s*<!\[CDATA\[.{0,2000}?\]\]>)?.*?)"
    r"(?:</(?:\w+:)?param(?:eter)?>|(?=<(?:\w+:)?param(?:eter)?\b)|\Z)"
    rf"|<{_KEY}>\s*(.*?)\s*</{_KEY}>\s*<{_VALUE}>(.*?)</{_VALUE}>",
    re.DOTALL,
)
_BEGUN = re.compile(rf"(?:{_MARKED}\s*)+(?=[{{\[])", re.MULTILINE)
_BLOCK = re.compile(r"```(?:\w*)\s*\n?\s*((?=[{\[a-z]).*?)\s*```\s*\Z|^((?=[{\[]).*)\Z", re.DOTALL | re.MULTILINE)
_PYTHONIC = re.compile(
    r"(?:<\|python_start\|>|<\|tool_call_start\|>|<function_calls>|<tool_call>|```tool_code\s)(?P<lines>.*?)"
    r"(?:<\|python_end\|>|<\|tool_call_end\|>|</function_calls>|</tool_call>|```)",
    re.DOTALL,
)
_BRACED = re.compile(rf"\bcall:{_NAME}(?P<braced>\{{.*?\}})(?=\s*<)", re.DOTALL)
_CDATA = re.compile(r"\s*<!\[CDATA\[(.*?)\]\]>\s*", re.DOTALL)
_DSML = re.compile(r"[|\uff5c]DSML[|\uff5c]")
_QUOTES = re.compile(r'<escape>|<\|"\|>')


def written(text: str, schemas: Mapping[str, Json]) -> list[WrittenCall]:
    """Name and arguments of each call in an answer's words, in their order.

    Args:
        schemas: of the parameters, by function; texts in tags become what they say. A call alone, without any mark,
            is one only of these functions."""
    text = _DSML.sub("", text)
    calls: list[WrittenCall] = []
    read = 0
    for at, end, found in sorted(_placed(text, schemas), key=lambda each: (each[0], -each[1])):
        if found and at >= read:
            calls += found
            read = end
    return calls or _alone(text, schemas)


def _placed(text: str, schemas: Mapping[str, Json]) -> Iterator[tuple[int, int, list[WrittenCall]]]:
    """Calls that have marks, with where they begin and end."""
    for mark in _TAGGED.finditer(text):
        name = mark["name"] or mark["glm"]
        given = dict(_parameters(mark["body"] or mark["pairs"] or "", schemas.get(name, {})))
        if given or "{" not in (mark["body"] or ""):
            yield mark.start(), mark.end(), [(name, given)]
    for mark in _HEADED.finditer(text):
        for given, end in _values(text, mark.end(), most=1):
            yield mark.start(), end, [(mark["name"], given)]
    for mark in _PYTHONIC.finditer(text):
        yield mark.start(), mark.end(), _python(mark["lines"])
    for mark in _BRACED.finditer(text):
        named = re.sub(r"([{,]\s*)([A-Za-z_]\w*)\s*:", r'\1"\2":', _QUOTES.sub('"', mark["braced"]))
        yield mark.start(), mark.end(), [(mark["name"], given) for given, _ in _values(named, 0, most=1)]
    for mark in _BEGUN.finditer(text):
        values = _values(text, mark.end())
        calls = [call for value, _ in values for call in _called(value, schemas)]
        if not values and text[mark.end()] == "{":  # it is told that this is no JSON
            calls = [("", text[mark.end() :].partition("<")[0])]
        yield mark.start(), values[-1][1] if values else mark.end(), calls


def _alone(text: str, schemas: Mapping[str, Json]) -> list[WrittenCall]:
    """Calls of known functions that are the end of an answer, on lines of their own or in a block."""
    mark = _BLOCK.search(text.strip())
    lines = (mark[1] or mark[2] or "") if mark else text.strip()
    values = _values(lines, 0) if lines[:1] in ("{", "[") else []
    if values and not lines[values[-1][1] :].strip(" \n;,"):
        found = [call for value, _ in values for call in _called(value, schemas)]
    else:
        found = _python(lines)
    return [call for call in found if call[0] in schemas]


def _values(text: str, at: int, most: int = 100) -> list[tuple[Any, int]]:
    """JSON values one after the other, with where each ends."""
    found: list[tuple[Any, int]] = []
    with suppress(ValueError, RecursionError):
        while len(found) < most:
            found.append(json.JSONDecoder().raw_decode(text, at))
            at = found[-1][1]
            while text[at : at + 1] in (" ", "\n", ";", ","):
                at += 1
            if text[at : at + 1] not in ("{", "["):
                break
    return found


def _called(value: object, schemas: Mapping[str, Json]) -> Iterator[WrittenCall]:
    if isinstance(value, list):
        for each in value:
            yield from _called(each, schemas)
    elif isinstance(value, dict):
        name = next((value[key] for key in NAMES if key in value), None)
        if isinstance(name, dict):
            yield from _called(name, schemas)
        elif isinstance(name, str):
            given = next((value[key] for key in ARGUMENTS if key in value), None)
            yield name.removeprefix("functions."), {} if given is None else given
        elif len(value) == 1 and next(iter(value)) in schemas:  # {"name": {...}}
            yield next(iter(value.items()))


def _parameters(body: str, schema: Json) -> Iterator[tuple[str, object]]:
    properties = schema.get("properties", {})
    for name, value, key, other in _PARAMETER.findall(body):
        yield name or key, _value(value or other, properties.get(name or key, {}))


def _value(text: str, schema: Json) -> object:
    """What a text in a tag says, by its schema."""
    if whole := _CDATA.fullmatch(text):
        text = whole[1]
    told = text[1:-1] if text[:1] == text[-1:] == "\n" and len(text) > 1 else text
    plain = told.strip()
    is_text = schema.get("type") == "string"
    if is_text and plain[:1] != '"':
        return told
    with suppress(ValueError, RecursionError):
        value = json.loads({"True": "true", "False": "false", "None": "null"}.get(plain, plain))
        if isinstance(value, str) or not is_text:
            return value
    return told


def _python(lines: str) -> list[WrittenCall]:
    """Calls in Python's notation with named constants; none if anything else is there."""
    calls: list[WrittenCall] = []
    try:
        for statement in ast.parse(lines.strip()).body:
            each = statement.value if isinstance(statement, ast.Expr) else None
            for call in each.elts if isinstance(each, ast.List | ast.Tuple) else [each]:
                match call:
                    case ast.Call(ast.Name("print"), [ast.Call() as inner], []):
                        call = inner
                match call:
                    case ast.Call(function, [], words):
                        given = {word.arg: ast.literal_eval(word.value) for word in words if word.arg}
                        calls.append((ast.unparse(function).rpartition(".")[2], given))
                    case _:
                        return []
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []
    return calls
